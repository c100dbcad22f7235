"""The structure of the view: no circle of imports, and no system of a frame within a step."""

from __future__ import annotations

import graphlib

import grimp
import pytest
from desk import Desk
from recording import RecordingCanvas

from physicslab.files.scene import load_scene
from physicslab.systems.frame.hud import HudSystem
from physicslab.systems.frame.input import InputSystem
from physicslab.systems.frame.render import RenderSystem
from physicslab.systems.system import Stage, System


@pytest.mark.parametrize("folder", ["physicslab.view", "physicslab.systems.frame"])
def test_no_files_import_each_other_in_a_circle(folder: str) -> None:
    graph = grimp.build_graph("physicslab", exclude_type_checking_imports=False, cache_dir=None)
    inside = {folder, *graph.find_descendants(folder)}
    assert len(inside) > 3
    imports = {module: graph.find_modules_directly_imported_by(module) & inside for module in inside}
    order = list(graphlib.TopologicalSorter(imports).static_order())  # raises CycleError for a circle
    assert set(order) == inside


@pytest.mark.parametrize(
    ("system", "stages"),
    [
        (InputSystem, {Stage.INPUT}),
        (RenderSystem, {Stage.RENDER}),
        (HudSystem, {Stage.HUD}),
    ],
)
def test_a_system_of_a_frame_runs_at_its_own_stage_alone(system: type[System], stages: set[Stage]) -> None:
    assert system.marked().keys() == stages


@pytest.mark.parametrize("name", ["sandbox", "pyramid", "billiards", "spring_chain"])
def test_a_window_with_every_overlay_leaves_the_steppers_as_they_are(name: str) -> None:
    alone, watched = load_scene(name), load_scene(name)
    desk = Desk(watched, RecordingCanvas((1280, 720)))
    for key in ("v", "e"):
        desk.key(key)
    desk.frames(2)
    alone.synchronise()
    assert [type(one) for one in watched.steppers.usable] == [type(one) for one in alone.steppers.usable]
    assert alone.steppers.usable
