"""Joints as the heads of screws; one that is fixed to the world has a bracket behind it."""

import numpy as np

from physicslab.diagnostics.joints import joint_states
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look
from physicslab.view.canvas.theme import Theme
from physicslab.world import World

_HEAD = 5.0
"""Radius of the head of a screw [px]."""
_SLOT = 3.4
"""Half length of the slot in it [px]."""
_BRACKET = 18.0
"""Side of a bracket [px]."""


def draw_joints(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the head of a screw at every joint, whose slot turns with what it holds."""
    joints = joint_states(world)
    if not joints:
        return
    centre = camera.project(np.array([(joint.place.x, joint.place.y) for joint in joints]))
    with np.errstate(invalid="ignore"):
        seen = ((centre > -_BRACKET) & (centre < np.array(camera.size) + _BRACKET)).all(axis=1)
    centre = centre[seen]
    if not len(centre):
        return
    angle = np.array([joint.angle for joint in joints])[seen]
    fixed = np.array([joint.is_fixed for joint in joints])[seen]
    if fixed.any():
        count = int(fixed.sum())
        side = np.full((count, 2), _BRACKET)
        plate = Look.plain(theme.background, theme.pin, count)
        plate.hatched[:] = True
        canvas.boxes(centre[fixed], side, np.zeros(count), plate)
    look = Look.plain(theme.background, theme.pin, len(centre))
    canvas.discs(centre, np.full(len(centre), _HEAD), angle, look)
    along = _SLOT * np.stack((np.cos(angle), -np.sin(angle)), axis=1)
    canvas.lines(centre - along, centre + along, theme.pin, 2.0)


def joint_at(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the entity of the joint whose screw is under a place on the screen [px], or ``None``."""
    joints = joint_states(world)
    if not joints:
        return None
    centre = camera.project(np.array([(joint.place.x, joint.place.y) for joint in joints]))
    with np.errstate(all="ignore"):
        distance = np.hypot(centre[:, 0] - pixel[0], centre[:, 1] - pixel[1])
    distance[~np.isfinite(distance)] = np.inf
    nearest = int(np.argmin(distance))
    return joints[nearest].entity if distance[nearest] <= _HEAD + 1.0 else None
