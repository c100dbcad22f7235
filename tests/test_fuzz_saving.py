"""Any scene goes on from a file with the same bits as without one.

A few random scenes are tried with every run of the tests, 1,200 by

    pytest -m fuzz --fuzz thorough tests/test_fuzz_saving.py
"""

from __future__ import annotations

import json
from typing import Any

from crowds import crowd, few
from hypothesis import example, given, settings
from hypothesis import strategies as st

from physicslab.components import Transform, Velocity
from physicslab.files.json_text import json_text
from physicslab.files.scene import read_scene, write_scene
from physicslab.state.masses import Diverged
from physicslab.world import World

AFTER = 10
"""Steps in which two worlds are compared: what a file lacks shows in the first few."""


def bits(world: World) -> list[bytes]:
    """Return the state of every body, bit by bit."""
    columns = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))
    world.synchronise()
    return [world.table(kind)[name][1:].tobytes() for kind, name in columns]


def goes_on(document: dict[str, Any], steps: int) -> None:
    """Run a scene, save and load it, and go on with both."""
    world = read_scene(document)
    try:
        world.run(steps=steps)
        again = read_scene(json.loads(json_text(write_scene(world))))
        world.run(steps=AFTER)
        again.run(steps=AFTER)
    except Diverged:
        return
    assert bits(again) == bits(world)
    assert again.plan.kept == world.plan.kept


EXAMPLES = settings().max_examples


CASES = settings(max_examples=20 if EXAMPLES <= 40 else EXAMPLES, derandomize=True)
SEEDS, STEPS = st.integers(0, 2**31), st.sampled_from((1, 20, 40, 120))


@CASES
@given(SEEDS, STEPS)
@example(3368, 40).via("impulses of a contact that exact collisions had taken apart")
@example(3552, 40).via("the order of blocks, of which the last were empty when there was no room")
@example(115681, 120).via("the forces under which a body on a spring fell asleep")
@example(705758920, 1).via("a deep overlap without an impulse, which exact collisions leave to contacts")
@example(226807876, 40).via("an approach noted at a point that had been lost and found since")
@example(36669189, 1).via("a box that turned fast, whose pair with a wall was not listed")
@example(3456, 1).via("a body that is hit meets one that was not near it before, in one substep")
@example(4215201, 120).via("loads by normals of contacts in blocks, which records do not follow")
@example(78572410, 1).via("pairs listed again between two rounds of impacts, in one of both worlds")
def test_a_scene_goes_on_from_a_file_with_the_same_bits(seed: int, steps: int) -> None:
    document = crowd(seed)
    document["simulation"]["contacts"] = "soft"
    goes_on(document, steps)


@CASES
@given(SEEDS, STEPS)
def test_a_scene_of_few_bodies_does_with_the_contacts_that_it_chooses(seed: int, steps: int) -> None:
    goes_on(few(seed), steps)


def test_a_scene_of_about_64_goes_on_from_a_file_after_a_removal() -> None:
    """Of up to 64 rows points of boxes are found again after any motion: blank rows do not count."""
    document = crowd(1046)
    document["simulation"]["contacts"] = "soft"
    world = read_scene(document)
    world.run(steps=2)
    world.remove(15)
    again = read_scene(json.loads(json_text(write_scene(world))))
    world.run(steps=4)
    again.run(steps=4)
    rows = [made.batch(Transform).rows for made in (world, again)]
    places = [made.table(Transform)["position"][row] for made, row in zip((world, again), rows, strict=True)]
    assert len(world.entity_index) == len(again.entity_index) + 1 == 65
    assert places[0].tobytes() == places[1].tobytes()
