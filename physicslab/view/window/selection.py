"""Which bodies are selected."""

from __future__ import annotations

from physicslab.world import World

__all__ = ["Selection"]


class Selection:
    """Entities that were clicked, the last one last.

    Attributes
    ----------
    entities : tuple of int
        Those that are selected.
    """

    def __init__(self) -> None:
        self.entities: tuple[int, ...] = ()

    def take(self, entity: int, *, add: bool = False) -> None:
        """Select an entity alone; or add it, or take it out where it was selected already."""
        if not add:
            self.entities = (entity,)
        elif entity in self.entities:
            self.entities = tuple(other for other in self.entities if other != entity)
        else:
            self.entities = (*self.entities, entity)

    def clear(self) -> None:
        """Select nothing."""
        self.entities = ()

    def follow(self, world: World) -> None:
        """Let go of entities that are not there any more."""
        if self.entities:
            living = set(world.entities())
            self.entities = tuple(entity for entity in self.entities if entity in living)
