"""The time machine: one history of edits and runs, taken back and gone through, to the bit.

Every edit is a command (:mod:`physicslab.history.commands`), whichever tool makes it. The line of edits and
runs is data (:mod:`physicslab.history.line`). Between key frames (:mod:`physicslab.stepping.keyframe`), steps
are made again. A recording is a line in a file (:mod:`physicslab.history.recording`).
"""

from physicslab.history.branches import Branch
from physicslab.history.commands import (
    AddComponent,
    Command,
    Group,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    SetSimulation,
    SetText,
    Spawn,
)
from physicslab.history.history import Changes, History, HistoryEntry
from physicslab.history.replay import Played

__all__ = [
    "AddComponent", "Branch", "Changes", "Command", "Group", "History", "HistoryEntry", "Played", "Remove",
    "RemoveComponent", "SetField", "SetPhysics", "SetSimulation", "SetText", "Spawn",
]  # fmt: skip
