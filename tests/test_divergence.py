"""A run that diverges stops at the step before, says what and when, and leaves the last good state."""

import csv
import math
from pathlib import Path

import numpy as np
import pygame
import pytest
from desk import Desk, bits

from physicslab.cli import main
from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene, save_scene
from physicslab.history import SetField
from physicslab.languages.language import language
from physicslab.prefabs import box, circle
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at
from physicslab.world import World


def stiff_world(stiffness: float = 1e12, *, touching: bool = False, **simulation: object) -> World:
    """Return a world whose spring is too stiff for leapfrog: it diverges."""
    config = SimulationConfig(integrator="leapfrog", **simulation)  # type: ignore[arg-type]
    world = World(*standard_systems(), simulation=config, physics=PhysicsConfig(gravity_mode="none"))
    world.name = "boom"
    bob = world.spawn(Transform((0, -1.5)), Velocity(), Mass(1.0), name="bob")
    world.spawn(Spring(a=bob, anchor_b=(0, 0), rest_length=1.0, stiffness=stiffness), name="rope")
    if touching:
        box(world, (50, -0.5), width=20, height=1, static=True)
        circle(world, (50, 0.25), radius=0.25, name="ball")
    return world


def finite(world: World) -> bool:
    return bool(np.isfinite(np.frombuffer(bits(world))).all())


@pytest.mark.parametrize("touching", [False, True])
def test_a_step_that_diverges_leaves_the_world_where_it_was(touching: bool) -> None:
    world, before = stiff_world(touching=touching), b""
    with pytest.raises(Diverged, match="bob: Transform is no longer finite at t = "):
        for _ in range(1000):
            before = bits(world)
            world.step()
    assert bits(world) == before and finite(world)
    with pytest.raises(Diverged):
        world.step()
    assert bits(world) == before, "and as often as it is tried"
    world.remove(world.entity("rope"))
    world.step()
    assert finite(world), "without its cause it goes on"


@pytest.mark.parametrize("method", ["leapfrog", "symplectic_euler", "rk4"])
def test_a_compiled_run_stops_at_the_step_before(method: str) -> None:
    one, two = stiff_world(), stiff_world()
    for world in (one, two):
        world.simulation = SimulationConfig(integrator=method)
    with pytest.raises(Diverged) as stepped:
        for _ in range(1000):
            one.step()
    with pytest.raises(Diverged) as ran:
        two.run(steps=1000)
    assert (two.time, two.steps) == pytest.approx((one.time, one.steps)) and finite(two)
    assert str(ran.value) == str(stepped.value)


def test_a_method_that_finds_no_step_names_the_body() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"))
    for name, x, mass in (("sun", 0.0, 1.0), ("comet", 1.0, 1e-3)):
        world.spawn(Transform((x, 0)), Velocity(), Mass(mass), name=name)
    with pytest.raises(Diverged, match=r"comet falls into sun, and the pull .* \(after t = "):
        world.run(seconds=10.0)
    assert finite(world)
    assert 1.0 < world.time < math.pi / 2.0**1.5, "the fall takes pi / sqrt(8 G M)"
    place = world.component(world.entity("comet"), Transform).position.x
    assert 0.0 < place < 0.2


def test_a_method_beside_contacts_that_finds_no_step_names_the_body() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"))
    for name, x in (("slow", -3.0), ("fast", 3.0)):
        ball = circle(world, (x, 0), radius=0.5, name=name)
        world.add(ball, Drag(0.1, 0.1))
    world.component(world.entity("fast"), Velocity).linear = (1e200, 0.0)
    with pytest.raises(Diverged, match=r"fast: Velocity changes too fast: .* \(after t = 0 s\)"):
        world.run(steps=30)
    assert finite(world) and world.time == 0.0


def test_a_body_alone_is_named_and_not_the_row_of_the_world() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"))
    world.simulation = SimulationConfig(integrator="dop853", collisions="exact")
    circle(world, (-1.2, 1.5), radius=0.5, name="alone")
    world.component(world.entity("alone"), Velocity).linear = (1e30, 0.0)
    with pytest.raises(Diverged, match=r"^alone: Velocity changes too fast: "):
        world.run(steps=30)


def test_what_a_step_counts_is_taken_back() -> None:
    class Poison(ForceSystem):
        """A force that is not finite after a while."""

        needs = (Velocity,)

        @at(Stage.FORCE)
        def push(self, world: World, h: float) -> None:
            world.bodies.force[1:, 0] += math.inf if world.time > 0.12 else 0.0

    world = World(*standard_systems(), Poison())
    box(world, (0, -0.5), width=20, height=1, static=True)
    circle(world, (0, 0.25), radius=0.25, name="ball")
    evaluations: list[int] = []
    with pytest.raises(Diverged, match=r"ball: .* at t = 0\.133"):
        for _ in range(100):
            evaluations.append(world.force_evaluations)
            world.step()
    assert world.force_evaluations == evaluations[-1] and finite(world)


@pytest.fixture
def boom(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    save_scene(stiff_world(touching=True), tmp_path / "boom.json")
    return tmp_path


def failed(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that fails, and return the one line that it says."""
    assert main(["run", "boom.json", *arguments]) == 1
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    return said.err


def test_run_saves_the_last_good_state(boom: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = failed(capsys)
    assert "bob: Transform is no longer finite at t = " in said
    assert said.strip().endswith("is in boom-before-divergence.json")
    saved = load_scene(boom / "boom-before-divergence.json")
    assert finite(saved) and saved.time > 0.0
    assert f"of t = {saved.time:.9g} s" in said
    with pytest.raises(Diverged):
        saved.step()


def test_run_overwrites_nothing_and_keeps_the_old_document(
    boom: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = boom / "out"
    (out / "boom-before-divergence.json").write_text("mine")
    (out / "o.json").write_text("old")
    said = failed(capsys, "--json", str(out / "o.json"))
    assert said.strip().endswith("boom-before-divergence-2.json")
    assert (out / "boom-before-divergence.json").read_text() == "mine"
    assert (out / "o.json").read_text() == "old"
    assert load_scene(out / "boom-before-divergence-2.json").time > 0.0


def test_the_table_keeps_every_good_row(boom: Path, capsys: pytest.CaptureFixture[str]) -> None:
    failed(capsys, "--csv", str(boom / "out" / "rows.csv"))
    saved = load_scene(boom / "boom-before-divergence.json")
    with (boom / "out" / "rows.csv").open(newline="") as file:
        rows = list(csv.reader(file))[1:]
    assert all(math.isfinite(float(number)) for row in rows for number in (row[0], *row[2:]))
    last = [row for row in rows if row[1] == "bob"][-1]
    assert float(last[0]) == saved.time
    assert float(last[3]) == saved.component(saved.entity("bob"), Transform).position.y


def test_a_state_that_cannot_be_saved_is_reported(
    boom: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("physicslab.files.scene.save_new_scene", refuse)
    assert "could not be saved: [Errno 28] No space left" in failed(capsys)


def test_the_window_stays_open_on_the_last_good_state(boom: Path) -> None:
    desk = Desk(stiff_world(touching=True))
    desk.frames(60)
    assert desk.window.pace.paused and finite(desk.world)
    assert "bob: Transform is no longer finite at t = " in desk.window.error
    assert "saved as boom-before-divergence.json" in desk.window.error
    assert bits(load_scene(boom / "boom-before-divergence.json")) == bits(desk.world)
    german = language("de").reword(desk.window.error)
    assert german.startswith("Angehalten: bob: Transform ist bei t = ")
    assert german.endswith("Strg+Z nimmt die letzte Änderung zurück.")
    assert "nicht mehr endlich; ein kleineres dt" in german
    assert "zu sehen und als boom-before-divergence.json gespeichert" in german
    desk.key("space")
    desk.frames(5)
    assert desk.window.pace.paused and "saved before" in desk.window.error
    assert len(list(boom.glob("*divergence*"))) == 1
    desk.key("r")
    desk.key("space")
    desk.frames(5)
    assert [desk.window.pace.paused, desk.window.error] == [False, ""]


def test_the_words_of_a_stop_go_with_the_edit_that_led_to_it(boom: Path) -> None:
    desk = Desk(stiff_world(1.0))
    desk.frames(3)
    desk.window.edits.do(SetField(desk.world.entity("rope"), "Spring", "stiffness", 1e12))
    desk.frames(60)
    assert "bob" in desk.window.error and desk.window.pace.paused
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames(2)
    assert (
        desk.window.error == "" and desk.world.component(desk.world.entity("rope"), Spring).stiffness == 1.0
    )
