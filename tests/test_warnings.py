"""Warnings: given where a world cannot be trusted, and nowhere else."""

import itertools
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from desk import Desk
from recording import RecordingCanvas
from test_hud import frame, recorded

from physicslab.cli import main
from physicslab.components import Mass, Rope, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.diagnostics.warnings import ModelWarning, WorstWarnings, find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene, save_scene
from physicslab.integrators import INTEGRATORS
from physicslab.prefabs import box, circle, stack
from physicslab.scenes import SCENES
from physicslab.systems.standard import standard_systems
from physicslab.theme import THEMES
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.overlay.banners import draw_advice
from physicslab.world import World


def open_world(**simulation: object) -> World:
    return World(*standard_systems(), simulation=SimulationConfig(**simulation))  # type: ignore[arg-type]


def floor(world: World) -> None:
    box(world, (0, -0.5), width=20, height=1, static=True)


def hang(world: World, stiffness: float) -> None:
    bob = world.spawn(Transform((0, -1.5)), Velocity(), Mass(1.0), name="bob")
    world.spawn(Spring(a=bob, anchor_b=(0, 0), rest_length=1.0, stiffness=stiffness), name="rope")


def only(world: World, words: str) -> ModelWarning:
    (found,) = [advice for advice in find_warnings(world) if words in advice.what]
    return found


CROWDS = ("sandbox", "pyramid", "pile", "dominoes", "gas", "bridge")
"""Built-in scenes of more bodies than rigid contacts take, under gravity."""


@pytest.mark.parametrize("name", SCENES)
def test_built_in_scenes_need_no_advice_but_on_the_model_of_contacts(name: str) -> None:
    world, worst = load_scene(name), WorstWarnings()
    for _ in world.stepping(seconds=3.0, stride=6):
        worst.add(find_warnings(world))
    found = [str(advice) for advice in worst.all]
    soft = [line for line in found if "contacts are soft" in line]
    assert len(soft) == (name in CROWDS)
    assert [line for line in found if line not in soft and "leave open how" not in line] == []


def test_a_thirteenth_body_makes_contacts_soft_and_that_is_told_with_its_size() -> None:
    def top(far: int, contacts: str) -> tuple[float, list[ModelWarning]]:
        world = open_world(contacts=contacts)
        floor(world)
        boxes = [box(world, (0, y + 0.5), width=1, height=1) for y in range(10)]
        for x in range(far):
            circle(world, (5 + x, 0.5), radius=0.5)
        world.run(seconds=1.0)
        told = [advice for advice in find_warnings(world) if "contacts are soft" in advice.what]
        return world.component(boxes[-1], Transform).position.y, told

    exact, none = top(2, "auto")
    assert exact == pytest.approx(9.5, abs=1e-12) and none == []
    height, (told,) = top(3, "auto")
    assert told.value is not None and 0.1 < told.value / (exact - height) < 10
    assert told.unit == "m" and told.setting == 'simulation.contacts = "rigid"'
    height, none = top(3, "rigid")
    assert height == pytest.approx(exact, abs=1e-12) and none == []
    assert top(3, "soft")[1] == [], "asked for"


@pytest.mark.parametrize("method", ["leapfrog", "symplectic_euler", "rk4"])
def test_the_setting_that_is_named_helps(method: str) -> None:
    world = open_world(integrator=method)
    hang(world, 1e6)
    world.synchronise()
    found = only(world, "too stiff")
    assert (found.entity, found.unit) == ("rope", "")
    assert found.value == pytest.approx(1e3 / 60 / 4) and found.value > found.limit  # type: ignore[operator]
    name, value = found.setting.split(" = ")
    assert name == "simulation.substeps"
    world.simulation = SimulationConfig(integrator=method, substeps=int(value))
    world.synchronise()
    assert find_warnings(world) == ()
    world.simulation = SimulationConfig(integrator=method, substeps=int(value) - 1)
    world.synchronise()
    assert only(world, "coarsely").setting == found.setting


@pytest.mark.parametrize("method", ["auto", "implicit_midpoint"])
def test_what_is_too_fast_to_be_followed_is_said(method: str) -> None:
    world = open_world(integrator=method)
    hang(world, 1e12)
    world.spawn(Transform((3, 0)), Velocity(), Mass(1.0), name="far")
    world.spawn(Spring(a=world.entity("far"), b=world.entity("bob"), stiffness=1.0, damping=0.1))
    world.synchronise()
    found = only(world, "too fast to be followed")
    assert found.entity == "rope"
    name, value = found.setting.split(" = ")
    dt = float(value) if name == "simulation.dt" else world.simulation.dt
    assert name == "simulation.dt"
    world.simulation = SimulationConfig(integrator=method, dt=dt)
    world.synchronise()
    assert not [advice for advice in find_warnings(world) if "too fast" in advice.what]


def comet() -> World:
    """Return a world with a light body on a long ellipse: it is far out at the start, and after 2 s."""
    config = SimulationConfig(integrator="leapfrog")
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"), simulation=config)
    world.spawn(Transform(), Velocity(), Mass(1))
    world.spawn(Transform((1, 0)), Velocity((0, 0.05)), Mass(1e-9), name="comet")
    return world


def test_a_close_passage_is_said_whenever_it_is_looked_for() -> None:
    at_once, stepped = comet(), comet()
    at_once.run(seconds=2.0)
    for _ in range(120):
        stepped.step()
    (first,), (second,) = find_warnings(at_once), find_warnings(stepped)
    assert first == second
    assert first.value is not None and first.value > 0.3 * 2.0
    present = at_once.schedule.forces[0].strongest_rate(at_once) / 240
    assert present < 0.02, "far out, where nothing is to be said"
    at_once.edited()
    assert find_warnings(at_once) == (), "an edit begins again"


def arenstorf(**simulation: object) -> tuple[World, float]:
    """Return Arenstorf's closed orbit after a period, and how far the craft is from where it began.

    The start is that of Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.0, seen from
    axes that do not turn.
    """
    config = SimulationConfig(**simulation)  # type: ignore[arg-type]
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"), simulation=config)
    share, period, start = 0.012277471, 17.0652165601579625588917206249, 0.994
    spin = start - 2.00158510637908252240537862224
    world.spawn(Transform((-share, 0.0)), Velocity((0.0, -share)), Mass(1.0 - share))
    world.spawn(Transform((1.0 - share, 0.0)), Velocity((0.0, 1.0 - share)), Mass(share))
    craft = world.spawn(Transform((start, 0.0)), Velocity((0.0, spin)), Mass(1e-30))
    world.run(seconds=period)
    there = world.component(craft, Transform).position
    return world, math.hypot(there.x - start * math.cos(period), there.y - start * math.sin(period))


def test_what_is_named_after_a_close_passage_was_checked() -> None:
    """With the substeps that its passages would need, leapfrog is as far off as without."""
    world, error = arenstorf(integrator="leapfrog")
    assert error > 0.5
    assert only(world, "coarsely").setting == 'simulation.integrator = "auto"'
    assert arenstorf(integrator="leapfrog", substeps=5)[1] > 0.3
    world, error = arenstorf()
    assert error < 1e-10 and find_warnings(world) == ()


@pytest.mark.parametrize("name", ["symplectic_euler", "leapfrog", "rk4", "blanes_moan", "implicit_midpoint"])
def test_the_phase_that_a_method_loses_is_known(name: str) -> None:
    method, lost = INTEGRATORS[name], []
    for h in (0.1, 0.2):
        laws, config = PhysicsConfig(gravity_mode="none"), SimulationConfig(dt=h, substeps=1, integrator=name)
        world = World(*standard_systems(), physics=laws, simulation=config)
        bob = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(1.0))
        world.spawn(Spring(a=bob, anchor_b=(0.0, 0.0), rest_length=0.0, stiffness=1.0))
        world.run(steps=round(40.0 * math.pi / h))
        state, speed = world.component(bob, Transform).position.x, world.component(bob, Velocity).linear.x
        phase = math.remainder(math.atan2(-speed, state) - world.time, 2.0 * math.pi)
        lost.append(abs(phase) / (world.time * h**method.phase_order))
    assert lost == pytest.approx([method.phase_share] * 2, rel=0.5 if name == "symplectic_euler" else 0.03)


def driven(**simulation: object) -> World:
    """Return a body on a spring, which another spring drives at resonance from a body too heavy to notice."""
    config = SimulationConfig(dt=0.2, substeps=1, **simulation)  # type: ignore[arg-type]
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=config)
    driver = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(1e16))
    world.spawn(Spring(a=driver, anchor_b=(0.0, 0.0), rest_length=0.0, stiffness=1e16))
    bob = world.spawn(Transform((0.0, 0.0)), Velocity(), Mass(1.0), name="bob")
    world.spawn(Spring(a=bob, anchor_b=(0.0, 0.0), rest_length=0.0, stiffness=0.75), name="own")
    world.spawn(Spring(a=bob, b=driver, rest_length=0.0, stiffness=0.25), name="drive")
    return world


def place_of(world: World) -> float:
    return world.component(world.entity("bob"), Transform).position.x


def test_a_phase_that_is_lost_is_said_with_its_size_and_the_setting_that_is_named_helps() -> None:
    """Of t sin(t) / 8: energy is kept to 1e-2, and places are wrong by a third of the amplitude."""
    world, at_once = driven(integrator="leapfrog"), driven(integrator="leapfrog")
    exact = 50.0 * math.sin(50.0) / 8.0
    for _ in range(250):
        world.step()
    at_once.run(seconds=50.0)
    found = only(world, "out of phase")
    assert str(found) == str(only(at_once, "out of phase")), "whenever it is looked for"
    assert abs(place_of(world) - exact) > 0.2
    assert found.value == pytest.approx(0.2**2 / 24 * 50.0, rel=0.02)
    name, value = found.setting.split(" = ")
    assert name == "simulation.substeps"
    finer = driven(integrator="leapfrog")
    finer.simulation = replace(finer.simulation, substeps=int(value))
    finer.run(seconds=50.0)
    assert find_warnings(finer) == ()
    assert abs(place_of(finer) - exact) < 0.06 * 50.0 / 8.0
    world = driven()
    world.run(seconds=50.0)
    assert find_warnings(world) == () and abs(place_of(world) - exact) < 1e-8


@pytest.mark.parametrize(("damping", "said"), [(0.0, True), (0.01, False)])
def test_what_is_damped_loses_phase_while_it_lasts(damping: float, said: bool) -> None:
    world = open_world(integrator="leapfrog")
    hang(world, 400.0)
    world.component(world.entity("rope"), Spring).damping = 100.0 * damping
    world.run(seconds=100.0)
    assert bool([found for found in find_warnings(world) if "phase" in found.what]) is said


def test_what_chooses_its_steps_or_is_exact_needs_no_advice() -> None:
    for method in ("auto", "exact", "dop853"):
        world = open_world(integrator=method)
        bob = world.spawn(Transform((0, -1.5)), Velocity(), Mass(1.0))
        world.spawn(Spring(a=bob, anchor_b=(0, 0), rest_length=0.0, stiffness=1e6))
        world.synchronise()
        assert find_warnings(world) == ()


@pytest.mark.parametrize("contacts", ["rigid", "soft"])
def test_a_close_passage_beside_a_rope_is_followed_by_what_chooses_its_steps_alone(contacts: str) -> None:
    laws = PhysicsConfig(gravity_mode="planet", G=20.0, softening=0.05)
    world = World(physics=laws, simulation=SimulationConfig(contacts=contacts))
    star, comet = circle(world, (0, 0), radius=0.1), circle(world, (1, 0), radius=0.1, velocity=(0, 0.3))
    world.spawn(Rope(star, comet, length=1.5))
    circle(world, (500, 0), radius=0.1)
    worst = WorstWarnings()
    for _ in range(30):
        world.step()
        worst.add(find_warnings(world))
    flies_apart = [warning for warning in worst.all if "omega h" in warning.what]
    assert world.plan.contacts == contacts and bool(flies_apart) == (contacts == "soft")
    assert contacts == "soft" or abs(measure_account(world).energy["numerical"]) < 1e-5, "of 400 J"


def test_a_refused_choice_is_reported() -> None:
    world = open_world(integrator="exact", collisions="exact")
    floor(world)
    box(world, (0, 0.25), angular_velocity=1.0)
    world.synchronise()
    settings = {advice.setting for advice in find_warnings(world)}
    assert settings == {'simulation.integrator = "auto"', 'simulation.collisions = "auto"'}


def test_a_divided_step_is_said() -> None:
    world = open_world()
    floor(world)
    stack(world, 2)
    world.step(0.05)
    found = only(world, "divided")
    assert (found.value, found.limit, world.step_divisions) == (3.0, 1.0, 3)
    world.step()
    assert find_warnings(world) == ()


@pytest.mark.parametrize(("ratio", "said"), [(2000.0, False), (4000.0, True), (1e6, True)])
def test_a_load_that_contacts_do_not_hold_is_said(ratio: float, said: bool) -> None:
    world = open_world(contacts="soft")
    floor(world)
    box(world, (0, 0.5), width=1, height=1, mass=1.0, name="light")
    box(world, (0, 1.5), width=1, height=1, mass=ratio)
    world.run(steps=3)
    found = [advice for advice in find_warnings(world) if "heavier" in advice.what]
    assert [advice.entity for advice in found] == (["light"] if said else [])
    assert all(advice.value == pytest.approx(ratio) for advice in found)


def test_a_heavy_body_beside_or_below_a_light_one_is_no_load() -> None:
    world = open_world()
    floor(world)
    box(world, (0, 0.5), width=1, height=1, mass=1e6)
    box(world, (0, 1.5), width=1, height=1, mass=1.0)
    box(world, (1.0, 0.5), width=1, height=1, mass=1.0)
    world.run(steps=5)
    assert find_warnings(world) == ()


def squeezed(substeps: int, contacts: str = "soft") -> World:
    """Return a heavy box that drives a light one against a wall, without gravity, friction or losses."""
    scene = {"restitution": 1.0, "friction": 0.0}
    laws = PhysicsConfig(gravity_mode="none")
    simulation = SimulationConfig(substeps=substeps, contacts=contacts)
    world = World(*standard_systems(), physics=laws, simulation=simulation)
    box(world, (-0.5, 0.0), width=1.0, height=4.0, static=True, **scene)  # type: ignore[arg-type]
    box(world, (1.25, 0.0), width=0.5, height=0.5, mass=1.0, **scene)  # type: ignore[arg-type]
    box(world, (3.0, 0.0), width=1.0, height=1.0, mass=65536.0, velocity=(-1.0, 0.0), **scene)  # type: ignore[arg-type]
    return world


def test_without_gravity_nothing_carries_and_the_setting_that_is_named_was_checked() -> None:
    counts, warnings = [], WorstWarnings()
    for substeps in (4, 13):
        world, warnings = squeezed(substeps), WorstWarnings()
        for _ in world.stepping(seconds=5.0):
            warnings.add(find_warnings(world))
        assert not any("carries" in warning.what for warning in warnings.all)
        if substeps == 4:
            (found,) = (warning for warning in warnings.all if "impacts after the first" in warning.what)
            assert found.setting == "simulation.substeps = 13"
        counts.append(world.collisions)
    assert not any("impacts after the first" in warning.what for warning in warnings.all)
    assert counts == [803, 803], "as many as there are by then, hundreds of them in one substep"
    world = squeezed(4, "auto")
    world.run(seconds=6.0)
    assert (world.collisions, find_warnings(world)) == (804, ()), "the last of them at its time, 5.97 s"


def test_of_a_kind_one_line_is_kept_whatever_its_cause() -> None:
    worst = WorstWarnings()
    for count, why in enumerate(("bodies overlap by 0.1 of their size", "bodies overlap by 0.2"), start=1):
        worst.add([ModelWarning(None, "steps were left", float(count), "", 0.0, "", because=why)])
    (line,) = map(str, worst.all)
    assert line == "steps were left: 2, as bodies overlap by 0.2; no setting is known to help"


def test_where_no_setting_is_known_the_words_are_plain() -> None:
    warning = ModelWarning("box", "sinks", 2.0, "m", 1.0, "")
    assert str(warning) == "box: sinks: 2 m, well up to 1; no setting is known to help"


def test_overlap_is_said_until_it_is_gone() -> None:
    world = open_world()
    for n in range(40):
        circle(world, (0.001 * n, 0.0), radius=0.5)
    world.step()
    found = only(world, "pressed into")
    assert found.setting == "", "more contacts than rigid ones are advised for"
    assert found.unit == "m" and found.value == pytest.approx(world.contacts.max_penetration, rel=0.2)


def heavy_boxes(**change: object) -> World:
    """Return three boxes of 1 m on each other, ten thousand times as heavy as on Earth."""
    world = World(
        *standard_systems(), physics=PhysicsConfig(gravity=(0.0, -1e5)),  # type: ignore[arg-type]
        simulation=SimulationConfig(contacts="soft", **change),  # type: ignore[arg-type]
    )  # fmt: skip
    floor(world)
    stack(world, 3)
    return world


def thin_rods() -> World:
    """Return ten rods of 2 m by 0.1 mm on each other."""
    world = open_world(contacts="soft")
    floor(world)
    for place in range(10):
        box(world, (0.0, 0.00005 + 0.0001 * place), width=2.0, height=0.0001, mass=0.1)
    return world


def heavy_load() -> World:
    """Return a light box that carries a heavy one."""
    world = open_world(contacts="soft")
    floor(world)
    box(world, (0, 0.5), width=1, height=1, mass=1.0)
    box(world, (0, 1.5), width=1, height=1, mass=3e4)
    return world


def test_soft_contacts_hold_heavy_boxes_in_substeps_that_are_short_enough() -> None:
    """Gravity moves what is free by 1.7 of their sizes in a substep of the scene's own length."""
    world = heavy_boxes()
    for _ in world.stepping(seconds=1.0):
        assert find_warnings(world) == ()
    assert world.substeps == 5 * world.simulation.substeps
    heights = world.table(Transform)["position"][2:, 1]
    assert heights == pytest.approx([0.5, 1.5, 2.5], abs=0.03)


def test_soft_contacts_hold_thin_rods_in_such_substeps() -> None:
    world = thin_rods()
    world.synchronise()
    before = world.table(Transform)["position"][2:].copy()
    for _ in world.stepping(seconds=1.0):
        assert find_warnings(world) == ()
    assert world.table(Transform)["position"][2:] == pytest.approx(before, abs=5e-5), "half a thickness"


def test_what_soft_contacts_do_not_hold_rigid_ones_do_as_is_said() -> None:
    build = heavy_load
    world, worst = build(), WorstWarnings()
    for _ in world.stepping(seconds=2.0):
        worst.add(find_warnings(world))
    assert {found.setting for found in worst.all} == {'simulation.contacts = "rigid"'}
    rigid = build()
    rigid.synchronise()
    before = rigid.table(Transform)["position"][1:].copy()
    rigid.simulation = replace(rigid.simulation, contacts="rigid")
    rigid.run(seconds=2.0)
    assert find_warnings(rigid) == ()
    assert rigid.table(Transform)["position"][1:] == pytest.approx(before, abs=1e-9)


def test_speed_matters_in_a_crowd_and_not_alone() -> None:
    world = open_world(collisions="step")
    world.physics = type(world.physics)(gravity_mode="none")
    box(world, (5, 0), width=1, height=9, static=True, restitution=1.0)
    circle(world, (0, 0), radius=0.1, velocity=(1e4, 0.0), restitution=1.0, name="bullet")
    world.step()
    assert find_warnings(world) == ()
    for x, y in itertools.product((-3.0, -2.0, -1.0, 1.0, 2.0), (-0.1, 0.1)):
        circle(world, (x, y), radius=0.1, restitution=1.0)
    world.component(world.entity("bullet"), Transform).position = (-4.0, 0.0)
    world.component(world.entity("bullet"), Velocity).linear = (1e4, 0.0)
    world.step()
    worst = WorstWarnings()
    worst.add(find_warnings(world))
    (found,) = [advice for advice in worst.all if "sizes of a body" in advice.what]
    assert found.excess[0] > 10.0 and found.setting.startswith("simulation.substeps = ")


def test_a_box_that_spins_fast_is_said_near_others_alone() -> None:
    world = open_world(collisions="step")
    floor(world)
    box(world, (0, 50.0), angular_velocity=500.0)
    world.step()
    assert find_warnings(world) == ()
    top = box(world, (0, 0.3), angular_velocity=500.0, friction=0.0, name="top")
    world.step()
    found = only(world, "corners")
    assert (found.entity, found.unit) == ("top", "rad")
    spin = world.component(top, Velocity).angular  # impacts of its corners, at least 15 % of what it had
    assert found.value == pytest.approx(abs(spin) / 240, rel=1e-9) and abs(spin) > 75.0


@pytest.mark.parametrize(("where", "said"), [(1e6, False), (1e8, False), (2e9, True)])
def test_what_is_too_far_out_is_said(where: float, said: bool) -> None:
    world = open_world()
    circle(world, (where, 0.0), radius=0.5)
    world.synchronise()
    assert bool(find_warnings(world)) is said


def test_the_worst_of_each_kind_is_kept() -> None:
    worst = WorstWarnings()
    for value in (2.0, 5.0, 3.0):
        worst.add(
            [ModelWarning("a", "one", value, "m", 1.0, ""), ModelWarning(None, "two", None, "", None, "x")]
        )
    assert [(advice.what, advice.value) for advice in worst.all] == [("one", 5.0), ("two", None)]


def test_measuring_changes_nothing() -> None:
    worlds = load_scene("pile"), load_scene("pile")
    for _ in range(30):
        for world in worlds:
            world.step()
        find_warnings(worlds[0])
    one, two = (world.table(Transform)["position"].tobytes() for world in worlds)
    assert one == two


def test_run_writes_advice(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = open_world(integrator="leapfrog")
    hang(world, 4e4)
    save_scene(world, tmp_path / "stiff.json")
    command, output = ["run", str(tmp_path / "stiff.json"), "--steps", "20"], tmp_path / "o.json"
    assert main([*command, "--json", str(output)]) == 0
    document = json.loads(output.read_text())
    assert document["divided"] == 1
    found = next(advice for advice in document["advice"] if "coarsely" in advice["what"])
    assert list(found) == ["entity", "what", "value", "unit", "limit", "setting", "because"]
    assert found["entity"] == "rope" and found["value"] == pytest.approx(200 / 240)
    capsys.readouterr()
    assert main(command) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  advice")]
    assert any("rope" in line and found["setting"] in line for line in lines)


def test_the_hud_says_it_in_words() -> None:
    world = open_world(contacts="soft")
    floor(world)
    box(world, (0, 0.5), width=1, height=1, mass=1.0, name="light")
    box(world, (0, 1.5), width=1, height=1, mass=1e6)
    desk, canvas = recorded(world)
    frame(desk, canvas)
    words = [text["words"] for text in canvas.called("text")]
    assert any(word.startswith("! ") for word in words) and any("light" in word for word in words)
    world.clear()
    frame(desk, canvas)
    assert not any(text["words"].startswith("! ") for text in canvas.called("text"))


@pytest.mark.parametrize("size", [(1280, 720), (800, 600)])
def test_the_advice_lies_over_no_panel(size: tuple[int, int]) -> None:
    world = open_world(contacts="soft")
    floor(world)
    box(world, (0, 0.5), width=1, height=1, mass=1.0, name="light")
    box(world, (0, 1.5), width=1, height=1, mass=1e6)
    canvas = RecordingCanvas(size)
    desk = Desk(world, canvas)
    frame(desk, canvas)
    (advice,) = [p["rect"] for p in canvas.called("panel") if p["outline"] == desk.window.theme.warning]
    others = [p["rect"] for p in canvas.called("panel") if p["outline"] != desk.window.theme.warning]
    for x, y, wide, high in others:
        apart_x = x >= advice[0] + advice[2] or advice[0] >= x + wide
        apart_y = y >= advice[1] + advice[3] or advice[1] >= y + high
        assert apart_x or apart_y


def test_at_most_three_are_said_and_the_rest_counted() -> None:
    canvas = RecordingCanvas((800, 600))
    on = Drawing(canvas, Camera(canvas.size), THEMES[0], 12)
    many = [ModelWarning(f"body {n}", f"kind {n}", float(n), "", 1.0, "") for n in range(2, 8)]
    rect = draw_advice(many, (250, 50, 300, 550), on)
    words = [text["words"] for text in canvas.called("text")]
    assert sum("body" in word for word in words) == 3 and "body 7" in words[1] and words[-1] == "and 3 more"
    assert rect is not None and rect[2] <= 300
    style = TextStyle(11, THEMES[0].warning, bold=True)
    assert all(canvas.text_size(word, style)[0] <= 300 for word in words)
    assert draw_advice([], (250, 50, 300, 550), on) is None
    assert math.isinf(ModelWarning(None, "x", None, "", None, "").excess[0])


def test_an_error_smaller_than_two_rims_is_no_warning_to_a_pupil() -> None:
    canvas = RecordingCanvas((800, 600))
    on = Drawing(canvas, Camera(canvas.size, scale=100.0), THEMES[0], 12)
    for off, seen_only, drawn in (
        (1.7e-4, True, False),
        (1.7e-4, False, True),
        (6e-3, True, False),
        (4e-2, True, True),
    ):
        advice = [ModelWarning(None, "contacts are soft", off, "m", 0.0, "")]
        rect = draw_advice(advice, (100, 50, 600, 500), on, plainly=True, seen_only=seen_only)
        assert (rect is not None) is drawn
    steps = [ModelWarning(None, "steps were left to soft contacts", 4.0, "", 0.0, "")]
    assert draw_advice(steps, (100, 50, 600, 500), on, plainly=True, seen_only=True) is None
    assert draw_advice(steps, (100, 50, 600, 500), on, plainly=True) is not None
    beyond = [ModelWarning(None, "a joint gives way", 1e-4, "m", 1e-5, "")]
    assert draw_advice(beyond, (100, 50, 600, 500), on, seen_only=True) is not None


def test_of_warnings_without_a_limit_the_largest_is_kept() -> None:
    worst = WorstWarnings()
    for value in (1e-4, 3e-2, 2e-3):
        worst.add([ModelWarning(None, "off by so much", value, "m", 0.0, "")])
    assert [warning.value for warning in worst.all] == [3e-2]
