"""The desktop sandbox: a world in a window, frame by frame."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.components import Gate, Graph, Held, Meter, Slider, Transform
from physicslab.desktop.autosave import Autosave
from physicslab.diagnostics.step_watch import StepWatch
from physicslab.files.scene import SceneError, save_last_good
from physicslab.history import Changes, History, RemoveComponent
from physicslab.languages.sentence import Sentence
from physicslab.state.attached import INSTRUMENTS
from physicslab.state.masses import Diverged
from physicslab.systems.frame.hud import HudSystem
from physicslab.systems.frame.input import InputSystem
from physicslab.systems.frame.render import RenderSystem
from physicslab.systems.system import Stage
from physicslab.view.controls.lesson_actions import end_lesson
from physicslab.view.controls.tools import SELECT
from physicslab.view.controls.window_events import WindowEvents
from physicslab.view.picture.backdrop import is_in_space
from physicslab.view.window.desk import restore_desk
from physicslab.view.window.ends import Pins
from physicslab.view.window.handles import Handles
from physicslab.view.window.measuring import Measuring
from physicslab.view.window.scenes import Left
from physicslab.view.window.window import Window
from physicslab.view.workbench.hud import Hud
from physicslab.view.workbench.interface import Interface
from physicslab.view.workbench.world_view import WorldView
from physicslab.world import World

_REST_AFTER, _REST_PERIOD = 1.0, 0.1
"""How long [s] nothing is done and nothing moves before pictures are fewer, and the time between two then."""
_PARTLY = 1e-6
"""Share of a step that is not made up for by another one: sums of steps are rounded."""
_PARTS = 10.0
"""A motion is seen from a tenth of a pixel on."""


class Sandbox:
    """A world in a window. A call of :meth:`frame` is one frame; no real window is needed for it.

    Parameters
    ----------
    world : World
        The world that is shown; the systems of a frame are installed in it.
    window : Window
        Where it is shown.
    clock : callable
        Returns the time [s]; it limits how long the steps of a frame may take.
    autosave : Autosave, optional
        The keeper of the state for the case that the program ends badly.
    shown : callable, optional
        Called with every world that is to be shown, before any system is installed in it.

    Attributes
    ----------
    world : World
        The world that is shown.
    history : History
        The edits and runs of it.
    interface : Interface
        The panels around it.
    """

    def __init__(
        self, world: World, window: Window, clock: Callable[[], float] = time.perf_counter,
        autosave: Autosave | None = None, shown: Callable[[World], None] | None = None,
    ) -> None:  # fmt: skip
        self.window = window
        self._shown = shown
        self._clock = clock
        self._watch: StepWatch
        self._autosave = autosave
        self._reported = False  # that the state cannot be kept
        self._rescued: tuple[World, float] | None = None
        self._stopped: tuple[object, ...] | None = None  # the state from which no step could be made
        self._rested = self._undrawn = 0.0  # how long nothing has moved, or was drawn [s]
        self._owed = 0.0  # time that is to be shown of steps that were made once [s]
        self._places = np.empty((0, 3))
        self._source = window.scenes.source
        self.world = world
        self.interface = Interface(window)
        window.framing.room, window.framing.small = self.interface.room, self.interface.small
        hud = Hud(window, self.interface)
        window.framing.above = hud.above
        self._events = WindowEvents(window, self.interface.take)
        self._systems = (
            InputSystem(pygame.event.get, self._events),
            RenderSystem(WorldView(window).draw),
            HudSystem(lambda: window.now, hud.readings, hud.draw),
        )
        self.show(world)
        if autosave is not None:
            autosave.finish(world)

    def show(self, world: World, history: History | None = None) -> None:
        """Show a world in place of the one that was shown, with nothing held and nothing begun.

        A world that was shown before comes with its history.
        """
        self.window.filming.end()
        is_again, self.window.scenes.starts_again = self.window.scenes.starts_again, False
        before = self.world if is_again and world is not self.world else None
        if not is_again and (is_in_space(world) or is_in_space(self.world)):
            self.window.grid = not is_in_space(world)
        self.world = world
        if self._shown is not None:
            self._shown(world)
        window = self.window
        window.dashboard.begin(world, before, is_new=history is None)
        if history is None:
            world.install(*self._systems)
        world.synchronise()  # what was done to make it is no edit
        self._watch = StepWatch(world)
        self.history = history or History(world)
        window.follow_history(self.history)
        window.sketch.cancel()
        window.sparks.clear()
        window.dust.clear()
        window.squash.clear()
        window.selection.clear()
        window.scenes.naming, window.picking, window.band, window.measuring = None, None, None, Measuring()
        window.handles, window.pins = Handles(), Pins()
        if not is_again:  # what was found of another scene is not for this one, nor is its speed
            window.pace.return_to_life()
            window.error_study.abandon()
            window.error_study.shown = False
        window.impacts.clear()
        self.interface.forget()
        window.microscope.forget()
        window.shows_stopwatch = bool(len(world.batch(Gate)))
        if world.desk is not None:
            restore_desk(window, world.desk)
        if not is_again and any(len(world.batch(kind)) for kind in (*INSTRUMENTS, Graph, Meter, Slider)):
            window.tool = SELECT.name  # a stray click is to make nothing in an experiment
        window.scenes.next_world = None
        window.framing.go_home(world)
        window.overlays.begin(world, window.camera)
        window.scenes.saved = Changes()
        window.trust.follow(world, window.now)  # before it is stepped: digits count from here

    def frame(self, elapsed: float) -> bool:
        """Do what the user asked for, advance the world and draw it, ``elapsed`` seconds after the last.

        While nothing in it moves it is drawn a few times a second; return whether it was.
        """
        lesson = self.window.lesson
        self.window.pace.measured = lesson is not None and lesson.running
        self.window.pace.begin(elapsed)
        if self.window.scenes.next_world is None:
            self._source = self.window.scenes.source  # another, once the scene was saved under another name
        self.world.frame(Stage.INPUT, elapsed)
        if self.window.scenes.next_world is not None:
            self._go_on_to(self.window.scenes.next_world)
        if self._stopped not in (None, self._moment):
            self.window.error, self._stopped = "", None
        self._advance()
        self.window.filming.advance(self.history)
        self._follow_entities()
        self._undrawn += elapsed
        drawn = not self._rests(elapsed) or self._undrawn > _REST_PERIOD
        if drawn:
            self._places = self._places_now()
            self.world.frame(Stage.RENDER, elapsed)
            self.window.filming.take(self.world, self.window.canvas, self.window.framing.room())
            self.world.frame(Stage.HUD, elapsed)
            self._undrawn = 0.0
        if self._autosave is not None:
            self._keep(self._autosave)
        return drawn

    @property
    def _moment(self) -> tuple[object, ...]:
        """The state that is shown: another after a step, an edit, or one taken back."""
        return self.world, self.world.time, self.world.motion_edits

    def _follow_entities(self) -> None:
        """Let go of what is not there any more: in the past steps make and remove bodies."""
        window, picking = self.window, self.window.picking
        window.selection.follow(self.world)
        if picking is not None and not self.world.has(picking.entity, picking.kind):
            window.picking = None

    def _rests(self, elapsed: float) -> bool:
        """Whether only the clock changes in the picture: for a while nothing has moved or was done."""
        window = self.window
        shown = window.notice or len(window.sparks) or len(window.dust) or window.works
        done = window.touched or window.hand.entity is not None
        still = not (shown or done) and np.array_equal(self._places, self._places_now())
        self._rested = self._rested + elapsed if still else 0.0
        return self._rested > _REST_AFTER and not self.interface.toolkit.unsettled

    def _places_now(self) -> NDArray[np.float64]:
        """Return where all bodies are, in parts of pixels too small to be seen."""
        transform = self.world.table(Transform)
        turned = np.column_stack((transform["position"], transform["angle"]))
        return np.round(turned * (_PARTS * self.window.camera.scale))

    def _go_on_to(self, world: World) -> None:
        """Show another world; the one that is left can be had back if there are unsaved edits in it."""
        window, back, lesson = self.window, self.window.scenes.left, self.window.lesson
        window.shows_cards &= window.scenes.starts_again  # they speak of the scene that is left
        window.hand.drop(self.world)
        window.edits.keep()
        if lesson is not None and lesson.world is world:
            window.scenes.source = None
            self.show(world)
            return
        left = Left(self.history, self._source, window.scenes.saved)
        if lesson is not None:
            left = lesson.before
            end_lesson(window, lesson)
            if left.history.world is world:
                self._show_again(left)
                return
        edited = left.is_edited
        window.scenes.left = left if edited else None
        if back is not None and back.history.world is world:
            self._show_again(back)
            return
        self.show(world)
        if edited:
            said = window.notice
            what = said if isinstance(said, Sentence) else Sentence(said)
            window.notify(
                Sentence("{what} - Ctrl+Z at its start brings back what was edited before", what=what), 6.0
            )

    def _show_again(self, left: Left) -> None:
        """Show a scene that was shown before, as it was."""
        self.show(left.history.world, left.history)
        self.window.scenes.source, self.window.scenes.saved = left.source, left.saved

    def is_still(self) -> bool:
        """Whether the next frame would show what this one does, unless the user does something."""
        window = self.window
        busy = window.works or window.pending or window.closing or window.scenes.next_world is not None
        busy = busy or self._events.waits
        return not (busy or window.is_moving(self.world) or self.interface.toolkit.unsettled)

    def _keep(self, autosave: Autosave) -> None:
        """Let the state be saved where that is due; say once where it cannot be."""
        autosave.advance(self.window.own.history.world)
        if autosave.failure and not self._reported:
            words = f"The state cannot be kept for the case of a crash: {autosave.failure}"
            self.window.notify(words, 8.0, failed=True)
        self._reported = bool(autosave.failure)

    def _advance(self) -> None:
        """Make the steps that are due.

        None is begun once they have taken as long as a frame may make up for: a world too heavy for the
        machine runs slowly, and the window stays awake.
        """
        window, dt = self.window, self.world.simulation.dt
        pace, microscope = window.pace, window.microscope
        worked = self._worked()  # other programs' share of the processor is no reason of this scene's
        deadline = self._clock() + pace.max_dt
        made, due = 0, pace.due(dt)
        if due and window.lesson is not None and window.lesson.waits:
            window.notify("First your prediction: lock it in, and the run is open")
            pace.halt()
            due = 0
        if due:
            self.window.edits.keep_for_run()  # no step is made with what is only shown
        try:
            while made < due and (made == 0 or self._clock() < deadline):
                logged, before = self.world.contacts.logged, self.world.time
                self._step(self._next_step(dt))
                made += 1
                if made < due and self.window.dashboard.graphs:
                    self.window.dashboard.follow(self.world, self.history)  # the last of them is the frame's
                if microscope.sees_impact(self.world, logged, before):
                    pace.halt()
                    self.history.divide()
                    break
                if window.lesson is not None and window.lesson.follow(self.world):
                    pace.halt()
                    break
        except Diverged as error:
            pace.halt()
            told = "Stopped: {why}. {rescue} Ctrl+Z takes back the last edit."
            self.window.error = Sentence(told, why=error.args[0], rescue=self._rescue())
            self._stopped = self._moment
        else:
            pace.done(made, dt)
            if made and (slow := self._watch.note(made, self._worked() - worked)):
                self.window.notify(Sentence("Slow: {what}", what=slow), 10.0, failed=True)
            if broken := self._watch.note_breaks():
                self.window.notify(broken, 6.0)
        microscope.follow(pace, self.world.time)

    def _worked(self) -> float:
        """Return how long this process has computed without compiling [s], from some time on."""
        return time.thread_time() - self.world.compile_s

    def _next_step(self, dt: float) -> float:
        """Return the length of a step [s]: a lesson's run ends when it says, at any speed."""
        lesson = self.window.lesson
        if lesson is not None and lesson.trial is not None and lesson.running:
            return lesson.trial.live.next_step
        return dt * self.window.pace.shortening

    def _step(self, dt: float) -> None:
        """Make a step; in the past the one that was made there once."""
        history = self.history
        if history.step_count < history.steps_range[1]:
            self._step_again(dt)
        else:
            self._owed = 0.0
            self._let_go_of_what_none_holds()
            self.window.hand.pull(self.world, dt)
            history.step(dt)

    def _step_again(self, dt: float) -> None:
        """Go on along the line by the steps that were made there, as far as ``dt`` [s] reaches.

        They are as long as they were: where time runs slowly now, a step is shown for several frames.
        """
        history, last = self.history, self.history.steps_range[1]
        self._owed = dt if self.window.pace.paused else self._owed + dt
        while self._owed > _PARTLY * dt and history.step_count < last:
            before = self.world.time
            history.seek(history.step_count + 1)
            self._owed -= self.world.time - before

    def _let_go_of_what_none_holds(self) -> None:
        """Let a body go that was in the hand at the place in the past from which time goes on now."""
        for entity in self.world.batch(Held).entities.tolist():
            if entity != self.window.hand.entity and self.history.entries:
                self.history.write(RemoveComponent(entity, Held.__name__))

    def _rescue(self) -> str:
        """Save the state before the step that failed, once, and return what to say of it."""
        if self._rescued == (self.world, self.world.time):
            return Sentence("The last good state is shown; it was saved before.")
        try:
            path = save_last_good(self.world, self.world.name, Path.cwd())
        except (OSError, SceneError) as error:
            return Sentence("The last good state is shown; it could not be saved: {why}.", why=error)
        self._rescued = self.world, self.world.time
        return Sentence("The last good state is shown, and saved as {file}.", file=path.name)
