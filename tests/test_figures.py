"""Energies, momenta, where the energy went, and the error of it, as the HUD shows them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, empty_world, sized, tap
from recording import RecordingCanvas
from test_hud import frame, recorded, row

from physicslab.components import Drag, Mass, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.energy import STORED_WORDS, measure_account, measure_energy, measure_momentum
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.prefabs import circle, pendulum
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.theme import DARK
from physicslab.view.canvas.canvas import overlap
from physicslab.view.canvas.quantities import percentage, quantity, round_quantity, vector_quantity
from physicslab.view.overlay.edges import draw_scale_bar
from physicslab.view.overlay.marks import draw_selection
from physicslab.view.toolkit.ui import Ui
from physicslab.view.workbench.figures import EnergyWatch, WorldFigures
from physicslab.view.workbench.world_panel import parts_of
from physicslab.world import World


def test_every_energy_stands_beside_its_name() -> None:
    world = empty_world()
    pendulum(world, (0, 2), length=1.5, stiffness=50.0)
    circle(world, (3, 1), mass=2.0, velocity=(1, 2), angular_velocity=3.0)
    desk, canvas = recorded(world)
    desk.frames(30)
    desk.key("space")
    frame(desk, canvas)
    energy = measure_energy(world)
    assert set(energy.potential) == {"gravity", "spring"}
    for name, stored in energy.potential.items():
        assert row(desk, STORED_WORDS.get(name, name)) == quantity(stored, "J")
    assert row(desk, "Kinetic energy") == quantity(energy.kinetic, "J")
    assert row(desk, "Potential energy") == quantity(sum(energy.potential.values()), "J")
    assert row(desk, "Total energy") == quantity(energy.total, "J")


def test_momentum_is_a_vector_and_has_a_magnitude() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 2), mass=2.0, velocity=(3, -4))
    desk, canvas = recorded(world)
    desk.key("space")
    frame(desk, canvas)
    assert row(desk, "Total momentum") == "10.00 kg m/s"
    assert row(desk, "as a vector") == "(6.00, -8.00) kg m/s"
    assert row(desk, "Angular momentum") == quantity(measure_momentum(world).angular, "kg m²/s")
    assert row(desk, "Angular momentum") == "-12.00 kg m²/s"


def test_what_was_lost_since_the_start_is_a_change_with_its_causes_and_no_error() -> None:
    world = load_scene("drop")
    desk, canvas = recorded(world)
    desk.frames()
    before = measure_energy(world).total
    desk.frames(180)
    desk.key("space")
    frame(desk, canvas)
    change = measure_energy(world).total - before
    assert change < -0.1
    assert row(desk, "Energy change") == quantity(change, "J")
    assert row(desk, "by impacts") == quantity(measure_account(world).energy["impacts"], "J")
    assert row(desk, "counted since") == "0.00 s"
    assert any(words.startswith("Taken: impacts") for words in desk.ui.words)
    assert abs(measure_account(world).energy["numerical"]) < 1e-9


def clicked(desk: Desk, button: str) -> None:
    desk.press(3, 3, button)
    desk.release(3, 3, button)


EDITS: dict[str, Callable[[Desk], None]] = {
    "a body is made": lambda desk: clicked(desk, "left"),
    "a box is made": lambda desk: clicked(desk, "right"),
    "a pendulum is made": lambda desk: desk.key("p"),
    "gravity is turned off": lambda desk: desk.key("g"),
    "planets": lambda desk: desk.key("o"),
    "everything is cleared": lambda desk: desk.key("r"),
    "a body is removed": lambda desk: desk.key("delete"),
}


@pytest.mark.parametrize("edit", EDITS)
def test_every_edit_is_booked_as_one_and_is_no_error(edit: str) -> None:
    world = empty_world()
    circle(world, (0, 1), mass=1.0)
    circle(world, (20, 0), mass=1.0)
    desk, canvas = recorded(world)
    frame(desk, canvas)
    desk.frames(51)
    frame(desk, canvas)
    before = measure_account(world)
    desk.move(*world.component(world.entities()[0], Transform).position)
    EDITS[edit](desk)
    desk.key("space")
    frame(desk, canvas)
    account = measure_account(world)
    edited, held = (account.energy[name] - before.energy[name] for name in ("edits", "hand"))
    assert edited != 0.0 and held == 0.0
    assert abs(account.energy["numerical"]) < 1e-9 * abs(edited)
    assert row(desk, "by edits") == quantity(account.energy["edits"], "J")
    assert row(desk, "counted since") == "0.00 s"


def test_the_work_of_the_hand_is_its_own_account() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), mass=1.0)
    desk, canvas = recorded(world)
    desk.drag((0, 0), (3.0, 0.0), frames=20)
    desk.frames(30)
    desk.key("space")
    frame(desk, canvas)
    assert measure_energy(world).kinetic > 4.0
    assert row(desk, "by hand and driven bodies") == quantity(measure_energy(world).kinetic, "J")
    desk.window.selection.entities = ()
    frame(desk, canvas)
    assert any(words.startswith("Given: hand") for words in desk.ui.words)
    assert "Where the energy came from" in desk.ui.words
    assert abs(measure_account(world).energy["numerical"]) < 1e-12


@pytest.mark.parametrize("scene", ["slope", "bounces", "spring_chain", "solar_system", "dominoes"])
def test_both_bars_of_the_energy_are_equally_long(scene: str) -> None:
    world = load_scene(scene)
    watch = EnergyWatch()
    for _ in world.stepping(seconds=2.0, stride=30):
        figures = WorldFigures(world, watch)
        came, went = parts_of(figures, DARK)
        assert [went[0].energy, went[1].energy] == [figures.energy.kinetic, figures.energy.stored]
        assert all(part.energy >= 0.0 for part in (*came[1:], *went[2:])), "an account is what was taken"
        whole = sum(part.energy for part in came)
        error = figures.audit.account.energy["numerical"]
        assert sum(part.energy for part in went) == pytest.approx(whole + error, rel=1e-9, abs=1e-9)
    assert whole != 0.0


def test_the_first_picture_of_the_bar_is_what_the_figures_above_it_say() -> None:
    figures = WorldFigures(load_scene("drop"), EnergyWatch())
    _, went = parts_of(figures, DARK)
    assert [(part.name, round(part.energy, 2)) for part in went] == [("kinetic", 0.5), ("potential", 39.24)]


def test_an_edit_that_is_taken_back_leaves_no_trace_in_the_bar() -> None:
    desk, _ = recorded(load_scene("slope"))
    desk.frames(20)
    desk.key("space")
    desk.frames(SETTLED)
    watch = EnergyWatch()
    before = parts_of(WorldFigures(desk.world, watch), DARK)
    desk.press(0, -2.5)
    desk.release(0, -2.5)
    desk.frames(SETTLED)
    assert parts_of(WorldFigures(desk.world, watch), DARK) != before
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames(SETTLED)
    assert parts_of(WorldFigures(desk.world, watch), DARK) == before


def test_a_bar_of_what_is_negative_lies_left_of_its_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: dict[str, tuple[float, float]] = {}

    def bar(ui: Ui, label: str, value: str, share: float, colour: object, *, zero: float, tip: str) -> None:
        drawn[label] = zero, zero + share

    monkeypatch.setattr(Ui, "bar", bar)
    recorded(load_scene("two_planets"))[0].frames(2)
    (zero, kinetic), (left, stored), (again, total) = (
        drawn[f"{kind} energy"] for kind in ("Kinetic", "Potential", "Total")
    )
    assert left == again == zero, "one zero for all three"
    assert stored == pytest.approx(0.0) and 0.0 < total < zero < kinetic == pytest.approx(1.0)
    world = empty_world()
    circle(world, (0, -5))
    recorded(world)[0].frames(2)
    zero, stored = drawn["Potential energy"]
    assert stored == pytest.approx(0.0) and zero == pytest.approx(0.8), "it ends before the end of the bar"


def test_a_body_in_the_hand_and_out_of_it_leaves_the_rest_as_it_was() -> None:
    world = empty_world()
    circle(world, (0, 8), mass=1.0)
    circle(world, (3, 5), mass=2.0)
    desk, canvas = recorded(world)
    desk.frames(5)
    desk.press(*world.component(world.entities()[1], Transform).position)
    desk.frames(30)
    desk.window.selection.entities = ()
    frame(desk, canvas)
    assert any("in the hand" in words for words in desk.ui.words)
    desk.release(3, 5)
    desk.key("space")
    desk.window.selection.entities = ()
    frame(desk, canvas)
    assert not any("in the hand" in words for words in desk.ui.words)
    account = measure_account(world)
    assert abs(account.energy["hand"]) < 2.0 * 9.81, "what it weighs from the origin up is not counted"


def test_parts_of_the_bar_have_their_names_as_far_as_there_is_room() -> None:
    world = load_scene("slope")
    desk, canvas = recorded(world)
    desk.frames(120)
    desk.key("space")
    frame(desk, canvas)
    assert "kinetic" in desk.ui.words and {"friction", "fri", "f"} & set(desk.ui.words)
    assert any(words.startswith("Taken: friction") for words in desk.ui.words)


def test_a_place_on_the_time_line_has_the_accounts_of_then() -> None:
    desk, canvas = recorded(load_scene("slope"))
    desk.frames(40)
    history = desk.window.edits.history
    step, then = history.step_count, measure_account(desk.world)
    desk.frames(60)
    desk.key("space")
    desk.frames(2)
    history.seek(step)
    frame(desk, canvas)
    assert measure_account(desk.world) == then
    assert row(desk, "by friction") == quantity(then.energy["friction"], "J")


def test_a_scene_that_is_started_again_has_new_accounts() -> None:
    desk, canvas = recorded(load_scene("slope"))
    desk.window.scenes.source = "slope"
    desk.frames(60)
    desk.key("space")
    frame(desk, canvas)
    assert "by friction" in desk.ui.rows
    desk.key("r", pygame.KMOD_CTRL)
    desk.frames(2)
    frame(desk, canvas)
    assert desk.world.time < 0.1
    account = measure_account(desk.world)
    assert account.since == 0.0 and abs(account.energy["friction"]) < 0.1


def test_a_body_that_is_put_elsewhere_while_paused_is_an_edit() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), mass=1.0)
    desk, _ = recorded(world)
    desk.key("space")
    desk.press(0, 0)
    desk.frames(2)
    before = world.revision
    desk.frames(2)
    assert world.revision == before
    desk.move(1.0, 0.0)
    desk.frames(2)
    assert world.component(ball, Transform).position.x == pytest.approx(1.0)
    assert world.revision > before


def test_what_only_changes_the_picture_is_no_edit() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk, _ = recorded(world)
    desk.frames(2)
    before = world.revision
    for name in ("v", "e", "h", "f", "i", "tab"):
        desk.key(name)
        desk.frames(2)
    assert world.revision == before


def test_trails_are_no_edit_of_the_motion_and_its_energy_goes_on_being_measured() -> None:
    world = empty_world()
    circle(world, (0, 5))
    desk, _ = recorded(world)
    desk.frames(30)
    plan, edits = world.plan, world.motion_edits
    watch = EnergyWatch()
    watch.sample(world)
    for on in (True, False):
        before = world.revision
        desk.key("t")
        desk.frames(10)
        assert world.revision > before and bool(len(world.batch(Trail))) == on
        assert world.motion_edits == edits and world.plan is plan
        watch.follow(world)
        assert watch.since < world.time - 0.1, "it has not begun again"
    world.add(circle(world, (3, 5)), Trail())
    desk.frames(2)
    watch.follow(world)
    assert world.motion_edits > edits and watch.since == world.time


def with_drag(world: World) -> None:
    world.add(circle(world, (0, 0)), Drag(linear=0.1))


def with_damping(world: World) -> None:
    world.spawn(Transform((0, 0)), Velocity(), Mass(1.0))
    world.physics = replace(world.physics, linear_damping=0.1)


def with_a_driven_body(world: World) -> None:
    driven = world.spawn(Transform((0, 0)), Velocity((1, 0)))
    pulled = world.spawn(Transform((1, 0)), Velocity(), Mass(1.0))
    world.spawn(Spring(a=driven, b=pulled, rest_length=1.0, stiffness=10.0))


CAUSES: dict[str, tuple[Callable[[World], object], str]] = {
    "a spring": (lambda world: pendulum(world, (0, 2), stiffness=5000.0), ""),
    "a damper": (lambda world: pendulum(world, (0, 2), stiffness=5000.0, damping=1.0), "by damping"),
    "drag": (with_drag, "by damping"),
    "damping": (with_damping, "by damping"),
    "a driven body": (with_a_driven_body, "by hand and driven bodies"),
}


@pytest.mark.parametrize("cause", CAUSES)
def test_what_changes_the_energy_by_law_stands_apart_from_the_error(cause: str) -> None:
    make, words = CAUSES[cause]
    world = empty_world()
    make(world)
    desk, canvas = recorded(world)
    desk.frames(30)
    frame(desk, canvas)
    causes = [label for label in desk.ui.rows if label.startswith("by ")]
    assert causes == ([words] if words else [])
    assert "Error of the method" in desk.ui.rows


def test_no_gravity_is_shown_where_no_system_applies_it() -> None:
    world = World(SpringSystem(), IntegrateSystem())
    world.spawn(Transform((0, 0)), Velocity(), Mass(1.0))
    desk, canvas = recorded(world)
    frame(desk, canvas)
    assert world.physics.gravity.y == -9.81
    assert row(desk, "Gravity") == "none: no GravitySystem"
    for name in ("g", "o"):
        desk.key(name)
        frame(desk, canvas)
        assert row(desk, "Gravity") == "none: no GravitySystem"
        assert "PLANET MODE" not in canvas.words
        assert any("without GravitySystem" in words for words in canvas.words)
    assert world.physics.gravity_mode == "linear" and world.physics.gravity.y == -9.81


def test_a_watch_begins_again_with_another_world() -> None:
    watch = EnergyWatch()
    for mass in (1.0, 5.0):
        world = empty_world()
        circle(world, (0, 1), mass=mass)
        assert watch.sample(world).initial == pytest.approx(9.81 * mass)


def test_the_revision_counts_edits_and_not_steps() -> None:
    world = empty_world()
    circle(world, (0, 0))
    world.run(steps=5)
    before = world.revision
    world.run(steps=5)
    assert world.revision == before
    circle(world, (1, 0))
    world.synchronise()
    assert world.revision > before


@pytest.mark.parametrize(
    ("scale", "words"), [(100.0, "0.5 m"), (37.0, "2 m"), (0.02, "5000 m"), (30.0, "2 m")]
)
def test_the_scale_bar_is_as_long_as_it_says(scale: float, words: str) -> None:
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(empty_world(), canvas)
    desk.window.camera.scale = scale
    canvas.calls.clear()
    draw_scale_bar(desk.window.drawing, 600, 400)
    assert canvas.words == [words]
    (lines,) = canvas.called("lines")
    assert lines["end"][0][0] - lines["start"][0][0] == pytest.approx(float(words[:-2]) * scale)


def test_h_hides_the_grid_and_shows_it() -> None:
    desk, canvas = recorded(empty_world())
    grids = []
    for _ in range(3):
        canvas.calls.clear()
        desk.frames()
        grids.append(any(call["colour"] == desk.window.theme.grid for call in canvas.called("lines")))
        desk.key("h")
    assert grids == [True, False, True]


def test_bodies_out_of_sight_are_pointed_at_and_counted() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), velocity=(1, 0))
    desk, canvas = recorded(world)
    frame(desk, canvas)
    theme = desk.window.theme

    def arrows() -> list[str]:
        texts = canvas.called("text")
        return [t["words"] for t in texts if t["style"].colour == theme.accent]

    assert not arrows()
    for place in ((30, 0), (40, 3), (0, -50), (-5.7, 0)):  # the last is behind the tools
        circle(world, place)
    frame(desk, canvas)
    assert arrows() == ["1", "2", "1"], "left, right, and below"
    heads = [call for call in canvas.called("lines") if call["colour"] == theme.accent]
    ways = [call["end"][0] - call["start"][0] for call in heads]
    assert ways[0][0] < 0 and ways[1][0] > 0 and ways[2][1] > 0
    desk.key("f")
    frame(desk, canvas)
    assert not arrows()


def test_the_line_around_a_chain_goes_along_it() -> None:
    """It went straight from one end of the hills to the other."""
    desk, canvas = recorded(load_scene("car"))
    bodies = desk.world.batch(Shape).entities.tolist()
    chain = next(body for body in bodies if desk.world.component(body, Shape).kind == "chain")
    canvas.calls.clear()
    draw_selection(desk.world, [chain], desk.window.drawing)
    spans = [np.hypot(*(call["end"] - call["start"]).T).max() for call in canvas.called("lines")]
    assert max(spans) < 2.0 * desk.window.camera.scale


@pytest.mark.parametrize("level", [0.0, 2.0, -2.0, 1.0])
def test_no_arrow_to_bodies_out_of_sight_covers_a_number_of_an_axis(level: float) -> None:
    """At the left edge it lay over the numbers of heights."""
    world = empty_world(gravity=(0, 0))
    for place in ((-60, 10.0 * level), (60, level), (0, 50), (0, -50)):
        circle(world, place)
    desk, canvas = recorded(world)
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 40.0)
    frame(desk, canvas)
    texts = [t for t in canvas.called("text") if t["style"].colour == desk.window.theme.coordinate]
    numbers = [(*t["at"], *canvas.text_size(t["words"], t["style"])) for t in texts]
    arrows = [call["rect"] for call in canvas.called("panel") if call["outline"] == desk.window.theme.accent]
    assert len(arrows) == 4
    assert not any(overlap(arrow, number) for arrow in arrows for number in numbers)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (Vector2(0, 0), "(0, 0) N"),
        (Vector2(-1234.5, 0.4), "(-1234, 0) N"),
        (Vector2(2.5e7, -1e6), "(2.50, -0.10)·10⁷ N"),
        (Vector2(0.012, -0.001), "(0.0120, -0.0010) N"),
        (Vector2(float("nan"), 0), "not finite, N"),
    ],
)
def test_vectors(value: Vector2, words: str) -> None:
    assert vector_quantity(value, "N") == words


def test_shares_and_lengths_that_are_out_of_the_ordinary() -> None:
    assert percentage(float("inf")) == "not finite"
    assert percentage(-1.5) == "-150 %"
    assert round_quantity(2e9, "m") == "2·10⁹ m"


def test_energy_that_is_all_of_the_start_has_no_bar_of_where_it_came_from() -> None:
    """A part below a hundredth has no name there: the bar had one part, and moved all below it."""
    desk = sized((1280, 800), load_scene("drop"))
    tap(desk, "space")
    desk.window.selection.take(desk.world.entity("ball"))
    tap(desk, "up")
    tap(desk, "escape")
    desk.frames(20)
    assert any(words.startswith("Given: edits") for words in desk.ui.words)
    assert "Where the energy is now" in desk.ui.words
    assert "Where the energy came from" not in desk.ui.words
