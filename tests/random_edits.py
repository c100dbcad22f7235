"""Random commands on a history, and what must be so after each of them."""

from __future__ import annotations

import random
from bisect import insort
from contextlib import suppress
from hashlib import blake2b

import numpy as np

from physicslab.components import Drag, Held, Mass, Material, Name, Shape, Spring, Transform, Velocity
from physicslab.files.scene import read_scene
from physicslab.history import (
    AddComponent,
    Command,
    Group,
    History,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    SetSimulation,
    Spawn,
)
from physicslab.state.masses import Diverged
from physicslab.world import World

__all__ = ["MOTION", "Driver", "bits", "box_of_discs", "state_hash"]

MOTION = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))


def bits(world: World) -> list[bytes]:
    """Return the clock and the state of motion of every body, bit by bit, in the order of entities."""
    world.synchronise()
    index = world.entity_index
    rows = np.flatnonzero(index.entities)
    columns = [np.array([world.time]), index.entities[rows]]
    columns += [world.table(kind)[name][rows] for kind, name in MOTION]
    columns += [world.sleep.asleep[rows], world.sleep.rest[rows]]
    return [column.tobytes() for column in columns]


def state_hash(world: World, *, planned: bool = True) -> bytes:
    """Return a hash of all columns, of the laws, the names and what sleeps, and of the plan."""
    digest = blake2b(b"".join(bits(world)), digest_size=16)
    index = world.entity_index
    rows = np.flatnonzero(index.entities)
    for kind in sorted(index.tables, key=lambda kind: kind.__name__):
        table = index.tables[kind]
        if table.handles:
            digest.update(kind.__name__.encode() + table.present[rows].tobytes())
            for column in table.columns:
                digest.update(column[rows].tobytes())
    names = [(entity, world.label(entity)) for entity in world.entities()]
    counts = world.collisions, world.steps, world.plan.kept if planned else None
    digest.update(repr((names, world.physics, world.simulation, counts)).encode())
    return digest.digest()


def box_of_discs(seed: int, count: int = 8) -> World:
    """Return a few discs and boxes in a walled box, with soft contacts."""
    rng = random.Random(seed)
    entities = [
        {
            "id": f"b{k}",
            "Transform": {"position": [rng.uniform(-1, 1), rng.uniform(0.2, 2)], "angle": rng.uniform(0, 3)},
            "Velocity": {"linear": [rng.gauss(0, 1), rng.gauss(0, 1)]},
            "Mass": {"mass": rng.uniform(0.5, 2)},
            "Shape": {"kind": "circle", "radius": 0.15}
            if k % 2
            else {"kind": "box", "width": 0.3, "height": 0.2},
            "Material": {"restitution": 0.3, "friction": 0.5},
        }
        for k in range(count)
    ]
    return read_scene(
        {
            "format": "physicslab-scene/1",
            "physics": {"bounds": [-1.5, 0.0, 1.5, 4.0]},
            "simulation": {"contacts": "soft", "collisions": "step", "sleeping": True},
            "entities": entities,
        }
    )


class Driver:
    """Does random things to a history, and compares every place with what it was at first.

    Attributes
    ----------
    known : dict of int to bytes
        The hash of the world at each place of the line where it was once.
    """

    def __init__(self, world: World, seed: int, budget: int = 2**22) -> None:
        self.rng = random.Random(seed)
        self.history = History(world, budget)
        self.known, self._places = {0: state_hash(world)}, [0]

    def check(self) -> None:
        """Compare the world with what it was at this place, or note it."""
        here, found = self.history._places.here, state_hash(self.history.world)
        if here not in self.known:
            insort(self._places, here)
        assert self.known.setdefault(here, found) == found
        assert self.history.difference is None

    def forget(self, here: int) -> None:
        """Forget what came after a place, where the line goes on differently."""
        while self._places[-1] > here:
            del self.known[self._places.pop()]

    def undo(self) -> None:
        self.history.undo()
        self.check()

    def redo(self) -> None:
        self.history.redo()
        self.check()

    def seek(self) -> None:
        first, last = self.history.steps_range
        self.history.seek(self.rng.randint(first, last))
        self.check()

    def run(self, steps: int) -> None:
        self.forget(self.history._places.here)
        with suppress(Diverged):
            self.history.step(self.rng.choice((None, None, 0.01)), steps)
        self.check()

    def edit(self) -> None:
        """Make an edit, which may be refused."""
        command, here = self._command(), self.history._places.here
        try:
            self.history.do(command)
        except (ValueError, KeyError, TypeError):
            assert self.history._places.here == here
        else:
            self.forget(here)
        self.check()

    def drag(self) -> None:
        """Do what a hand does: take hold of something, move it, let go."""
        movers = self._movers()
        if not movers:
            return
        self.forget(self.history._places.here)
        history, entity = self.history, self.rng.choice(movers)
        history.write(AddComponent(entity, Held((0.05, 0.0))))
        for _ in range(3):
            place = (self.rng.gauss(0, 2), self.rng.gauss(0, 2))
            history.write(SetField(entity, "Velocity", "linear", place))
            history.step()
        history.write(RemoveComponent(entity, "Held"))
        self.check()

    def anything(self) -> None:
        """Do something that is chosen at random."""
        kind = self.rng.random()
        if kind < 0.45:
            self.edit()
        elif kind < 0.75:
            self.run(self.rng.randint(1, 4))
        elif kind < 0.85:
            self.undo()
        elif kind < 0.95:
            self.redo()
        elif kind < 0.98:
            self.drag()
        else:
            self.seek()
            self.history.seek(self.history.steps_range[1])  # else the line would stay short

    def refused(self) -> None:
        """Try what no world allows: nothing is recorded, and nothing changes."""
        before, entries = state_hash(self.history.world), self.history.entries
        entity = (self._movers() or [1])[0]
        half = Group("half", [Spawn([Transform()]), SetField(10**6, "Mass", "mass", 1.0)])
        for command in (SetField(entity, "Velocity", "linear", float("nan")), Remove(10**6), half):
            try:
                self.history.do(command)
            except (ValueError, KeyError, TypeError):
                continue
            raise AssertionError(command)
        assert self.history.entries == entries and state_hash(self.history.world) == before

    def back_to_the_start(self) -> None:
        """Undo everything."""
        while self.history.undo() is not None:
            if self.history._places.here in self.known:
                assert self.known[self.history._places.here] == state_hash(self.history.world)
        assert self.history._places.here == 0 and state_hash(self.history.world) == self.known[0]

    def _movers(self) -> list[int]:
        world = self.history.world
        return [e for e in world.entities() if world.has(e, Velocity) and world.has(e, Transform)]

    def _command(self) -> Command:
        rng, movers, world = self.rng, self._movers(), self.history.world
        kind = rng.randrange(12)
        if (kind < 3 and len(movers) < 14) or len(movers) < 3:
            return self._spawn()
        entity = rng.choice(movers)
        match kind:
            case 3 | 4 | 5:
                return Remove(rng.choice(world.entities()))
            case 6:
                return SetField(entity, "Velocity", "linear", (rng.gauss(0, 2), rng.gauss(0, 2)))
            case 7:
                return SetField(entity, "Transform", "position", (rng.uniform(-1, 1), rng.uniform(0.2, 2)))
            case 8:
                part = rng.choice((Drag(rng.uniform(0, 2)), Material(rng.random(), 0.4), Name(f"n{entity}")))
                return AddComponent(entity, part)
            case 9:
                return RemoveComponent(entity, rng.choice(("Drag", "Material", "Mass", "Shape")))
            case 10:
                return SetPhysics({"gravity": (rng.uniform(-1, 1), rng.uniform(-10, 1))})
            case 11:
                return SetSimulation({"substeps": rng.choice((1, 2, 4))})
            case _:
                return SetField(entity, "Mass", "mass", rng.uniform(0.5, 3))

    def _spawn(self) -> Command:
        rng, number = self.rng, self.history.next_entity
        place = (rng.uniform(-1, 1), rng.uniform(0.2, 2))
        body = [Transform(place), Velocity(), Mass(1.0), Shape("circle", radius=rng.uniform(0.05, 0.2))]
        if rng.random() < 0.7:
            return Spawn(body, rng.choice((None, f"body {number}")))
        hung = Spring(a=number, anchor_b=(place[0], 2.5), rest_length=0.5, stiffness=20.0)
        return Group("made a pendulum on a spring", [Spawn(body), Spawn([hung])])
