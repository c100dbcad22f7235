"""Worlds in threads: one at a time works, two at once are refused before anything is touched."""

import threading
from collections.abc import Callable

import esper
import pytest
from desk import bits

from physicslab.components import Transform, Velocity
from physicslab.files.scene import load_scene
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.system import Stage, System, at
from physicslab.world import World

LINE = "another thread is working with a world: esper's context is one for the whole process"


class Pause(System):
    """Waits within a step, until another thread has made its attempt."""

    def __init__(self, meanwhile: Callable[[], object]) -> None:
        self._meanwhile = meanwhile
        self.raised: list[BaseException] = []

    def _try(self) -> None:
        try:
            self._meanwhile()
        except BaseException as error:
            self.raised.append(error)

    @at(Stage.FINISH)
    def pause(self, world: World, h: float) -> None:
        thread = threading.Thread(target=self._try)
        thread.start()
        thread.join()


def attempts(other: World) -> dict[str, Callable[[], object]]:
    """Return what another thread may try with a world of its own."""
    return {
        "step": other.step,
        "run": lambda: other.run(steps=3),
        "spawn": lambda: other.spawn(Transform(), Velocity()),
        "read": other.entities,
        "make": World,
        "activate": other.activate,
    }


@pytest.mark.parametrize("what", list(attempts(World())))
def test_two_threads_at_once_are_refused_and_nothing_is_touched(what: str) -> None:
    other = load_scene("two_planets")
    before = bits(other), other.entities(), other.time
    pause = Pause(attempts(other)[what])
    world = World(IntegrateSystem(), pause)
    ball = world.spawn(Transform(), Velocity((1.0, 0.0)))
    context = esper.current_world
    world.step(0.5)
    (error,) = pause.raised
    assert isinstance(error, RuntimeError) and str(error).startswith(LINE)
    assert world.component(ball, Transform).position.x == 0.5 and world.time == 0.5
    assert (bits(other), other.entities(), other.time) == before
    assert esper.current_world == context


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
