"""Random scenes of bodies that touch, whose outcome has a closed form or comes from impact to impact."""

import math
from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.honesty.scene import KnownScene, State, between, body, spring, still, written
from physicslab.lab.closed_forms import rolled, slid

_G = 9.81
_MAX_SCAN = 20_000
"""Parts of a flight in which the first corner that strikes is looked for."""


def _dt(draw: Random) -> float:
    return draw.choice((1 / 60, 1 / 60, between(draw, 1 / 480, 1 / 12)))


def _of(*states: State) -> Callable[[], NDArray[np.float64]]:
    return lambda: np.array(states)


def edge(draw: Random) -> KnownScene:
    """Return a disc that slides over the edge of a table without friction, or rolls off and flies."""
    radius, way = draw.uniform(0.05, 0.5), draw.uniform(0.1, 0.8)
    least = math.sqrt(_G * radius)
    rolls = draw.random() < 0.3
    speed = least * (draw.uniform(1.05, 2.0) if rolls else draw.uniform(0.3, 1.6))
    friction, spin = (0.8, -speed / radius) if rolls else (0.0, 0.0)
    reached, turned, pivoted = way / speed, 0.0, 0.0
    x, y, vx, vy = 0.0, radius, speed, 0.0
    if speed < least:
        # It turns about the corner, by theta'^2 = (v/r)^2 + 2 g/r (1 - cos theta), until that pushes no more.
        turned = math.acos((speed**2 / (_G * radius) + 2.0) / 3.0)
        nodes, weights = np.polynomial.legendre.leggauss(60)
        angles = 0.5 * turned * (nodes + 1.0)
        rates = np.sqrt((speed / radius) ** 2 + 4.0 * _G / radius * np.sin(0.5 * angles) ** 2)
        pivoted = float(0.5 * turned * (weights / rates).sum())
        rate = math.sqrt((speed / radius) ** 2 + 4.0 * _G / radius * math.sin(0.5 * turned) ** 2)
        x, y = radius * math.sin(turned), radius * math.cos(turned)
        vx, vy = radius * rate * math.cos(turned), -radius * rate * math.sin(turned)
    flown = draw.uniform(0.05, 0.5)
    seconds = reached + pivoted + flown
    place = (x + vx * flown, y + vy * flown - 0.5 * _G * flown**2)
    bodies = [
        still("table", (-5.0, -0.5), (10.0, 1.0), friction=friction),
        body("b", (-way, radius), velocity=(speed, 0.0), spin=spin, radius=radius, friction=friction),
    ]
    return KnownScene(
        written(bodies, _dt(draw)), seconds, _of((*place, spin * seconds, vx, vy - _G * flown, spin))
    )


def belt(draw: Random) -> KnownScene:
    """Return a block on a belt, free or on a spring: it slips, and comes along where it is as fast."""
    friction, speed, mass = draw.uniform(0.1, 0.8), draw.uniform(0.1, 3.0), draw.uniform(0.5, 3.0)
    push, seconds = friction * _G, draw.uniform(0.5, 3.0)
    block = body("b", (0.0, 0.25), size=(0.5, 0.5), mass=mass, friction=friction)
    driven = still("belt", (0.0, -0.5), (60.0, 1.0), friction=friction, velocity=(speed, 0.0))
    moved: State = (speed * seconds, -0.5, 0.0, speed, 0.0, 0.0)
    bodies = [driven, block]
    if draw.random() < 0.5:
        behind, slower = slid(speed, push, seconds)  # seen from the belt
        x, vx = speed * seconds - behind, speed - slower
    else:
        stiffness = between(draw, 3.0, 100.0)
        omega = math.sqrt(stiffness / mass)
        far = push / omega**2
        bodies.append(spring("s", "b", anchor_b=[-2.0, 0.25], rest_length=2.0, stiffness=stiffness))
        sticks = math.asin(speed / (far * omega)) / omega if speed < far * omega else math.inf
        along = far * (1.0 - math.cos(omega * sticks)) if sticks < math.inf else 0.0
        slips = sticks + (far - along) / speed
        if seconds < sticks:
            x, vx = far * (1.0 - math.cos(omega * seconds)), far * omega * math.sin(omega * seconds)
        elif seconds < slips:
            x, vx = along + speed * (seconds - sticks), speed
        else:
            phase = omega * (seconds - slips)
            x, vx = far + speed / omega * math.sin(phase), speed * math.cos(phase)
    return KnownScene(written(bodies, _dt(draw)), seconds, _of(moved, (x, 0.25, 0.0, vx, 0.0, 0.0)))


def slope(draw: Random) -> KnownScene:
    """Return a block that slides down a slope, to its stop or on, or a disc that slips and then rolls."""
    angle, friction, speed = draw.uniform(0.05, 0.9), draw.uniform(0.02, 0.9), draw.uniform(0.0, 4.0)
    seconds, size = draw.uniform(0.3, 1.5), draw.uniform(0.2, 1.0)
    down, held = _G * math.sin(angle), friction * _G * math.cos(angle)
    along, out = (-math.cos(angle), -math.sin(angle)), (-math.sin(angle), math.cos(angle))
    plane = still(
        "slope", (0.5 * math.sin(angle), -0.5 * math.cos(angle)), (80.0, 1.0), angle=angle, friction=friction
    )
    if draw.random() < 0.5:
        rises = 0.25 * size
        shape: dict[str, Any] = {"size": (size, 2.0 * rises), "angle": angle}
        way, rate = slid(speed, held - down, seconds)
        turned, spin = angle, 0.0
    else:
        rises, shape = 0.5 * size, {"radius": 0.5 * size}
        way, rate, rim, turns = rolled(speed, held, seconds, pull=down)
        turned, spin = rim / rises, turns / rises  # down is to the left, so that it turns counter-clockwise
    start = np.multiply(rises, out)
    block = body("b", tuple(start.tolist()), velocity=(speed * along[0], speed * along[1]), friction=friction,
                 **shape)  # fmt: skip
    end = (*(start + np.multiply(way, along)).tolist(), turned, rate * along[0], rate * along[1], spin)
    return KnownScene(written([plane, block], _dt(draw)), seconds, _of(end))


def bounce(draw: Random) -> KnownScene:
    """Return a box that spins and bounces on its corners, without friction, until between two impacts."""
    width, height = draw.uniform(0.2, 1.0), draw.uniform(0.2, 1.0)
    restitution, mass = draw.uniform(0.2, 1.0), draw.uniform(0.5, 5.0)
    start: State = (
        0.0, math.hypot(width, height) / 2.0 + draw.uniform(0.1, 1.5), draw.uniform(0.0, 3.0),
        draw.gauss(0.0, 2.0), draw.uniform(-3.0, 1.0), draw.gauss(0.0, 5.0),
    )  # fmt: skip
    state, elapsed, impacts = start, 0.0, draw.randint(0, 3)
    inertia = mass * (width**2 + height**2) / 12.0
    for n in range(impacts + 1):
        found = _next_impact(state, width, height)
        if found is None or n == impacts:
            break
        after, arm = found
        state = _flown(state, after)
        elapsed += after
        closing = state[4] + state[5] * arm
        impulse = -(1.0 + restitution) * closing / (1.0 / mass + arm**2 / inertia)
        state = (*state[:4], state[4] + impulse / mass, state[5] + arm * impulse / inertia)
    rest = draw.uniform(0.2, 0.8) * (0.3 if found is None else found[0])
    bodies = [
        still("floor", (0.0, -0.5), (100.0, 1.0), restitution=restitution),
        body("b", start[:2], angle=start[2], velocity=start[3:5], spin=start[5], size=(width, height),
             mass=mass, restitution=restitution),
    ]  # fmt: skip
    return KnownScene(written(bodies, _dt(draw)), elapsed + rest, _of(_flown(state, rest)))


def _flown(state: State, t: float) -> State:
    x, y, angle, vx, vy, spin = state
    return x + vx * t, y + vy * t - 0.5 * _G * t**2, angle + spin * t, vx, vy - _G * t, spin


def _next_impact(state: State, width: float, height: float) -> tuple[float, float] | None:
    """Return when a corner of a box strikes y = 0 next [s], and how far beside its middle that is [m]."""
    _, y, angle, _, vy, spin = state
    reach, own = 0.5 * math.hypot(width, height), math.atan2(height, width)
    corners = np.array([own, math.pi - own, own - math.pi, -own])
    longest = (vy + math.sqrt(max(0.0, vy**2 + 2.0 * _G * (y + reach)))) / _G
    times = np.linspace(0.0, longest, _MAX_SCAN)[1:]

    def heights(t: float | NDArray[np.float64]) -> NDArray[np.float64]:
        t = np.asarray(t)[..., None]
        found: NDArray[np.float64] = y + vy * t - 0.5 * _G * t**2 + reach * np.sin(angle + spin * t + corners)
        return found

    low = heights(times).min(axis=1)
    below = np.flatnonzero((low[1:] <= 0.0) & (low[:-1] > 0.0))
    if not len(below):
        return None
    t = float(times[below[0] + 1])
    corner = int(heights(t).argmin())
    for _ in range(20):
        phase = angle + spin * t + corners[corner]
        rate = vy - _G * t + reach * spin * math.cos(phase)
        t -= float(heights(t)[corner]) / rate
    return t, reach * math.cos(angle + spin * t + corners[corner])


def fall(draw: Random) -> KnownScene:
    """Return a box or disc that falls on a floor, or lies on it, tiny to large, in short and long steps."""
    size, gravity = between(draw, 1e-5, 2.0), draw.choice((_G, _G, between(draw, 1.0, 1e3)))
    dt = draw.choice((1 / 60, between(draw, 1e-3, 1.0)))
    restitution = draw.choice((0.0, 0.0, draw.uniform(0.1, 0.9)))
    high = draw.choice((0.0, size * between(draw, 0.1, 100.0)))
    seconds, thick = dt * draw.randint(3, 40), size * between(draw, 1.0, 100.0)
    left, speed = seconds - math.sqrt(2.0 * high / gravity), restitution * math.sqrt(2.0 * gravity * high)
    y, vy = high - 0.5 * gravity * seconds**2, -gravity * seconds
    if left >= 0.0:
        while speed > 1e-9 and left > 2.0 * speed / gravity:
            left, speed = left - 2.0 * speed / gravity, speed * restitution
        flies = speed > 1e-9
        y, vy = (speed * left - 0.5 * gravity * left**2, speed - gravity * left) if flies else (0.0, 0.0)
    shape = {"radius": 0.5 * size} if draw.random() < 0.5 else {"size": (size, size)}
    bodies = [
        still("floor", (0.0, -0.5 * thick), (1000.0 * size, thick), restitution=restitution, friction=0.5),
        body("b", (0.0, 0.5 * size + high), restitution=restitution, friction=0.5, **shape),
    ]  # fmt: skip
    document = written(bodies, dt, {"gravity": [0.0, -gravity]})
    return KnownScene(document, seconds, _of((0.0, 0.5 * size + y, 0.0, 0.0, vy, 0.0)))


def stack(draw: Random) -> KnownScene:
    """Return boxes that lie on each other, a little aside, equal or heavier and heavier: they stay."""
    count, size, friction = draw.randint(1, 6), between(draw, 0.02, 2.0), draw.uniform(0.2, 0.9)
    ratio = draw.choice((1.0, between(draw, 0.2, 5.0)))
    bodies = [still("floor", (0.0, -0.5), (50.0, 1.0), friction=friction)]
    bodies += [
        body(f"b{n}", (size * draw.uniform(-0.05, 0.05), (n + 0.5) * size), size=(size, size), mass=ratio**n,
             friction=friction)
        for n in range(count)
    ]  # fmt: skip
    document = written(bodies, _dt(draw), contacts=draw.choice(("auto", "auto", "soft")), sleeping=False)
    truth = [(*box["Transform"]["position"], 0.0, 0.0, 0.0, 0.0) for box in bodies[1:]]
    return KnownScene(document, draw.uniform(0.5, 3.0), _of(*truth))


def crowd(draw: Random) -> KnownScene:
    """Return 13 to 16 blocks side by side, too many for rigid contacts, that slide to their stops."""
    friction, seconds = draw.uniform(0.1, 0.8), draw.uniform(0.5, 2.0)
    bodies, truth = [still("floor", (50.0, -0.5), (400.0, 1.0), friction=friction)], []
    for n in range(draw.randint(13, 16)):
        size, speed = draw.uniform(0.2, 1.0), draw.uniform(0.0, 3.0)
        start = (8.0 * n, 0.25 * size)
        bodies.append(body(f"b{n}", start, velocity=(speed, 0.0), size=(size, 0.5 * size), friction=friction))
        way, left = slid(speed, friction * _G, seconds)
        truth.append((start[0] + way, start[1], 0.0, left, 0.0, 0.0))
    return KnownScene(written(bodies, _dt(draw)), seconds, _of(*truth))
