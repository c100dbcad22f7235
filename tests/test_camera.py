"""Camera: metres to pixels and back."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera

places = st.builds(Vector2, st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))
pixels = st.tuples(st.floats(0.0, 1280.0), st.floats(0.0, 720.0))
cameras = st.builds(
    lambda centre, power: Camera((1280, 720), centre=centre, scale=10.0**power), places, st.floats(-1.0, 3.0)
)


def test_default_view_is_100_px_per_metre_with_y_up() -> None:
    camera = Camera((1280, 720))
    assert camera.to_screen(Vector2(0, 0)) == (640.0, 360.0)
    assert camera.to_screen(Vector2(1, 1)) == (740.0, 260.0)
    assert camera.visible == (-6.4, -3.6, 6.4, 3.6)


@given(cameras, places)
def test_a_point_is_found_again_under_its_pixel(camera: Camera, place: Vector2) -> None:
    back = camera.to_world(camera.to_screen(place))
    assert (back - place).magnitude < 1e-10


@given(cameras, st.lists(places, min_size=1, max_size=5))
def test_many_points_project_like_one(camera: Camera, points: list[Vector2]) -> None:
    projected = camera.project(np.array([tuple(point) for point in points]))
    assert np.allclose(projected, [camera.to_screen(point) for point in points], rtol=0, atol=1e-8)


@given(cameras, pixels, st.floats(0.5, 2.0))
def test_zoom_leaves_what_is_under_the_cursor(
    camera: Camera, pixel: tuple[float, float], factor: float
) -> None:
    before, scale = camera.to_world(pixel), camera.scale
    camera.zoom(factor, pixel)
    assert (camera.to_world(pixel) - before).magnitude < 1e-9
    assert camera.scale == pytest.approx(scale * factor)


@given(cameras, pixels, st.floats(-300.0, 300.0), st.floats(-300.0, 300.0))
def test_pan_moves_the_picture_with_the_cursor(
    camera: Camera, pixel: tuple[float, float], dx: float, dy: float
) -> None:
    under = camera.to_world(pixel)
    camera.pan(dx, dy)
    moved = camera.to_screen(under)
    assert math.dist(moved, (pixel[0] + dx, pixel[1] + dy)) < 1e-6


def test_resize_keeps_middle_and_scale() -> None:
    camera = Camera((1280, 720), centre=Vector2(3, 4), scale=50.0)
    camera.resize((800, 600))
    assert camera.to_screen(Vector2(3, 4)) == (400.0, 300.0)
    assert camera.scale == 50.0


@pytest.mark.parametrize("extent", [(0.0, 0.0, 10.0, 1.0), (-1.0, -30.0, 1.0, 5.0), (2.0, 2.0, 2.0, 3.0)])
def test_fitting_scale_shows_all_of_it(extent: tuple[float, float, float, float]) -> None:
    camera = Camera((1280, 720))
    camera.look_at(extent, camera.fitting_scale(extent))
    xmin, ymin, xmax, ymax = camera.visible
    assert xmin < extent[0] and ymin < extent[1] and xmax > extent[2] and ymax > extent[3]
    share = max((extent[2] - extent[0]) / (xmax - xmin), (extent[3] - extent[1]) / (ymax - ymin))
    assert share == pytest.approx(0.86)


def test_zoom_stops_before_floats_do() -> None:
    camera = Camera((1280, 720))
    for _ in range(2000):
        camera.zoom(0.5, (3.0, 4.0))
    assert camera.scale > 0.0 and all(map(math.isfinite, camera.centre))
    for _ in range(4000):
        camera.zoom(2.0, (3.0, 4.0))
    assert math.isfinite(camera.scale) and all(map(math.isfinite, camera.centre))
