"""Contacts between unlike masses: stacks make no energy, heaps give back what is told, rigid ones nothing."""

import math
import random
from collections.abc import Iterable

import pytest

from physicslab import World
from physicslab.components import Transform
from physicslab.components.vertices import regular
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.warnings import UNLIKE_LIMIT, find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.accounts import CONTACT, ENERGY
from physicslab.prefabs import box, circle, polygon
from physicslab.systems.standard import standard_systems

FROM_NOWHERE = "energy that comes from nowhere"


def soft_world(gravity_mode: str = "linear", contacts: str = "soft") -> World:
    physics = PhysicsConfig(gravity_mode=gravity_mode)
    return World(*standard_systems(), simulation=SimulationConfig(contacts=contacts), physics=physics)


def floor(world: World) -> None:
    box(world, (0, -0.5), width=40, height=1, static=True, friction=0.5)


def spawn(world: World, kind: str, at: tuple[float, float], height: float, mass: float) -> int:
    if kind == "box":
        return box(world, at, width=1.0, height=height, mass=mass, friction=0.5)
    if kind == "disc":
        return circle(world, at, radius=0.5 * height, mass=mass, friction=0.5)
    return polygon(world, at, list(regular(6, height / math.sqrt(3.0))), mass=mass, friction=0.5)


def given(world: World, steps: int) -> float:
    """Return by how much contacts have given more than where they had taken most, in so many steps [J]."""
    taken = most = 0.0
    for _ in world.stepping(steps=steps):
        energy = float(world.account.sums[CONTACT, ENERGY])
        taken = min(taken, energy)
        most = max(most, energy - taken)
    return most


@pytest.mark.parametrize("kind", ["box", "hexagon", "mixed"])
@pytest.mark.parametrize("seed", range(4))
def test_stacks_of_random_masses_gain_no_more_than_their_overlap_lifts(kind: str, seed: int) -> None:
    chance, world, top, lifted = random.Random(seed), soft_world(), 0.0, 0.0
    floor(world)
    for _ in range(chance.randint(2, 8)):
        mass, height = 10.0 ** chance.uniform(0.0, 3.0), chance.uniform(0.3, 1.0)
        which = kind if kind != "mixed" else chance.choice(["box", "hexagon"])
        spawn(world, which, (chance.uniform(-0.02, 0.02), top + 0.5 * height), height, mass)
        top, lifted = top + height, lifted + mass * 9.81 * height
    assert given(world, 90) < 0.01 * lifted
    assert FROM_NOWHERE not in "".join(str(advice) for advice in find_warnings(world))


@pytest.mark.parametrize("kind", ["box", "hexagon", "disc"])
@pytest.mark.parametrize("seed", [3, 7])
def test_what_heaps_that_fall_on_each_other_give_back_is_bounded_and_told(kind: str, seed: int) -> None:
    """Sweeps leave a part of what pushed heavy bodies out of light ones as motion."""
    chance, world, lifted = random.Random(seed), soft_world(), 0.0
    floor(world)
    for side in (-1.0, 1.0):
        box(world, (1.8 * side, 10.0), width=0.5, height=20.0, static=True, friction=0.5)
    for i in range(12):
        mass, height = 10.0 ** chance.uniform(0.0, 3.0), chance.uniform(0.3, 1.0)
        at = (i % 2 - 0.5) * 1.1, 0.55 + i // 2 * 1.05 + chance.uniform(0.0, 0.04)
        spawn(world, kind, at, height, mass)
        lifted += mass * 9.81 * height
    taken, most, settings = 0.0, 0.0, set[str]()
    for _ in world.stepping(steps=120):
        energy = float(world.account.sums[CONTACT, ENERGY])
        taken = min(taken, energy)
        if energy - taken > most:
            most = energy - taken
            settings |= {told.setting for told in find_warnings(world) if FROM_NOWHERE in told.what}
    assert most < 0.45 * lifted
    assert most < UNLIKE_LIMIT * lifted or settings == {'simulation.contacts = "rigid"'}
    assert (most > UNLIKE_LIMIT * lifted) == (seed == 7), "both cases are there"
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-9 * lifted


def fallen(steps: Iterable[int]) -> tuple[bytes, set[int]]:
    """Return where a heap of unlike boxes is after calls of so many steps, and the numbers of substeps."""
    chance, world, substeps = random.Random(2), soft_world(), set[int]()
    floor(world)
    for i in range(20):
        at = 1.02 * (i % 4) + chance.uniform(0.0, 0.01), 0.6 + 1.05 * (i // 4)
        spawn(world, "box", at, 1.0, 10.0 ** chance.uniform(0.0, 3.0))
    for count in steps:
        world.run(steps=count)
        substeps.add(world.substeps)
    return world.table(Transform)["position"].tobytes(), substeps


def test_substeps_are_the_same_however_a_run_is_divided() -> None:
    single, substeps = fallen([1] * 60)
    assert len(substeps) > 1, "loads come and go"
    assert fallen([60])[0] == fallen([7, 23, 30])[0] == single


@pytest.mark.parametrize(("contacts", "share"), [("soft", 0.33), ("rigid", 1e-12)])
@pytest.mark.parametrize("masses", [(1.0, 1000.0), (1000.0, 1.0, 1000.0), (1.0, 1.0, 1.0, 1000.0)])
def test_how_far_what_is_dropped_on_something_light_jumps(
    masses: tuple[float, ...], contacts: str, share: float
) -> None:
    """Soft contacts give back up to a third of what pressed bodies together, rigid ones nothing."""
    world = soft_world(contacts=contacts)
    floor(world)
    bodies = [spawn(world, "box", (0.0, n + 0.5), 1.0, mass) for n, mass in enumerate(masses)]
    world.component(bodies[-1], Transform).position = (0.0, len(masses) - 0.45)
    lowest, rebound = math.inf, 0.0
    for _ in world.stepping(steps=120):
        energy = measure_energy(world).total
        lowest = min(lowest, energy)
        rebound = max(rebound, energy - lowest)
    assert rebound < share * masses[-1] * 9.81 * 0.05


def test_a_stack_that_exploded_comes_to_rest() -> None:
    world = soft_world()
    floor(world)
    bodies = [
        spawn(world, "box", (0.0, n + 0.5), 1.0, mass) for n, mass in enumerate((1000.0, 1.0, 1000.0, 1.0))
    ]
    world.run(steps=120)
    for n, body in enumerate(bodies):
        place = world.component(body, Transform).position
        assert abs(place.x) < 1e-9
        assert abs(place.y - n - 0.5) < 1e-4
    before = measure_energy(world).kinetic
    assert before < 1e-9


def test_energy_that_contacts_have_made_is_told_with_the_bodies_and_what_to_change() -> None:
    world = soft_world("none")
    for _ in range(12):
        circle(world, (0.0, 0.0), radius=0.1)
    world.run(steps=20)
    (told,) = [advice for advice in find_warnings(world) if FROM_NOWHERE in advice.what]
    assert told.unit == "J"
    assert told.value == pytest.approx(measure_account(world).energy["contact"])
    assert told.entity is not None
    assert " and " in told.entity
    assert told.setting == 'simulation.contacts = "rigid"'
