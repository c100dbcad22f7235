"""Meters and sliders in the window."""

from itertools import combinations
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, fill, point, sized, tap
from plotting import CTRL, SHIFT, ball_of, pause

from physicslab import load_scene
from physicslab.components import Mass, Meter, Slider, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, History, SetField
from physicslab.view.controls import dashboard_actions
from physicslab.view.workbench.panel_places import Small, places


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    return sized((1280, 720), empty_world(gravity=(0, 0)))


def test_a_meter_shows_a_number_with_its_unit_and_can_show_another(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m", CTRL)
    assert "2.000 m/s" in desk.ui.words
    click(desk, "Menu of meter 1")
    click(desk, "ball")
    click(desk, "kinetic energy [J]")
    assert desk.window.dashboard.meters[0].key[1] == "kinetic energy"
    click(desk, "Menu of meter 1")
    click(desk, "Place")
    click(desk, "Top left")
    assert desk.window.dashboard.meters[0].corner == "top left"
    click(desk, "Menu of meter 1")
    click(desk, "Remove the meter")
    assert not desk.world.batch(Meter).entities.size
    pause(desk)
    tap(desk, "z", CTRL)
    tap(desk, "z", CTRL)
    assert desk.world.batch(Meter).entities.size


def slide(desk: Desk, label: str, share: float, between: int = 3) -> None:
    """Press the slider in its middle, move to a share of its width, and let go there."""
    left, top, width, height = desk.ui.places[label]
    start, end = (left + width // 2, top + height // 2), (left + round(share * width), top + height // 2)
    point(desk, start)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=start, button=1, touch=False))
    desk.frames(2)
    for n in range(1, 4):
        place = start[0] + (end[0] - start[0]) * n // 3, start[1]
        point(desk, place, (1, 0, 0))
        desk.frames(between)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, pos=end, button=1, touch=False))
    desk.frames(SETTLED)


def test_a_slider_is_one_edit_while_time_stands_still(desk: Desk) -> None:
    ball = ball_of(desk)
    pause(desk)
    tap(desk, "m", CTRL | SHIFT)
    entries = len(desk.window.edits.history.entries)
    mass = mass_of(desk, ball)
    slide(desk, "Slider 1", 0.8)
    assert mass_of(desk, ball) > mass and len(desk.window.edits.history.entries) == entries + 1
    tap(desk, "z", CTRL)
    assert mass_of(desk, ball) == mass


def mass_of(desk: Desk, ball: int) -> float:
    return desk.world.component(ball, Mass).mass


def test_a_slider_may_have_any_range_that_a_file_may_have() -> None:
    world = empty_world(gravity_mode="none")
    body = world.spawn(Transform(), Mass(2.0))
    world.spawn(Slider("Mass.mass", body, 1.0, 1e300))
    desk = sized((1280, 720), world)
    pause(desk)
    slide(desk, "Slider 1", 1.0)
    assert world.component(body, Mass).mass == pytest.approx(1e300, rel=0.05)
    assert desk.window.dashboard.sliders


def test_a_slider_for_gravity_works_while_time_runs_and_the_run_is_the_same_again(
    desk: Desk, tmp_path: Path
) -> None:
    ball_of(desk)
    desk.window.selection.clear()
    tap(desk, "m", CTRL | SHIFT)
    desk.frames(5)
    slide(desk, "Slider 1", 0.9)
    assert 15.0 < -desk.world.physics.gravity.y <= 20.0
    desk.frames(20)
    tap(desk, "z", CTRL)
    assert -desk.world.physics.gravity.y == 0.0, "one press takes the drag back"
    tap(desk, "y", CTRL)
    assert 15.0 < -desk.world.physics.gravity.y <= 20.0
    pause(desk)
    history, last = desk.window.edits.history, desk.window.edits.history.step_count
    place = desk.world.component(desk.world.entity("ball"), Transform).position
    assert place.y < 0.0
    history.save(tmp_path / "slid.json")
    history.seek(0)
    history.seek(last)
    assert history.difference is None
    assert desk.world.component(desk.world.entity("ball"), Transform).position == place
    again = History.load(tmp_path / "slid.json")
    again.seek(again.steps_range[1])
    assert again.difference is None
    assert again.world.component(again.world.entity("ball"), Transform).position == place


def test_the_slider_of_a_spring_is_for_its_stiffness_and_can_be_given_other_ends(desk: Desk) -> None:
    ball = ball_of(desk)
    desk.window.edits.do(AddComponent(ball, Spring(anchor_b=(0, 2), stiffness=40.0)))
    pause(desk)
    tap(desk, "m", CTRL | SHIFT)
    slider = desk.window.dashboard.sliders[0]
    assert (slider.changes, slider.low, slider.high) == ("Spring.stiffness", 0.0, 200.0)
    made = Slider("Spring.stiffness", ball, 10.0, 50.0)
    desk.window.do_next(dashboard_actions.change, slider.entity, made)
    desk.frames(SETTLED)
    slide(desk, "Slider 1", 1.0)
    assert desk.world.component(ball, Spring).stiffness == 50.0
    desk.window.selection.take(ball)
    tap(desk, "delete")
    assert "The body is gone" in desk.ui.words


@pytest.mark.parametrize(("end", "number", "allowed"), [("low", "60", "< 50"), ("high", "5", "> 10")])
def test_an_end_beyond_the_other_is_refused_by_what_that_end_may_be(
    desk: Desk, end: str, number: str, allowed: str
) -> None:
    ball = ball_of(desk)
    desk.window.edits.do(AddComponent(ball, Spring(anchor_b=(0, 2), stiffness=40.0)))
    pause(desk)
    tap(desk, "m", CTRL | SHIFT)
    made = Slider("Spring.stiffness", ball, 10.0, 50.0)
    desk.window.do_next(dashboard_actions.change, desk.window.dashboard.sliders[0].entity, made)
    desk.frames(SETTLED)
    click(desk, "Menu of slider 1")
    fill(desk, f"{end} of slider 1", number)
    assert f"must be a finite number {allowed} N/m" in desk.ui.words
    assert (desk.window.dashboard.sliders[0].low, desk.window.dashboard.sliders[0].high) == (10.0, 50.0)


@pytest.mark.parametrize("text", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("size", [(800, 600), (1280, 720)])
@pytest.mark.parametrize("scene", ["carts", "gear_train", "pulleys"])
def test_meters_and_sliders_cover_no_body_where_all_of_the_world_is_shown(
    scene: str, size: tuple[int, int], text: float
) -> None:
    """At 800 x 600 with text of 150 % they hid the carts that they speak of; so did gears and weights."""
    desk = sized(size, load_scene(scene), text)
    desk.window.language = "de"  # whose words are long
    for shows_figures in (True, False):
        desk.window.figures = shows_figures
        desk.frames(SETTLED)
        for key in ("home", "f"):
            tap(desk, key)
            small = [pygame.Rect(place) for place in desk.sandbox.interface.small()]
            assert small or (shows_figures and "Show meters" in desk.ui.places)
            assert not any(one.colliderect(other) for one, other in combinations(small, 2))
            camera, place = desk.window.camera, desk.world.table(Transform)["position"]
            for row in desk.world.batch(Transform, Velocity).rows:
                assert not desk.sandbox.interface.toolkit.covers(camera.to_screen(Vector2(*place[row])))


def test_the_view_stays_where_a_meter_grows_by_a_digit(desk: Desk) -> None:
    ball = ball_of(desk, "b")
    tap(desk, "m", CTRL)
    tap(desk, "home")
    before, width = desk.window.camera.scale, desk.sandbox.interface.small()[0][2]
    desk.window.edits.do(SetField(ball, "Velocity", "linear", (-1.234567e11, 0.0)))
    pause(desk)
    desk.frames(SETTLED)
    assert desk.sandbox.interface.small()[0][2] > width and desk.window.camera.scale == before


def test_small_panels_from_two_corners_do_not_cover_each_other_where_others_leave_room() -> None:
    small = [Small(n, "top right" if n == 3 else "top left", (150, 60)) for n in (1, 2, 3)]
    for width in (1000, 460):
        first, second, third = (
            pygame.Rect(place) for place in places((0, 0, width, 400), 16.0, small).values()
        )
        assert not any(
            one.colliderect(other) for one, other in ((first, second), (first, third), (second, third))
        )


def test_a_stack_of_small_panels_has_one_edge_and_its_first_uppermost() -> None:
    """Beside the scale bar there is no room for one of them: the other stood 25 px further in, and above."""
    small = [Small(n, "bottom left", (253, 78)) for n in (1, 2)]
    found = places((124, 26, 374, 520), 18.0, small)
    assert found[1][0] == found[2][0] and found[1][1] < found[2][1]
