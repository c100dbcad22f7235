"""Any scene goes on from a file with the same bits as without one.

A few random scenes are tried with every run of the tests, 2,000 by

    pytest tests/test_fuzz_saving.py --hypothesis-profile=thorough
"""

from __future__ import annotations

import json
import random

from crowds import crowd
from hypothesis import given, settings
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


def goes_on(seed: int) -> str:
    """Run a scene, save and load it, and go on with both; return what moved it, or why it ended before."""
    world = read_scene(crowd(seed))
    try:
        world.run(steps=random.Random(seed).choice((1, 20, 40, 120)))
        again = read_scene(json.loads(json_text(write_scene(world))))
        world.run(steps=AFTER)
        again.run(steps=AFTER)
    except Diverged:
        return "diverged"
    assert bits(again) == bits(world)
    assert again.plan.kept == world.plan.kept
    assert world.stepper is not None
    return world.stepper.name


THOROUGH = settings().max_examples > 40


@settings(max_examples=2000 if THOROUGH else 20)
@given(st.integers(0, 2**31))
def test_a_scene_goes_on_from_a_file_with_the_same_bits(seed: int) -> None:
    goes_on(seed)
