"""A world in words: what they say is so, in every language, and the same each time."""

import pygame
import pytest
from desk import SETTLED, bits, click, sized, tap

from physicslab import PhysicsConfig, Vector2, describe, load_scene
from physicslab.components import Charge, Mass, Medium, Rod, Shape, Transform, Velocity
from physicslab.scenes import SCENES
from physicslab.world import World


def test_a_world_is_told_with_its_figures() -> None:
    world = load_scene("drop")
    assert describe(world).splitlines() == [
        "A ball on a floor",
        "t = 0 s. 1 body can move, 1 is fixed.",
        "Gravity is 9.81 m/s² downwards.",
        "ball: circle of radius 0.25 m, 1 kg, at x = -3 m, y = 4 m; it moves at 1 m/s to the right.",
        "floor: box of 20 m by 1 m, fixed, at x = 0 m, y = -0.5 m.",
        "Kinetic energy 0.5 J, potential energy 39.24 J, together 39.74 J.",
        "Total momentum 1 kg m/s along x, 0 kg m/s along y.",
    ]
    german = describe(world, "de")
    assert (
        "ball: Kreis vom Radius 0,25 m, 1 kg, bei x = -3 m, y = 4 m; bewegt sich mit 1 m/s nach rechts."
        in german
    )


def test_what_moves_how_and_what_holds_it_is_told() -> None:
    world = World()
    one = world.spawn(Transform((0, 1)), Velocity((-1, -1), -2.0), Mass(2.0), Shape.box(1, 2))
    other = world.spawn(Transform((0, 3)), Velocity((0, 0), 1.0))
    world.spawn(Rod(a=one, b=other, length=2.0))
    world.spawn(Rod(a=one, anchor_b=(0, 4), length=3.0))
    words = describe(world)
    assert "it moves at 1.414 m/s to the lower left and turns at 2 rad/s clockwise." in words
    assert (
        "point without outline, infinitely heavy" in words and "turns at 1 rad/s counter-clockwise" in words
    )
    assert f"Rod between {world.label(one)} and {world.label(other)}." in words
    assert f"Rod between {world.label(one)} and a fixed point." in words


def test_fluids_charges_and_fields_are_told() -> None:
    """A pool was a box that bodies were in, and a charge went round without a reason."""
    physics = PhysicsConfig(gravity_mode="none", electric_field=Vector2(0.0, -2.0), magnetic_field=-0.5)
    world = World(physics=physics)
    world.spawn(Transform(), Velocity(), Mass(1.0), name="lone")
    pool = Transform((0.0, 1.0)), Shape("box", width=8.0, height=4.0), Medium(1.5, flow=(0.5, 0.0))
    world.spawn(*pool, name="pool")
    assert "field" not in describe(world), "nothing is charged"
    world.spawn(Transform(), Velocity(), Mass(1.0), Charge(-0.3), name="ion")
    lines = describe(world).splitlines()
    assert lines[1:4] == [
        "There is no gravity.",
        "An electric field of 2 N/C points downwards.",
        "A magnetic field of 0.5 T points into the plane.",
    ]
    told = "box of 8 m by 4 m full of a fluid of 1.5 kg/m² that flows at 0.5 m/s to the right"
    assert f"pool: {told}, fixed, at x = 0 m, y = 1 m." in lines
    assert any(line.startswith("ion: point without outline with a charge of -0.3 C, 1 kg") for line in lines)
    german = describe(world, "de")
    assert "voll Flüssigkeit" in german and "mit einer Ladung von -0,3 C" in german


def test_rounding_is_no_place_and_a_slow_world_is_not_at_rest() -> None:
    """A plank in balance was at x = 5.046e-16 m, and all of what swims in a drop of water at rest."""
    world = World(physics=PhysicsConfig(gravity_mode="none"))
    world.spawn(Transform((5e-16, 2e-6)), Velocity((3e-7, 0.0), 0.0), Mass(1e-15))
    world.spawn(Transform((5e-16, 4.0)), Velocity(), Mass(1e-15))
    slow, still = describe(world).splitlines()[2:4]
    assert slow.endswith("at x = 0 m, y = 2e-06 m; it moves at 3e-07 m/s to the right.")
    assert still.endswith("at x = 0 m, y = 4 m; it is at rest.")


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_is_told_in_the_same_words_and_stays_as_it_is(name: str) -> None:
    world = load_scene(name)
    before = bits(world)
    words = describe(world)
    assert words == describe(load_scene(name)) and bits(world) == before
    assert "e+" not in words, "a screen reader says it letter by letter"
    moving = len(world.batch(Velocity))
    assert f"{moving} {'body' if moving == 1 else 'bodies'} can move" in words
    assert len(describe(world, "de").splitlines()) == len(words.splitlines()) < 70


def test_f3_shows_the_words_and_they_can_be_copied(monkeypatch: pytest.MonkeyPatch) -> None:
    copied: list[str] = []
    monkeypatch.setattr(pygame.scrap, "put_text", copied.append)
    desk = sized((1280, 720), load_scene("drop"))
    desk.window.pace.paused = True
    tap(desk, "f3")
    assert set(describe(desk.world).splitlines()) <= set(desk.ui.words)
    click(desk, "Copy the words")
    desk.frames(SETTLED)
    assert copied == [describe(desk.world)] and desk.window.notice == "Copied to the clipboard"
    tap(desk, "f3")
    assert not desk.window.shows_words
