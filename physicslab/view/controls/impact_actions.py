"""Actions on impacts: list them, look at one closely, pause at the next."""

from typing import Any

from physicslab.components import Velocity
from physicslab.ecs.sentences import listed
from physicslab.languages.sentence import Sentence
from physicslab.view.controls import actions
from physicslab.view.window.window import Window
from physicslab.world import World

_REACH = 14.0
"""How near to the mark of an impact a click need be [px]."""
_SLOWLY = 0.0625
"""How fast time runs around an impact that is shown slowly."""
_AROUND = 0.12
"""How long before and after the impact that is [s]."""


def close_up(world: World, window: Window, record: Any) -> None:
    """Open the microscope at an impact, and go to the moment after it where that is kept."""
    window.microscope.show(record)
    history = window.edits.history
    step = history.step_at(float(record["time"]))
    if step != history.step_count:
        actions.seek(world, window, step)
    window.pace.paused = True


def go_beside(world: World, window: Window, by: int) -> None:
    """Go from the impact that is shown to the next one, or with -1 to the one before."""
    microscope = window.microscope
    time = microscope.collision.time if microscope.is_open else world.time
    record = window.impacts.beside(time, by, window.selection.entities)
    if record is None:
        window.notify("No later impact is listed" if by > 0 else "No earlier impact is listed")
    else:
        close_up(world, window, record)


def pause_at_next(world: World, window: Window) -> None:
    """Run until the next impact of the selection, and pause there; or no longer wait."""
    microscope = window.microscope
    if microscope.waits_for is not None:
        microscope.waits_for = None
        window.notify("No pause at the next impact")
        return
    chosen = tuple(entity for entity in window.selection.entities if world.has(entity, Velocity))
    microscope.waits_for = chosen
    window.error, window.pace.paused = "", False
    names: str = Sentence("the selection")
    if 0 < len(chosen) < 3:
        names = listed("or", map(world.label, chosen))
    words = Sentence("Pause at the next impact of {body}", body=names)
    window.notify(words if chosen else "Pause at the next impact")


def run_slowly(world: World, window: Window) -> None:
    """Go to shortly before the impact that is shown, and let time run slowly through it."""
    microscope, history = window.microscope, window.edits.history
    if not microscope.is_open:
        window.notify("Choose an impact first: click a row of the table, or a spark")
        return
    time = microscope.collision.time
    start, end = time - _AROUND, max(time + _AROUND, world.simulation.dt)
    was_paused = window.pace.paused
    actions.seek(world, window, history.step_at(start))
    window.pace.paused = was_paused
    microscope.run_slowly(window.pace, _SLOWLY, end)


def clicked_impact(world: World, window: Window, pixel: tuple[float, float]) -> Any | None:
    """Return the impact whose mark or sparks are at a place on the screen [px], while time stands still."""
    camera = window.camera
    if not window.pace.paused:
        return None
    return window.microscope.near(camera.to_world(pixel), _REACH / camera.scale, world.time)
