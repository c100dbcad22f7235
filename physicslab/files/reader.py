"""From a scene document, the parsed JSON, to a world, with every check."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import esper

from physicslab.contacts.islands import restore_rests
from physicslab.contacts.memory import restore_contacts
from physicslab.ecs.component import Component, InvalidValue
from physicslab.ecs.config import MAX_TIME, MIN_TIME, PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.fields import COORDINATE_LIMIT, Field
from physicslab.files import checks
from physicslab.files.entities import check_contacts, check_entities, check_ids, check_joints, check_rests
from physicslab.files.numbers import check_numbers, renumbered, renumbered_islands, renumbered_rows
from physicslab.files.remainders import check_remainders
from physicslab.integrators import SPLIT_METHODS
from physicslab.kernels.solver.impulse import MAX_SUBSTEP_FACTOR
from physicslab.state.contents import LEVELS, SCENE_TEXTS, SHOWN, Desk, View
from physicslab.state.joint_rows import KINDS
from physicslab.state.remainders import Remainders
from physicslab.stepping.accounting import restore_joints
from physicslab.stepping.forces import MAX_STEPS
from physicslab.stepping.island import KeptIsland
from physicslab.systems.standard import standard_systems
from physicslab.world import World

FORMAT = "physicslab-scene/1"
"""The value of the key ``format`` of a scene."""

_MOST_STEPS = 2.0**48
"""Steps after which the clock still tells a sixteenth of a step from none."""

_DRIVEN = "[id, x, y, angle] or [id, x, y, angle, remainders of these]"

KEYS = (
    "format", "name", "title", "description", "view", "desk", "numbers", "time", "physics", "simulation",
    "entities", "contacts", "joints", "rests", "solver", "remainders", "islands",
)  # fmt: skip
"""The keys of a scene."""


@dataclass(frozen=True, slots=True)
class SceneDraft:
    """The checked content of a scene, of which a world can be made.

    Attributes
    ----------
    name, title, description : str
        Name, title and description of the scene.
    view : View, optional
        The part that a window shows at first.
    desk : Desk, optional
        The view beside that.
    time : float
        Where its clock stands [s].
    physics, simulation : PhysicsConfig, SimulationConfig
        The laws, and how they are stepped.
    entities : list of (str or None, list of Component)
        The id of each entity and its components. They refer to entities by place in this list, from 1.
    contacts : list of lists of numbers
        The contact solver's memory; the first two numbers of a row are entities, 0 for the bounds.
    joints : list of (int, str, list of float)
        Entity and kind of each joint, and its impulses in the last substep [N s].
    rests : list of lists of numbers
        Sleeping entities, one in a list; and how long [s] and how slowly [m/s] the others have rested.
    numbers : list of int
        Those of the entities, in order.
    remainders : dict of int to two lists of six numbers
        x, y, angle and their rates of entities, and the rounding remainder of each.
    solver : tuple of float, int and tuple
        The time over which the contacts' impulses act [s], the factor by which the coming step needs more
        substeps than configured, and what was chosen for an earlier state of motion, if anything was.
    islands : list of KeptIsland, optional
        The islands, where they are not those that are found first; their entities are places in the list.
    """

    name: str
    title: str
    description: str
    view: View | None
    desk: Desk | None
    time: float
    physics: PhysicsConfig
    simulation: SimulationConfig
    entities: list[tuple[str | None, list[Component]]]
    contacts: list[list[Any]]
    joints: list[tuple[int, str, list[float]]]
    rests: list[list[Any]]
    remainders: dict[int, tuple[list[float], list[float]]]
    numbers: list[int]
    solver: tuple[float, int, tuple[str, str, int] | None]
    islands: list[KeptIsland] | None


def read_scene(document: object, source: str = "scene") -> World:
    """Return the world that a scene document describes, with the systems that it needs.

    Parameters
    ----------
    document : dict
        A scene as ``json.loads`` gives it.
    source : str
        Name of the scene in messages: its path or name.

    Raises
    ------
    SceneError
        If anything in it is not allowed; esper's active world is then the one it was.

    Examples
    --------
    >>> world = read_scene({"format": FORMAT, "entities": [{"id": "ball", "Transform": {"angle": 1}}]})
    >>> world.entity("ball")
    1
    >>> read_scene({"format": FORMAT, "entities": [{"id": "b", "Transform": {"angle": "up"}}]})
    Traceback (most recent call last):
    ...
    physicslab.files.checks.SceneError: scene: entity "b": Transform.angle = "up": must be a finite number rad
    """
    draft = check_scene(document, source)
    before = esper.current_world
    world = World(*standard_systems(), physics=draft.physics, simulation=draft.simulation)
    world.name, world.title, world.description = draft.name, draft.title, draft.description
    world.view, world.desk, world.time = draft.view, draft.desk, draft.time
    for number, (id_, components) in zip(draft.numbers, draft.entities, strict=True):
        world.spawn(*components, name=id_, entity=number)  # by which springs name bodies that are yet to come
    world.islands.paused = True
    world.contacts.impulse_dt, world.contacts.substep_factor, chosen = draft.solver
    if any(type(part) in KINDS for _, parts in draft.entities for part in parts):
        _place_joints(world, source, before)
    if draft.contacts or draft.joints or draft.rests or chosen:
        world.synchronise()
        try:
            restore_contacts(world.contacts, draft.contacts)
        except (ValueError, OverflowError) as error:
            esper.switch_world(before)
            raise checks.SceneError(f"{source}: contacts: {error}") from error
        restore_joints(world, draft.joints)
        restore_rests(world, draft.rests)
    if draft.remainders:
        world.remainders = Remainders.of_bodies(draft.remainders)
    if chosen is not None:
        world.resume(*chosen)
    if draft.islands is not None:
        world.synchronise()
        world.islands.restore(world, draft.islands)
    world.islands.paused = False
    return world


def _place_joints(world: World, source: str, before: str) -> None:
    """Measure what joints leave as placed; raise a SceneError, in the world ``before``, if that cannot be."""
    try:
        world.synchronise()
    except InvalidValue as error:
        esper.switch_world(before)
        raise checks.SceneError(f"{source}: {error}") from error


def check_scene(document: object, source: str = "scene") -> SceneDraft:
    """Return the content of a scene document; the first thing not allowed is a :class:`SceneError`."""
    scene = checks.checked_object(document, source, 'an object {"format": ..., "entities": [...]}')
    checks.checked_keys(scene, f"{source}: ", "key", KEYS)
    if "format" not in scene:
        raise checks.SceneError(f"{source}: format is missing: must be {checks.shown(FORMAT)}")
    if scene["format"] != FORMAT:
        raise checks.refusal(f"{source}: format", scene["format"], checks.shown(FORMAT))
    if "entities" not in scene:
        raise checks.SceneError(f"{source}: entities is missing: must be a list of entities")
    ids = check_ids(scene["entities"], source)
    simulation = _config(SimulationConfig, scene.get("simulation", {}), source)
    entities = check_entities(scene["entities"], ids, source)
    numbers = check_numbers(scene.get("numbers", []), len(entities), source)
    draft = SceneDraft(
        **{key: checked_scene_text(key, scene.get(key, ""), f"{source}: ") for key in SCENE_TEXTS},
        view=_view(scene.get("view"), source),
        desk=_desk(scene["desk"], f"{source}: desk") if "desk" in scene else None,
        time=_time(scene.get("time", 0.0), simulation.dt, f"{source}: time"),
        physics=_config(PhysicsConfig, scene.get("physics", {}), source),
        simulation=simulation,
        entities=entities,
        contacts=check_contacts(scene.get("contacts", []), scene["entities"], ids, source),
        joints=check_joints(scene.get("joints", []), scene["entities"], ids, source),
        rests=check_rests(scene.get("rests", []), scene["entities"], ids, source),
        remainders=check_remainders(scene.get("remainders", []), entities, ids, source),
        numbers=numbers,
        solver=_solver(scene.get("solver", {}), simulation, f"{source}: solver"),
        islands=_islands(scene["islands"], ids, simulation, source) if "islands" in scene else None,
    )
    return _renumbered(draft) if "numbers" in scene else draft


def _renumbered(draft: SceneDraft) -> SceneDraft:
    """Return a draft whose entities refer to each other by their numbers, and no longer by their places."""
    numbers = draft.numbers
    return replace(
        draft,
        entities=[(id_, [renumbered(part, numbers) for part in parts]) for id_, parts in draft.entities],
        contacts=renumbered_rows(draft.contacts, numbers, ends=2),
        joints=[(numbers[place - 1], kind, impulses) for place, kind, impulses in draft.joints],
        rests=renumbered_rows(draft.rests, numbers),
        remainders={numbers[place - 1]: low for place, low in draft.remainders.items()},
        islands=None if draft.islands is None else renumbered_islands(draft.islands, numbers),
    )


def checked_scene_text(key: str, text: object, where: str) -> str:
    """Return a text of a scene, one of ``SCENE_TEXTS``, or raise a SceneError that begins with ``where``."""
    limit = SCENE_TEXTS[key]
    if limit is None:
        return checks.checked_text(text, f"{where}{key}", lines=True)
    return checks.checked_title(text, f"{where}{key}", limit)


def _view(value: object, source: str) -> View | None:
    """Return the part of the scene that a window shows at first [m]."""
    if value is None:
        return None
    try:
        view: View = Field("view", "box", unit="m", limit=COORDINATE_LIMIT).check(value)
    except InvalidValue as error:
        raise checks.refusal(f"{source}: view", value, error.allowed) from None
    return view


def _desk(value: object, where: str) -> Desk:
    """Return what a window shows beside the world."""
    found = checks.checked_object(value, where, 'an object {"level": ..., "shown": [...]}')
    checks.checked_keys(found, f"{where}: ", "key", ("level", "shown"))
    level, shown = found.get("level"), found.get("shown", [])
    if level not in LEVELS:
        raise checks.refusal(f"{where}.level", level, f"one of {', '.join(LEVELS)}")
    for place, part in checks.checked_rows(shown, f"{where}.shown", "a list of words"):
        if part not in SHOWN:
            raise checks.refusal(place, part, f"one of {', '.join(SHOWN)}")
    return Desk(str(level), frozenset(shown))


_SPAN = Field("span", "number", unit="s", minimum=MIN_TIME, maximum=MAX_TIME, owner="solver")
_FINER = Field("finer", "whole", minimum=1, maximum=MAX_SUBSTEP_FACTOR, owner="solver")


def _solver(
    value: Any, simulation: SimulationConfig, where: str
) -> tuple[float, int, tuple[str, str, int] | None]:
    """Return the values that the solver takes from the last step; those left out are as configured."""
    found = checks.checked_object(value, where, 'an object {"span": ..., "finer": ...}')
    checks.checked_keys(found, f"{where}: ", "key", ("span", "finer", "chosen"))
    return _solver_values(found, simulation, where)


def _solver_values(
    found: Mapping[str, Any], simulation: SimulationConfig, where: str
) -> tuple[float, int, tuple[str, str, int] | None]:
    """Return the values that a checked object has; those left out are as configured."""
    given: dict[str, Any] = {"span": simulation.dt / simulation.substeps, "finer": 1, **found}
    try:
        span, finer = float(_SPAN.check(given["span"])), int(_FINER.check(given["finer"]))
    except InvalidValue as error:
        raise checks.SceneError(f"{where.removesuffix('solver')}{error}") from error
    return span, finer, _chosen(found["chosen"], f"{where}.chosen") if "chosen" in found else None


def _islands(
    value: object, ids: Mapping[str, int], simulation: SimulationConfig, source: str
) -> list[KeptIsland]:
    """Return the islands, of which no two have a body in common."""
    islands: list[KeptIsland] = []
    seen: set[int] = set()
    for where, row in checks.checked_rows(value, f"{source}: islands", "a list of objects"):
        found = checks.checked_object(row, where, 'an object {"bodies": [...], "span": ..., "finer": ...}')
        checks.checked_keys(found, f"{where}: ", "key", ("bodies", "span", "finer", "chosen", "driven"))
        bodies: list[int] = []
        for place, body in checks.checked_rows(found.get("bodies"), f"{where}.bodies", "a list of ids"):
            number = ids.get(body, 0) if isinstance(body, str) else 0
            if not number or number in seen:
                raise checks.refusal(place, body, "the id of an entity that no other island has")
            seen.add(number)
            bodies.append(number)
        driven: list[list[float]] = []
        poses = checks.checked_rows(found.get("driven", []), f"{where}.driven", f"a list of {_DRIVEN}")
        for place, pose in poses:
            known = isinstance(pose, list) and len(pose) in (4, 7) and all(map(checks.is_number, pose[1:]))
            if not (known and isinstance(pose[0], str) and pose[0] in ids):
                raise checks.refusal(place, pose, f"{_DRIVEN}, an entity and three or six finite numbers")
            numbers = [*map(float, pose[1:]), 0.0, 0.0, 0.0][:6]
            if any(abs(low) > math.ulp(high) for high, low in zip(numbers[:3], numbers[3:], strict=True)):
                raise checks.refusal(place, pose, "remainders of at most the last digit of x, y and angle")
            driven.append([ids[pose[0]], *numbers])
        islands.append(KeptIsland(bodies, *_solver_values(found, simulation, where), driven))
    return islands


def _chosen(value: Any, where: str) -> tuple[str, str, int]:
    """Return how collisions were found, by which method bodies moved, and in how many steps."""
    allowed = f"[how collisions are found, a method, a whole number from 1 to {MAX_STEPS}]"
    if isinstance(value, list) and len(value) == 3:
        collisions, method, steps = value
        known = collisions in ("exact", "rigid", "step", "none") and isinstance(method, str)
        if known and method in SPLIT_METHODS and type(steps) is int and 1 <= steps <= MAX_STEPS:
            return collisions, method, steps
    raise checks.refusal(where, value, allowed)


def _time(value: Any, dt: float, where: str) -> float:
    """Return the time at which the clock stands: a step of ``dt`` [s] must move it on."""
    if not (checks.is_number(value) and value >= 0.0):
        raise checks.refusal(where, value, "a finite number >= 0 s")
    if value > _MOST_STEPS * dt:
        raise checks.refusal(where, value, f"at most {_MOST_STEPS * dt:g} s: a clock counts 2^48 steps of dt")
    return float(value)


def _config[C: (PhysicsConfig, SimulationConfig)](config: type[C], value: object, source: str) -> C:
    where = f"{source}: {config.section}"
    given = checks.checked_object(value, where, "an object of settings")
    checks.checked_keys(given, f"{where}.", "setting", field_names(config))
    checks.refuse_written(given, {spec.name: spec for spec in config.FIELDS}, f"{where}.")
    try:
        return config(**given)
    except InvalidValue as error:
        raise checks.refusal(f"{where}.{error.field}", error.value, error.allowed) from error
