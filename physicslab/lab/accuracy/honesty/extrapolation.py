"""Smooth motion by another method, in 64 bits of mantissa where there are so many: Gragg, Bulirsch and Stoer.

It shares nothing with the integrators that it judges: neither the method nor the code of the forces.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.variants import Document

type Long = NDArray[np.longdouble]
"""An array of long floats, a point a row (n, 2) [m], [m/s]."""

_COLUMNS = 9
"""Rows of the table of extrapolation: the order is twice that."""
_TOLERANCE = 1e-16
_LEAST = 1e-9
"""Places [m] and velocities [m/s] smaller than this are right to a share of this."""
_G, _DOWN = 1.0, (0.0, -9.81)
"""The defaults of scenes."""


def moved(document: Document, seconds: float) -> NDArray[np.float64]:
    """Return the states (n, 6) of points after some time [s], under gravity, springs and drag."""
    points = [entity for entity in document["entities"] if "Mass" in entity]
    places, velocities = (
        np.array([entity[kind][name] for entity in points], np.longdouble)
        for kind, name in (("Transform", "position"), ("Velocity", "linear"))
    )
    q, v = extrapolated(_accelerations(document, points), places, velocities, seconds)
    found = np.zeros((len(points), 6))
    found[:, :2], found[:, 3:5] = q, v
    return found


def passed(document: Document, seconds: float) -> NDArray[np.float64]:
    """Return the states (2, 6) of two points that attract each other, in closed form.

    Kepler's equation in a universal variable s, with r ds = dt: steps lose what a close passage magnifies,
    as much as six digits.
    """
    mass, place, velocity = (
        np.array([entity[kind][name] for entity in document["entities"]], np.longdouble)
        for kind, name in (("Mass", "mass"), ("Transform", "position"), ("Velocity", "linear"))
    )
    total = mass.sum()
    mu, apart, rate = _G * total, place[1] - place[0], velocity[1] - velocity[0]
    far, radial = np.sqrt(apart @ apart), apart @ rate
    root = np.sqrt(np.clongdouble(rate @ rate - 2 * mu / far))  # of twice the energy, negative on an ellipse
    s = np.longdouble(seconds) / far
    for _ in range(200):
        c1, c2 = (np.sinh(root * s) / root).real, (2 * (np.sinh(root * s / 2) / root) ** 2).real
        c3 = ((c1 - s) / root**2).real
        distance = far * np.cosh(root * s).real + radial * c1 + mu * c2
        change = (far * c1 + radial * c2 + mu * c3 - seconds) / distance
        s -= np.clip(change, -1 / abs(root), 1 / abs(root))
        if abs(change) < 1e-18 * abs(s):
            break
    f, g = 1 - mu * c2 / far, seconds - mu * c3
    df, dg = -mu * c1 / (distance * far), 1 - mu * c2 / distance
    centre, drift = mass @ place / total, mass @ velocity / total
    shares = np.array([-mass[1], mass[0]])[:, None] / total
    found = np.zeros((2, 6))
    found[:, :2] = centre + seconds * drift + shares * (f * apart + g * rate)
    found[:, 3:5] = drift + shares * (df * apart + dg * rate)
    return found


def extrapolated(
    accelerate: Callable[[Long, Long], Long], q: Long, v: Long, seconds: float
) -> tuple[Long, Long]:
    """Return places and velocities, of any shape, after some time [s]."""
    left, h = np.longdouble(seconds), np.longdouble(seconds) / 16
    reach_q = reach_v = _LEAST
    while left > 0:
        h = min(h, left)
        reach_q, reach_v = max(reach_q, float(np.abs(q).max())), max(reach_v, float(np.abs(v).max()))
        table: list[tuple[Long, Long]] = []
        for column in range(1, _COLUMNS + 1):
            row = [_midpoint(accelerate, q, v, h, 2 * column)]
            for k, (below_q, below_v) in enumerate(table):
                factor = (np.longdouble(column) / (column - 1 - k)) ** 2 - 1
                last_q, last_v = row[-1]
                row.append((last_q + (last_q - below_q) / factor, last_v + (last_v - below_v) / factor))
            table = row
        (one_q, one_v), (other_q, other_v) = table[-1], table[-2]
        error = max(
            float(np.abs(one_q - other_q).max()) / reach_q, float(np.abs(one_v - other_v).max()) / reach_v
        )
        if error <= _TOLERANCE or h < 1e-9 * seconds:
            q, v, left = one_q, one_v, left - h
        h *= min(2.0, max(0.2, 0.8 * (_TOLERANCE / max(error, 1e-30)) ** (1.0 / (2 * _COLUMNS - 1))))
    return q, v


def _midpoint(
    accelerate: Callable[[Long, Long], Long], q: Long, v: Long, span: np.longdouble, steps: int
) -> tuple[Long, Long]:
    """Return the state after a span by Gragg's rule, whose error is a series in even powers of its steps."""
    h = np.longdouble(span / steps)
    old_q, old_v = q, v
    new_q, new_v = q + h * v, v + h * accelerate(q, v)
    for _ in range(steps - 1):
        a = accelerate(new_q, new_v)
        old_q, old_v, new_q, new_v = new_q, new_v, old_q + 2 * h * new_v, old_v + 2 * h * a
    a = accelerate(new_q, new_v)
    half = np.longdouble(0.5)
    return half * (old_q + new_q + h * new_v), half * (old_v + new_v + h * a)


def _accelerations(document: Document, points: list[dict[str, object]]) -> Callable[[Long, Long], Long]:
    """Return what accelerates the points of a scene, as the contract has its laws."""
    physics, number = document["physics"], {entity["id"]: n for n, entity in enumerate(points)}
    mass = np.array([entity["Mass"]["mass"] for entity in points], np.longdouble)[:, None]  # type: ignore[index]
    springs = [entity["Spring"] for entity in document["entities"] if "Spring" in entity]
    drags = [(number[e["id"]], e["Drag"]) for e in document["entities"] if "Drag" in e]
    mode = physics.get("gravity_mode", "linear")
    down = np.array(physics.get("gravity", _DOWN), np.longdouble)
    strength, soft = np.longdouble(physics.get("G", _G)), np.longdouble(physics.get("softening", 0.0))

    def accelerate(q: Long, v: Long) -> Long:
        force = mass * down if mode == "linear" else np.zeros_like(q)
        if mode == "planet":
            apart = q[None, :] - q[:, None]
            square = (apart**2).sum(axis=2) + soft**2 + np.eye(len(q), dtype=np.longdouble)
            force += (
                strength * mass * (mass[None, :] * apart / (square * np.sqrt(square))[..., None]).sum(axis=1)
            )
        for spring in springs:
            a, b = number[spring["a"]], number.get(spring.get("b"))
            end = np.array(spring["anchor_b"], np.longdouble) if b is None else q[b]
            speed = v[a] if b is None else v[a] - v[b]
            line = q[a] - end
            length = np.sqrt((line**2).sum())
            pull = spring["stiffness"] * (length - np.longdouble(spring["rest_length"]))
            pull += spring.get("damping", 0.0) * (speed * line).sum() / length
            force[a] -= pull * line / length
            if b is not None:
                force[b] += pull * line / length
        for n, drag in drags:
            speed = np.sqrt((v[n] ** 2).sum())
            force[n] -= (drag.get("linear", 0.0) + drag.get("quadratic", 0.0) * speed) * v[n]
        return force / mass

    return accelerate
