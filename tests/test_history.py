"""The time machine: edits and runs are taken back, put back and gone through, to the bit.

The large numbers of the design are tried with

    pytest tests/test_history.py -m slow --effort 10
"""

from __future__ import annotations

import itertools
import random
import time
from typing import Any

import numpy as np
import pytest
from crowds import crowd
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule
from numpy.typing import NDArray
from random_edits import Driver, bits, box_of_discs, state_hash

from physicslab import load_scene
from physicslab.components import Held, Mass, Name, Shape, Spring, Trail, Transform, Velocity
from physicslab.ecs.component import InvalidValue
from physicslab.files.scene import read_scene
from physicslab.history import (
    AddComponent,
    Group,
    History,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    SetSimulation,
    Spawn,
)
from physicslab.history import places as places_module
from physicslab.history.keyframes import _FRAME, _OBJECT
from physicslab.lab.bench.catalogue import SCENES
from physicslab.state.masses import Diverged
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import Stage, System, at
from physicslab.systems.trail import TrailSystem
from physicslab.world import World

BALL = (Transform((0, 1)), Velocity((0.5, 0)), Mass(2.0), Shape("circle", radius=0.2))


@pytest.fixture
def dense(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave a key frame at every place."""
    monkeypatch.setattr(places_module, "_RARELY", 0.0)
    monkeypatch.setattr(places_module, "_SEEKING", 0.0)


def ball(history: History, name: str = "ball") -> int:
    """Make a ball by hand."""
    return history.do(Spawn(BALL, name))[0]


# ---- undo and redo -----------------------------------------------------------------------------------------


def test_an_entity_that_was_removed_comes_back_with_its_number_its_name_and_its_place() -> None:
    history = History(box_of_discs(0))
    made = ball(history)
    history.step(steps=20)
    before = state_hash(history.world)
    history.do(Remove(made))
    other = ball(history, "another")
    assert other > made and history.undo() == "made a circle, another"
    assert history.undo() == "removed ball"
    assert history.world.entity("ball") == made and state_hash(history.world) == before
    assert history.redo() == "removed ball" and not history.world.has(made, Transform)
    assert history.redo() == "made a circle, another" and history.world.entity("another") == other
    assert history.redo() is None


def test_entries_are_in_plain_english_and_say_what_is_done() -> None:
    history = History(World())
    made = ball(history)
    history.step(0.02, steps=160)
    history.do(SetField(made, "Mass", "mass", 3))
    history.do(SetPhysics({"gravity": (0, -1.62)}))
    history.do(AddComponent(made, Name("stone")))
    history.do(Group("turned it round", [SetField(made, "Transform", "angle", 1.0)]))
    history.do(RemoveComponent(made, "Velocity"))
    history.do(SetSimulation({"dt": 0.01}))
    history.undo()
    assert [(entry.words, entry.done) for entry in history.entries] == [
        ("made a circle, ball", True),
        ("ran 3.2 s", True),
        ("mass of ball: 3 kg", True),
        ("gravity: (0, -1.62) m/s^2", True),
        ("named ball: stone", True),
        ("turned it round", True),
        ("took Velocity from stone", True),
        ("dt: 0.01 s", False),
    ]
    assert history.position == 7 and history.entries[1].steps == 160


def test_a_group_is_one_entry_and_its_entities_are_numbered_in_order() -> None:
    history = History(World(SpringSystem(), IntegrateSystem()))
    first = history.next_entity
    spring = Spring(a=first, b=first + 1, rest_length=1.0, stiffness=10.0)
    ends = [Spawn((Transform((x, 0)), Velocity(), Mass(1.0))) for x in (0, 2)]
    assert history.do(Group("tied two", [*ends, Spawn([spring])])) == (first, first + 1, first + 2)
    history.step(0.01, steps=10)
    after = state_hash(history.world)
    assert (history.undo(), history.undo()) == ("ran 0.1 s", "tied two")
    assert history.world.entities() == [] and len(history.entries) == 2
    history.redo()
    history.redo()
    assert state_hash(history.world) == after


def test_runs_without_an_edit_between_them_are_one_entry_with_every_dt() -> None:
    history = History(box_of_discs(1))
    history.step(0.01, steps=30)
    history.step(0.02, steps=5)
    history.step(steps=2)
    fresh = box_of_discs(1)
    for dt in [0.01] * 30 + [0.02] * 5 + [None] * 2:
        fresh.step(dt)
    assert len(history.entries) == 1 and history.entries[0].words == "ran 0.4 s"
    assert history.undo() == "ran 0.4 s" and history.step_count == 0
    history.redo()
    assert bits(history.world) == bits(fresh) and history.time == fresh.time


REFUSED: list[tuple[Any, type[Exception]]] = [
    (SetField(1, "Mass", "mass", -1), InvalidValue),
    (SetField(1, "Mass", "weight", 1), TypeError),
    (SetField(1, "Wings", "span", 1), KeyError),
    (SetField(99, "Mass", "mass", 1), KeyError),
    (SetField(1, "Shape", "kind", "box"), AttributeError),
    (Remove(99), KeyError),
    (RemoveComponent(1, "Drag"), KeyError),
    (AddComponent(1, Name("b1")), InvalidValue),
    (Spawn(BALL, "b0"), InvalidValue),
    (Spawn(BALL, entity=1), ValueError),
    (SetPhysics({"gravity": "down"}), InvalidValue),
    (SetPhysics({"colour": 1}), TypeError),
    (SetSimulation({"dt": 0}), InvalidValue),
    (SetField(1, "Mass", "mass", 1e308), InvalidValue),  # its moment of inertia would not be finite
    (Group("two", [Spawn(BALL), SetField(2, "Mass", "mass", 5.0), Remove(99)]), KeyError),
]


@pytest.mark.parametrize(("command", "error"), REFUSED)
def test_a_refused_edit_raises_what_the_world_raises_and_changes_nothing(
    command: Any, error: type[Exception]
) -> None:
    history = History(box_of_discs(2))
    history.world.add(1, Shape("box", width=1e10, height=1e10)) if getattr(
        command, "value", 0
    ) == 1e308 else 0
    history = History(history.world)
    history.step(steps=3)
    before = state_hash(history.world)
    with pytest.raises(error):
        history.do(command)
    assert [entry.words for entry in history.entries] == ["ran 0.05 s"]
    assert state_hash(history.world) == before
    history.step(steps=3)
    again = state_hash(history.world)
    history.undo()
    history.redo()
    assert state_hash(history.world) == again


def test_a_step_that_diverges_leaves_the_world_as_it_was_to_the_bit() -> None:
    history = History(box_of_discs(3))
    history.step(steps=40)
    history.do(SetField(1, "Velocity", "linear", (1e160, 0)))
    before = state_hash(history.world)
    with pytest.raises(Diverged):
        history.step(steps=5)
    assert history.step_count == 40 and state_hash(history.world) == before
    for dt in (-1.0, float("nan"), True):
        with pytest.raises(InvalidValue):
            history.step(dt)
    assert len(history.entries) == 2 and history.undo() == "linear of b0: (1e+160, 0) m/s"
    history.step(steps=5)
    assert history.difference is None


# ---- seeking -----------------------------------------------------------------------------------------------


def goes_through(document: dict[str, Any], steps: int, seed: int) -> set[str]:
    """Seek steps at random in a run and compare with a run that was never recorded; return who stepped."""
    history, fresh = History(read_scene(document)), read_scene(document)
    expected, names = [bits(fresh)], set[str]()
    try:
        for _ in range(steps):
            fresh.step()
            expected.append(bits(fresh))
        history.step(steps=steps)
    except Diverged:
        return names
    rng = random.Random(seed)
    for step in [rng.randint(0, steps) for _ in range(20)]:
        history.seek(step)
        assert history.step_count == step and bits(history.world) == expected[step]
        names.add(history.world.stepper.name if history.world.stepper else "")
    assert history.difference is None
    return names


@pytest.mark.usefixtures("dense")
@settings(max_examples=12, derandomize=True)
@given(st.integers(0, 2**31), st.sampled_from(("soft", "auto")))
def test_seeks_give_the_bits_of_a_fresh_run_whatever_the_scene(seed: int, contacts: str) -> None:
    document = crowd(seed)
    document["simulation"]["contacts"] = contacts
    goes_through(document, 40, seed)


@pytest.mark.usefixtures("dense")
@pytest.mark.parametrize(
    ("scene", "stepper"),
    [
        ("drop", "event_driven"),
        ("newtons_cradle", "rigid"),
        ("pendulum", "flow"),
        ("solar_system", "flow"),
        ("spring_chain", "fused_contact"),
        ("pyramid", "fused_contact"),
        ("pile", "fused_contact"),
    ],
)
def test_seeks_give_the_bits_of_a_fresh_run_with_every_stepper(scene: str, stepper: str) -> None:
    from physicslab.files.scene import write_scene

    document = write_scene(load_scene(scene))
    assert stepper in goes_through(document, 60, 1)


@pytest.mark.usefixtures("dense")
def test_seeks_give_the_bits_of_a_fresh_run_where_all_fall_asleep() -> None:
    def build() -> World:
        world = SCENES["pyramid_30"].build()
        world.simulation = type(world.simulation)(collisions="step", contacts="soft", sleeping=True)
        return world

    history, fresh = History(build()), build()
    history.step(steps=290)
    assert history.world.stepper is not None and history.world.stepper.name == "asleep"
    expected = [bits(fresh)]
    for _ in range(290):
        fresh.step()
        expected.append(bits(fresh))
    for step in (5, 283, 284, 282, 290, 200, 0, 285):
        history.seek(step)
        assert bits(history.world) == expected[step]
    assert history.difference is None


def test_a_seek_beyond_the_line_is_refused() -> None:
    history = History(box_of_discs(4))
    history.step(steps=5)
    history.undo()
    assert history.steps_range == (0, 0)
    for step in (-1, 1):
        with pytest.raises(IndexError, match=f"step {step}"):
            history.seek(step)


def test_an_edit_at_the_place_that_is_sought_is_done_and_one_that_was_taken_back_is_not() -> None:
    history = History(box_of_discs(5))
    history.step(steps=4)
    made = ball(history)
    history.seek(2)
    assert not history.world.has(made, Mass)
    history.seek(4)
    assert history.world.has(made, Mass)
    history.undo()
    history.seek(1)
    history.seek(4)
    assert not history.world.has(made, Mass) and history.redo() == "made a circle, ball"


@pytest.mark.usefixtures("dense")
@pytest.mark.parametrize("seconds", [1.0, 4.0])
def test_contacts_are_counted_at_once_where_a_place_is_gone_back_to(seconds: float) -> None:
    world = load_scene("stack")
    history = History(world)
    for _ in range(round(seconds / world.simulation.dt)):
        history.step()
    before = world.contacts.count
    assert before > 9
    history.do(Spawn([Transform((50.0, 5.0))]))
    for _ in range(3):
        history.step()
    history.undo()
    history.undo()
    assert world.contacts.count == before


def test_names_are_those_of_the_place() -> None:
    history = History(box_of_discs(4))
    history.step(steps=2)
    history.do(AddComponent(2, Name("second")))
    history.step(steps=2)
    history.do(AddComponent(2, Name("another")))
    history.step(steps=2)
    for step, name in ((3, "second"), (1, "b1"), (6, "another"), (5, "another"), (2, "second")):
        history.seek(step)
        assert history.world.label(2) == name and history.world.entity(name) == 2


@pytest.mark.usefixtures("dense")
def test_trails_are_those_of_the_place() -> None:
    history = History(box_of_discs(4))
    history.do(AddComponent(2, Trail(0.3)))
    trails = next(system for system in history.world.schedule.systems if isinstance(system, TrailSystem))
    paths = []
    for _ in range(40):
        paths.append(b"".join(part.tobytes() for part in trails.paths()))
        history.step()
    for step in (39, 38, 5, 6, 20, 1, 0):
        history.seek(step)
        assert b"".join(part.tobytes() for part in trails.paths()) == paths[step]


class Pushing(System):
    """Pushes more from step to step; it keeps its count, or does not."""

    def __init__(self, keeps: bool) -> None:
        self._count, self._keeps = 0, keeps

    @at(Stage.PREPARE)
    def push(self, state: Any, h: float) -> None:
        self._count += 1
        state.table(Velocity)["angular"][1] += 0.001 * self._count

    def keep(self) -> tuple[NDArray[Any], ...]:
        return (np.array([self._count]),) if self._keeps else ()

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        self._count = int(kept[0][0])


def test_where_steps_made_again_give_other_bits_is_found() -> None:
    for keeps in (True, False):
        history = History(World(IntegrateSystem(), Pushing(keeps)))
        ball(history)
        history.step(0.01, steps=10)
        history.seek(0)
        history.seek(7)
        assert (history.difference is None) is keeps
    assert history.difference is not None
    assert (history.difference.step, history.difference.columns) == (
        1,
        ("Transform.angle", "Velocity.angular"),
    )


# ---- branches ----------------------------------------------------------------------------------------------


def test_an_edit_in_the_past_begins_a_branch_that_can_be_gone_back_to() -> None:
    history = History(box_of_discs(6))
    history.step(steps=50)
    end = state_hash(history.world)
    history.seek(20)
    history.step(0.005, steps=10)
    assert history.steps_range == (0, 30) and len(history.entries) == 1
    other = state_hash(history.world)
    (branch,) = history.branches
    assert branch.step == 20 and branch.words == ("ran 0.5 s",) and branch.seconds == pytest.approx(1 / 3)
    history.switch(branch)
    assert history.step_count == 20 and history.steps_range == (0, 50)
    history.seek(50)
    assert state_hash(history.world) == end
    (back,) = history.branches
    history.switch(back)
    history.seek(30)
    assert state_hash(history.world) == other and history.difference is None


def test_branches_leave_where_the_line_that_is_gone_along_leaves_them() -> None:
    history = History(box_of_discs(6))
    history.step(steps=50)
    history.seek(40)
    history.do(SetField(1, "Mass", "mass", 3.0))  # the first branch is left after step 40
    history.step(steps=6)
    history.seek(20)
    history.do(SetField(1, "Mass", "mass", 2.0))  # and now both after step 20
    first, second = history.branches
    assert (first.step, second.step) == (20, 20)
    assert first.words == ("ran 0.5 s",)
    assert second.words == ("ran 0.3 s", "mass of b0: 3 kg", "ran 0.1 s")
    history.switch(second)
    assert [branch.step for branch in history.branches] == [40, 20] and history.step_count == 20
    with pytest.raises(ValueError, match="no branch"):
        history.switch(second)
    assert history.step_count == 20


def test_few_branches_are_kept() -> None:
    history = History(box_of_discs(6))
    for _ in range(30):
        history.step(steps=2)
        history.undo()
    history.step()
    assert len(history.branches) == 8


# ---- the hand ----------------------------------------------------------------------------------------------


def test_what_a_hand_does_is_a_part_of_the_run() -> None:
    history = History(box_of_discs(7))
    before = state_hash(history.world)
    seen = [bits(history.world)]
    for frame in range(30):
        if frame == 5:
            history.write(AddComponent(1, Held((0.1, 0.0))))
        if 5 <= frame < 20:
            history.write(SetField(1, "Velocity", "linear", (1.0, 0.1 * frame)))
        if frame == 20:
            history.write(RemoveComponent(1, "Held"))
        history.step()
        seen.append(bits(history.world))
    assert [entry.words for entry in history.entries] == ["ran 0.5 s"]
    for step in (3, 29, 17, 6, 12, 30):
        history.seek(step)
        assert bits(history.world)[2] == seen[step][2]  # positions: of velocities the next write may be done
    assert history.difference is None
    history.undo()
    assert state_hash(history.world) == before


def test_a_refused_write_is_no_part_of_the_run() -> None:
    history = History(box_of_discs(7))
    history.step(steps=3)
    before = state_hash(history.world)
    with pytest.raises(KeyError):
        history.write(Group("", [SetField(1, "Velocity", "angular", 2.0), Remove(99)]))
    assert state_hash(history.world) == before and history._places.line.ticks == 3


# ---- memory ------------------------------------------------------------------------------------------------


def test_edits_leave_key_frames_along_the_line_as_runs_do(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a clock on which whatever is timed takes a moment, on any machine."""
    monkeypatch.setattr(time, "perf_counter", itertools.count().__next__)
    monkeypatch.setattr(places_module, "_RARELY", 10.0)
    monkeypatch.setattr(places_module, "_SMOOTH", 0.0)
    history = History(box_of_discs(8))
    for k in range(300):
        history.do(SetField(1, "Mass", "mass", 1.0 + k % 3))
    assert len(history._places._frames._along.places) > 3


@pytest.mark.usefixtures("dense")
def test_key_frames_keep_to_their_budget() -> None:
    history = History(box_of_discs(8, 20), budget=400_000)
    history.step(steps=300)
    assert history.size <= 400_000 and history._places._frames.spacing > 1
    expected = bits(history.world)
    for step in range(300, 150, -1):
        history.seek(step)
        assert history.size <= 400_000
    history.seek(300)
    assert bits(history.world) == expected
    places = history._places._frames
    held = {id(a): a.nbytes for k in range(301) if k in places for a in places[k].arrays()}
    assert sum(held.values()) <= history.size


def test_what_key_frames_take_is_counted_right_after_many_commands(pytestconfig: pytest.Config) -> None:
    """A count that only grew would leave fewer and fewer of them; how many there are depends on the clock."""
    driver = Driver(box_of_discs(9, 4), 9, budget=2**20)
    for _ in range(4):
        for _ in range(round(500 * pytestconfig.getoption("effort"))):
            driver.anything()
        for frames in (driver.history._places._frames._along, driver.history._places._frames._nearby):
            arrays = {id(a): a.nbytes for frame in frames.by_place.values() for a in frame.arrays()}
            held = sum(arrays.values()) + _OBJECT * len(arrays) + _FRAME * len(frames.places)
            assert frames.size == held and frames.places == sorted(frames.by_place)
        assert driver.history.size <= 2**20


# ---- random commands ---------------------------------------------------------------------------------------


class RandomCommands(RuleBasedStateMachine):
    """Edits, runs, undo, redo and seeks in any order: each place is as it was at first."""

    def __init__(self) -> None:
        super().__init__()
        self.driver = Driver(box_of_discs(9), 9, budget=300_000)

    @rule(seed=st.integers(0, 2**31))
    def edit(self, seed: int) -> None:
        self.driver.rng.seed(seed)
        self.driver.edit()

    @rule(steps=st.integers(1, 12))
    def run(self, steps: int) -> None:
        self.driver.run(steps)

    @rule()
    def undo(self) -> None:
        self.driver.undo()

    @rule()
    def redo(self) -> None:
        self.driver.redo()

    @rule(seed=st.integers(0, 2**31))
    def seek(self, seed: int) -> None:
        self.driver.rng.seed(seed)
        self.driver.seek()

    @rule()
    def drag(self) -> None:
        self.driver.drag()

    @rule()
    def refused(self) -> None:
        self.driver.refused()

    def teardown(self) -> None:
        self.driver.back_to_the_start()


TestRandomCommands = RandomCommands.TestCase
TestRandomCommands.settings = settings(max_examples=10, stateful_step_count=30, deadline=None)


@pytest.mark.slow
def test_thousands_of_random_commands_are_taken_back(pytestconfig: pytest.Config) -> None:
    driver = Driver(box_of_discs(10, 4), 10, budget=2**20)
    for _ in range(round(2_000 * pytestconfig.getoption("effort"))):
        driver.anything()
    assert driver.history.size <= 2**20
    driver.back_to_the_start()


@pytest.mark.slow
def test_thousands_of_random_seeks_give_the_bits_of_a_fresh_run(pytestconfig: pytest.Config) -> None:
    document = crowd(77)
    document["simulation"]["contacts"] = "soft"
    history, fresh, expected = History(read_scene(document)), read_scene(document), []
    for _ in range(3000):
        expected.append(bits(fresh))
        fresh.step()
    history.step(steps=2999)
    rng = random.Random(12)
    for _ in range(round(2_000 * pytestconfig.getoption("effort"))):
        step = rng.randrange(3000)
        history.seek(step)
        assert bits(history.world) == expected[step]
    assert history.difference is None
