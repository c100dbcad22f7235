"""Wide contacts: the same result as one by one, no body twice in a block, woken by an impact."""

import math
from dataclasses import replace

import numpy as np
import pytest
from desk import bits
from kept_contacts import kept_contacts

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts import near_pairs
from physicslab.contacts.arguments import do_stage, near_in
from physicslab.contacts.memory import restore_contacts
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig
from physicslab.files.scene import read_scene, write_scene
from physicslab.kernels import near_counts
from physicslab.kernels.solver import soft
from physicslab.kernels.wide import restore_slots
from physicslab.kernels.wide_layout import MASS_A, MASS_B, WIDE
from physicslab.lab.worlds import floor, open_space, place
from physicslab.prefabs import (
    BodyOptions,
    box,
    capsule,
    circle,
    container,
    ground,
    pile,
    polygon,
    pyramid,
    regular_polygon,
)
from physicslab.state.shapes import REGISTER
from physicslab.world import World


def settled_boxes() -> World:
    world = open_space()
    floor(world)
    pyramid(world, 15)
    world.run(seconds=1.0)
    return world


def settled_discs() -> World:
    world = open_space()
    container(world, width=3.0, height=6.0)
    pile(world, 120, columns=11)
    world.run(seconds=6.0)
    return world


def mixed(steps: int) -> World:
    """Return discs and boxes that fall into a container, so many steps later."""
    world, rng = open_space(), np.random.default_rng(3)
    container(world, width=3.0, height=9.0)
    for i in range(150):
        place = (-1.2 + 0.27 * (i % 10) + rng.uniform(-0.01, 0.01), 0.3 + 0.27 * (i // 10))
        if i % 2:
            circle(world, place, radius=rng.uniform(0.08, 0.12), restitution=0.0)
        else:
            box(world, place, width=0.2, height=0.15, angle=rng.uniform(-0.3, 0.3), restitution=0.0)
    world.run(steps=steps)
    return world


def settled_mixed() -> World:
    return mixed(400)


def settled_rounded() -> World:
    """Return polygons, capsules, boxes and discs on a chain that turns now and then."""
    world = open_space()
    container(world, width=4.0, height=6.0)
    ground(world, [(2.0, 0.6), (1.0, 0.3), (0.3, 0.25), (0.0, 0.2), (-0.3, 0.25), (-1.0, 0.3), (-2.0, 0.6)])
    for i in range(120):
        at = -1.6 + 0.36 * (i % 10), 0.8 + 0.36 * (i // 10)
        if i % 4 == 0:
            capsule(world, at, length=0.1, radius=0.08, angle=0.3 * i, restitution=0.0)
        elif i % 4 == 1:
            regular_polygon(world, at, corners=3 + i % 6, radius=0.14, angle=0.7 * i, restitution=0.0)
        elif i % 4 == 2:
            box(world, at, width=0.2, height=0.15, angle=0.2 * i, restitution=0.0)
        else:
            circle(world, at, radius=0.1, restitution=0.0)
    world.run(steps=300)
    return world


ADDED = {
    "boxes": settled_boxes, "discs": settled_discs, "mixed": settled_mixed, "rounded": settled_rounded,
}  # fmt: skip


@pytest.mark.parametrize("name", ADDED)
def test_steady_contacts_are_in_blocks(name: str) -> None:
    world = ADDED[name]()
    assert world.contacts.wide.filled > 0.7 * world.contacts.count
    assert world.contacts.count == world.contacts.active + world.contacts.wide.filled


@pytest.mark.parametrize("name", ADDED)
def test_no_block_moves_a_body_twice(name: str) -> None:
    world = ADDED[name]()
    for constraints in world.contacts.wide.kinds:
        for k in range(constraints.count):
            span = slice(k * WIDE, (k + 1) * WIDE)
            taken = constraints.pair[span] >= 0
            rows = np.concatenate((constraints.a[span][taken], constraints.b[span][taken]))
            rows = rows[world.bodies.inverse_mass[rows] > 0.0]
            assert len(np.unique(rows)) == len(rows)


@pytest.mark.parametrize("name", ADDED)
def test_every_pair_has_one_slot_or_is_scalar(name: str) -> None:
    contacts = ADDED[name]().contacts
    restored = np.concatenate([kind.pair[: kind.count * WIDE] for kind in contacts.wide.kinds])
    restored = restored[restored >= 0]
    all_pairs = np.sort(np.concatenate((restored, contacts.scalar[: contacts.scalar_count])))
    assert np.array_equal(all_pairs, np.arange(contacts.recorded))


@pytest.mark.parametrize("name", ADDED)
def test_eight_at_a_time_come_to_what_one_by_one_do(name: str) -> None:
    """Both solvers, from the same state and in the same order, agree to rounding."""
    world = ADDED[name]()
    world.step()
    contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
    contacts.sync()
    blocks = contacts.wide
    order = [
        int(p)
        for kind in blocks.kinds
        for k in kind.order[: kind.count]
        for p in kind.pair[k * WIDE : (k + 1) * WIDE]
        if p >= 0
    ]
    h = contacts.impulse_dt = 1.0 / 240.0
    world.simulation = replace(world.simulation, iterations=1)
    velocity["linear"][bodies.inverse_mass > 0.0] -= (0.0, 9.81 * h)
    world.has_forces = world.uniform_forces = True
    ends, begin = [], (velocity["linear"].copy(), velocity["angular"].copy())
    for in_blocks in (True, False):
        velocity["linear"][:], velocity["angular"][:] = begin
        counts = contacts.counts.copy()
        counts[near_counts.ACTIVE] = counts[near_counts.LEFT] = 0 if in_blocks else len(order)
        if not in_blocks:
            for count in (near_counts.WIDE_COUNT, near_counts.DISC_BLOCKS, near_counts.BOX_BLOCKS):
                counts[count] = 0
        discs, boxes = ((kind.kind, kind.data.copy(), *kind.slots[2:]) for kind in blocks.kinds)
        near = near_in(world)
        points, touching = contacts.points.copy(), np.array(order, np.int64)
        near = (counts, near[1], points, near[3], touching, discs, boxes, *near[7:])
        inverse = (bodies.inverse_mass, bodies.inverse_inertia)
        do_stage(world, soft.SOLVE, h, softness=(0.17, 7.0, 1.5), near=near, inverse=inverse)
        ends.append((velocity["linear"].copy(), velocity["angular"].copy()))
    assert ends[0][0] == pytest.approx(ends[1][0], rel=1e-9, abs=1e-12)
    assert ends[0][1] == pytest.approx(ends[1][1], rel=1e-9, abs=1e-11)


def test_what_moves_has_slots_too_and_a_file_goes_on_with_them() -> None:
    world = mixed(25)
    assert measure_energy(world).kinetic > 0.1
    again = read_scene(write_scene(world))
    shares = []
    for _ in range(50):
        world.step()
        again.step()
        assert bits(again) == bits(world)
        shares.append(world.contacts.wide.filled / world.contacts.count)
    assert np.median(shares) > 0.6
    kinds = world.table(Shape)["kind"]
    records = world.contacts.manifolds[: world.contacts.recorded]
    wide = records[records["slot"] >= 0]
    assert set((kinds[wide["a"]] + kinds[wide["b"]]).tolist()) == {2, 3, 4}, "pairs of all shapes"


def test_what_slides_fast_under_load_has_a_slot() -> None:
    world = open_space()
    floor(world, width=400.0)
    for i in range(80):
        slider = box(world, (i - 40.0, 0.1), width=0.4, height=0.2, friction=0.1)
        world.component(slider, Velocity).linear = (2.4, 0.0)  # a twentieth of its height in a substep
    for _ in range(20):
        world.step()
    assert world.table(Velocity)["linear"][-1, 0] > 1.5
    assert world.contacts.wide.filled == world.contacts.count == 80
    assert world.table(Transform)["position"][-1, 1] == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize("kind", ["discs", "boxes", "floor"])
def test_what_overlaps_deeply_has_a_slot_and_is_moved_apart(kind: str) -> None:
    world = open_space()
    world.physics = PhysicsConfig(gravity_mode="none")
    for i in range(70):
        x = 3.0 * i
        if kind == "discs":
            circle(world, (x, 0.0), radius=0.5)
            circle(world, (x + 0.8, 0.0), radius=0.5)
        else:
            box(world, (x, 0.0), width=1.0, height=1.0, static=kind == "floor")
            box(world, (x, 0.8), width=1.0, height=1.0)
    world.step()
    assert world.contacts.wide.filled == 70
    assert world.contacts.max_penetration < 0.19
    world.run(steps=60)
    assert world.contacts.max_penetration <= 0.1 + 1e-9
    energy = measure_energy(world)
    assert energy.kinetic < 70 * 0.5 * 0.1**2, "moving them apart gives them little speed"


def test_few_contacts_stay_scalar() -> None:
    world = open_space(contacts="soft")
    floor(world)
    for i in range(5):
        box(world, (0.0, 0.5 + i), width=1.0, height=1.0)
    world.run(seconds=2.0)
    assert world.contacts.wide.filled == 0


def test_a_pile_with_wide_contacts_rests_and_keeps_its_momentum() -> None:
    world = settled_discs()
    energy = measure_energy(world).total
    world.run(seconds=2.0)
    assert measure_energy(world).total <= energy + 1e-6 * abs(energy)
    assert measure_momentum(world).linear.magnitude < 0.05 * 120


def test_an_impact_goes_through_a_resting_row_of_elastic_balls() -> None:
    world = open_space(gravity=None, collisions="step")
    balls = [circle(world, (0.2 * i, 0.0), radius=0.1, restitution=1.0, friction=0.0) for i in range(80)]
    world.run(steps=5)
    assert world.contacts.wide.filled > 60
    circle(world, (-1.0, 0.0), radius=0.1, restitution=1.0, friction=0.0, velocity=(2.0, 0.0))
    world.run(seconds=1.0)
    speeds = [world.component(ball, Velocity).linear.x for ball in balls]
    assert speeds[-1] == pytest.approx(2.0, rel=0.02)
    assert max(abs(speed) for speed in speeds[:-1]) < 0.05


@pytest.mark.parametrize("name", ADDED)
def test_an_impact_in_a_heap_from_a_file_gives_the_bits_of_the_heap_that_was_saved(name: str) -> None:
    """What an impact wakes must not depend on how old its record is: that of a file is blank."""
    world = ADDED[name]()
    rows = world.batch(Material).rows
    world.table(Material)["restitution"][rows] = 0.8
    world.run(steps=1)
    again, wide = read_scene(write_scene(world)), world.contacts.wide.filled
    for heap in (world, again):
        circle(heap, (0.05, 8.0), velocity=(0.0, -30.0), radius=0.2, mass=5.0, restitution=0.9)
        filled = []
        for _ in range(40):
            heap.step()
            filled.append(heap.contacts.wide.filled)
        assert min(filled) < wide, "some were woken"
    assert bits(again) == bits(world)


def test_a_mass_changed_by_hand_counts_from_the_next_step() -> None:
    worlds = [settled_boxes() for _ in range(2)]
    top = max(
        (entity for entity in worlds[0].entities() if worlds[0].has(entity, Mass)),
        key=lambda entity: place(worlds[0], entity).y,
    )
    worlds[0].component(top, Mass).mass = 2.0
    for world in worlds:
        world.step()
        world.contacts.sync()
    near = worlds[0].contacts.manifolds[: worlds[0].contacts.recorded]
    touches = (near["count"] > 0) & ((near["entity_a"] == top) | (near["entity_b"] == top))
    felt = [
        float(world.contacts.points["normal_impulse"].reshape(-1, 2)[: len(near)][touches].sum())
        for world in worlds
    ]
    assert felt[0] > 1.2 * felt[1]


def test_other_vertices_of_the_same_extents_count_from_the_next_step() -> None:
    """The mirror image of a triangle is as large, as heavy and as hard to turn, and touches elsewhere."""
    world, corners = open_space(), [(-0.3, -0.2), (0.6, -0.2), (-0.3, 0.4)]
    floor(world, width=200.0)
    wedges = [polygon(world, (1.2 * i - 48.0, 0.2), corners) for i in range(80)]
    world.run(steps=30)
    assert world.contacts.wide.filled == 80
    shape = world.component(wedges[7], Shape)
    shape.vertices = [(-x, y) for x, y in reversed(corners)]
    world.step()
    world.contacts.sync()
    near = world.contacts.manifolds[: world.contacts.recorded]
    used = np.arange(2) < near["count"][:, None]
    arms = np.where(used, world.contacts.points["arm_bx"].reshape(-1, 2)[: len(near)], -np.inf)
    for wedge, right in ((wedges[6], 0.6), (wedges[7], 0.3)):
        assert arms[near["entity_b"] == wedge].max() == pytest.approx(right, abs=1e-3)


@pytest.mark.parametrize("name", ["boxes", "mixed"])
def test_a_body_made_smaller_is_so_in_a_copy_and_a_file_too(name: str) -> None:
    """Slots filled from records of the outline before were followed: what it had left went on pressing."""
    world = settled_boxes() if name == "boxes" else mixed(400)
    body = world.batch(Mass, Shape).entities.tolist()[50]
    worlds = [world, world.copy(), world.copy()]
    for each in worlds:
        shape = each.component(body, Shape)
        shape.width, shape.height, shape.radius = 0.8 * shape.width, 0.8 * shape.height, 0.8 * shape.radius
    worlds[2] = read_scene(write_scene(worlds[2]))
    for each in worlds:
        each.run(steps=2)
    assert bits(worlds[1]) == bits(world)
    assert bits(worlds[2]) == bits(world)


_ROOM = 1800
"""Rows for vertices that are not taken yet: those of some forty triangles."""


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_vertices_that_are_new_in_this_process_count_whatever_room_there_is_for_them(contacts: str) -> None:
    world = open_space(contacts=contacts)
    floor(world)
    wedge = polygon(world, (0.0, 0.2), [(-0.3, -0.2), (0.6, -0.2), (-0.3, 0.4)])
    world.run(steps=5)
    shape, edits = world.component(wedge, Shape), 0
    room = np.zeros((int(REGISTER.kinds[:, 1].max()) + _ROOM, 4))  # however many other tests have taken
    used = min(len(room), len(REGISTER.pool))
    room[:used], REGISTER.pool = REGISTER.pool[:used], room
    while REGISTER.pool is room:
        edits += 1
        share = 1.0 + 1e-9 * (edits + 1000 * (contacts == "soft"))
        shape.vertices = [(-0.3, -0.2 * share), (0.6, -0.2 * share), (-0.3, 0.4 * share)]
        world.step()
        assert place(world, wedge).y == pytest.approx(0.2, abs=1e-3), edits
    assert edits > 30


def test_removing_a_body_lets_those_above_fall() -> None:
    world = settled_boxes()
    lowest = [entity for entity in world.entities() if world.has(entity, Mass)][:15]
    before = max(place(world, entity).y for entity in world.entities() if world.has(entity, Mass))
    for entity in lowest:
        world.remove(entity)
    world.run(seconds=3.0)  # they bounce before they rest
    after = max(place(world, entity).y for entity in world.entities() if world.has(entity, Mass))
    assert after == pytest.approx(before - 1.0, abs=1e-3)
    assert np.isfinite(world.table(Transform)["position"]).all()


def test_slots_that_a_file_makes_up_stay_scalar() -> None:
    """Two contacts in one slot, boxes in a slot of discs, a body twice in a block, a slot far out."""
    for spoiled in ("one slot", "wrong kind", "one block", "far out"):
        world = settled_boxes()
        rows = [row for row in kept_contacts(world.contacts) if len(row) > 20]
        world.contacts.clear()
        slots: dict[str, list[tuple[float, float]]] = {
            "one slot": [(1, 0) for _ in rows],
            "wrong kind": [(row[-2] - 1, row[-1]) for row in rows],
            "one block": [(2 * n + 1, 0) for n in range(len(rows))],
            "far out": [(10**15 + 1, 0) for _ in rows],
        }
        changed = [[*row[:-2], *slot] for row, slot in zip(rows, slots[spoiled], strict=True)]
        restore_contacts(world.contacts, changed)
        world.run(steps=30)
        contacts = world.contacts
        restored = np.concatenate([kind.pair[: kind.count * WIDE] for kind in contacts.wide.kinds])
        restored = restored[restored >= 0]
        all_pairs = np.sort(np.concatenate((restored, contacts.scalar[: contacts.scalar_count])))
        assert np.array_equal(all_pairs, np.arange(contacts.recorded))
        assert len(restored) == contacts.wide.filled
        assert contacts.max_penetration < 0.02


def test_all_slots_of_a_pile_are_restored_from_a_file() -> None:
    """Where none is added after they got slots, they are solved in their order all the same."""
    world = settled_discs()
    again = read_scene(write_scene(world))
    for _ in range(20):
        world.step()
        again.step()
        assert bits(again) == bits(world)
    assert again.contacts.wide.filled == world.contacts.wide.filled > 100


@pytest.mark.parametrize("name", ADDED)
def test_every_block_is_solved_once_while_contacts_come_and_go(name: str) -> None:
    world = ADDED[name]()
    bodies = [entity for entity in world.entities() if world.has(entity, Mass)]
    for entity in bodies[::-7]:
        world.remove(entity)
        for _ in range(3):
            world.step()
            for constraints in world.contacts.wide.kinds:
                assert sorted(constraints.order[: constraints.count].tolist()) == list(
                    range(constraints.count)
                )


@pytest.mark.parametrize("name", ADDED)
def test_a_heavier_body_keeps_its_slots_with_the_new_mass(name: str) -> None:
    world = ADDED[name]()
    before = world.contacts.wide.filled
    body = [entity for entity in world.entities() if world.has(entity, Mass)][40]
    world.component(body, Mass).mass *= 1.1
    world.step()
    assert world.contacts.wide.filled > before - 12
    row, inverse = world.entity_index.row_of[body], world.bodies.inverse_mass
    for constraints in world.contacts.wide.kinds:
        for slot in np.flatnonzero(constraints.pair[: constraints.count * WIDE] >= 0):
            block = constraints.data[slot // WIDE * constraints.rows :]
            for rows, at in ((constraints.a, MASS_A), (constraints.b, MASS_B)):
                if rows[slot] == row:
                    assert block[at + slot % WIDE] == inverse[row]


@pytest.mark.parametrize("name", ADDED)
def test_an_edited_body_fills_its_own_slots_again_and_gives_the_bits_of_filling_all(name: str) -> None:
    ours, full = ADDED[name](), ADDED[name]()
    for world in (ours, full):
        body = [entity for entity in world.entities() if world.has(entity, Mass)][40]
        world.component(body, Mass).mass *= 1.1
        world.component(body, Material).friction *= 0.9
    with pytest.MonkeyPatch.context() as patch:
        filled: list[World] = []
        patch.setattr(near_pairs, "fill_again", filled.append)
        ours.run(steps=5)
        assert not filled
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(restore_slots, "outdated", lambda *arguments: 2)
        full.run(steps=1)
    full.run(steps=4)
    assert bits(ours) == bits(full)


@pytest.mark.parametrize("shape", ["box", "capsule"])
@pytest.mark.parametrize("restitution", [0.0, 0.6])
def test_an_end_that_comes_down_within_a_step_is_held(shape: str, restitution: float) -> None:
    # A hundred boards of 6 cm that stand on one end each: the other one lands at up to 3 m/s, 5 cm a step.
    world, half, thin = open_space(), 0.2, 0.03
    floor(world, width=400.0, restitution=restitution)
    made = []
    for k in range(100):
        tilt = 0.1 + 0.008 * k
        thick = thin if shape == "capsule" else thin * math.cos(tilt)
        at, law = (
            (k - 50.0, half * math.sin(tilt) + thick),
            BodyOptions(mass=1.0, angle=tilt, restitution=restitution),
        )
        if shape == "box":
            made.append(box(world, at, width=2.0 * half, height=2.0 * thin, **law))
        else:
            made.append(capsule(world, at, length=2.0 * half, radius=thin, **law))
    world.synchronise()
    rows = world.entity_index.rows_of(np.array(made))
    lowest, turning = 0.0, np.zeros(100)
    for _ in range(45):
        world.run(steps=1)
        transform, velocity = world.table(Transform), world.table(Velocity)
        angle = np.abs(transform["angle"][rows])
        below = half * np.sin(angle) + (thin if shape == "capsule" else thin * np.cos(angle))
        lowest = min(lowest, float((transform["position"][rows, 1] - below).min()))
        turning = np.maximum(turning, velocity["angular"][rows])
    assert world.contacts.wide.filled > 90
    assert lowest > -0.006  # -0.03 where ends were first looked for in the next step
    if restitution:
        assert np.count_nonzero(turning > 1.0) > 90  # they bounce


@pytest.mark.parametrize("restitution", [0.0, 0.6])
def test_other_ends_of_capsules_whose_ends_are_nearest_are_held(restitution: float) -> None:
    # A hundred capsules lie on fixed ones, each with an end on an end; the other one comes down.
    world, half, radius = open_space(), 0.1, 0.08
    lower, made = BodyOptions(static=True, restitution=restitution), []
    for k in range(100):
        tilt, x = 0.05 + 0.003 * k, 1.0 * k
        capsule(world, (x, 0.0), length=2.0 * half, radius=radius, **lower)
        at = x - 0.01 - half + half * math.cos(tilt), 2.0 * radius + half * math.sin(tilt)
        upper = BodyOptions(mass=1.0, angle=tilt, restitution=restitution)
        made.append(capsule(world, at, length=2.0 * half, radius=radius, **upper))
    world.synchronise()
    rows = world.entity_index.rows_of(np.array(made))
    lowest = 0.0
    for _ in range(30):
        world.run(steps=1)
        transform = world.table(Transform)
        angle, beside = transform["angle"][rows], transform["position"][rows, 0] - np.arange(100.0)
        above = transform["position"][rows, 1] + half * np.sin(angle) - 2.0 * radius
        on_it = np.abs(beside + half * np.cos(angle)) < half
        lowest = min(lowest, float(above[on_it].min(initial=0.0)))
    assert lowest > -0.001  # -0.005 where the nearest ends were all that touched


def test_a_heap_whose_contacts_become_many_has_loaded_what_they_need() -> None:
    """A room of 40 bodies loaded ten kernels as its 64th contact came, and stood still for 25 ms."""
    world = open_space()
    container(world, width=2.0, height=6.0)
    pile(world, 45, columns=8)
    world.run(steps=1)
    assert world.stepper is not None and world.contacts.wide.filled == 0
    assert set(world.contacts.wide.kernels) <= set(world.stepper.kernels)
    world.run(seconds=3.0)
    assert world.contacts.wide.filled > 64
