"""Compute motion on joints to 16 digits and more: how the figures of the accuracy problems were made.

``uv run python benchmarks/joint_references.py [NAME ...]`` prints how far two runs of different steps are
apart, and the figures as ``problems.json`` has them. Angles are the only coordinates, so that nothing is to
be held together. Steps are extrapolated from Gragg's midpoint rule with 2, 4, ... 28 parts (Hairer, Norsett &
Wanner, Solving Ordinary Differential Equations I, 1993, II.9), with 40 digits.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable

import mpmath
from mpmath import cos, mpf, sin, sqrt

type Numbers = list[mpmath.mpf]
type Law = Callable[[Numbers, Numbers], Numbers]
"""Returns the accelerations (n,) at coordinates (n,) and speeds (n,)."""

G = mpf("9.81")
START = (
    "-0.0617138900142764496358948458001", "0", "0.455279819163070380255912382449",
    "0.222668390165885884674473185609", "0.487364979543842550225598953530",
    "-0.222668390165885884674473185609", "1.23054744454982119249735015568",
)  # fmt: skip
"""The angles of Andrews' mechanism at first."""
PARTS = [2 * k for k in range(1, 15)]


def numbers(text: str) -> Numbers:
    """Return decimal numbers with all digits."""
    return [mpf(part) for part in text.split()]


def step(law: Law, state: Numbers, h: mpmath.mpf) -> Numbers:
    """Return coordinates and speeds h seconds on."""
    size = len(state) // 2
    rows: list[list[Numbers]] = []

    def slope(y: Numbers) -> Numbers:
        return y[size:] + law(y[:size], y[size:])

    first = slope(state)
    for k, parts in enumerate(PARTS):
        part = h / parts
        old, now = state, [x + part * dx for x, dx in zip(state, first, strict=True)]
        for _ in range(parts - 1):
            old, now = now, [x + 2 * part * dx for x, dx in zip(old, slope(now), strict=True)]
        row = [now]
        for j in range(1, k + 1):
            ratio = (mpf(parts) / PARTS[k - j]) ** 2 - 1
            row.append([x + (x - y) / ratio for x, y in zip(row[-1], rows[-1][j - 1], strict=True)])
        rows.append(row)
    return rows[-1][-1]


def run(law: Law, state: Numbers, times: list[int], steps: int) -> dict[int, Numbers]:
    """Return the states at whole seconds, with so many steps a second."""
    found = {}
    for n in range(1, times[-1] * steps + 1):
        state = step(law, state, mpf(1) / steps)
        if n % steps == 0 and n // steps in times:
            found[n // steps] = state
    return found


def solved(a: list[Numbers], b: Numbers) -> Numbers:
    """Return x of A x = b for a symmetric positive definite A (n, n), by Cholesky's factors."""
    n, low = len(b), [row[:] for row in a]
    x = b[:]
    for i in range(n):
        for j in range(i):
            low[i][j] = (low[i][j] - sum(low[i][k] * low[j][k] for k in range(j))) / low[j][j]
        low[i][i] = sqrt(low[i][i] - sum(low[i][k] ** 2 for k in range(i)))
        x[i] = (x[i] - sum(low[i][k] * x[k] for k in range(i))) / low[i][i]
    for i in reversed(range(n)):
        x[i] = (x[i] - sum(low[k][i] * x[k] for k in range(i + 1, n))) / low[i][i]
    return x


def chain(links: int, *, bars: bool) -> Law:
    """Return the law of links of 1 m and 1 kg, even bars or masses at the ends, by angles from below.

    Lagrange's equations: sum_j c_ij (cos(q_i - q_j) q_j'' + sin(q_i - q_j) q_j'^2) + w_i g sin q_i = 0.
    """
    share = mpf(1) / 2 if bars else mpf(1)
    below = [links - 1 - i for i in range(links)]
    weights = [share + below[i] for i in range(links)]
    c = [[share + below[max(i, j)] if i != j else None for j in range(links)] for i in range(links)]
    for i in range(links):
        c[i][i] = (mpf(1) / 3 if bars else mpf(1)) + below[i]

    def law(q: Numbers, v: Numbers) -> Numbers:
        sines, cosines = [sin(x) for x in q], [cos(x) for x in q]
        a: list[Numbers] = []
        b = [-w * G * s for w, s in zip(weights, sines, strict=True)]
        for i in range(links):
            a.append([c[i][j] * (cosines[i] * cosines[j] + sines[i] * sines[j]) for j in range(links)])
            for j in range(links):
                b[i] -= c[i][j] * (sines[i] * cosines[j] - cosines[i] * sines[j]) * v[j] ** 2
        return solved(a, b)

    return law


def ends(q: Numbers, v: Numbers) -> dict[str, str]:
    """Return place and velocity of the end of a chain."""
    return shown(
        {
            "x": sum(sin(a) for a in q), "y": -sum(cos(a) for a in q),
            "vx": sum(w * cos(a) for a, w in zip(q, v, strict=True)),
            "vy": sum(w * sin(a) for a, w in zip(q, v, strict=True)),
        }
    )  # fmt: skip


def slider_crank(q: Numbers, v: Numbers) -> Numbers:
    """Return the acceleration of a crank of 0.5 m with a rod of 1.5 m and a slider, bars and all of 1 kg.

    By its angle from the rail: J q'' + J' q'^2 / 2 + U' = 0, with J = 2 T / q'^2 and the energy U of place.
    """
    r, rod = mpf(1) / 2, mpf(3) / 2
    s, c = sin(q[0]), cos(q[0])
    w = sqrt(rod * rod - r * r * s * s)
    x1 = -r * s - r * r * s * c / w  # the slider's place by the angle, once and twice
    x2 = -r * c - r * r * ((c * c - s * s) / w + r * r * s * s * c * c / w**3)
    t1, t2 = -r * c / w, r * s / w - r**3 * s * c * c / w**3  # the rod's angle
    j = r * r / 3 + ((x1 - r * s) ** 2 + (r * c) ** 2) / 4 + rod * rod / 12 * t1**2 + x1**2
    dj = (x1 - r * s) * (x2 - r * c) / 2 - r * r * s * c / 2 + rod * rod / 6 * t1 * t2 + 2 * x1 * x2
    return [-(dj * v[0] ** 2 / 2 + G * r * c) / j]


def slider(q: Numbers, v: Numbers) -> dict[str, str]:
    """Return place and speed of the slider, and the crank's angle and speed."""
    r, rod, s, c = mpf(1) / 2, mpf(3) / 2, sin(q[0]), cos(q[0])
    w = sqrt(rod * rod - r * r * s * s)
    return shown({"x": r * c + w, "vx": v[0] * (-r * s - r * r * s * c / w), "angle": q[0], "spin": v[0]})


def turning(rate2: mpmath.mpf, spin: mpmath.mpf, t: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Return angle from below and speed of a pendulum, q'' = -rate2 sin q, that turns over its top.

    It is there with ``spin`` at first: q = 2 am(u, k) with u = K + w t, w = sqrt(rate2) / k.
    """
    k2 = 1 / (1 + spin**2 / (4 * rate2))
    w, k = sqrt(rate2 / k2), mpmath.ellipk(k2)
    u = k + w * t
    turns = mpmath.floor(u / (2 * k) + mpf(1) / 2)
    rest = u - 2 * k * turns
    q = 2 * (mpmath.asin(mpmath.ellipfun("sn", rest, m=k2)) + mpmath.pi * turns)
    return q, 2 * w * mpmath.ellipfun("dn", rest, m=k2)


def swinging(rate2: mpmath.mpf, start: mpmath.mpf, t: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Return angle and speed of a pendulum that is let go at an angle from below: sin(q/2) = k cd(w t, k)."""
    k, w = sin(start / 2), sqrt(rate2)
    cn, dn, sn = (mpmath.ellipfun(name, w * t, m=k * k) for name in ("cn", "dn", "sn"))
    q = 2 * mpmath.asin(k * cn / dn)
    return q, -2 * k * w * sqrt(1 - k * k) * sn / dn


def andrews(q: Numbers, v: Numbers) -> Numbers:
    """Return the accelerations of Andrews' mechanism, by the seven angles of the test set (andrews.py)."""
    return andrews_forces(q, v)[:7]


def andrews_forces(q: Numbers, v: Numbers) -> Numbers:
    """Return accelerations (7,) and multipliers (6,): M a + G^T l = f, G a = -Gdot v."""
    m1, m2, m3, m4, m5, m6, m7 = numbers("0.04325 0.00365 0.02373 0.00706 0.0705 0.00706 0.05498")
    i1, i2, i3, i4, i5, i6, i7 = numbers("2.194e-6 4.41e-7 5.255e-6 5.667e-7 1.169e-5 5.667e-7 1.912e-5")
    xb, yb, xc, yc = numbers("-0.03635 0.03273 0.014 0.072")
    d, da, rr, ra, ss, zt, u, e, zf = numbers("0.028 0.0115 0.007 0.00092 0.035 0.04 0.04 0.02 0.02")
    sa, sb, sc, sd, ta, tb, ua, ub = numbers("0.01874 0.01043 0.018 0.02 0.02308 0.00916 0.01228 0.00449")
    x4 = x6 = mpf("0.00579")
    be, th, ga, ph, de, om, ep = q
    bp, tp, gp, pp, dp, op, epp = v
    m = mpmath.zeros(13)
    m[0, 0] = m1 * ra**2 + m2 * (rr**2 - 2 * da * rr * cos(th) + da**2) + i1 + i2
    m[0, 1] = m2 * (da**2 - da * rr * cos(th)) + i2
    m[1, 1] = m2 * da**2 + i2
    m[2, 2] = m3 * (sa**2 + sb**2) + i3
    m[3, 3] = m4 * x4**2 + i4
    m[3, 4] = m4 * (x4**2 + zt * x4 * sin(ph)) + i4
    m[4, 4] = m4 * (zt**2 + 2 * zt * x4 * sin(ph) + x4**2) + m5 * (ta**2 + tb**2) + i4 + i5
    m[5, 5] = m6 * x6**2 + i6
    m[5, 6] = m6 * (x6**2 - u * x6 * sin(om)) + i6
    m[6, 6] = m6 * (x6**2 - 2 * u * x6 * sin(om) + u**2) + m7 * (ua**2 + ub**2) + i6 + i7
    xd, yd = sd * cos(ga) + sc * sin(ga) + xb - xc, sd * sin(ga) - sc * cos(ga) + yb - yc
    long = sqrt(xd**2 + yd**2)
    pull = -4530 * (long - mpf("0.07785")) / long
    f = [
        mpf("0.033") - m2 * da * rr * tp * (tp + 2 * bp) * sin(th),
        m2 * da * rr * bp**2 * sin(th),
        pull * (xd * (sc * cos(ga) - sd * sin(ga)) + yd * (sd * cos(ga) + sc * sin(ga))),
        m4 * zt * x4 * dp**2 * cos(ph),
        -m4 * zt * x4 * pp * (pp + 2 * dp) * cos(ph),
        -m6 * u * x6 * epp**2 * cos(om),
        m6 * u * x6 * op * (op + 2 * epp) * cos(om),
    ]
    # Each of the three loops: the end of the second body is where another one ends; x, then y.
    bt, pd, oe, own = be + th, ph + de, om + ep, bp + tp
    for loop in range(3):
        x, y = 7 + 2 * loop, 8 + 2 * loop
        m[0, x], m[1, x] = -rr * sin(be) + d * sin(bt), d * sin(bt)
        m[0, y], m[1, y] = rr * cos(be) - d * cos(bt), -d * cos(bt)
        fx = rr * cos(be) * bp**2 - d * cos(bt) * own**2
        fy = rr * sin(be) * bp**2 - d * sin(bt) * own**2
        if loop == 0:
            m[2, x], m[2, y] = -ss * cos(ga), -ss * sin(ga)
            fx, fy = fx - ss * sin(ga) * gp**2, fy + ss * cos(ga) * gp**2
        elif loop == 1:
            w = pp + dp
            m[3, x], m[4, x] = -e * cos(pd), -e * cos(pd) + zt * sin(de)
            m[3, y], m[4, y] = -e * sin(pd), -e * sin(pd) - zt * cos(de)
            fx -= e * sin(pd) * w**2 + zt * cos(de) * dp**2
            fy -= -e * cos(pd) * w**2 + zt * sin(de) * dp**2
        else:
            w = op + epp
            m[5, x], m[6, x] = zf * sin(oe), zf * sin(oe) - u * cos(ep)
            m[5, y], m[6, y] = -zf * cos(oe), -zf * cos(oe) - u * sin(ep)
            fx -= zf * cos(oe) * w**2 + u * sin(ep) * epp**2
            fy -= zf * sin(oe) * w**2 - u * cos(ep) * epp**2
        f += [fx, fy]
    for i in range(13):
        for j in range(i):
            m[i, j] = m[j, i]
    return list(mpmath.lu_solve(m, mpmath.matrix(f)))


def andrews_figures(steps: int) -> dict[str, str]:
    """Return the 27 values after 0.03 s."""
    state = [mpf(x) for x in START] + [mpf(0)] * 7
    for _ in range(steps):
        state = step(andrews, state, mpf("0.03") / steps)
    values = state + andrews_forces(state[:7], state[7:])
    return shown({f"y{n + 1}": value for n, value in enumerate(values)})


def shown(values: dict[str, mpmath.mpf]) -> dict[str, str]:
    """Return figures with 22 digits."""
    return {key: mpmath.nstr(value, 22, strip_zeros=False) for key, value in values.items()}


def pendulum(q: mpmath.mpf, v: mpmath.mpf) -> dict[str, str]:
    """Return place and velocity of a point 1 m from where it turns."""
    return ends([q], [v])


def by_steps(
    law: Law, state: Numbers, read: Callable[[Numbers, Numbers], dict[str, str]], steps: int, times: list[int]
) -> dict[str, dict[str, str]]:
    """Return the figures at times; print how far runs with other steps are off."""
    fine, coarse = (run(law, state, times, n) for n in (steps, steps * 5 // 6))
    size = len(state) // 2
    for t in times:
        print(
            t,
            mpmath.nstr(max(abs(x - y) for x, y in zip(fine[t], coarse[t], strict=True)), 3),
            file=sys.stderr,
        )
    return {f"t={t}": read(fine[t][:size], fine[t][size:]) for t in times}


def references() -> dict[str, Callable[[], dict[str, dict[str, str]]]]:
    """Return what computes the figures of each problem, by its name."""
    zero, times = mpf(0), [1, 10]
    loop = (mpf(7) / 2 * G) / 3  # two loops: three cranks, two tops
    return {
        "rod_pendulum": lambda: {f"t={t}": pendulum(*swinging(G, mpf(5) / 2, mpf(t))) for t in times},
        "four_bar": lambda: {f"t={t}": pendulum(*turning(loop, mpf(1), mpf(t))) for t in times},
        "double_pendulum": lambda: by_steps(
            chain(2, bars=False), [mpf(1), mpf(1), zero, zero], ends, 48, times
        ),
        "double_bars": lambda: by_steps(chain(2, bars=True), [mpf(1), mpf(1), zero, zero], ends, 24, times),
        "slider_crank": lambda: by_steps(slider_crank, [zero, mpf(4)], slider, 32, times),
        "ten_links": lambda: by_steps(chain(10, bars=True), [mpf(1) / 2] * 10 + [zero] * 10, ends, 12, times),
    }


if __name__ == "__main__":
    mpmath.mp.dps = 40
    for name, compute in references().items():
        if name in sys.argv[1:] or len(sys.argv) == 1:
            print(json.dumps({name: compute()}, indent=1), flush=True)
    if "andrews" in sys.argv[1:] or len(sys.argv) == 1:
        print(json.dumps({"andrews": andrews_figures(60)}, indent=1))
