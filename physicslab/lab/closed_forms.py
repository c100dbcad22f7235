"""Motion with a closed form, to which results of the labs are compared."""

import cmath
import math


def slid(speed: float, slowing: float, t: float) -> tuple[float, float]:
    """Return the way [m] and speed [m/s] after a time [s] of what slides until it stops.

    Parameters
    ----------
    speed : float
        At the start [m/s].
    slowing : float
        Deceleration [m/s^2]; negative where it becomes faster.

    >>> slid(2.0, 1.0, 1.0), slid(2.0, 1.0, 3.0)
    ((1.5, 1.0), (2.0, 0.0))
    """
    stops = speed / slowing if slowing > 0.0 else math.inf
    moving = min(t, stops)
    return speed * moving - 0.5 * slowing * moving * moving, speed - slowing * t if t < stops else 0.0


def rolled(
    speed: float, friction: float, t: float, *, pull: float = 0.0, share: float = 0.5
) -> tuple[float, float, float, float]:
    """Return the way and speed of a round body thrown without spin, and those of its rim [m], [m/s].

    It slips until its rim is as fast as its centre, and rolls then.

    Parameters
    ----------
    speed : float
        At the start [m/s].
    friction, pull : float
        Accelerations [m/s^2] by sliding friction, against the motion, and by gravity, along it.
    t : float
        The time since the start [s].
    share : float
        Its moment of inertia over m r^2.

    >>> rolled(3.0, 2.0, 1.0)
    (2.25, 2.0, 1.5, 2.0)
    """
    grip = (1.0 + 1.0 / share) * friction - pull
    slipping = min(t, speed / grip if grip > 0.0 else math.inf)
    way, gone = speed * slipping + 0.5 * (pull - friction) * slipping**2, speed + (pull - friction) * slipping
    rim, turning = 0.5 * friction / share * slipping**2, friction / share * slipping
    rolling, rate = t - slipping, pull / (1.0 + share)
    more = 0.5 * rate * rolling**2
    return (
        way + gone * rolling + more, gone + rate * rolling,
        rim + turning * rolling + more, turning + rate * rolling,
    )  # fmt: skip


def dragged_energy(rate: float, vx: float, vy: float, gravity: float, t: float) -> float:
    """Return the energy [J] of 1 kg thrown from height 0 after a time [s], slowed by a rate [1/s] times v."""
    gone, sink, left = -math.expm1(-rate * t) / rate, gravity / rate, math.exp(-rate * t)
    now_x, now_y = vx * left, (vy + sink) * left - sink
    return 0.5 * (now_x**2 + now_y**2) + gravity * ((vy + sink) * gone - sink * t)


def stopped_by_friction(start: float, rate: float, held: float, t: float) -> float:
    """Return where a body on a spring is that Coulomb friction slows, let go at ``start`` [m].

    Each half of a swing is one about a point that friction has moved by ``held`` [m], the way from the middle
    at which it holds the body; where a half ends within that, the body stays.

    >>> stopped_by_friction(1.0, 1.0, 0.25, 100.0)
    0.0
    >>> stopped_by_friction(1.0, 1.0, 0.375, 100.0)
    -0.25
    """
    half = math.pi / rate
    while abs(start) > held:
        middle = math.copysign(held, start)
        if t < half:
            return middle + (start - middle) * math.cos(rate * t)
        start, t = 2.0 * middle - start, t - half
    return start


def corner_impact(
    arm: tuple[float, float], inertia: float, fall: float, e: float, mu: float
) -> tuple[float, float, float]:
    """Return vx, vy [m/s] and spin [rad/s] of 1 kg after the impact of its corner on a floor.

    Parameters
    ----------
    arm : pair of floats
        From its centre to the corner [m].
    inertia : float
        Its moment of inertia [kg m^2].
    fall : float
        The speed with which it fell, without spin [m/s].
    e, mu : float
        Restitution, by Newton's law, and friction, by Coulomb's: both impulses act at one time.
    """
    x, y = arm
    across, along, both = 1.0 + y * y / inertia, 1.0 + x * x / inertia, -x * y / inertia
    wanted = (1.0 + e) * fall
    # Sticking: across * jx + both * jy = 0 and both * jx + along * jy = wanted.
    jy = wanted / (along - both * both / across)
    jx = -both * jy / across
    if abs(jx) > mu * jy:  # it slides: friction is at its limit, and against the speed that it leaves
        edge = math.copysign(mu, jx)
        jy = wanted / (along + edge * both)
        jx = edge * jy
    return jx, jy - fall, (x * jy - y * jx) / inertia


def driven(
    stiffness: float, drag: float, strength: float, rate: float, start: float, t: float
) -> tuple[float, float]:
    """Return x [m] and v [m/s] of 1 kg on a spring with linear drag, driven by strength cos(rate t).

    Parameters
    ----------
    stiffness, drag, strength : float
        Spring [N/m], drag [kg/s] and amplitude of the force [N]. The damping is below the critical one.
    rate, start, t : float
        That of the force [rad/s]; where it is let go at t = 0 [m]; the time [s].
    """
    steady = strength / complex(stiffness - rate * rate, drag * rate)
    own = complex(-0.5 * drag, math.sqrt(stiffness - 0.25 * drag * drag))
    # Re(free e^(own t)): what is left at t = 0 of the place and of the velocity.
    x, v = start - steady.real, rate * steady.imag
    free = complex(x, (own.real * x - v) / own.imag) * cmath.exp(own * t)
    swing = steady * cmath.exp(1j * rate * t)
    return free.real + swing.real, (own * free).real - rate * swing.imag


def crossed(
    pull: complex, rate: float, start: complex, velocity: complex, t: float
) -> tuple[complex, complex]:
    """Return place [m] and velocity [m/s], as complex numbers, of z'' = pull - i rate z' after a time [s].

    Parameters
    ----------
    pull : complex
        The acceleration by a uniform field [m/s^2].
    rate : float
        The rate q B / m at which a magnetic field turns velocities clockwise [rad/s].
    start, velocity : complex
        At t = 0 [m], [m/s].
    """
    drift = pull / (1j * rate)
    circling = (velocity - drift) * cmath.exp(-1j * rate * t)
    return start + drift * t + (velocity - drift - circling) / (1j * rate), drift + circling


def repelled(strength: float, axis: float, excess: float, t: float) -> tuple[complex, complex]:
    """Return r [m] and r' [m/s], as complex numbers, of r'' = strength r / |r|^3, nearest at t = 0.

    It goes along the branch of a hyperbola that is turned away from the origin, with a half axis ``axis`` [m]
    and the eccentricity ``excess``; r = a (1 + e cosh F), where t = sqrt(a^3 / strength) (F + e sinh F).
    """
    mean, found = t * math.sqrt(strength / axis**3), math.asinh(t * math.sqrt(strength / axis**3) / excess)
    for _ in range(50):
        found -= (found + excess * math.sinh(found) - mean) / (1.0 + excess * math.cosh(found))
    narrow, goes = math.sqrt(excess * excess - 1.0), math.sqrt(strength / axis)
    goes /= 1.0 + excess * math.cosh(found)
    place = complex(excess + math.cosh(found), narrow * math.sinh(found))
    return axis * place, goes * complex(math.sinh(found), narrow * math.cosh(found))


def molecules_period(share: float, rate: float) -> tuple[float, float]:
    """Return the least distance of two molecules that oscillate, and their period [s].

    By the trapezoidal rule over the phase of the oscillation, which converges faster than any power.

    Parameters
    ----------
    share : float
        Their energy, as a share of the depth, from -1 (at rest) to 0 (they part).
    rate : float
        sqrt(depth / reduced mass) over the distance at which they rest, in units of which lengths are [1/s].
    """
    root = math.sqrt(1.0 + share)
    near, far = (1.0 + root) ** (-1.0 / 6.0), (1.0 - root) ** (-1.0 / 6.0)
    total, parts = 0.0, 400
    for k in range(parts):
        r = 0.5 * (near + far) - 0.5 * (far - near) * math.cos(math.pi * (k + 0.5) / parts)
        s = r**-6.0
        # E - V = (s_near - s) (s - s_far): the roots are divided out before they are small.
        total += math.sqrt((r - near) * (far - r) / ((1.0 + root - s) * (s - 1.0 + root)))
    return near, total * math.pi / parts * math.sqrt(2.0) / rate
