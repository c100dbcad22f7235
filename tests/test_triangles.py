"""The painter of panels against references: which pixels a triangle covers, and in which colour."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pygame
import pytest
from numpy.typing import NDArray

from physicslab.kernels.triangles import paint_triangles

type Picture = NDArray[np.uint32]
type Corner = tuple[float, float]

SIZE = (48, 64)
"""Height and width of the pictures [px]."""
SOLID = np.full((4, 4), 255, np.uint8)


def rgba(red: int, green: int, blue: int, alpha: int = 255) -> int:
    return red | green << 8 | blue << 16 | alpha << 24


def vertices_of(
    corners: list[Corner], colours: list[int], texture: list[Corner] | None = None
) -> NDArray[np.float32]:
    vertices = np.zeros((len(corners), 5), np.float32)
    vertices[:, :2] = corners
    if texture is not None:
        vertices[:, 2:4] = texture
    vertices.view(np.uint32)[:, 4] = colours
    return vertices


def painted(
    corners: list[Corner], order: list[int], colours: list[int], *, onto: Picture | None = None,
    texture: list[Corner] | None = None, coverage: NDArray[np.uint8] = SOLID,
    clip: tuple[int, int, int, int] | None = None,
) -> Picture:  # fmt: skip
    pixels = np.zeros(SIZE, np.uint32) if onto is None else onto.copy()
    vertices = vertices_of(corners, colours, texture)
    left, top, right, bottom = clip or (0, 0, SIZE[1], SIZE[0])
    paint_triangles(
        pixels, vertices, vertices.view(np.uint32), np.array(order, np.uint32), 0, len(order), 0, coverage,
        left, top, right, bottom,
    )  # fmt: skip
    return pixels


def channels(pixels: Picture) -> NDArray[np.int64]:
    """Return red, green, blue and alpha of each pixel (height, width, 4)."""
    return np.stack([(pixels >> shift) & 255 for shift in (16, 8, 0, 24)], axis=-1).astype(np.int64)


def covered(corners: list[Corner]) -> NDArray[np.bool_]:
    """Return which pixels a triangle covers, in whole numbers of eighths of a pixel.

    A middle that lies on an edge counts where a point a little to the right of it, and less below, is inside.
    """
    (xa, ya), (xb, yb), (xc, yc) = ((round(8 * x), round(8 * y)) for x, y in corners)
    if (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa) < 0:
        xb, yb, xc, yc = xc, yc, xb, yb
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]] * 8 + 4
    inside = np.ones(SIZE, bool)
    for x0, y0, x1, y1 in ((xa, ya, xb, yb), (xb, yb, xc, yc), (xc, yc, xa, ya)):
        weight = (x1 - x0) * (rows - y0) - (y1 - y0) * (columns - x0)
        a_little = y0 - y1 if y0 != y1 else x1 - x0
        inside &= (weight > 0) | ((weight == 0) & (a_little > 0))
    area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)
    return inside if area else np.zeros(SIZE, bool)


def quarters(random: np.random.Generator, count: int) -> list[Corner]:
    """Return points at quarters of pixels, many of them middles and corners of pixels, some outside."""
    places = random.integers(-20, [4 * SIZE[1] + 20, 4 * SIZE[0] + 20], (count, 2)) / 4
    return [(float(x), float(y)) for x, y in places]


@pytest.mark.parametrize("seed", range(60))
def test_a_triangle_covers_the_pixels_whose_middle_is_inside(seed: int) -> None:
    corners = quarters(np.random.default_rng(seed), 3)
    if seed % 3 == 0:  # with a level and an upright edge
        corners[1] = corners[1][0], corners[0][1]
        corners[2] = corners[1][0], corners[2][1]
    for order in ([0, 1, 2], [2, 1, 0], [1, 2, 0]):
        pixels = painted(corners, order, [rgba(9, 8, 7)] * 3)
        assert np.array_equal(pixels != 0, covered(corners))
        assert set(np.unique(pixels)) <= {0, 0xFF090807}


def mesh(seed: int) -> tuple[list[Corner], list[list[int]]]:
    """Return the corners of triangles that fill a rectangle from (4, 4) to (60, 44) without gaps."""
    random = np.random.default_rng(seed)
    across, down = np.linspace(4, 60, 8), np.linspace(4, 44, 6)
    corners = []
    for y in down:
        for x in across:
            dx, dy = random.integers(-7, 8, 2) / 4
            corners.append((float(x + dx * (4 < x < 60)), float(y + dy * (4 < y < 44))))
    triangles = []
    for row in range(5):
        for column in range(7):
            a = 8 * row + column
            b, c, d = a + 1, a + 9, a + 8
            halves = ([a, b, c], [a, c, d]) if random.random() < 0.5 else ([a, b, d], [b, c, d])
            triangles += [list(random.permutation(half)) for half in halves]
    return corners, triangles


@pytest.mark.parametrize("seed", range(20))
def test_triangles_with_common_edges_leave_no_gap_and_paint_no_pixel_twice(seed: int) -> None:
    corners, triangles = mesh(seed)
    times = np.zeros(SIZE, int)
    for triangle in triangles:
        times += painted(corners, triangle, [rgba(255, 255, 255)] * len(corners)) != 0
    expected = np.zeros(SIZE, int)
    expected[4:44, 4:60] = 1
    assert np.array_equal(times, expected)
    everything = [corner for triangle in triangles for corner in triangle]
    half = painted(corners, everything, [rgba(200, 100, 50, 128)] * len(corners))
    assert len(np.unique(half[4:44, 4:60])) == 1, "half as opaque, it would show"


@pytest.mark.parametrize("seed", range(30))
def test_rectangles_are_what_pygame_fills_and_what_two_triangles_cover(seed: int) -> None:
    random = np.random.default_rng(seed)
    left, top = (int(n) for n in random.integers(-8, 40, 2))
    width, height = (int(n) for n in random.integers(0, 40, 2))
    shift = float(random.choice([0.0, 0.25, 0.5, 0.75]))
    x0, y0, x1, y1 = left + shift, top + shift, left + width + shift, top + height + shift
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    pixels = painted(corners, [0, 1, 2, 0, 2, 3], [rgba(10, 20, 30)] * 4)
    surface = pygame.Surface(SIZE[::-1], 0, 32)
    moved = 1 if shift > 0.5 else 0  # the first middle that is not above or left of the edge
    surface.fill((1, 1, 1), (left + moved, top + moved, width, height))
    assert np.array_equal(pixels != 0, pygame.surfarray.array3d(surface)[:, :, 0].T != 0)
    halves = covered([corners[n] for n in (0, 1, 2)]) ^ covered([corners[n] for n in (0, 2, 3)])
    assert np.array_equal(pixels != 0, halves)


@pytest.mark.parametrize("alpha", [1, 3, 64, 127, 128, 200, 254, 255])
@pytest.mark.parametrize("shape", ["rectangle", "triangle"])
def test_colours_are_laid_over_others_as_their_opacity_demands(alpha: int, shape: str) -> None:
    corners = [(4.0, 4.0), (40.0, 4.0), (40.0, 40.0), (4.0, 40.0)]
    order = [0, 1, 2, 0, 2, 3] if shape == "rectangle" else [0, 1, 2]
    for below in ((0, 0, 0, 0), (255, 255, 255, 255), (12, 130, 250, 255), (60, 30, 0, 80)):
        ground = np.full(SIZE, below[0] << 16 | below[1] << 8 | below[2] | below[3] << 24, np.uint32)
        pixels = painted(corners, order, [rgba(200, 100, 7, alpha)] * 4, onto=ground)
        share = alpha / 255
        expected = np.array((200, 100, 7, 255)) * share + np.array(below) * (1 - share)
        found = channels(pixels)[10, 30]
        assert np.all(np.abs(found - expected) <= 1.6), (found, expected)
        assert np.all(found[:3] <= found[3]), "premultiplied: no colour is above alpha"
        assert np.array_equal(pixels[:4], ground[:4]) and np.array_equal(pixels[:, 40:], ground[:, 40:])


def test_opacity_between_corners_is_interpolated() -> None:
    corners, opacities = [(2.0, 3.0), (61.0, 5.0), (20.0, 46.0)], [250, 10, 120]
    for order in ([0, 1, 2], [0, 2, 1]):
        colours = [rgba(255, 255, 255, opacity) for opacity in opacities]
        pixels, mask = channels(painted(corners, order, colours)), covered(corners)
        (xa, ya), (xb, yb), (xc, yc) = corners
        matrix = np.linalg.inv(np.array([[xa, xb, xc], [ya, yb, yc], [1.0, 1.0, 1.0]]))
        rows, columns = np.nonzero(mask)
        shares = matrix @ np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))])
        assert len(rows) > 1000
        found = pixels[rows, columns]
        assert np.all(np.abs(found[:, 3] - shares.T @ np.array(opacities)) <= 1.6)
        assert np.all(found == found[:, 3:]) and np.all(pixels[~mask] == 0)


@pytest.mark.parametrize("order", [[0, 1, 2, 0, 2, 3], [0, 1, 3, 1, 2, 3]])
def test_letters_are_taken_from_the_texture_pixel_by_pixel(order: list[int]) -> None:
    random = np.random.default_rng(5)
    coverage = random.integers(0, 256, (32, 16)).astype(np.uint8)
    corners = [(8.0, 10.0), (20.0, 10.0), (20.0, 30.0), (8.0, 30.0)]  # texels (2, 4) to (14, 24), one to one
    texture = [(2 / 16, 4 / 32), (14 / 16, 4 / 32), (14 / 16, 24 / 32), (2 / 16, 24 / 32)]
    pixels = channels(painted(corners, order, [rgba(255, 255, 255)] * 4, texture=texture, coverage=coverage))
    alpha = pixels[10:30, 8:20, 3]
    assert np.all(np.abs(alpha - coverage[4:24, 2:14].astype(int)) <= 1)
    assert np.count_nonzero(pixels[..., 3]) == np.count_nonzero(alpha)


@pytest.mark.parametrize("clip", [(10, 12, 30, 20), (0, 0, 64, 48), (63, 47, 64, 48), (5, 5, 5, 40)])
def test_nothing_is_painted_beyond_the_rectangle_that_may_be(clip: tuple[int, int, int, int]) -> None:
    left, top, right, bottom = clip
    corners = [(-500.0, -400.0), (900.0, -400.0), (900.0, 800.0), (-500.0, 800.0)]
    for order in ([0, 1, 2, 0, 2, 3], [0, 1, 3, 1, 2, 3]):
        pixels = painted(corners, order, [rgba(1, 2, 3)] * 4, clip=clip)
        expected = np.zeros(SIZE, bool)
        expected[top:bottom, left:right] = True
        assert np.array_equal(pixels != 0, expected)


def test_triangles_without_area_and_far_away_paint_nothing() -> None:
    for corners in (
        [(3.0, 3.0), (40.0, 40.0), (21.5, 21.5)], [(5.0, 5.0)] * 3, [(3.0, 8.5), (30.0, 8.5), (20.0, 8.5)],
        [(-90.0, 2.0), (-30.0, 2.0), (-50.0, 30.0)], [(3.0, 1e6), (9.0, 1e6), (5.0, 2e6)],
    ):  # fmt: skip
        assert not painted(corners, [0, 1, 2], [rgba(1, 2, 3)] * 3).any()


def test_later_triangles_lie_over_earlier_ones() -> None:
    corners = [(0.0, 0.0), (60.0, 0.0), (0.0, 40.0)]
    pixels = painted([*corners, *corners], [0, 1, 2, 3, 4, 5], [rgba(9, 9, 9)] * 3 + [rgba(7, 7, 7)] * 3)
    assert set(np.unique(pixels)) == {0, 0xFF070707}


def test_the_reference_of_coverage_is_that_of_fractions() -> None:
    corners = [(2.25, 3.5), (20.0, 3.5), (9.75, 17.0)]
    mask, (xa, ya), (xb, yb), (xc, yc) = covered(corners), *corners
    for row in range(20):
        for column in range(24):
            x, y = (
                Fraction(2 * column + 1, 2) + Fraction(1, 10**6),
                Fraction(2 * row + 1, 2) + Fraction(1, 10**12),
            )
            signs = [
                (Fraction(x1) - Fraction(x0)) * (y - Fraction(y0))
                - (Fraction(y1) - Fraction(y0)) * (x - Fraction(x0))
                for x0, y0, x1, y1 in ((xa, ya, xb, yb), (xb, yb, xc, yc), (xc, yc, xa, ya))
            ]
            assert mask[row, column] == all(sign > 0 for sign in signs)
