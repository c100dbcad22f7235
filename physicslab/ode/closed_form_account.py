"""Energy and momentum from causes to bodies that moved in closed form: integrals in closed form as well.

No power is integrated beside such a motion: what dampers and drag take is what the energy of their bodies
loses along the solution, and what is left of the angular momentum of these is that of damping. The solution
is evaluated here once more, from the start, and not taken from where bodies have come to: an error of the
kernel that moves them is no damping.
"""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, DAMPING, ENERGY, GRAVITY, PX, PY, SPRINGS
from physicslab.ode.closed_form import ClosedForm
from physicslab.ode.kepler import TwoBodies
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array, of bodies by the axes of their springs (n, 2)."""

_SMALL = 0.1
"""Share of a time constant of damping below which what it leaves is summed as a series."""


@np.errstate(all="ignore")  # whether the motion is finite is looked at when it is made
def given_in_closed_form(state: State, form: ClosedForm | TwoBodies, t: float) -> dict[int, Numbers]:
    """Return what each cause has given to bodies within a time t [s].

    Parameters
    ----------
    state : State
        The world as it was before.
    form : ClosedForm or TwoBodies
        How its bodies move.
    t : float
        How long that took [s].

    Returns
    -------
    dict of int to float64 array (4,)
        For gravity, springs and damping the energy [J], the momentum [N s] and the angular momentum about the
        origin [N m s]; gravity and springs store energy, which is not counted.
    """
    if isinstance(form, TwoBodies):
        return form.given(state, t)
    free = state.bodies.inverse_mass[form.rows] > 0.0
    mass = state.table(Mass)["mass"][form.rows][free, None]
    along = form.direction[free]
    rate2, drag, centre, a = (of[free] for of in (form.rate2, form.drag, form.centre, form.acceleration))
    y0 = _on_axes(state.table(Transform)["position"][form.rows][free], along)
    v0 = _on_axes(state.table(Velocity)["linear"][form.rows][free], along)
    y1, v1 = _solution(rate2, drag, centre, a, y0, v0, t)
    held, damped = rate2 > 0.0, drag > 0.0
    by_gravity, by_damping = mass * a * t, -mass * drag * (y1 - y0)
    by_springs = np.where(held, mass * (v1 - v0) - by_gravity - by_damping, 0.0)
    lengths = _integral(rate2, drag, centre, a, y0, v0, y1 - y0, v1 - v0, t)
    own = np.where(held, rate2 * centre - a, 0.0)  # the centre without gravity, times rate2
    torque_g = (mass * (lengths[:, :1] * a[:, 1:] - lengths[:, 1:] * a[:, :1])).sum()
    by_rate = (rate2[:, :1] - rate2[:, 1:]) * y0[:, 1:] * lengths[:, :1]  # of springs in a line, y2 stays
    torque_s = (mass * (by_rate + own[:, 1:] * lengths[:, :1] - own[:, :1] * lengths[:, 1:])).sum()
    spin = (mass * (_cross(y1, v1) - _cross(y0, v0))).sum()
    change = 0.5 * (v1 - v0) * (v1 + v0) + 0.5 * rate2 * (y1 - y0) * (y1 + y0 - 2.0 * centre)
    change -= np.where(held, 0.0, a * (y1 - y0))
    energy = float((mass * change)[damped].sum())
    rest = float(spin - torque_g - torque_s) if damped.any() else 0.0
    return {
        GRAVITY: _row(0.0, by_gravity, along, float(torque_g)),
        SPRINGS: _row(0.0, by_springs, along, float(torque_s)),
        DAMPING: _row(energy, by_damping, along, rest),
    }


def _solution(
    rate2: Numbers, drag: Numbers, centre: Numbers, a: Numbers, y: Numbers, v: Numbers, t: float
) -> tuple[Numbers, Numbers]:
    """Return places and velocities after a time t [s] of y'' = a - rate2 (y - centre) - drag y'."""
    half, z = 0.5 * drag, drag * t
    second, _ = _shares(z)
    first = 1.0 - z * second
    fallen = y + t * (v * first + a * t * second), v - z * first * v + a * t * first
    s = np.sqrt(np.abs(rate2 - half * half))
    swings, turn = rate2 > half * half, s * t
    slow, fast = np.exp(-np.where(swings, half, rate2 / (half + s)) * t), np.exp(-(half + s) * t)
    near = turn < 1e-3  # the two rates meet: sinh(s t) / s by its series
    parted = 0.5 * (slow - fast) / np.where(near, 1.0, s)
    series = np.exp(-half * t) * t * (1.0 + turn**2 / 6.0 + turn**4 / 120.0)
    sine = np.where(swings, slow * t * np.sinc(turn / np.pi), np.where(near, series, parted))
    cosine = np.where(swings, slow * np.cos(turn), 0.5 * (slow + fast))
    apart = y - centre
    swung = (
        centre + cosine * apart + sine * (v + half * apart),
        cosine * v - sine * (rate2 * apart + half * v),
    )
    held = rate2 > 0.0
    return np.where(held, swung[0], fallen[0]), np.where(held, swung[1], fallen[1])


def _on_axes(vectors: Numbers, along: Numbers) -> Numbers:
    """Return vectors (n, 2) by the two axes of each body."""
    c, s = along.T
    return np.stack((c * vectors[:, 0] + s * vectors[:, 1], c * vectors[:, 1] - s * vectors[:, 0]), axis=1)


def _cross(a: Numbers, b: Numbers) -> Numbers:
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[:, None]


def _row(energy: float, impulse: Numbers, along: Numbers, spin: float) -> Numbers:
    """Return a row of the account, of impulses (n, 2) by the axes of each body."""
    c, s = along.T
    row = np.zeros(4)
    row[[ENERGY, ANGULAR_MOMENTUM]] = energy, spin
    row[PX] = (c * impulse[:, 0] - s * impulse[:, 1]).sum()
    row[PY] = (s * impulse[:, 0] + c * impulse[:, 1]).sum()
    return row


def _integral(
    rate2: Numbers, drag: Numbers, centre: Numbers, a: Numbers,
    y: Numbers, v: Numbers, moved: Numbers, gained: Numbers, t: float,
) -> Numbers:  # fmt: skip
    """Return the integrals of the places over a time t [m s], by the equation of motion."""
    held, z = rate2 > 0.0, drag * t
    swung = centre * t - (gained + drag * moved) / np.where(held, rate2, 1.0)
    second, third = _shares(z)
    fallen = y * t + t * t * (v * second + a * t * third)
    return np.where(held, swung, fallen)


def _shares(z: Numbers) -> tuple[Numbers, Numbers]:
    """Return (z - 1 + e^-z) / z^2 and (z^2 / 2 - z + 1 - e^-z) / z^3 without loss for small z."""
    small, term = z < _SMALL, np.full(z.shape, 0.5)
    second, third = np.zeros(z.shape), np.zeros(z.shape)
    for k in range(1, 14):
        second += term
        third += term / (k + 2.0)
        term = term * -z / (k + 2.0)
    large = np.where(small, 1.0, z)
    far = (1.0 + np.expm1(-large) / large) / large
    return np.where(small, second, far), np.where(small, third, (0.5 - far) / large)
