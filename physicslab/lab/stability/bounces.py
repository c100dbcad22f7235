"""Elastic collisions that go on for long."""

from __future__ import annotations

import math
from functools import partial

from physicslab.components import Spring, Transform
from physicslab.diagnostics.energy import measure_energy
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, energy_change, floor, largest, open_space
from physicslab.prefabs import circle
from physicslab.scenes import SCENES
from physicslab.world import World

__all__ = ["BOUNCES"]

_RADIUS = 0.25
_HEIGHT = 5.0
_CRADLE_LENGTH = 3.0


def _apex_error(seconds: float, collisions: str) -> float:
    """Return how far the apex of a ball with e = 1 departs from where it was let go, of the height."""
    world = open_space(collisions=collisions)
    floor(world, restitution=1.0)
    circle(world, (0.0, _HEIGHT + _RADIUS), radius=_RADIUS, restitution=1.0)
    start = measure_energy(world).total

    def apex() -> float:  # where the energy would carry it, were it to rise now
        return abs(measure_energy(world).total - start) / (GRAVITY * _HEIGHT)

    return largest(world, round(seconds * 60.0), apex)


def _gas_energy(steps: int) -> float:
    return energy_change(SCENES["gas"].build(), steps, every=50)


def _cradle_amplitude(seconds: float, damping: float) -> float:
    """Return by how much the swing of the outer balls differs at the end, as a share of the first."""
    world = SCENES["newtons_cradle"].build()
    _set_damping(world, damping)
    balls = [world.component(world.entity(f"ball {i}"), Transform) for i in (1, 5)]
    rests = [ball.position.x for ball in balls]
    rests[0] = -rests[1]  # the first is held aside at the start
    period = 2.0 * math.pi * math.sqrt(_CRADLE_LENGTH / GRAVITY)
    steps = round(seconds * 60.0)
    last = round(1.2 * period * 60.0)
    first = rests[0] - balls[0].position.x
    world.run(steps=steps - last)

    def swing() -> float:
        return max(rests[0] - balls[0].position.x, balls[1].position.x - rests[1])

    return abs(largest(world, last, swing) / first - 1.0)


def _set_damping(world: World, damping: float) -> None:
    for entity in world.entities():
        if world.has(entity, Spring):
            world.component(entity, Spring).damping = damping


def _ball(seconds: float, collisions: str) -> StabilityCase:
    how = "" if collisions == "auto" else ", collisions within steps"
    return StabilityCase(
        name=f"ball_{seconds:g}s" if collisions == "auto" else f"ball_{seconds:g}s_step",
        title=f"ball with e = 1 dropped from 5 m, {seconds:g} s{how}", group="bounces",
        right="the apex stays where it was let go, within 0.1 %", figure="change of the apex, of the height",
        limit=0.001, measure=partial(_apex_error, seconds, collisions),
    )  # fmt: skip


BOUNCES = [
    *(_ball(seconds, collisions) for collisions in ("auto", "step") for seconds in (60.0, 200.0)),
    StabilityCase(
        name="gas_energy", title="gas of 2,000 elastic discs, 10,000 steps", group="bounces",
        right="energy is kept within 0.2 %", figure="largest change of energy", limit=0.002,
        measure=partial(_gas_energy, 10_000), long_s=4.0,
    ),
    StabilityCase(
        name="cradle_amplitude", title="Newton's cradle, 60 s, strings that take nothing away",
        group="bounces", right="the outer balls swing as far as at the start, within 1 %",
        figure="change of the amplitude", limit=0.01, measure=partial(_cradle_amplitude, 60.0, 0.0),
    ),
    StabilityCase(
        name="cradle_amplitude_damped", title="Newton's cradle as the built-in scene has it, 60 s",
        group="bounces", right="the outer balls swing as far as at the start, within 1 %",
        figure="change of the amplitude", limit=0.01, measure=partial(_cradle_amplitude, 60.0, 20.0),
    ),
]  # fmt: skip
