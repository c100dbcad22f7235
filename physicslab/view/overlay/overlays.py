"""Which overlays are shown, the scales of their arrows, and what is kept from frame to frame."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Velocity
from physicslab.state.shapes import lengths_of
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.quantities import round_quantity, rounded_up
from physicslab.view.overlay.contact_samples import RecentImpacts
from physicslab.view.overlay.labels import Labels
from physicslab.world import World

_MEMORY = 4.0
"""Time [s] in which the memory of a strong value fades to a third."""
_SHORTEST, _LONGEST = 0.25, 1.3
"""While the longest arrow is within these shares of the wanted length, the scale stays."""


class Gauge:
    """How much of a quantity a metre of arrow stands for: 1, 2 or 5 times a power of ten.

    The scale follows the strongest value of the last seconds. It depends on the world alone: zooming enlarges
    arrows together with all else, and the legend stays true.

    Parameters
    ----------
    unit : str
        Of the quantity.

    Attributes
    ----------
    per_metre : float
        How much one metre stands for; 0 before anything was shown.
    kept : bool
        Whether it stays as it is, so that two pictures can be compared.

    Examples
    --------
    >>> gauge = Gauge("m/s")
    >>> gauge.follow(np.array([3.0]), reach=1.5, time=0.0)
    >>> gauge.words
    '1 m = 2 m/s'
    """

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.per_metre = 0.0
        self.kept = False
        self._peak = 0.0
        self._time = 0.0

    def follow(self, values: NDArray[np.float64], reach: float, time: float) -> None:
        """Take in the magnitudes of a frame; the strongest should be about ``reach`` [m] long."""
        if self.kept and self.per_metre:
            return
        strongest = float(np.max(values, initial=0.0, where=np.isfinite(values)))
        faded = self._peak * math.exp(-max(time - self._time, 0.0) / _MEMORY)
        self._peak, self._time = max(strongest, faded), time
        wanted = self._peak / reach
        if wanted > 1e-12 and not _SHORTEST * self.per_metre <= wanted <= _LONGEST * self.per_metre:
            self.per_metre = rounded_up(wanted, 1e-3)

    @property
    def words(self) -> str:
        """The scale, as it stands in the legend."""
        return f"1 m = {round_quantity(self.per_metre, self.unit)}" if self.per_metre else "none yet"


_REACH = 0.13
"""Length of the longest arrow, as a share of the smaller side of the picture."""
_MAX_IN_CROWD = 2.0
"""Its greatest length among several bodies, in sizes of a body: no arrow is lost among the others."""
_MIN_LENGTH = 16.0
"""Its length is at least that [px]."""


class Overlays:
    """The state of the overlays; all of it is the window's, none the world's.

    Attributes
    ----------
    arrows, impulses : bool
        Whether velocities, forces and normals are shown, and whether impulses are.
    keeps_scales : bool
        Whether the scales of arrows stay as they are.
    reach : float
        The wanted length of the strongest arrow [m], chosen when an overlay is turned on.
    velocity, force, impact, rest : Gauge
        The scales: of velocities, forces, impulses of impacts, and impulses that hold bodies apart.
    body_force : Gauge
        The scale of the forces on the selection.
    force_labels : Labels
        Where their names stand.
    impacts : RecentImpacts
        The impacts of the last second.
    labels : Labels
        Where the numbers stand.
    covered : list of Rect
        What the HUD covers [px]; labels keep clear of it.
    """

    def __init__(self) -> None:
        self.arrows = self.impulses = self.keeps_scales = False
        self.reach = 1.0
        self.velocity, self.force = Gauge("m/s"), Gauge("N")
        self.impact, self.rest = Gauge("N s"), Gauge("N s")
        self.body_force, self.force_labels = Gauge("N"), Labels()
        self.impacts = RecentImpacts()
        self.labels = Labels()
        self.covered: list[Rect] = []

    def toggle_arrows(self, world: World, camera: Camera) -> None:
        """Show or hide velocities, forces and contact normals."""
        self.arrows = not self.arrows
        if self.arrows and not self.keeps_scales:
            self.velocity, self.force = Gauge("m/s"), Gauge("N")
            self._measure(world, camera)

    def toggle_impulses(self, world: World, camera: Camera) -> None:
        """Show or hide the impulses at contacts."""
        self.impulses = not self.impulses
        if self.impulses and not self.keeps_scales:
            self.impact, self.rest = Gauge("N s"), Gauge("N s")
            self._measure(world, camera)
        self.forget()

    def toggle_scales(self) -> None:
        """Let the scales of all arrows stay as they are, or follow what is shown again."""
        self.keeps_scales = not self.keeps_scales
        for gauge in (self.velocity, self.force, self.impact, self.rest, self.body_force):
            gauge.kept = self.keeps_scales

    def forget(self) -> None:
        """Forget impacts and the places of labels: they belong to what was shown before."""
        self.impacts.clear()
        self.labels.clear()
        self.force_labels.clear()

    def _measure(self, world: World, camera: Camera) -> None:
        shape = world.table(Shape)
        rows = world.batch(Shape, Velocity).rows
        self.reach = _REACH * min(camera.size) / camera.scale
        if len(rows) > 1:
            half, radius = lengths_of(shape, rows)
            size = 2.0 * (half.max(axis=1) + radius)
            self.reach = min(
                self.reach, max(_MAX_IN_CROWD * float(np.median(size)), _MIN_LENGTH / camera.scale)
            )
