"""The remainders of compensated sums in scene files: a loaded world goes on bit for bit."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.ecs.component import Component
from physicslab.files.checks import checked_rows, is_number, refusal
from physicslab.state.remainders import coordinate_keys
from physicslab.state.state import State

_ROW = "[id, x, y, angle, vx, vy, omega]"


def export_remainders(state: State) -> list[list[Any]]:
    """Return a list for each body that has remainders: the entity, then those of coordinates and rates."""
    kept = state.remainders
    if not (kept.q_low.any() or kept.v_low.any()):
        return []
    transform, velocity = state.table(Transform), state.table(Velocity)
    rows = np.flatnonzero(transform.present & velocity.present)
    entities = state.entity_index.entities[rows]
    position, linear = transform["position"][rows].ravel(), velocity["linear"][rows].ravel()
    q = np.concatenate((position, transform["angle"][rows]))
    v = np.concatenate((linear, velocity["angular"][rows]))
    n = len(rows)
    columns = [
        part
        for low in kept.of(coordinate_keys(entities, entities), q, v)
        for part in (low[: 2 * n : 2], low[1 : 2 * n : 2], low[2 * n :])
    ]
    remainders = np.stack(columns, axis=1)
    some = np.flatnonzero(remainders.any(axis=1))
    return [[int(entities[row]), *remainders[row].tolist()] for row in some]


def check_remainders(
    value: object,
    entities: Sequence[tuple[str | None, Sequence[Component]]],
    ids: Mapping[str, int],
    source: str,
) -> dict[int, tuple[list[float], list[float]]]:
    """Return of each entity the numbers that have remainders, and these; refuse what is no rounding."""
    found: dict[int, tuple[list[float], list[float]]] = {}
    for where, row in checked_rows(value, f"{source}: remainders", f"a list of {_ROW}"):
        if not (isinstance(row, list) and len(row) == 7 and all(map(is_number, row[1:]))):
            raise refusal(where, row, f"{_ROW}, six finite numbers")
        number = ids.get(row[0], 0) if isinstance(row[0], str) else 0
        of = {type(part): part for part in entities[number - 1][1]} if number else {}
        transform, velocity = of.get(Transform), of.get(Velocity)
        if not (isinstance(transform, Transform) and isinstance(velocity, Velocity)):
            raise refusal(f"{where}[0]", row[0], "the id of an entity with Transform and Velocity")
        if number in found:
            raise refusal(f"{where}[0]", row[0], "an id that has none yet")
        values = [*transform.position, transform.angle, *velocity.linear, velocity.angular]
        for place, (low, high) in enumerate(zip(row[1:], values, strict=True), start=1):
            if abs(low) > math.ulp(high):
                raise refusal(
                    f"{where}[{place}]", low, f"at most {math.ulp(high):g}, the last digit of {high!r}"
                )
        found[number] = values, [float(low) for low in row[1:]]
    return found
