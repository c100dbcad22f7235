"""The tour: eight acts, each shown until it is done in the world itself."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from physicslab.components import Shape, Spring
from physicslab.view.window.tour import Tour
from physicslab.view.window.window import Window
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class Step:
    """An act: what it is, how it is done, and the number that it makes larger, or changes."""

    title: str
    words: str
    reads: Callable[[World, Window], object]
    grows: bool = True


STEPS = (
    Step("Throw", "Take a ball or a box with the left button, move the mouse, and let go on the way.",
         lambda world, window: window.hand.throws),
    Step("Pause", "Space stops time. Press it again, and time goes on.",
         lambda world, window: window.pace.paused),
    Step("Draw", "Choose Box at the left, and drag from one corner to the other in an empty place.",
         lambda world, window: len(world.batch(Shape))),
    Step("Spring", "Choose Spring at the left, and drag from a body to another one, or to any point.",
         lambda world, window: len(world.batch(Spring))),
    Step("Gravity", "G turns gravity off. Look around, and press G again.",
         lambda world, window: (world.physics.gravity_mode, world.physics.gravity), grows=False),
    Step("Microscope", "Z lists all impacts. Click a row: the microscope shows that impact.",
         lambda world, window: window.microscope.is_open),
    Step("Undo", "Ctrl+Z takes back what you did last; Ctrl+Y does it again.",
         lambda world, window: len(window.edits.history.entries) - window.edits.history.position),
    Step("Save", "Ctrl+S writes the scene to a file, the first time under a name that you give it.",
         lambda world, window: window.scenes.saved, grows=False),
)  # fmt: skip


def next_step(world: World, window: Window) -> None:
    """Go on to the next step; after the last one, say where to go from here."""
    tour = window.tour
    if tour is None:
        return
    if tour.number + 1 < len(STEPS):
        window.tour = Tour(tour.number + 1)
        return
    window.put("tour", None)
    window.notify("That was the tour. Ctrl+K finds everything else, F1 lists all keys", 8.0)


def follow_tour(world: World, window: Window) -> None:
    """Go on to the next step as soon as the act of this one is done."""
    tour = window.tour
    if tour is None:
        return
    step = STEPS[tour.number]
    now = step.reads(world, window)
    if tour.world is not world:
        window.tour = replace(tour, world=world, read=now)
    elif now != tour.read:
        if step.grows and now < tour.read:  # type: ignore[operator]
            window.tour = replace(tour, read=now)
        else:
            next_step(world, window)
