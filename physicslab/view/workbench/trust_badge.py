"""How many digits can be relied on: a badge in the bar of menus, which opens, and a line of the inspector."""

import math

from imgui_bundle import ImVec2, imgui

from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.trust_watch import RUNS, Finding, TrustWatch
from physicslab.view.window.window import Window
from physicslab.world import World

BADGE = "Digits to trust"
"""By what the badge is found."""
_ASKED = "Digits?"
_OPENED, _INSET = 21.0, 0.35
"""Width of what opens, and how far the badge's frame is from its words, in heights of the text."""
_QUANTITIES = ("Position", "Velocity", "Angle", "Spin")
_FUTURES = ("one of many possible futures", "many futures")
_MEANING = (
    "How many digits agree where this scene is computed in other ways: half the step, another model of "
    "contacts, mirrored, moved by one rounding and more."
)


def badge_width(ui: Ui, world: World, window: Window) -> float:
    """Return how wide the badge is with all its words [px]."""
    return _width(ui, _words(window.trust, world.time)[0])


def build_badge(ui: Ui, world: World, window: Window, room: float) -> None:
    """Build the badge at the right end of some room in the bar of menus, and what it opens.

    Parameters
    ----------
    room : float
        How wide it may be [px]; fewer words are written where there is little, and none in too little.
    """
    trust, now = window.trust, world.time
    words = next((words for words in _words(trust, now) if _width(ui, words) <= room), "")
    if not words:
        return
    inset = room - _width(ui, words) + _INSET * ui.size
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + inset)
    words = ui.written(words)
    imgui.set_next_window_size_constraints(ImVec2(_OPENED * ui.size, 0.0), ImVec2(_OPENED * ui.size, 1e9))
    is_quiet = trust.finding(now) is None
    imgui.push_style_color(imgui.Col_.text, packed(ui.theme.faint if is_quiet else ui.theme.text))
    is_open = imgui.begin_menu(f"{words}###{BADGE}")
    imgui.pop_style_color()
    ui.note(BADGE)
    _frame(ui)
    if is_open:
        _build_details(ui, world, window)
        imgui.end_menu()
    else:
        ui.tip(_sentence(trust, world, now))


def _width(ui: Ui, words: str) -> float:
    """Return how wide the badge is with some words and its frame [px]."""
    return float(ui.width(words) + 2.0 * _INSET * ui.size + imgui.get_style().item_spacing.x)


def build_body_digits(ui: Ui, world: World, window: Window, entity: int) -> None:
    """Write to how many digits a body's place and motion are good, where that is known."""
    digits, found = window.trust.digits_of(entity, world.time), window.trust.finding(world.time)
    if digits is None or found is None:
        return
    for name, count in zip(_QUANTITIES, digits, strict=True):
        words = f"good to {_counted(count)}"
        if window.trust.is_beyond(world.time):
            words = "one of many"
        elif found.until < world.time:
            words = f"{_counted(count)} until {found.until:.3g} s"
        ui.row(name, words, _sentence(window.trust, world, world.time))


def _frame(ui: Ui) -> None:
    """Draw the outline of the badge around what was built last."""
    low, high, inset = imgui.get_item_rect_min(), imgui.get_item_rect_max(), _INSET * ui.size
    imgui.get_window_draw_list().add_rect(
        ImVec2(low.x - inset, low.y), ImVec2(high.x + inset, high.y), packed(ui.theme.outline),
        0.5 * (high.y - low.y),
    )  # fmt: skip


def _words(trust: TrustWatch, now: float) -> tuple[str, ...]:
    """Return what is written on the badge, the longest first."""
    found = trust.finding(now)
    if not trust.wanted:
        return (_ASKED,)
    if trust.left_out:
        return ("digits: left out",)
    if found is None and trust.failure:
        return ("digits: not found",)
    if found is None:
        return (f"checking {trust.share:.0%}", "checking") if trust.running else ("to be checked",)
    if trust.is_beyond(now):
        return _FUTURES
    counted = _counted(found.digits)
    return (counted,) if found.until >= now else (f"{counted} until {found.until:.3g} s", counted)


def _counted(digits: float) -> str:
    """Return whole digits in words.

    >>> _counted(9.7), _counted(1.2), _counted(0.3)
    ('9 digits', '1 digit', 'no digit')
    """
    whole = math.floor(digits)
    return "no digit" if whole < 1 else f"{whole} digit{'s' if whole > 1 else ''}"


def _sentence(trust: TrustWatch, world: World, now: float) -> str:
    """Return what the badge stands for."""
    found = trust.finding(now)
    if not trust.wanted:
        return f"{_MEANING} A click here, and a line of what opens, has it checked"
    if trust.left_out or (trust.failure and found is None):
        return trust.left_out or f"Digits could not be checked: {trust.failure}"
    if found is None:
        return f"Digits are being checked from t = {trust.since:.4g} s on, the last edit"
    if trust.is_beyond(now):
        return (
            f"One rounding has grown to another future since t = {trust.horizon:.3g} s, by whatever method. "
            f"Still true: {_still_true(found)}"
        )
    span = f"from t = {trust.since:.4g} s (the last edit) until t = {found.until:.4g} s"
    return f"{_worst(trust, world, now)}: {span}"


def _worst(trust: TrustWatch, world: World, now: float) -> str:
    """Return which position has the fewest digits, and how many."""
    found, worst = trust.finding(now), trust.worst(now)
    assert found is not None and worst is not None
    others = ", and no other to fewer" if len(found.bodies) > 1 else ""
    return f"The position of {world.label(worst)} is good to {_counted(found.digits)}{others}"


def _still_true(found: Finding) -> str:
    """Return what can be relied on after the horizon."""
    kept = [
        f"{name} ({_counted(digits)})"
        for name, digits in (("energy", found.energy), ("momentum", found.momentum))
        if digits >= 1.0
    ]
    return ", ".join([*kept, "averages"])


def _build_details(ui: Ui, world: World, window: Window) -> None:
    """Build what the badge opens."""
    trust, now = window.trust, world.time
    found = trust.finding(now) if trust.wanted else None
    ui.heading(BADGE if found is None else _words(trust, now)[0].capitalize())
    ui.faint(_sentence(trust, world, now))
    if found is not None:
        ui.gap(0.2)
        ui.row("Positions", _counted(found.digits), "Of the worst body")
        for name, counts in zip(
            ("Velocities", "Angles", "Spins"), (found.velocities, found.angles, found.spins), strict=True
        ):
            ui.row(name, _counted(min(counts)), "Of the worst body")
        ui.row("Energy", _counted(found.energy), "As a share of the largest of it and its parts")
        ui.row("Momentum", _counted(found.momentum), "As a share of the sum of those of all bodies")
        ui.row("Turning", _counted(found.angular_momentum), "Angular momentum, in the same way")
        horizon = "none found" if trust.horizon is None else f"t = {trust.horizon:.3g} s"
        ui.row("Horizon", horizon, "When one rounding has grown to a tenth of a body's size")
        if found.digits < 1.0 and not trust.is_beyond(now):
            ui.faint("A smaller step or another method keeps more: F5 compares them")
    if trust.failure and found is not None:
        ui.faint(f"They were not checked for longer: {trust.failure}")
    if trust.running:
        ui.gap(0.2)
        ui.bar("Checking", f"{trust.share:.0%}", trust.share, ui.theme.accent)
    elif not trust.wanted:
        ui.faint(f"It computes the scene about {RUNS} times over, beside the window: frames have priority.")
    ui.rule()
    tip = "In a separate process, again as time goes on"
    ui.item("Check digits", lambda _, window: window.trust.toggle(), on=trust.wanted, tip=tip)
