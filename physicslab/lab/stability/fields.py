"""Fields: charges and molecules close by, dense and viscous media, a strong magnetic field in long steps."""

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Charge, Drag, Mass, Medium, Molecule, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.config import PhysicsConfig
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import open_space
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
