"""Actions on the history: switch branches, save all of it in a file."""

from pathlib import Path

from physicslab.ecs.text import printable
from physicslab.files.scene import SceneError, file_stem
from physicslab.history import Branch
from physicslab.view.controls.file_actions import new_paths
from physicslab.view.window.window import Window
from physicslab.world import World

ENDING = ".replay"
"""The suffix of recordings: they are not offered as scenes."""
_WORDS_LIMIT = 2
"""How much of what was done in a branch is written out."""


def branch_words(branch: Branch, start: float) -> str:
    """Return what was done in a branch, and when it leaves the line that is shown; ``start`` [s] is its."""
    words = branch.words
    more = len(words) - _WORDS_LIMIT
    shown = ", then ".join(words[:_WORDS_LIMIT]) + (f", and {more} more" if more > 0 else "")
    return f"At {start + branch.seconds:.2f} s: {shown}"


def switch(world: World, window: Window, branch: Branch) -> None:
    """Go on along a branch, where it leaves the line that was gone along: that is a branch from now on."""
    history = window.edits.history
    if branch not in history.branches:  # clicked before the line changed
        return
    window.pause_for_history(world)
    history.switch(branch)
    window.notify("Another branch: Space plays it, Ctrl+B goes back", 5.0)


def next_branch(world: World, window: Window) -> None:
    """Go on along the branch that was left first; one after the other, all come round."""
    branches = window.edits.history.branches
    if branches:
        switch(world, window, branches[0])
    else:
        window.notify("There is no other branch: a change in the past begins one")


def save_recording(world: World, window: Window) -> None:
    """Keep what was done as a file that ``physicslab replay`` plays, where the program was started."""
    window.hand.drop(world)
    window.edits.take_back_shown()
    paths = new_paths(Path.cwd(), file_stem(world.name), ENDING)
    try:
        path = next(path for path in paths if not path.exists())
        window.edits.history.save(path)
    except (SceneError, OSError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or error
        window.notify(f"The recording could not be saved: {reason}", 6.0, failed=True)
    else:
        window.notify(f"Saved {printable(path.name)}: physicslab replay plays it", 5.0)
