"""Impacts in the window: each is read once, and shown at its own place with its own figures."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from desk import FRAME, Desk, empty_world
from recording import RecordingCanvas

from physicslab.contacts.report import ImpactReader
from physicslab.prefabs import circle
from physicslab.view.canvas.quantities import quantity
from physicslab.view.overlay.contact_samples import RecentImpacts
from physicslab.world import World


def rattling(collisions: str = "exact") -> World:
    """Return a ball that bounces to and fro between two walls, 40 times a second."""
    world = empty_world(gravity=(0, 0), bounds=(-0.5, -3, 0.5, 3), bounds_restitution=1.0)
    world.simulation = replace(world.simulation, collisions=collisions)
    circle(world, (0, 0), radius=0.25, mass=1.0, velocity=(20, 0), restitution=1.0)
    return world


@pytest.mark.parametrize("steps", [1, 3, 8])
@pytest.mark.parametrize("collisions", ["exact", "step"])
def test_each_impact_is_read_once_however_many_steps_a_frame_has(steps: int, collisions: str) -> None:
    world, reader, read = rattling(collisions), ImpactReader(), []
    reader.follow(world)
    for _ in range(10):
        for _ in range(steps):
            world.step(FRAME)
        read.append(reader.new(world))
        assert not len(reader.new(world)), "a frame without a step has no impact"
    assert world.collisions == sum(map(len, read)) > 5
    assert np.array_equal(np.concatenate(read), world.contacts.impacts)


def test_of_more_impacts_than_the_log_holds_the_last_are_read() -> None:
    world, reader = rattling(), ImpactReader()
    reader.follow(world)
    world.contacts.log = world.contacts.log[:16].copy()
    world.run(seconds=1.0)
    assert world.contacts.logged > 30
    assert np.array_equal(reader.new(world), world.contacts.impacts)


def test_impacts_from_before_a_world_was_shown_and_those_taken_back_are_not_read() -> None:
    world, reader = rattling(), ImpactReader()
    world.run(seconds=0.5)
    reader.follow(world)
    assert not len(reader.new(world))
    world.contacts.logged -= 3  # as where a step that failed is taken back
    assert not len(reader.new(world))
    before = world.contacts.logged
    world.run(seconds=0.1)
    assert len(reader.new(world)) == world.contacts.logged - before > 0


def test_two_impacts_of_a_pair_within_a_frame_are_shown_at_their_own_places() -> None:
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(rattling(), canvas)
    desk.key("e")
    desk.frames()
    while desk.window.pace.speed < 4.0:
        desk.key("]")
        desk.frames()
    canvas.calls.clear()
    before = desk.world.collisions
    desk.frames()
    assert desk.world.collisions >= before + 2
    kept = desk.window.overlays.impacts.kept
    assert sorted(np.round(kept["place"][:, 0], 6)) == [-0.5, 0.5]
    assert canvas.words.count(f"impact at {quantity(20.0, 'm/s')}") == 2
    assert canvas.words.count(f"normal {quantity(40.0, 'N s')}") == 2


def test_slow_motion_shows_an_impact_once() -> None:
    desk = Desk(rattling(), RecordingCanvas((1280, 720)))
    desk.key("e")
    desk.key("tab")
    noted = []
    for _ in range(12):
        desk.frames()
        noted.append(len(desk.window.sparks.rings))  # they take no energy: there are no sparks
    assert desk.world.collisions == 2
    assert sum(after > before for before, after in itertools.pairwise(noted)) == 2


def test_of_impacts_of_a_pair_at_one_place_the_one_that_stands_out_most_is_kept() -> None:
    world, recent = rattling(), RecentImpacts()
    world.run(seconds=0.2)
    impacts = world.contacts.impacts[-3:].copy()
    impacts["x"], impacts["y"] = [0.0, 0.05, 1.0], 0.0
    impacts["normal_impulse"], impacts["time"] = [1.0, 3.0, 2.0], world.time
    recent.note(world, impacts, reach=1.0)
    assert recent.kept["normal"].tolist() == [3.0, 2.0]
    impacts["normal_impulse"] = [1.0, 2.0, 5.0]
    recent.note(world, impacts, reach=1.0)
    assert recent.kept["normal"].tolist() == [5.0, 3.0]
    assert len(np.unique(recent.kept["point"])) == 2


def test_impacts_of_bodies_that_are_gone_are_left_out() -> None:
    world, recent = rattling(), RecentImpacts()
    world.run(seconds=0.2)
    impacts = world.contacts.impacts
    world.clear()
    world.synchronise()
    recent.note(world, impacts, reach=1.0)
    assert len(impacts) and not len(recent.kept)
