"""What the user can do, one function each, whichever key or button asks for it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.fields import InvalidValue
from physicslab.files.checks import printable
from physicslab.files.new_scene import save_new_scene
from physicslab.files.scene import SceneError, load_scene
from physicslab.view.canvas.theme import THEMES
from physicslab.view.controls.scene_files import new_scene_paths, newest_scene
from physicslab.view.controls.tools import HAND, Tool
from physicslab.view.window import Window
from physicslab.world import World

__all__ = [
    "ask_screenshot", "choose_tool", "clear", "close", "enlarge", "faster", "fit", "go_home", "leave",
    "next_theme", "open_scene", "reduce", "reopen", "save", "slower", "step", "study_error",
    "toggle_arrows", "toggle_figures", "toggle_gravity", "toggle_grid", "toggle_help", "toggle_impulses",
    "toggle_menu", "toggle_pause", "toggle_planets", "toggle_slow_motion", "toggle_trails",
    "zoom", "zoom_in", "zoom_out",
]  # fmt: skip

_ZOOM_STEP = 3.0
"""How many notches of the wheel a key or a button zooms by."""


def choose_tool(window: Window, tool: Tool) -> None:
    """Let the left mouse button do something else."""
    window.spring_tool.cancel()
    window.tool = tool
    window.notify(tool.tells, 5.0)


def toggle_menu(window: Window, name: str) -> None:
    """Open a menu, or close it."""
    window.menu = "" if window.menu == name else name


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


def save(world: World, window: Window) -> None:
    """Save the world to a new scene file where the program was started."""
    try:
        path = save_new_scene(world, new_scene_paths(Path.cwd(), world.name))
    except (SceneError, OSError) as error:
        window.notify(f"The scene could not be saved: {error}", 6.0, failed=True)
    else:
        window.scene_file = path
        window.notify(f"Saved {printable(str(path))}")


def reopen(world: World, window: Window) -> None:
    """Open the scene file last saved or opened, or else the newest; where that fails, all stays as it is."""
    try:
        path = window.scene_file or newest_scene(Path.cwd())
    except OSError as error:
        window.notify(f"Not opened: {error}", 8.0, failed=True)
        return
    if path is None:
        window.notify(f"There is no scene file in {Path.cwd()}: Ctrl+S saves one", failed=True)
    else:
        open_scene(window, path)


def open_scene(window: Window, source: str | Path) -> None:
    """Open a built-in scene by name, or a file; where that fails, all stays as it is."""
    try:
        opened = load_scene(source)
        opened.synchronise()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not opened: {error}", 8.0, failed=True)
        return
    window.next_world = opened
    if isinstance(source, Path):
        window.scene_file = source
    window.notify(f"Opened {printable(str(source)) if isinstance(source, Path) else opened.title}")


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


def zoom_in(world: World, window: Window) -> None:
    """Enlarge the picture around the cursor."""
    zoom(window, _ZOOM_STEP)


def zoom_out(world: World, window: Window) -> None:
    """Reduce the picture around the cursor."""
    zoom(window, -_ZOOM_STEP)


def enlarge(world: World, window: Window) -> None:
    """Enlarge the picture around its middle: the cursor is on a button."""
    window.camera.zoom(1.15**_ZOOM_STEP, window.middle)


def reduce(world: World, window: Window) -> None:
    """Reduce the picture around its middle: the cursor is on a button."""
    window.camera.zoom(1.15**-_ZOOM_STEP, window.middle)


def next_theme(world: World, window: Window) -> None:
    """Show everything in the colours of the next theme."""
    window.theme = THEMES[(THEMES.index(window.theme) + 1) % len(THEMES)]
    window.notify(f"Colours: {window.theme.name}")


def toggle_figures(world: World, window: Window) -> None:
    """Show the figures and costs, or leave all of the window to the world."""
    window.figures = not window.figures


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


def study_error(world: World, window: Window) -> None:
    """Measure error against run time of the scene as it is now; show it when that is done."""
    if window.error_study.running:
        window.error_study.stop()
        window.notify("Measuring error against run time: stopped")
        return
    try:
        window.error_study.start(world)
    except (OSError, SceneError) as error:
        window.notify(f"Error against run time could not be measured: {error}", failed=True)
    else:
        window.notify("Measuring error against run time of this scene; F5 stops it", 600.0)


def leave(world: World, window: Window) -> None:
    """Leave the help, the plot, the menu or the tool if there is one, else the window."""
    if window.help:
        window.help = False
    elif window.error_study.shown:
        window.error_study.shown = False
    elif window.menu:
        window.menu = ""
    elif window.tool is not HAND:
        choose_tool(window, HAND)
    else:
        close(world, window)


def close(world: World, window: Window) -> None:
    """Close the window."""
    window.closing = True
