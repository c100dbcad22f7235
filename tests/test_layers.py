"""Layers: which bodies touch each other, in every stepper, and from the moment at which it is changed."""

import copy

import pytest

from physicslab import World, load_scene
from physicslab.components import Layer, Transform
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.history import AddComponent, History
from physicslab.prefabs import box, circle

SETTINGS = {
    "soft": SimulationConfig(contacts="soft"),
    "rigid": SimulationConfig(contacts="rigid"),
    "events": SimulationConfig(collisions="exact"),
}


def stacked(settings: SimulationConfig, lower: Layer | None, upper: Layer | None) -> float:
    """Return the height at which a ball comes to rest above a box on a floor, each of a size of 1 m."""
    world = World(physics=PhysicsConfig(bounds=(-5.0, 0.0, 5.0, 9.0)), simulation=settings)
    one = box(world, (0.0, 0.5), width=1.0, height=1.0, static=True)
    other = circle(world, (0.0, 1.7), radius=0.5)
    for entity, layer in ((one, lower), (other, upper)):
        if layer is not None:
            world.add(entity, copy.copy(layer))
    world.run(seconds=1.0)
    return world.component(other, Transform).position.y


@pytest.mark.parametrize(
    "lower, upper, touches",
    [
        (Layer(1), Layer(1), True),
        (Layer(1), Layer(2), False),
        (None, Layer(2), True),
        (None, Layer(2, "none"), False),
        (Layer(1, "others"), Layer(1, "others"), False),
        (Layer(1, "others"), Layer(2, "others"), True),
        (Layer(1, "others"), Layer(2, "own"), False),
        (None, Layer(3, "others"), True),
    ],
)
@pytest.mark.parametrize("settings", SETTINGS.values(), ids=SETTINGS)
def test_two_bodies_touch_if_each_touches_the_layer_of_the_other(
    settings: SimulationConfig, lower: Layer | None, upper: Layer | None, touches: bool
) -> None:
    height = stacked(settings, lower, upper)
    assert height == pytest.approx(1.5 if touches else 0.5, abs=5e-3), "the bounds hold all"


def test_a_sleeper_falls_through_a_floor_that_is_put_into_another_layer() -> None:
    world = World(simulation=SimulationConfig(sleeping=True, contacts="soft"))
    floor = box(world, (0.0, -0.5), width=4.0, height=1.0, static=True)
    crate = box(world, (0.0, 0.25), width=0.5, height=0.5)
    world.add(crate, Layer(1))
    history = History(world)
    for _ in range(60):
        history.step()
    assert world.sleep.count == 1
    history.do(AddComponent(floor, Layer(2)))
    for _ in range(30):
        history.step()
    fallen = 0.25 - 0.5 * 9.81 * 0.25
    assert world.component(crate, Transform).position.y == pytest.approx(fallen, abs=0.02)


def test_layers_are_kept_in_files() -> None:
    world = load_scene("drop")
    world.add(world.entity("ball"), Layer(7, "others"))
    document = write_scene(world)
    assert document["entities"][1]["Layer"] == {"number": 7, "touches": "others"}
    again = read_scene(document)
    assert again.component(again.entity("ball"), Layer).given() == {"number": 7, "touches": "others"}
    with pytest.raises(InvalidValue, match="a whole number from 1 to 99"):
        Layer(0)
