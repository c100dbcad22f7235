"""The keys that a person has chosen in place of the usual ones."""

from dataclasses import dataclass, field


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
