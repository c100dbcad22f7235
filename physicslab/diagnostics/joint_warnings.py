"""Warnings of joints: those that contradict each other, those that hold what is held, and what they leave."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Material, Rod
from physicslab.diagnostics.contact_warnings import contact_graph, rigid_setting
from physicslab.diagnostics.energy import measure_account, measure_kinetic
from physicslab.diagnostics.step_warnings import SUBSTEPS_LIMIT, ModelWarning
from physicslab.ecs.sentences import sentence
from physicslab.kernels.joints.blocks import ACTIVE, GIVES, ROW, STATE
from physicslab.kernels.joints.measured import AX, BX, BY, TURN_A
from physicslab.state.joint_closing import closing_places
from physicslab.state.joint_figures import figures_of, measured_terms
from physicslab.state.joint_rows import Measure, Role
from physicslab.state.joints import Joint
from physicslab.stepping.plan import WITHOUT_END
from physicslab.stepping.soft import Soft
from physicslab.world import World

STRETCH_LIMIT = 0.01
"""How far a joint may be apart, in lengths of what it holds: bridges, chains and welds stay below that under
10,000 times the load of a link, and two pins that contradict each other are as far apart as they are made."""


LEVERAGE_LIMIT = 1e6
"""Mass times arm squared over the moment of inertia up to which the equations of joints keep seven digits of
the energy and more; each tenfold beyond costs four, until a row is taken for that of a flat linkage."""
LOST_LIMIT = 0.1
"""Share of the energy exchanged that joints may have taken where bodies that they hold bounce: elastic discs
in pairs on rods lose half of theirs in a second, and nothing where contacts are rigid."""
_MARGIN = 1.5
"""Between two looks at a run joints are further apart than those seen."""
_MOST_ROWS = 100
"""Number of rows up to which it is looked for contradictions."""


def joint_warnings(world: World) -> Iterator[ModelWarning]:
    """Yield a joint that does nothing, the one that is farthest apart with the reason, and redundant ones."""
    joints = world.joints.joints
    if not joints:
        return
    world.joints.refresh(world.entity_index)
    moves = _moves(world)
    if not moves.all():
        idle, what = joints[int(np.argmin(moves))].entity, sentence("idle_joint")
        yield ModelWarning.about(world, idle, what, setting=sentence("mass_at_one_end"))
    if not moves.any():
        return
    yield from _light_to_turn(world)
    yield from _bounces(world)
    figures, dependent = figures_of(world), _dependent(world) & _acts(world)
    worst = int(np.argmax(np.where(moves, figures.stretch / figures.size, -1.0)))
    stretch, limit = float(figures.stretch[worst]), STRETCH_LIMIT * float(figures.size[worst])
    if stretch > limit and _has_no_direction(world, joints[worst]):
        what, where = sentence("ends_in_one_place"), sentence("apart")
        yield ModelWarning.about(world, joints[worst].entity, what, setting=where)
        return
    told = stretch > limit and (bool(dependent.any()) or _contradict(world, limit))
    if stretch <= limit:
        yield from _softness(world, joints[worst].entity, stretch)
    if stretch > limit and (told or isinstance(world.stepper, Soft)):  # others close what can be closed
        what = sentence("contradicts") if told else sentence("does_not_hold")
        needed = _substeps(world, float(figures.size[worst]), stretch / limit)
        setting = "" if told else f"simulation.substeps = {needed}"
        if (
            not told
            and joints[worst].own.start in world.joints.blocks.nodes[:-1, ROW][world.joints.blocks.gives_way]
        ):
            what, setting = sentence("gives_way"), sentence("fewer_joints")
        yield ModelWarning.about(world, joints[worst].entity, what, stretch, "m", limit, setting)
    elif dependent.any():
        first = int(np.argmax(dependent))
        joint = joints[int(world.joints.owner[first])]
        if _has_no_direction(world, joint):
            what = sentence("ends_in_one_place")
            yield ModelWarning.about(world, joint.entity, what, setting=sentence("a_pin"))
            return
        blocked = dependent & (world.joints.role == Role.MOTOR)
        if blocked.any():
            joint = joints[int(world.joints.owner[int(np.argmax(blocked))])]
            yield ModelWarning.about(world, joint.entity, sentence("blocked_motor"))
            return
        what = sentence("redundant")
        count = float(np.count_nonzero(dependent))
        yield ModelWarning.about(
            world, joint.entity, what, count, limit=0.0, setting=sentence("one_joint_less")
        )


def _has_no_direction(world: World, joint: Joint) -> bool:
    """Whether a joint is a rod whose ends are in one place."""
    return joint.kind is Rod and not measured_terms(world)[joint.first, AX : BY + 1].any()


def _softness(world: World, joint: int, stretch: float) -> Iterator[ModelWarning]:
    """Yield how far joints give that are soft as exact ones had to be given up."""
    if stretch > 0.0 and isinstance(world.stepper, Soft) and world.plan.contact_reason == WITHOUT_END:
        what, why = sentence("soft_joints"), world.plan.contact_reason
        finer = f"simulation.substeps = {min(4 * world.simulation.substeps, SUBSTEPS_LIMIT)}"
        yield replace(ModelWarning.about(world, joint, what, stretch, "m", 0.0, finer), because=why)


def _substeps(world: World, size: float, times: float) -> int:
    """Return how many substeps would let soft joints hold, and at least twice as many as there are.

    A light body that carries M/m times its weight on links of a ``size`` [m] swings sideways at the rate
    sqrt(2 M g / m L), as a loaded string does; a substep has to follow it. Joints that are so many ``times``
    too far apart without that were met at a speed, as a wheel is by the end of its rope: they give by the way
    in a substep.
    """
    joints, mass = world.joints, world.bodies.inverse_mass
    ends = np.stack((mass[joints.a], mass[joints.b]))
    ends = ends[:, (ends > 0.0).all(axis=0)]
    ratio = float((ends.max(axis=0) / ends.min(axis=0)).max(initial=1.0))
    rate = math.sqrt(2.0 * ratio * math.hypot(*world.physics.gravity) / size)
    substeps = world.simulation.substeps
    needed = min(rate * world.simulation.dt, SUBSTEPS_LIMIT)
    if needed <= 2 * substeps:
        needed = min(substeps * max(_MARGIN * times, 2.0), SUBSTEPS_LIMIT)
    return math.ceil(needed)


def _moves(world: World) -> NDArray[np.bool_]:
    """Return of each joint (n,) whether a force can move what it joins; a hand may let go of it."""
    bodies, joints, owner = world.bodies, world.joints, world.joints.owner
    free = (bodies.inverse_mass > 0.0) | (bodies.inverse_inertia > 0.0) | world.table(Held).present
    moves = np.zeros(len(joints.joints), np.bool_)
    np.logical_or.at(moves, owner, free[joints.a] | free[joints.b])
    return moves


def _acts(world: World) -> NDArray[np.bool_]:
    """Return which rows (n,) do not hold what no force moves, as the angle of a body without inertia."""
    terms, bodies, joints, owner = measured_terms(world), world.bodies, world.joints, world.joints.row
    free = np.stack((bodies.inverse_mass, bodies.inverse_mass, bodies.inverse_inertia), axis=1) > 0.0
    free |= world.table(Held).present[:, None]
    holds, acts = np.zeros((2, len(joints)), np.bool_)
    for ends, gradient in ((joints.a, terms[:, AX : TURN_A + 1]), (joints.b, terms[:, BX:])):
        np.logical_or.at(holds, owner, (gradient != 0.0).any(axis=1))
        np.logical_or.at(acts, owner, ((gradient != 0.0) & free[ends]).any(axis=1))
    return acts | ~holds


def _light_to_turn(world: World) -> Iterator[ModelWarning]:
    """Yield the body with the smallest moment of inertia for the arm on which exact joints hold it."""
    if isinstance(world.stepper, Soft) and world.plan.contact_reason != WITHOUT_END:
        return
    joints, bodies = world.joints, world.bodies
    ends = np.concatenate((joints.a, joints.b))
    arms = np.hypot(*np.concatenate((joints.anchor_a, joints.anchor_b)).T)
    mass, inertia = bodies.inverse_mass[ends], bodies.inverse_inertia[ends]
    held = np.where(np.concatenate((joints.measure, joints.measure)) == Measure.ANGLE, 0.0, arms * arms)
    leverage = np.where(mass > 0.0, held * inertia / np.where(mass > 0.0, mass, 1.0), 0.0)
    worst = int(np.argmax(leverage))
    if leverage[worst] > LEVERAGE_LIMIT:
        what = sentence("light_to_turn")
        setting = f"Mass.inertia = {1.01 * leverage[worst] / (LEVERAGE_LIMIT * inertia[worst]):.3g}"
        entity = int(world.entity_index.entities[ends[worst]])
        yield ModelWarning.about(world, entity, what, float(leverage[worst]), "", LEVERAGE_LIMIT, setting)


def _bounces(world: World) -> Iterator[ModelWarning]:
    """Yield the energy that joints have taken where impacts bounce bodies without their joints.

    Soft joints act after the impacts of a substep, and take what those have left along them.
    """
    if not (isinstance(world.stepper, Soft) and world.collisions):
        return
    joints = world.joints
    holds = joints.role[world.joints.row] == Role.HOLD
    ends = np.unique(np.concatenate((joints.a[holds], joints.b[holds])))
    bouncing = ends[
        (world.table(Material)["restitution"][ends] > 0.0) & (world.bodies.inverse_mass[ends] > 0.0)
    ]
    changes = measure_account(world).energy
    lost, exchanged = -changes["joints"], sum(measure_kinetic(world)) + sum(map(abs, changes.values()))
    limit = LOST_LIMIT * exchanged
    if len(bouncing) and lost > limit:
        setting = rigid_setting(world, len(contact_graph(world).touching))
        body = int(world.entity_index.entities[bouncing[0]])
        yield ModelWarning.about(world, body, sentence("bounces_alone"), lost, "J", limit, setting)


def _contradict(world: World, limit: float) -> bool:
    """Whether the rows that hold cannot all be closed, from where bodies are."""
    if np.count_nonzero(world.joints.role == Role.HOLD) > _MOST_ROWS:
        return False
    return closing_places(world, 0.5 * limit) is None


def _dependent(world: World) -> NDArray[np.bool_]:
    """Return which rows of joints (n,) depend on others, as far as the last stepper found that."""
    joints = world.joints
    if not isinstance(world.stepper, Soft):
        return joints.dependent
    owner, (_, state, _) = world.joints.owner[: len(world.joints)], joints.buffers
    gives, acts = np.zeros((2, len(joints) + 1))
    for place in (1, 0):  # nodes of one row have none in the second place, which is that of another
        gives[joints.blocks.nodes[:-1, ROW] + place] = np.where(
            joints.blocks.gives_way, 0.0, state[:, GIVES + place]
        )
        acts[joints.blocks.nodes[:-1, ROW] + place] = state[:, STATE]
    # A motor that stands at a limit of its own joint holds the same as that, which is meant.
    bounds = joints.role != Role.HOLD
    acting = np.bincount(owner[bounds & (acts[:-1] == ACTIVE)], minlength=len(joints.joints))
    dependent: NDArray[np.bool_] = (gives[:-1] != 0.0) & ~(bounds & (acting[owner] > 1))
    return dependent
