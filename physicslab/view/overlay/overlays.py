"""Which overlays are shown, and what is kept for them from frame to frame."""

from __future__ import annotations

import numpy as np

from physicslab.components import Shape, Velocity
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Rect
from physicslab.view.overlay.gauge import Gauge
from physicslab.view.overlay.impacts import RecentImpacts
from physicslab.view.overlay.labels import Labels
from physicslab.world import World

__all__ = ["Overlays"]

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
            size = np.maximum(
                2.0 * shape["radius"][rows], np.maximum(shape["width"][rows], shape["height"][rows])
            )
            self.reach = min(
                self.reach, max(_MAX_IN_CROWD * float(np.median(size)), _MIN_LENGTH / camera.scale)
            )
