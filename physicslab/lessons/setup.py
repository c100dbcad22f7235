"""The scene of a lesson: a document with parameters, from which each case makes a world."""

from __future__ import annotations

import ast
import copy
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.ecs.quantity_text import Expression, InvalidText, Quantity, in_unit, is_known
from physicslab.ecs.text import suggestion
from physicslab.files.checks import SceneError
from physicslab.files.reader import read_scene
from physicslab.world import World

_SECTIONS = {config.section: config.FIELDS for config in (PhysicsConfig, SimulationConfig)}
_WORDS: dict[str, Any] = {"true": True, "false": False, "null": None}


@dataclass(frozen=True, slots=True)
class Case:
    """Changes to a scene: values of parameters, or of fields, by ``ID.Component.field``.

    Cases are equal whatever their note, and the line of the file where they stand.
    """

    text: str
    values: tuple[tuple[str, str], ...] = ()
    note: str = field(default="", compare=False)
    line: int = field(default=0, compare=False)


AS_IT_IS = Case("as it is")


class Parameters:
    """The values of a lesson's parameters: a scope in which expressions of them are evaluated."""

    def __init__(self, values: Mapping[str, Quantity]) -> None:
        self.values = values

    def named(self, name: str) -> Quantity | None:
        """Return the value of a parameter; refuse a name that is no unit either."""
        if name in self.values or "." in name or is_known(name):
            return self.values.get(name)
        if not self.values:
            raise InvalidText(f"'{name}' is no unit, and there are no parameters here")
        raise InvalidText(f"'{name}' is no unit and no parameter; must be one of {_listed(self.values)}")

    def called(self, name: str, arguments: list[ast.expr], whole: Expression) -> Quantity | None:
        """Return nothing: parameters know no functions of their own."""
        return None


@dataclass(frozen=True, slots=True)
class Setup:
    """A scene with parameters.

    Attributes
    ----------
    document : dict
        A scene; a text in the place of a number is an expression of parameters.
    source : str
        Its name in messages: file, line and block.
    parameters : dict of str to Expression
        Each may refer to those before it.
    notes : dict of str to str
        Their meaning in words.
    opened : dict of str to (str, str)
        Those that a learner may change, with the least and the greatest value.
    tools, shown : tuple of str
        Tools of the window that are open, and things that it shows beside the world.
    """

    document: dict[str, Any]
    source: str
    parameters: dict[str, Expression]
    notes: dict[str, str]
    opened: dict[str, tuple[str, str]]
    tools: tuple[str, ...] = ()
    shown: tuple[str, ...] = ()

    def quantity(self, name: str, text: str) -> float:
        """Return the value of a parameter that a text stands for [SI]."""
        found = self.values(Case(text, ((name, text),))).named(name)
        assert found is not None
        return found.value

    def fixed(self, case: Case) -> Setup:
        """Return the same scene with the fields of a case as its own."""
        document = copy.deepcopy(self.document)
        for path, text in case.values:
            self._set(document, path, text)
        return replace(self, document=document)

    def values(self, case: Case = AS_IT_IS) -> Parameters:
        """Return the parameters of a case; those that follow from others follow."""
        given = {name: Expression(text) for name, text in case.values if name in self.parameters}
        scope = Parameters(found := {})
        for name, expression in self.parameters.items():
            value = given.get(name, expression).value(scope)
            found[name] = _as_declared(value, expression, scope) if name in given else value
        return scope

    def world(self, case: Case = AS_IT_IS) -> World:
        """Return the world of a case.

        Raises
        ------
        SceneError
            If the case names nothing of the scene, or the scene cannot be.
        """
        fields = tuple(value for value in case.values if value[0] not in self.parameters)
        document = self.fixed(Case(case.text, fields)).document
        scope = self.values(case)
        for where, specs, values in _places(document):
            for spec in specs:
                if spec.name in values:
                    try:
                        values[spec.name] = _number(spec, values[spec.name], scope)
                    except InvalidText as error:
                        raise SceneError(f"{self.source}: {where}.{spec.name}: {error}") from error
        world = read_scene(document, self.source)
        world.time = 0.0  # runs begin there, whenever the scene was saved
        return world

    def _set(self, document: dict[str, Any], path: str, text: str) -> None:
        """Put a text in the place of a field; a component that the entity does not have is added."""
        parts = path.split(".")
        if len(parts) == 2 and parts[0] in _SECTIONS:
            document.setdefault(parts[0], {})[parts[1]] = _WORDS.get(text, text)
            return
        entities = {one["id"]: one for one in document["entities"] if "id" in one}
        if len(parts) != 3 or parts[0] not in entities:
            known = [*self.parameters, *entities]
            raise SceneError(
                f"{self.source}: {path} = {text}: must be a parameter ({_listed(self.parameters)}) or "
                f"ID.Component.field of {_listed(entities)}{suggestion(parts[0], known)}"
            )
        entities[parts[0]].setdefault(parts[1], {})[parts[2]] = _WORDS.get(text, _parts(text))


def _as_declared(value: Quantity, declared: Expression, scope: Parameters) -> Quantity:
    """Return a value in the unit of the declaration where it names none, and refuse another dimension."""
    usual = declared.value(scope)
    if not value.has_unit and usual.has_unit:
        return Quantity(value.value, usual.dimension, True)
    if value.dimension != usual.dimension:
        raise InvalidText(f"'{declared.text}' is its usual value: another unit does not fit")
    return value


def _places(document: dict[str, Any]) -> Iterable[tuple[str, tuple[Field, ...], dict[str, Any]]]:
    """Yield the objects of a scene that have fields with what they are called and the fields."""
    for section, fields in _SECTIONS.items():
        if isinstance(document.get(section), dict):
            yield section, fields, document[section]
    for number, entity in enumerate(document["entities"], start=1):
        for name, values in entity.items() if isinstance(entity, dict) else ():
            if name in COMPONENTS and isinstance(values, dict):
                yield f"entity {entity.get('id', number)}: {name}", COMPONENTS[name].FIELDS, values


def _number(spec: Field, value: Any, scope: Parameters) -> Any:
    """Return the number that a text in the place of one stands for."""
    if spec.kind not in ("number", "whole", "vector", "points", "box"):
        return value
    if isinstance(value, list):
        return [_number(spec, part, scope) for part in value]
    if not isinstance(value, str):
        return value
    number = in_unit(Expression(value).value(scope), spec.unit, value)
    return int(number) if spec.kind == "whole" and number.is_integer() else number


def _parts(text: str) -> str | list[str]:
    """Return the parts of ``[x, y]`` as texts; any other text as it is."""
    if not (text.startswith("[") and text.endswith("]")):
        return text
    return [part.strip() for part in re.split(r",(?![^(]*\))", text[1:-1])]


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "none"
