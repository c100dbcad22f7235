"""Meters and sliders in the window."""

from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, fill, point, sized, tap
from plotting import CTRL, SHIFT, ball_of, pause

from physicslab import load_scene
from physicslab.components import Mass, Meter, Slider, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, History
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


def test_meters_and_sliders_cover_no_cart_where_the_window_is_small_and_its_text_large() -> None:
    """At 800 x 600 with text of 150 % they hid the carts that they speak of."""
    desk = sized((800, 600), load_scene("carts"), 1.5)
    tap(desk, "home")
    assert {"cart 1: velocity x", "2.000 m/s"} <= set(desk.ui.words)
    camera, place = desk.window.camera, desk.world.table(Transform)["position"]
    for row in desk.world.batch(Transform, Velocity).rows:
        x, y = camera.to_screen(Vector2(*place[row]))
        assert not desk.sandbox.interface.toolkit.covers((x, y), round(0.3 * camera.scale))


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
