"""RenderSystem: what is drawn of a world, and that drawing changes nothing of it."""

import math
from typing import Any

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, bits, empty_world
from recording import RecordingCanvas

from physicslab.components import Held, Mass, Rod, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.files.scene import load_scene
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.systems.frame.render import RenderSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage
from physicslab.theme import DARK
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Finish
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.picture.backdrop import grid_spacing
from physicslab.view.picture.bodies import body_rows, point_radii
from physicslab.view.picture.extent import extent_of
from physicslab.view.picture.picture import draw_world
from physicslab.view.window.window import Window
from physicslab.view.workbench.world_view import WorldView
from physicslab.world import World


def drawn(world: World, scale: float = 100.0) -> RecordingCanvas:
    """Draw a world onto a canvas that takes notes."""
    canvas = RecordingCanvas((1280, 720))
    window = Window(canvas)
    window.camera.scale = scale
    world.install(RenderSystem(WorldView(window).draw))
    world.frame(Stage.RENDER, FRAME)
    return canvas


def only(canvas: RecordingCanvas, name: str) -> dict[str, Any]:
    (call,) = canvas.called(name)
    return call


def test_the_picture_begins_with_the_sky() -> None:
    canvas = drawn(empty_world())
    sky = {"top": DARK.sky_top, "bottom": DARK.sky_bottom, "grain": DARK.grain}
    assert canvas.calls[0] == ("clear", sky)


def test_in_space_there_are_stars_and_no_grid_and_a_heavy_star_shines() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"))
    for x, mass in ((0.0, 8.0), (1.0, 1e-3), (2.0, 8e-3)):
        world.spawn(Transform((x, 0)), Velocity(), Mass(mass))
    canvas = RecordingCanvas((1280, 720))
    draw_world(world, Camera(canvas.size), DARK, canvas)
    assert {call["colour"] for call in canvas.called("lines")} == {DARK.text}  # the stars
    discs = only(canvas, "discs")
    assert discs["radius"].tolist() == [14.0, 3.5, 3.5] and len(canvas.called("glows")) == 2
    assert discs["look"].finish.tolist() == [Finish.FLAT, Finish.POINT, Finish.POINT]
    radii = point_radii(world, world.entity_index.rows_of(np.array(world.entities())))
    assert radii.tolist() == [14.0, 3.5, 3.5]
    world.component(world.entities()[1], Mass).mass = 1.0
    assert point_radii(world, body_rows(world).points)[1] == pytest.approx(7.0)  # an eighth of the mass


def test_bodies_are_drawn_where_and_as_large_as_they_are() -> None:
    world = empty_world()
    circle(world, (1, 2), radius=0.5, angle=0.7)
    box(world, (-1, 0), width=2, height=0.5, angle=-0.2)
    canvas = drawn(world)
    discs, boxes = only(canvas, "discs"), only(canvas, "boxes")
    assert discs["centre"].tolist() == [[740.0, 160.0]]
    assert discs["radius"].tolist() == [50.0] and discs["angle"].tolist() == [0.7]
    assert boxes["centre"].tolist() == [[540.0, 360.0]]
    assert boxes["extent"].tolist() == [[200.0, 50.0]] and boxes["angle"].tolist() == [-0.2]


def test_what_cannot_move_is_hatched_and_has_its_own_colour() -> None:
    world = empty_world()
    box(world, (0, 0), static=True)
    box(world, (1, 0))
    kinematic = box(world, (2, 0))
    world.discard(kinematic, Mass)
    held = box(world, (3, 0))
    world.add(held, Held())
    look = only(drawn(world), "boxes")["look"]
    assert look.finish.tolist() == [Finish.GROUND, Finish.LIT, Finish.LIT, Finish.LIT]
    rims = [tuple(rim) for rim in look.rim.tolist()]
    assert rims[0] == DARK.static and rims[1] in DARK.bodies
    assert rims[2] == DARK.kinematic and rims[3] == DARK.held


def test_neighbours_in_time_differ_in_colour() -> None:
    world = empty_world()
    for n in range(6):
        circle(world, (n * 0.5, 0))
    rims = only(drawn(world), "discs")["look"].rim
    assert len({tuple(rim) for rim in rims.tolist()}) == 6


def test_off_the_screen_is_off_the_list() -> None:
    world = empty_world()
    for x in (0.0, 6.5, 7.0, -50.0):
        circle(world, (x, 0), radius=0.25)
        box(world, (0, x), width=0.5, height=0.5)
    canvas = drawn(world)
    assert only(canvas, "discs")["centre"][:, 0].tolist() == [640.0, 1290.0]
    assert only(canvas, "boxes")["centre"][:, 1].tolist() == [360.0]


@pytest.mark.parametrize("scale", [1.0, 100.0])
def test_points_without_shape_have_a_size_of_their_own(scale: float) -> None:
    world = empty_world()
    world.spawn(Transform((0, 0)), Mass(1e30))
    world.spawn(Transform((1, 0)), Velocity(), Mass(1))
    world.spawn(Transform((2, 0)))  # no body
    points = only(drawn(world, scale), "discs")
    assert points["radius"].tolist() == [5.0, 5.0]
    assert all(tuple(rim) in DARK.bodies for rim in points["look"].rim.tolist())
    assert not points["look"].finish.any()


@pytest.mark.filterwarnings("error")
def test_lost_bodies_are_left_out() -> None:
    world = empty_world()
    for n in range(4):
        circle(world, (n, 0))
        box(world, (n, 1))
    world.spawn(Transform((0, 0)), Velocity())
    world.synchronise()
    position, angle = world.table(Transform)["position"], world.table(Transform)["angle"]
    position[1], position[2], position[9] = math.nan, (math.inf, 0), math.nan
    angle[3] = math.inf
    canvas = drawn(world)
    for given in canvas.called("discs") + canvas.called("boxes"):
        assert np.isfinite(given["centre"]).all() and np.isfinite(given["angle"]).all()
    assert len(only(canvas, "discs")["centre"]) == 2


@pytest.mark.parametrize(
    ("gravity", "ground"), [((0, -9.81), [[0, 560], [1280, 720]]), ((0, 9.81), [[533, 560], [947, 567]])]
)
def test_the_world_ends_in_thin_walls_and_all_below_is_ground(
    gravity: tuple[float, float], ground: list[list[float]]
) -> None:
    canvas = drawn(empty_world(bounds=(-1, -2, 3, 2), gravity=gravity))
    (edge,) = [call for call in canvas.called("lines") if call["colour"] == DARK.static]
    assert edge["start"].tolist() == [[540, 160], [940, 160], [940, 560], [540, 560]]
    walls = only(canvas, "boxes")
    low, high = walls["centre"] - 0.5 * walls["extent"], walls["centre"] + 0.5 * walls["extent"]
    assert low.tolist() == [[533, 160], [940, 160], [533, 153], ground[0]]
    assert high.tolist() == [[540, 560], [947, 560], [947, 160], ground[1]]


@pytest.mark.parametrize("scale", [1e-12, 1e-3, 0.7, 100.0, 12345.0])
def test_grid_lines_are_round_numbers_apart_and_not_too_many(scale: float) -> None:
    spacing = grid_spacing(scale)
    assert 45.0 - 1e-6 <= spacing * scale <= 45.0 * 2.5 + 1e-6
    first = spacing / 10.0 ** math.floor(math.log10(spacing) + 1e-9)
    assert min(abs(first - round_number) for round_number in (1, 2, 5)) < 1e-9


def test_extent_is_of_what_there_is_to_see() -> None:
    world = empty_world()
    assert extent_of(world) is None
    circle(world, (0, 0), radius=0.5)
    circle(world, (10, 2), radius=0.5)
    box(world, (0, -1), width=1e6, height=1, static=True)
    extent = extent_of(world)
    assert extent is not None
    xmin, ymin, xmax, ymax = extent
    assert -20 < xmin <= -0.5 and 10.5 <= xmax < 30 and ymin == -1.5 and ymax >= 2.5


def test_extent_of_what_hangs_holds_what_it_hangs_from() -> None:
    world = World(*standard_systems())
    bob = world.spawn(Transform((0.5, 1.0)), Velocity(), Mass(1.0))
    world.spawn(Rod(b=bob, anchor_a=(0.0, 3.0)))
    extent = extent_of(world)
    assert extent is not None and extent[0] <= 0.0 and extent[3] >= 3.0


def test_extent_of_walls_alone_and_of_lost_bodies() -> None:
    world = empty_world()
    box(world, (0, 0), width=4, height=2, static=True)
    assert extent_of(world) == (-2.0, -1.0, 2.0, 1.0)
    lost = circle(world, (0, 0))
    world.synchronise()
    world.table(Transform)["position"][world.entity_index.row_of[lost]] = math.nan
    assert extent_of(world) == (-2.0, -1.0, 2.0, 1.0)


@pytest.mark.parametrize("name", ["sandbox", "stack", "spring_chain", "two_planets"])
def test_drawing_changes_no_bit_of_the_world(name: str) -> None:
    alone, watched = load_scene(name), load_scene(name)
    desk = Desk(watched)
    for n in range(40):
        alone.step()
        desk.frames()
        if n % 7 == 0:
            desk.key("f" if n % 2 else "home")
    assert watched.steps == alone.steps == 40
    assert bits(watched) == bits(alone)
    assert watched.time == alone.time


@pytest.mark.parametrize("name", SCENES)
def test_every_built_in_scene_can_be_drawn(name: str) -> None:
    world = load_scene(name)
    canvas = PygameCanvas(pygame.Surface((640, 360), 0, 32))
    window = Window(canvas)
    world.install(RenderSystem(WorldView(window).draw))
    window.framing.fit(world)
    world.frame(Stage.RENDER, FRAME)
    picture = pygame.surfarray.array2d(canvas.surface)
    assert len(np.unique(picture)) > 20
