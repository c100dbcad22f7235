"""Drawings of one impact: both bodies, B against A, momenta tip to tail, and where the energy went."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from physicslab.components import Shape
from physicslab.diagnostics.collision import Body, Collision
from physicslab.ecs.vector import Vector2
from physicslab.theme import Colour, Theme, contrast, mixed
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.canvas.rim import rim_of
from physicslab.view.picture.bodies import named_colour
from physicslab.view.toolkit.paper import Paper, Place, drawn_on
from physicslab.view.toolkit.ui import Ui
from physicslab.world import World

type Projection = Callable[[Vector2], Place]
"""The map from places or momenta to a drawing."""

_REACH = 0.36
"""Length of the longest arrow of the bodies, as a share of the smaller side of the drawing."""
_BIGGEST = 1.6
"""How much of a large body is in sight, in sizes of the smaller one."""
_ROOM = 1.08
_ALIKE = 0.05
"""How far arrows may point away from one line, and be drawn beside each other."""
_TINT = 0.5
"""Share of its own colour in a tint."""
_FILL = 0.3
"""Share of its colour in the inside of a body: arrows of the same colour and words are seen on it."""
_SHORT = 2.0
"""Arrows shorter than that are not drawn [px]."""


def colours_of(world: World, theme: Theme, seen: Collision) -> tuple[Colour, Colour]:
    """Return the colours of A and of B: their own in the world; of two alike B has a tint of it."""
    bodies = seen.a, seen.b
    a, b = (named_colour(world, theme, one.entity) if one.is_free else theme.static for one in bodies)
    return a, mixed(theme.text, b, _TINT) if a == b else b


# ---- both bodies -------------------------------------------------------------------------------------------


def draw_bodies(ui: Ui, world: World, seen: Collision, size: tuple[float, float]) -> None:
    """Draw both where they were at the moment, with their velocities before (thin) and after (thick)."""
    theme, (width, height) = ui.theme, size
    middle = sum((spot.place for spot in seen.spots), Vector2()) / len(seen.spots)
    radii = [_extent(world, body, seen) for body in (seen.a, seen.b)]
    small = min(radii)
    scale = 0.5 * min(width, height) / (_ROOM * (small + min(max(radii), _BIGGEST * small)))

    def at(place: Vector2) -> Place:
        return Vector2(0.5 * width, 0.5 * height) + scale * _down(place - middle)

    speeds = [m.linear.magnitude for body in (seen.a, seen.b) for m in (body.before, body.after)]
    per_speed = _REACH * min(width, height) / max(*speeds, 1e-300)
    with drawn_on(ui, width, height) as paper:
        for body, colour in zip((seen.a, seen.b), colours_of(world, theme, seen), strict=True):
            _draw_body(paper, world, body, seen, at, scale, colour)
        _draw_axes(paper, seen, at(middle))
        for spot in seen.spots:
            paper.disc(at(spot.place), 4.0, theme.contact_normal, theme.background)
        for name, body, colour in zip("AB", (seen.a, seen.b), colours_of(world, theme, seen), strict=True):
            start = at(body.centre)
            for motion, mark, before in ((body.before, "", True), (body.after, "'", False)):
                way = per_speed * _down(motion.linear)
                if way.magnitude < _SHORT:
                    continue
                end = start + way
                paper.arrow(start, end, colour, before=before)
                paper.words(_beyond(start, end, ui.size), f"v{name}{mark}", theme.text)
            if not (0.0 < start.x < width and 0.0 < start.y < height) or body.entity == 0:
                side = -4.0 if name == "A" else 4.0
                start = at(middle) + side * ui.size * _down(seen.normal)
            paper.words(start + Vector2(0.0, 0.9 * ui.size), name, theme.heading)


def _down(way: Vector2) -> Vector2:
    """Return a way of the world as one of a drawing, whose y points down."""
    return Vector2(way.x, -way.y)


def _extent(world: World, body: Body, seen: Collision) -> float:
    """Return how far a body reaches from its centre [m]."""
    shape = world.component(body.entity, Shape) if body.entity and world.has(body.entity, Shape) else None
    if shape is None:
        arms = [spot.arm_a if body is seen.a else spot.arm_b for spot in seen.spots]
        return math.inf if body.entity == 0 else max(*(arm.magnitude for arm in arms), 1e-9)
    return shape.reach


def _draw_body(
    paper: Paper, world: World, body: Body, seen: Collision, at: Projection, scale: float, colour: Colour
) -> None:
    fill = mixed(paper.ui.theme.background, colour, _FILL)
    shape = world.component(body.entity, Shape) if body.entity and world.has(body.entity, Shape) else None
    if shape is None and body.entity == 0:
        n, t = (_down(way) * (paper.width + paper.height) for way in (seen.normal, seen.tangent))
        touch = at(seen.spots[0].place)
        corners = [touch + s * t - d * n for s, d in ((-1, 0), (1, 0), (1, 1), (-1, 1))]
        paper.polygon(corners, fill, colour)
    elif shape is not None and len(shape.core) == 1:
        paper.disc(at(body.centre), scale * shape.radius, fill, colour)
        rim = body.centre + shape.radius * Vector2.from_angle(body.angle)
        paper.line(at(body.centre), at(rim), colour)
    elif shape is not None:
        outline = rim_of(np.array([tuple(corner) for corner in shape.core]), shape.rounding).tolist()
        corners = [at(body.centre + Vector2(x, y).rotated(body.angle)) for x, y in outline]
        paper.polygon(corners, fill, colour)
    if body.entity:
        paper.disc(at(body.centre), 2.5, colour, colour)


def _draw_axes(paper: Paper, seen: Collision, origin: Place) -> None:
    """Draw the directions of normal and tangent at the contact."""
    theme, length = paper.ui.theme, 4.4 * paper.ui.size
    for way, name in ((seen.normal, "n"), (seen.tangent, "t")):
        end = origin + length * _down(way)
        paper.axes.append((2.0 * origin - end, end))
        paper.line(*paper.axes[-1], theme.faint, dashed=True)
        paper.words(_beyond(origin, end, 0.6 * paper.ui.size), name, theme.contact_normal)


def _beyond(start: Place, end: Place, by: float) -> Place:
    """Return a place beyond the tip of an arrow."""
    way = end - start
    return end + by / max(way.magnitude, 1e-9) * way


# ---- velocities at the contact, and momenta ----------------------------------------------------------------


def draw_contact(ui: Ui, world: World, seen: Collision, size: tuple[float, float]) -> None:
    """Draw how B moves against A at the contact, split along n (upwards) and t (to the left)."""
    theme, (width, height) = ui.theme, size
    spot = max(seen.spots, key=lambda one: one.normal_impulse)
    speeds = seen.approach(spot), seen.approach(spot, after=True)
    largest = max(max(map(abs, pair)) for pair in speeds) or 1.0
    scale = 0.36 * min(width, height) / largest
    with drawn_on(ui, width, height) as paper:
        origin, across, up = Vector2(0.5 * width, 0.5 * height), Vector2(width, 0.0), Vector2(0.0, height)
        paper.line(origin - 0.5 * across, origin + 0.5 * across, theme.axis)
        paper.line(origin - 0.5 * up, origin + 0.5 * up, theme.axis)
        paper.words(origin - 0.5 * up, "n", theme.contact_normal)
        paper.words(origin - 0.5 * across - Vector2(0.0, 0.6 * ui.size), "t", theme.contact_normal)
        for (vn, vt), words, before in zip(speeds, ("before", "after"), (True, False), strict=True):
            end = origin - scale * Vector2(vt, vn)
            for foot in (Vector2(end.x, origin.y), Vector2(origin.x, end.y)):
                paper.line(end, foot, theme.faint, dashed=True)
            paper.arrow(origin, end, theme.velocity, before=before)
            paper.words(_beyond(origin, end, 0.8 * ui.size), words, theme.text)


type _Chain = tuple[list[Vector2], tuple[str, ...], tuple[Colour, ...], bool]
"""Momenta put tip to tail, their names and colours, and whether they are those before."""


def draw_momenta(ui: Ui, world: World, seen: Collision, size: tuple[float, float]) -> None:
    """Draw momenta tip to tail: the sum of both is the same arrow before and after.

    If impulses do not move one of them, the momentum of the other changes by the impulse.
    """
    theme, (a_colour, b_colour) = ui.theme, colours_of(world, ui.theme, seen)
    before, after = ([b.momentum(m) for b, m in zip((seen.a, seen.b), ms, strict=True)]
                     for ms in ((seen.a.before, seen.b.before), (seen.a.after, seen.b.after)))  # fmt: skip
    if seen.a.is_free and seen.b.is_free:
        chains: list[_Chain] = [
            (before, ("pA", "pB"), (a_colour, b_colour), True),
            (after, ("pA'", "pB'"), (a_colour, b_colour), False),
        ]
    else:
        free, colour, name, sign = (1, b_colour, "B", 1.0) if seen.b.is_free else (0, a_colour, "A", -1.0)
        chains = [
            ([before[free], sign * seen.impulse], (f"p{name}", "J"), (colour, theme.normal_impulse), True),
            ([after[free]], (f"p{name}'",), (colour,), False),
        ]
    with drawn_on(ui, *size) as paper:
        at = _fitted([part for chain in chains for part in _tips(chain[0])], size, 1.6 * ui.size)
        aside, drawn = _aside([part for chain in chains for part in chain[0]], 0.7 * ui.size), 0
        for parts, names, colours, thin in chains:
            places = [at(tip) for tip in _tips(parts)]
            for start, end, name, colour in zip(places, places[1:], names, colours, strict=False):
                if (end - start).magnitude < _SHORT:
                    continue
                start, end = start + drawn * aside, end + drawn * aside
                drawn += 1
                paper.arrow(start, end, colour, before=thin)
                side = 0.9 if thin != bool(aside) else -0.9
                paper.words(_beside(start, end, side * ui.size), name, theme.text)
        if len(chains[1][0]) == 2:
            start, end = at(Vector2()), at(sum(before, Vector2()))
            paper.disc(start, 3.0, theme.heading, theme.heading)
            paper.disc(end, 5.0, theme.background, theme.heading, 1.5)
            paper.words(start + Vector2(0.0, 0.9 * ui.size), "start", theme.faint)
            paper.words(end + Vector2(0.0, 0.9 * ui.size), "sum", theme.faint)


def _aside(parts: Sequence[Vector2], by: float) -> Place:
    """Return by how much each arrow is drawn beside the one before [px]: where all lie in one line."""
    longest = max(parts, key=lambda part: part.magnitude)
    if not longest or any(abs(part.cross(longest)) > _ALIKE * longest.magnitude_squared for part in parts):
        return Vector2()
    return by * _down(longest.normalized.perpendicular)


def _tips(parts: Sequence[Vector2]) -> list[Vector2]:
    """Return where arrows begin and end that are put tip to tail, from the origin on."""
    tips = [Vector2()]
    for part in parts:
        tips.append(tips[-1] + part)
    return tips


def _fitted(places: Sequence[Vector2], size: tuple[float, float], margin: float) -> Projection:
    """Return what maps places into a drawing, all of them in sight."""
    xs, ys = [place.x for place in places], [place.y for place in places]
    spans = max(xs) - min(xs), max(ys) - min(ys)
    scale = min(
        max(side - 2.0 * margin, 1.0) / span if span > 0.0 else math.inf
        for side, span in zip(size, spans, strict=True)
    )
    scale = 0.0 if math.isinf(scale) else scale
    middle = Vector2(0.5 * (max(xs) + min(xs)), 0.5 * (max(ys) + min(ys)))
    return lambda place: 0.5 * Vector2(*size) + scale * _down(place - middle)


def _beside(start: Place, end: Place, by: float) -> Place:
    """Return a place beside the middle of an arrow."""
    way = end - start
    return 0.5 * (start + end) + by / max(way.magnitude, 1e-9) * Vector2(way.y, -way.x)


# ---- energy ------------------------------------------------------------------------------------------------


def draw_energies(ui: Ui, world: World, seen: Collision, width: float) -> None:
    """Draw the kinetic energies before and after as bars, with what was lost and to what, and write them."""
    theme = ui.theme
    a_colour, b_colour = colours_of(world, theme, seen)
    parts = []
    for a, b in ((seen.a.before, seen.b.before), (seen.a.after, seen.b.after)):
        (a_along, a_turn), (b_along, b_turn) = seen.a.energies(a), seen.b.energies(b)
        parts.append(
            [
                ("A moves|A", a_along, a_colour, False), ("A turns|A ω", a_turn, theme.fill(a_colour), False),
                ("B moves|B", b_along, b_colour, False), ("B turns|B ω", b_turn, theme.fill(b_colour), False),
            ]
        )  # fmt: skip
    bounced, friction = seen.lost
    parts[1] += [
        ("lost in the bounce|lost", bounced, theme.error, True),
        ("lost to friction|friction", friction, theme.paused, True),
    ]
    full = max(sum(max(part[1], 0.0) for part in bar) for bar in parts) or 1.0
    totals = [sum(part[1] for part in bar[:4]) for bar in parts]
    label, high = 7.6 * ui.size, 1.3 * ui.size
    with drawn_on(ui, width, 2.0 * high + 1.2 * ui.size) as paper:
        for n, (when, bar) in enumerate(zip(("before", "after"), parts, strict=True)):
            words = f"{when} {quantity(totals[n], 'J')}"
            top = 0.4 * ui.size + n * (high + 0.4 * ui.size)
            paper.words(Vector2(0.5 * label, top + 0.5 * high), words, theme.text)
            x = label + 0.4 * ui.size
            across = (width - x - 0.4 * ui.size) / full
            for name, energy, colour, hatched in bar:
                if energy * across < 1.0:
                    continue
                end = x + energy * across
                paper.bar(Vector2(x, top), Vector2(end - 1.0, top + high), colour, hatched=hatched)
                on = theme.background if hatched else colour
                _label_bar(paper, name, (x, end), top + 0.5 * high, on)
                x = end


def _label_bar(paper: Paper, name: str, span: tuple[float, float], middle: float, on: Colour) -> None:
    """Write what a part of a bar is on its colour, in the longest of its names for which there is room."""
    per_letter, theme = 0.56 * paper.ui.size, paper.ui.theme
    colour = max((theme.text, theme.background), key=lambda one: contrast(one, on))
    for words in name.split("|"):
        if len(words) * per_letter < span[1] - span[0]:
            paper.words(Vector2(0.5 * sum(span), middle), words, colour, on)
            return


def build_losses(ui: Ui, seen: Collision) -> None:
    """Write what was lost and to what; rounding beside the energy before is treated as zero."""
    full = sum(sum(body.energies(body.before)) for body in (seen.a, seen.b))
    bounced, friction = (without_rounding(part, full) for part in seen.lost)
    ui.row("Lost in the bounce", quantity(bounced, "J"), "Taken by the normal impulse: restitution")
    ui.row("Lost to friction", quantity(friction, "J"), "Taken by the friction impulse")
    driven = without_rounding(seen.driven, full)
    if driven:
        tip = "A body that no impulse moves, but that moves for this observer, does work on the other"
        ui.row("Given by the body that no impulse moves", quantity(driven, "J"), tip)
