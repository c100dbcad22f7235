"""Kernels as plain Python: the bits of compiled code, until that is there, and for a debugger."""

from __future__ import annotations

import ast
import json
import math
import os
import re
import subprocess
import sys
import tracemalloc
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numba
import numpy as np
import pygame
import pytest
from attraction import attraction
from both_tiers import compared, name_of, same_bits
from desk import bits

from physicslab.components import Mass, Molecule, Shape, Transform, Velocity
from physicslab.contacts.arguments import motion_of, near_in
from physicslab.desktop import compiling
from physicslab.desktop.compiling import INTERPRETING_LIMIT, SmallScenes
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, read_scene, write_scene
from physicslab.history import History
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.kernels import (
    KERNELS,
    ask_before_compiling,
    compile_kernels,
    digest,
    finishes,
    interpreter,
    lzw,
    motion,
    raster,
    triangles,
)
from physicslab.kernels.broad.leaving import SMALLS, FatBoxes
from physicslab.kernels.events.events import run_events
from physicslab.kernels.forces import gravity
from physicslab.kernels.forces.inverse_square import PLAIN_LIMIT, pair_potential
from physicslab.kernels.forces.pairwise import attract_pairwise
from physicslab.kernels.forces.tree_pull import MAX_ERROR, attract_by_tree
from physicslab.kernels.interpreter import fallback_of, install, interpreted
from physicslab.kernels.loading import direct_entry
from physicslab.kernels.near_counts import ACTIVE
from physicslab.kernels.ode.dop853 import dop853
from physicslab.kernels.python_equivalents import math_functions
from physicslab.kernels.python_fallback import natives
from physicslab.kernels.solver import soft
from physicslab.kernels.solver.lone_sweep import sweep_contacts
from physicslab.kernels.solver.sweep import sweep
from physicslab.kernels.tiers import natives_within
from physicslab.kernels.warm import Warmup
from physicslab.state.state import State
from physicslab.stepping import rigid_motion
from physicslab.stepping.rigid import Rigid
from physicslab.systems import broad_phase
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.view.canvas.canvas import Look
from physicslab.view.canvas.display import Display
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.world import World

ROOT = Path(__file__).parent.parent
Entity = dict[str, Any]


def scene(*entities: Entity, physics: Entity | None = None, **simulation: object) -> World:
    laws = {"gravity_mode": "linear", **(physics or {})}
    document = {"format": "physicslab-scene/1", "physics": laws, "simulation": simulation}
    named = [{"id": f"e{i}", **entity} for i, entity in enumerate(entities)]
    return read_scene({**document, "entities": named})


def body(x: float, y: float, shape: str = "", **more: object) -> Entity:
    """Return an entity of a scene at (x, y) [m]: a disc, a box or a point, which moves."""
    shapes = {"disc": {"kind": "circle", "radius": 0.5}, "box": {"kind": "box", "width": 1, "height": 1}}
    parts: Entity = {"Transform": {"position": [x, y]}, "Velocity": {}, "Mass": {"mass": 1.5}}
    if shape:
        parts |= {"Shape": shapes[shape], "Material": {"friction": 0.5, "restitution": 0.2}}
    return parts | more


FLOOR: Entity = {
    "Transform": {"position": [0, -0.5]}, "Shape": {"kind": "box", "width": 40, "height": 1},
    "Material": {"friction": 0.6, "restitution": 0.3},
}  # fmt: skip


def settled(shape: str, struck: bool = True) -> World:
    """Return so many discs or boxes in a heap that their contacts are solved eight at a time."""
    places = [(1.001 * (i % 9) - 4.0, 0.5 + 0.999 * (i // 9)) for i in range(63)]
    ball = body(0.3, 13.0, "disc", Velocity={"linear": [0.5, -6.0]})
    heap = [*(body(x, y, shape) for x, y in places), *([ball] if struck else [])]
    laws = {"bounds": [-4.6, -1, 4.6, 20]}
    return scene(FLOOR, *heap, physics=laws, sleeping=True)


def heaps() -> None:
    for shape in ("disc", "box"):
        world = settled(shape)
        world.run(steps=25)
        assert world.contacts.wide.filled > 0
        for _ in range(40):  # through every stage by itself, while a ball strikes the heap
            world.step(0.015)
        read_scene(write_scene(world)).step(0.01)
        world.component(7, Velocity).linear = (30.0, 0.0)
        lists = world.schedule.find(BroadPhaseSystem)
        assert lists is not None
        with patch.object(broad_phase, "_FEW", 1_000):  # all pairs are listed, while contacts have slots
            FatBoxes(*lists.fat).counts[SMALLS] = -1
            world.step()
        world.component(7, Mass).mass = 3.0
        world.step()
        assert world.contacts.max_penetration >= 0.0
    quiet = settled("box", struck=False)
    quiet.run(seconds=4.0)
    assert quiet.sleep.count > 0


def heavy_loads() -> None:
    heavy = body(0.0, 1.5, "box", Mass={"mass": 500.0}, Drag={"linear": 0.1})
    world = scene(FLOOR, body(0.0, 0.5, "box"), heavy, collisions="step", sleeping=True)
    for _ in range(3):
        world.step(0.01)


def sleepers() -> None:
    boxes = (body(x, 0.5, "box") for x in (0.0, 1.0, 5.0))
    world = scene(FLOOR, *boxes, collisions="step", sleeping=True)
    world.run(seconds=0.4)
    for _ in range(30):
        world.step()
    assert world.sleep.count == 3
    world.component(2, Transform).position = Vector2(0.0, 0.6)
    world.run(steps=3)
    world.spawn(Transform((5.0, 1.4)), Velocity((0.0, -1.0)), Mass(1.0), Shape.circle(0.4))
    world.step()
    world.run(steps=4)


def planets() -> None:
    rocks = [body(3.0 * math.cos(i), 3.0 * math.sin(2 * i)) for i in range(9)]
    for law in ("clamp", "plummer"):
        world = scene(*rocks, physics={"gravity_mode": "planet", "softening": 0.1, "softening_law": law})
        world.run(steps=2)
        measure_energy(world)
    sun: Entity = {"Transform": {"position": [9.0, 0.5]}, "Mass": {"mass": 2.0}}
    scene(sun, *rocks, physics={"gravity_mode": "planet"}).run(steps=2)
    for fling in (0.8, 3.0):  # an ellipse, in whole and in short spans, and a hyperbola
        planet = body(3.0, 0.0) | {"Velocity": {"linear": [0.1, fling]}}
        for count in (1, 40, 400):
            world = scene(sun, planet, physics={"gravity_mode": "planet", "G": 5.0})
            world.run(steps=count)
    touching = [body(2.0 * i, 0.0, "disc") for i in range(5)]
    world = scene(*touching, physics={"gravity_mode": "planet"})
    world.step()
    assert max(
        system.strongest_rate(world) for system in world.schedule.running if isinstance(system, ForceSystem)
    )
    world.run(steps=2)
    measure_energy(world)


def smooth_motion() -> None:
    chain: list[Entity] = []
    for i in range(4):
        end = {"b": f"e{i - 1}"} if i else {"anchor_b": [0.0, 5.0]}
        spring = {"a": f"e{i}", "anchor_a": [0.1, 0.05], "stiffness": 300.0, "damping": 0.5}
        chain.append(body(0.5 * i, 4.0, Spring={**spring, **end}, Drag={"linear": 0.1, "quadratic": 0.2}))
    names = "leapfrog", "symplectic_euler", "rk4", "blanes_moan", "dop853", "implicit_midpoint"
    for name in names:
        world = scene(*chain, physics={"linear_damping": 0.1}, integrator=name)
        world.run(steps=2)
        measure_energy(world)
    still = body(0.0, 1.0, Spring={"a": "e0", "anchor_b": [0, 0], "rest_length": 0.0, "stiffness": 9.0})
    scene(still, integrator="exact").run(steps=2)


def springs_beside_contacts() -> None:
    """Let a chain land on a floor, one end of it whirling about the other so fast that steps are chosen."""
    chain: list[Entity] = []
    for i in range(11):
        fast = {"Velocity": {"linear": [0.0, 600.0 if i == 10 else 0.0]}}
        spring = {"b": f"e{i}", "stiffness": 900.0, "rest_length": 1.1}
        chain.append(body(1.15 * i, 0.51, "disc", **fast, **({"Spring": spring} if i else {})))
    for links in (chain, [*chain[:-1], {**chain[-1], "Drag": {"linear": 0.3}}]):
        world = scene(FLOOR, *links, contacts="soft", collisions="step")
        world.run(steps=3)
        assert world.plan.split_forces is SPRING_SPLITTING


def damped() -> World:
    """Return discs that fall through air, one of them under a spring, so that some are sub-integrated."""
    hung = {"Spring": {"b": "e1", "stiffness": 90.0, "rest_length": 1.1, "damping": 0.5}}
    discs = [body(1.15 * i, 0.51, "disc", **(hung if i == 2 else {})) for i in range(4)]
    laws = {"linear_damping": 0.1, "angular_damping": 0.1}  # which the compiled flow of springs does not take
    return scene(FLOOR, *discs, physics=laws, contacts="soft", collisions="step")


def damped_beside_contacts() -> None:
    """Let them fall."""
    world = damped()
    world.run(steps=3)
    assert measure_account(world).energy["damping"] < 0.0


class Bystander(System):
    """Looks at stages, so that the systems of these are called from Python."""

    @at(Stage.DRIFT)
    def see_drift(self, state: State, h: float) -> None:
        """See that it is there."""

    @at(Stage.KICK)
    def see_kick(self, state: State, h: float) -> None:
        """See that it is there."""

    @at(Stage.BROAD_PHASE)
    def see_pairs(self, state: State, h: float) -> None:
        """See that it is there."""


def hung() -> World:
    """Return a disc on a spring that is stiff enough to be predicted."""
    return scene(body(1.0, 1.3, "disc", Spring={"anchor_b": [0, 3], "stiffness": 2000.0, "rest_length": 2.0}))


def stages_with_hooks() -> None:
    """Let systems be called one by one, where bodies touch and where nothing can."""
    for world in (load_scene("sandbox"), load_scene("pendulum"), hung()):
        world.physics = replace(world.physics, linear_damping=0.1, angular_damping=0.1)
        world.simulation = replace(world.simulation, contacts="soft", collisions="step")
        world.install(Bystander())
        world.run(steps=2)
        assert world.stepper is not None and world.stepper.name == "contact"


def forces_by_hand() -> None:
    """Call what only other kernels call, or none any more."""
    random, n = np.random.default_rng(2), 4
    vectors = [random.normal(size=(n, 2)) for _ in range(5)]
    numbers = [random.uniform(0.5, 2.0, n) for _ in range(4)]
    gravity.uniform_gravity(vectors[0], numbers[0], numbers[1], 0.5, -9.81)
    gravity.uniform_potential(vectors[0], numbers[0], numbers[1], 0.5, -9.81)
    numbers_of_colours = random.integers(0, 16, 300).astype(np.uint8)
    room = np.zeros((lzw.CODES, 256), np.int16), np.zeros(2 * 300 + 16, np.uint8)
    assert lzw.pack_lzw(numbers_of_colours, 4, *room) > 100
    for lengths in ((14, 7, 14, 7), (4, 2, 4, 2)):
        columns = [random.normal(size=length).view(np.int64) for length in lengths]
        assert len(set(digest.digest_motion(*columns))) == 4


def drawn() -> None:
    pixels, two = np.full((24, 40), 0x102030, np.uint32), np.array((0x40A0F0, 0x8090A0), np.uint32)
    centre, sizes = np.array(((9.3, 8.1), (30.0, 15.5))), np.array(((6.5, 6.0), (9.0, 9.5)))
    rims, turned = two[::-1].copy(), np.array((0.4, 2.0))
    corners = np.repeat(centre[:, None], 8, axis=1)
    corners[1, :4] += ((7.0, -6.0), (-7.0, -8.0), (-7.0, 6.0), (6.0, 6.0))
    for kind in range(0, len(finishes.FINISHES), 2):
        for count, rounding in ((1, (6.5, 9.0)), (4, (0.0, 2.5))):  # discs, then what is at most a polygon
            shapes = corners.reshape(2, -1), np.array((1, count)), np.array(rounding), turned
            finish, room = np.array((kind, kind + 1)), np.empty((8, 5))
            raster.paint_rounded(pixels, *shapes, two, rims, finish, 1.6, 0.3, room)
    widths, opacities = np.array((2.5, 7.0)), np.array((1.0, 0.3))
    raster.paint_lines(pixels, centre, sizes + 30.0, widths, opacities, two)
    assert len(np.unique(pixels)) > 20


def panels() -> None:
    """Paint rectangles, letters and triangles of any colours, many beyond what may be painted."""
    random = np.random.default_rng(4)
    coverage = random.integers(0, 256, (16, 16)).astype(np.uint8)
    pixels = np.zeros((30, 40), np.uint32)
    for kind in range(8):
        vertices = np.zeros((8, 5), np.float32)
        vertices[:, :2] = random.integers(-20, 200, (8, 2)) / 4
        vertices.view(np.uint32)[:, 4] = random.integers(0, 2**32, 8)
        if kind % 2:  # a rectangle of one colour, plain or of the texture
            (left, top), (right, bottom) = np.sort(vertices[:2, :2], axis=0)
            vertices[:4, :2] = (left, top), (right, top), (right, bottom), (left, bottom)
            vertices.view(np.uint32)[:4, 4] = random.integers(0, 2**32)
            vertices[:4, 2:4] = ((0, 0), (1, 0), (1, 1), (0, 1)) if kind % 4 == 1 else 0.0
        else:
            vertices[:, 2:4] = random.uniform(0.0, 1.0, (8, 2)) if kind % 4 == 0 else 0.5
        order = np.array((0, 1, 2, 0, 2, 3, 1, 2, 3), np.uint32)
        triangles.paint_triangles(
            pixels, vertices, vertices.view(np.uint32), order, 0, 9, kind // 2, coverage, 2, 1, 37, 28
        )
    assert len(np.unique(pixels)) > 100


def built_in() -> None:
    for name in ("drop", "stack", "sandbox", "slope", "bounces", "dominoes", "pendulum", "newtons_cradle"):
        world = load_scene(name)
        for _ in range(6):
            world.step()
        world.run(steps=6)


def rigid_contacts() -> None:
    for name, steps in (("drop", 120), ("slope", 30), ("stack", 4)):
        world = load_scene(name)
        world.simulation = replace(world.simulation, contacts="rigid")
        world.run(steps=steps)
        assert world.stepper is not None and world.stepper.name == "rigid"
    for height in (0.25 - 1e-5, 0.251):  # a little too deep; about to bounce, and the rest by impulses
        world = load_scene("drop")
        world.simulation = replace(world.simulation, contacts="rigid")
        ball = world.component(2, Transform), world.component(2, Velocity)
        ball[0].position, ball[1].linear = (-3, height), (1, -1)
        with patch.object(rigid_motion, "_MAX_WORK", 0):
            world.run(steps=1)
        assert world.stepper is not None and world.stepper.name == "rigid"


def impacts() -> None:
    """Let a rod slide on its end, which would gain energy by Newton's law, and a corner turn into a disc."""
    bouncing, weightless = {"friction": 0.3, "restitution": 1.0}, {"gravity_mode": "none"}
    rod: Entity = {
        "Transform": {"position": [0, 0.82], "angle": 0.785}, "Velocity": {"linear": [0.8, -1.0]},
        "Mass": {"mass": 1.0}, "Shape": {"kind": "box", "width": 2, "height": 0.02}, "Material": bouncing,
    }  # fmt: skip
    for contacts in ("soft", "rigid"):
        floor = FLOOR | {"Material": bouncing}
        world = scene(floor, rod, physics=weightless, contacts=contacts, collisions="step")
        world.run(steps=9)
        rigid = next((stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid)), None)
        assert world.contacts.energetic_impacts + (0 if rigid is None else rigid.energetic_impacts) == 1
    turning = body(0.0, 0.0, "box", Velocity={"angular": 9.0})
    disc = body(1.3, 0.2, "disc", Velocity={"linear": [-2.0, 0.0]})
    world = scene(turning, disc, physics=weightless, contacts="soft", collisions="step")
    world.run(steps=12)
    assert world.collisions > 0


def joints() -> None:
    """Let a box turn about a pin, by itself and beside what it hits."""
    pin: Entity = {"Pin": {"b": "e0", "anchor_a": [0, 2], "anchor_b": [-0.5, 0]}}
    for others, contacts in (((), "auto"), ((body(1.5, 0.5, "disc"), FLOOR), "rigid")):
        world = scene(body(0.5, 2.0, "box"), pin, *others, contacts=contacts)
        world.run(steps=24)
        assert len(world.joints) == 2


def joints_fields_and_chains() -> None:
    """Let chains, media, molecules, thrusts, charges, motors, limits and soft rows act."""
    for name in ("loop_the_loop", "floating", "rocket", "cyclotron", "crossed_fields", "pulleys", "piston"):
        load_scene(name).run(steps=6)
    for name in ("pulleys", "bridge", "cyclotron", "loop_the_loop"):
        world = load_scene(name)
        world.simulation = replace(world.simulation, contacts="soft")
        world.run(steps=2)
        joint_states(world)
    pin: Entity = {
        "Pin": {"b": "e0", "anchor_b": [-0.5, 0], "lower": -0.2, "motor_speed": -1, "max_torque": 1}
    }
    with patch.object(rigid_motion, "_MAX_EVENTS", 0):
        scene(body(0.5, 0.0, "box"), pin).run(steps=2)
    world = World()
    for x in (0.0, 0.25):
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), Molecule())
    world.run(steps=2)
    world.simulation = replace(world.simulation, integrator="dop853")
    world.record(4.0 * world.simulation.dt)
    for name in ("drop", "sandbox"):
        load_scene(name).record(4.0 * world.simulation.dt)


def lone_sweeps() -> None:
    """Call what runs within an interpreted loop of substeps, on the contacts of a pile that was pushed."""
    world = load_scene("sandbox")
    world.run(steps=3)
    motion = motion_of(world)
    counts, *_, pairs, points = near_in(world)
    contacts = pairs, points, int(counts[ACTIVE])
    assert contacts[-1] > 10
    last = np.full(len(motion[1]), -1)
    for number, booked in ((0, True), (1, False)):
        motion[2][...] += 0.1
        stirred = number, number - 1, last
        sweep_contacts(contacts, motion, (240.0, 1.0, 0.9, 0.1, 10.0, 0.5, 0.1), stirred, booked)


def recorded() -> None:
    """Record steps, of which each has a digest."""
    History(load_scene("pyramid")).step(steps=3)


def test_every_kernel_gives_the_same_bits_as_python() -> None:
    calls: Counter[str] = Counter()
    scenes = built_in, heaps, heavy_loads, sleepers, planets, smooth_motion, rigid_contacts, impacts
    for drive in (
        *scenes,
        springs_beside_contacts,
        damped_beside_contacts,
        stages_with_hooks,
        forces_by_hand,
        drawn,
        joints,
        joints_fields_and_chains,
        lone_sweeps,
        recorded,
        panels,
    ):
        with compared(calls):
            drive()
    own = {name_of(jitted) for jitted in KERNELS if jitted.__module__.startswith("physicslab.")}
    assert sorted(own - set(calls)) == []


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (1.0, np.nextafter(1.0, 2.0).item()), (0.0, -0.0), (1, 1.0), ((1, 2.0), (1, 3.0)),
        (np.ones(2), np.array((1.0, np.nextafter(1.0, 0.0)))), (np.arange(2), np.array((0, 2))),
    ],
)  # fmt: skip
def test_the_comparison_notices_a_single_bit(one: Any, other: Any) -> None:
    same_bits("it", one, one)
    with pytest.raises(AssertionError):
        same_bits("it", one, other)


def test_what_a_loop_spends_its_time_in_is_compiled_before_it_and_changes_no_bit() -> None:
    assert natives_within(soft.advance) == (sweep_contacts,) and natives_within(sweep_contacts) == ()
    expected, world, calls = load_scene("sandbox"), load_scene("sandbox"), []
    compile_kernels((sweep_contacts,))
    native = direct_entry(sweep_contacts)

    class Noted:
        compiled = True

        def __call__(self, *arguments: Any) -> Any:
            calls.append(arguments)
            return native(*arguments)

    expected.run(steps=3)
    with interpreted(), patch.dict(natives, {sweep: Noted()}):
        world.run(steps=3)
    assert bits(world) == bits(expected) and calls


@pytest.mark.parametrize("name", ["drop", "sandbox", "pendulum", "two_planets"])
def test_a_run_that_changes_tiers_half_way_ends_in_the_same_bits(name: str) -> None:
    expected, world = load_scene(name), load_scene(name)
    for _ in range(8):
        expected.step()
    with interpreted():
        for _ in range(4):
            world.step()
    for _ in range(4):
        world.step()
    assert bits(world) == bits(expected)
    assert motion.derive_masses.compiled  # type: ignore[attr-defined]


SWITCHING = """
import numpy as np
from physicslab.components import Transform
from physicslab.files.scene import load_scene
from physicslab.kernels import KERNELS, ask_before_compiling, load, motion
ask_before_compiling(lambda missing: missing)
world = load_scene("slope")
for _ in range(5):
    world.step()
assert not any(jitted.compiled for jitted in KERNELS)
load(motion.drift)
load(motion.derive_masses)
for _ in range(5):
    world.step()
print(sum(jitted.compiled for jitted in KERNELS), world.table(Transform)["position"].tobytes().hex())
"""


def test_kernels_are_interpreted_until_they_are_loaded(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SWITCHING], env={**os.environ, "XDG_CACHE_HOME": str(tmp_path)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    loaded, places = done.stdout.split()
    world = load_scene("slope")
    for _ in range(10):
        world.step()
    assert loaded == "2"
    assert places == world.table(Transform)["position"].tobytes().hex()


def test_the_environment_forbids_to_compile(tmp_path: Path) -> None:
    command = [sys.executable, "main.py", "run", "drop", "--steps", "20", "--json", "-"]
    documents = []
    for forced in ("0", "1"):
        caches = {"XDG_CACHE_HOME": str(tmp_path)} if forced == "1" else {}
        environment = {**os.environ, "PHYSICSLAB_INTERPRET": forced, **caches}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, cwd=ROOT)
        documents.append(json.loads(done.stdout))
    assert documents[0]["entities"] == documents[1]["entities"]
    assert documents[0]["energy"] == documents[1]["energy"]
    assert not list(tmp_path.rglob("*.nbc"))


def orbit() -> World:
    sun = body(0.0, 0.0, Mass={"mass": 50.0})
    earth = body(3.0, 0.0, Velocity={"linear": [0.0, 4.0]})
    return scene(sun, earth, physics={"gravity_mode": "planet"}, integrator="dop853")


@contextmanager
def interpreted_up_to(world: World, jitted: Any, longest: float) -> Iterator[list[Any]]:
    """Let a kernel be interpreted for so long [s] at most; yield the list of those that are compiled then."""
    late, overloads = list[Any](), dict(jitted.overloads)

    def compile_now(kernel: Any) -> None:
        late.append(kernel)
        interpreter._take_back(kernel, overloads)

    world.synchronise()
    interpreter._set_aside(jitted)
    install(jitted)
    interpreter.limit(lambda _: longest, compile_now)
    ask_before_compiling(lambda missing: missing)
    try:
        yield late
    finally:
        ask_before_compiling(None)
        interpreter.unlimited()
        interpreter.uninstall(jitted)
        if not late:
            interpreter._take_back(jitted, overloads)


@pytest.mark.parametrize(("make", "jitted"), [(lambda: load_scene("drop"), run_events), (orbit, dop853)])
def test_what_would_be_interpreted_for_too_long_is_compiled_first(
    make: Callable[[], World], jitted: Any
) -> None:
    expected, world = make(), make()
    for _ in range(3):
        expected.step()
    with interpreted_up_to(world, jitted, 1e-9) as late:
        for _ in range(3):
            world.step()
    assert late == [jitted]
    assert bits(world) == bits(expected)


def falling_box() -> World:
    world = scene(FLOOR, body(0.0, 0.52, "box", Velocity={"linear": [0.0, -1.0]}), contacts="soft")
    world.contacts.read = True  # as in a window
    return world


@pytest.mark.parametrize(("longest", "compiles"), [(1e-9, True), (60.0, False)])
def test_a_call_that_may_be_made_once_more_copies_no_table_of_impacts(longest: float, compiles: bool) -> None:
    """It has 34 MB, and to copy it took longer than an interpreted step of a few bodies."""
    expected, world = falling_box(), falling_box()
    for _ in range(3):
        expected.step()
    with interpreted_up_to(world, soft.advance, longest) as late:
        tracemalloc.start()
        try:
            for _ in range(3):
                world.step()
            _, most = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
    assert bool(late) == compiles
    assert bits(world) == bits(expected)
    assert world.contacts.impacts.tobytes() == expected.contacts.impacts.tobytes() != b""
    assert most < 0.5 * world.contacts.log.nbytes  # a copy would be all of it


@pytest.mark.parametrize(
    "odd", [np.ones(3, np.float32), np.ones(3, np.int64), np.ones(6)[::2], np.ones((2, 2)), [1.0, 2.0]]
)
def test_arguments_of_another_type_are_refused_as_they_are_by_compiled_code(odd: Any) -> None:
    vectors = np.ones((3, 2))
    with interpreted():
        motion.clear(vectors, np.ones(3))
        with pytest.raises(TypeError, match="No matching definition of clear"):
            motion.clear(vectors, odd)
    assert not vectors.any()


def test_a_debugger_finds_the_lines_of_a_kernel() -> None:
    fallback: Any = fallback_of(motion.kick)
    original = motion.kick.py_func  # type: ignore[attr-defined]
    assert fallback.__code__.co_filename == original.__code__.co_filename
    assert list(fallback.__code__.co_lines()) == list(original.__code__.co_lines())


LOOSE = 1e-13
"""Share of the largest pull that sums in another order may differ by: two units in the last place of each of
a hundred or so terms."""


@pytest.mark.parametrize("plummer", [False, True])
def test_attraction_of_many_differs_by_rounding_alone(plummer: bool) -> None:
    n, random = PLAIN_LIMIT + 30, np.random.default_rng(3)
    position, mass = random.normal(size=(n, 2)), random.uniform(0.5, 2.0, n)
    rows, forces = np.arange(n), np.zeros((2, n, 2))
    laws = (1.0, 0.05, plummer)
    compile_kernels((pair_potential,))
    forces[0] = attraction(position, mass, *laws)
    compiled = pair_potential(position, mass, rows, *laws)
    with interpreted():
        forces[1] = attraction(position, mass, *laws)
        python = pair_potential(position, mass, rows, *laws)
    assert not np.array_equal(forces[0], np.zeros((n, 2)))
    assert np.abs(forces[0] - forces[1]).max() <= LOOSE * np.abs(forces[0]).max()
    assert python == pytest.approx(compiled, rel=LOOSE)


def test_the_tree_is_as_near_as_stated_when_interpreted() -> None:
    n, random = 90, np.random.default_rng(4)
    x, y, mass = random.normal(size=n), random.normal(size=n), random.uniform(0.5, 2.0, n)
    direct, tree = np.zeros((2, n)), np.zeros((2, n))
    with np.errstate(all="ignore"):
        fallback_of(attract_pairwise)(x, y, mass, np.float64(0.0), False, *direct)
        fallback_of(attract_by_tree)(x, y, mass, np.float64(0.0), False, *tree)
    pulls = np.hypot(*direct)
    assert np.hypot(*(tree - direct)).max() < MAX_ERROR * pulls.mean()


def test_math_gives_what_compiled_code_gives_where_python_raises() -> None:
    with np.errstate(all="ignore"):
        assert math.isnan(math_functions.sqrt(-1.0)) and math.isnan(math_functions.sin(math.inf))
        assert math_functions.exp(1e4) == math.inf and math_functions.log(0.0) == -math.inf
        assert math_functions.pow(0.0, -1.0) == math.inf
    assert math_functions.floor(math.nan) == -(2**63) and math_functions.floor(-1.5) == -2


def functions_of_math() -> list[str]:
    """Return the names of those functions of ``math`` that modules of kernels call."""
    package = Path(sys.modules["physicslab.kernels"].__file__ or "").parent
    sources = "\n".join(path.read_text(encoding="utf-8") for path in package.rglob("*.py"))
    return sorted(set(re.findall(r"\bmath\.(\w+)\(", sources)) - {"factorial", "fsum"})


@pytest.mark.parametrize("name", functions_of_math())
def test_math_gives_the_same_bits_compiled(name: str) -> None:
    """Python's hypot is rounded otherwise than the compiled one in one of 200 calls: kernels have none."""
    function, random = getattr(math, name), np.random.default_rng(5)
    two = name in ("atan2", "copysign", "pow")
    jitted: Any = numba.njit((lambda x, y: function(x, y)) if two else (lambda x: function(x)))
    low, high = (-1.0, 1.0) if name == "acos" else (0.0, 30.0) if name in ("sqrt", "pow") else (-30.0, 30.0)
    samples = random.uniform(low, high, (4_000, 2 if two else 1)).tolist()
    equal = math_functions.__dict__[name]
    assert all(jitted(*sample) == equal(*sample) for sample in samples)


def test_kernels_take_no_power_by_an_operator() -> None:
    """A square is a product where it is compiled, and a call of pow in Python, which is rounded otherwise.

    Powers of 2 are exact.
    """
    package = Path(sys.modules["physicslab.kernels"].__file__ or "").parent
    found = [
        f"{path.relative_to(package)}:{power.lineno}"
        for path in package.rglob("*.py")
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(function, ast.FunctionDef)
        for power in ast.walk(function)
        if isinstance(power, ast.BinOp) and isinstance(power.op, ast.Pow) and ast.unparse(power.left) != "2.0"
    ]
    assert not found


# ---- the window while kernels are compiled -----------------------------------------------------------------


def test_pictures_are_drawn_before_the_painters_are_there() -> None:
    surface = pygame.Surface((60, 40), 0, 32)
    canvas = PygameCanvas(surface)
    places, turned = np.array(((15.0, 20.0), (45.0, 20.0))), np.array((0.0, 0.5))
    with interpreted():
        canvas.discs(places[:1], np.array((9.0,)), turned[:1], Look.plain((200, 40, 40), (255, 255, 255), 1))
        canvas.boxes(places[1:], np.array(((16.0, 12.0),)), turned[1:], Look.plain((1, 90, 1), (9, 9, 9), 1))
        canvas.lines(np.array(((0.0, 2.0),)), np.array(((59.0, 2.0),)), (0, 0, 255), 1.0, 0.5)
    assert surface.get_at((13, 16))[:3] == (200, 40, 40)
    assert surface.get_at((45, 22))[:3] == (1, 90, 1)
    assert surface.get_at((30, 2))[:3] == (0, 0, 128)
    assert surface.get_at((30, 30))[:3] == (0, 0, 0)


@pytest.mark.parametrize("size", [1e3, 1e6, 1e12])
def test_what_is_far_larger_than_the_picture_is_cut_off(size: float) -> None:
    surface = pygame.Surface((60, 40), 0, 32)
    canvas, look = PygameCanvas(surface), Look.plain((200, 40, 40), (255, 255, 255), 1)
    with interpreted():
        canvas.boxes(np.array(((30.0, size / 2 + 20.0),)), np.array(((size, size),)), np.zeros(1), look)
        assert surface.get_at((30, 35))[:3] == (200, 40, 40) and surface.get_at((30, 10))[:3] == (0, 0, 0)
        surface.fill((0, 0, 0))
        canvas.discs(np.array(((30.0, size + 20.0),)), np.array((size,)), np.zeros(1), look)
        canvas.lines(np.array(((-size, 5.0),)), np.array(((size, 5.0),)), (0, 0, 255))
    assert surface.get_at((30, 5))[:3] == (0, 0, 255)


def waiting(*names: str) -> list[Any]:
    return [type(name, (), {"compiled": False})() for name in names]


def test_a_small_scene_is_interpreted_and_a_large_one_waits() -> None:
    scenes, kernels = SmallScenes(), waiting("a", "b")
    assert scenes.interpret(kernels) == ()  # nothing is shown yet
    scenes.follow(load_scene("sandbox"))
    assert scenes.interpret(kernels) == kernels == scenes.pending()
    assert scenes.made_up_for(0.1) < 0.1
    kernels[0].compiled = True
    assert scenes.pending() == kernels[1:]
    scenes.follow(load_scene("pile"))
    assert scenes.interpret(waiting("c")) == ()


def test_bodies_that_attract_each_other_count_twice() -> None:
    scenes, places = SmallScenes(), [body(1.0 * i, 0.0) for i in range(30)]
    scenes.follow(scene(*places))
    assert scenes.small
    scenes.follow(scene(*places, physics={"gravity_mode": "planet"}))
    assert not scenes.small


def test_a_scene_that_turns_out_to_be_slow_is_waited_for() -> None:
    scenes, kernels = SmallScenes(), waiting("a")
    scenes.follow(load_scene("drop"))
    scenes.interpret(kernels)
    assert not any(scenes.notice(left) for left in (-1.0, -1.0, 0.0, -1.0, -1.0, -1.0))
    assert scenes.notice(-1.0)
    assert scenes.give_up() == kernels
    assert scenes.interpret(waiting("b")) == ()
    scenes.follow(load_scene("drop"))
    assert scenes.small


def test_the_window_hands_over_what_is_small_and_hurries_it(monkeypatch: pytest.MonkeyPatch) -> None:
    hurried: list[str] = []
    workers = Warmup(1, (sys.executable, "-c", "input()"))
    monkeypatch.setattr(Warmup, "hurry", lambda _, spent: hurried.extend(spent))
    with Display.open(WindowConfig(), "test") as display, compiling.Compiling(display, workers) as started:
        started.scenes.follow(load_scene("drop"))
        assert started._ask([motion.drift]) == [motion.drift]
        assert hurried == ["physicslab.kernels.motion.drift"]
        assert interpreter._limit(motion.drift) == INTERPRETING_LIMIT
    assert interpreter._limit(motion.drift) == math.inf
