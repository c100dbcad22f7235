"""The entities of a scene document, checked: their ids, their components and what refers to them.

Nothing here lists the fields of a component: names, types and ranges come from ``Component.FIELDS``, so a
new component is read, checked and refused like the others.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from physicslab.components import Gear, Held, Mass, Medium, Pin, Shape, Slot, Spring, Transform, Velocity
from physicslab.components.gear import COUPLED, why_not_coupled
from physicslab.components.joint_ends import key_of, why_not_joined
from physicslab.components.name import why_no_id
from physicslab.components.shape import STAYS
from physicslab.components.spring import OTHER_END
from physicslab.ecs.component import COMPONENTS, Component, Field, InvalidValue
from physicslab.ecs.text import suggestion
from physicslab.files import checks
from physicslab.state.attached import INSTRUMENTS
from physicslab.state.joint_rows import KINDS, kinds_of

UNSAVED: frozenset[type[Any]] = frozenset({Held})
"""Components that scene files do not hold: no hand reaches into a file."""

type _Expected = tuple[dict[str, Field], tuple[str, ...], str]
_NEED_TRANSFORM = (
    "Velocity", "Mass", "Shape", "Material", "Drag", "Thrust", "Charge", "Molecule", "Medium", "Trail",
    "Layer", "MadeOf", "Colour",
)  # fmt: skip
_PLACED = "the id of an entity with a Transform"
_MAY_REST = ("Velocity", "Mass", "Shape")


def check_ids(entities: object, source: str) -> dict[str, int]:
    """Return the place, from 1, of each entity that has an id; check that they are a list of objects."""
    if not isinstance(entities, list):
        raise checks.refusal(f"{source}: entities", entities, "a list of entities")
    ids: dict[str, int] = {}
    for number, entity in enumerate(entities, start=1):
        checks.checked_object(
            entity, _label(number, entity, source), 'an object {"id": ..., "Transform": ..., ...}'
        )
        if "id" not in entity:
            continue
        where = f"{source}: entity {number}: id"
        name = entity["id"]
        allowed = why_no_id(name)
        if allowed is not None:
            raise checks.refusal(where, name, allowed)
        if name in ids:
            raise checks.refusal(where, name, f"an id of its own; entity {ids[name]} has this one")
        ids[name] = number
    return ids


def check_entities(
    entities: Sequence[Mapping[str, Any]], ids: Mapping[str, int], source: str
) -> list[tuple[str | None, list[Component]]]:
    """Return each entity's id and components, in order; they refer to each other by place, from 1."""
    made: list[tuple[str | None, list[Component]]] = []
    joined: dict[type[Any], dict[Any, str]] = {}
    expected = {name: _expected(kind) for name, kind in COMPONENTS.items() if kind not in UNSAVED}
    known = ("id", *expected)
    for number, entity in enumerate(entities, start=1):
        where = _label(number, entity, source)
        checks.checked_keys(entity, f"{where}: ", "component", known)
        components = [
            _component(COMPONENTS[name], expected[name], values, ids, where)
            for name, values in entity.items()
            if name != "id"
        ]
        _check_together(components, entity, where)
        for component in components:
            _check_references(component, entities, where)
            if isinstance(component, Spring):
                _check_ends(component, number, entities, where)
            elif type(component) in KINDS:
                _check_joint(component, number, entities, where, joined.setdefault(type(component), {}))
        made.append((entity.get("id"), components))
    return made


def check_contacts(
    rows: object, entities: Sequence[Mapping[str, Any]], ids: Mapping[str, int], source: str
) -> list[list[Any]]:
    """Return the rows of the contact solver's memory with places, from 1, for ids, and 0 for the bounds."""
    mapped: list[list[Any]] = []
    for where, row in checks.checked_rows(rows, f"{source}: contacts", "a list of lists"):
        if not isinstance(row, list) or len(row) < 2:
            raise checks.refusal(where, row, "a list of two ids (null for the bounds) and numbers")
        pair: list[int] = []
        for place, name in enumerate(row[:2]):
            number = ids.get(name, 0) if isinstance(name, str) else 0
            if name is not None and (number == 0 or "Shape" not in entities[number - 1]):
                raise checks.refusal(
                    f"{where}[{place}]", name, "the id of an entity with a Shape, or null for the bounds"
                )
            pair.append(number)
        for place, value in enumerate(row[2:], start=2):
            if not checks.is_number(value):
                raise checks.refusal(f"{where}[{place}]", value, "a finite number")
        mapped.append([*pair, *row[2:]])
    return mapped


def check_joints(
    rows: object, entities: Sequence[Mapping[str, Any]], ids: Mapping[str, int], source: str
) -> list[tuple[int, str, list[float]]]:
    """Return of joints the places, from 1, for ids, their kinds, and their impulses [N s]."""
    mapped: list[tuple[int, str, list[float]]] = []
    kinds = [kind.__name__ for kind in KINDS]
    for where, row in checks.checked_rows(rows, f"{source}: joints", "a list of lists"):
        if not (isinstance(row, list) and len(row) > 2 and all(map(checks.is_number, row[2:]))):
            raise checks.refusal(where, row, "a list of an id, a kind of joint and numbers")
        number = ids.get(row[0], 0) if isinstance(row[0], str) else 0
        if row[1] not in kinds or not number or row[1] not in entities[number - 1]:
            allowed = f"the id of an entity with the kind of joint that follows it: {', '.join(kinds)}"
            raise checks.refusal(where, row, allowed)
        mapped.append((number, row[1], [float(value) for value in row[2:]]))
    return mapped


def check_rests(
    rows: object, entities: Sequence[Mapping[str, Any]], ids: Mapping[str, int], source: str
) -> list[list[Any]]:
    """Return which bodies sleep, and how long and how slowly others rest, with places, from 1, for ids."""
    mapped: list[list[Any]] = []
    seen: set[int] = set()
    for where, row in checks.checked_rows(rows, f"{source}: rests", "a list of lists"):
        if not isinstance(row, list) or len(row) not in (1, 3, 4):
            allowed = "an id for a sleeper, which a force of x and y N and a torque N m may follow; "
            raise checks.refusal(where, row, allowed + "or an id, a time s and a speed m/s; in a list")
        number = ids.get(row[0], 0) if isinstance(row[0], str) else 0
        if not number or not all(name in entities[number - 1] for name in _MAY_REST):
            allowed = "the id of an entity with " + ", ".join(_MAY_REST)
            raise checks.refusal(f"{where}[0]", row[0], allowed)
        if number in seen:
            raise checks.refusal(f"{where}[0]", row[0], "an id that has no rest yet")
        seen.add(number)
        if len(row) == 3 and not (checks.is_number(row[1]) and row[1] > 0.0):
            raise checks.refusal(f"{where}[1]", row[1], "a finite number > 0 s")
        if len(row) == 3 and not (checks.is_number(row[2]) and row[2] >= 0.0):
            raise checks.refusal(f"{where}[2]", row[2], "a finite number >= 0 m/s")
        if len(row) == 4 and not all(map(checks.is_number, row[1:])):
            raise checks.refusal(where, row, "an id and three finite numbers N, N and N m")
        mapped.append([number, *row[1:]])
    return mapped


def _label(number: int, entity: object, source: str) -> str:
    name = entity.get("id") if isinstance(entity, dict) else None
    return f"{source}: entity {checks.shown(name) if isinstance(name, str) else number}"


def _expected(kind: type[Component]) -> _Expected:
    """Return a component's fields by name, the names of entities, and what it must look like."""
    fields = {spec.name: spec for spec in kind.FIELDS}
    ends = tuple(spec.name for spec in kind.FIELDS if spec.kind == "entity")
    return fields, ends, "an object {" + ", ".join(f'"{name}": ...' for name in fields) + "}"


def _component(
    kind: type[Component], expected: _Expected, value: object, ids: Mapping[str, int], where: str
) -> Component:
    place = f"{where}: {kind.__name__}"
    fields, ends, allowed = expected
    given = checks.checked_object(value, place, allowed)
    checks.checked_keys(given, f"{place}.", "field", tuple(fields))
    checks.refuse_written(given, fields, f"{place}.")
    values = dict(given) if ends else given
    for name in ends:
        if given.get(name) is not None:
            values = {**values, name: _entity_of(given[name], ids, f"{place}.{name}")}
    try:
        return kind(**values)
    except InvalidValue as error:
        raise checks.refusal(
            f"{where}: {error.component}.{error.field}", error.value, error.allowed
        ) from error
    except TypeError as error:  # a field without default was left out
        raise checks.SceneError(f"{where}: {error}") from error


def _entity_of(name: object, ids: Mapping[str, int], where: str) -> int:
    if isinstance(name, str) and name in ids:
        return ids[name]
    likely = suggestion(name, ids) if isinstance(name, str) else ""
    raise checks.refusal(where, name, f"the id of an entity in this scene, or null{likely}")


def _check_together(components: Sequence[Component], entity: Mapping[str, Any], where: str) -> None:
    """Check what concerns several components."""
    for name in _NEED_TRANSFORM:
        if name in entity and Transform.__name__ not in entity:
            raise checks.SceneError(
                f"{where}: {name} = {checks.shown(entity[name])}: must have a Transform beside it"
            )
    of: dict[type[Any], Any] = {type(component): component for component in components}
    if Medium in of and (Shape not in of or of[Shape].kind == "chain" or Velocity in of):
        allowed = "with a Shape that is no chain, and without a Velocity: a medium stays where it is"
        raise checks.refusal(f"{where}: Medium", entity[Medium.__name__], allowed)
    if Mass in of and Shape in of:
        _check_inertia(of[Mass], of[Shape], where)
    if Velocity in of and Shape in of and of[Shape].kind == "chain":
        raise checks.refusal(f"{where}: Shape.kind", "chain", STAYS)
    fixed = Mass in of and of[Mass].fixed_rotation
    if fixed and Velocity in of and of[Velocity].angular != 0.0:
        angular = of[Velocity].angular
        raise checks.refusal(
            f"{where}: Velocity.angular", angular, "0 rad/s where Mass.fixed_rotation is true"
        )


def _check_inertia(mass: Mass, shape: Shape, where: str) -> None:
    """Refuse a body so large and heavy that its moment of inertia is not finite, by its largest size."""
    if mass.is_given("inertia"):
        return
    sizes = {name: getattr(shape, name) for name in shape.HAS[shape.kind]}
    if sizes.pop("vertices", None) is not None:
        sizes["reach"] = shape.reach
    largest = max(sizes, key=lambda name: sizes[name])
    if not math.isfinite(mass.mass * sum(size * size for size in sizes.values())):
        allowed = f"smaller: the moment of inertia is not finite with Mass.mass = {mass.mass:g} kg"
        name = "vertices, which reach" if largest == "reach" else largest
        raise checks.refusal(f"{where}: Shape.{name}", sizes[largest], allowed)


def _check_references(component: Component, entities: Sequence[Mapping[str, Any]], where: str) -> None:
    """Refuse to refer to an entity that has not what is needed: a point of an instrument needs a place."""
    references = component.references()
    if isinstance(component, INSTRUMENTS):
        references = {f"{name}_body": "Transform" for name in component.POINTS}
    elif type(component) in KINDS and not isinstance(component, Gear):
        references = {"a": "Transform", "b": "Transform"}
    for name, needed in references.items():
        other = getattr(component, name)
        if other is not None and not any(kind in entities[other - 1] for kind in kinds_of(needed)):
            place = f"{where}: {type(component).__name__}.{name}"
            raise checks.refusal(place, entities[other - 1].get("id"), f"the id of an entity with a {needed}")


def _check_joint(
    joint: Any, number: int, entities: Sequence[Mapping[str, Any]], where: str,
    joined: dict[Any, str],
) -> None:  # fmt: skip
    """Refuse a joint whose ends are not two points, or are those of another of its kind."""
    kind = type(joint).__name__
    if isinstance(joint, Gear):
        _check_gear(joint, number, entities, where, joined)
        return
    carrier = number if "Transform" in entities[number - 1] else 0
    ends = (joint.a or carrier, joint.anchor_a), (joint.b or 0, joint.anchor_b)
    refused = why_not_joined(*ends, joined)
    if refused is not None:
        value = entities[joint.b - 1].get("id") if joint.b else None
        raise checks.refusal(f"{where}: {kind}.{refused[0]}", value, refused[1])
    joined[key_of(*ends)] = str(entities[number - 1].get("id", f"entity {number}"))


def _check_gear(
    gear: Gear, number: int, entities: Sequence[Mapping[str, Any]], where: str,
    joined: dict[Any, str],
) -> None:  # fmt: skip
    """Refuse a gear that couples no two joints, or those of another."""
    ends = gear.first or 0, gear.second or 0
    refused = why_not_coupled(
        *ends, lambda end: sum(kind.__name__ in entities[end - 1] for kind in (Pin, Slot)), joined
    )
    if refused is not None:
        name, end, allowed = refused
        allowed = f"the id of {COUPLED}" if allowed == COUPLED else allowed
        raise checks.refusal(f"{where}: Gear.{name}", entities[end - 1].get("id"), allowed)
    joined[frozenset(ends)] = str(entities[number - 1].get("id", f"entity {number}"))


def _check_ends(spring: Spring, number: int, entities: Sequence[Mapping[str, Any]], where: str) -> None:
    for name, given in (("a", spring.a), ("b", spring.b)):
        end = given or (number if name == "a" else None)
        if end is not None and "Transform" not in entities[end - 1]:
            value = entities[end - 1].get("id") if given else None
            raise checks.refusal(f"{where}: Spring.{name}", value, _PLACED)
    if spring.b == (spring.a or number):
        raise checks.refusal(f"{where}: Spring.b", entities[spring.b - 1].get("id"), OTHER_END)
