"""Hostile values and scene documents for the fuzz tests: mostly valid, with a few mutations each."""

from __future__ import annotations

import copy
import math
from typing import Any

from hypothesis import strategies as st

from physicslab.ecs.config import INTEGRATORS

__all__ = ["EXTREME", "HOSTILE", "NAMES", "PLAIN", "scenes"]

EXTREME = st.sampled_from(
    [
        0, -0.0, 1, -1, 0.5, 5e-324, 1e-320, 1e-300, 1e-160, 1e-30, 1e-9, 1e9, 1e30, 1e149, 1e155, 1e299,
        1e300, 1.7e308, -1e308, 2**63, 2**63 - 1, -(2**63),
    ]
)  # fmt: skip
"""Numbers, most of which are legal and none of which anybody means."""
NAMES = st.sampled_from(
    [
        "", " ", "a", "--json", "-", "a\nb", "\x1b[2J", "\x00", "\u202eb", "\ud800", "\U0001f600", "e\u0301",
        "x" * 5000, "1",
    ]
)  # fmt: skip
"""Ids: empty, like an option, of several lines, half a character, very long."""
PLAIN = st.floats(-10.0, 10.0) | st.integers(-10, 10)
"""Numbers that people mean."""
HOSTILE: st.SearchStrategy[Any] = st.one_of(
    EXTREME,
    st.sampled_from([math.nan, math.inf, -math.inf, 10**400, True, False, None]),
    NAMES,
    st.builds(list, st.lists(EXTREME, max_size=4)),
    st.sampled_from([[], {}, [[0, 0]], [None, None], ["0", "0"], {"x": 1}, [1e308, -1e308], [math.nan, 0]]),
)
"""Values of any type."""

_POSITIVE = st.floats(0.01, 10.0)
_SHAPES = st.one_of(
    st.fixed_dictionaries({"kind": st.just("circle"), "radius": _POSITIVE}),
    st.fixed_dictionaries({"kind": st.just("box"), "width": _POSITIVE, "height": _POSITIVE}),
)
_SPRINGS = st.fixed_dictionaries(
    {"a": st.sampled_from("abc")},
    optional={
        "b": st.sampled_from("abc"), "anchor_a": st.tuples(PLAIN, PLAIN).map(list), "rest_length": _POSITIVE,
        "stiffness": st.floats(0.0, 1e4), "damping": st.floats(0.0, 10.0),
    },
)  # fmt: skip
_BODIES = st.fixed_dictionaries(
    {"Transform": st.fixed_dictionaries({"position": st.tuples(PLAIN, PLAIN).map(list), "angle": PLAIN})},
    optional={
        "Velocity": st.fixed_dictionaries({"linear": st.tuples(PLAIN, PLAIN).map(list), "angular": PLAIN}),
        "Mass": st.fixed_dictionaries(
            {"mass": _POSITIVE}, optional={"inertia": _POSITIVE, "fixed_rotation": st.just(False)}
        ),
        "Shape": _SHAPES,
        "Material": st.fixed_dictionaries({"restitution": st.floats(0, 1), "friction": st.floats(0, 2)}),
        "Drag": st.just({}),
        "Trail": st.just({"length": 1.0}),
    },
)
_PHYSICS = st.fixed_dictionaries(
    {},
    optional={
        "gravity_mode": st.sampled_from(["linear", "planet", "none"]),
        "gravity": st.tuples(PLAIN, PLAIN).map(list),
        "G": PLAIN, "softening": _POSITIVE, "softening_law": st.sampled_from(["clamp", "plummer"]),
        "linear_damping": _POSITIVE, "angular_damping": _POSITIVE,
        "bounds": st.sampled_from([None, [-20, -20, 20, 20], [20, 20, -20, -20], [0, 0, 0, 0]]),
        "bounds_restitution": st.floats(0, 1), "bounds_friction": _POSITIVE,
    },
)  # fmt: skip
_SIMULATION = st.fixed_dictionaries(
    {},
    optional={
        "dt": st.floats(1e-4, 0.1), "substeps": st.integers(1, 8), "iterations": st.integers(1, 4),
        "integrator": st.sampled_from(INTEGRATORS),
        "sleeping": st.booleans(), "collisions": st.sampled_from(["auto", "step", "exact"]),
        "tolerance": st.floats(1e-18, 1e-6),
    },
)  # fmt: skip
_KEYS = st.sampled_from(
    ["Spring", "Mass", "Velocity", "id", "time", "contacts", "rests", "solver", "angular"]
)


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a scene document: a valid one, to which at most three things were done."""
    entities: list[dict[str, Any]] = []
    for id_ in "abc":
        body: dict[str, Any] = draw(_BODIES)
        entities.append({"id": id_, **body})
    for spring in draw(st.lists(_SPRINGS, max_size=2)):
        entities.append({"Spring": spring})
    document: dict[str, Any] = {
        "format": "physicslab-scene/1", "name": "fuzz", "physics": draw(_PHYSICS),
        "simulation": draw(_SIMULATION), "entities": entities,
    }  # fmt: skip
    document = copy.deepcopy(document)  # strategies may hand out the same object twice
    for _ in range(draw(st.integers(0, 3))):
        _mutate(draw, document)
    return document


def _mutate(draw: st.DrawFn, document: dict[str, Any]) -> None:
    """Change one thing: a value becomes extreme or absurd, goes or comes; or an entity is copied."""
    containers = _containers(document)
    where = containers[draw(st.integers(0, len(containers) - 1))]
    what = draw(st.sampled_from(["extreme", "extreme", "extreme", "hostile", "drop", "key", "copy"]))
    keys: list[Any] = list(where) if isinstance(where, dict) else list(range(len(where)))
    if what == "copy":
        entities = document.get("entities")
        if isinstance(entities, list) and entities:
            entities.append(copy.deepcopy(draw(st.sampled_from(entities))))
    elif what == "key" and isinstance(where, dict):
        where[draw(NAMES | _KEYS)] = draw(HOSTILE)
    elif keys:
        key = draw(st.sampled_from(keys))
        if what == "drop":
            del where[key]
        elif what == "extreme":
            old = where[key]
            where[key] = [draw(EXTREME), draw(EXTREME)] if isinstance(old, list) else draw(EXTREME)
        else:
            where[key] = draw(HOSTILE)


def _containers(value: Any) -> list[Any]:
    """Return every object and list of a document, innermost ones as often as outer ones."""
    found: list[Any] = []
    if isinstance(value, dict | list):
        found.append(value)
        for item in value.values() if isinstance(value, dict) else value:
            found += _containers(item)
    return found
