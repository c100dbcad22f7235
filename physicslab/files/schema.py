"""The JSON Schema of scene files, made from the fields of components and settings.

Editors complete and check scenes by it. It says all that can be said of each value by itself: types, ranges,
words, keys. References to other entities are checked when a scene is opened.
"""

import math
from typing import Any

from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import REQUIRED, Field
from physicslab.files.entities import UNSAVED
from physicslab.files.reader import FORMAT, KEYS
from physicslab.state.contents import LEVELS, SCENE_TEXTS, SHOWN

type _Schema = dict[str, Any]

_NUMBER: _Schema = {"type": "number"}
_BOX: _Schema = {"type": "array", "items": _NUMBER, "minItems": 4, "maxItems": 4}


def scene_schema() -> _Schema:
    """Return the schema, of draft 2020-12."""
    known: dict[str, _Schema] = {
        "format": {"const": FORMAT},
        "view": {
            **_BOX,
            "type": ["array", "null"],
            "description": "what a window shows at first: xmin, ymin, xmax, ymax [m]",
        },
        "time": {"type": "number", "minimum": 0.0, "description": "where the clock stands [s]"},
        "desk": _object({"level": {"enum": list(LEVELS)}, "shown": _list({"enum": list(SHOWN)})}, ["level"]),
        "physics": _settings(PhysicsConfig),
        "simulation": _settings(SimulationConfig),
        "entities": _list({"$ref": "#/$defs/entity"}),
        "solver": {"type": "object"},
        **{key: _text(limit) for key, limit in SCENE_TEXTS.items()},
    }
    parts = {name: kind for name, kind in COMPONENTS.items() if kind not in UNSAVED}
    entity = {"id": {"type": "string"}, **{name: {"$ref": f"#/$defs/{name}"} for name in parts}}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"A scene of PhysicsLab, {FORMAT}",
        **_object({key: known.get(key, {"type": "array"}) for key in KEYS}, ["format", "entities"]),
        "$defs": {
            "entity": _object(entity),
            **{
                name: {"description": (kind.__doc__ or "").splitlines()[0], **_fields(kind.FIELDS)}
                for name, kind in parts.items()
            },
        },
    }


def _settings(config: type[PhysicsConfig] | type[SimulationConfig]) -> _Schema:
    return {**_fields(config.FIELDS), "description": (config.__doc__ or "").splitlines()[0]}


def _fields(specs: tuple[Field, ...]) -> _Schema:
    """Return the schema of a component or a section. A field of settings has its default in its record."""
    required = [spec.name for spec in specs if spec.default is REQUIRED]
    owner = specs[0].owner if specs else ""
    settings = owner in (PhysicsConfig.section, SimulationConfig.section)
    return _object({spec.name: _field(spec) for spec in specs}, [] if settings else required)


def _field(spec: Field) -> _Schema:
    unit = f" [{spec.unit}]" if spec.unit not in ("", "1") else ""
    found = {**_value(spec), "description": f"{spec.meaning}{unit}"}
    if spec.derived:
        found["description"] += f"; null: {spec.derived}"
        found["type"] = [found["type"], "null"]
    if spec.default is not REQUIRED and isinstance(spec.default, int | float | str):
        found["default"] = spec.default
    return found


def _value(spec: Field) -> _Schema:
    """Return what a field takes."""
    match spec.kind:
        case "choice":
            return {"enum": list(spec.choices)}
        case "flag":
            return {"enum": [True, False, *spec.choices]}
        case "entity":
            return {"type": ["string", "null"]}
        case "text":
            return {"type": "string", "maxLength": spec.longest}
        case "vector":
            return _point(spec)
        case "points":
            return _list(_point(spec))
        case "box":
            return _BOX
    bounds: _Schema = {"type": "integer" if spec.kind == "whole" else "number"}
    if spec.above > -math.inf:
        bounds["exclusiveMinimum"] = spec.above
    for name, value in (("minimum", spec.minimum), ("maximum", min(spec.maximum, spec.limit))):
        if abs(value) < math.inf:
            bounds[name] = value
    return bounds


def _point(spec: Field) -> _Schema:
    part = _NUMBER if spec.limit == math.inf else {**_NUMBER, "minimum": -spec.limit, "maximum": spec.limit}
    return {**_list(part), "minItems": 2, "maxItems": 2}


def _text(limit: int | None) -> _Schema:
    return {"type": "string"} if limit is None else {"type": "string", "maxLength": limit}


def _list(items: _Schema) -> _Schema:
    return {"type": "array", "items": items}


def _object(properties: dict[str, _Schema], required: list[str] | None = None) -> _Schema:
    found: _Schema = {"type": "object", "properties": properties, "additionalProperties": False}
    return {**found, "required": required} if required else found
