"""Actions of the user, one function each, for all keys and buttons."""

import math
from pathlib import Path

from physicslab.components import Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.text import printable
from physicslab.ecs.vector import Vector2
from physicslab.files.replace import reason_of
from physicslab.files.scene import SceneError, file_stem
from physicslab.history import Branch, Command, Remove, SetField, SetPhysics, SetText
from physicslab.languages.sentence import Sentence
from physicslab.state.contents import SCENE_TEXTS
from physicslab.systems.gravity import GravitySystem
from physicslab.theme import THEMES
from physicslab.view.controls.lesson_actions import begin_run, leave_lesson
from physicslab.view.controls.measuring import nudged
from physicslab.view.controls.saving import name_of
from physicslab.view.controls.share_actions import stop_sharing
from physicslab.view.controls.tool import Tool
from physicslab.view.controls.tools import HAND
from physicslab.view.overlay.instruments import instruments_of
from physicslab.view.window.naming import new_paths
from physicslab.view.window.tour import Search, Tour
from physicslab.view.window.window import OPENED, Action, Window
from physicslab.world import World

_ZOOM_STEP = 3.0
"""How many notches of the wheel a key or a button zooms by."""
_TEXT_SCALES = (0.8, 0.9, 1.0, 1.15, 1.3, 1.5, 1.75, 2.0)
"""The sizes of text there are, as shares of the usual."""


def choose_tool(world: World, window: Window, tool: Tool) -> None:
    """Let the left mouse button do something else."""
    if window.lesson is not None and not window.lesson.opens_tool(tool.name):
        window.notify(f"The lesson has {tool.title} shut; Esc leaves the lesson")
        return
    window.sketch.cancel()
    window.measuring.cancel()
    window.tool = tool.name
    window.notify(tool.usage, 5.0)


def toggle_pause(world: World, window: Window) -> None:
    """Let time stand still, or go on; at the beginning of a lesson's run, make that."""
    if window.lesson is not None and window.lesson.coming is not None:
        begin_run(world, window, window.lesson.coming)
        return
    window.pace.toggle_pause()
    if window.hand.entity is None:  # what the hand does goes on, and is one act
        window.edits.history.divide(own=not window.pace.paused)
    if not window.pace.paused:
        window.error = ""


def step_once(world: World, window: Window) -> None:
    """Pause, and make one step; undo takes single steps back without the edit before them."""
    history = window.edits.history
    if window.hand.entity is None and not history.runs_on:
        history.divide(own=True)
    window.pace.queue_step()


def clear(world: World, window: Window) -> None:
    """Remove everything, and what the scene says of itself."""
    window.hand.drop(world)
    window.sketch.cancel()
    window.measuring.cancel()
    removed: list[Command] = [Remove(entity) for entity in world.entities()]
    removed += [SetText(key, "") for key in SCENE_TEXTS if getattr(world, key)]
    if removed:
        window.edits.do_all(removed, "cleared everything")
        window.notify("Cleared: one Ctrl+Z brings all back", 5.0)
    window.overlays.forget()
    window.sparks.clear()


def toggle_gravity(world: World, window: Window) -> None:
    """Turn the uniform pull on or off; where the scene has none to turn on, it is that of the Earth."""
    if world.physics.gravity_mode == "linear" and world.physics.gravity:
        _set_gravity(world, window, gravity_mode="none")
    else:
        gravity = world.physics.gravity or PhysicsConfig().gravity
        _set_gravity(world, window, gravity_mode="linear", gravity=gravity)


def toggle_planets(world: World, window: Window) -> None:
    """Let bodies attract each other, or go back to the gravity there was before."""
    now = world.physics.gravity_mode
    _set_gravity(world, window, gravity_mode=window.gravity_before if now == "planet" else "planet")
    window.gravity_before = window.gravity_before if now == "planet" else now


def _set_gravity(world: World, window: Window, **physics: object) -> None:
    if has_gravity(world):
        window.edits.do(SetPhysics(physics))
    else:
        window.notify("This world was made without GravitySystem: no law of gravity acts in it", failed=True)


def toggle_scales(world: World, window: Window) -> None:
    """Let the scales of all arrows stay as they are, or follow what is shown again."""
    window.overlays.toggle_scales()
    kept = window.overlays.keeps_scales
    window.notify("Arrows keep their scale" if kept else "The scale of arrows follows what is shown")


def zoom(window: Window, notches: float, at: tuple[float, float] | None = None) -> None:
    """Enlarge the picture by some notches of the wheel, around a place [px] or the cursor."""
    window.begin_glide()
    window.camera.zoom(1.15**notches, window.pointer if at is None else at)


def fit(world: World, window: Window) -> None:
    """Show everything, and glide there."""
    window.begin_glide()
    window.framing.fit(world)


def first_view(world: World, window: Window) -> None:
    """Go back to the view at the start, and glide there."""
    window.begin_glide()
    window.framing.go_home(world)


def zoom_by_key(sign: int) -> Action:
    """Return what enlarges the picture around the cursor, or reduces it."""
    return lambda _, window: zoom(window, sign * _ZOOM_STEP)


def zoom_by_button(sign: int) -> Action:
    """Return what enlarges the picture around its middle, or reduces it: the cursor is on a button."""
    return lambda _, window: zoom(window, sign * _ZOOM_STEP, window.framing.middle)


def scale_text(window: Window, steps: int) -> None:
    """Change the size of all text by some steps."""
    nearest = min(range(len(_TEXT_SCALES)), key=lambda n: abs(_TEXT_SCALES[n] - window.text_scale))
    window.text_scale = _TEXT_SCALES[min(max(nearest + steps, 0), len(_TEXT_SCALES) - 1)]
    window.notify(f"Text: {100 * window.text_scale:.0f} %")


def next_theme(world: World, window: Window) -> None:
    """Show everything in the colours of the next theme."""
    window.theme = THEMES[(THEMES.index(window.theme) + 1) % len(THEMES)]
    window.notify(f"Colours: {window.theme.name}")


def toggle_snapping(world: World, window: Window) -> None:
    """Let places, sizes and angles snap, or no longer."""
    window.snapping.on = not window.snapping.on
    window.notify("Snapping is on" if window.snapping.on else "Snapping is off")


def reset_layout(world: World, window: Window) -> None:
    """Put every window back in its first place, and undock it."""
    window.arrangements = dict.fromkeys(window.arrangements, "")
    window.notify("Layout reset")


def leave(world: World, window: Window) -> None:
    """Leave the help, the plot, the selection or the tool if there is one, else the window."""
    if _gave_up(world, window):
        window.note_closed()
    else:
        window.ask_to_close(world, twice=window.has_closed)


def quit_window(world: World, window: Window) -> None:
    """Close the window, whatever is open in it; where something would be lost, at the second request."""
    window.ask_to_close(world)


def _gave_up(world: World, window: Window) -> bool:
    """Close or give up what is in front; return whether there was anything."""
    if window.measuring.cancel() or window.sketch.cancel() or _close_panel(window):
        return True
    if window.sharing.running:
        stop_sharing(world, window)
        return True
    if window.picking is not None:
        window.picking = None
        window.notify("Nothing was chosen")
    elif window.selection.entities:
        window.selection.clear()
    elif window.lesson is not None:
        leave_lesson(world, window)
    elif window.tool != HAND.name:
        choose_tool(world, window, HAND)
    else:
        return False
    return True


def _close_panel(window: Window) -> bool:
    """Close the first panel that is open of those that Esc closes; return whether there is one."""
    panel = next((panel for panel in OPENED if window.is_open(panel) and panel != "shows_stopwatch"), None)
    if panel is not None:
        window.closing_of(panel)()
    return panel is not None


def select_all(world: World, window: Window) -> None:
    """Select all bodies that can move."""
    window.selection.entities = tuple(world.batch(Transform, Velocity).entities.tolist())


def select_next(world: World, window: Window) -> None:
    """Select the body after the one that is selected, those that move first, and then instruments."""
    found = {*world.batch(Transform).entities.tolist(), *(one.entity for one in instruments_of(world))}
    moving = set(world.batch(Transform, Velocity).entities.tolist())
    order = sorted(found, key=lambda entity: (entity not in moving, entity))
    chosen = window.selection.entities
    if order:
        now = order.index(chosen[-1]) if chosen and chosen[-1] in order else -1
        window.selection.take(order[(now + 1) % len(order)])


def _changed(world: World, window: Window, name: str, by: Vector2 | float) -> list[Command]:
    """Return what adds to a field of the Transform of all that is selected."""
    return [
        SetField(entity, "Transform", name, getattr(world.component(entity, Transform), name) + by)
        for entity in window.selection.bodies(world)
    ]


def _of_all(world: World, window: Window, did: str) -> Sentence:
    """Return what was done to the selection: to the one by its name, or to how many."""
    chosen = window.selection.entities
    return Sentence(did, what=world.label(chosen[0]) if len(chosen) == 1 else len(chosen))


def nudger(across: int, up: int) -> Action:
    """Return what moves all that is selected by so many pixels."""

    def nudge(world: World, window: Window) -> None:
        by = Vector2(across, up) / window.camera.scale
        moves = _changed(world, window, "position", by)
        moves += filter(None, (nudged(world, entity, by) for entity in window.selection.entities))
        window.edits.do_all(moves, _of_all(world, window, "moved {what}"))

    return nudge


def turner(sign: int) -> Action:
    """Return what turns each body that is selected by a degree, or by 15 where angles snap."""

    def turn(world: World, window: Window) -> None:
        by = sign * math.radians(15.0 if window.snapping.active else 1.0)
        turns = _changed(world, window, "angle", by)
        window.edits.do_all(turns, _of_all(world, window, "turned {what}"))

    return turn


def _told(words: str, what: str) -> Sentence:
    return Sentence(words, what=what if isinstance(what, Sentence) else Sentence(what))


def undo(world: World, window: Window) -> None:
    """Undo the last edit with what merely went on after it, or the run since a pause."""
    window.pause_for_history(world)
    words = window.edits.history.undo(runs=False)
    if words is None and window.scenes.left is not None and window.lesson is None:
        window.scenes.next_world = window.scenes.left.history.world
        words = "opened another scene"
    window.notify(_told("Undone: {what}", words) if words else "There is nothing to undo")


def redo(world: World, window: Window) -> None:
    """Redo what was undone last."""
    window.pause_for_history(world)
    words = window.edits.history.redo(runs=False)
    window.notify(_told("Redone: {what}", words) if words else "There is nothing to redo")


def seek(world: World, window: Window, step: int) -> None:
    """Go to the place after so many steps, and pause there; beyond the ends to the nearest."""
    history = window.edits.history
    window.pause_for_history(world)
    first, last = history.steps_range
    history.seek(min(max(step, first), last))


def step_back(world: World, window: Window) -> None:
    """Pause, and go back by one step."""
    seek(world, window, window.edits.history.step_count - 1)


def toggle_tour(world: World, window: Window) -> None:
    """Begin the tour, and close the cards; end it where it is under way."""
    window.put("shows_cards", False)
    window.put("tour", Tour() if window.tour is None else None)


def toggle_search(world: World, window: Window) -> None:
    """Open the search of commands, or close it."""
    window.put("search", Search() if window.search is None else None)


# ---- laws in words -----------------------------------------------------------------------------------------


def has_gravity(world: World) -> bool:
    """Whether the world has a system that applies the law of gravity; a world may be made without one."""
    return any(isinstance(system, GravitySystem) for system in world.schedule.systems)


def gravity_in_words(world: World) -> str:
    """Return the law of gravity, with its constant; "none" where no system applies it."""
    physics = world.physics
    if not has_gravity(world):
        return "none: no GravitySystem"
    if physics.gravity_mode == "none" or (physics.gravity_mode == "linear" and not physics.gravity):
        return "off"
    if physics.gravity_mode == "planet":
        return f"G = {physics.G:.4g} N m²/kg²"
    if physics.gravity.x == 0.0:
        return f"{abs(physics.gravity.y):.4g} m/s² {'down' if physics.gravity.y < 0.0 else 'up'}"
    return f"({physics.gravity.x:.3g}, {physics.gravity.y:.3g}) m/s²"


# ---- the history: switch branches, save all of it in a file ------------------------------------------------


RECORDING_ENDING = ".replay"
"""The suffix of recordings: they are not offered as scenes."""
_WORDS_LIMIT = 2
"""How much of what was done in a branch is written out."""


def branch_words(branch: Branch, start: float) -> str:
    """Return what was done in a branch, and when it leaves the line that is shown; ``start`` [s] is its."""
    words = branch.words
    more = len(words) - _WORDS_LIMIT
    shown = ", then ".join(words[:_WORDS_LIMIT]) + (f", and {more} more" if more > 0 else "")
    return f"At {start + branch.seconds:.2f} s: {shown}"


def switch(world: World, window: Window, branch: Branch) -> None:
    """Go on along a branch, where it leaves the line that was gone along: that is a branch from now on."""
    history = window.edits.history
    if branch not in history.branches:  # clicked before the line changed
        return
    window.pause_for_history(world)
    history.switch(branch)
    window.notify("Another branch: Space plays it, Ctrl+B goes back", 5.0)


def next_branch(world: World, window: Window) -> None:
    """Go on along the branch that was left first; one after the other, all come round."""
    branches = window.edits.history.branches
    if branches:
        switch(world, window, branches[0])
    else:
        window.notify("There is no other branch: a change in the past begins one")


def save_recording(world: World, window: Window) -> None:
    """Keep what was done as a file that ``physicslab replay`` plays, where the program was started."""
    window.put_down(world)
    paths = new_paths(Path.cwd(), file_stem(name_of(world, window)), RECORDING_ENDING)
    try:
        path = next(path for path in paths if not path.exists())
        window.edits.history.save(path)
    except (SceneError, OSError) as error:
        window.notify(f"The recording could not be saved: {reason_of(error)}", 6.0, failed=True)
    else:
        window.notify(f"Saved {printable(path.name)}: physicslab replay plays it", 5.0)
