"""A lesson that is being made of the scene: what is chosen for it, and what cannot be so."""

from dataclasses import dataclass, field

from physicslab.lessons.writer import Draft
from physicslab.view.window.naming import Naming
from physicslab.view.window.sharing import FROM_START


@dataclass(slots=True)
class Making:
    """A teacher's choices for a lesson of the scene.

    Attributes
    ----------
    choosing : bool
        Whether the panel is shown in which it is chosen.
    naming : Naming
        The name of its file, and why it could not be written.
    draft : Draft
        The choices.
    begins : str
        ``FROM_START``, ``FROM_EDIT`` or ``FROM_NOW``: of which moment its scene is.
    quantity, reading : str
        The quantity, as ``ball.x``, and its measure in a run: the last value, the greatest, ...
    refused : dict of (str, str) to str
        Why no lesson could be made, by the kind of block and the key that cannot be so.
    """

    choosing: bool = False
    naming: Naming = field(default_factory=Naming)
    draft: Draft = field(default_factory=lambda: Draft(""))
    begins: str = FROM_START
    quantity: str = ""
    reading: str = ""
    refused: dict[tuple[str, str], str] = field(default_factory=dict)
