"""A Step file as a world, with what of it a scene has no place for."""

from collections.abc import Iterator

from physicslab.files.checks import SceneError, refusal, shown
from physicslab.files.kde_step.bodies import BODIES, give_points_extent
from physicslab.files.kde_step.couplings import COUPLINGS, HOLDS, LENNARD_JONES, take_molecules
from physicslab.files.kde_step.draft import Draft
from physicslab.files.kde_step.instruments import INSTRUMENTS
from physicslab.files.kde_step.item import Item
from physicslab.files.kde_step.notes import make_room_for_notes
from physicslab.files.kde_step.xml import parse_xml
from physicslab.files.reader import FORMAT, read_scene
from physicslab.world import World

_GROUPS = ("ItemGroup", "Gas", "SoftBody")
"""Classes of items that hold others."""
_MARGIN = 0.2
"""Space around what should be seen at first, as a share of its extent."""
_CAD = b"ISO-10303-21"
"""The beginning of a file of another format with this ending."""


def read_step(content: bytes, source: str, name: str, losses: list[str]) -> World:
    """Return the world that a Step file describes.

    Parameters
    ----------
    content : bytes
        The file.
    source : str
        Its name in messages: its path.
    name : str
        Name of the scene.
    losses : list of str
        Gets what of the file has no place in a scene, a line each; the description of the scene has them too.

    Raises
    ------
    SceneError
        If it is not a world of Step, or a value in it is not allowed; one line: what, the line and why.
    """
    draft = _draft(content, source)
    losses += draft.losses
    document = {
        "format": FORMAT, "name": name, "title": name, "description": _description(draft),
        "time": draft.time, "physics": draft.physics, "entities": draft.entities, "view": _view(draft),
    }  # fmt: skip
    try:
        return read_scene(document, source)
    except SceneError as error:
        words = str(error)
        lines = (n for id_, n in draft.lines.items() if words.startswith(f"{source}: entity {shown(id_)}:"))
        line = next(lines, None)
        raise SceneError(words if line is None else f"{words} (line {line})") from error


def _draft(content: bytes, source: str) -> Draft:
    """Return the scene that a Step file describes."""
    if content.lstrip().startswith(_CAD):
        raise SceneError(f"{source}: is a model of CAD (ISO 10303), not a world of KDE Step")
    root = parse_xml(content, source)
    if root.tag != "world":
        raise refusal(
            f"{source}: line {root.line}: the root element", root.tag, '"world", as KDE Step has it'
        )
    world = Item(root, source)
    draft = Draft(world.number)
    items = list(_all(world))
    _check_numbers(items, draft.world)
    known = (*_GROUPS, *BODIES, *HOLDS, *COUPLINGS, LENNARD_JONES, *INSTRUMENTS)
    for item in items:
        if item.kind not in known:
            draft.lose(item, f"there is no {shown(item.kind)}")
    for table in (BODIES, HOLDS, COUPLINGS, INSTRUMENTS):
        for item in items:
            if item.kind in table:
                table[item.kind](item, draft)
    for group in (world, *(item for item in items if item.kind in _GROUPS)):
        take_molecules(group, draft)
    give_points_extent(draft)
    make_room_for_notes(draft)
    _lose_settings(world, draft)
    draft.time = max(world.number_of("time", 0.0), 0.0)
    return draft


def _all(group: Item) -> Iterator[Item]:
    """Yield the items of a group, and of the groups in it."""
    for item in group.items:
        yield item
        if item.kind in _GROUPS:
            yield from _all(item)


def _check_numbers(items: list[Item], world: int) -> None:
    seen = {world}
    for item in items:
        if item.number in seen:
            raise refusal(f"{item.where}: id", item.number, "a number that no other item has")
        seen.add(item.number)


def _lose_settings(world: Item, draft: Draft) -> None:
    """Name what the world has, and no scene."""
    scale = world.number_of("timeScale", 1.0)
    if scale != 1.0:
        draft.losses.append(f"timeScale {scale:g}: the window chooses how fast time goes")
    if world.flag("errorsCalculation"):
        draft.losses.append("errorsCalculation: variances are not taken; --trust says how many digits hold")


def _description(draft: Draft) -> str:
    """Return the notes that were cut, and what is not taken."""
    losses = ["Not taken from the Step file:", *draft.losses] if draft.losses else []
    return "\n".join([*draft.texts, *losses])


def _view(draft: Draft) -> list[float] | None:
    """Return the part of the world to be seen at first [m]; ``None`` if nothing is in it."""
    if draft.extent is None:
        return None
    left, low, right, high = draft.extent
    margin = _MARGIN * max(right - left, high - low) or 1.0
    return [left - margin, low - margin, right + margin, high + margin]
