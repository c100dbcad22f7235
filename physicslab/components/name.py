"""What an entity is called."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Name:
    """The id of an entity in scene files and reports. A plain esper component: words have no column."""

    id: str
