"""Forces among many: chains and nets of stiff springs, bodies that attract each other."""

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import (
    GRAVITY,
    energy_change,
    energy_growth,
    largest,
    open_space,
    place,
    spawn_point,
)
from physicslab.prefabs import binary, chain
from physicslab.state.masses import Diverged
from physicslab.world import World

_LINKS = 50
_STIFF = 1e6
_SIDE = 20
_STEPS = 600


def _chain(touches: bool) -> tuple[World, list[int]]:
    """Return a chain of 50 springs let go level: masses of 0.1 kg, and one of 100 kg at the end."""
    world = open_space(contacts="soft")
    if touches:
        balls = chain(world, _LINKS, (0.0, 0.0), (10.0, 0.0), radius=0.05, stiffness=_STIFF, damping=0.0)
    else:
        balls, link = [], 10.0 / _LINKS
        for i in range(_LINKS):
            ball = spawn_point(world, ((i + 1) * link, 0.0), mass=0.1)
            before = balls[-1] if balls else None
            world.add(ball, Spring(None, before, rest_length=link, stiffness=_STIFF))
            balls.append(ball)
    world.component(balls[-1], Mass).mass = 100.0
    return world, balls


def _reach(touches: bool) -> float:
    """Return the largest distance of a mass from the hook, in lengths of the chain."""
    world, balls = _chain(touches)
    rows = [world.component(ball, Transform) for ball in balls]
    return largest(world, _STEPS, lambda: max(row.position.magnitude for row in rows) / 10.0)


def _chain_growth(touches: bool) -> float:
    world, _ = _chain(touches)
    return energy_growth(world, _STEPS, scale=100.0 * GRAVITY * 10.0)


def _net_growth(steps: int) -> float:
    """Return how the energy grows of a net of 20 x 20 masses, held at two corners and let go level."""
    world, pitch = open_space(), 0.25
    link = partial(Spring, rest_length=pitch, stiffness=_STIFF)
    made = {
        (j, i): spawn_point(world, (i * pitch, -j * pitch), mass=0.1)
        for j in range(_SIDE)
        for i in range(_SIDE)
    }
    for (j, i), body in made.items():
        for other in ((j, i + 1), (j + 1, i)):
            if other in made:
                world.spawn(link(body, made[other]))
    for i in (0, _SIDE - 1):
        world.add(made[0, i], link(anchor_b=Vector2(i * pitch, pitch)))
    weight = 0.1 * _SIDE * _SIDE * GRAVITY
    return energy_growth(world, steps, scale=weight * _SIDE * pitch)


def _off_modes(ratio: float) -> float:
    """Return how far a mass of a level chain is at most from where its modes have it after 2 s [m].

    A hundred springs of 100 N/m between two walls; of 99 masses every second is ``ratio`` times 1 kg. All lie
    on a line, so that the springs are linear, and the first is let go 1 cm off.
    """
    count, stiffness, pulled, seconds = 99, 100.0, 0.01, 2.0
    masses = np.where(np.arange(count) % 2, ratio, 1.0)
    world = open_space(gravity=None)
    made: list[int | None] = [
        spawn_point(world, (i + 1.0 + (pulled if i == 0 else 0.0), 0.0), mass=float(mass))
        for i, mass in enumerate(masses)
    ]
    for i, (a, b) in enumerate(zip([*made, made[-1]], [None, *made[:-1], None], strict=True)):
        hook = (count + 1.0 if b is None and i else 0.0, 0.0)
        world.spawn(Spring(a, b, anchor_b=hook, rest_length=1.0, stiffness=stiffness))
    world.run(seconds=seconds)
    root = np.sqrt(masses)
    springs = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    matrix = stiffness * springs / np.outer(root, root)
    rates, modes = np.linalg.eigh(matrix)
    swing = modes * np.cos(np.sqrt(np.abs(rates)) * seconds) @ modes.T
    expected = np.arange(1.0, count + 1.0) + pulled * root[0] * swing[:, 0] / root
    found = np.array([place(world, body).x for body in made if body is not None])
    return float(np.abs(found - expected).max())


_case = partial(StabilityCase, group="chains")


def _hung(prefix: str, scene: str, touches: bool) -> tuple[StabilityCase, StabilityCase]:
    title = f"chain of {scene}: 50 springs of 1e6 N/m, 0.1 kg each, 100 kg at the end"
    return (
        _case(
            name=f"{prefix}_bounded", title=title, figure="farthest from the hook, of its length", limit=1.05,
            right="it swings and stays together: nothing is farther from the hook than the chain is long",
            measure=partial(_reach, touches),
        ),
        _case(
            name=f"{prefix}_energy", title=title, figure="growth, of what the fall can give", limit=1e-6,
            right="energy never grows", measure=partial(_chain_growth, touches),
        ),
    )  # fmt: skip


CHAINS = (
    *_hung("chain", "points", touches=False),
    *_hung("chain_touching", "discs that touch others", touches=True),
    *(
        _case(
            name=f"chain_modes_{ratio:g}", unit="m", limit=1e-6, measure=partial(_off_modes, ratio),
            title=f"chain of 100 springs between walls, every second mass {ratio:g} times the others, 2 s",
            right="it goes as its modes do", figure="farthest from there",
        )
        for ratio in (1.0, 1e3, 1e6)
    ),
    _case(
        name="net_energy", title="net of 20 x 20 masses on springs of 1e6 N/m, 2 s", limit=1e-6,
        right="bounded: energy never grows", figure="growth, of what the fall can give",
        measure=partial(_net_growth, 120),
    ),
)  # fmt: skip


def _planets(softening: float = 0.0) -> World:
    return open_space(physics=PhysicsConfig(gravity_mode="planet", softening=softening))


def _unreported(softening: float, apart: float) -> float:
    """Return how many bodies have no finite state without a report; two start so far apart, at rest [m]."""
    world = _planets(softening)
    for x in (0.0, apart):
        spawn_point(world, (x, 0.0))
    try:
        world.run(seconds=10.0)
    except Diverged as error:  # a clear end is right: it names the time, and a likely reason
        return float("t =" not in str(error))
    transform, velocity = world.table(Transform), world.table(Velocity)
    finite = np.isfinite(transform["position"]).all(axis=1) & np.isfinite(velocity["linear"]).all(axis=1)
    return float((~finite).sum())


def _stops(world: World, seconds: float) -> Iterator[None]:
    """Advance a world that chooses its steps, with 97 stops on the way."""
    for _ in range(97):
        world.run(seconds=seconds / 97.0)
        yield


def _close_encounter() -> float:
    """Return the change of energy of two bodies that pass at 1e-6 of their largest distance."""
    world = _planets()
    binary(world, separation=2.0, eccentricity=(1.0 - 1e-6) / (1.0 + 1e-6))
    period = 2.0 * math.pi * math.sqrt((1.0 + 1e-6) ** 3 / 2.0)
    return energy_change(world, _stops(world, 2.3 * period))


def _pythagorean() -> float:
    """Return the change of energy of three bodies at rest in the corners of a triangle of 3, 4 and 5."""
    world = _planets()
    for mass, corner in ((3.0, (1.0, 3.0)), (4.0, (-2.0, -1.0)), (5.0, (1.0, -1.0))):
        spawn_point(world, corner, mass=mass)
    return energy_change(world, _stops(world, 70.0))


_planets_case = partial(StabilityCase, group="planets")
_keeps = partial(
    _planets_case, right="the adaptive method keeps the energy", figure="largest change of energy", limit=1e-6
)

ATTRACTION = (
    *(
        _planets_case(
            name=name, title=title, figure="bodies without a finite place, unreported", limit=0.0,
            right="a clear end that names the time, or the right motion: never NaN",
            measure=partial(_unreported, softening, apart),
        )
        for name, title, softening, apart in (
            ("planets_coincident", "two bodies on one spot, softening 0", 0.0, 0.0),
            ("planets_coincident_soft", "two bodies on one spot, softening 0.1 m", 0.1, 0.0),
            ("planets_head_on", "two bodies that fall into each other, softening 0", 0.0, 1.0),
        )
    ),
    _keeps(
        name="planets_close", title="two bodies that pass at 1e-6 of their largest distance",
        measure=_close_encounter,
    ),
    _keeps(name="planets_pythagorean", title="the Pythagorean problem, t = 70", measure=_pythagorean),
)  # fmt: skip
