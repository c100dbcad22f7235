"""A line of a graph as a tone, for who cannot see it: the higher the value, the higher the tone."""

import numpy as np
from numpy.typing import NDArray

RATE = 22_050
"""Samples a second."""
LASTS = 3.0
"""How long the whole line takes [s]."""
LOWEST, HIGHEST = 200.0, 1000.0
"""Frequencies of the least and of the greatest value [Hz]: equal shares of the range are equal intervals."""
_TICK, _TICK_S = 2500.0, 0.03
"""Frequency [Hz] and length [s] of the tick where the line crosses zero."""
_FADE_S = 0.01
_LOUD = 0.4

type _Numbers = NDArray[np.float64]


def pitches(times: _Numbers, values: _Numbers) -> _Numbers:
    """Return the frequency [Hz] of each sample of the tone of a line, NaN where there is no value.

    Parameters
    ----------
    times, values : float64 arrays (n,)
        The line; times grow. NaN stands for no value.

    Returns
    -------
    float64 array (LASTS * RATE,)
    """
    count, known = round(LASTS * RATE), np.isfinite(values)
    if not known.any():
        return np.full(count, np.nan)
    moments = np.linspace(times[0], times[-1], count)
    size = float(np.abs(values[known]).max()) or 1.0
    shares = values[known] / size  # the difference of two finite numbers may be infinite
    line = np.interp(moments, times[known], shares)
    nearest = np.clip(np.searchsorted(times, moments), 0, len(times) - 1)
    low, high = shares.min(), shares.max()
    share = (line - low) / (high - low) if high > low else np.full(count, 0.5)
    return np.where(known[nearest], LOWEST * (HIGHEST / LOWEST) ** share, np.nan)


def crossings(times: _Numbers, values: _Numbers) -> list[int]:
    """Return the samples of the tone at which the line changes its sign.

    Parameters
    ----------
    times, values : float64 arrays (n,)
        The line, as in :func:`pitches`.
    """
    known = np.isfinite(values) & (values != 0.0)
    signs, at = np.sign(values[known]), times[known]
    where = at[1:][signs[1:] != signs[:-1]]
    span = times[-1] - times[0] if len(times) else 0.0
    return [round((moment - times[0]) / span * (LASTS * RATE - 1)) for moment in where] if span > 0.0 else []


def tone(times: _Numbers, values: _Numbers) -> NDArray[np.int16]:
    """Return the samples (LASTS * RATE,) of the tone of a line, with a tick wherever it crosses zero.

    Parameters
    ----------
    times, values : float64 arrays (n,)
        The line, as in :func:`pitches`.
    """
    frequency = pitches(times, values)
    heard = np.isfinite(frequency)
    phase = 2.0 * np.pi * np.cumsum(np.where(heard, frequency, 0.0)) / RATE
    fade = np.convolve(heard, np.full(round(_FADE_S * RATE), 1.0 / round(_FADE_S * RATE)), "same")
    fade *= np.minimum(1.0, np.minimum(np.arange(len(heard)), np.arange(len(heard))[::-1]) / (_FADE_S * RATE))
    wave = _LOUD * fade * heard * np.sin(phase)
    length = round(_TICK_S * RATE)
    tick = _LOUD * np.sin(2.0 * np.pi * _TICK * np.arange(length) / RATE) * np.linspace(1.0, 0.0, length)
    for start in crossings(times, values):
        end = min(start + length, len(wave))
        wave[start:end] += tick[: end - start]
    samples: NDArray[np.int16] = (32767.0 * np.clip(wave, -1.0, 1.0)).astype(np.int16)
    return samples
