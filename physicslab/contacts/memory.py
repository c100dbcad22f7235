"""The memory of contacts from step to step, as rows of numbers that a file can hold."""

from collections.abc import Iterator, Sequence

from physicslab.contacts.report import ordered_records
from physicslab.kernels.events.events import DEEP
from physicslab.kernels.geometry.contact import AS_FOUND
from physicslab.kernels.records import MANIFOLD, POINT
from physicslab.kernels.wide.slots import COLOURS
from physicslab.kernels.wide_layout import WIDE
from physicslab.state.contacts import Contacts

_NO_ROWS = ("entity_a", "entity_b", "a", "b", "gap", "slot")
_KEPT = tuple(name for name in MANIFOLD.names or () if name not in _NO_ROWS)
_OF_BASE = ("base_x", "base_y", "base_angle_a", "base_angle_b", "base_sizes")
"""Fields of the pose in which points were found."""
_OF_POINT = tuple(name for name in POINT.names or () if name != "bend")
"""Fields of a point in a file; how a chain bends there is found again in each substep."""
_WARM = ("feature", "normal_impulse", "tangent_impulse")


def kept_rows(contacts: Contacts) -> Iterator[list[float] | None]:
    """Yield what the next step takes from the last one, as rows of numbers that JSON can hold.

    A row starts with the two entities (0 for the world's bounds) and the wall. Points that will be found
    again leave their features and impulses; those that will be kept, or that overlap deeply, everything;
    ``None`` is for a pair of which nothing is kept. A wide contact adds its slot, and the colour of its
    block; one that will have an impact in the next substep, which of its points do: 1, 2, or 3 for both.
    """
    for p in ordered_records(contacts):
        manifold = contacts.manifolds[p]
        pair = [int(manifold["entity_a"]), int(manifold["entity_b"]), int(manifold["wall"])]
        number = int(manifold["slot"])
        colours = contacts.wide.kinds[number % 2].colour
        slot = [number, int(colours[number // 2 // WIDE])] if number >= 0 else []
        if manifold["count"] <= 0:
            yield None
        elif manifold["found"] == 2 or _overlaps_deeply(contacts, p):
            kept = {name: manifold[name].item() for name in _KEPT[1:]}
            if manifold["found"] != 2:  # a file's next step finds all points again, whatever these are
                kept |= dict.fromkeys(_OF_BASE, 0.0) | {
                    "found": 0 if kept["found"] == AS_FOUND else kept["found"]
                }
            both = [contacts.points[j][name].item() for j in (2 * p, 2 * p + 1) for name in _OF_POINT]
            yield [*pair, *kept.values(), *both, *slot]
        else:
            warm = [contacts.points[j][name].item() for j in (2 * p, 2 * p + 1) for name in _WARM]
            ahead = int(contacts.points[2 * p]["ahead"] + 2 * contacts.points[2 * p + 1]["ahead"])
            rest = slot or ([ahead] if ahead else [])
            yield [*pair, *warm, *rest] if rest or any(warm[1:3] + warm[4:]) else None


def _overlaps_deeply(contacts: Contacts, p: int) -> bool:
    """Whether a pair overlaps so deeply that exact collisions leave its bodies to the contact step."""
    manifold = contacts.manifolds[p]
    separation = contacts.points["separation"][2 * p : 2 * p + int(manifold["count"])]
    return bool((separation < -DEEP * manifold["size"]).any())


def restore_contacts(contacts: Contacts, rows: Sequence[Sequence[float]]) -> None:
    """Restore what :func:`kept_rows` yielded of pairs of which something is kept.

    Raises
    ------
    ValueError
        If a row has not the right number of values.
    """
    contacts.make_room(max(64, len(rows)))
    light, heavy = 3 + 2 * len(_WARM), 2 + len(_KEPT) + 2 * len(_OF_POINT)
    ordered = sorted(rows, key=lambda row: tuple(row[:3]))
    for p, row in enumerate(ordered):
        if len(row) not in (light, heavy, light + 1, light + 2, heavy + 2):
            raise ValueError(f"a contact has {light} or {heavy} values, or two more, not {len(row)}")
        if len(row) == light + 1 and row[-1] not in (1, 2, 3):
            raise ValueError(f"points with an impact next: {row[-1]!r}: must be 1, 2 or 3")
        manifold = contacts.manifolds[p]
        named = len(row) in (light + 2, heavy + 2)
        manifold["slot"] = _take_slot(contacts, *row[-2:]) if named else -1
        manifold["entity_a"], manifold["entity_b"], manifold["wall"] = row[:3]
        if len(row) >= heavy:
            for name, value in zip(_KEPT[1:], row[3:], strict=False):
                manifold[name] = value
            values = iter(row[2 + len(_KEPT) :])
            names: Sequence[str] = _OF_POINT
        else:
            manifold["count"] = 1  # it had points: if it has none now, their impulses are dropped
            values, names = iter(row[3:]), _WARM
        for j in (2 * p, 2 * p + 1):
            for name in names:
                contacts.points[j][name] = next(values)
        if len(row) == light + 1:
            contacts.points["ahead"][2 * p : 2 * p + 2] = int(row[-1]) & 1, int(row[-1]) >> 1
    contacts.recorded, contacts.proximity_count, contacts.active = len(ordered), 0, 0
    contacts.stale = True


def _take_slot(contacts: Contacts, slot: float, colour: float) -> int:
    """Reserve the slot of a contact that will be found again, in a block of a colour."""
    if not (slot == int(slot) and slot >= 0):
        raise ValueError(f"a slot of {slot!r}: must be a whole number >= 0")
    if not (colour == int(colour) and 0 <= colour < COLOURS):
        raise ValueError(f"a colour of {colour!r}: must be a whole number from 0 to 63")
    constraints, block = contacts.wide.kinds[int(slot) % 2], int(slot) // 2 // WIDE
    if block > 2 * len(contacts.manifolds) + 1024:  # no world has so many: memory must not depend on a file
        return -1
    constraints.make_room(block + 1)
    constraints.colour[block] = int(colour)
    contacts.restoring = True
    return int(slot)
