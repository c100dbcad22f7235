"""Random scenes of crowds: mixed shapes and materials in a small box, springs, drag and damping."""

from __future__ import annotations

import random
from typing import Any

__all__ = ["crowd", "few"]

_INTEGRATORS = ("auto", "auto", "auto", "leapfrog", "symplectic_euler", "dop853", "implicit_midpoint")


def crowd(seed: int) -> dict[str, Any]:
    """Return the document of a scene: 1 to 120 bodies, most of them so near each other that they touch."""
    rng = random.Random(seed)
    count = rng.choice((rng.randint(1, 8), rng.randint(8, 30), rng.randint(30, 70), rng.randint(65, 120)))
    width = 0.32 * max(2, count) ** 0.5 * rng.uniform(0.9, 2.0)
    spread = rng.choice((0.0, 0.0, 0.3, 1.5))  # of masses: unlike ones take many small substeps
    bodies = [_body(rng, number, width, spread) for number in range(count)]
    movers = [body["id"] for body in bodies if "Velocity" in body and "Mass" in body]
    springs = [_spring(rng, movers, width) for _ in range(rng.choice((0, 0, 1, 3)))] if movers else []
    if rng.random() < 0.5:
        size = {"kind": "box", "width": 4.0 * width, "height": 1.0}
        bodies.insert(0, {"id": "floor", "Transform": {"position": [0.0, -0.5]}, "Shape": size})
    document = {"physics": _physics(rng, width), "simulation": _simulation(rng), "entities": bodies + springs}
    return {"format": "physicslab-scene/1", "name": f"crowd {seed}"} | document


def few(seed: int) -> dict[str, Any]:
    """Return the first crowd from a seed on of up to 12 bodies that move, which chooses how it is stepped."""
    document = crowd(seed)
    while sum("Velocity" in entity and "Mass" in entity for entity in document["entities"]) > 12:
        seed += 1
        document = crowd(seed)
    document["simulation"] |= {"sleeping": "auto", "integrator": "auto", "contacts": "auto"}
    return document


def _body(rng: random.Random, number: int, width: float, spread: float) -> dict[str, Any]:
    place = [rng.uniform(-0.5, 0.5) * width, rng.uniform(0.1, 1.0) * width]
    turned = rng.choice((0.0, 0.0, rng.uniform(-3.0, 3.0)))
    body: dict[str, Any] = {"id": f"b{number}", "Transform": {"position": place, "angle": turned}}
    if rng.random() < 0.9:
        speed = rng.choice((0.0, 0.5, 5.0))
        spin = rng.choice((0.0, rng.gauss(0.0, 4.0)))
        body["Velocity"] = {"linear": [rng.gauss(0.0, speed), rng.gauss(0.0, speed)], "angular": spin}
    if rng.random() < 0.95:
        body["Mass"] = {"mass": 10.0 ** rng.uniform(-spread, spread)}
        if rng.random() < 0.2:
            body["Mass"]["fixed_rotation"] = True
            body.get("Velocity", {})["angular"] = 0.0
    if rng.random() < 0.95:
        sizes = [0.28, rng.uniform(0.1, 0.5)]
        circle = {"kind": "circle", "radius": 0.5 * rng.choice(sizes)}
        box = {"kind": "box", "width": rng.choice(sizes), "height": rng.choice(sizes)}
        body["Shape"] = rng.choice((circle, box))
    if rng.random() < 0.8:
        bounciness, friction = (
            rng.choice((0.0, 0.3, 0.8, 1.0, rng.random())),
            rng.choice((0.0, 0.3, 0.6, 10.0)),
        )
        body["Material"] = {"restitution": bounciness, "friction": friction}
    if rng.random() < 0.05 and "Mass" in body:
        body["Drag"] = {"linear": rng.uniform(0.0, 3.0), "quadratic": rng.uniform(0.0, 3.0)}
    return body


def _spring(rng: random.Random, movers: list[str], width: float) -> dict[str, Any]:
    a, b = rng.choice(movers), rng.choice(movers)
    end: dict[str, Any] = {"b": b} if a != b else {"anchor_b": [rng.uniform(-0.5, 0.5) * width, width]}
    stiffness, damping = rng.choice((5.0, 50.0, 5000.0)), rng.choice((0.0, 0.0, 0.5))
    numbers = {"rest_length": rng.uniform(0.0, 1.0), "stiffness": stiffness, "damping": damping}
    return {"Spring": {"a": a, "anchor_a": rng.choice(([0.0, 0.0], [0.1, 0.05]))} | end | numbers}


def _physics(rng: random.Random, width: float) -> dict[str, Any]:
    physics: dict[str, Any] = {"gravity_mode": rng.choice(("linear", "linear", "linear", "planet", "none"))}
    if physics["gravity_mode"] == "planet":
        physics |= {"softening": 0.1, "softening_law": rng.choice(("clamp", "plummer"))}
    if rng.random() < 0.7:
        physics["bounds"] = [-0.55 * width, 0.0, 0.55 * width, 1.2 * width]
        physics |= {"bounds_restitution": rng.random(), "bounds_friction": rng.random()}
    for name in ("linear_damping", "angular_damping"):
        if rng.random() < 0.15:
            physics[name] = rng.choice((0.1, 5.0))
    return physics


def _simulation(rng: random.Random) -> dict[str, Any]:
    return {
        "dt": rng.choice((1 / 60, 1 / 60, 1 / 120, 1 / 240)), "substeps": rng.choice((1, 2, 4, 4, 8)),
        "iterations": rng.choice((None, None, 1, 3)), "integrator": rng.choice(_INTEGRATORS),
        "sleeping": rng.random() < 0.8, "collisions": rng.choice(("auto", "auto", "step", "exact")),
        "tolerance": rng.choice((1e-12, 1e-8)),
    }  # fmt: skip
