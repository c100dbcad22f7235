"""Warnings: where a world cannot be trusted as it is stepped, and which setting would help.

The limits below are measured, as each describes; documentation takes its figures from here. Nothing here
runs within a step: finding warnings costs some 50 us for a few bodies and below a millisecond for thousands,
and is done ten times a second or once a measurement.
"""

import math
from collections.abc import Callable, Iterator

import numpy as np

from physicslab.components import Shape, Transform, Velocity
from physicslab.components.shape import CHAIN
from physicslab.diagnostics.contact_warnings import (
    RIGID_LIMIT,
    ContactGraph,
    contact_graph,
    contact_warnings,
    rigid_setting,
)
from physicslab.diagnostics.energy import measure_account, measure_kinetic
from physicslab.diagnostics.field_warnings import field_warnings
from physicslab.diagnostics.joint_warnings import joint_warnings
from physicslab.diagnostics.step_warnings import SUBSTEPS_LIMIT, ModelWarning, WorstWarnings, step_warnings
from physicslab.ecs.sentences import listed, sentence
from physicslab.kernels.solver.impulse import HEAVY_RATIO
from physicslab.state.masses import quiet
from physicslab.state.shapes import lengths_of
from physicslab.stepping.rigid import Rigid
from physicslab.stepping.soft import Soft
from physicslab.stepping.stepper import MAX_FACTOR, falls_far
from physicslab.world import World

__all__ = [
    "DISTANCE_LIMIT", "MASS_RATIO_LIMIT", "OVERLAP_LIMIT", "RIGID_LIMIT",
    "SPEED_LIMIT", "SPIN_LIMIT", "ModelWarning", "WorstWarnings", "find_warnings",
]  # fmt: skip

_ENERGY_ROUNDING = 1e-13
"""Share of the energy that is rounding."""
OVERLAP_LIMIT = 0.2
"""Overlap as a share of the smaller body. A stack of ten equal boxes stays below 0.005, 300 kg on 1 kg below
0.08, a pile of 900 bodies that lands has 0.16 for a moment; one that goes through another passes 0.3."""
SPEED_LIMIT = 1.0
"""Relative speed times the substep, in sizes of the smaller body, among several neighbours. A single impact
is right at any speed, because the motion is swept; but a body collides with one neighbour a substep: of 20
discs of e = 1 in walls none is lost in 300 steps at 1, three at 2, twelve at 5."""
SPIN_LIMIT = 0.25
"""Angle that a box turns by in a substep [rad] near others. Places are swept, corners are not: a spinning box
dropped on a floor lands 8 % off at 0.25, 25 % off at 0.5, anywhere at 1; energy never grows, up to 5."""
MASS_RATIO_LIMIT = 3000.0
"""Mass of a body over that of a lighter one that it lies on. On top of ten boxes of 1 m a body a thousand
times as heavy sinks by 2 cm in 10 s, three thousand times by 4 cm, ten thousand times by 38 cm: substeps,
which are made shorter for such loads, are then as short as they may be. Welded on a box that stands or falls
by 0.3 m, five thousand times give 0.2 % of what lifts them by 1 m in 4 s, ten thousand times 29 %."""
_PEAK_MARGIN = 1.5
"""Between two looks at a run speeds are higher than those seen: so many more substeps are advised."""
GIVEN_LIMIT = 0.2
"""Energy that contacts may give back, as a share of the kinetic energy, of that which lifts each body by its
size, and of what they had taken: bodies that are pressed into each other are lifted out of that. A pile of
400 like discs that lands gives a tenth of all of it."""
UNLIKE_LIMIT = 0.1
"""The same between masses that differ by more than ten, as a share of what lifts each body by its size: like
masses that fall between walls give back 0.02 of it, stacks of 1 to 1,000 kg 0.0014, heaps 0.03 to 0.9."""
_RIGID_MASS_RATIO = 1e6
"""Mass ratio up to which rigid contacts were seen to hold to 1e-15 m without shorter steps."""
FALL_LIMIT = 0.5
"""Way that gravity adds in a substep, in sizes of the smallest: beyond it a body may pass others."""
DISTANCE_LIMIT = 1e9
"""Coordinate in sizes of a body: float64 keeps places there to 1e-7 of the body, and a tower to 1e-3."""


@quiet
def find_warnings(world: World) -> tuple[ModelWarning, ...]:
    """Return the warnings about a world in its present state, the worst of each kind.

    Nothing is changed; the figures are those of the last step.
    """
    worst = WorstWarnings()
    for part in world.parts:
        worst.add(tuple(warning for rule in RULES for warning in rule(part)))
    return worst.all


def _rigid_stepper(world: World) -> Rigid | None:
    return next((stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid)), None)


def _finished_otherwise(world: World) -> Iterator[ModelWarning]:
    """Yield which rigid steps were made by soft contacts or by impulses, and what that cost."""
    rigid = _rigid_stepper(world)
    if rigid is None:
        return
    if rigid.left_to_soft:
        what, count = sentence("left_to_soft"), float(rigid.left_to_soft)
        behind = getattr(rigid.why_soft, "code", "") == "overlap" and _has_chain(world)
        setting = sentence("chain_turned") if behind else ""
        yield ModelWarning(None, what, count, limit=0.0, setting=setting, because=rigid.why_soft)
    if rigid.by_impulses:
        what, count = sentence("by_impulses"), rigid.by_impulses
        lost = measure_account(world).energy["numerical"]
        why = sentence("and_lost_by_now", why=rigid.why_impulses, energy=f"{lost:.3g}")
        yield ModelWarning(None, what, float(count), limit=0.0, because=why)
    parts = measure_account(world).parts if rigid.energy_added else None
    if parts is not None and abs(rigid.energy_added) > _ENERGY_ROUNDING * (parts.kinetic + abs(parts.stored)):
        yield ModelWarning(None, sentence("moved_apart"), rigid.energy_added, "J", 0.0)


def _has_chain(world: World) -> bool:
    """Whether there is a chain: bodies that come from its solid side overlap it at once."""
    return bool((world.table(Shape)["kind"][world.batch(Shape).rows] == CHAIN).any())


def _contact_model(world: World) -> Iterator[ModelWarning]:
    yield from contact_warnings(world, _rigid_stepper(world))


def _soft_contacts(world: World) -> Iterator[ModelWarning]:
    """Yield what is wrong where contacts are soft."""
    rigid = _rigid_stepper(world)
    if world.plan.collisions == "step" and (rigid is None or rigid.left_to_soft):
        graph = contact_graph(world)
        for rule in (_overlap, _gains, _mass_ratios, _welded_on, _speeds, _spins):
            yield from rule(world, graph)
        yield from _falls(world)


def _laws(world: World) -> Iterator[ModelWarning]:
    """Yield how many impacts obeyed another law than Newton's, and which."""
    rigid = _rigid_stepper(world)
    energetic, lowered = world.contacts.energetic_impacts, world.contacts.restitutions_lowered
    if rigid is not None:
        energetic, lowered = energetic + rigid.energetic_impacts, lowered + rigid.restitutions_lowered
    if energetic:
        yield ModelWarning(None, sentence("energetic_impacts"), float(energetic), limit=0.0)
    if lowered:
        yield ModelWarning(None, sentence("lowered_restitution"), float(lowered), limit=0.0)


def _refusals(world: World) -> Iterator[ModelWarning]:
    """Yield settings that the engine could not follow."""
    method = world.plan
    if method.refused:
        yield ModelWarning(None, method.refused, setting='simulation.integrator = "auto"')
    if world.simulation.contacts == "rigid" and method.contacts == "soft" and method.collisions != "none":
        yield ModelWarning(None, method.contact_reason, setting='simulation.contacts = "soft"')
    asked_for_exact = world.simulation.collisions == "exact" and method.contacts == "soft"
    if asked_for_exact and method.collisions == "step":
        yield ModelWarning(None, method.collision_reason, setting='simulation.collisions = "auto"')


def _division(world: World) -> Iterator[ModelWarning]:
    if world.step_divisions > 1:
        what = sentence("divided")
        yield ModelWarning(None, what, float(world.step_divisions), "", 1.0, sentence("shorter_step"))


def _distance(world: World) -> Iterator[ModelWarning]:
    """Yield the body that is furthest from the origin in its own sizes, if that is too far."""
    batch = world.batch(Transform, Shape)
    if not len(batch):
        return
    rows = batch.rows
    reach = np.abs(world.table(Transform)["position"][rows]).max(axis=1)
    half, radius = lengths_of(world.table(Shape), rows)
    size = 2.0 * (half.min(axis=1) + radius)
    size = np.where(size > 0.0, size, 2.0 * half.max(axis=1))  # a straight chain has no width
    worst = int(np.argmax(reach / size))
    limit = DISTANCE_LIMIT * float(size[worst])
    if reach[worst] >= limit:
        far, better = int(batch.entities[worst]), sentence("nearer_origin")
        yield ModelWarning.about(world, far, sentence("far_away"), float(reach[worst]), "m", limit, better)


def _overlap(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the body that overlaps another by the largest share of its size."""
    if not len(graph.touching):
        return
    share = graph.depth / graph.size[graph.touching]
    worst = int(np.argmax(share))
    if share[worst] > OVERLAP_LIMIT:
        lighter = graph.lighter(world, int(graph.touching[worst]))
        size = float(graph.size[graph.touching[worst]])
        what = sentence("pressed_in")
        depth, limit = float(graph.depth[worst]), OVERLAP_LIMIT * size
        yield ModelWarning.about(
            world, lighter, what, depth, "m", limit, rigid_setting(world, len(graph.touching))
        )


def _gains(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the energy that contacts have given: those of bodies at rest have none to give."""
    soft = next(stepper for stepper in world.steppers.usable if isinstance(stepper, Soft))
    a, b = graph.a[graph.touching], graph.b[graph.touching]
    one, other = world.bodies.inverse_mass[a], world.bodies.inverse_mass[b]
    ratio = np.where(one * other > 0.0, np.maximum(one, other) / np.minimum(one, other), 1.0)
    unlike = bool(ratio.max(initial=1.0) > HEAVY_RATIO)
    lifts = float(np.hypot(*world.bodies.force.T) @ world.bodies.shapes.reach)
    limit = GIVEN_LIMIT * (sum(measure_kinetic(world)) + lifts + max(0.0, soft.energy_taken))
    if unlike and lifts > 0.0:
        limit = min(limit, UNLIKE_LIMIT * lifts)
    if not (len(a) and soft.energy_given > limit):
        return
    worst = int(np.argmax(ratio if unlike else graph.depth))
    names = [world.label(int(world.entity_index.entities[row])) for row in (a[worst], b[worst]) if row]
    what = sentence("energy_from_nowhere")
    better = sentence("unlike_masses") if unlike else sentence("no_overlap_at_start")
    setting = rigid_setting(world, len(a)) or sentence("or_smaller_dt", setting=better)
    yield ModelWarning(listed("and", names), what, soft.energy_given, "J", limit, setting)


def _mass_ratios(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the lighter body of the largest mass ratio among bodies that lie on supported ones."""
    ratio = graph.mass_ratios(world)
    if len(ratio) and ratio.max() > MASS_RATIO_LIMIT:
        lighter = graph.lighter(world, int(graph.touching[np.argmax(ratio)]))
        what = sentence("mass_ratio")
        setting = rigid_setting(world, len(graph.touching)) if ratio.max() <= _RIGID_MASS_RATIO else ""
        yield ModelWarning.about(world, lighter, what, float(ratio.max()), "", MASS_RATIO_LIMIT, setting)


def _welded_on(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the body that stands on another and has the largest multiple of its mass welded on."""
    carrier, ratio = max(graph.carrying(world), key=lambda found: found[1], default=(0, 0.0))
    if ratio > MASS_RATIO_LIMIT:
        setting = rigid_setting(world, len(graph.touching)) if ratio <= _RIGID_MASS_RATIO else ""
        yield ModelWarning.about(world, carrier, sentence("welded_on"), ratio, "", MASS_RATIO_LIMIT, setting)


def _speeds(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the fastest body that has several neighbours."""
    h = world.simulation.dt / world.simulation.substeps
    linear = world.table(Velocity)["linear"]
    apart = linear[graph.b] - linear[graph.a]
    sizes = np.hypot(apart[:, 0], apart[:, 1]) * h / graph.size
    sizes[~graph.sharing_a_body(sizes > SPEED_LIMIT)] = 0.0
    if len(sizes) and sizes.max() > SPEED_LIMIT:
        worst = int(np.argmax(sizes))
        setting = _more_substeps(world, float(sizes[worst]) / SPEED_LIMIT)
        what = sentence("passes_sizes")
        faster = graph.faster(world, worst)
        yield ModelWarning.about(world, faster, what, float(sizes[worst]), "", SPEED_LIMIT, setting)


def _spins(world: World, graph: ContactGraph) -> Iterator[ModelWarning]:
    """Yield the body with corners that spins fastest near others."""
    h = world.simulation.dt / world.simulation.substeps
    turns = world.bodies.shapes.vertices > 1
    involved = np.zeros(len(turns), np.bool_)
    involved[graph.a] = involved[graph.b] = True
    rows = np.flatnonzero(involved & turns)
    angles = np.abs(world.table(Velocity)["angular"][rows]) * h
    if len(angles) and angles.max() > SPIN_LIMIT:
        setting = _more_substeps(world, float(angles.max()) / SPIN_LIMIT)
        what = sentence("turns_far")
        spinning = int(world.entity_index.entities[rows[np.argmax(angles)]])
        yield ModelWarning.about(world, spinning, what, float(angles.max()), "rad", SPIN_LIMIT, setting)


def _falls(world: World) -> Iterator[ModelWarning]:
    """Yield how far gravity carries bodies in a substep, where no shorter one is made."""
    if falls_far(world, world.simulation.dt, world.bodies.smallest) == MAX_FACTOR:
        h = world.simulation.dt / (world.simulation.substeps * MAX_FACTOR)
        sizes = world.physics.gravity.magnitude * h * h / world.bodies.smallest
        if sizes <= FALL_LIMIT:
            return
        yield ModelWarning(None, sentence("falls_far"), sizes, "", FALL_LIMIT, sentence("smaller_dt"))


def _more_substeps(world: World, factor: float) -> str:
    needed = math.ceil(world.simulation.substeps * factor * _PEAK_MARGIN)
    return f"simulation.substeps = {needed}" if needed <= SUBSTEPS_LIMIT else sentence("smaller_dt")


RULES: tuple[Callable[[World], Iterator[ModelWarning]], ...] = (
    _refusals, _division, step_warnings, _distance, _finished_otherwise, _laws,
    _contact_model, _soft_contacts, joint_warnings, field_warnings,
)  # fmt: skip
"""All of them, in the order in which they are shown. Another is added here, and nowhere else."""
