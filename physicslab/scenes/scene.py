"""The record of a built-in scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.state.contents import Contents, View

if TYPE_CHECKING:
    from physicslab.world import World


def _nothing(contents: Contents) -> None:
    """Spawn nothing."""


@dataclass(frozen=True, slots=True)
class Scene:
    """A built-in scene: what it is called, and the laws in it; it decorates the function that fills it.

    Attributes
    ----------
    title, description : str
        A heading, and one line on what there is to see.
    view : tuple of four floats, optional
        The part that a window shows: xmin, ymin, xmax, ymax [m], with room for 10 s of motion; by default
        all that there is at the start.
    moment : float
        The time at which a small picture shows what it is about [s].
    teaches : tuple of str
        Subjects that it is an example of, by which it is found too.
    tags : tuple of str
        Its contents, by which it is found: as :func:`physicslab.view.workbench.thumbnails.tags_of` finds.
    also : str
        Further words by which it is searched.
    physics, simulation : PhysicsConfig, SimulationConfig
        The laws, and how they are stepped.
    fill : callable
        Spawns everything in the contents that it is given, those of a world or alone.
    """

    title: str
    description: str
    view: View | None = None
    moment: float = 0.6
    teaches: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    also: str = ""
    physics: PhysicsConfig = field(default_factory=PhysicsConfig)
    simulation: SimulationConfig = field(default_factory=SimulationConfig)
    fill: Callable[[Contents], None] = _nothing

    def __call__(self, fill: Callable[[Contents], None]) -> Scene:
        """Return the scene that a function fills."""
        return replace(self, fill=fill)

    @property
    def name(self) -> str:
        """The name for the command line: that of the function."""
        return self.fill.__name__

    @property
    def search_words(self) -> tuple[str, ...]:
        """Words that find it beside its title and description."""
        return self.name, *self.teaches, *self.tags, self.also

    def contents(self) -> Contents:
        """Return what a new world of this scene holds, without all that steps it."""
        contents = Contents(self.physics, self.simulation)
        self._put_into(contents)
        return contents

    def build(self) -> World:
        """Return a new world of this scene, the same each time."""
        from physicslab.world import World  # with all of the compiled steppers

        world = World(physics=self.physics, simulation=self.simulation)
        self._put_into(world)
        return world

    def _put_into(self, contents: Contents) -> None:
        contents.name, contents.title, contents.description = self.name, self.title, self.description
        contents.view = self.view
        self.fill(contents)
