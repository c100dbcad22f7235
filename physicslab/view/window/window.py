"""The shared state of the systems of a frame: camera, canvas, clock and hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Concatenate

from physicslab.ecs.component import Component
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.history import History
from physicslab.theme import DARK, Theme
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import Canvas, text_height
from physicslab.view.overlay.dust import Dust
from physicslab.view.overlay.forces import Measured
from physicslab.view.overlay.legend import Overlays
from physicslab.view.picture.sparks import Sparks
from physicslab.view.picture.squash import Squash
from physicslab.view.picture.trails import TrailSwitch
from physicslab.view.window.context import Context, Picking
from physicslab.view.window.copying import Copying
from physicslab.view.window.dashboard import Dashboard
from physicslab.view.window.edits import Edits, Recipe, Selection
from physicslab.view.window.ends import Pins
from physicslab.view.window.filming import Filming
from physicslab.view.window.framing import Framing
from physicslab.view.window.hand import Hand
from physicslab.view.window.handles import Handles
from physicslab.view.window.impacts import ImpactList, Microscope
from physicslab.view.window.lab_process import ErrorStudy
from physicslab.view.window.lesson import OpenLesson
from physicslab.view.window.making import Making
from physicslab.view.window.measuring import Measuring
from physicslab.view.window.motion import Glide, fading
from physicslab.view.window.pace import Pace
from physicslab.view.window.placing import Snapping
from physicslab.view.window.scenes import Left, Scenes
from physicslab.view.window.sharing import Sharing
from physicslab.view.window.sketch import Sketch
from physicslab.view.window.sounds import Sounds
from physicslab.view.window.tour import Search, Tour
from physicslab.view.window.trust_watch import TrustWatch
from physicslab.world import World

type Action = Callable[[World, Window], object]
"""The action of a click or a key."""

_PATIENCE = 3.0
"""How long [s] after Esc a second one closes the window though there are unsaved edits."""
OPENED: dict[str, object] = {
    "help": False, "scenes.shows_gallery": False, "filming.choosing": False, "sharing.choosing": False,
    "making.choosing": False,
    "scenes.opening": None, "scenes.naming": None, "lists_history": False, "microscope.record": None,
    "impacts.shown": False, "error_study.shown": False, "search": None, "tour": None, "shows_cards": False,
    "shows_stopwatch": False, "shows_words": False, "copying": None,
}  # fmt: skip
"""Panels that can be closed: what of the window says that they are open, and its value when they are not."""
BESIDE = (
    "copying", "lists_history", "microscope.record", "impacts.shown", "tour", "shows_cards",
    "shows_stopwatch", "shows_words",
)  # fmt: skip
"""Those that lie beside the world; the others lie over it, and keys are for them."""


@dataclass(slots=True)
class KeyChoice:
    """Which keys were chosen, and what the next key that is pressed is for.

    Attributes
    ----------
    chosen : dict of str to str
        The names of keys as SDL has them, after ``"ctrl+"`` and ``"shift+"``, by what their controls do.
    asks : str
        The control that gets the next key; empty for none.
    open : bool
        Whether the list of keys lets one choose.
    """

    chosen: dict[str, str] = field(default_factory=dict)
    asks: str = ""
    open: bool = False


class Window:
    """The state of the sandbox's window; no part of the world depends on it.

    Attributes
    ----------
    canvas : Canvas
        The surface to draw on.
    config : WindowConfig
        Size, frame rate and limits.
    theme : Theme
        The colours.
    camera : Camera
        Which part of the world is shown.
    framing : Framing
        The part of the world that it shows, and the room for it.
    pace : Pace
        Whether time runs, and how fast.
    hand : Hand
        The bodies that are held.
    overlays : Overlays
        Which arrows are shown.
    sparks, dust, squash : Sparks, Dust, Squash
        Sparks of impacts, dust of sliding, and how bodies give way when hit.
    reduced_motion : bool
        Whether nothing moves in the window but what moves in the world.
    sounds : Sounds
        Those of impacts.
    glide : Glide
        How the picture goes from one view to another.
    trails : TrailSwitch
        Whether moving bodies leave trails.
    now : float
        Time [s] that the window has been open; it runs while the world is paused.
    pointer : tuple of two floats
        Where the cursor is [px].
    pointer_on_panel, pointer_beside_panel, has_pointed : bool
        Whether the cursor is on a panel or outside the window, whether on one or so near that nothing is
        begun there, and whether it was ever moved.
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
    lists_history : bool
        Whether the list of edits and runs is shown.
    shows_cards, welcomed : bool
        Whether the cards of the first minute are shown, and whether they were used and closed before.
    search, tour : Search, Tour, optional
        The search among all commands, and the place in the tour; ``None`` while closed.
    tool : str
        The tool of the left mouse button: a name of :mod:`physicslab.view.controls.tools`.
    level : str
        How much is shown: one of :data:`physicslab.view.window.desk.LEVELS`.
    scales : dict of str to float
        How large quantities of the world are, by unit: what is far smaller is rounding.
    text_scale : float
        How much larger than usual text is.
    arrangements : dict of str to str
        Where windows lie and are docked, in words of the toolkit, where the room is ``"wide"`` and where it
        is ``"narrow"``; empty for the layout of the start.
    keys_go_to : str
        Where keys are to go from the next frame on: ``"menu"``, ``"fields"``, ``"panel"`` (the next one) or
        nowhere else.
    keys : KeyChoice
        The keys that were chosen in place of the usual ones.
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
        Properties of the next body.
    measured : Measured
        The forces on the selection.
    snapping : Snapping
        Whether places, sizes and angles snap, and where to.
    pins : Pins
        The fixed end of a spring that is dragged.
    context : Context, optional
        The menu of a place that is open.
    picking : Picking, optional
        The function that gets the body that is clicked next, or ``None``.
    impacts, microscope : ImpactList, Microscope
        The table of impacts; the impact that is looked at closely, and what waits for the next one.
    measuring, shows_stopwatch, shows_words : Measuring, bool, bool
        Instruments that are being placed, dragged or written; whether times between gates are shown, and
        the scene in words.
    scenes : Scenes
        The scene that is shown, its file, and other scenes.
    filming : Filming
        The film that is being made.
    copied, copying : dict, Copying, optional
        The components of each entity that was copied, by its number, and the copies that are to be made.
    band : Vector2, optional
        Where the rectangle begins that is being drawn around bodies [m].
    dashboard : Dashboard
        The graphs, meters and sliders that are shown, and what is recorded for them.
    has_closed : bool
        Whether something was closed or given up: Esc, which does that, quits only at the second press then.
    pending : list of Action
        Actions of clicks on panels: they are done when the next frame begins.
    preparing : float, optional
        How long [s] it takes about until what moves the world is compiled; until then it is interpreted.
    has_kernels : callable
        Returns whether all kernels are there, so that no step of any scene waits for one.
    sketch : Sketch
        The drawing by the mouse.
    lesson : OpenLesson, optional
        The lesson that is open, which shuts what it does not name.
    language : str
        That of lessons and words, as "en".
    error_study, sharing, making : ErrorStudy, Sharing, Making
        Error against run time of the scene, the page and the lesson that are made of it.
    trust : TrustWatch
        How many digits of what is shown can be relied on.
    notice_failed : bool
        Whether the notice is of something that could not be done.
    """

    def __init__(self, canvas: Canvas, config: WindowConfig | None = None) -> None:
        self.canvas = canvas
        self.config = config or WindowConfig()
        self.theme: Theme = DARK
        self.camera = Camera(canvas.size, scale=self.config.pixels_per_metre)
        self.framing = Framing(canvas, self.camera, self.config.pixels_per_metre)
        self.pace = Pace(self.config.max_dt)
        self.hand = Hand(self.config)
        self.overlays = Overlays()
        self.sparks, self.dust, self.squash = Sparks(), Dust(), Squash()
        self.reduced_motion, self.sounds = False, Sounds()
        self.glide = Glide()
        self.trails = TrailSwitch()
        self.now = 0.0
        self.pointer: tuple[float, float] = (0.5 * canvas.size[0], 0.5 * canvas.size[1])
        self.pointer_on_panel = self.pointer_beside_panel = self.has_pointed = False
        self.gravity_before = "linear"
        self.spawned = 0
        self.touched = self.wants_screenshot = False
        self.closing = False
        self.error = ""
        self.help = self.lists_history = self.shows_cards = self.welcomed = False
        self.search: Search | None = None
        self.tour: Tour | None = None
        self.grid = self.figures = True
        self.tool = "circle"
        self.level = "Explore"
        self.text_scale = 1.0
        self.scales: dict[str, float] = {}
        self.arrangements = {"wide": "", "narrow": ""}
        self.keys, self.keys_go_to = KeyChoice(), ""
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
        self.measuring, self.shows_stopwatch, self.shows_words = Measuring(), False, False
        self.impacts, self.microscope = ImpactList(), Microscope()
        self.scenes = Scenes()
        self.filming = Filming(lambda words, failed: self.notify(words, 6.0, failed=failed))
        self.copied: dict[int, list[Component]] = {}
        self.copying: Copying | None = None
        self.context: Context | None = None
        self.band: Vector2 | None = None
        self.dashboard = Dashboard()
        self.has_closed = False
        self.pending: list[Action] = []
        self.error_study, self.sharing, self.making = ErrorStudy(), Sharing(), Making()
        self.trust = TrustWatch()
        self.sketch = Sketch()
        self.lesson: OpenLesson | None = None
        self.language = "en"
        self.preparing: float | None = None
        self.has_kernels: Callable[[], bool] = lambda: False
        self.notice_failed = False
        self._notice, self._notice_since, self._notice_until = "", 0.0, 0.0
        self._may_close_until = 0.0

    @property
    def drawing(self) -> Drawing:
        """The canvas, camera and colours; text is larger in a larger window, times the chosen scale."""
        size = text_height(self.canvas.size, self.text_scale)
        return Drawing(self.canvas, self.glide.shown(self.camera, self.now), self.theme, size)

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

    @property
    def notice_share(self) -> float:
        """How visible the notice is, 0 to 1: it comes and goes softly."""
        if self.reduced_motion:
            return 1.0
        return fading(self.now - self._notice_since, self._notice_until - self.now)

    def begin_glide(self) -> None:
        """Let the picture glide from what is shown now to the view that the camera is given next."""
        if not self.reduced_motion:
            self.glide.begin(self.drawing.camera, self.now)

    def put(self, path: str, value: object) -> None:
        """Give a part of the state another value, by its path from the window, as ``"pace.paused"``."""
        owner, _, name = path.rpartition(".")
        if path in OPENED and value is OPENED[path]:
            self.note_closed()
        setattr(attrgetter(owner)(self) if owner else self, name, value)

    def note_closed(self) -> None:
        """Note that something was closed or given up: the next Esc may be meant for that."""
        self.has_closed, self._may_close_until = True, 0.0

    def is_open(self, panel: str) -> bool:
        """Whether a panel is open, one of ``OPENED``."""
        return attrgetter(panel)(self) is not OPENED[panel]

    @property
    def works(self) -> bool:
        """Whether something is being made that takes many frames: a film, a page, samples of the past."""
        fills = self.dashboard.past is not None or self.impacts.fills
        return fills or self.error_study.running or self.filming.running or self.sharing.running

    @property
    def in_front(self) -> str:
        """The panel that lies over the world, one of ``OPENED``; empty if none does."""
        return next((panel for panel in OPENED if panel not in BESIDE and self.is_open(panel)), "")

    def closing_of(self, panel: str) -> Callable[[], None]:
        """Return what closes a panel, one of ``OPENED``."""
        return lambda: self.put(panel, OPENED[panel])

    @property
    def own(self) -> Left:
        """The user's scene: the one that is shown, or that waits until a lesson is left."""
        if self.lesson is not None:
            return self.lesson.before
        return Left(self.edits.history, self.scenes.source, self.scenes.saved)

    @property
    def has_unsaved(self) -> bool:
        """Whether anything was done to the user's scene by hand since it was opened or saved."""
        return self.own.is_edited

    def notify(self, words: str, seconds: float = 3.0, *, failed: bool = False) -> None:
        """Show a message for a while; ``failed`` marks what could not be done."""
        self.notice_failed = failed
        if words != self.notice:
            self._notice_since = self.now
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
        self.edits = Edits(
            history,
            lambda words: self.notify(words, 6.0, failed=True),
            lambda world: self.hand.loosen(world),
            lambda command: self.lesson is None or self.lesson.allows(command, history.world),
        )
        self.hand.write = lambda world, command: self.edits.write(command)

    def put_down(self, world: World) -> None:
        """Let go of what is held, and make an edit of what was shown: the world is written as it is."""
        self.hand.drop(world)
        self.edits.keep()

    def pause_for_history(self, world: World) -> None:
        """Pause, and let go of what is held or dragged, to go to another place of the history."""
        self.hand.drop(world)
        self.handles.release(self.edits)
        self.pins.release(self.edits)
        self.pace.paused = self.trails.goes_elsewhere = True

    @property
    def handled(self) -> int | None:
        """The body whose handles are shown: the one that is selected, while paused."""
        chosen = self.selection.entities if self.lesson is None else ()
        return chosen[0] if self.pace.paused and len(chosen) == 1 and self.hand.entity is None else None

    def ask_to_close(self, world: World, *, twice: bool = False) -> None:
        """Close the window; where something would be lost, or ``twice``, at the second request in a while."""
        reasons: list[str] = []
        if self.has_unsaved:
            reasons.append("its scene is kept and offered at the next start")
        if self.scenes.left is not None:
            scene = self.scenes.left.history.world.title or "the scene before"
            reasons.append(f"what was edited in {scene} is lost")
        if self.filming.running:
            reasons.append("the film is not finished")
        if not (reasons or twice) or self.now < self._may_close_until:
            self.closing = True
            return
        self._may_close_until = self.now + _PATIENCE
        words = f"Once more closes the window; {', and '.join(reasons)}" if reasons else "Esc again quits"
        self.notify(words, _PATIENCE)

    def coming(self, world: World) -> float:
        """Return the time [s] that is about to be simulated in this frame."""
        dt = world.simulation.dt
        return self.pace.due(dt) * dt * self.pace.shortening

    def is_moving(self, world: World) -> bool:
        """Whether something in the picture changes by itself: time runs, a body is held, words will go."""
        stands = self.pace.paused and self.pace.due(world.simulation.dt) == 0 and self.hand.entity is None
        return not stands or bool(self.notice or len(self.sparks)) or self.glide.runs(self.now)
