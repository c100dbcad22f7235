"""Random scenes in which forces alone act: springs, nets, orbits, flybys, drag."""

import math
from functools import partial
from random import Random
from typing import Any

from physicslab.lab.accuracy.honesty.extrapolation import moved, passed
from physicslab.lab.accuracy.honesty.scene import KnownScene, between, body, spring, written

_PLANETS = {"gravity_mode": "planet", "softening_law": "plummer", "G": 1.0}


def _known(document: dict[str, Any], seconds: float) -> KnownScene:
    return KnownScene(document, seconds, partial(moved, document, seconds))


def springs(draw: Random) -> KnownScene:
    """Return a bob that swings, or two that turn about each other, on a spring, by any method."""
    stiffness, mass = between(draw, 10.0, 3e4), draw.uniform(0.5, 2.0)
    rate = math.sqrt(2.0 * stiffness / mass)
    dt = between(draw, 1 / 240, 1 / 20)
    methods = ("auto", "auto", "auto", "leapfrog", "rk4", "blanes_moan", "implicit_midpoint")
    method = draw.choice(methods if rate * dt < 2.0 else methods[:3])
    speed = draw.uniform(1.0, 6.0)
    fields = {"rest_length": 1.0, "stiffness": stiffness}
    if draw.random() < 0.5:
        entities = [
            body("b", (draw.uniform(0.9, 1.1), 0.0), velocity=(0.0, speed), mass=mass),
            spring("s", "b", anchor_b=[0.0, 0.0], **fields),
        ]
        physics: dict[str, Any] = {}
    else:
        entities = [
            body("b", (draw.uniform(0.95, 1.05), 0.0), velocity=(0.3, speed), mass=mass),
            body("c", (0.0, 0.0), velocity=(0.0, -speed), mass=mass),
            spring("s", "b", b="c", **fields),
        ]
        physics = {"gravity_mode": "none"}
    seconds = draw.uniform(1.0, min(6.0, 400.0 / rate))
    return _known(written(entities, dt, physics, integrator=method), seconds)


def net(draw: Random) -> KnownScene:
    """Return a chain of masses between two walls, damped or not."""
    count, dt = draw.randint(2, 4), between(draw, 1 / 240, 1 / 15)
    damping = draw.choice((0.0, draw.uniform(0.1, 5.0)))
    entities = [
        body(f"b{n}", (n + 1.0, draw.uniform(-0.3, 0.3)), velocity=(draw.gauss(), draw.gauss()))
        for n in range(count)
    ]
    fields = {
        "rest_length": draw.uniform(0.5, 1.0),
        "stiffness": between(draw, 20.0, 5e3),
        "damping": damping,
    }
    links = [spring(f"s{n}", f"b{n}", b=f"b{n + 1}", **fields) for n in range(count - 1)]
    ends = [
        spring("left", "b0", anchor_b=[0.0, 0.0], **fields),
        spring("right", f"b{count - 1}", anchor_b=[count + 1.0, 0.0], **fields),
    ]
    return _known(written([*entities, *links, *ends], dt), draw.uniform(0.5, 2.0))


def orbit(draw: Random) -> KnownScene:
    """Return one to three light bodies about a heavy one, on ellipses."""
    entities = [body("star", (0.0, 0.0), mass=1.0)]
    for n in range(draw.randint(1, 3)):
        far, angle = 1.0 + 0.8 * n, draw.uniform(0.0, 2.0 * math.pi)
        speed = math.sqrt(draw.uniform(0.1, 1.2) / far)
        entities.append(
            body(f"p{n}", (far * math.cos(angle), far * math.sin(angle)), mass=between(draw, 1e-6, 1e-2),
                 velocity=(-speed * math.sin(angle), speed * math.cos(angle)))
        )  # fmt: skip
    method = draw.choice(("auto", "auto", "auto", "leapfrog"))
    physics = {**_PLANETS, "softening": draw.choice((0.0, 0.0, 0.05 if method == "auto" else 0.2))}
    document = written(entities, between(draw, 1 / 240, 1 / 20), physics, integrator=method)
    seconds = draw.uniform(3.0, 15.0)
    two = len(entities) == 2 and not physics["softening"]
    return KnownScene(document, seconds, partial(passed if two else moved, document, seconds))


def flyby(draw: Random) -> KnownScene:
    """Return a body that passes a heavy one closely, and goes off again."""
    entities = [
        body("star", (0.0, 0.0), mass=1.0),
        body("p", (-draw.uniform(2.0, 8.0), between(draw, 0.03, 1.0)), mass=between(draw, 1e-12, 0.5),
             velocity=(draw.uniform(0.5, 2.0), 0.0)),
    ]  # fmt: skip
    document, seconds = written(entities, between(draw, 1 / 240, 1 / 20), _PLANETS), draw.uniform(6.0, 14.0)
    return KnownScene(document, seconds, partial(passed, document, seconds))


def drag(draw: Random) -> KnownScene:
    """Return one to three bodies that are thrown, through air that holds them back; some on a spring."""
    entities: list[dict[str, Any]] = []
    for n in range(draw.randint(1, 3)):
        resistance = {
            "linear": draw.choice((0.0, between(draw, 0.01, 3.0))),
            "quadratic": between(draw, 1e-3, 1.0),
        }
        entities.append(
            body(f"b{n}", (2.0 * n, 0.0), velocity=(draw.gauss(0.0, 20.0), draw.gauss(0.0, 20.0)),
                 mass=between(draw, 0.1, 10.0), Drag=resistance)
        )  # fmt: skip
        if draw.random() < 0.3:
            fields = {"anchor_b": [2.0 * n, 3.0], "rest_length": 1.0, "stiffness": between(draw, 5.0, 500.0)}
            entities.append(spring(f"s{n}", f"b{n}", **fields))
    return _known(written(entities, between(draw, 1 / 240, 1 / 10)), draw.uniform(0.5, 3.0))
