"""Forces close by, stiff, dense and strong: charges, molecules, media; nets of springs, attraction."""

import math
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from physicslab.components import Charge, Drag, Mass, Medium, Molecule, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
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


def _charges(distance: float) -> float:
    """Return the error of the speed at which two charges part that are let go so near to each other [m]."""
    world = open_space(physics=PhysicsConfig(gravity_mode="none", coulomb_constant=1.0))
    for x in (0.0, distance):
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), Charge(1.0))
    world.run(seconds=1.0)
    left = abs(world.component(2, Transform).position.x - world.component(1, Transform).position.x)
    parted = math.sqrt(4.0 * (1.0 / distance - 1.0 / left))
    return abs((world.component(2, Velocity).linear.x - world.component(1, Velocity).linear.x) / parted - 1.0)


def _molecules(depth: float) -> float:
    """Return by what share of their depth the energy of three stiff molecules that collide changes."""
    world = open_space(gravity=None)
    for x, y, speed in ((-1.0, 0.0, 1.0), (0.0, 0.02, 0.0), (1.1, -0.01, -2.0)):
        world.spawn(Transform((x, y)), Velocity((speed, 0.0)), Mass(1.0), Molecule(depth, 0.5))
    start = measure_energy(world).total
    world.run(seconds=0.5)
    return abs(measure_energy(world).total - start) / depth


def _turned(turns: float) -> float:
    """Return the error of the speed of a charge after 100 leapfrog steps of so many turns, as a share."""
    laws = PhysicsConfig(gravity_mode="none", magnetic_field=2.0 * math.pi * turns)
    world = open_space(physics=laws, integrator="leapfrog", dt=1.0, substeps=1)
    body = world.spawn(Transform(), Velocity((1.0, 0.0)), Mass(1.0), Charge(1.0))
    world.run(steps=100)
    return abs(world.component(body, Velocity).linear.magnitude - 1.0)


def _pool(density: float, viscosity: float) -> World:
    world = open_space()
    world.spawn(Transform((0.0, -5.0)), Shape.box(20.0, 10.0), Medium(density, viscosity=viscosity))
    return world


def _thrown_up(density: float) -> float:
    """Return what the energy of a cork changes by that is let go 2 m deep in a dense medium, as a share."""
    world = _pool(density, 0.0)
    world.spawn(Transform((0.0, -2.0)), Velocity(), Mass(1.0), Shape.circle(0.25))
    start = measure_energy(world)
    world.run(seconds=2.0)
    return abs(measure_energy(world).total - start.total) / start.potential["medium"]


def _sunk(viscosity: float) -> float:
    """Return the error of the speed at which a disc sinks in a viscous medium, as a share."""
    world, radius, mass = _pool(1.0, viscosity), 0.25, 10.0
    body = world.spawn(Transform((0.0, -2.0)), Velocity((1.0, 0.0)), Mass(mass), Shape.circle(radius))
    world.run(seconds=2.0)
    weight = 9.81 * (mass - math.pi * radius * radius)
    speed = -weight / (viscosity * 2.0 * math.pi * radius)
    return abs(world.component(body, Velocity).linear.y / speed - 1.0)


def _on_a_spring(world: World) -> None:
    parts = Transform((0.0, -0.5)), Velocity(), Mass(1.0), Drag(linear=4.0, quadratic=0.2)
    bob = world.spawn(*parts)
    world.spawn(Spring(a=bob, anchor_b=(0.0, 1.0 + 9.81 / 100.0), rest_length=1.0, stiffness=100.0))


def _afloat(world: World) -> None:
    world.spawn(Transform((0.0, -5.0)), Shape.box(20.0, 10.0), Medium(1000.0, viscosity=600.0))
    world.spawn(Transform((0.0, 0.05)), Velocity(), Mass(125.0), Shape.box(0.5, 0.5))


def _evaluations(build: Callable[[World], None]) -> float:
    """Return the most force evaluations in a second of 12, in which something comes to rest at the origin."""
    world, most, before = open_space(), 0, 0
    build(world)
    for _ in range(12):
        world.run(seconds=1.0)
        most, before = max(most, world.force_evaluations - before), world.force_evaluations
    return float(most)


_case = partial(StabilityCase, group="fields")
FIELDS = (
    *(
        _case(
            name=f"charges_{distance:g}m", title=f"two charges let go {distance:g} m from each other, 1 s",
            right="they part with what their energy gives", figure="error of their speed, as a share",
            limit=1e-9, measure=partial(_charges, distance),
        )
        for distance in (1e-3, 1e-6)
    ),
    *(
        _case(
            name=f"molecules_{depth:g}J", title=f"three molecules of {depth:g} J collide, 0.5 s",
            right="the energy stays", figure="change of energy, of their depth", limit=1e-6,
            measure=partial(_molecules, depth),
        )
        for depth in (1.0, 1e6)
    ),
    _case(
        name="magnetic_1000", title="charge in a magnetic field, 100 leapfrog steps of 1,000.1 turns each",
        right="the field does no work", figure="error of the speed, as a share", limit=1e-12,
        measure=partial(_turned, 1000.1),
    ),
    _case(
        name="cork_1e5", title="cork of 5 kg/m^2 let go 2 m deep in a medium of 10^5, 2 s",
        right="it leaves with the work of its lift", figure="change of energy, as a share", limit=1e-9,
        measure=partial(_thrown_up, 1e5),
    ),
    *(
        _case(
            name=f"sinks_{viscosity:g}", title=f"disc of 10 kg sinks in {viscosity:g} kg/(m s), 2 s",
            right="its weight is the drag", figure="error of its speed, as a share", limit=1e-9,
            measure=partial(_sunk, viscosity),
        )
        for viscosity in (100.0, 1e4)
    ),
    *(
        _case(
            name=f"rests_{name}", title=f"{words} comes to rest at the origin, 12 s", limit=20_000.0,
            right="steps go by what forces resolve", figure="most force evaluations in a second",
            measure=partial(_evaluations, build),
        )
        for name, words, build in (
            ("on_a_spring", "weight on a spring in air", _on_a_spring), ("afloat", "box afloat", _afloat),
        )
    ),
)  # fmt: skip
"""Fields close by, stiff, dense and strong."""


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


_chains = partial(StabilityCase, group="chains")


def _hung(prefix: str, scene: str, touches: bool) -> tuple[StabilityCase, StabilityCase]:
    title = f"chain of {scene}: 50 springs of 1e6 N/m, 0.1 kg each, 100 kg at the end"
    return (
        _chains(
            name=f"{prefix}_bounded", title=title, figure="farthest from the hook, of its length", limit=1.05,
            right="it swings and stays together: nothing is farther from the hook than the chain is long",
            measure=partial(_reach, touches),
        ),
        _chains(
            name=f"{prefix}_energy", title=title, figure="growth, of what the fall can give", limit=1e-6,
            right="energy never grows", measure=partial(_chain_growth, touches),
        ),
    )  # fmt: skip


CHAINS = (
    *_hung("chain", "points", touches=False),
    *_hung("chain_touching", "discs that touch others", touches=True),
    *(
        _chains(
            name=f"chain_modes_{ratio:g}", unit="m", limit=1e-6, measure=partial(_off_modes, ratio),
            title=f"chain of 100 springs between walls, every second mass {ratio:g} times the others, 2 s",
            right="it goes as its modes do", figure="farthest from there",
        )
        for ratio in (1.0, 1e3, 1e6)
    ),
    _chains(
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
