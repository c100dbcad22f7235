"""Figures of a world for people: its energy, its impacts, its motion in a run."""

from collections.abc import Callable
from importlib import import_module
from types import FunctionType
from typing import TYPE_CHECKING, Any, Never, cast

from numpy.typing import NDArray

from physicslab.ecs.config import PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.text import no_such
from physicslab.state.account import Energy, Momentum
from physicslab.state.run import Run
from physicslab.state.state import State


def _measuring(part: str) -> Any:
    """Return a module of what measures worlds, which stands above them."""
    return import_module(f"physicslab.diagnostics.{part}")


class Facade(State):
    """A state with the measurements of it."""

    __slots__ = ()

    def __init_subclass__(cls) -> None:
        """Name what is inherited as the class's own: Python's refusals of arguments say it to people."""
        for name in _SHOWN:
            if isinstance(method := getattr(cls, name), FunctionType):
                method.__qualname__ = f"{cls.__qualname__}.{name}"

    def __repr__(self) -> str:
        title = self.title or self.name or "without a title"
        return f"<World {title!r}: entities: {len(self.entities())}, t = {self.time:g} s>"

    def __reduce__(self) -> tuple[Any, ...]:
        # The contents of a scene file go to another process; the layer that writes files is above this one.
        scene = import_module("physicslab.files.scene")
        return scene.load_scene, (scene.write_scene(self),)

    @property
    def energy(self) -> Energy:
        """The energy as it is now: ``.kinetic``, ``.potential`` by force, ``.total`` [J]."""
        return cast(Energy, _measuring("energy").measure_energy(self))

    @property
    def momentum(self) -> Momentum:
        """The momentum as it is now: ``.linear`` [kg m/s], ``.angular`` about the origin [kg m^2/s]."""
        return cast(Momentum, _measuring("energy").measure_momentum(self))

    @property
    def impacts(self) -> dict[str, NDArray[Any]]:
        """The last impacts in the order of time, by columns: ``time``, ``a``, ``b``, ``energy_lost`` [J], ...

        Those of contacts that are found within steps are there where the run was recorded.
        """
        return cast(
            dict[str, NDArray[Any]], _measuring("impact_table").impact_table(self, self.contacts.impacts)
        )

    if not TYPE_CHECKING:  # type checkers know the attributes

        def __getattr__(self, name: str) -> object:
            if name[:1] == "_" or hasattr(type(self), name):
                return super().__getattribute__(name)
            parts = (*field_names(PhysicsConfig), *field_names(SimulationConfig))
            raise AttributeError(no_such(type(self).__name__, "attribute", name, _SHOWN, parts), name=None)

    def describe(self, language: str = "en") -> str:
        """Return in words what there is, where it is and how it moves, a sentence a line.

        ``language`` is a code as ``"de"``.
        """
        return cast(str, _measuring("description").describe(self, language))

    def record(
        self, seconds: float, *wrong: Never, every: float | None = None, until: str | None = None
    ) -> Run:
        """Advance like :meth:`run`, with the same bits, and return what happened as columns.

        Parameters
        ----------
        seconds : float
            How long [s], at most.
        every : float, optional
            Time between two instants [s], up to whole steps; every step where it is not given.
        until : str, optional
            A condition at which it ends, of what graphs and lessons show: ``"ball.x >= 8 m"``,
            ``"time > 1 s and world.kinetic < 2 J"``. It is looked at after each step; the moment at which it
            begins to hold is then found to rounding, and the world stands there.

        Raises
        ------
        Diverged
            As :meth:`run` does.
        InvalidValue
            If ``until`` is no condition of this world.
        """
        if wrong:
            raise TypeError(f"record: give every=... or until=... by name, not {wrong[0]!r}")
        return cast(Run, _measuring("recorder").record(self, seconds, every, until))

    def _repr_html_(self) -> str:
        """Return a picture of now for a notebook: the page of a run of one instant, in a frame."""
        made = import_module("physicslab.export.page").page_of([self], self.title or self.name)
        return cast(str, import_module("physicslab.export.notebook").frame(made))

    def __dir__(self) -> list[str]:
        """Return what a person may want; all else is there, and belongs to the machine."""
        return sorted(_SHOWN)


_SHOWN = (
    "add", "clear", "component", "components", "copy", "describe", "description", "discard", "energy",
    "entities", "entity", "has", "impacts", "label", "mark", "momentum", "name", "physics", "plan", "record",
    "remove", "reset", "run", "schedule", "simulation", "spawn", "step", "stepping", "steps", "time", "title",
)  # fmt: skip


def _measured(name: str) -> Callable[[Facade, object], Never]:
    """Return what refuses to write a figure that is measured."""

    def refuse(world: Facade, value: object) -> Never:
        raise AttributeError(
            f"world.{name} is measured and cannot be set; the bodies have it, by Transform, Velocity and Mass"
        )

    return refuse


for _name in ("energy", "momentum", "impacts"):
    setattr(Facade, _name, vars(Facade)[_name].setter(_measured(_name)))
