"""The sound of impacts, made of numbers; off at first, and silent where there is no device for it."""

import math
from collections import OrderedDict
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.components import MadeOf, Shape
from physicslab.components.made_of import look_of
from physicslab.state.shapes import lengths_of
from physicslab.view.window.listening import RATE
from physicslab.world import World

_CHANNELS, _PER_FRAME = 16, 6
"""Sounds at once, and new ones in a frame."""
_MAX_SOUNDS = 200
"""Number of sounds that are kept."""
_TONE, _SIZE = 330.0, 0.5
"""Frequency [Hz] of a plain body of such a size [m]: twice as large is an octave deeper."""
_LOWEST, _HIGHEST, _STEPS = 60.0, 5_000.0, 6
"""Range of frequencies [Hz], and steps in an octave."""
_TYPICAL, _FAINTEST = 3.0, 0.02
"""Impulse [N s] that is about two thirds as loud as can be, and loudness below which nothing is heard."""
_VOICES = {
    "plain": (1.0, 0.09, (1.0, 0.35)),
    "grain": (0.9, 0.08, (1.0, 0.5, 0.2)),
    "metal": (2.6, 0.55, (1.0, 0.7, 0.5, 0.35)),
    "frost": (1.7, 0.14, (1.0, 0.6, 0.3)),
    "matt": (0.45, 0.06, (1.0, 0.15)),
    "clear": (2.9, 0.32, (1.0, 0.55, 0.45)),
    "speckle": (1.3, 0.06, (1.0, 0.6, 0.5)),
}
"""How materials sound: their pitch as a share of a plain body's, how long they ring [s], their partials.

These are for the ear, and measure nothing.
"""
_PARTIALS = (1.0, 2.76, 5.40, 8.93)
"""Frequencies of a free bar that bends, as multiples of the lowest (Rayleigh, The Theory of Sound, 174)."""


class Sounds:
    """Plays an impact's sound: deep of what is large, short or ringing by the material, loud by the impulse.

    Attributes
    ----------
    on : bool
        Whether impacts are to be heard.
    failure : str
        Why they cannot be; empty while they can.
    played : int
        How many were heard.
    """

    def __init__(self) -> None:
        self.on = False
        self.failure = ""
        self.played = 0
        self._heard: pygame.mixer.Sound | None = None
        self._kept: OrderedDict[tuple[int, str], pygame.mixer.Sound] = OrderedDict()

    def play(self, world: World, impacts: NDArray[Any]) -> None:
        """Let the loudest of new impacts, of IMPACT (n,), be heard."""
        if not (self.on and len(impacts)) or not self._open():
            return
        loudness = 1.0 - np.exp(-impacts["normal_impulse"] / _TYPICAL)
        for n in np.argsort(-loudness, kind="stable")[:_PER_FRAME].tolist():
            channel = pygame.mixer.find_channel()
            if channel is None or not loudness[n] >= _FAINTEST:
                return
            channel.set_volume(float(loudness[n]))
            channel.play(self._sound(*voice_of(world, impacts[n])))
            self.played += 1

    def listen(self, wave: NDArray[np.int16]) -> None:
        """Let samples (n,) be heard, in place of those before; where it cannot be, ``failure`` says why."""
        if self._open():
            if self._heard is not None:
                self._heard.stop()
            self._heard = _made(wave)
            self._heard.play()
            self.played += 1

    def _open(self) -> bool:
        """Open the device at the first sound; where there is none it is silent, and says why."""
        if not pygame.mixer.get_init() and not self.failure:
            try:
                pygame.mixer.init(RATE, -16, 1, 512)
                pygame.mixer.set_num_channels(_CHANNELS)
            except pygame.error as error:
                self.failure = str(error)
        return not self.failure

    def _sound(self, pitch: int, look: str) -> pygame.mixer.Sound:
        key = pitch, look
        if key not in self._kept:
            if len(self._kept) >= _MAX_SOUNDS:
                self._kept.popitem(last=False)
            self._kept[key] = _made(wave_of(pitch, look))
        self._kept.move_to_end(key)
        return self._kept[key]


def _made(wave: NDArray[np.int16]) -> pygame.mixer.Sound:
    _, _, channels = pygame.mixer.get_init() or (RATE, -16, 1)
    return pygame.mixer.Sound(
        buffer=np.ascontiguousarray(np.repeat(wave[:, None], channels, axis=1)).tobytes()
    )


def voice_of(world: World, impact: Any) -> tuple[int, str]:
    """Return the pitch, in steps above the lowest, and the look of what is heard of an impact, one IMPACT.

    That is the smaller one of the bodies that it moved.
    """
    found = []
    for body in "ab":
        entity = int(impact[f"entity_{body}"])
        if impact[f"inverse_mass_{body}"] > 0.0 and world.has(entity, Shape):
            half, radius = lengths_of(world.table(Shape), world.entity_index.rows_of(np.array([entity])))
            size = 2.0 * float(np.sqrt((half[0, 0] + radius[0]) * (half[0, 1] + radius[0])))
            found.append((max(size, 1e-6), entity))
    if not found:
        return _steps(_TONE), "plain"
    size, entity = min(found)
    look = look_of(world.component(entity, MadeOf).material) if world.has(entity, MadeOf) else "plain"
    return _steps(_TONE * _VOICES[look][0] * _SIZE / size), look


def _steps(frequency: float) -> int:
    return round(_STEPS * math.log2(min(max(frequency, _LOWEST), _HIGHEST) / _LOWEST))


def wave_of(pitch: int, look: str) -> NDArray[np.int16]:
    """Return the samples (n,) of a sound: partials of a bar, the higher ones the shorter."""
    _, ring, shares = _VOICES[look]
    frequency = _LOWEST * 2.0 ** (pitch / _STEPS)
    time = np.arange(round(RATE * min(6.0 * ring, 1.5))) / RATE
    wave = np.zeros(len(time))
    for share, partial in zip(shares, _PARTIALS, strict=False):
        if partial * frequency < 0.45 * RATE:
            wave += (
                share * np.exp(-time * partial**0.7 / ring) * np.sin(2.0 * np.pi * partial * frequency * time)
            )
    wave *= np.minimum(time / 0.002, 1.0)  # no click as it begins
    samples: NDArray[np.int16] = (0.6 * 32767.0 * wave / max(float(np.abs(wave).max()), 1e-9)).astype(
        np.int16
    )
    return samples
