"""What the user can do, one function each, whichever key or button asks for it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from physicslab.config import PhysicsConfig
from physicslab.fields import InvalidValue
from physicslab.prefabs import box, circle, pendulum
from physicslab.scene import SceneError, load_scene, save_scene
from physicslab.view.picking import body_at
from physicslab.view.scene_files import new_scene_path, newest_scene
from physicslab.view.window import Window
from physicslab.world import World

__all__ = [
    "ask_screenshot", "begin_spring", "clear", "close", "end_spring", "faster", "fit", "go_home", "leave",
    "press", "release", "remove", "reopen", "save", "slower",
    "spawn_box", "spawn_circle", "spawn_pendulum", "step",
    "toggle_arrows", "toggle_gravity", "toggle_grid", "toggle_help", "toggle_impulses", "toggle_pause",
    "toggle_planets", "toggle_slow_motion", "toggle_trails", "zoom",
]  # fmt: skip

_RADII = (0.22, 0.30, 0.18, 0.26, 0.34)
_SIZES = ((0.5, 0.5), (0.8, 0.4), (0.4, 0.7), (0.6, 0.6), (1.0, 0.3))
"""The sizes of what is spawned, in turn [m]."""
_DENSITY = 5.0
"""Mass of what is spawned per area [kg/m^2]."""
_RESTITUTION = 0.4


def press(world: World, window: Window) -> None:
    """Take hold of the body under the cursor, or spawn a circle where there is none."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is None:
        spawn_circle(world, window)
    elif not window.hand.take(world, entity, window.place, window.now):
        window.notify(f"{world.label(entity)} is static: it stays where it is")


def release(world: World, window: Window) -> None:
    """Let go of what is held."""
    window.hand.release(world, window.place, window.now, window.pace.paused)


def _next_size[T](window: Window, sizes: tuple[T, ...]) -> T:
    window.spawned += 1
    return sizes[window.spawned % len(sizes)]


def spawn_circle(world: World, window: Window) -> None:
    """Make a circle at the cursor."""
    radius = _next_size(window, _RADII)
    mass = _DENSITY * math.pi * radius * radius
    circle(world, window.place, radius=radius, mass=mass, restitution=_RESTITUTION)


def spawn_box(world: World, window: Window) -> None:
    """Make a rectangle at the cursor."""
    width, height = _next_size(window, _SIZES)
    mass = _DENSITY * width * height
    box(world, window.place, width=width, height=height, mass=mass, restitution=_RESTITUTION)


def spawn_pendulum(world: World, window: Window) -> None:
    """Hang a pendulum from the cursor."""
    window.spawned += 1
    pendulum(world, window.place, length=1.5, angle=0.7)


def toggle_pause(world: World, window: Window) -> None:
    """Let time stand still, or go on."""
    window.pace.toggle_pause()
    if not window.pace.paused:
        window.error = ""


def toggle_slow_motion(world: World, window: Window) -> None:
    """Let time run at a quarter of its speed, or as usual."""
    window.pace.slow_motion = not window.pace.slow_motion


def slower(world: World, window: Window) -> None:
    """Let time run at half the speed."""
    window.pace.choose(0.5)


def faster(world: World, window: Window) -> None:
    """Let time run at twice the speed."""
    window.pace.choose(2.0)


def step(world: World, window: Window) -> None:
    """Pause, and make one step."""
    window.pace.ask_step()


def remove(world: World, window: Window) -> None:
    """Remove the body under the cursor; its springs go with it."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is None:
        window.notify("Nothing to remove: put the cursor on a body")
        return
    if window.hand.entity == entity:
        window.hand.drop(world)
    world.remove(entity)


def begin_spring(world: World, window: Window) -> None:
    """Begin a spring at the body under the cursor."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is None:
        window.notify(
            "A spring begins on a body: put the cursor on one, hold S, and drag to where it shall end"
        )
    else:
        window.spring_tool.begin(world, entity, window.place)


def end_spring(world: World, window: Window) -> None:
    """End the spring at the body under the cursor, or at that point of the world."""
    target = body_at(world, window.camera, window.pointer)
    refused = window.spring_tool.end(world, target, window.place)
    if refused:
        window.notify(refused)


def save(world: World, window: Window) -> None:
    """Save the world to a new scene file where the program was started."""
    try:
        path = new_scene_path(Path.cwd(), world.name)
        save_scene(world, path)
    except (SceneError, OSError) as error:
        window.notify(f"The scene could not be saved: {error}", 6.0, failed=True)
    else:
        window.scene_file = path
        window.notify(f"Saved {path}")


def reopen(world: World, window: Window) -> None:
    """Open the scene file last saved or opened, or else the newest; where that fails, all stays as it is."""
    try:
        path = window.scene_file or newest_scene(Path.cwd())
        if path is None:
            window.notify(f"There is no scene file in {Path.cwd()}: Ctrl+S saves one", failed=True)
            return
        opened = load_scene(path)
        opened.synchronise()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not opened: {error}", 8.0, failed=True)
    else:
        window.scene_file, window.next_world = path, opened
        window.notify(f"Opened {path}")


def clear(world: World, window: Window) -> None:
    """Remove everything."""
    window.hand.drop(world)
    window.spring_tool.cancel()
    world.clear()
    window.overlays.forget()
    window.sparks.clear()
    window.error = ""


def toggle_gravity(world: World, window: Window) -> None:
    """Turn the uniform pull on or off; where the scene has none to turn on, it is that of the Earth."""
    if world.physics.gravity_mode == "linear" and world.physics.gravity:
        world.physics = replace(world.physics, gravity_mode="none")
    else:
        gravity = world.physics.gravity or PhysicsConfig().gravity
        world.physics = replace(world.physics, gravity_mode="linear", gravity=gravity)


def toggle_planets(world: World, window: Window) -> None:
    """Let bodies attract each other, or go back to the gravity there was before."""
    if world.physics.gravity_mode == "planet":
        world.physics = replace(world.physics, gravity_mode=window.gravity_before)
    else:
        window.gravity_before = world.physics.gravity_mode
        world.physics = replace(world.physics, gravity_mode="planet")


def toggle_arrows(world: World, window: Window) -> None:
    """Show or hide the arrows of velocities, forces and contact normals."""
    window.overlays.toggle_arrows(world, window.camera)


def toggle_impulses(world: World, window: Window) -> None:
    """Show or hide what contacts do: impulses, friction cones and their numbers."""
    window.overlays.toggle_impulses(world, window.camera)


def toggle_trails(world: World, window: Window) -> None:
    """Show where moving bodies have been, or no longer."""
    window.trails.toggle(world)


def zoom(window: Window, notches: float) -> None:
    """Enlarge the picture around the cursor."""
    window.camera.zoom(1.15**notches, window.pointer)


def fit(world: World, window: Window) -> None:
    """Show all of the world."""
    window.fit(world)


def go_home(world: World, window: Window) -> None:
    """Show the world as at the start."""
    window.go_home(world)


def ask_screenshot(world: World, window: Window) -> None:
    """Ask for a picture of the window as soon as this frame is drawn."""
    window.wants_screenshot = True


def toggle_grid(world: World, window: Window) -> None:
    """Show the grid, or hide it."""
    window.grid = not window.grid


def toggle_help(world: World, window: Window) -> None:
    """Show all keys, or the world and its figures again."""
    window.help = not window.help


def leave(world: World, window: Window) -> None:
    """Leave the help if it is shown, else the window."""
    if window.help:
        window.help = False
    else:
        close(world, window)


def close(world: World, window: Window) -> None:
    """Close the window."""
    window.closing = True
