"""The window in which a page of the scene is chosen, and how far it is while it is made."""

from functools import partial

from imgui_bundle import imgui

from physicslab.ecs.text import printable
from physicslab.view.controls import share_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.sharing import WHOLE_LESSON, beginnings
from physicslab.view.window.window import Window
from physicslab.view.workbench.file_panels import build_answers, build_name
from physicslab.world import World

_NAME, _SECONDS, _QUANTITY, _SPAN = 26.0, 7.0, 17.0, 8.4
"""Widths of the fields, in heights of the text."""


def build_share(ui: Ui, world: World, window: Window) -> None:
    """Build the choices, the fields and the buttons, in a window of its own."""
    sharing, size, close = window.sharing, ui.size, window.closing_of("sharing.choosing")
    with ui.floating("Share as a page", window.framing.middle, close):
        ui.faint("One file that plays the run in any browser, without a network", wrapped=False)
        entered = build_name(ui, "Page name", sharing.naming, _NAME, close)
        holds = beginnings(window.edits.history.last_edit)
        holds = holds if window.lesson is None else (WHOLE_LESSON, *holds)
        begins = sharing.begins if sharing.begins in holds else holds[0]  # an edit was taken back
        sharing.begins = ui.choice("Page begins", begins, holds, width=(_NAME - _SECONDS - 4.0) * size)
        if sharing.begins == WHOLE_LESSON:
            ui.faint("Predict, run, compare and answer in the browser; its solutions are in the page")
        else:
            _build_run(ui, world, window)
        make, labels = share_actions.begin_sharing, ("Make the page", "Cancel")
        build_answers(ui, sharing.naming, labels, entered, make, close)


def _build_run(ui: Ui, world: World, window: Window) -> None:
    """Build how long the run of the page is, and what its sliders change."""
    sharing, size = window.sharing, ui.size
    imgui.same_line()
    sharing.seconds, _ = ui.field("Seconds of the page", sharing.seconds, _SECONDS * size)
    imgui.same_line()
    ui.faint("seconds", wrapped=False)
    ui.gap(0.2)
    ui.faint("Sliders of the page: a quantity, and from : to : how many values, 40 at most", wrapped=False)
    for n, slid in enumerate(sharing.slid, start=1):
        tip = "The run is made for each value, and the slider chooses between them"
        path = ui.choice(
            f"Slider {n} of the page", slid.path, partial(share_actions.varying, world), tip,
            width=_QUANTITY * size, shown=share_actions.words_of(slid.path),
        )  # fmt: skip
        if path != slid.path:
            window.do_next(share_actions.choose_slid, slid, path)
        if slid.path:
            imgui.same_line()
            before = slid.span
            slid.span, _ = ui.field(f"Values of slider {n}", before, _SPAN * size, wrong=bool(slid.refused))
            if slid.span != before:
                slid.refused = ""
            ui.refusal(slid.refused)


def build_sharing(ui: Ui, window: Window) -> None:
    """Build how far the page is that is being made."""
    left, top, width, _ = window.framing.room()
    place, stop = (
        (left + 0.5 * width, top + 4.0 * ui.size),
        partial(window.do_next, share_actions.stop_sharing),
    )
    with ui.floating("Making the page", place, stop):
        ui.faint("The runs of the page are made beside the window", wrapped=False)
        sharing = window.sharing
        ui.bar(printable(sharing.path.name), sharing.progress, sharing.share, ui.theme.accent)
        ui.button("Give it up", "Esc does so too", share_actions.stop_sharing)
