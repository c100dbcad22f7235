"""Where bodies touch: every pair of shapes, either way round."""

from __future__ import annotations

import copy
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.report import Contact, contact_between
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.world import World


def touch(
    first: tuple[Shape, tuple[float, float], float],
    second: tuple[Shape, tuple[float, float], float],
    *,
    reverse: bool = False,
) -> Contact | None:
    """Return the contact of two bodies, asked for as (first, second), spawned in either order."""
    world = World(BroadPhaseSystem(), ContactSystem())
    made: dict[int, int] = {}
    for k in (1, 0) if reverse else (0, 1):
        shape, place, angle = (first, second)[k]
        made[k] = world.spawn(
            Transform(place, angle), copy.copy(shape), Velocity(), Mass(1), Material(0.4, 0.25)
        )
    world.step(1e-6)
    return contact_between(world, made[0], made[1])


def circle(x: float, y: float, radius: float) -> tuple[Shape, tuple[float, float], float]:
    return Shape.circle(radius), (x, y), 0.0


def box(
    x: float, y: float, w: float, h: float, angle: float = 0.0
) -> tuple[Shape, tuple[float, float], float]:
    return Shape.box(w, h), (x, y), angle


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(
    ("first", "second", "normal", "depth", "points"),
    [
        (circle(0, 0, 1), circle(1.5, 0, 1), (1, 0), 0.5, 1),
        (circle(0, 0, 1), circle(0, -1.8, 1), (0, -1), 0.2, 1),
        (circle(0, 0, 1), box(1.9, 0, 2, 2), (1, 0), 0.1, 1),
        (box(0, 0, 2, 2), circle(0, 1.9, 1), (0, 1), 0.1, 1),
        (box(0, 0, 2, 2), circle(1 + 0.6, 1 + 0.8, 1.1), (0.6, 0.8), 0.1, 1),  # at a corner
        (box(0, 0, 2, 2), circle(0.9, 0.1, 0.5), (1, 0), 0.6, 1),  # centre inside
        (box(0, 0, 2, 2), box(1.9, 0.3, 2, 2), (1, 0), 0.1, 2),
        (box(0, 0, 2, 2), box(0.3, -1.95, 2, 2), (0, -1), 0.05, 2),
        (box(0, 0, 2, 2), box(1 + math.sqrt(2) - 0.05, 0, 2, 2, math.pi / 4), (1, 0), 0.05, 1),
        (box(0, 0, 4, 2, math.pi / 2), box(1.9, 0, 2, 2), (1, 0), 0.1, 2),
    ],
)
def test_normal_leads_from_a_to_b_and_depth_is_positive(
    first: tuple[Shape, tuple[float, float], float],
    second: tuple[Shape, tuple[float, float], float],
    normal: tuple[float, float],
    depth: float,
    points: int,
    reverse: bool,
) -> None:
    contact = touch(first, second, reverse=reverse)
    assert contact is not None
    assert tuple(contact.normal) == pytest.approx(normal, abs=1e-9)
    assert contact.depth == pytest.approx(depth, abs=1e-9)
    assert sum(point.separation < 0 for point in contact.points) == points
    assert (contact.restitution, contact.friction) == (0.4, 0.25)
    swapped = touch(second, first, reverse=reverse)
    assert swapped is not None
    assert tuple(swapped.normal) == pytest.approx((-normal[0], -normal[1]), abs=1e-9)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (circle(0, 0, 1), circle(2.2, 0, 1)),
        (box(0, 0, 2, 2), circle(1.8, 1.8, 1)),  # the boxes around them overlap
        (box(0, 0, 2, 2, math.pi / 4), box(1.6, 1.6, 2, 2, math.pi / 4)),
    ],
)
def test_bodies_apart_do_not_touch(
    first: tuple[Shape, tuple[float, float], float], second: tuple[Shape, tuple[float, float], float]
) -> None:
    assert touch(first, second) is None


def test_coincident_centres_get_a_unit_normal_and_always_the_same() -> None:
    contacts = [touch(circle(0, 0, 1), circle(0, 0, 1)) for _ in range(2)]
    assert contacts[0] == contacts[1]
    assert contacts[0] is not None
    assert contacts[0].normal.magnitude == pytest.approx(1.0)
    assert contacts[0].depth == pytest.approx(2.0)


def test_a_pair_uses_the_lesser_restitution_and_the_geometric_mean_of_friction() -> None:
    world = World(BroadPhaseSystem(), ContactSystem())
    a = world.spawn(Transform(), Shape.circle(1), Velocity(), Mass(1), Material(0.9, 0.2))
    b = world.spawn(Transform((1.9, 0)), Shape.circle(1), Velocity(), Mass(1), Material(0.3, 0.8))
    world.step(1e-6)
    contact = contact_between(world, a, b)
    assert contact is not None
    assert contact.restitution == 0.3
    assert contact.friction == pytest.approx(0.4)


def test_bounds_touch_with_an_inward_normal() -> None:
    world = World(BroadPhaseSystem(), ContactSystem(), physics=PhysicsConfig(bounds=(-5, -5, 5, 5)))
    ball = world.spawn(Transform((4.6, 0)), Shape.circle(0.5), Velocity(), Mass(1), Material())
    crate = world.spawn(Transform((0, -4.55)), Shape.box(1, 1), Velocity(), Mass(1), Material())
    world.step(1e-6)
    wall, floor = contact_between(world, 0, ball), contact_between(world, 0, crate)
    assert wall is not None and floor is not None
    assert (wall.normal, floor.normal, len(floor.points)) == (Vector2(-1, 0), Vector2(0, 1), 2)
    assert (wall.depth, floor.depth) == pytest.approx((0.1, 0.05))
    assert contact_between(world, ball, ball) is None and contact_between(world, ball, crate) is None


angles = st.floats(-math.pi, math.pi)


@given(st.floats(0.3, 2), st.floats(0.3, 2), angles, angles, angles, st.floats(0.0, 0.2))
def test_box_contacts_turn_with_the_scene(
    width: float, height: float, angle_a: float, angle_b: float, turn: float, gap: float
) -> None:
    """Turning both bodies about A's centre turns normal and points, and leaves the depth as it is."""
    apart = Vector2.from_angle(0.3, 0.5 * (width + height) - gap)
    plain = touch(box(0, 0, width, 1, angle_a), box(apart.x, apart.y, 1, height, angle_b))
    turned_place = apart.rotated(turn)
    turned = touch(
        box(0, 0, width, 1, angle_a + turn), box(turned_place.x, turned_place.y, 1, height, angle_b + turn)
    )
    assume(plain is not None and turned is not None and len(plain.points) == len(turned.points))
    assert plain is not None and turned is not None
    if (plain.normal.rotated(turn) - turned.normal).magnitude < 1e-6:  # two axes may be equally good
        assert turned.depth == pytest.approx(plain.depth, abs=1e-9)


@given(st.floats(0.2, 1.0), st.floats(0.2, 1.0), angles, st.floats(-0.1, 0.05))
def test_circle_depth_is_the_distance_of_the_surfaces(
    ra: float, rb: float, direction: float, gap: float
) -> None:
    assume(gap < 0.015 * min(ra, rb))
    away = Vector2.from_angle(direction, ra + rb + gap)
    contact = touch(circle(0, 0, ra), circle(away.x, away.y, rb))
    assert contact is not None
    assert contact.depth == pytest.approx(-gap, abs=1e-9)
    assert (contact.normal - away.normalized).magnitude < 1e-9
