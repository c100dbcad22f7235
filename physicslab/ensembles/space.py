"""The runs of an ensemble: fields of a scene, and their values in each run, a row."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ensembles.sobol import BITS, DIMENSIONS, sobol
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import Place, entity_names, find_place
from physicslab.world import World

type Values = NDArray[Any]
"""The values of a field: float64 or int64 arrays (n,), or arrays of words."""
type Given = Any
"""A list, an array, a law and its numbers, or one value."""

_BLOCK = 1024
"""Samples whose numbers are drawn at once: which they are depends on their own place alone."""
_LAWS = {"uniform": "two numbers a < b", "normal": "a mean and a deviation > 0", "sobol": "two numbers a < b"}
_KINDS = ("number", "whole", "flag", "choice", "text")
MOST_ROWS = 10**9


@dataclass(frozen=True, slots=True)
class Axis:
    """A field and how its values are found.

    Attributes
    ----------
    name : str
        Name of its column.
    path, kind : str
        The field, and what its values are.
    law : str
        ``"grid"``, ``"rows"`` (a value for each sample), ``"uniform"``, ``"normal"``, ``"sobol"`` or
        ``"fixed"``, the scene's own value, to which a jitter is added.
    values : array (n,)
        Those of a grid or of the samples; else the two numbers of the law [SI].
    jitter : float
        Deviation [SI] by which it differs in each replica but the first.
    """

    name: str
    path: str
    kind: str
    law: str
    values: Values
    jitter: float = 0.0


@dataclass(frozen=True, slots=True)
class Space:
    """The rows of an ensemble: every combination of the grids, times samples, times replicas.

    The last list of a grid changes faster than those before it, samples faster than grids, and replicas
    fastest. A row's values depend on the seed and on its place alone.
    """

    axes: tuple[Axis, ...]
    samples: int
    seed: int
    replicas: int

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the grids, the number of samples, that of replicas."""
        return (*(len(axis.values) for axis in self.axes if axis.law == "grid"), self.samples, self.replicas)

    def columns(self, first: int, last: int) -> dict[str, Values]:
        """Return the values of each field in the rows from ``first`` up to ``last``, in their columns."""
        rows = np.arange(first, last)
        *grid, sample, replica = np.unravel_index(rows, self.shape)
        places, dimension = iter(grid), 0
        found: dict[str, Values] = {}
        for axis in self.axes:
            if axis.law == "grid":
                values = axis.values[next(places)]
            elif axis.law == "rows":
                values = axis.values[sample]
            elif axis.law == "fixed":
                values = np.repeat(axis.values, len(rows))
            else:
                values = self._drawn(axis, sample, dimension)
                dimension += axis.law == "sobol"
            if axis.jitter:
                random = self._blocks(axis, "jitter", rows, lambda rng: rng.standard_normal(_BLOCK))
                values = np.where(replica > 0, values + axis.jitter * random, values)
            found[axis.name] = values
        if self.replicas > 1:
            found["replica"] = replica
        return found

    def _drawn(self, axis: Axis, samples: NDArray[np.int64], dimension: int) -> Values:
        low, high = axis.values.tolist()
        share: Values
        if axis.law == "normal":
            share = self._blocks(axis, axis.law, samples, lambda rng: rng.standard_normal(_BLOCK))
            return np.asarray(low + high * share)
        if axis.law == "sobol":
            shift = int(self._generator(axis, axis.law, 0).integers(2**BITS))
            share = ((sobol(samples, dimension) ^ shift) + 0.5) * 2.0**-BITS
        else:
            share = self._blocks(axis, axis.law, samples, lambda rng: rng.random(_BLOCK))
        return np.asarray(low + (high - low) * share)

    def _blocks(self, axis: Axis, use: str, places: NDArray[np.int64], draw: Any) -> NDArray[np.float64]:
        """Return a random number for each place, drawn in blocks that each have a generator of their own."""
        found = np.empty(len(places))
        block = places // _BLOCK
        for number in np.unique(block).tolist():
            inside = block == number
            found[inside] = draw(self._generator(axis, use, number))[places[inside] % _BLOCK]
        return found

    def _generator(self, axis: Axis, use: str, block: int) -> np.random.Generator:
        """Return what draws a block of numbers of a field; fields added beside it change none."""
        name = np.frombuffer(hashlib.sha256(f"{use} {axis.path}".encode()).digest(), "<u4")
        sequence = np.random.SeedSequence(self.seed, spawn_key=(*name.tolist(), block))
        return np.random.Generator(np.random.PCG64(sequence))


def space_of(
    world: World, space: Mapping[str, Given], samples: int | None, seed: int, replicas: int,
    jitter: float | str | Mapping[str, float | str],
) -> Space:  # fmt: skip
    """Return the rows of an ensemble, each field and every number checked.

    Raises
    ------
    SceneError
        If a field is not one of the scene, a value is not one that it can have, or two parts contradict.
    """
    if not isinstance(space, Mapping):
        raise SceneError(f"space {shown(space)}: must be a dict of fields and their values")
    names, axes = entity_names(world), []
    for path, given in space.items():
        if not isinstance(path, str):
            raise SceneError(f"space: {shown(path)}: must be ID.Component.field")
        place = find_place(world, "space", path, "", names)
        axes.append(_axis(world, place, path.strip(), given))
    paths = [axis.path for axis in axes]
    for path in paths:
        if paths.count(path) > 1:
            raise SceneError(f"space: {path}: is given twice; a field must be given once")
    seed, replicas = check_whole("seed", seed, 0), check_whole("replicas", replicas, 1, MOST_ROWS)
    axes = _with_jitter(world, names, axes, replicas, jitter)
    if sum(axis.law == "sobol" for axis in axes) > DIMENSIONS:
        raise SceneError(f"space: a sobol sequence must have at most {DIMENSIONS} fields")
    found = Space(tuple(axes), _samples(axes, samples), seed, replicas)
    if len(found) > MOST_ROWS:
        raise SceneError(f"space: has {len(found):,} rows; must have at most {MOST_ROWS:,}")
    return found


def _axis(world: World, place: Place, name: str, given: Given) -> Axis:
    """Return a field with its values, or with the numbers of its law, in SI."""
    kind = place.spec.kind
    if kind not in (*_KINDS, "vector") or (kind == "vector") != bool(place.part):
        allowed = "a part of it, .x or .y" if kind == "vector" else "a number, a part of a vector, or a word"
        raise SceneError(f"{place.words}: cannot be varied; must be {allowed}")
    if isinstance(given, tuple) and given and isinstance(given[0], str) and given[0] in (*_LAWS, "rows"):
        law, *numbers = given
        if law != "rows":
            return Axis(name, place.path, kind, law, _law(world, place, law, numbers))
        if len(numbers) != 1 or np.ndim(numbers[0]) != 1:
            raise SceneError(f'{place.words}: ("rows", values) must have one list of values')
        return Axis(name, place.path, kind, law, _values(world, place, list(numbers[0])))
    numeric = kind in ("number", "vector")
    if numeric and isinstance(given, tuple) and given and str(given[0]).isidentifier():
        raise SceneError(
            f"{place.words} = {shown(given)}: a law must be one of {', '.join((*_LAWS, 'rows'))}"
        )
    if isinstance(given, str) or np.ndim(given) == 0:
        given = [given]
    if np.ndim(given) != 1:
        raise SceneError(
            f"{place.words} = {shown(given)}: must be a list of values, or a law and two numbers"
        )
    return Axis(name, place.path, kind, "grid", _values(world, place, list(given)))


def _values(world: World, place: Place, given: list[Any]) -> Values:
    if not given:
        raise SceneError(f"{place.words} = []: must be at least one value")
    found = [_checked(world, place, value) for value in given]
    if place.spec.kind in ("number", "vector"):
        return np.array(found, np.float64)
    return np.array(found, np.int64 if place.spec.kind == "whole" else object)


def _law(world: World, place: Place, law: str, numbers: list[Any]) -> Values:
    if place.spec.kind not in ("number", "vector"):
        raise SceneError(
            f"{place.words}: takes a list of values; only numbers with a unit are drawn at random"
        )
    if len(numbers) != 2:
        raise SceneError(f'{place.words}: ("{law}", ...) must have {_LAWS[law]}')
    if law == "normal":
        low, high = _checked(world, place, numbers[0]), number_of(place, numbers[1])
    else:
        low, high = (_checked(world, place, number) for number in numbers)
    if not (high > 0.0 if law == "normal" else low < high):
        raise SceneError(f'{place.words} = {shown([law, *numbers])}: ("{law}", ...) must have {_LAWS[law]}')
    return np.array((low, high), np.float64)


def _checked(world: World, place: Place, value: Any) -> Any:
    """Return a value as the column has it, or refuse it by name."""
    if place.spec.kind in ("number", "vector"):
        value = number_of(place, value)
    elif isinstance(value, np.generic):
        value = value.item()
    try:
        place.spec.check(place.whole(place.read(world), value))
    except InvalidValue as error:
        raise SceneError(f"{place.words} = {shown(value)}: must be {error.allowed}") from error
    return value


def number_of(place: Place, value: Any) -> float:
    """Return a number or a text with a unit in the unit of a field, or refuse it by name."""
    if isinstance(value, (bool, np.bool_, bytes, bytearray)):
        raise SceneError(f"{place.words} = {shown(value)}: must be {place.spec.allowed}")
    try:
        number = evaluate(value, place.spec.unit) if isinstance(value, str) else float(value)
    except (InvalidText, OverflowError, TypeError, ValueError) as error:
        raise SceneError(f"{place.words} = {shown(value)}: {error}; must be {place.spec.allowed}") from error
    if not math.isfinite(number):
        raise SceneError(f"{place.words} = {number}: must be a finite number")
    return number


def _with_jitter(
    world: World, names: Mapping[str, int], axes: list[Axis], replicas: int,
    jitter: float | str | Mapping[str, float | str],
) -> list[Axis]:  # fmt: skip
    """Return the fields with the deviation of each, and those besides that only differ between replicas."""
    by_path = {axis.path: axis for axis in axes}
    if not isinstance(jitter, Mapping):
        numbers = [axis.name for axis in axes if axis.kind in ("number", "vector")]
        jitter = dict.fromkeys(numbers, jitter) if jitter else {}
    for path, size in jitter.items():
        place = find_place(world, "jitter", path, str(size), names)
        deviation = number_of(place, size)
        own = by_path.get(place.path)
        if own is None:
            own = replace(_axis(world, place, path.strip(), place.value(world)), law="fixed")
        if own.kind not in ("number", "vector") or deviation < 0.0:
            raise SceneError(f"{place.words} = {shown(size)}: a jitter must be a number >= 0, of a number")
        by_path[place.path] = replace(own, jitter=deviation)
    has_jitter = any(axis.jitter for axis in by_path.values())
    if replicas > 1 and not has_jitter:
        raise SceneError("replicas: must have a jitter: runs of the same values have the same bits")
    if has_jitter and replicas == 1:
        raise SceneError("jitter: needs replicas, which differ by it: replicas must be at least 2")
    return list(by_path.values())


def _samples(axes: Sequence[Axis], samples: int | None) -> int:
    """Return how many samples there are."""
    lengths = {axis.name: len(axis.values) for axis in axes if axis.law == "rows"}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        raise SceneError(f'space: ("rows", ...) must all have as many values: {words}')
    drawn = any(axis.law in _LAWS for axis in axes)
    if samples is not None:
        samples = check_whole("samples", samples, 1, MOST_ROWS)
    if lengths:
        length = next(iter(lengths.values()))
        if samples not in (None, length):
            raise SceneError(
                f"samples = {samples}: must be {length}, as there are so many values in the rows"
            )
        return length
    if drawn != (samples is not None):
        words = "must be given: fields are drawn at random" if drawn else "no field is drawn at random"
        raise SceneError(f"samples: {words}")
    return samples or 1


def check_whole(name: str, value: object, least: int, most: float = math.inf) -> int:
    """Return a whole number, of numpy's or not; refuse what is none, or one that is out of the range."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or not least <= value <= most:
        limit = f", at most {most:,}" if most < math.inf else ""
        raise SceneError(f"{name} = {shown(value)}: must be a whole number >= {least}{limit}")
    return int(value)
