"""Actions on graphs, meters and sliders: each is an edit, so that it is saved and undone."""

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from physicslab.components import Graph, GraphLine, Mass, Meter, Shape, Slider, Spring, Transform, Velocity
from physicslab.components.quantities import QUANTITIES
from physicslab.components.slider import GRAVITY, SLIDER_FIELDS
from physicslab.diagnostics.quantities import NOT_YET, why_undefined
from physicslab.ecs.component import Component
from physicslab.ecs.text import table_cell
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Command, Group, Remove, SetField, SetPhysics, Spawn
from physicslab.languages.sentence import Sentence
from physicslab.view.controls import actions, saving
from physicslab.view.controls.picking import body_at
from physicslab.view.window.dashboard import Dashboard, GraphShown, SliderShown
from physicslab.view.window.listening import tone
from physicslab.view.window.placing import refused_change
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.world import World

_ENERGIES = ("kinetic energy", "potential energy", "total energy")
_LIMIT = 8
"""Bodies that one graph begins with."""
_EACH = 4
"""Meters that are made at once."""
_GONE = "It was made later than the moment that is shown: go to the end of the time line to change it"
_IN_SPACE = (Shape, Transform)
"""Components of which a change may need room."""
_USUAL = {
    "Mass.mass": (0.1, 10.0), "Spring.stiffness": (0.0, 200.0), "Material.restitution": (0.0, 1.0),
}  # fmt: skip
"""Between which values a new slider goes, if the value that there is lies between them."""


def plot_selected(world: World, window: Window) -> None:
    """Plot the selection against time, of joints and springs their force; else what moves at the cursor.

    Without either, the world's energies are plotted.
    """
    bodies = window.selection.bodies(world)
    if not window.selection.entities and not window.pointer_on_panel:
        body = body_at(world, window.camera, window.pointer)
        bodies = [] if body is None or not world.has(body, Velocity) else [body]
    if not bodies:
        pulls = _pulls(world, window)
        energies: list[Key] = [(None, name) for name in _ENERGIES]
        _plot(window, "plotted forces" if pulls else "plotted energies", Graph(), pulls or energies)
        return
    names: tuple[str, ...] = ("x", "y")
    if len(bodies) > 1:
        names = ("speed",) if all(world.has(body, Velocity) for body in bodies) else ("y",)
    elif world.has(bodies[0], Velocity):
        names = ("x", "y", "speed")
    keys: list[Key] = [(body, name) for body in bodies[:_LIMIT] for name in names]
    _plot(window, f"plotted {_labels(world, bodies)}", Graph(), keys)


def plot_quantity(world: World, window: Window, name: str) -> None:
    """Plot a quantity against time: of all selected that has it, or else of the world."""
    quantity = QUANTITIES[name]
    chosen = window.selection.entities if quantity.of_entity else ()
    owners = [entity for entity in chosen if _has(world, name, entity)]
    keys: list[Key] = [(entity, name) for entity in owners[:_LIMIT]]
    if not keys and quantity.of_world:
        keys = [(None, name)]
    if keys:
        _plot(window, f"plotted {name}", Graph(), keys)
    else:
        match quantity.carrier:
            case "Spring":
                window.notify(f"Select a spring: {name} is of a spring")
            case "Transform":
                window.notify(f"Select a body that has it: {name} is of a body")
            case _:
                window.notify(f"Select a joint: {name} is of a joint")


def _pulls(world: World, window: Window) -> list[Key]:
    """Return the forces of the joints and springs that are selected."""
    return [
        (entity, name)
        for entity in window.selection.entities[:_LIMIT]
        for name in ("joint force", "spring force")
        if _has(world, name, entity)
    ]


def _has(world: World, name: str, entity: int) -> bool:
    return why_undefined(world, name, entity) in ("", NOT_YET)


def plot_phase(world: World, window: Window) -> None:
    """Plot the velocity of the selection against its place."""
    bodies = [body for body in window.selection.bodies(world) if world.has(body, Velocity)]
    if not bodies:
        window.notify("Select a body that moves: its velocity is plotted against its place")
        return
    body = bodies[-1]
    graph = Graph("x", body=body)
    what = Sentence("velocity of {body} against place", body=world.label(body))
    _plot(window, Sentence("plotted {what}", what=what), graph, [(body, "velocity x")])


def _plot(window: Window, words: str, graph: Graph, keys: Sequence[Key]) -> None:
    """Make a graph with its lines, in one edit."""
    entity = window.edits.history.next_entity
    lines = [Spawn([GraphLine(entity, name, body)]) for body, name in keys]
    window.edits.do(Group(words, [Spawn([graph]), *lines]))


def add_meter(world: World, window: Window) -> None:
    """Show the speed of each body that is selected in large figures, or the total energy of the world."""
    bodies = window.selection.bodies(world)[:_EACH]
    keys: list[Key] = [(body, "speed" if world.has(body, Velocity) else "y") for body in bodies]
    keys = keys or [(None, "total energy")]
    made = [Spawn([Meter(name, body)]) for body, name in keys]
    window.edits.do(Group(Sentence("made a meter: {what}", what=_labels(world, bodies)), made))


def add_slider(world: World, window: Window) -> None:
    """Make a slider for the selection: its mass or its stiffness; without one, for gravity."""
    for entity in window.selection.entities:
        for kind, changes in ((Spring, "Spring.stiffness"), (Mass, "Mass.mass")):
            if world.has(entity, kind):
                slider = Slider(changes, entity, *usual_range(world, changes, entity))
                what = Sentence("{quantity} of {body}", quantity=changes, body=world.label(entity))
                words = Sentence("made a slider: {what}", what=what)
                window.edits.do(Group(words, [Spawn([slider])]))
                return
    window.edits.do(Group("made a slider: gravity", [Spawn([Slider(GRAVITY)])]))


def usual_range(world: World, changes: str, entity: int | None) -> tuple[float, float]:
    """Return between which values a new slider goes, such that the present one is among them."""
    if changes == GRAVITY or entity is None:
        return 0.0, 20.0
    kind, spec = SLIDER_FIELDS[changes]
    now = float(getattr(world.component(entity, kind), spec.name))
    low, high = _USUAL.get(changes, (-10.0, 10.0))
    low, high = min(low, 2.0 * now), max(high, 2.0 * now)
    if spec.above > -math.inf:
        low = max(low, min(0.1, 0.1 * now))
    return max(low, spec.lowest), min(high, spec.highest)


def toggle_line(world: World, window: Window, graph: GraphShown, key: Key) -> None:
    """Draw a line in a graph, or take it away."""
    body, name = key
    there = [Remove(line.entity) for line in graph.lines if line.key == key]
    what = Sentence(name)
    if body is not None:
        what = Sentence("{quantity} of {body}", quantity=what, body=window.dashboard.label(body))
    if there:
        _do(world, window, graph.entity, Group(Sentence("took {what} from a graph", what=what), there))
    else:
        made = Spawn([GraphLine(graph.entity, name, body)])
        _do(world, window, graph.entity, Group(Sentence("plotted {what}", what=what), [made]))


def change(world: World, window: Window, entity: int, part: Component) -> None:
    """Give an instrument other fields."""
    _do(world, window, entity, AddComponent(entity, part))


def remove(world: World, window: Window, entity: int) -> None:
    """Remove a meter or a slider."""
    _do(world, window, entity, Remove(entity))


def close_graph(world: World, window: Window, graph: GraphShown) -> None:
    """Remove a graph with its lines."""
    lines = [Remove(line.entity) for line in graph.lines]
    _do(world, window, graph.entity, Group("closed a graph", [*lines, Remove(graph.entity)]))


def _do(world: World, window: Window, entity: int, command: Command) -> None:
    """Carry out an edit of an instrument, if it is there at the moment that is shown."""
    if entity not in world.entity_index.row_of:
        window.notify(_GONE, 6.0, failed=True)
        return
    window.edits.do(command)


def slide(world: World, window: Window, slider: SliderShown, value: float) -> None:
    """Give the number of a slider another value: all until it is let go is one edit, or a part of the run."""
    if not window.edits.held:
        window.edits.hold()
    command = _sliding(world, slider, value)
    if isinstance(command, str):
        window.notify(command, 6.0, failed=True)
    else:
        window.edits.do_all([command])


def _sliding(world: World, slider: SliderShown, value: float) -> Command | str:
    """Return the command that does so, or why there is none."""
    if slider.changes == GRAVITY:
        return SetPhysics({"gravity": Vector2(world.physics.gravity.x, -value)})
    kind, spec = SLIDER_FIELDS[slider.changes]
    if slider.target is None or slider.target not in world.entity_index.row_of:
        return "The entity of the slider was removed"
    if not world.has(slider.target, kind):
        return Sentence("{body} has no {part}", body=world.label(slider.target), part=Sentence(kind.__name__))
    refused = refused_change(world, slider.target, kind, spec.name, value) if kind in _IN_SPACE else ""
    return refused or SetField(slider.target, kind.__name__, spec.name, value)


def go_to(world: World, window: Window, time: float) -> None:
    """Pause, and go to the recorded moment nearest to a time [s]."""
    step = window.dashboard.step_at(time)
    if step is not None:
        actions.seek(world, window, step)


def save_table(world: World, window: Window, graph: GraphShown) -> None:
    """Write a graph to a new file where the program was started, as a table."""
    saving.save_table(world, window, "graph", partial(_rows, graph, window.dashboard))


def save_picture(world: World, window: Window, graph: GraphShown, content: bytes) -> None:
    """Write a picture of a graph to a new file where the program was started."""
    saving.save_new(world, window, "graph", ".png", content)


def _labels(world: World, bodies: Sequence[int]) -> str:
    if not bodies:
        return Sentence("total energy")
    return world.label(bodies[0]) if len(bodies) == 1 else Sentence("{n} bodies", n=len(bodies))


def _rows(graph: GraphShown, dashboard: Dashboard) -> Iterator[tuple[object, ...]]:
    """Yield the rows of what a graph shows: the time, then a column for each quantity, in full figures.

    Moments at which nothing of it was measured are left out.
    """
    record, keys = dashboard.record, list(dict.fromkeys(graph.keys))
    columns = np.array([record.values(key) for key in keys]).reshape(len(keys), len(record))
    yield "time [s]", *(_heading(key, dashboard) for key in keys)
    for n in np.flatnonzero(~np.isnan(columns).all(axis=0)).tolist():
        values = ("" if np.isnan(value) else value for value in columns[:, n].tolist())
        yield float(record.times[n]), *values


def _heading(key: Key, dashboard: Dashboard) -> str:
    body, name = key
    heading = f"{name} [{QUANTITIES[name].unit}]"
    return heading if body is None else table_cell(f"{dashboard.label(body)}: {heading}")


def listen(world: World, window: Window, key: Key) -> None:
    """Let a line of a graph be heard."""
    record = window.dashboard.record
    window.sounds.listen(tone(record.times, record.values(key)))
    if window.sounds.failure:
        window.notify(f"No sound: {window.sounds.failure}", 6.0, failed=True)
