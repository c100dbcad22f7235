"""The numbers of entities in scene files: by these they have their colours, and their labels.

A file has its entities in order. Where some were removed before it was written, ``numbers`` says so: a row
``[place, number]`` for each entity, by its place from 1, whose number is not the one after that before it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from physicslab.ecs.component import Component
from physicslab.files import checks
from physicslab.stepping.island import KeptIsland

LARGEST = 2_000_000
"""The largest number that an entity of a file may have: a world keeps a row of a table for each below it."""


def export_numbers(entities: Sequence[int]) -> list[list[int]]:
    """Return the rows for entities in order; none where the numbers are too large for a file."""
    if entities and entities[-1] > LARGEST:
        return []
    before = 0
    rows: list[list[int]] = []
    for place, number in enumerate(entities, start=1):
        if number != before + 1:
            rows.append([place, number])
        before = number
    return rows


def check_numbers(rows: object, count: int, source: str) -> list[int]:
    """Return the numbers of ``count`` entities, in order; refuse what cannot be."""
    numbers: list[int] = []

    def go_on(until: int) -> None:
        first = numbers[-1] + 1 if numbers else 1
        numbers.extend(range(first, first + until - len(numbers)))

    for where, row in checks.checked_rows(rows, f"{source}: numbers", "a list of [place, number]"):
        known = isinstance(row, list) and len(row) == 2 and all(type(value) is int for value in row)
        if known and len(numbers) < row[0] <= count:
            go_on(row[0] - 1)
            known = (numbers[-1] if numbers else 0) < row[1] <= LARGEST
        else:
            known = False
        if not known:
            allowed = f"[place, number]: places in order, {count} at most, and a number larger than those "
            raise checks.refusal(where, row, f"{allowed}before, {LARGEST:,} at most")
        numbers.append(row[1])
    go_on(count)
    if numbers and numbers[-1] > max(LARGEST, count):
        raise checks.SceneError(f"{source}: numbers: end at {numbers[-1]:,}; must be {LARGEST:,} at most")
    return numbers


def renumbered(component: Component, numbers: Sequence[int]) -> Component:
    """Return a component that refers to entities by number where it did so by place."""
    ends = [spec.name for spec in component.FIELDS if spec.kind == "entity"]
    if not ends:
        return component
    given = component.given()
    given |= {name: numbers[given[name] - 1] for name in ends if given[name] is not None}
    return type(component)(**given)


def renumbered_rows(rows: Iterable[Sequence[Any]], numbers: Sequence[int], ends: int = 1) -> list[list[Any]]:
    """Return rows whose first entries are places, 0 for the bounds, with numbers there."""
    return [[*(numbers[end - 1] if end else 0 for end in row[:ends]), *row[ends:]] for row in rows]


def renumbered_islands(islands: Iterable[KeptIsland], numbers: Sequence[int]) -> list[KeptIsland]:
    """Return islands whose bodies are places with numbers there."""
    return [
        replace(
            island,
            bodies=[numbers[body - 1] for body in island.bodies],
            driven=[[numbers[int(row[0]) - 1], *row[1:]] for row in island.driven],
        )
        for island in islands
    ]
