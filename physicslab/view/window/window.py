"""The shared state of the systems of a frame: camera, canvas, clock and hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Concatenate

from physicslab.ecs.component import Component
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.history import History
from physicslab.view.canvas.camera import Camera, Drawing, Extent
from physicslab.view.canvas.canvas import Canvas, Rect
from physicslab.view.canvas.theme import DARK, Theme
from physicslab.view.overlay.forces import Measured
from physicslab.view.overlay.legend import Overlays
from physicslab.view.picture.extent import extent_of
from physicslab.view.picture.sparks import Sparks
from physicslab.view.picture.trails import TrailSwitch
from physicslab.view.window.dashboard import Dashboard
from physicslab.view.window.edits import Edits, Recipe, Selection
from physicslab.view.window.filming import Filming
from physicslab.view.window.hand import Hand
from physicslab.view.window.handles import Handles
from physicslab.view.window.impacts import ImpactList, Microscope
from physicslab.view.window.lab_process import ErrorStudy
from physicslab.view.window.measuring import Measuring
from physicslab.view.window.pace import Pace
from physicslab.view.window.placing import Snapping
from physicslab.view.window.recent import RecentFiles, Recovery
from physicslab.view.window.sketch import Sketch
from physicslab.view.window.spring_tool import Pins
from physicslab.view.window.trust_watch import TrustWatch
from physicslab.world import World

type Action = Callable[[World, Window], object]
"""The action of a click or a key."""

_PATIENCE = 3.0
"""How long [s] after Esc a second one closes the window though there are unsaved edits."""
LEVELS = {
    "Explore": "The world first, few figures",
    "Measure": "Energies, momenta and their changes",
    "Engineer": "Methods, systems and their cost",
}
"""How much the panel at the right shows, with what each level is for."""
OPENED: dict[str, object] = {
    "help": False, "shows_gallery": False, "filming.choosing": False, "opening": None, "naming": None,
    "lists_history": False, "microscope.record": None, "impacts.shown": False, "error_study.shown": False,
    "shows_stopwatch": False,
}  # fmt: skip
"""Panels that can be closed: what of the window says that they are open, and its value when they are not."""
_AROUND = 0.04
"""Room left around the world, as a share of what the panels leave."""


@dataclass(frozen=True, slots=True)
class Left:
    """A scene with unsaved edits that another one took the place of.

    Attributes
    ----------
    history : History
        Its edits and runs, with its world.
    source : str or path, optional
        What it was opened from.
    unchanged : int
        How often it had been edited when it was opened or saved last.
    """

    history: History
    source: str | Path | None
    unchanged: int


@dataclass(frozen=True, slots=True)
class Picking:
    """The field of an entity's component that the body is for which is clicked next."""

    entity: int
    kind: type[Component]
    field: str


class Window:
    """The state of the sandbox's window; no part of the world depends on it.

    Attributes
    ----------
    canvas : Canvas
        What is drawn on.
    config : WindowConfig
        Size, frame rate and limits.
    theme : Theme
        The colours.
    camera : Camera
        Which part of the world is shown.
    pace : Pace
        Whether time runs, and how fast.
    hand : Hand
        What is held.
    overlays : Overlays
        Which arrows are shown.
    sparks : Sparks
        Those in flight.
    trails : TrailSwitch
        Whether moving bodies leave trails.
    now : float
        Time [s] that the window has been open; it runs while the world is paused.
    pointer : tuple of two floats
        Where the cursor is [px].
    pointer_on_panel, has_pointed : bool
        Whether the cursor is on a panel, and whether it was ever moved.
    gravity_before : str
        The mode that gravity goes back to after planet mode.
    spawned : int
        How many bodies were made by hand; what comes next varies with it.
    touched : bool
        Whether the user did anything since the frame before.
    wants_screenshot : bool
        Whether a picture of the window is to be kept as soon as it is drawn.
    closing : bool
        Whether the window is to be closed.
    error : str
        Why the world stopped; empty while all is well.
    help, grid, figures : bool
        Whether all keys are shown, the grid, and the panels of figures and costs.
    lists_history, shows_gallery : bool
        Whether the list of edits and runs is shown, and the gallery of scenes.
    tool : str
        What the left mouse button does: the name of a tool of :mod:`physicslab.view.controls.tools`.
    level : str
        How much is shown: one of ``LEVELS``.
    text_scale : float
        How much larger than usual text is.
    arrangement : str
        Where windows lie and are docked, in words of the toolkit; empty for the layout of the start.
    keys_go_to : str
        Where keys are to go from the next frame on: ``"menu"``, ``"fields"``, ``"panel"`` (the next one) or
        nowhere else.
    points_by_key, presses_by_key : bool
        Whether the cursor was moved by keys, and whether the tool was pressed by one and is to be let go.
    adding : bool
        Whether a click adds to the selection: Shift or Ctrl is held.
    selection : Selection
        Which bodies are selected.
    edits : Edits
        How the world that is shown is changed.
    handles : Handles
        Those of the selection.
    recipe : Recipe
        What the next body is like.
    measured : Measured
        The forces on the selection.
    snapping : Snapping
        Whether places, sizes and angles snap, and where to.
    pins : Pins
        The fixed end of a spring that is dragged.
    picking : Picking, optional
        What is given the body that is clicked next, or none where there is none.
    measuring : Measuring
        What is being placed, dragged or written of instruments.
    impacts : ImpactList
        The table of impacts.
    microscope : Microscope
        The impact that is looked at closely, and what waits for the next one.
    shows_stopwatch : bool
        Whether the times between crossings of gates are shown.
    naming : str, optional
        The name that is being written for the scene to be saved under; ``None`` while none is.
    naming_refused : str
        Why the scene could not be saved under it.
    opening : str, optional
        The name that is being written of the file to be opened; ``None`` while none is.
    opening_refused : str
        Why it could not be opened.
    filming : Filming
        The film that is being made.
    recent : RecentFiles
        The files that were opened or saved last.
    copied : list
        The components of each body that was copied.
    band : Vector2, optional
        Where the rectangle begins that is being drawn around bodies [m].
    dashboard : Dashboard
        The graphs, meters and sliders that are shown, and what is recorded for them.
    pending : list of Action
        What panels were clicked for: it is done when the next frame begins.
    source : str or path, optional
        The built-in scene or the file that is shown; restarting opens it again.
    room : callable
        Returns which part of the canvas is left for the world [px].
    sketch : Sketch
        What is being drawn with the mouse.
    error_study : ErrorStudy
        Error against run time of the scene, measured when its key is pressed.
    trust : TrustWatch
        How many digits of what is shown can be relied on.
    scene_file : path, optional
        The scene file that was last saved or opened.
    unchanged : int
        How often the world had been edited when it was opened or saved last.
    next_world : World, optional
        The world that is to be shown in place of the present one from the next frame on.
    left : Left, optional
        The scene that was shown before, where it has unsaved edits; undo at the start brings it back.
    notice_failed : bool
        Whether the notice is of something that could not be done.
    recovery : Recovery
        What sessions that ended without closing have left.
    """

    def __init__(self, canvas: Canvas, config: WindowConfig | None = None, theme: Theme = DARK) -> None:
        self.canvas = canvas
        self.config = config or WindowConfig()
        self.theme = theme
        self.camera = Camera(canvas.size, scale=self.config.pixels_per_metre)
        self.pace = Pace(self.config.max_dt)
        self.hand = Hand(self.config)
        self.overlays = Overlays()
        self.sparks = Sparks()
        self.trails = TrailSwitch()
        self.now = 0.0
        self.pointer: tuple[float, float] = (0.5 * canvas.size[0], 0.5 * canvas.size[1])
        self.pointer_on_panel = self.has_pointed = False
        self.gravity_before = "linear"
        self.spawned = 0
        self.touched = self.wants_screenshot = False
        self.closing = False
        self.error = ""
        self.help = self.lists_history = self.shows_gallery = False
        self.grid = self.figures = True
        self.tool = "circle"
        self.level = "Explore"
        self.text_scale = 1.0
        self.arrangement = ""
        self.keys_go_to = ""
        self.points_by_key = self.presses_by_key = False
        self.adding = False
        self.selection = Selection()
        self.handles = Handles()
        self.edits: Edits
        self.recipe = Recipe()
        self.measured = Measured()
        self.pins = Pins()
        self.snapping = Snapping()
        self.picking: Picking | None = None
        self.measuring, self.shows_stopwatch = Measuring(), False
        self.impacts, self.microscope = ImpactList(), Microscope()
        self.naming: str | None = None
        self.naming_refused = ""
        self.opening: str | None = None
        self.opening_refused = ""
        self.filming = Filming(lambda words, failed: self.notify(words, 6.0, failed=failed))
        self.recent = RecentFiles()
        self.copied: list[list[Component]] = []
        self.band: Vector2 | None = None
        self.dashboard = Dashboard()
        self.pending: list[Action] = []
        self.source: str | Path | None = None
        self.room: Callable[[], Rect] = lambda: (0, 0, *canvas.size)
        self.error_study = ErrorStudy()
        self.trust = TrustWatch()
        self.sketch = Sketch()
        self.scene_file: Path | None = None
        self.unchanged = 0
        self.next_world: World | None = None
        self.left: Left | None = None
        self.notice_failed = False
        self.recovery = Recovery()
        self._notice, self._notice_until = "", 0.0
        self._may_close_until = 0.0
        self._shown: tuple[Vector2, float, float, Extent | None] | None = None
        self._room: Rect | None = None

    @property
    def drawing(self) -> Drawing:
        """The canvas, camera and colours; text is larger in a larger window, times the chosen scale."""
        width, height = self.canvas.size
        size = round(min(max(min(height / 48, width / 80), 12), 20) * self.text_scale)
        return Drawing(self.canvas, self.camera, self.theme, size)

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of what is left for the world [px]."""
        left, top, width, height = self.room()
        return left + 0.5 * width, top + 0.5 * height

    @property
    def place(self) -> Vector2:
        """The point of the world under the cursor [m]."""
        return self.camera.to_world(self.pointer)

    @property
    def target(self) -> Vector2:
        """The point at which the cursor moves or makes bodies [m]: its place, or that to which it snaps."""
        return self.place if self.snapping.place is None else self.snapping.place

    @property
    def notice(self) -> str:
        """The message that is shown for a few seconds; empty when there is none."""
        return self._notice if self.now < self._notice_until else ""

    def put(self, path: str, value: object) -> None:
        """Give a part of the state another value, by its path from the window, as ``"pace.paused"``."""
        owner, _, name = path.rpartition(".")
        setattr(attrgetter(owner)(self) if owner else self, name, value)

    def is_open(self, panel: str) -> bool:
        """Whether a panel is open, one of ``OPENED``."""
        return attrgetter(panel)(self) is not OPENED[panel]

    def closing_of(self, panel: str) -> Callable[[], None]:
        """Return what closes a panel, one of ``OPENED``."""
        return lambda: self.put(panel, OPENED[panel])

    def has_unsaved(self, world: World) -> bool:
        """Whether the world was edited since it was opened or saved."""
        return world.motion_edits != self.unchanged

    def notify(self, words: str, seconds: float = 3.0, *, failed: bool = False) -> None:
        """Show a message for a while; ``failed`` marks what could not be done."""
        self.notice_failed = failed
        self._notice, self._notice_until = words, self.now + seconds

    def do_next[**P](
        self, action: Callable[Concatenate[World, Window, P], object], *args: P.args, **kwargs: P.kwargs
    ) -> None:
        """Have ``action(world, window, ...)`` done when the next frame begins."""
        self.pending.append(lambda world, window: action(world, window, *args, **kwargs))

    def do_first[**P](
        self, action: Callable[Concatenate[World, Window, P], object], *args: P.args, **kwargs: P.kwargs
    ) -> None:
        """Have it done before what is pending already: what was written, before the click that ended that."""
        self.pending.insert(0, lambda world, window: action(world, window, *args, **kwargs))

    def follow_history(self, history: History) -> None:
        """Let edits, and what the hand does, go to the history of the world that is shown."""
        self.edits = Edits(history, lambda words: self.notify(words, 6.0, failed=True))
        self.hand.write = lambda world, command: self.edits.write(command)

    def pause_for_history(self, world: World) -> None:
        """Pause, with nothing in the hand and no edit half done, to go to another place of the history."""
        self.hand.drop(world)
        self.edits.take_back_shown()
        self.pace.paused = True

    @property
    def handled(self) -> int | None:
        """The body whose handles are shown: the one that is selected, while paused."""
        chosen = self.selection.entities
        return chosen[0] if self.pace.paused and len(chosen) == 1 and self.hand.entity is None else None

    def ask_to_close(self, world: World) -> None:
        """Close the window; with unsaved edits, only at the second request within a while."""
        if not self.has_unsaved(world) or self.now < self._may_close_until:
            self.closing = True
            return
        self._may_close_until = self.now + _PATIENCE
        self.notify("Esc again closes the window; its scene is kept and offered at the next start", _PATIENCE)

    def coming(self, world: World) -> float:
        """Return the time [s] that is about to be simulated in this frame."""
        dt = world.simulation.dt
        return self.pace.due(dt) * dt * self.pace.shortening

    def is_moving(self, world: World) -> bool:
        """Whether something in the picture changes by itself: time runs, a body is held, words will go."""
        stands = self.pace.paused and self.pace.due(world.simulation.dt) == 0 and self.hand.entity is None
        return not stands or bool(self.notice or len(self.sparks))

    def follow_size(self, world: World) -> None:
        """Let the camera follow the canvas and its room; an untouched view still shows all of the world."""
        if self.camera.size == self.canvas.size and self._room == self.room():
            return
        self._room = self.room()
        self.camera.resize(self.canvas.size)
        if self._shown is not None and self._shown[:2] == (self.camera.centre, self.camera.scale):
            self._show(world, *self._shown[2:])

    def go_home(self, world: World) -> None:
        """Show the world as at the start: what its scene says is to be seen, or else all of it.

        A scene that does not say is shown at the usual scale where it fits, else smaller.
        """
        self._show(world, float("inf") if world.view else self.config.pixels_per_metre, world.view)

    def fit(self, world: World) -> None:
        """Show all of the world, as large as it goes."""
        self._show(world, float("inf"))

    def _show(self, world: World, largest_scale: float, view: Extent | None = None) -> None:
        extent, room = view or extent_of(world), self.room()
        if extent is None:
            self.camera.look_at((0.0, 0.0, 0.0, 0.0), self.config.pixels_per_metre, room)
        else:
            scale = min(self.camera.fitting_scale(extent, room, _AROUND), largest_scale)
            self.camera.look_at(extent, scale, room)
        self._shown = (self.camera.centre, self.camera.scale, largest_scale, view)
