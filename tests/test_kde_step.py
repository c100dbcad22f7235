"""Worlds of KDE Step: what their items are here, and what is named as not taken."""

from __future__ import annotations

import html
import math
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, empty_world, sized, tap, write

from physicslab import World, cli
from physicslab.components import (
    Charge,
    Colour,
    Graph,
    GraphLine,
    Mass,
    Material,
    Meter,
    Molecule,
    Note,
    Pin,
    Rod,
    Rope,
    Shape,
    Slider,
    Spring,
    Thrust,
    Trail,
    Transform,
    Velocity,
)
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import SceneError, load_scene, save_scene


def item(number: int, kind: str, **properties: object) -> str:
    """Return an item of Step, named after its class and its number."""
    lines = "".join(f"\n    <{name}>{value}</{name}>" for name, value in properties.items())
    return f'  <item class="{kind}" id="{number}">\n    <name>{kind}{number}</name>{lines}\n  </item>\n'


def world_of(*items: str, **properties: object) -> str:
    """Return a file of Step."""
    lines = "".join(f"  <{name}>{value}</{name}>\n" for name, value in properties.items())
    head = '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE StepCoreXML>\n'
    space = 'xmlns="https://edu.kde.org/step/StepCoreXML" version="1.0"'
    return f'{head}<world {space} id="1">\n{lines}{"".join(items)}</world>\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "lab.step"


def opened(file: Path, *items: str, **properties: object) -> tuple[World, list[str]]:
    """Return the world of a file, and what is not taken."""
    file.write_text(world_of(*items, **properties), "utf-8")
    losses: list[str] = []
    return load_scene(file, losses), losses


PARTICLE = item(2, "Particle", position="(1,2)", velocity="(3,0)", mass=2)
DISK = item(3, "Disk", position="(0,5)", angularVelocity=2, mass=4, inertia=0.5, radius=0.25)
WEIGHT = item(4, "WeightForce", weightConst=9.8)


def test_a_particle_falls(file: Path) -> None:
    world, losses = opened(file, PARTICLE, WEIGHT, time=2)
    particle = world.entity("Particle2")
    assert (world.time, world.component(particle, Mass).mass, losses) == (2.0, 2.0, [])
    world.run(seconds=1.0)
    place = world.component(particle, Transform).position
    assert (place.x, place.y) == pytest.approx((4.0, 2.0 - 4.9), abs=1e-12)


def test_nothing_falls_without_weight(file: Path) -> None:
    world, _ = opened(file, PARTICLE)
    assert world.physics.gravity_mode == "none"


def test_shapes_are_elastic_and_smooth(file: Path) -> None:
    box = item(2, "Box", position="(1,2)", angle=0.5, size="(2,3)", mass=6, inertia="inf")
    wall = item(
        5, "Polygon", mass="inf", inertia="inf", vertexes="(0,0),(1,0),(1,4),(0,4)", angle=math.pi / 2
    )
    world, losses = opened(file, box, DISK, wall)
    box2, disc, flat = (world.entity(name) for name in ("Box2", "Disk3", "Polygon5"))
    assert [world.component(name, Shape).kind for name in (box2, disc, flat)] == ["box", "circle", "box"]
    assert world.component(box2, Shape).height == 3.0 and world.component(box2, Mass).fixed_rotation
    assert world.component(disc, Mass).inertia == 0.5 and world.component(disc, Velocity).angular == 2.0
    middle = world.component(flat, Transform).position
    assert (middle.x, middle.y) == pytest.approx((-2.0, 0.5)) and not world.has(flat, Velocity)
    assert (
        world.component(disc, Material).restitution == 1.0 and world.component(disc, Material).friction == 0.0
    )
    assert losses == []


def test_colours_that_were_chosen_are_kept(file: Path) -> None:
    red, plain = item(5, "Box", color="#ffFF8000"), item(6, "Box", color="#ff000000", position="(3,0)")
    world, losses = opened(file, red, plain)
    assert world.component(world.entity("Box5"), Colour).colour == "#ff8000"
    assert not world.has(world.entity("Box6"), Colour) and losses == []
    with pytest.raises(SceneError, match='<color> = "red": must be a colour #aarrggbb'):
        opened(file, item(5, "Box", color="red"))


def test_polygons_are_centred_and_those_that_are_not_convex_are_named(file: Path) -> None:
    wedge = item(2, "Polygon", position="(1,2)", mass=2, inertia=1, vertexes="(0,3),(3,0),(0,0)", angle=1)
    tip = item(3, "Spring", body1=2, body2=0, localPosition1="(3,0)", localPosition2="(9,9)")
    arrow = item(4, "Polygon", position="(9,2)", vertexes="(0,0),(2,2),(0,1),(-2,2)")
    world, losses = opened(file, wedge, tip, arrow, item(5, "Spring", body1=2, body2=4))
    made = world.entity("Polygon2")
    shape, place = world.component(made, Shape), world.component(made, Transform)
    assert {tuple(vertex) for vertex in shape.vertices} == {(-1.0, 2.0), (2.0, -1.0), (-1.0, -1.0)}
    corner = place.position + Vector2(-1.0, -1.0).rotated(place.angle)
    assert tuple(corner) == pytest.approx((1.0, 2.0))
    assert tuple(world.component(world.entity("Spring3"), Spring).anchor_a) == pytest.approx((2.0, -1.0))
    assert losses == [
        'Polygon "Polygon2" (line 4): its centre of mass is (-1, -1) m off that of its area; here it is not',
        'Polygon "Polygon4" (line 19): its vertices must be convex; at number 3 these turn inwards',
        'Spring "Spring5" (line 24): its body, item 4, is not taken',
    ]


def test_particles_are_small_discs_where_they_can_hit_something(file: Path) -> None:
    near = item(5, "Particle", position="(1.001,2)")
    world, losses = opened(file, PARTICLE, near, DISK)
    shape = world.component(world.entity("Particle2"), Shape)
    assert shape.kind == "circle" and shape.radius == pytest.approx(0.45e-3)
    assert losses == ["2 particles: have no size; here they touch as discs of 0.00045 m, each other too"]


def test_a_spring_has_the_period_that_it_means(file: Path) -> None:
    fixed = item(3, "Particle", position="(0,0)", mass="inf")
    spring = item(
        4, "Spring", restLength=1, stiffness=8, damping=0, body1=3, body2=2,
        localPosition1="(0,0)", localPosition2="(0,0)",
    )  # fmt: skip
    world, _ = opened(file, item(2, "Particle", position="(1.5,0)", mass=2), fixed, spring)
    world.run(seconds=math.pi / 2.0)  # half a period: omega = 2/s
    assert world.component(world.entity("Particle2"), Transform).position.x == pytest.approx(0.5, abs=1e-10)


def test_a_spring_to_the_world_has_its_body_first(file: Path) -> None:
    spring = item(4, "Spring", body1=0, body2=3, localPosition1="(7,8)", localPosition2="(0,1)")
    world, _ = opened(file, DISK, spring)
    made = world.component(world.entity("Spring4"), Spring)
    assert (made.a, made.b) == (world.entity("Disk3"), None)
    assert tuple(made.anchor_a) == (0.0, 1.0) and tuple(made.anchor_b) == (7.0, 8.0)


def test_a_pendulum_on_a_stick_has_the_period_that_it_means(file: Path) -> None:
    hook = item(3, "Particle", position="(0,0)", mass="inf")
    stick = item(5, "Stick", restLength=2.0, body1=2, body2=3)
    ball = item(2, "Particle", position="(1.2,-1.6)")
    world, losses = opened(file, ball, hook, stick, WEIGHT)
    # Half a period is 2 sqrt(l/g) K(sin(a/2)), K by the arithmetic-geometric mean.
    mean, other = 1.0, math.cos(0.5 * math.asin(0.6))
    for _ in range(6):
        mean, other = 0.5 * (mean + other), math.sqrt(mean * other)
    world.run(seconds=2.0 * math.sqrt(2.0 / 9.8) * math.pi / (2.0 * mean))
    place = world.component(world.entity("Particle2"), Transform).position
    assert (place.x, place.y) == pytest.approx((-1.2, -1.6), abs=1e-9) and losses == []


def test_sticks_and_ropes_are_as_long_as_files_of_six_digits_say(file: Path) -> None:
    ends = {"body1": 2, "body2": 0, "localPosition2": "(1,5)"}
    items = [
        item(5, "Stick", restLength=3.00001, **ends),
        item(6, "Rope", restLength=2.99999, **ends),
        item(7, "Rope", restLength=4, **ends | {"localPosition2": "(1,6)"}),
        item(8, "Stick", restLength=0, body1=2, body2=3, localPosition1="(-1,3)"),
    ]
    world, losses = opened(file, PARTICLE, DISK, *items)
    world.synchronise()
    assert [world.component(world.entity(f"Rope{n}"), Rope).length for n in (6, 7)] == [3.0, 4.0]
    assert world.component(world.entity("Stick5"), Rod).length == 3.0
    assert tuple(world.component(world.entity("Stick8"), Pin).anchor_a) == (-1.0, 3.0)
    world, losses = opened(file, PARTICLE, item(5, "Stick", restLength=2, **ends))
    assert losses == ['Stick "Stick5" (line 10): it is 3 m long as placed, and 2 m as it should be']


def test_pins_and_anchors_hold(file: Path) -> None:
    pin = item(5, "Pin", body=3, localPosition="(0.1,0)", position="(0.1,5)")
    anchor = item(6, "Anchor", body=2, position="(1,2)")
    still = DISK.replace("<angularVelocity>2<", "<angularVelocity>0<")
    world, losses = opened(file, PARTICLE.replace("(3,0)", "(0,0)"), still, pin, anchor, WEIGHT)
    assert not world.has(world.entity("Particle2"), Velocity)
    before = measure_energy(world).total
    world.run(seconds=1.0)
    disc = world.component(world.entity("Disk3"), Transform)
    arm = disc.position.x + 0.1 * math.cos(disc.angle), disc.position.y + 0.1 * math.sin(disc.angle)
    assert arm == pytest.approx((0.1, 5.0), abs=1e-9) and world.has(world.entity("Pin5"), Pin)
    assert measure_energy(world).total == pytest.approx(before, rel=1e-9)
    assert len(losses) == 1, "the particle's size"


def test_motors_that_turn_with_a_body_are_one_thrust(file: Path) -> None:
    push = {"body": 3, "localPosition": "(0,0.1)", "forceValue": "(2,0)", "rigidlyFixed": "true"}
    motors = item(5, "LinearMotor", **push), item(6, "LinearMotor", **push | {"localPosition": "(0.3,0.4)"})
    turn = item(7, "CircularMotor", body=3, torqueValue=1.5)
    other = item(8, "LinearMotor", body=3, localPosition="(0,0)", forceValue="(1,0)")
    slider = item(9, "Controller", object=7, property="torqueValue", index=-1, limits="(-1,1)")
    upright = DISK.replace("<radius", f"<angle>{math.pi / 2}</angle><radius")
    world, losses = opened(file, upright, *motors, turn, other, slider)
    thrust = world.component(world.entity("Disk3"), Thrust)
    assert tuple(thrust.force) == pytest.approx((0.0, -4.0)) and tuple(thrust.at) == (0.0, 0.1)
    assert thrust.frame == "body" and thrust.torque == pytest.approx(1.5 - 0.3 * 2.0)
    assert world.component(world.entity("Controller9"), Slider).changes == "Thrust.torque"
    assert losses == [
        'LinearMotor "LinearMotor8" (line 31): it cannot be one with the other motors of the body'
    ]


def test_motors_of_fixed_directions_act_as_one_at_every_angle(file: Path) -> None:
    forces = {"(3,-1)": (1.0, 2.0), "(0.5,2)": (-3.0, 0.5)}
    motors = [
        item(n, "LinearMotor", body=3, localPosition=at, forceValue=f"({x},{y})")
        for n, (at, (x, y)) in enumerate(forces.items(), start=5)
    ]
    world, losses = opened(file, DISK, *motors)
    thrust = world.component(world.entity("Disk3"), Thrust)
    for angle in (0.0, 1.0, 2.5):
        arm, force = thrust.at.rotated(angle), thrust.force
        torque = (3 * 2 + 1 * 1 + 0.5 * 0.5 + 2 * 3) * math.cos(angle)
        torque += (3 * 1 - 1 * 2 + 0.5 * -3 + 2 * 0.5) * math.sin(-angle)
        assert arm.cross(force) == pytest.approx(torque)
    assert tuple(thrust.force) == (-2.0, 2.5) and thrust.torque == 0.0 and losses == []


def test_what_has_an_infinite_mass_alone_turns_on_an_axle(file: Path) -> None:
    wheel = item(2, "Disk", position="(1,2)", mass="inf", inertia=0.5, angularVelocity=3)
    world, losses = opened(file, wheel, item(5, "CircularMotor", body=2, torqueValue=1), WEIGHT)
    world.run(seconds=1.0)
    wheel_now = world.component(world.entity("Disk2"), Transform)
    assert wheel_now.angle == pytest.approx(3.0 + 1.0) and losses == []
    assert tuple(wheel_now.position) == pytest.approx((1.0, 2.0))


def test_attraction_pulls_anchored_masses_too(file: Path) -> None:
    sun = item(5, "Particle", position="(0,0)", mass=100)
    world, losses = opened(
        file,
        PARTICLE,
        sun,
        item(6, "Anchor", body=5),
        item(7, "GravitationForce", gravitationConst=2),
        WEIGHT,
    )
    assert (world.physics.gravity_mode, world.physics.G) == ("planet", 2.0)
    assert world.component(world.entity("Particle5"), Mass).mass == 100.0
    assert len(losses) == 1 and losses[0].startswith('WeightForce "WeightForce4"')


def test_charges_act_on_each_other(file: Path) -> None:
    charges = [item(n, "ChargedParticle", position=f"({n},0)", charge=c) for n, c in ((2, 1e-3), (3, -2e-3))]
    world, losses = opened(file, *charges, item(4, "CoulombForce", coulombConst=9e9))
    assert world.component(world.entity("ChargedParticle3"), Charge).charge == -2e-3
    assert measure_energy(world).total == pytest.approx(-9e9 * 2e-6) and losses == []


def test_groups_are_flat_here(file: Path) -> None:
    ends = [item(n, "SoftBodyParticle", position=f"({n},0)") for n in (3, 4)]
    spring = item(5, "SoftBodySpring", body1=3, body2=4, stiffness=5, restLength=1)
    whole = item(2, "SoftBody").replace("  </item>", f"{''.join(ends)}{spring}  </item>")
    world, losses = opened(file, whole)
    spring5 = world.component(world.entity("SoftBodySpring5"), Spring)
    assert (spring5.a, spring5.b) == (world.entity("SoftBodyParticle3"), world.entity("SoftBodyParticle4"))
    assert len(world.entities()) == 3 and losses == []


def test_instruments_are_those_of_the_workbench(file: Path) -> None:
    page = html.escape("<style>p {}</style><p>One <b>two</b></p><p>three</p>")
    parts = [
        item(5, "Note", position="(3,4)", text=page),
        item(6, "Graph", objectX=1, propertyX="time", indexX=-1, objectY=2, propertyY="velocity", indexY=0),
        item(7, "Meter", object=3, property="kineticEnergy", index=-1),
        item(8, "Controller", object=3, property="mass", index=-1, limits="(-1,9)"),
        item(9, "Controller", object=4, property="weightConst", index=-1, limits="(0,20)"),
        item(10, "Tracer", body=2, localPosition="(0,0)"),
        item(11, "Meter", object=3, property="wetness", index=-1),
    ]
    world, losses = opened(file, PARTICLE, DISK, WEIGHT, *parts)
    note = world.component(world.entity("Note5"), Note)
    assert note.text == "One two\nthree" and tuple(note.place) == (3.0, 4.0)
    assert world.component(world.entity("Graph6"), Graph).across == "time"
    assert world.component(world.entity("Graph6 (2)"), GraphLine).quantity == "velocity x"
    assert world.component(world.entity("Meter7"), Meter).quantity == "kinetic energy"
    slider = world.component(world.entity("Controller8"), Slider)
    assert (slider.changes, slider.low, slider.high) == ("Mass.mass", 1e-300, 9.0)
    assert world.component(world.entity("Controller9"), Slider).changes == "gravity"
    assert world.has(world.entity("Particle2"), Trail)
    assert [loss.partition(": ")[0] for loss in losses] == [
        'Controller "Controller8" (line 42)', 'Meter "Meter11" (line 61)', "Particle2",
    ]  # fmt: skip


def test_a_long_note_stands_whole_in_the_description(file: Path) -> None:
    words = " ".join(f"word{n}" for n in range(200))
    world, _ = opened(file, item(5, "Note", text=f"&lt;p&gt;{words}&lt;/p&gt;"))
    note = world.component(world.entity("Note5"), Note).text
    assert note.endswith(" ...") and len(note) <= 400 and words in world.description


def test_a_note_keeps_its_paragraphs_which_the_window_breaks_into_lines(file: Path) -> None:
    words = "A particle that leaves the drop is slower than it was within"
    world, _ = opened(file, item(5, "Note", text=f"&lt;p&gt;{words}&lt;/p&gt;&lt;p&gt;- it cools&lt;/p&gt;"))
    assert world.component(world.entity("Note5"), Note).text.splitlines() == [words, "- it cools"]


def test_beside_bodies_a_long_note_is_its_first_line_and_stands_whole_in_the_description(file: Path) -> None:
    lines = ["Try it", "- Turn the box", *("- Press it down until it is still" for _ in range(3))]
    page = "".join(f"&lt;p&gt;{line}&lt;/p&gt;" for line in lines)
    world, _ = opened(file, DISK, item(5, "Note", text=page, position="(-8,2)"))
    assert world.component(world.entity("Note5"), Note).text == "Try it ..."
    assert "\n".join(lines) in world.description


def test_notes_that_would_cover_bodies_or_each_other_stand_beside_them(file: Path) -> None:
    where = {5: "(-0.1,5.1)", 6: "(-0.05,5)", 7: "(9,9)"}
    notes = [item(n, "Note", text="two words", position=place) for n, place in where.items()]
    world, _ = opened(file, DISK, *notes)
    disk = world.entity("Disk3")
    middle, radius = world.component(disk, Transform).position, world.component(disk, Shape).radius
    first, second, far = (world.component(world.entity(f"Note{n}"), Note).place for n in where)
    assert tuple(far) == (9.0, 9.0), "it covers nothing"
    left, right, low, high = middle.x - radius, middle.x + radius, middle.y - radius, middle.y + radius
    for place in (first, second):
        assert place.x >= right or place.y <= low or place.y > high or place.x < left - 0.5
    assert abs(first.y - second.y) > 0.2 or abs(first.x - second.x) > 1.0


def test_losses_are_named_in_the_description_too(file: Path) -> None:
    world, losses = opened(file, item(2, "Warp", speed=9), timeScale=100)
    assert losses == [
        'Warp "Warp2" (line 5): there is no "Warp"',
        "timeScale 100: the window chooses how fast time goes",
    ]
    lines = ["Not taken from the Step file:", *losses]
    assert world.description.splitlines() == lines
    desk = sized((1280, 720), world)
    assert set(lines) <= set(desk.ui.words), "each in a line of the panel"


LAUGHS = (
    '<!DOCTYPE w [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;">]><world id="1"><name>&b;</name></world>'
)
OUTSIDE = '<!DOCTYPE w [<!ENTITY a SYSTEM "file:///etc/passwd">]><world id="1"><name>&a;</name></world>'
REFUSED = {
    "entities": (LAUGHS, 'line 1: declares the entity "a"; must declare none'),
    "outside": (OUTSIDE, 'line 1: declares the entity "a"; must declare none'),
    "undeclared": ('<world id="1"><name>&a;</name></world>', "is not XML: undefined entity at line 1"),
    "empty": ("", "is not XML: no element found at line 1"),
    "JSON": ("{}", "is not XML: "),
    "cut": (world_of(PARTICLE)[:-20], "is not XML: no element found at line 8"),
    "CAD": ("ISO-10303-21;\nHEADER;", "is a model of CAD (ISO 10303), not a world of KDE Step"),
    "encoding": ('<?xml version="1.0" encoding="klingon"?><world/>', "is not XML: "),
    "deep": ('<world id="1">' + "<item>" * 60, "is nested too deeply to be a scene"),
    "root": ("<html/>", 'the root element = "html": must be "world"'),
    "no number": (world_of(PARTICLE.replace('id="2"', "")), 'Particle "Particle2" (line 4): id = ""'),
    "twice": (world_of(PARTICLE, PARTICLE), 'Particle "Particle2" (line 10): id = 2: must be a number that'),
    "word": (
        world_of(DISK.replace("0.25", "big")),
        'line 10: Disk: <radius> = "big": must be a finite number',
    ),
    "nan": (world_of(DISK.replace("0.25", "nan")), '<radius> = "nan": must be a finite number'),
    "one part": (
        world_of(PARTICLE.replace("(1,2)", "(1)")),
        'line 6: Particle: <position> = "(1)": must be a list of pairs',
    ),
    "infinite": (world_of(PARTICLE.replace("(1,2)", "(inf,2)")), '<position> = "(inf,2)": must be pairs'),
    "field": (
        world_of(DISK.replace("0.25", "-1")),
        'entity "Disk3": Shape.radius = -1.0: must be a finite number',
    ),
    "line of a field": (world_of(DISK.replace("0.25", "-1")), "(line 4)"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_bad_file_is_refused_in_one_line(name: str, file: Path) -> None:
    content, words = REFUSED[name]
    file.write_text(content, "utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(file)
    line = str(caught.value)
    assert line.startswith(f"{file}: ") and words in line and "\n" not in line and len(line) < 600


def test_import_writes_a_new_scene_file(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.write_text(world_of(PARTICLE, WEIGHT, item(9, "Warp")), "utf-8")
    assert cli.main(["import", str(file)]) == 0
    said = capsys.readouterr()
    out = file.with_suffix(".json")
    assert said.out == f"{out}: entities: 1; not taken: 1\n"
    assert said.err == 'not taken: Warp "Warp9" (line 14): there is no "Warp"\n'
    assert load_scene(out).physics == load_scene(file).physics
    assert cli.main(["import", str(file)]) == 2
    assert capsys.readouterr().err == f"physicslab: {out}: is there already; --out names another file\n"
    assert cli.main(["import", str(file), "--out", "-"]) == 0
    assert capsys.readouterr().out.encode() == out.read_bytes()
    assert cli.main(["import", str(file), "--out", str(file)]) == 2
    assert "is the name of a world of KDE Step" in capsys.readouterr().err


def test_run_takes_a_step_file(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.write_text(world_of(PARTICLE, item(9, "Warp")), "utf-8")
    assert cli.main(["run", str(file), "--steps", "2"]) == 0
    assert capsys.readouterr().err.startswith('not taken: Warp "Warp9"')


def test_one_that_is_dropped_on_the_window_opens_and_is_never_overwritten(file: Path) -> None:
    file.write_text(content := world_of(PARTICLE, item(9, "Warp")), "utf-8")
    desk = Desk(empty_world())
    desk.frames(SETTLED)
    pygame.event.post(pygame.Event(pygame.DROPFILE, file=str(file)))
    desk.frames(SETTLED)
    assert desk.world.has(desk.world.entity("Particle2"), Mass)
    assert desk.window.notice == f"Opened {file}; not taken: 1 (listed in the panel at the right)"
    with pytest.raises(SceneError, match=r"is the name of a world of KDE Step; a scene is JSON"):
        save_scene(desk.world, file)
    tap(desk, "s", pygame.KMOD_CTRL | pygame.KMOD_SHIFT)
    write(desk, str(file))
    tap(desk, "return")
    desk.frames(SETTLED)
    assert file.read_text("utf-8") == content


def gas(number: int, *places: float, **force: object) -> str:
    """Return a gas of particles on the x axis, with a force of Lennard and Jones."""
    particles = (
        item(number + 2 + n, "GasParticle", position=f"({x},0)", mass=1) for n, x in enumerate(places)
    )
    inside = item(number + 1, "GasLJForce", **force) + "".join(particles)
    return f'  <item class="Gas" id="{number}">\n    <name>gas</name>\n{inside}  </item>\n'


def test_particles_of_a_gas_are_molecules(file: Path) -> None:
    world, losses = opened(file, gas(2, 0.0, 0.05, depth=0.1, rmin=0.05, cutoff="inf"), item(9, "Particle"))
    molecules = [world.component(world.entity(f"GasParticle{n}"), Molecule) for n in (4, 5)]
    assert [(one.depth, one.distance) for one in molecules] == [(0.1, 0.05)] * 2
    assert not world.has(world.entity("Particle9"), Molecule)
    assert losses == []


def test_a_force_of_a_gas_that_ends_near_is_named_and_so_is_a_second_gas(file: Path) -> None:
    near, far = gas(2, 0.0, 1.0, rmin=1.0, cutoff=1.5), gas(12, 9.0, 9.5, depth=2.0, rmin=0.5)
    _, losses = opened(file, near, far)
    assert [loss.split(": ")[1] for loss in losses] == [
        "it ends at 1.5 m; here at 2.23 m",
        "molecules of all gases act on each other here, as on GasParticle4",
    ]
