"""The microscope: one impact large, in words, and by the law of impact with the numbers put in."""

from functools import partial

from imgui_bundle import ImVec2, imgui

from physicslab.diagnostics.collision import Collision
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.controls import impact_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.impacts import FRAMES
from physicslab.view.window.window import Action, Window
from physicslab.view.workbench.collision_drawing import draw_bodies, draw_contact, draw_energies, draw_momenta
from physicslab.view.workbench.collision_words import AGREES, Step, body_name, law_steps, story
from physicslab.world import World

_PICTURE, _WORDS = 24.0, 29.0
"""Widths of the drawings and of the words beside them, in heights of the text."""
_TALL, _LOW = 38.0, 13.0
"""Height of both where there is room, and height of the bodies' drawing."""
_SMALL = 8.6
"""Height of the drawings below that."""
_SHARE = 0.94
"""How much of the window it may take."""
_RESTING = 1e-4
"""Speed of approach [m/s] up to which rigid contacts may take a point for resting."""
_FLAT = 0.6
"""Height of a drawing as a share of its width, at most."""


def build_microscope(ui: Ui, world: World, window: Window) -> None:
    """Build it in a window of its own."""
    wide, high, beside = _room(ui, window)
    left, top, across, _ = window.room()
    place = left + 0.5 * across, top + 0.5 * (high + 9.0 * ui.size)
    with ui.floating("Collision microscope", place, window.closing_of("microscope.record"), docks=True):
        _build_head(ui, world, window, wide)
        if imgui.is_window_docked():
            free = imgui.get_content_region_avail()
            wide, high = free.x, max(free.y, 6.0 * ui.size)
            beside = wide >= (_PICTURE + _WORDS) * ui.size
        drawn = _PICTURE * ui.size if beside else wide - 1.2 * ui.size
        with ui.child("drawings", ImVec2(_PICTURE * ui.size if beside else wide, high)) as is_seen:
            if is_seen:
                _build_drawings(ui, world, window, drawn - 0.8 * ui.size)
                if not beside:
                    _build_words(ui, world, window)
        if beside:
            imgui.same_line()
            with ui.child("words", ImVec2(wide - _PICTURE * ui.size - ui.size, high)) as is_seen:
                if is_seen:
                    _build_words(ui, world, window)


def _room(ui: Ui, window: Window) -> tuple[float, float, bool]:
    """Return the width and height of what is below the head [px], and whether words are beside drawings."""
    width = window.canvas.size[0]
    across = window.room()[2] - 2.5 * ui.size
    beside = across >= (_PICTURE + _WORDS) * ui.size
    wide = (_PICTURE + _WORDS) * ui.size if beside else min(max(across, 0.6 * width), _WORDS * ui.size)
    high = min(_TALL * ui.size, _SHARE * window.room()[3] - 9.5 * ui.size)
    return min(wide, _SHARE * width - 2.0 * ui.size), max(high, 8.0 * ui.size), beside


def _build_head(ui: Ui, world: World, window: Window, wide: float) -> None:
    """Build when and what it was, what can be done from there, and the observers."""
    microscope, collision = window.microscope, window.microscope.collision
    a, b = _names(world, collision)
    pair = f"mu = {collision.friction:.4g}, e = {collision.restitution:.4g}"
    with ui.wrapping(wide):
        ui.text(f"At {collision.time:.6f} s   ·   A: {a}   ·   B: {b}   ·   {pair}")
    end = imgui.get_cursor_pos_x() + wide
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
    for n, (frame, tip) in enumerate(FRAMES.items()):
        label = f"Seen by: {frame}"
        if n:
            ui.same_line_if_room(frame, end)
        if ui.button(label, f"Velocities, momenta and energies as an observer finds them. {tip}",
                     shown=frame, on=microscope.frame == frame):  # fmt: skip
            microscope.frame = frame
    imgui.same_line()
    ui.faint("observer", wrapped=False)


def _names(world: World, seen: Collision) -> tuple[str, str]:
    return body_name(world, seen.a.entity, seen.wall), body_name(world, seen.b.entity, seen.wall)


def _build_drawings(ui: Ui, world: World, window: Window, wide: float) -> None:
    seen = window.microscope.seen
    draw_bodies(ui, world, seen, (wide, min(_LOW * ui.size, _FLAT * wide)))
    ui.faint("Thin and dashed: before. Thick: after (with ').")
    half, gap = 0.5 * (wide - ui.size), ui.size
    high = min(_SMALL * ui.size, half)
    ui.faint("B against A at the contact", wrapped=False)
    imgui.same_line(half + gap)
    both = seen.a.is_free and seen.b.is_free
    ui.faint("Momenta, tip to tail" if both else "Momentum and impulse", wrapped=False)
    draw_contact(ui, seen, (half, high))
    imgui.same_line(0.0, gap)
    draw_momenta(ui, seen, (half, high))
    ui.faint("Kinetic energy", wrapped=False)
    draw_energies(ui, seen, wide)


def _build_words(ui: Ui, world: World, window: Window) -> None:
    """Build what happened in words, the velocities, and the law with its numbers."""
    microscope = window.microscope
    collision, result = microscope.collision, microscope.result
    for sentence in story(collision, result, _names(world, collision)):
        ui.text(sentence, wrapped=True)
    ui.gap(0.3)
    _build_velocities(ui, microscope.seen)
    _build_momentum(ui, microscope.seen)
    ui.gap(0.3)
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
    """Write the momenta of both together before and after, or the impulse on the one that is free."""
    before, after = (
        seen.a.momentum(a) + seen.b.momentum(b)
        for a, b in ((seen.a.before, seen.b.before), (seen.a.after, seen.b.after))
    )
    scale = max(body.momentum(m).magnitude for body in (seen.a, seen.b) for m in (body.before, body.after))
    ui.row("Momentum before", _vector(before, scale), "The sum over the bodies that impulses move")
    ui.row("Momentum after", _vector(after, scale))
    if not (seen.a.is_free and seen.b.is_free):
        tip = "Given by the other one, which no impulse moves"
        ui.row("Impulse on it", quantity(seen.impulse.magnitude, "N s"), tip)


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
