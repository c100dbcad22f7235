"""Worlds in threads: they work in turn, each with the bits that it has alone."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest
from desk import bits

from physicslab.components import Transform, Velocity
from physicslab.files.scene import load_scene
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.system import Stage, System, at
from physicslab.world import World


class Meanwhile(System):
    """Begins a thread within a step, and gives it time to get in the way."""

    def __init__(self, work: Callable[[], object]) -> None:
        self.thread = threading.Thread(target=work)

    @at(Stage.FINISH)
    def begin(self, world: World, h: float) -> None:
        if self.thread.ident is None:
            self.thread.start()
            self.thread.join(0.05)
            assert self.thread.is_alive(), "it waits until the step is made"


def attempts(other: World) -> dict[str, Callable[[], object]]:
    """Return what another thread may do with a world of its own."""
    return {
        "step": other.step,
        "run": lambda: other.run(steps=3),
        "spawn": lambda: other.spawn(Transform(), Velocity()),
        "read": other.entities,
        "make": World,
        "activate": other.activate,
    }


@pytest.mark.parametrize("what", list(attempts(World())))
def test_a_second_thread_waits_until_the_first_has_made_its_step(what: str) -> None:
    other, alone = load_scene("two_planets"), load_scene("two_planets")
    meanwhile = Meanwhile(attempts(other)[what])
    world = World(IntegrateSystem(), meanwhile)
    ball = world.spawn(Transform(), Velocity((1.0, 0.0)))
    world.step(0.5)
    meanwhile.thread.join(60.0)
    assert not meanwhile.thread.is_alive()
    attempts(alone)[what]()
    assert world.component(ball, Transform).position.x == 0.5 and world.time == 0.5
    assert (bits(other), other.entities(), other.time) == (bits(alone), alone.entities(), alone.time)


def _end(scene: str) -> bytes:
    world = load_scene(scene)
    for _ in world.stepping(steps=40, stride=3):
        pass
    return bits(world)


def test_worlds_of_several_threads_have_the_bits_that_they_have_alone() -> None:
    scenes = ["stack", "drop", "newtons_cradle", "two_planets"] * 3
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(_end, scenes)) == list(map(_end, scenes))


def test_threads_one_after_the_other_work_and_give_the_same_bits() -> None:
    one, two = load_scene("stack"), load_scene("stack")
    one.run(steps=20)
    for _ in range(4):
        thread = threading.Thread(target=two.run, kwargs={"steps": 5})
        thread.start()
        thread.join()
    assert two.steps == 20 and bits(one) == bits(two)


def test_a_thread_that_fails_leaves_the_worlds_to_others() -> None:
    world = World()

    def fail() -> None:
        with pytest.raises(ZeroDivisionError), world.active():
            raise ZeroDivisionError

    thread = threading.Thread(target=fail)
    thread.start()
    thread.join()
    world.step()
    assert world.steps == 1
