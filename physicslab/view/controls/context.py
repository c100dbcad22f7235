"""Subject of a place's menu: the body, the joint or the spring that lies there, or empty space."""

from physicslab.components import Transform
from physicslab.view.controls.picking import body_at, link_at
from physicslab.view.picture.joints import joint_at
from physicslab.view.window.context import Context
from physicslab.view.window.window import Window
from physicslab.world import World


def thing_at(world: World, window: Window) -> int | None:
    """Return the joint, the body or the spring under the cursor, if there is one."""
    joint = joint_at(world, window.camera, window.pointer)
    body = body_at(world, window.camera, window.pointer) if joint is None else joint
    return link_at(world, window.camera, window.pointer) if body is None else body


def open_context(world: World, window: Window) -> None:
    """Open the menu of what is under the cursor, and select that, unless it is selected with others."""
    window.sketch.cancel()
    if window.lesson is not None:
        return  # it shuts all that the menu does
    entity = thing_at(world, window)
    if entity is None:
        window.selection.clear()
    elif entity not in window.selection.entities:
        window.selection.take(entity)
    is_body = entity is not None and world.has(entity, Transform)
    window.context = Context(entity, is_body, window.pointer, window.place)
