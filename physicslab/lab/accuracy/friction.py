"""Bodies that slide, roll, and come to rest."""

from __future__ import annotations

from functools import partial
from typing import Any

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.report import list_contacts
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.worlds import GRAVITY, empty_world, place, velocity
from physicslab.prefabs import box
from physicslab.world import World

__all__ = ["FRICTION"]

_problem = partial(Problem, group="contact", touches=True)
_MU, _SPEED = 0.3, 5.0
_NONE: frozenset[str] = frozenset()


def _floor(world: World, friction: float) -> None:
    box(world, (10, -0.5), width=60, height=1, static=True, friction=friction)


def _slide(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    _floor(world, _MU)
    box(
        world, (0, 0.25), width=1, height=0.5, friction=_MU, velocity=(_SPEED, 0), fixed_rotation=True,
        name="block",
    )  # fmt: skip
    return world


def _slide_error(world: World, i: int) -> float:
    slowing = _MU * GRAVITY
    distance, speed = ((_SPEED - 0.5 * slowing, _SPEED - slowing), (number("friction_slide", "d"), 0.0))[i]
    return max(abs(place(world, "block").x - distance), abs(velocity(world, "block").x - speed))


def _slide_energy(t: float) -> float:
    speed = max(0.0, _SPEED - _MU * GRAVITY * t)
    return 0.5 * speed * speed + GRAVITY * 0.25


def _roll(kind: str, share: float, *, way: bool = False) -> Problem:
    """Return the problem of a body thrown flat that comes to roll; its inertia is ``share`` m r^2.

    What is compared is the speed, or with ``way`` the place, which shows when it began to roll.
    """
    start, stop = number("slip_to_roll", kind, "t"), 1.0

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation)
        _floor(world, _MU)
        shape: tuple[Any, ...] = (Shape.circle(0.5), Material(0, _MU), Mass(1, inertia=share * 0.25))
        world.spawn(Transform((0, 0.5)), Velocity((_SPEED, 0)), *shape, name="wheel")
        return world

    def error(world: World, i: int) -> float:
        speed, slid = number("slip_to_roll", kind, "v"), number("slip_to_roll", kind, "d")
        if way:
            return abs(place(world, "wheel").x - slid - speed * (stop - start))
        spin = world.component(world.entity("wheel"), Velocity).angular
        return max(abs(velocity(world, "wheel").x - speed), abs(-0.5 * spin - speed))

    def energy(t: float) -> float:
        slipping = min(t, start)
        speed, rim = _SPEED - _MU * GRAVITY * slipping, _MU * GRAVITY * slipping / share
        return 0.5 * (speed * speed + share * rim * rim) + GRAVITY * 0.5

    return _problem(
        name=f"slip_to_roll_{kind}" + ("_way" if way else ""),
        title=f"A {kind} thrown without spin that comes to roll",
        source="slip_to_roll",
        compared="how far it has come after 1 s" if way else "speed and spin after 1 s, when it rolls",
        measure="error [m]" if way else "largest error of the speed, and of the rim's [m/s]",
        build=build,
        times=(stop,),
        error=error,
        good=1e-2 if way else 1e-3,
        excellent=1e-6 if way else 1e-9,
        ladder=Ladder(240, 4, by_step=True),
        exact_energy=energy,
        keeps=_NONE,
    )


def _stack(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    box(world, (0, -0.5), width=20, height=1, static=True, friction=0.6)
    for i in range(10):
        box(world, (0, 0.5 + i), width=1, height=1, friction=0.6, name=f"box {i}")
    return world


def _forces_error(world: World, i: int) -> float:
    """Return the largest relative error of the forces between the floor and the boxes of the stack."""
    boxes = [world.entity(f"box {n}") for n in range(10)]
    felt = dict.fromkeys(range(10), 0.0)
    for contact in list_contacts(world):
        above = max(boxes.index(end) for end in (contact.a, contact.b) if end in boxes)
        felt[above] += sum(point.normal_force for point in contact.points)
    true = [number("stack10", "force_k", str(n)) for n in range(10)]
    return max(abs(felt[n] - true[n]) / true[n] for n in range(10))


def _stack_problem(
    name: str, compared: str, measure: str, error: Any, good: float, excellent: float
) -> Problem:
    return _problem(
        name=f"stack10_{name}",
        title="Ten boxes on each other, at rest for 10 s",
        source="stack10",
        compared=compared,
        measure=measure,
        build=_stack,
        times=(10.0,),
        error=error,
        good=good,
        excellent=excellent,
        ladder=Ladder(2400, 2, by_step=True),
    )


FRICTION = (
    _problem(
        name="friction_slide",
        title="A block that slides to a stop",
        compared="place and speed after 1 s, and after 3 s, when it has stopped",
        measure="largest error [m], [m/s]",
        build=_slide,
        times=(1.0, 3.0),
        error=_slide_error,
        good=1e-2,
        excellent=1e-6,
        ladder=Ladder(720, 4, by_step=True),
        exact_energy=_slide_energy,
        keeps=_NONE,
    ),
    _roll("disc", 0.5),
    _roll("disc", 0.5, way=True),
    _roll("sphere", 0.4),
    _roll("hoop", 1.0),
    _stack_problem(
        "forces", "the force at each of ten interfaces after 10 s", "largest relative error", _forces_error,
        1e-2, 1e-9,
    ),
    _stack_problem(
        "height", "how high the top box is after 10 s", "error [m]",
        lambda world, i: abs(place(world, "box 9").y - number("stack10", "top_centre_y")), 0.05, 0.005,
    ),
    _stack_problem(
        "drift", "how far boxes have crept sideways after 10 s", "largest way [m]",
        lambda world, i: max(abs(place(world, f"box {n}").x) for n in range(10)), 1e-3, 1e-6,
    ),
)  # fmt: skip
"""Their problems."""
