"""Which worlds have a solution in closed form, and what it is."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.ecs.sentences import listed, sentence
from physicslab.ecs.vector import rotated
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import DAMPING, GRAVITY, SPRINGS
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.closed_form_account import give_in_closed_form
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.kepler import Motion, TwoBodies, two_bodies
from physicslab.state.packed import spring_ends
from physicslab.state.state import State
from physicslab.systems.drag import DragSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem

_KNOWN = (SpringSystem, DragSystem)
"""The forces that have a closed form, beside those that accelerate every body alike."""
_IN_LINE = 1e-12
"""How far [share of the length] a body may be off the line of its springs and still count as on it."""
_CAUSES = (GRAVITY, SPRINGS, DAMPING)
"""In the order of the rows of what is given in closed form."""


class NoClosedForm(LookupError):
    """The world's motion has no known closed form; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """Motion on two axes a body: y'' = acceleration - rate2 (y - centre) - drag y'.

    Attributes
    ----------
    rows : int64 array (n,)
        The rows that move.
    direction : float64 array (n, 2)
        The first axis of each, a unit vector; the second is at a right angle to it.
    mass : float64 array (n,)
        The mass [kg] of each, 0 where no force moves it.
    rate2, drag, centre, acceleration : float64 arrays (n, 2)
        By axis: 1/s^2, 1/s, m and m/s^2. The centre includes the shift by the acceleration where rate2 is
        not 0.
    what : str
        The motion that it covers, in words.
    """

    rows: NDArray[np.int64]
    direction: NDArray[np.float64]
    mass: NDArray[np.float64]
    rate2: NDArray[np.float64]
    drag: NDArray[np.float64]
    centre: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    what: str

    def motion(self, state: State) -> Motion:
        """Return copies of the present positions [m] and velocities [m/s] (n, 2)."""
        return state.table(Transform)["position"][self.rows], state.table(Velocity)["linear"][self.rows]

    def after(self, start: Motion, t: float) -> Motion:
        """Return positions [m] and velocities [m/s] (n, 2) a time t [s] after a start."""
        position, velocity = start[0].copy(), start[1].copy()
        direct_entry(propagate)(
            position, velocity, self.direction, self.rate2, self.drag, self.centre, self.acceleration, t
        )
        return position, velocity

    def given(self, start: Motion, t: float) -> dict[int, NDArray[np.float64]]:
        """Return what each cause gives within a time t [s] from a start.

        Energy [J], momentum [N s] and angular momentum about the origin [N m s] (4,) by cause.
        """
        given = np.zeros((len(_CAUSES), ACCOUNTS))
        direct_entry(give_in_closed_form)(
            *start, self.mass, self.direction, self.rate2, self.drag, self.centre, self.acceleration, t, given
        )
        return dict(zip(_CAUSES, given, strict=True))


def closed_form(state: State, forces: Sequence[ForceSystem]) -> ClosedForm | TwoBodies:
    """Return the closed form of a world in which nothing but ``forces`` act.

    There is one for two bodies that attract each other; and for uniform gravity, linear drag and damping, and
    springs to fixed points: those of no rest length and no damper in the plane, all of them along one line,
    on which the body must then stay.

    Raises
    ------
    NoClosedForm
        If there is none.
    """
    if [type(force) for force in forces] == [GravitySystem] and forces[0].attractors == 2:
        orbits = two_bodies(state)
        if orbits is not None:
            return orbits
    uniform = _uniform(state, forces)
    rows = np.flatnonzero(state.table(Transform).present & state.table(Velocity).present)
    n = len(rows)
    bodies, physics, mass = state.bodies, state.physics, state.table(Mass)["mass"]
    inverse = bodies.inverse_mass[rows]
    if not np.isfinite(inverse).all():
        raise NoClosedForm(sentence("mass_too_small"))
    free = inverse > 0.0
    gravity = np.zeros((n, 2))
    gravity[free] = uniform
    decay = np.where(free, physics.linear_damping, 0.0)
    dragged = state.table(Drag)
    has_drag = dragged.present[rows] & (mass[rows] > 0.0)
    decay = decay + np.where(has_drag, dragged["linear"][rows] * inverse, 0.0)
    form = ClosedForm(
        rows, np.tile((1.0, 0.0), (n, 1)), np.where(free, mass[rows], 0.0), np.zeros((n, 2)),
        np.stack((decay, decay), axis=1), np.zeros((n, 2)), gravity, _words(forces, bool(decay.any())),
    )  # fmt: skip
    if len(state.batch(Spring)):
        _hang(state, form)
    return form


def _words(forces: Sequence[ForceSystem], damped: bool) -> str:
    uniform = any(type(force) not in _KNOWN for force in forces)
    springs = any(type(force) is SpringSystem for force in forces)
    parts = [sentence("uniform_gravity")] * uniform
    parts += [sentence("anchored_springs")] * springs
    parts += [sentence("linear_drag")] * damped
    if not parts:
        return sentence("no_force")
    return sentence("forces_alone_act", forces=listed("and", parts))


def _uniform(state: State, forces: Sequence[ForceSystem]) -> tuple[float, float]:
    """Return the acceleration that all bodies with Mass have alike; refuse forces without a closed form."""
    x = y = 0.0
    for force in forces:
        if type(force) in _KNOWN:
            continue
        uniform = force.uniform_alone(state)
        if uniform is None:
            attracts = force.attractors > 0
            why = (
                sentence("attraction")
                if attracts
                else sentence("force_without_closed_form", system=force.name)
            )
            raise NoClosedForm(why)
        x, y = x + uniform.x, y + uniform.y
    if (state.table(Drag)["quadratic"][state.batch(Drag, Velocity, Mass).rows] > 0.0).any():
        raise NoClosedForm(sentence("quadratic_drag"))
    return x, y


def _hang(state: State, form: ClosedForm) -> None:
    """Put the springs into a form that has none so far."""
    springs, a, b = spring_ends(state)
    bodies, velocity = state.bodies, state.table(Velocity).present
    index = {row: i for i, row in enumerate(form.rows.tolist())}
    of_body: dict[int, list[tuple[int, NDArray[np.float64]]]] = {}
    for spring, end_a, end_b in zip(springs.tolist(), a.tolist(), b.tolist(), strict=True):
        label = state.label(int(state.entity_index.entities[spring]))
        moving = [end for end in (end_a, end_b) if velocity[end]]
        if not moving:
            continue
        if len(moving) > 1:
            raise NoClosedForm(sentence("joins_two", body=label))
        if bodies.inverse_mass[moving[0]] == 0.0:
            raise NoClosedForm(sentence("driven_on_spring", body=label))
        side, body, other = ("a", end_a, end_b) if velocity[end_a] else ("b", end_b, end_a)
        if state.table(Spring)[f"anchor_{side}"][spring].any():
            raise NoClosedForm(sentence("turned_by_spring", body=label))
        of_body.setdefault(body, []).append((spring, _fixed_point(state, spring, side, other)))
    for body, held in of_body.items():
        _hang_body(state, form, index[body], held)


def _fixed_point(state: State, spring: int, side: str, other: int) -> NDArray[np.float64]:
    """Return where the end that does not move is [m]."""
    transform = state.table(Transform)
    anchor = state.table(Spring)["anchor_b" if side == "a" else "anchor_a"][spring]
    place: NDArray[np.float64] = transform["position"][other] + rotated(anchor, transform["angle"][other])
    return place


def _hang_body(state: State, form: ClosedForm, i: int, held: list[tuple[int, NDArray[np.float64]]]) -> None:
    """Put the springs of one body into the form."""
    row, table = int(form.rows[i]), state.table(Spring)
    inverse = state.bodies.inverse_mass[row]
    parameters = [(float(table["rest_length"][s]), float(table["stiffness"][s]), float(table["damping"][s]))
               for s, _ in held]  # fmt: skip
    points = np.array([point for _, point in held])
    stiffness = np.array([k for _, k, _ in parameters])
    if all(rest == 0.0 and c == 0.0 for rest, _, c in parameters):
        rate2 = float(stiffness.sum() * inverse)
        form.rate2[i] = rate2
        if rate2 > 0.0:
            form.centre[i] = stiffness @ points / stiffness.sum() + form.acceleration[i] / rate2
        return
    _hang_in_line(state, form, i, points, np.array(parameters))


def _hang_in_line(
    state: State, form: ClosedForm, i: int, points: NDArray[np.float64], parameters: NDArray[np.float64]
) -> None:
    """Put springs into the form that pull along one line, on which the body stays."""
    row = int(form.rows[i])
    label = state.label(int(state.entity_index.entities[row]))
    position = state.table(Transform)["position"][row]
    velocity = state.table(Velocity)["linear"][row]
    reach = position - points
    lengths = np.hypot(reach[:, 0], reach[:, 1])
    line = reach[int(lengths.argmax())] / (lengths.max() or 1.0)
    if not lengths.max() > 0.0:
        along = next((v for v in (velocity, form.acceleration[i]) if v.any()), np.array((1.0, 0.0)))
        line = along / np.hypot(*along)
    normal = np.array((-line[1], line[0]))
    rest, stiffness, damping = parameters.T
    inverse = state.bodies.inverse_mass[row]
    rate = float(np.sqrt(stiffness.sum() * inverse))
    speed = float(np.hypot(*velocity)) + rate * float(lengths.max())  # what rounding is measured against
    for vector, scale in ((velocity, speed), (form.acceleration[i], float(np.hypot(*form.acceleration[i])))):
        if abs(float(normal @ vector)) > _IN_LINE * scale:
            raise NoClosedForm(sentence("off_line", body=label))
    if (np.abs(reach @ normal) > _IN_LINE * lengths.max()).any():
        raise NoClosedForm(sentence("off_line", body=label))
    side = np.sign(reach @ line)
    rate2, drag = float(stiffness.sum() * inverse), float(damping.sum() * inverse) + form.drag[i, 0]
    acceleration = float(form.acceleration[i] @ line)
    form.direction[i] = line
    form.acceleration[i] = acceleration, 0.0
    form.rate2[i] = rate2, 0.0
    form.drag[i] = drag, 0.0
    if rate2 > 0.0:
        natural = points @ line + side * rest
        form.centre[i] = float(stiffness @ natural) / stiffness.sum() + acceleration / rate2, 0.0
    rigid = rest > 0.0
    if rigid.any():
        place, speed = float(position @ line), float(velocity @ line)
        if rate2 == 0.0:
            return  # dampers alone: no force depends on the length
        swing = float(np.hypot(place - form.centre[i, 0], speed / np.sqrt(rate2)))
        room = np.abs(form.centre[i, 0] - points @ line)
        sides = np.sign(form.centre[i, 0] - points @ line)
        if (rigid & ((room <= swing) | (sides != side))).any():
            raise NoClosedForm(sentence("through_end", body=label))
