"""The contents of a scene: entities, the laws, how they are stepped, texts, and what is shown of them.

A scene is filled into them without any of the compiled steppers being imported.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.text import printable, shortened
from physicslab.state.entities import Entities

SCENE_TEXTS: Mapping[str, int | None] = {"name": 1_000, "title": 200, "description": None}
"""The texts of a scene, and the characters that those on one line may have."""
type View = tuple[float, float, float, float]
"""The part of a world that a window shows at first: xmin, ymin, xmax, ymax [m]."""
LEVELS = ("Explore", "Measure", "Engineer")
"""How much a window may show beside the world, the least first."""
SHOWN = (
    "arrows", "centres", "grid", "impacts", "impulses", "momenta", "panel", "parts", "stopwatch",
)  # fmt: skip
"""Things that a window may show beside that."""


@dataclass(frozen=True, slots=True)
class Desk:
    """The view of a scene beside the world: one of ``LEVELS``, and some of ``SHOWN``."""

    level: str
    shown: frozenset[str]


class Contents(Entities):
    """Entities, the laws, and what is said and shown of them.

    Attributes
    ----------
    name, title, description : str
        Name, title and description of the scene.
    view : View, optional
        The part that a window shows at first; all of it by default.
    desk : Desk, optional
        The view beside that; by default as the user has it.
    stale : bool
        Whether systems and steppers are to be chosen again before the next step.
    """

    __slots__ = ("_physics", "_simulation", "description", "desk", "name", "stale", "title", "view")

    def __init__(
        self, physics: PhysicsConfig | None = None, simulation: SimulationConfig | None = None
    ) -> None:
        self._physics = PhysicsConfig() if physics is None else _checked(physics, PhysicsConfig)
        self._simulation = (
            SimulationConfig() if simulation is None else _checked(simulation, SimulationConfig)
        )
        self.name: str = ""
        self.title: str = ""
        self.description: str = ""
        self.view: View | None = None
        self.desk: Desk | None = None
        self.stale = True
        super().__init__()

    @property
    def physics(self) -> PhysicsConfig:
        """The laws of this world."""
        return self._physics

    @physics.setter
    def physics(self, physics: PhysicsConfig) -> None:
        self._physics = _checked(physics, PhysicsConfig)
        self.stale = self.entity_index.motion_edited = True

    @property
    def simulation(self) -> SimulationConfig:
        """How this world is stepped."""
        return self._simulation

    @simulation.setter
    def simulation(self, simulation: SimulationConfig) -> None:
        self._simulation = _checked(simulation, SimulationConfig)
        self.stale = self.entity_index.motion_edited = True


def _checked[C: PhysicsConfig | SimulationConfig](value: C, kind: type[C]) -> C:
    """Return laws or settings; refuse what is none, as a dict of them."""
    if isinstance(value, kind):
        return value
    words = shortened(printable(repr(value)))
    raise TypeError(f"world.{kind.section} is a {kind.__name__}, not {words}: write {kind.__name__}(...)")
