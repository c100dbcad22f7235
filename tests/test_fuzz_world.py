"""Whatever is called on a world, with whatever values: refused by a documented error, or finite."""

from __future__ import annotations

import tempfile
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from deadline import deadline
from hostile_scenes import EXTREME, HOSTILE, NAMES, PLAIN
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Name, Shape, Spring, Transform, Velocity
from physicslab.ecs.component import COMPONENTS, InvalidValue
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems

VALUES = HOSTILE | st.sampled_from(
    [
        1j,
        np.float32(1.5),
        np.int8(3),
        np.nan,
        np.float64("inf"),
        np.array([1.0, 2.0]),
        np.array([[1, 2]]),
        Decimal("NaN"),
        Fraction(10**400),
        b"ab",
        object(),
        {1, 2},
        range(2),
        np.bool_(True),
        "circle",
        "box",
    ]
)
KINDS = st.sampled_from([kind for kind in COMPONENTS.values() if kind.__module__.startswith("physicslab.")])
REFUSED = (ValueError, TypeError, KeyError, Diverged, AttributeError)


@given(KINDS, st.lists(VALUES, max_size=7))
def test_a_component_takes_finite_values_or_refuses_them(kind: type[Any], values: list[Any]) -> None:
    try:
        made = kind(*values)
    except (InvalidValue, TypeError) as error:
        assert len(str(error)) > 5
        return
    for value in made.values().values():
        assert not isinstance(value, float) or np.isfinite(value)


class Hostile(RuleBasedStateMachine):
    """A world on which anything is called, in any order."""

    def __init__(self) -> None:
        super().__init__()
        self.world = World(*standard_systems())

    def entity(self, index: int) -> int:
        entities = self.world.entities()
        return entities[index % len(entities)] if entities and index >= 0 else index

    def call(self, function: Any, *values: Any, **named: Any) -> None:
        try:
            with deadline((function, values, named)):
                function(*values, **named)
        except REFUSED as error:
            assert str(error)
            if isinstance(error, Diverged):
                self.world = World(*standard_systems())

    @rule(x=PLAIN | EXTREME, v=PLAIN | EXTREME, m=EXTREME, size=EXTREME, name=st.none() | NAMES)
    def spawn(self, x: float, v: float, m: float, size: float, name: str | None) -> None:
        def make() -> None:
            parts = Transform((x, 0)), Velocity((v, 0)), Mass(m), Shape.circle(size)
            self.world.spawn(*parts, name=name)

        if len(self.world.entities()) < 6:
            self.call(make)

    @rule(a=st.integers(-1, 9), b=st.integers(-1, 9), k=EXTREME)
    def tie(self, a: int, b: int, k: float) -> None:
        self.call(lambda: self.world.spawn(Spring(self.entity(a), self.entity(b), stiffness=k)))

    @rule(index=st.integers(-1, 9))
    def remove(self, index: int) -> None:
        self.call(self.world.remove, self.entity(index))

    @rule(index=st.integers(-1, 9), kind=KINDS)
    def discard(self, index: int, kind: type[Any]) -> None:
        self.call(self.world.discard, self.entity(index), kind)

    @rule(index=st.integers(-1, 9), name=NAMES)
    def rename(self, index: int, name: str) -> None:
        self.call(lambda: self.world.add(self.entity(index), Name(name)))

    @rule(index=st.integers(-1, 9), kind=KINDS, which=st.integers(0, 6), value=VALUES)
    def assign(self, index: int, kind: type[Any], which: int, value: Any) -> None:
        field = kind.FIELDS[which % len(kind.FIELDS)].name if kind.FIELDS else "nothing"
        self.call(lambda: setattr(self.world.component(self.entity(index), kind), field, value))

    @rule(dt=st.sampled_from([None, 1e-3, 0.01, 5e-324, 0.0, -1.0, 1e308, float("nan"), float("inf")]))
    def step(self, dt: float | None) -> None:
        self.call(self.world.step, dt)

    @rule(steps=st.integers(-1, 2) | st.sampled_from([10**400, 2**63, 1.5, True, "1", None]))
    def run_steps(self, steps: Any) -> None:
        self.call(self.world.run, steps=steps)

    @rule(
        seconds=st.sampled_from(
            [0, 0.02, -0.0, 5e-324, 1e308, 10**400, "1", float("nan"), float("inf"), True]
        )
    )
    def run_seconds(self, seconds: Any) -> None:
        self.call(self.world.run, seconds=seconds)

    @rule()
    def save_and_load(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory) / "scene.json"
            try:
                save_scene(self.world, path)
            except ValueError as error:
                assert len(str(error).splitlines()) == 1
            else:
                self.world = load_scene(path)

    @invariant()
    def names_differ(self) -> None:
        labels = [self.world.label(entity) for entity in self.world.entities()]
        assert len(labels) == len(set(labels))


Hostile.TestCase.settings = settings(
    stateful_step_count=12, deadline=None, suppress_health_check=list(HealthCheck)
)
TestHostileCalls = Hostile.TestCase


def test_an_id_is_given_once() -> None:
    world = World()
    ball = world.spawn(Transform(), name="ball")
    with pytest.raises(
        InvalidValue, match=r"Name\.id = 'ball': must be an id of its own; entity 1 has this one"
    ):
        world.spawn(name="ball")
    other = world.spawn(Transform())
    with pytest.raises(InvalidValue, match="an id of its own"):
        world.add(other, Name("ball"))
    world.add(ball, Name("ball"))
    world.remove(ball)
    world.add(other, Name("ball"))
    assert world.entity("ball") == other
