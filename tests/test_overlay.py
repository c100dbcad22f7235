"""The educational overlay: its numbers are the resolver's."""

import math
from dataclasses import replace

import numpy as np
import pytest
from desk import Desk, bits, empty_world
from recording import RecordingCanvas
from test_arrows import lines_in, shown

from physicslab.components import Mass, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.prefabs import box, circle
from physicslab.theme import DARK, Colour
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import Rect, overlap
from physicslab.view.canvas.quantities import quantity
from physicslab.view.overlay.contact_samples import SHOWN, resting_of
from physicslab.view.overlay.impulses import CROWD, LABELLED, LABELLED_IN_CROWD
from physicslab.view.overlay.labels import Label, Labels
from physicslab.world import World


def momentum(world: World, entity: int) -> Vector2:
    return world.component(entity, Velocity).linear * world.component(entity, Mass).mass


@pytest.mark.parametrize("offset", [0.0, 0.2], ids=["head-on", "oblique"])
def test_the_impulses_shown_change_the_momenta_exactly(offset: float) -> None:
    world = empty_world(gravity=(0, 0))
    a = circle(world, (-1, 0), radius=0.25, mass=2.0, velocity=(4, 0), restitution=0.8, friction=0.5)
    b = circle(world, (1, offset), radius=0.25, mass=1.0, velocity=(-2, 0), restitution=0.8, friction=0.5)
    before = momentum(world, a), momentum(world, b)
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.key("e")
    desk.frames(25)
    overlays = desk.window.overlays
    (touch,) = overlays.impacts.recent(world.time)
    normal = Vector2(*touch["direction"].tolist())
    shown_impulse = float(touch["normal"]) * normal + float(touch["tangent"]) * normal.perpendicular
    for change in (momentum(world, b) - before[1], before[0] - momentum(world, a)):
        assert change.x == pytest.approx(shown_impulse.x, abs=1e-9)
        assert change.y == pytest.approx(shown_impulse.y, abs=1e-9)
    assert touch["speed"] == pytest.approx(-Vector2(-6, 0).dot(normal), abs=1e-9)
    words = set(canvas.words)
    assert f"impact at {quantity(float(touch['speed']), 'm/s')}" in words
    assert f"normal {quantity(float(touch['normal']), 'N s')}" in words
    assert f"friction {quantity(abs(float(touch['tangent'])), 'N s')}" in words


@pytest.mark.parametrize("offset", [0.0, 0.2], ids=["head-on", "oblique"])
def test_the_arrows_drawn_change_the_momenta_exactly(offset: float) -> None:
    world = empty_world(gravity=(0, 0))
    a = circle(world, (-1, 0), radius=0.25, mass=2.0, velocity=(4, 0), restitution=0.8, friction=0.5)
    b = circle(world, (1, offset), radius=0.25, mass=1.0, velocity=(-2, 0), restitution=0.8, friction=0.5)
    before = momentum(world, a), momentum(world, b)
    desk, canvas = shown(world, "e", frames=25, paused=False)
    metre = desk.window.camera.scale / desk.window.overlays.impact.per_metre
    foot = lines_in(canvas, DARK.normal_impulse)[0]["start"][0]

    def impulse(colour: Colour) -> Vector2:
        """Return what the arrow at the contact represents, by the legend's scale [N s]."""
        calls = lines_in(canvas, colour)[:-4]  # without the legend's
        if not calls:
            return Vector2()
        dx, dy = calls[0]["end"][0] - foot  # of a broken shaft, the stroke at the tip comes first
        return Vector2(float(dx), -float(dy)) / metre

    normal, friction = impulse(DARK.normal_impulse), impulse(DARK.friction_impulse)
    total = normal + friction
    assert abs(normal.cross(friction)) == pytest.approx(normal.magnitude * friction.magnitude)
    assert (friction.magnitude > 0.1) == (offset > 0.0)
    for change in (momentum(world, b) - before[1], before[0] - momentum(world, a)):
        assert change.x == pytest.approx(total.x, abs=1e-9)
        assert change.y == pytest.approx(total.y, abs=1e-9)
    assert f"normal {quantity(normal.magnitude, 'N s')}" in canvas.words
    assert f"friction {quantity(friction.magnitude, 'N s')}" in canvas.words


@pytest.mark.parametrize("static_first", [True, False])
def test_impulses_act_on_what_can_move(static_first: bool) -> None:
    world = empty_world(gravity=(0, 0))
    if static_first:
        box(world, (0, -0.5), width=10, height=1, static=True, restitution=1)
    circle(world, (0, 0.5), velocity=(0, -4), radius=0.25, mass=1, restitution=1)
    if not static_first:
        box(world, (0, -0.5), width=10, height=1, static=True, restitution=1)
    desk, _ = shown(world, "e", frames=8, paused=False)
    (touch,) = desk.window.overlays.impacts.recent(world.time)
    assert touch["direction"].tolist() == pytest.approx([0.0, 1.0])
    assert touch["normal"] == pytest.approx(8.0) and touch["speed"] == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("friction", "word"), [(0.9, "sticks, μ = 0.9"), (0.1, "slips, μ = 0.1"), (0.0, "μ = 0")]
)
def test_slip_stick_and_the_cone(friction: float, word: str) -> None:
    world = empty_world(gravity=(3.0, -9.0))
    box(world, (0, -0.5), width=10, height=1, static=True, friction=friction)
    box(world, (0, 0.25), width=0.5, height=0.5, friction=friction)
    _, canvas = shown(world, "e", frames=20, paused=False)
    assert word in canvas.words
    cones = lines_in(canvas, DARK.friction_cone)[:-2]  # without the legend's
    if not friction:
        assert not cones
        return
    if friction == 0.9:
        (cone,) = cones
        span = cone["end"] - cone["start"]
        angle = np.degrees(np.arctan2(np.abs(span[:, 0]), -span[:, 1]))
        assert angle == pytest.approx(math.degrees(math.atan(friction)))
    friction_impulse = lines_in(canvas, DARK.friction_impulse)[0]
    assert (
        friction_impulse["end"][:, 0] < friction_impulse["start"][:, 0]
    ).all()  # against the pull to the right


def test_a_block_that_rests_does_not_slip_though_one_of_its_points_carries_all_that_friction_can() -> None:
    world = empty_world(gravity=(3.0, -9.0))
    world.simulation = replace(world.simulation, contacts="rigid")
    box(world, (0, -0.5), width=10, height=1, static=True, friction=0.5)
    block = box(world, (0, 0.25), width=0.8, height=0.5, friction=0.5)
    _, canvas = shown(world, "e", frames=20, paused=False)
    resting = resting_of(world)
    at_limit = np.abs(resting["tangent"]) >= 0.5 * resting["normal"] * (1.0 - 1e-9)
    assert at_limit.any() and world.component(block, Velocity).linear == Vector2()
    assert "sticks, μ = 0.5" in canvas.words and "slips, μ = 0.5" not in canvas.words


def test_impacts_fade_within_a_second_and_not_while_paused() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (-0.3, 0), radius=0.25, velocity=(1, 0), restitution=1)
    circle(world, (0.3, 0), radius=0.25, velocity=(-1, 0), restitution=1)
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.key("e")
    desk.frames(15)

    def opacity(frames: int = 1) -> float:
        canvas.calls.clear()
        desk.frames(frames)
        calls = lines_in(canvas, DARK.normal_impulse)[:-4]  # without the legend's
        return float(calls[0]["opacity"].max()) if calls else 0.0

    fresh = opacity()
    desk.key("space")
    desk.frames(120)
    assert opacity(7) == fresh > 0.7  # where nothing moves it is drawn ten times a second
    desk.key("space")
    desk.frames(30)
    assert 0.0 < opacity() < fresh
    desk.frames(math.ceil(SHOWN * 60))
    assert opacity() == 0.0


def test_only_the_strongest_have_their_numbers() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=14, height=1, static=True)
    for n in range(20):
        circle(world, (0.6 * n - 5.7, 0.2), radius=0.2, mass=10.0 + n)
    desk, canvas = shown(world, "e", frames=30, paused=False)
    numbers = [words for words in canvas.words if words.startswith("normal ") and " N s" in words]
    assert 1 <= len(numbers) <= LABELLED
    assert len(lines_in(canvas, DARK.normal_impulse)[0]["start"]) == 20
    assert desk.window.overlays.covered


def test_a_crowd_of_impacts_has_few_numbers() -> None:
    world = empty_world(gravity=(0, 0))
    for n in range(2 * CROWD):
        circle(world, (0.2 * n - 6.0, 2.0), radius=0.05, velocity=(0, -1), restitution=1)
        circle(world, (0.2 * n - 6.0, 1.8), radius=0.05, velocity=(0, 1), restitution=1)
    _, canvas = shown(world, "e", frames=12, paused=False)
    assert len(lines_in(canvas, DARK.normal_impulse)[0]["start"]) == 2 * CROWD
    numbers = [words for words in canvas.words if words.startswith("impact at")]
    assert 1 <= len(numbers) <= LABELLED_IN_CROWD


def test_the_points_of_a_pair_are_written_together_as_a_force() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    block = box(world, (0, 0.25), width=0.8, height=0.5, mass=3.0)
    desk, canvas = shown(world, "e", frames=30, paused=False)
    desk.window.selection.take(block)
    canvas.calls.clear()
    desk.frames()
    (words,) = [words for words in canvas.words if words.startswith("normal ")]
    assert words == f"normal 29.43 N ({29.43 / 240:.4f} N s)"


def test_labels_lie_apart_and_stay_where_they_are() -> None:
    labels = Labels()
    crowd = [Label((n,), (300.0 + 3 * n, 300.0), ["one", "a longer line"]) for n in range(10)]
    covered = [(0, 0, 280, 600)]
    places = []
    for order in (crowd, crowd[::-1]):
        canvas = RecordingCanvas((800, 600))
        labels.draw(order, covered, Drawing(canvas, Camera(canvas.size), DARK, 12))
        rects = sorted(call["rect"] for call in canvas.called("panel"))
        places.append(rects)
        every = [*rects, *covered]
        for n, (x, y, w, h) in enumerate(every):
            for x2, y2, w2, h2 in every[n + 1 :]:
                assert x + w <= x2 or x2 + w2 <= x or y + h <= y2 or y2 + h2 <= y
    assert len(places[0]) == 10 and places[0] == places[1]


def test_numbers_of_forces_and_impulses_lie_apart() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    box(world, (-0.3, 0.25), width=0.5, height=0.5)
    box(world, (0.3, 0.25), width=0.5, height=0.5)
    top = box(world, (0, 0.75), width=0.5, height=0.5)
    desk, canvas = shown(world, "v", "e", frames=30, paused=False)
    desk.window.selection.take(top)
    desk.key("space")
    desk.frames(3)
    overlays = desk.window.overlays
    canvas.calls.clear()
    desk.frames()
    written = [(call["words"], call["at"]) for call in canvas.called("text")]
    assert len([one for one, _ in written if one.startswith("normal ")]) >= 2
    assert len([one for one, _ in written if one.startswith("normal, from")]) == 2
    panels = [call["rect"] for call in canvas.called("panel")]
    around = [
        next(rect for rect in panels if inside(rect, at))
        for words, at in written if words.startswith(("normal", "weight", "friction"))
    ]  # fmt: skip
    rects = sorted(set(around))
    assert overlays.arrows and overlays.impulses and len(rects) >= 5
    assert not any(overlap(one, other) for n, one in enumerate(rects) for other in rects[n + 1 :])


def inside(rect: Rect, at: tuple[int, int]) -> bool:
    return rect[0] <= at[0] < rect[0] + rect[2] and rect[1] <= at[1] < rect[1] + rect[3]


def test_clearing_drops_impacts() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (-0.3, 0), radius=0.25, velocity=(1, 0), restitution=1)
    circle(world, (0.3, 0), radius=0.25, velocity=(-1, 0), restitution=1)
    desk, _ = shown(world, "e", frames=12, paused=False)
    assert len(desk.window.overlays.impacts.kept)
    desk.key("r")
    desk.frames()
    assert not len(desk.window.overlays.impacts.kept)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("pyramid", marks=pytest.mark.slow),
        pytest.param("spring_chain", marks=pytest.mark.slow),
        "solar_system",
        "bounces",
    ],
)
def test_neither_the_window_nor_its_overlays_change_a_bit_of_240_frames(name: str) -> None:
    alone = load_scene(name)
    for _ in range(240):
        alone.step()
    for keys in ((), ("v", "t", "e", "f1")):
        desk = Desk(load_scene(name), RecordingCanvas((1280, 720)))
        for half in range(2):
            for key in keys:  # off again half-way, but for the sparks
                desk.key(key)
            desk.frames(120)
            assert desk.world.steps == 120 * (half + 1)
            desk.window.canvas.calls.clear()  # type: ignore[attr-defined]
        assert bits(desk.world) == bits(alone), keys
