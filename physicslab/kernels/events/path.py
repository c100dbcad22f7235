"""Ballistic paths: motion under constant accelerations, with the rounding remainders kept.

A path is a row of numbers: place, velocity and start, each with the remainder that rounding would drop, the
acceleration, and the mass of what gravity accelerates. Only an impact of the body begins a new path; between
impacts it is evaluated in closed form, so that no error adds up, however many impacts other bodies have.
"""

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.accounts import GRAVITY, book
from physicslab.kernels.events.meeting import Course
from physicslab.kernels.ode.compensated import add_pair, multiply

FIELDS = 13
"""Numbers of a path."""
_X, _VX, _A, _T, _M = 0, 4, 8, 10, 12
"""Where its parts begin: x and its remainder, y and its remainder; the same of velocities; accelerations; the
start; the mass."""


@inlined
def begin(paths: Vectors, i: int, x: float, y: float, vx: float, vy: float) -> None:
    """Begin the path of row i at time 0; its acceleration and its remainders stay."""
    paths[i, _X], paths[i, _X + 2], paths[i, _VX], paths[i, _VX + 2] = x, y, vx, vy
    paths[i, _T], paths[i, _T + 1] = 0.0, 0.0


@inlined
def _advanced(paths: Vectors, i: int, now: float, low: float) -> float:
    """Return the time since the start of row i's path at the time ``now + low`` [s]."""
    advanced: float = (now - paths[i, _T]) + (low - paths[i, _T + 1])
    return advanced


@inlined
def place(paths: Vectors, i: int, now: float, low: float) -> tuple[float, float, float, float]:
    """Return where row i is: x and its remainder, y and its remainder [m]."""
    s = _advanced(paths, i, now, low)
    dx = s * (paths[i, _VX] + (paths[i, _VX + 1] + 0.5 * s * paths[i, _A]))
    dy = s * (paths[i, _VX + 2] + (paths[i, _VX + 3] + 0.5 * s * paths[i, _A + 1]))
    x, x_low = add_pair(paths[i, _X], paths[i, _X + 1], dx, 0.0)
    y, y_low = add_pair(paths[i, _X + 2], paths[i, _X + 3], dy, 0.0)
    return x, x_low, y, y_low


@inlined
def velocity(paths: Vectors, i: int, now: float, low: float) -> tuple[float, float, float, float]:
    """Return how fast row i is: vx and its remainder, vy and its remainder [m/s]."""
    s = _advanced(paths, i, now, low)
    vx, vx_low = add_pair(paths[i, _VX], paths[i, _VX + 1], s * paths[i, _A], 0.0)
    vy, vy_low = add_pair(paths[i, _VX + 2], paths[i, _VX + 3], s * paths[i, _A + 1], 0.0)
    return vx, vx_low, vy, vy_low


@inlined
def seen_from(paths: Vectors, a: int, b: int, now: float, low: float) -> Course:
    """Return place, velocity and acceleration of row b against row a."""
    ax, ax_low, ay, ay_low = place(paths, a, now, low)
    bx, bx_low, by, by_low = place(paths, b, now, low)
    vax, vax_low, vay, vay_low = velocity(paths, a, now, low)
    vbx, vbx_low, vby, vby_low = velocity(paths, b, now, low)
    return Course(
        (bx - ax) + (bx_low - ax_low), (by - ay) + (by_low - ay_low),
        (vbx - vax) + (vbx_low - vax_low), (vby - vay) + (vby_low - vay_low),
        paths[b, _A] - paths[a, _A], paths[b, _A + 1] - paths[a, _A + 1],
    )  # fmt: skip


@inlined
def advance_to(
    paths: Vectors, i: int, angle: Numbers, angular: Numbers, now: float, low: float, account: Vectors
) -> None:
    """Begin a new path of row i where the old one is at the time ``now + low``.

    Energy and momentum by gravity on the old one are added to the account: m g s, and about the origin the
    integral of x x m g, which is (x s + v s^2 / 2) x m g for a parabola.
    """
    s = _advanced(paths, i, now, low)
    angle[i] += s * angular[i]
    px, py = paths[i, _M] * paths[i, _A] * s, paths[i, _M] * paths[i, _A + 1] * s
    middle_x = paths[i, _X] + 0.5 * s * paths[i, _VX]
    middle_y = paths[i, _X + 2] + 0.5 * s * paths[i, _VX + 2]
    book(account[GRAVITY], 0, 0.0, px, py, middle_x * py - middle_y * px)
    x, x_low, y, y_low = place(paths, i, now, low)
    vx, vx_low, vy, vy_low = velocity(paths, i, now, low)
    paths[i, _X], paths[i, _X + 1], paths[i, _X + 2], paths[i, _X + 3] = x, x_low, y, y_low
    paths[i, _VX], paths[i, _VX + 1], paths[i, _VX + 2], paths[i, _VX + 3] = vx, vx_low, vy, vy_low
    paths[i, _T], paths[i, _T + 1] = now, low


@inlined
def push(paths: Vectors, i: int, inverse_mass: float, px: float, py: float) -> None:
    """Change the velocity with which row i began its path by an impulse (px, py) [N s]."""
    x, x_low = multiply(inverse_mass, px)
    y, y_low = multiply(inverse_mass, py)
    paths[i, _VX], paths[i, _VX + 1] = add_pair(paths[i, _VX], paths[i, _VX + 1], x, x_low)
    paths[i, _VX + 2], paths[i, _VX + 3] = add_pair(paths[i, _VX + 2], paths[i, _VX + 3], y, y_low)
