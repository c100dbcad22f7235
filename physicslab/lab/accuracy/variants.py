"""Variants of a scene: the same laws from the same start, computed in another way.

The spread of where variants end is an estimate of the error. Runs that differ in their step alone share the
model of contacts, with its overlap and its softness, and the order in which contacts are solved: the errors
that these make do not show, so some of the variants differ in them.
"""

import copy
import math
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from physicslab.components import Gear, Shape
from physicslab.components.naming import name_by_kinds
from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.text import unique_name
from physicslab.files.reader import read_scene
from physicslab.integrators.dop853 import DOP853
from physicslab.state.joint_rows import KINDS
from physicslab.stepping.island import Part
from physicslab.stepping.method import tolerance_for
from physicslab.stepping.plan import StepPlan
from physicslab.world import World

type Document = dict[str, Any]
"""A scene as :func:`physicslab.files.writer.write_scene` returns it, in which every entity has an id."""

_PAST = ("contacts", "rests", "solver")
"""The keys of a scene that hold the steps before it; a mirrored or permuted one begins without."""
_MIRRORED: dict[str, tuple[str, ...]] = {
    name: tuple(
        spec.name
        for spec in COMPONENTS[name].FIELDS
        if spec.kind in ("vector", "points") or spec.unit in ("rad", "rad/s")
    )
    for name in (
        "Transform", "Velocity", "Mass", "Shape", "Material", "Spring", "Charge", "Molecule", "Medium",
        "Drag", "Trail", "Colour", "Layer", "MadeOf", *(kind.__name__ for kind in KINDS if kind is not Gear),
    )
} | {"Thrust": ("force", "torque", "at")}  # fmt: skip
"""Fields that a mirror changes; a scene with another component is not mirrored. The phase of a Thrust is no
angle in the plane."""
_RIGID_BUDGET_S = 10.0
"""Rigid contacts of many bodies, and of bodies that chatter, can take seconds a step."""
GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
"""By what factor steps are shorter that end at other moments: no two of both ever end together."""
_FINE = 8.0
"""How many times shorter steps are where half a step misses the events that a step does."""
_LEAST_TOLERANCE = 1e-20
"""From a scene's configuration."""
_ULP_SCALE = 1e-2
"""Coordinates [m], [m/s], [rad] smaller than this are moved by a rounding of this."""
NUDGES = 6
"""How many starts are moved by one rounding."""
NUDGE_SHARE = 0.5
"""A number is off by half a rounding where it is rounded, and these are moved by a whole one."""
ROUNDING = 2.0**-50
"""The smallest error of a result, as a share of its size: that of a few operations."""
_NUMBERS: dict[str, tuple[str, ...]] = {
    "Transform": ("position", "angle"),
    "Velocity": ("linear", "angular"),
    "Mass": ("mass",),
}
"""The numbers of a body that are moved."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One way to compute a scene differently.

    Attributes
    ----------
    name, what : str
        Its name, and how it differs.
    make : callable
        Takes the scene's document, which it leaves as it is, and a world made from it, ready to be stepped;
        returns the variant's world, or ``None`` where a scene has no such variant.
    mirrored : bool
        Whether its x coordinates and angles have the opposite sign.
    budget_s : float
        After how much time [s] it is given up.
    differs_in_step : bool
        Whether it is off by an error of the same kind, so that the difference may be less than either.
    """

    name: str
    what: str
    make: Callable[[Document, World], World | None]
    mirrored: bool = False
    budget_s: float = math.inf
    differs_in_step: bool = False


def with_ids(document: Document) -> Document:
    """Return a scene in which every entity has an id, so that its variants can be compared."""
    document = copy.deepcopy(document)
    taken = {entity["id"] for entity in document["entities"] if "id" in entity}
    for i, entity in enumerate(document["entities"], 1):
        if "id" not in entity:
            kinds = [COMPONENTS[name] for name in entity if name in COMPONENTS]
            shape = entity.get(Shape.__name__, {}).get("kind")
            entity["id"] = unique_name(name_by_kinds(i, kinds, shape), taken)
            taken.add(entity["id"])
    return document


def refined(document: Document, world: World, factor: float) -> World:
    """Return the scene with steps shorter by a factor, those of a method within its steps as well.

    A method that chooses its steps is allowed a tenth of the error: of order 8, it makes them shorter by a
    quarter then. Much less than rounding allows takes it for ever.

    Parameters
    ----------
    document : Document
        The scene.
    world : World
        Made from it, ready to be stepped: what ``auto`` chose for it holds for the other.
    factor : float
        Factor of the length of steps; 1 for another tolerance alone.
    """
    tolerance = max(_LEAST_TOLERANCE, 0.1 * tolerance_for(world, world.schedule.forces))
    variant = _with_settings(document, dt=world.simulation.dt / factor, tolerance=tolerance)
    variant.synchronise()
    # Else auto would make the same steps within a shorter one.
    own, others = _islands(world), _islands(variant)
    for part, other in zip(own, others, strict=True) if len(own) == len(others) else ():
        if part.plan.collisions != "exact":
            other.resume(*part.plan.kept)
    return variant


def _islands(world: World) -> list[Part]:
    """Return what advances a world, in the order of first bodies: itself, or its islands."""
    return [island.world for island in world.islands.members] or [world]


def _half(document: Document, world: World) -> World | None:
    return refined(document, world, 2.0) if not all(map(_follows_events, world.plans)) else None


def _fine(document: Document, world: World) -> World | None:
    """Return the scene in so short steps that an event which is missed by a step is missed by little."""
    return refined(document, world, _FINE) if any(map(_follows_events, world.plans)) else None


def _follows_events(plan: StepPlan) -> bool:
    """Whether contacts are rigid: the step goes from event to event, and half of it may meet the same."""
    return plan.collisions == "step" and plan.contacts == "rigid"


def _other(document: Document, world: World) -> World | None:
    """Return the scene with steps that end at other moments; none for a smooth method that chooses them."""
    if all(plan.smooth and plan.integrator.chooses_steps for plan in world.plans):
        return None
    return refined(document, world, GOLDEN)


def _tightest(document: Document, world: World) -> World | None:
    """Return the scene by the method that chooses its steps, where it goes by one of fixed steps."""
    smooth = all(plan.smooth for plan in world.plans)
    if not smooth or all(plan.integrator.chooses_steps for plan in world.plans):
        return None
    variant = _with_settings(document, integrator=DOP853.name, tolerance=SimulationConfig().tolerance)
    variant.synchronise()
    return None if variant.plan.refused else variant


def _with_settings(document: Document, **changes: Any) -> World:
    return read_scene(document | {"simulation": document["simulation"] | changes})


def _rigid(document: Document, world: World) -> World | None:
    """Return the scene with contacts that do not give way, where these can be had."""
    if not _gives_way(world):
        return None
    variant = _with_settings(document, contacts="rigid", collisions="auto", integrator="auto", sleeping=False)
    variant.synchronise()
    return variant if any(plan.contacts == "rigid" for plan in variant.plans) else None


def _gives_way(world: World) -> bool:
    """Whether any contacts may be soft."""
    return any(plan.collisions != "none" and plan.contacts == "soft" for plan in world.plans)


def _stiffer(document: Document, world: World) -> World | None:
    """Return the scene with harder contacts, at half the step: their stiffness goes by step and sweeps."""
    if not _gives_way(world):
        return None
    simulation = world.simulation
    sweeps = None if simulation.iterations is None else min(1000, 2 * simulation.iterations)
    return _with_settings(document, dt=0.5 * simulation.dt, iterations=sweeps)


def _mirror(document: Document, world: World) -> World | None:
    if any(set(entity) - {"id", "Name", *_MIRRORED} for entity in document["entities"]):
        return None
    mirrored = _without_past(document)
    for entity in mirrored["entities"]:
        for name in _MIRRORED.keys() & entity.keys():
            for field in _MIRRORED[name]:
                value = entity[name].get(field, _default(name, field))
                if value is not None:
                    entity[name][field] = _across(value)
        if "Pin" in entity:
            pin = entity["Pin"]
            pin["lower"], pin["upper"] = pin.get("upper"), pin.get("lower")
    physics = mirrored["physics"]
    for field in ("gravity", "electric_field", "magnetic_field"):  # the last one is an axis, as a spin is
        physics[field] = _across(physics[field])
    if physics["bounds"] is not None:
        left, low, right, high = physics["bounds"]
        physics["bounds"] = [-right, low, -left, high]
    return read_scene(mirrored)


def _default(component: str, name: str) -> list[float] | None:
    """Return a vector that a document leaves out and that a mirror changes, as the axis of a Slot."""
    default = next(spec.default for spec in COMPONENTS[component].FIELDS if spec.name == name)
    return list(default) if isinstance(default, tuple) and any(default) else None


def _across(value: Any) -> Any:
    """Return a number, a vector, or vertices in their order, with left and right exchanged."""
    if not isinstance(value, list):
        return -value
    if value and isinstance(value[0], list):
        return [_across(point) for point in reversed(value)]
    return [-value[0], value[1]] if value else value


def _permute(document: Document, world: World) -> World | None:
    if len(document["entities"]) < 2:
        return None
    permuted = _without_past(document)
    permuted["entities"].reverse()
    return read_scene(permuted)


def _without_past(document: Document) -> Document:
    return {key: copy.deepcopy(value) for key, value in document.items() if key not in _PAST}


def _nudge(document: Document, world: World) -> World | None:
    """Return the scene with places and velocities of bodies moved by one rounding, some up and some down."""
    variant = copy.deepcopy(document)
    ways = _alternating()
    for entity in variant["entities"]:
        if "Velocity" not in entity:
            continue
        turns = not entity.get("Mass", {}).get("fixed_rotation", False)
        speeds = ("linear", "angular") if turns else ("linear",)
        for name, fields in (("Transform", ("position", "angle")), ("Velocity", speeds)):
            part = entity.setdefault(name, {})
            for field in fields:
                value = part.get(field, 0.0 if field.startswith("ang") else [0.0, 0.0])
                part[field] = (
                    [_moved(v, ways) for v in value] if isinstance(value, list) else _moved(value, ways)
                )
    return read_scene(variant)


def _alternating() -> Iterator[float]:
    """Yield signs of which neither neighbours nor every second, third or sixth are all alike."""
    i = 0
    while True:
        i += 1
        yield 1.0 if (i * i // 3 + i) % 2 else -1.0


def _moved(value: float, ways: Iterator[float]) -> float:
    return value + next(ways) * math.ulp(max(abs(value), _ULP_SCALE))


def nudged(document: Document, seed: int) -> Document:
    """Return a scene whose numbers are moved by one rounding each, up or down.

    These are positions, velocities and masses of bodies that can move, and gravity. Zeros stay: they are
    not rounded, and with it a symmetry that no rounding breaks.
    """
    variant, order = copy.deepcopy(document), random.Random(seed)

    def move(part: dict[str, Any], *names: str) -> None:
        for name in names:
            value = part.get(name)
            if isinstance(value, list):
                part[name] = [_next(number, order) for number in value]
            elif value is not None:
                part[name] = _next(value, order)

    for entity in variant["entities"]:
        if "Velocity" in entity:
            for kind, names in _NUMBERS.items():
                move(entity.get(kind, {}), *names)
    move(variant.get("physics", {}), "gravity", "G")
    return variant


def _next(number: float, order: random.Random) -> float:
    """Return the next number up or down; of zero itself."""
    return math.nextafter(number, order.choice((-math.inf, math.inf))) if number else number


def _awake(document: Document, world: World) -> World | None:
    return _with_settings(document, sleeping=False) if world.sleep.on else None


VARIANTS: tuple[Variant, ...] = (
    Variant("other steps", "steps 0.618 times as long, which end at other moments", _other,
         differs_in_step=True),
    Variant("half step", "half the step, and a tenth of the tolerance", _half, differs_in_step=True),
    Variant("eighth of the step", "steps an eighth as long, where contacts are rigid", _fine,
         differs_in_step=True),
    Variant("tightest", f"{DOP853.name} with the tightest tolerance", _tightest),
    Variant("stiffer", "contacts four times as stiff, at half the step", _stiffer, differs_in_step=True),
    Variant("rigid",
            "contacts that do not give way: their laws solved to rounding, events at their own times",
            _rigid, budget_s=_RIGID_BUDGET_S),
    Variant("mirrored", "left and right exchanged", _mirror, mirrored=True),
    Variant("permuted", "entities in the opposite order", _permute),
    Variant("nudged", "the start moved by one rounding", _nudge),
    Variant("awake", "nothing falls asleep", _awake),
)  # fmt: skip
"""All of them. Another way to compute the same laws is added here, and nowhere else."""
