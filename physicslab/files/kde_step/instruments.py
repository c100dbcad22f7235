"""Step's notes, graphs, meters, controllers and tracers as those of the workbench."""

from collections.abc import Callable, Mapping
from html.parser import HTMLParser

from physicslab.components import Note
from physicslab.components.graph import TIME
from physicslab.components.quantities import why_not_of
from physicslab.components.slider import GRAVITY, SLIDER_FIELDS
from physicslab.ecs.text import is_line
from physicslab.files.kde_step.draft import Draft
from physicslab.files.kde_step.item import Item

_TRACE_S = 60.0
"""How far back a tracer goes [s]; Step's go back to the beginning."""
_NOTE = {spec.name: spec for spec in Note.FIELDS}["text"]
_QUANTITIES = {
    "time": (TIME,),
    "position": ("x", "y"),
    "velocity": ("velocity x", "velocity y"),
    "acceleration": ("acceleration x", "acceleration y"),
    "force": ("force x", "force y"),
    "momentum": ("momentum x", "momentum y"),
    "angle": ("angle",),
    "angularVelocity": ("angular velocity",),
    "angularMomentum": ("angular momentum",),
    "kineticEnergy": ("kinetic energy",),
}
"""Properties of bodies, and of the world its time: the quantities of their parts."""
_FIELDS = {
    "mass": "Mass.mass",
    "radius": "Shape.radius",
    "angle": "Transform.angle",
    "angularVelocity": "Velocity.angular",
    "restLength": "Spring.rest_length",
    "stiffness": "Spring.stiffness",
    "damping": "Spring.damping",
    "charge": "Charge.charge",
    "torqueValue": "Thrust.torque",
}
"""Properties that a slider changes."""
_BREAKS = ("p", "br", "li", "div", "h1", "h2", "h3", "h4")
_HIDDEN = ("head", "style", "script", "title")


class _Plain(HTMLParser):
    """Collects the text of a page, a line for each of its paragraphs."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = [""]
        self._hidden = 0

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self._hidden += tag in _HIDDEN
        if tag in _BREAKS and self.lines[-1]:
            self.lines.append("")

    def handle_endtag(self, tag: str) -> None:
        self._hidden = max(self._hidden - (tag in _HIDDEN), 0)

    def handle_data(self, data: str) -> None:
        if not self._hidden:
            self.lines[-1] += data


def plain_text(html: str) -> str:
    r"""Return the text of a note, which Step keeps as a page of HTML, in lines that can be shown.

    >>> plain_text("<head><style>p {}</style></head><body><p>One <b>two</b></p><p>three</p></body>")
    'One two\nthree'
    """
    page = _Plain()
    page.feed(html)
    page.close()
    shown = ("".join(c if is_line(c) else " " for c in line) for line in page.lines)
    return "\n".join(filter(None, (" ".join(line.split()) for line in shown)))


def take_note(item: Item, draft: Draft) -> None:
    """Take a note; one that is too long is cut, and stands whole in the description of the scene."""
    text = plain_text(item.text("text"))
    if not text:
        return
    lines = text.splitlines()
    shown = "\n".join(lines[: _NOTE.lines])
    if len(lines) > _NOTE.lines or len(shown) > _NOTE.longest:
        shown = shown[: _NOTE.longest - 4].rstrip() + " ..."
        draft.texts.append(text)
    place = item.pair("position")
    draft.points.append(place)
    draft.place(item, {"Note": {"text": shown, "place": list(place)}})
    for part in item.items:
        draft.lose(part, "a note is text alone")


def take_graph(item: Item, draft: Draft) -> None:
    """Take a graph of one line."""
    across, up = _quantity(item, draft, "X"), _quantity(item, draft, "Y")
    if across is None or up is None:
        return
    if up[0] == TIME:
        draft.lose(item, "there is no graph of the time against something")
        return
    graph = draft.place(item, {"Graph": {"across": across[0], "body": across[1]}})
    draft.place(item, {"GraphLine": {"graph": graph["id"], "quantity": up[0], "body": up[1]}})


def take_meter(item: Item, draft: Draft) -> None:
    """Take a meter."""
    found = _quantity(item, draft, "")
    if found is not None and found[0] == TIME:
        draft.lose(item, "the time is always shown")
    elif found is not None:
        draft.place(item, {"Meter": {"quantity": found[0], "body": found[1]}})


def take_controller(item: Item, draft: Draft) -> None:
    """Take a controller as a slider, with the part of its range that the field allows."""
    entity, name = draft.placed.get(item.whole("object", 0)), item.text("property").strip()
    low, high = item.pair("limits")
    if name == "weightConst" and "gravity" in draft.physics:
        draft.place(item, {"Slider": {"changes": GRAVITY, "low": low, "high": high}})
        return
    changes = _FIELDS.get(name, "")
    if entity is None or changes not in SLIDER_FIELDS or changes.partition(".")[0] not in entity:
        draft.lose(item, f"no slider changes {name or 'nothing'}")
        return
    spec = SLIDER_FIELDS[changes][1]
    ends = max(low, spec.lowest), min(high, spec.highest)
    if ends[0] >= ends[1]:
        draft.lose(item, f"{changes} is never within {low:g} to {high:g}")
        return
    if ends != (low, high):
        draft.lose(item, f"its ends are {ends[0]:g} and {ends[1]:g}, as {changes} is {spec.allowed}")
    slider = {"changes": changes, "entity": entity["id"], "low": ends[0], "high": ends[1]}
    draft.place(item, {"Slider": slider})


def take_tracer(item: Item, draft: Draft) -> None:
    """Take a tracer as the trail of its body."""
    body = draft.end(item, "body")
    if body is None or not body.moves:
        draft.lose(item, "it traces a point that does not move")
    elif item.pair("localPosition") != (0.0, 0.0):
        draft.lose(item, "a trail is that of the centre of a body")
    else:
        body.entity["Trail"] = {"length": _TRACE_S}


INSTRUMENTS: Mapping[str, Callable[[Item, Draft], None]] = {
    "Note": take_note,
    "Graph": take_graph,
    "Meter": take_meter,
    "Controller": take_controller,
    "Tracer": take_tracer,
}
"""The classes of what shows and changes things."""


def _quantity(item: Item, draft: Draft, axis: str) -> tuple[str, str | None] | None:
    """Return a quantity and its body, ``None`` for the world's; nothing, and named, where there is none."""
    number, index = item.whole(f"object{axis}", 0), item.whole(f"index{axis}", -1)
    name = item.text(f"property{axis}").strip()
    body = draft.bodies.get(number)
    parts = _QUANTITIES.get(name, ())
    part = index if len(parts) > 1 else 0
    if 0 <= part < len(parts) and (body is not None or number == draft.world):
        quantity = parts[part]
        known = why_not_of(quantity, None if body is None else number) is None
        if body is None if quantity == TIME else known:
            return quantity, None if body is None else body.id
    draft.lose(item, f"{name or 'nothing'} of item {number} is not measured")
    return None
