"""Results of a run: the document of ``run --json`` and the summary for the terminal."""

import dataclasses
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from physicslab.components import Transform, Velocity
from physicslab.components.quantities import MOMENTUM_CAUSES
from physicslab.contacts.report import count_near_pairs, list_contacts
from physicslab.diagnostics.energy import ACCOUNT_WORDS, Audit, flows, measure_momentum, summation
from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.warnings import ModelWarning, WorstWarnings
from physicslab.ecs.text import printable, unique_name
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import coded
from physicslab.stepping.partition import MAX_BODIES
from physicslab.stepping.stepper import Advancer
from physicslab.systems.breaking import breaks_of
from physicslab.world import World

_MOMENTA: dict[str, float | Vector2] = dict.fromkeys(MOMENTUM_CAUSES, math.nan)
"""In the order of the document; a cause whose momentum is not measured by itself stays without a number."""


@dataclass(slots=True)
class RunRecord:
    """Measurements taken while a world runs.

    Attributes
    ----------
    scene : str
        Name of the scene.
    audit : Audit
        Changes of the energy since the start, and its largest error.
    steps : int
        Steps done.
    wall_s : float
        Seconds of stepping, without compiling and without measuring.
    interpreted_steps : int
        Steps in which kernels ran as plain Python, as they were not compiled: these take longer.
    interpreted_s : float
        Seconds that those kernels took, within ``wall_s``.
    max_penetration : float
        The deepest overlap after any step [m].
    divided : int
        The largest number of parts that a step was divided into.
    warnings : WorstWarnings
        The worst warning of each kind.
    """

    scene: str
    audit: Audit
    steps: int = 0
    wall_s: float = 0.0
    interpreted_steps: int = 0
    interpreted_s: float = 0.0
    max_penetration: float = 0.0
    divided: int = 1
    warnings: WorstWarnings = field(default_factory=WorstWarnings)


def body_names(world: World) -> dict[int, str]:
    """Name every entity with a Transform, in order, by its id, or what it is and its number; no two alike."""
    names: dict[int, str] = {}
    taken: set[str] = set()
    for entity in world.batch(Transform).entities.tolist():
        names[entity] = unique_name(world.label(entity), taken)
        taken.add(names[entity])
    return names


def advice_of(warnings: Iterable[ModelWarning]) -> list[dict[str, Any]]:
    """Return warnings as a report has them; entities have names there, and no numbers."""
    found = [dataclasses.asdict(warning) for warning in warnings]
    return [{key: value for key, value in each.items() if key != "number"} for each in found]


def run_report(world: World, record: RunRecord) -> dict[str, Any]:
    """Return the document of a run, as the contract of ``run --json`` has it; SI units."""
    world.synchronise()
    momentum, most = measure_momentum(world), world.parts[0]
    stepper: Advancer = world.islands if world.islands.members else world.steppers.main(world)
    # A system that ran and is not needed any more is not among those left out; one that is needed stands
    # among the systems, with no call where a closed form does its work.
    running = {system.name for system in world.schedule.running}
    timings = {
        name: timing for name, timing in world.schedule.timings.items() if timing.calls or name in running
    }
    return {
        "scene": record.scene,
        "time": world.time,
        "steps": record.steps,
        "dt": world.simulation.dt,
        "substeps": world.simulation.substeps,
        "integrator": most.plan.integrator.name,
        "integrator_reason": most.plan.reason,
        "collision_method": most.plan.collisions,
        "collision_reason": most.plan.collision_reason,
        "contact_model": _contact_model(most),
        "contact_reason": most.plan.contact_reason,
        "summation": summation(world),
        "interpreted": list(world.schedule.interpreted),
        "force_evaluations": world.force_evaluations,
        "wall_s": record.wall_s,
        "compile_s": world.compile_s,
        "interpreted_steps": record.interpreted_steps,
        "interpreted_s": record.interpreted_s,
        "stepper": {"name": stepper.name, "reason": stepper.reason},
        "reason_codes": {
            name: coded(words)
            for name, words in (
                ("integrator", most.plan.reason),
                ("collision", most.plan.collision_reason),
                ("contact", most.plan.contact_reason),
                ("stepper", stepper.reason),
            )
        },
        "steppers_left_out": [{"name": left.name, "reason": left.reason} for left in most.steppers.left_out],
        "islands": [_island(world, part) for part in world.parts],
        "islands_reason": world.islands.reason if world.islands.members else world.islands.why_one,
        "systems": [
            {"name": name, "calls": timing.calls, "ms": timing.ms} for name, timing in timings.items()
        ],
        "left_out": [
            {"name": left.name, "reason": left.reason, **coded(left.reason)}
            for left in world.schedule.left_out
            if left.name not in timings
        ],
        "energy": _energy(record.audit),
        "account": _account(record.audit.account.energy),
        "momentum_account": _account({**_MOMENTA, **record.audit.account.momentum}),
        "angular_momentum_account": _account({**_MOMENTA, **record.audit.account.angular_momentum}),
        "momentum": list(momentum.linear),
        "angular_momentum": momentum.angular,
        "candidate_pairs": count_near_pairs(world),
        "contacts": int(world.contacts.count),
        "asleep": world.sleep.count,
        "contact_forces": _contact_forces(world),
        "collisions": int(world.collisions),
        "max_penetration": record.max_penetration,
        "divided": record.divided,
        "advice": advice_of(record.warnings.all),
        "advice_codes": [coded(warning.what) for warning in record.warnings.all],
        **_joints(world),
        "entities": _bodies(world),
    }


def _account(booked: Mapping[str, float | Vector2]) -> dict[str, Any]:
    """Return the contribution of each cause; ``None`` if it was not measured, or is no number."""

    def shown(value: float) -> float | None:
        return value if math.isfinite(value) else None

    return {
        name: [shown(part) for part in value] if isinstance(value, Vector2) else shown(value)
        for name, value in booked.items()
    }


def _energy(audit: Audit) -> dict[str, Any]:
    now = audit.latest
    potential = {"gravity": 0.0, "spring": 0.0} | now.potential
    return {
        "initial": audit.initial,
        "final": audit.account.now.energy,
        "kinetic_linear": now.kinetic_linear,
        "kinetic_angular": now.kinetic_angular,
        **{f"potential_{name}": stored for name, stored in potential.items()},
        "exchanged": audit.exchanged,
        "max_relative_drift": audit.error,
        "max_relative_change": audit.change,
        "changed_by": list(audit.causes),
    }


def _contact_model(world: World) -> str:
    return "none" if world.plan.collisions == "none" else world.plan.contacts


def _island(world: World, part: World) -> dict[str, Any]:
    """Return what advances some bodies, and why: their names, or of more than a few their number."""
    bodies = part.entity_index.entities[part.bodies.inverse_mass > 0.0].tolist()
    stepper = part.steppers.main(part)
    return {
        "bodies": [world.label(body) for body in bodies] if len(bodies) <= MAX_BODIES else len(bodies),
        "stepper": stepper.name,
        "method": part.plan.integrator.name,
        "contact_model": _contact_model(part),
        "reason": stepper.reason,
    }


def _contact_forces(world: World) -> list[dict[str, Any]]:
    """Return the forces of the contacts that press: on B, along the normal from A and across [N]."""
    names, forces = body_names(world), []
    for contact in list_contacts(world):
        normal = sum(point.normal_force for point in contact.points)
        if normal > 0.0:
            tangent = sum(point.tangent_force for point in contact.points)
            forces.append(
                {
                    "a": names.get(contact.a, "bounds"),
                    "b": names.get(contact.b, "bounds"),
                    "normal": list(contact.normal),
                    "normal_force": normal,
                    "tangent_force": tangent,
                }
            )
    return forces


def _joints(world: World) -> dict[str, Any]:
    """Return of each joint force [N] and torque [N m] on B, and the error left [m, rad]; and which broke."""
    joints, broken = joint_states(world), breaks_of(world.schedule.systems, world.time)
    if not joints and not broken:
        return {}
    found = {}
    for joint in joints:
        name, (x, y) = world.label(joint.entity), joint.force
        found[name] = {
            "kind": joint.kind.__name__,
            "force": [x, y],
            "torque": joint.torque,
            "stretch": joint.stretch,
            "largest_stretch": joint.largest_stretch,
            "twist": joint.twist,
        }
    gone = [one._asdict() for one in broken]
    return {"joints": found} | ({"broken": gone} if gone else {})


def _energy_words(report: Mapping[str, Any]) -> list[str]:
    """Return where the energy went, and how large the error of it is: a line each."""
    energy, account = report["energy"], report["account"]
    moved = [(name, account[name]) for name in energy["changed_by"]]
    words = [
        f"{ACCOUNT_WORDS[name]} {'gave' if value > 0.0 else 'took'} {abs(value):.6g} J"
        for name, value in flows({name: value for name, value in moved if value is not None})
    ]
    error = "not a number" if account["numerical"] is None else f"{account['numerical']:.3g} J"
    share = f"at most {energy['max_relative_drift']:.3g} of the energy exchanged"
    return [
        f"  energy      {energy['initial']:.9g} J before, {energy['final']:.9g} J after; "
        f"{', '.join(words) or 'nothing gave or took any'}",
        f"  error       {error} of energy by the method; {share}",
    ]


def _bodies(world: World) -> dict[str, dict[str, Any]]:
    transform, velocity, rows = world.table(Transform), world.table(Velocity), world.batch(Transform).rows
    columns = zip(
        transform["position"][rows].tolist(), transform["angle"][rows].tolist(),
        velocity["linear"][rows].tolist(), velocity["angular"][rows].tolist(), strict=True,
    )  # fmt: skip
    keys = ("position", "angle", "linear", "angular")
    return {
        name: dict(zip(keys, values, strict=True))
        for name, values in zip(body_names(world).values(), columns, strict=True)
    }


def find_not_finite(report: object, place: str = "") -> str | None:
    """Return where in a report there is a number that is not finite, or ``None``.

    >>> find_not_finite({"energy": {"initial": 1.0, "final": float("nan")}})
    'energy.final'
    """
    if isinstance(report, float):
        return None if math.isfinite(report) else place
    items: Iterator[tuple[object, object]] = iter(())
    if isinstance(report, dict):
        items = iter(report.items())
    elif isinstance(report, list):
        items = iter(enumerate(report))
    places = (find_not_finite(value, f"{place}.{key}" if place else str(key)) for key, value in items)
    return next((found for found in places if found is not None), None)


def run_summary(report: Mapping[str, Any], title: str, start: float = 0.0) -> str:
    """Return a summary of a run that began at ``start`` [s], on a few lines."""
    momentum, began = report["momentum"], f"{start:.9g} s to " if start else ""
    wall = report["wall_s"]
    systems = ", ".join(f"{system['name']} {system['ms']:.1f} ms" for system in report["systems"])
    lines = [
        f"{report['scene']}: {printable(title)}" if title else str(report["scene"]),
        f"  time        {began}{report['time']:.9g} s in {report['steps']} steps of {report['dt']:.6g} s, "
        f"{report['substeps']} substeps each",
        f"  method      {report['integrator']}: {report['integrator_reason']}; "
        f"{report['force_evaluations']} force evaluations",
        f"  collisions  {report['collision_method']}: {report['collision_reason']}",
        f"  took        {wall:.3g} s, and {report['compile_s']:.3g} s to compile or load kernels",
        *_energy_words(report),
        f"  momentum    [{momentum[0]:.6g}, {momentum[1]:.6g}] kg m/s, "
        f"angular {report['angular_momentum']:.6g} kg m^2/s",
        f"  contacts    {report['contacts']} of {report['candidate_pairs']} near pairs, "
        f"{report['collisions']} collisions, deepest overlap {report['max_penetration']:.3g} m",
        f"  systems     {systems or 'none'}",
    ]
    if len(report["islands"]) > 1:
        lines.insert(3, f"  islands     {report['islands_reason']}; the methods are those of the largest")
    if report["contact_model"] != "none":
        lines.insert(4, f"  touching    {report['contact_model']} contacts: {report['contact_reason']}")
    if report["asleep"]:
        lines.insert(-1, f"  asleep      {report['asleep']} of {len(report['entities'])} bodies, at rest")
    if report["summation"]:
        lines.append(f"  summed      {report['summation']}")
    if report["interpreted_steps"]:
        lines.append(
            f"  interpreted {report['interpreted_s']:.3g} s of that, in {report['interpreted_steps']} of "
            f"{report['steps']} steps: compiling would take longer, once"
        )
    if report["interpreted"]:
        lines.append(f"  slower      {', '.join(report['interpreted'])}: computed by Python, call by call")
    if "trust" in report:
        lines.append(f"  trust       {_trust_words(report['trust'])}")
    lines += [f"  advice      {words}" for words in (ModelWarning(**found) for found in report["advice"])]
    lines += [f"  left out    {left['name']}: {left['reason']}" for left in report["left_out"]]
    return "\n".join(lines)


def _trust_words(report: Mapping[str, Any]) -> str:
    """Return the reliable digits, on a line."""
    if report["digits"] is None:
        return f"cannot be measured: {report['failure']}"
    fewest = [
        f"{min(report[name].values()):.1f} of every {word}"
        for name, word in (("velocities", "velocity"), ("angles", "angle"), ("spins", "spin"))
    ]
    words = (
        f"{report['digits']:.1f} digits of every position at the end, fewest of {report['worst']}; "
        f"{', '.join(fewest)}; {report['energy']:.1f} of the energy"
    )
    if report["left_out"]:
        words += f"; left out: {', '.join(report['left_out'])}"
    if report["horizon_s"] is None:
        return words if "horizon" in words else f"{words}; no rounding grows to another future"
    return f"{words}; one of many possible futures {report['horizon_s']:.3g} s after the start"
