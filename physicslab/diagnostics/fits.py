"""Curves fitted to samples by least squares, with the standard errors of their parameters."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Numbers = NDArray[np.float64]
"""A float64 array (n,)."""

_MOST = 4000
"""Samples that a fit goes through: of more every so many are taken."""
_GUESS, _FINER = 1024, 8
"""Samples of the spectrum in which a sine's frequency is looked for, and by how much it is made finer."""
_EQUAL_SAMPLES_SHARE = 1e-12
"""Share of the largest value up to which samples are alike."""
_ROUNDS, _DONE = 60, 1e-13
"""Most steps of a fit that is not linear, and the relative change of the sum of squares at which it ends."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a curve.

    Attributes
    ----------
    name : str
        Its name.
    value, error : float
        It, and its standard error.
    across, up : int
        The powers of the units of x and of y in its unit.
    """

    name: str
    value: float
    error: float
    across: int
    up: int


@dataclass(frozen=True, slots=True)
class Fit:
    """A curve that was fitted.

    Attributes
    ----------
    parameters : tuple of Parameter
        Those that people read.
    rest : float
        Root of the mean square of what it leaves, in the unit of y.
    curve : callable
        Returns its y at each x, arrays (n,).
    """

    parameters: tuple[Parameter, ...]
    rest: float
    curve: Callable[[Numbers], Numbers]


def covariance_of(jacobian: Numbers, rests: Numbers) -> Numbers:
    """Return the covariance s^2 (J^T J)^-1 of parameters (Press et al., Numerical Recipes, 2007, 15.4).

    Parameters
    ----------
    jacobian : float64 array (n, parameters)
        Derivatives of the residuals by the parameters.
    rests : float64 array (n,)
        Residuals.
    """
    count, unknown = jacobian.shape
    variance = float(rests @ rests) / max(count - unknown, 1)
    return np.asarray(variance * np.linalg.pinv(jacobian.T @ jacobian), np.float64)


def _polynomial(degree: int) -> Callable[[Numbers, Numbers], Fit]:
    names = (("value at 0", 0), ("slope at 0", -1), ("second derivative", -2))

    def fitted(x: Numbers, y: Numbers) -> Fit:
        middle, span = 0.5 * (x[0] + x[-1]), max(float(np.ptp(x)), 1e-300)
        jacobian = ((x - middle) / span)[:, None] ** np.arange(degree + 1)
        found = np.linalg.lstsq(jacobian, y, rcond=None)[0]
        rests = y - jacobian @ found
        # from powers of (x - middle) / span to those of x
        back = np.zeros((degree + 1, degree + 1))
        for n in range(degree + 1):
            for k in range(n + 1):
                back[k, n] = math.comb(n, k) * (-middle) ** (n - k) / span**n
        back[2:] *= 2.0
        values = back @ found
        errors = np.sqrt(np.diag(back @ covariance_of(jacobian, rests) @ back.T))
        parameters = tuple(
            Parameter(name, float(value), float(error), power, 1)
            for (name, power), value, error in zip(names, values, errors, strict=False)
        )

        def curve(at: Numbers) -> Numbers:
            return np.asarray(((at - middle) / span)[:, None] ** np.arange(degree + 1) @ found)

        return Fit(parameters[::-1], _rest(rests), curve)

    return fitted


def _sine(x: Numbers, y: Numbers) -> Fit:
    """Fit m + b cos(w x) + c sin(w x) by Gauss and Newton, from the strongest frequency on, with damping."""
    start = x[0]
    x = x - start

    def model(w: float) -> tuple[Numbers, Numbers, Numbers]:
        basis = np.column_stack((np.ones_like(x), np.cos(w * x), np.sin(w * x)))
        found = np.linalg.lstsq(basis, y, rcond=None)[0]
        return basis, found, y - basis @ found

    w = _frequency(x, y)
    basis, found, rests = model(w)
    jacobian = np.column_stack((basis, np.zeros_like(x)))
    for _ in range(_ROUNDS):
        jacobian = np.column_stack((basis, x * (found[2] * basis[:, 1] - found[1] * basis[:, 2])))
        step = float(np.linalg.lstsq(jacobian, rests, rcond=None)[0][3])
        before = float(rests @ rests)
        while abs(step) > 1e-15 * w:
            tried = model(w + step) if w + step > 0.0 else None
            if tried is not None and float(tried[2] @ tried[2]) <= before:
                w, (basis, found, rests) = w + step, tried
                break
            step *= 0.5
        if before - float(rests @ rests) <= _DONE * before:
            break
    covariance = covariance_of(jacobian, rests)
    amplitude = math.hypot(found[1], found[2])
    along = np.array([0.0, found[1], found[2], 0.0]) / max(amplitude, 1e-300)
    parameters = (
        Parameter("amplitude", amplitude, math.sqrt(along @ covariance @ along), 0, 1),
        Parameter("period", 2.0 * math.pi / w, 2.0 * math.pi / w**2 * math.sqrt(covariance[3, 3]), 1, 0),
        Parameter("middle", float(found[0]), math.sqrt(covariance[0, 0]), 0, 1),
    )

    def curve(at: Numbers) -> Numbers:
        turned = w * (at - start)
        return np.asarray(found[0] + found[1] * np.cos(turned) + found[2] * np.sin(turned))

    return Fit(parameters, _rest(rests), curve)


def _frequency(x: Numbers, y: Numbers) -> float:
    """Return the strongest angular frequency of samples, at least that of half a turn."""
    even = np.linspace(0.0, x[-1], _GUESS)
    levels = np.interp(even, x, y)
    spectrum = np.abs(np.fft.rfft(levels - levels.mean(), _FINER * _GUESS))
    first = _FINER // 2
    peak = first + int(np.argmax(spectrum[first:]))
    return 2.0 * math.pi * peak / (_FINER * float(x[-1]) * _GUESS / (_GUESS - 1))


def _rest(rests: Numbers) -> float:
    return math.sqrt(float(np.mean(rests**2)))


FITS: dict[str, tuple[Callable[[Numbers, Numbers], Fit], int]] = {
    "line": (_polynomial(1), 3), "parabola": (_polynomial(2), 4), "sine": (_sine, 6),
}  # fmt: skip
"""Curves that can be fitted, and the least number of samples for each."""


def fit(kind: str, x: Numbers, y: Numbers) -> Fit | None:
    """Fit a curve, one of ``FITS``, to samples.

    The standard errors take what the curve leaves for noise that is independent from sample to sample.

    Parameters
    ----------
    x, y : float64 arrays (n,)
        The samples; those that are NaN are left out.

    Returns
    -------
    Fit or None
        None where there are too few, or all are at one x; of a sine also where all are alike.

    Examples
    --------
    >>> x = np.linspace(0.0, 2.0, 9)
    >>> slope, start = fit("line", x, 3.0 * x + 1.0).parameters
    >>> round(slope.value, 9), round(start.value, 9)
    (3.0, 1.0)
    """
    there = np.isfinite(x) & np.isfinite(y)
    x, y = x[there], y[there]
    fitted, least = FITS[kind]
    every = -(-len(x) // _MOST)
    x, y = x[:: max(every, 1)], y[:: max(every, 1)]
    if len(np.unique(x)) < least:
        return None
    if kind == "sine":
        if np.ptp(y) <= _EQUAL_SAMPLES_SHARE * np.abs(y).max():
            return None
        order = np.argsort(x, kind="stable")
        x, y = x[order], y[order]
    with np.errstate(all="ignore"):
        found = fitted(x, y)
    figures = [found.rest, *(part for one in found.parameters for part in (one.value, one.error))]
    return found if all(map(math.isfinite, figures)) else None
