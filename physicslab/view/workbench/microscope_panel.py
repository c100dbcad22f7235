"""The microscope: one impact large, in words, and by the law of impact with the numbers put in."""

from collections.abc import Sequence
from functools import partial

from imgui_bundle import ImVec2, imgui

from physicslab.diagnostics.collision import Collision
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.controls import impact_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.impacts import FRAMES
from physicslab.view.window.window import Action, Window
from physicslab.view.workbench import collision_drawing
from physicslab.view.workbench.collision_words import AGREES, Step, body_name, law_steps, story
from physicslab.world import World

_WIDE, _TALL, _LOW = 27.0, 36.0, 12.0
"""Width and height where it lies over the world, height of the bodies' drawing, in heights of the text."""
_FIRST = 2
"""Sentences that come first."""
_SMALL = 8.6
"""Height of the drawings below that."""
_RESTING = 1e-4
"""Speed of approach [m/s] up to which rigid contacts may take a point for resting."""
_FROM_ELSEWHERE = 1e-9
"""Share of the largest momentum above which a sum that is not kept is no rounding."""
_FLAT = 0.6
"""Height of a drawing as a share of its width, at most."""


def build_microscope(ui: Ui, world: World, window: Window) -> None:
    """Build it in a window of its own: what happened, both bodies, momenta, energies, and the rest below."""
    ui.stand_beside("Collision microscope", "right", 0.5, 26.0)
    middle, close = window.framing.middle, window.closing_of("microscope.record")
    with ui.floating("Collision microscope", middle, close, docks=True):
        ui.raise_tab(window.microscope.number)
        size = ui.extent(_WIDE * ui.size, _TALL * ui.size)
        with ui.child("impact", ImVec2(size.x, max(size.y, 8.0 * ui.size))) as is_seen:
            if is_seen:
                _build(ui, world, window, imgui.get_content_region_avail().x)


def _build(ui: Ui, world: World, window: Window, wide: float) -> None:
    microscope = window.microscope
    collision, seen = microscope.collision, microscope.seen
    told = story(collision, microscope.result, _names(world, collision))
    _build_head(ui, window, imgui.get_cursor_pos_x() + wide)
    for sentence in told[:_FIRST]:
        ui.text(sentence, wrapped=True)
    _build_momentum(ui, seen)
    collision_drawing.build_losses(ui, seen)
    ui.gap(0.3)
    collision_drawing.draw_bodies(ui, world, seen, (wide, min(_LOW * ui.size, _FLAT * wide)))
    ui.faint("Thin and dashed: before. Thick: after (with ').")
    ui.faint("Kinetic energy", wrapped=False)
    collision_drawing.draw_energies(ui, world, seen, wide)
    ui.gap(0.3)
    more = window.level == "Engineer" if microscope.shows_more is None else microscope.shows_more
    if ui.button("More", "Other observers, turning, friction, and the law with its numbers", on=more):
        microscope.shows_more = more = not more
    if more:
        _build_more(ui, world, window, told[_FIRST:], wide)


def _build_head(ui: Ui, window: Window, end: float) -> None:
    """Build when it was, and what can be done from there; ``end`` is the right edge [px]."""
    microscope = window.microscope
    ui.faint(f"At {microscope.collision.time:.6f} s", wrapped=False)
    buttons: tuple[tuple[str, str, Action, bool], ...] = (
        ("Earlier", "The impact before this one; time goes back to it",
         partial(impact_actions.go_beside, by=-1), False),
        ("Later", "The impact after this one", partial(impact_actions.go_beside, by=1), False),
        ("Slowly through it", "Go to shortly before it, and run slowly through it (Shift+Tab)",
         impact_actions.run_slowly, microscope.slow is not None),
        ("Pause at the next impact", "Run until the next impact of the selection, or of any body (Shift+Z)",
         impact_actions.pause_at_next, microscope.waits_for is not None),
        ("All impacts", "The table of impacts (Z)",
         lambda _, window: window.put("impacts.shown", not window.impacts.shown), window.impacts.shown),
    )  # fmt: skip
    for n, (label, tip, action, on) in enumerate(buttons):
        if n:
            ui.same_line_if_room(label, end)
        ui.button(label, tip, action, on=on)


def _build_more(ui: Ui, world: World, window: Window, told: Sequence[str], wide: float) -> None:
    """Build the observers, the rest of the words and drawings, and the law."""
    microscope = window.microscope
    seen, end = microscope.seen, imgui.get_cursor_pos_x() + wide
    ui.faint("Seen by", wrapped=False)
    for frame, tip in FRAMES.items():
        ui.same_line_if_room(frame, end)
        tip = f"Velocities, momenta and energies as an observer finds them. {tip}"
        if ui.button(f"Seen by: {frame}", tip, shown=frame, on=microscope.frame == frame):
            microscope.frame = frame
    collision = microscope.collision
    ui.row("Friction and restitution", f"μ = {collision.friction:.4g}, e = {collision.restitution:.4g}")
    for sentence in told:
        ui.text(sentence, wrapped=True)
    _build_velocities(ui, seen)
    ui.gap(0.3)
    half, gap = 0.5 * (wide - ui.size), ui.size
    high, left = min(_SMALL * ui.size, half), imgui.get_cursor_pos_x()
    ui.faint("B against A", wrapped=False)
    imgui.same_line(left + half + gap)
    both = seen.a.is_free and seen.b.is_free
    ui.faint("Momenta, tip to tail" if both else "Momentum and impulse", wrapped=False)
    collision_drawing.draw_contact(ui, world, seen, (half, high))
    imgui.same_line(0.0, gap)
    collision_drawing.draw_momenta(ui, world, seen, (half, high))
    ui.gap(0.3)
    _build_law(ui, window)


def _names(world: World, seen: Collision) -> tuple[str, str]:
    return body_name(world, seen.a.entity, seen.wall), body_name(world, seen.b.entity, seen.wall)


def _build_law(ui: Ui, window: Window) -> None:
    """Build the law with its numbers, beside the result of the solver."""
    microscope = window.microscope
    collision, result = microscope.collision, microscope.result
    shown = window.level == "Engineer" if microscope.shows_formula is None else microscope.shows_formula
    if ui.button(
        "The law with its numbers", "The formula line by line, beside the result of the solver", on=shown
    ):
        microscope.shows_formula = shown = not shown
    if not shown:
        return
    steps = law_steps(collision, result)
    slowest = min(-collision.approach(spot)[0] for spot in collision.spots)
    _build_verdict(ui, steps, is_alone=collision.alone, is_slow=slowest < _RESTING)
    for step in steps:
        _build_step(ui, step)


def _build_velocities(ui: Ui, seen: Collision) -> None:
    """Build a table of the velocities of both, split along n and t."""
    speed, turning = seen.speed_scale, seen.turning_scale
    rows = [
        (
            f"{name} {when}",
            quantity(without_rounding(motion.linear.dot(seen.normal), speed), "m/s"),
            quantity(without_rounding(motion.linear.dot(seen.tangent), speed), "m/s"),
            quantity(without_rounding(motion.angular, turning), "rad/s"),
        )
        for name, body in (("A", seen.a), ("B", seen.b))
        for when, motion in (("before", body.before), ("after", body.after))
    ]
    ui.table("velocities", (("", 5.0), ("along n", 6.6), ("along t", 6.6), ("turning", 7.4)), rows)


def _build_momentum(ui: Ui, seen: Collision) -> None:
    """Write the momenta of both together before and after, and the impulse on the one that is free.

    Joints, and impacts at the same moment, may give either of them momentum too: that has a row of its own.
    """
    before, after = (
        seen.a.momentum(a) + seen.b.momentum(b)
        for a, b in ((seen.a.before, seen.b.before), (seen.a.after, seen.b.after))
    )
    scale = max(body.momentum(m).magnitude for body in (seen.a, seen.b) for m in (body.before, body.after))
    ui.row("Momentum before", _vector(before, scale), "The sum over the bodies that impulses move")
    ui.row("Momentum after", _vector(after, scale))
    rest = after - before
    if not (seen.a.is_free and seen.b.is_free):
        tip = "Given by the other one, which no impulse moves"
        ui.row("Impulse on it", quantity(seen.impulse.magnitude, "N s"), tip)
        rest = rest - seen.impulse if seen.b.is_free else rest + seen.impulse
    if rest.magnitude > _FROM_ELSEWHERE * scale:
        tip = "Joints, or other impacts at the same moment, gave it: momentum is kept with theirs counted"
        ui.row("From joints and others", _vector(rest, scale), tip)


def _vector(value: Vector2, scale: float) -> str:
    x, y = (quantity(without_rounding(part, scale), "").strip() for part in value)
    return f"({x}, {y}) kg m/s"


def _build_verdict(ui: Ui, steps: list[Step], *, is_alone: bool, is_slow: bool) -> None:
    """Write whether the solver did what the law says."""
    worst, theme = max(step.difference for step in steps), ui.theme
    words, colour = f"The solver agrees with the law: they differ by {worst:.1e} at most.", theme.heading
    if worst > AGREES and is_alone:
        words, colour = f"The solver differs from the law by {worst:.1e} of the largest figure.", theme.error
    elif worst > AGREES:
        words = "The solver resolved several impacts together here; this pair by itself would differ."
        colour = theme.paused
    ui.text(words, colour, wrapped=True)
    if colour == theme.error and is_slow:
        ui.faint("An approach as slow as this may be treated as rest, and does not bounce.")


def _build_step(ui: Ui, step: Step) -> None:
    ui.gap(0.2)
    ui.faint(step.words)
    ui.text(step.formula, wrapped=True)
    shown = f"= {step.numbers}" if step.numbers else ""
    if shown:
        ui.text(shown, wrapped=True)
    ui.text(step.value, ui.theme.accent, wrapped=True)
    if step.solver:
        ui.faint(f"solver: {step.solver}, differs by {step.difference:.1e}")
