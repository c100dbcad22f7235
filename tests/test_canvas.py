"""Canvas: smooth shapes on a pygame surface, exact to a fraction of a pixel; and one that takes notes."""

import math

import numpy as np
import pygame
import pytest
from numpy.typing import NDArray
from recording import RecordingCanvas

from physicslab.kernels import finishes
from physicslab.theme import Colour
from physicslab.view.canvas.canvas import Canvas, Finish, Look, Rounded, TextStyle
from physicslab.view.canvas.pygame_canvas import PygameCanvas

BLACK, WHITE, RED = (0, 0, 0), (255, 255, 255), (255, 0, 0)


def canvas_of(width: int = 200, height: int = 150) -> PygameCanvas:
    canvas = PygameCanvas(pygame.Surface((width, height), 0, 32))
    canvas.clear(BLACK, BLACK)
    return canvas


def light(canvas: PygameCanvas) -> NDArray[np.float64]:
    """Return how much of each pixel is covered, (height, width), for white on black."""
    return pygame.surfarray.array3d(canvas.surface)[:, :, 0].T / 255.0


def disc(canvas: Canvas, x: float, y: float, radius: float, angle: float = 0.0, rim: Colour = WHITE) -> None:
    look = Look.plain(WHITE, rim, 1)
    canvas.discs(np.array([[x, y]]), np.array([radius]), np.array([angle]), look)


def box(canvas: Canvas, x: float, y: float, width: float, height: float, angle: float = 0.0) -> None:
    look = Look.plain(WHITE, WHITE, 1)
    canvas.boxes(np.array([[x, y]]), np.array([[width, height]]), np.array([angle]), look)


@pytest.mark.parametrize("radius", [1.0, 2.5, 8.0, 31.4, 60.0])
def test_a_disc_covers_its_area_and_sits_where_it_should(radius: float) -> None:
    canvas = canvas_of()
    disc(canvas, 100.3, 70.8, radius)
    covered = light(canvas)
    assert covered.sum() == pytest.approx(math.pi * radius**2, rel=0.02, abs=0.5)
    rows, columns = np.mgrid[0:150, 0:200] + 0.5
    assert (covered * columns).sum() / covered.sum() == pytest.approx(100.3, abs=0.05)
    assert (covered * rows).sum() / covered.sum() == pytest.approx(70.8, abs=0.05)


@pytest.mark.parametrize("angle", [0.0, 0.1, 0.785, 1.57, 2.5])
def test_a_box_covers_its_area_at_any_angle(angle: float) -> None:
    canvas = canvas_of()
    box(canvas, 99.6, 75.2, 70.5, 30.25, angle)
    covered = light(canvas)
    assert covered.sum() == pytest.approx(70.5 * 30.25, rel=0.01)
    columns = np.arange(200) + 0.5
    spread_x = (covered * (columns - 99.6) ** 2).sum() / covered.sum()
    expected = (70.5**2 * math.cos(angle) ** 2 + 30.25**2 * math.sin(angle) ** 2) / 12
    assert spread_x == pytest.approx(expected, rel=0.02)


def test_angles_turn_counter_clockwise_on_the_screen() -> None:
    canvas = canvas_of()
    box(canvas, 100, 75, 80, 10, angle=math.pi / 4)
    covered = light(canvas)
    assert covered[75 - 20, 100 + 20] == 1.0  # right and up
    assert covered[75 + 20, 100 + 20] == 0.0


def test_edges_are_smooth() -> None:
    canvas = canvas_of()
    disc(canvas, 100.2, 75.3, 40)
    shades = np.unique(light(canvas))
    assert len(shades) > 50


def lit(shape: str, angle: float, finish: Finish = Finish.LIT, shadow: float = 0.0) -> PygameCanvas:
    """Return a picture of one grey disc, box or polygon on a light ground."""
    canvas = canvas_of()
    canvas.clear((200, 200, 200), (200, 200, 200))
    grey = np.array([[100, 100, 100]], np.uint8)
    look = Look(grey, grey, np.array([finish], np.int64), shadow)
    centre, turn = np.array([[100.0, 75.0]]), np.array([angle])
    if shape == "disc":
        canvas.discs(centre, np.array([30.0]), turn, look)
    elif shape == "box":
        canvas.boxes(centre, np.array([[60.0, 60.0]]), turn, look)
    else:
        corners = np.zeros((1, 8, 2))
        corners[0, :4] = np.array([(70, 105), (130, 105), (130, 45), (70, 45)])
        corners[0, 4:] = corners[0, 3]
        canvas.rounded(Rounded(corners, np.array([4]), np.array([0.5])), look)
    return canvas


def test_a_disc_shows_how_far_it_has_turned_and_a_point_does_not() -> None:
    for finish, seen in ((Finish.LIT, True), (Finish.POINT, False)):
        turned = [light(lit("disc", angle, finish)) for angle in (0.0, 0.6)]
        assert bool(np.abs(turned[0] - turned[1]).sum() > 5.0) is seen


@pytest.mark.parametrize("shape", ["disc", "box", "polygon"])
def test_bodies_are_lit_from_above(shape: str) -> None:
    picture = light(lit(shape, -1.0))
    above, below = picture[50:60, 95:105].mean(), picture[90:100, 85:95].mean()
    assert above > 100 / 255 > below > 0.7 * 100 / 255


@pytest.mark.parametrize("shape", ["disc", "box", "polygon"])
def test_a_shadow_is_soft_lies_below_and_hides_nothing_of_its_body(shape: str) -> None:
    without, with_shadow = (light(lit(shape, 0.0, shadow=share)) for share in (0.0, 0.3))
    assert np.array_equal(without[60:95, 80:120], with_shadow[60:95, 80:120])
    column = with_shadow[105:116, 100]
    assert column[0] < 0.75 * 200 / 255 and column[-1] == without[115, 100]
    assert (np.diff(column) >= 0.0).all() and len(np.unique(column)) > 3
    assert np.array_equal(with_shadow[:40], without[:40])


@pytest.mark.parametrize("finish", [one for one in Finish if one >= Finish.GROUND])
@pytest.mark.parametrize("shape", ["disc", "box", "polygon"])
def test_each_material_looks_its_own_way_and_keeps_its_colour(shape: str, finish: Finish) -> None:
    plain, own = light(lit(shape, 0.4))[60:90, 85:115], light(lit(shape, 0.4, finish))[60:90, 85:115]
    assert np.abs(plain - own).max() > 0.02
    clear = finish in (Finish.ICE, Finish.GLASS)
    assert abs(own.mean() - 100 / 255) < (0.3 if clear else 0.15)


def test_what_is_clear_shows_what_is_behind() -> None:
    assert light(lit("box", 0.0, Finish.GLASS)).mean() > light(lit("box", 0.0)).mean() + 0.02


def test_finishes_have_the_numbers_of_the_kernel() -> None:
    assert tuple(Finish.__members__) == finishes.FINISHES
    assert [int(one) for one in Finish] == list(range(len(finishes.FINISHES)))


def test_a_hatch_marks_what_cannot_move() -> None:
    canvas = canvas_of()
    fill, rim = np.array([[40, 40, 40]], np.uint8), np.array([[255, 255, 255]], np.uint8)
    look = Look(fill, rim, np.array([Finish.GROUND], np.int64))
    canvas.boxes(np.array([[100.0, 75.0]]), np.array([[120.0, 90.0]]), np.zeros(1), look)
    inside = light(canvas)[45:105, 60:140]
    rows = inside.max(axis=1) - inside.min(axis=1)
    assert (rows > 0.06).all() and (inside < 0.4).all()  # faint, and in every row


def test_a_sky_goes_from_its_top_to_its_bottom_and_grain_is_small() -> None:
    canvas = canvas_of()
    canvas.clear((20, 20, 20), (60, 60, 60), 4)
    rows = light(canvas).mean(axis=1) * 255.0
    assert rows[0] == pytest.approx(20, abs=1) and rows[-1] == pytest.approx(60, abs=1)
    assert (np.diff(rows[::10]) > 0.0).all()
    assert np.ptp(light(canvas)[75]) * 255.0 <= 4.0 + 1e-6


def test_a_kept_picture_is_the_same_as_a_drawn_one_and_is_drawn_twice() -> None:
    canvas, drawn = canvas_of(), []

    def draw() -> None:
        drawn.append(1)
        canvas.clear((20, 20, 20), (60, 60, 60), 4)

    pictures = []
    for key in ("here", "here", "here", "there", "here"):
        canvas.keep(key, draw)
        pictures.append(light(canvas))
        canvas.clear(BLACK, BLACK)
    assert len(drawn) == 4 and all(np.array_equal(pictures[0], other) for other in pictures)


def test_light_is_added_and_fades_outwards() -> None:
    canvas = canvas_of()
    canvas.clear((40, 40, 40), (40, 40, 40))
    canvas.glows(np.array([[100.0, 75.0]]), np.array([30.0]), (100, 100, 100), np.array([0.5]))
    row = light(canvas)[75, 100:140] * 255.0
    assert row[0] == pytest.approx(90, abs=3) and row[-1] == pytest.approx(40) and (np.diff(row) <= 0.0).all()


@pytest.mark.parametrize("place", [(-20.0, 75.0), (205.0, 150.0), (1e7, 1e7), (-1e12, 3.0), (100.0, -1e15)])
@pytest.mark.parametrize("size", [0.2, 30.0, 1e6, 1e9])
def test_what_is_partly_or_far_off_the_picture_does_no_harm(place: tuple[float, float], size: float) -> None:
    canvas = canvas_of()
    disc(canvas, *place, size)
    box(canvas, *place, size, 3 * size, 0.5)
    ends = np.array([place]), np.array([[100.0, 75.0]])
    canvas.lines(*ends, WHITE, 3.0)


def test_a_disc_larger_than_the_picture_fills_it() -> None:
    canvas = canvas_of()
    disc(canvas, 100, 75, 1e6)
    box(canvas, 100, 75, 1e6, 1e6, 0.3)
    assert light(canvas).min() == 1.0


@pytest.mark.parametrize(("dx", "dy"), [(100.0, 0.0), (0.0, 90.0), (70.0, 50.0), (-60.0, 55.0)])
def test_a_line_covers_its_length_times_its_width(dx: float, dy: float) -> None:
    canvas = canvas_of()
    start = np.array([[90.5, 40.25]])
    canvas.lines(start, start + np.array([dx, dy]), WHITE, 3.0)
    length = math.hypot(dx, dy)
    assert light(canvas).sum() == pytest.approx(3.0 * length + math.pi * 1.5**2, rel=0.03)


def test_opacity_lets_the_picture_through() -> None:
    canvas = canvas_of()
    canvas.lines(np.array([[10.0, 75.0]]), np.array([[190.0, 75.0]]), WHITE, 9.0, 0.5)
    assert light(canvas)[75, 100] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("masks", [(0xFF0000, 0xFF00, 0xFF, 0), (0xFF, 0xFF00, 0xFF0000, 0)])
def test_colours_are_right_whatever_the_order_of_channels(masks: tuple[int, int, int, int]) -> None:
    canvas = PygameCanvas(pygame.Surface((60, 60), 0, 32, masks))
    canvas.clear((10, 20, 30), (10, 20, 30))
    look = Look.plain((200, 100, 50), (200, 100, 50), 1)
    canvas.discs(np.array([[30.0, 30.0]]), np.array([10.0]), np.zeros(1), look)
    assert tuple(canvas.surface.get_at((30, 30)))[:3] == (200, 100, 50)
    assert tuple(canvas.surface.get_at((2, 2)))[:3] == (10, 20, 30)


def test_other_depths_are_refused() -> None:
    with pytest.raises(ValueError, match="32 bits"):
        PygameCanvas(pygame.Surface((10, 10), 0, 24))


def test_panels_have_round_corners_and_let_through_what_they_should() -> None:
    canvas = canvas_of()
    canvas.clear(WHITE, WHITE)
    canvas.panel((20, 20, 100, 60), BLACK, BLACK, 0.75)
    covered = 1.0 - light(canvas)
    assert covered[50, 70] == pytest.approx(0.75, abs=0.01)
    assert covered[20, 20] < 0.2  # cut by the round corner
    assert covered[19, 70] == 0.0
    canvas.panel((0, 0, 0, 10), BLACK, BLACK)  # nothing to draw is no error


def test_words_are_as_wide_as_announced_and_align() -> None:
    canvas = canvas_of()
    style = TextStyle(16, WHITE)
    width, height = canvas.text_size("Energy 12 J", style)
    canvas.text("Energy 12 J", (190, 10), style, "right")
    columns = np.flatnonzero(light(canvas).max(axis=0))
    rows = np.flatnonzero(light(canvas).max(axis=1))
    assert columns[0] >= 190 - width and columns[-1] <= 190
    assert rows[0] >= 10 and rows[-1] <= 10 + height


def test_the_same_words_are_rendered_once() -> None:
    canvas = canvas_of()
    for _ in range(3):
        canvas.text("again", (5, 5), TextStyle(14, RED))
    assert canvas._surfaces.text.cache_info().currsize == 1
    for n in range(2000):
        canvas.text(f"{n}", (5, 5), TextStyle(14, RED))
    assert canvas._surfaces.text.cache_info().currsize <= 512


def test_a_recording_canvas_takes_the_same_calls() -> None:
    canvas = RecordingCanvas((100, 80))
    canvas.clear(BLACK, BLACK)
    disc(canvas, 10, 20, 5)
    box(canvas, 10, 20, 5, 6)
    canvas.lines(np.zeros((1, 2)), np.ones((1, 2)), RED)
    canvas.panel((1, 2, 3, 4), BLACK, RED)
    canvas.text("hello", (1, 2), TextStyle(12, RED))
    assert [name for name, _ in canvas.calls] == ["clear", "discs", "boxes", "lines", "panel", "text"]
    assert canvas.words == ["hello"]
    assert canvas.text_size("hello", TextStyle(12, RED))[0] > 0
