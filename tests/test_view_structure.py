"""The structure: no circle of imports, and systems of a frame that stand alone and run within no step."""

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


@pytest.fixture
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("physicslab", exclude_type_checking_imports=False, cache_dir=None)


def test_no_folders_import_each_other_in_a_circle(graph: grimp.ImportGraph) -> None:
    folders = graph.find_children("physicslab")
    for folder in folders:
        graph.squash_module(folder)
    imports = {folder: graph.find_modules_directly_imported_by(folder) - {folder} for folder in folders}
    assert len(imports) > 15
    graphlib.TopologicalSorter(imports).prepare()  # raises CycleError for a circle


def test_at_most_three_files_import_each_other_in_a_circle(graph: grimp.ImportGraph) -> None:
    circles = {
        frozenset({one, *(graph.find_upstream_modules(one) & graph.find_downstream_modules(one))})
        for one in graph.modules
    }
    assert max(map(len, circles)) <= 3
    assert not any(len(circle) > 1 for circle in circles if "kernels" not in min(circle))


def test_systems_of_a_frame_import_nothing_above_systems(graph: grimp.ImportGraph) -> None:
    below = {"systems", "contacts", "state", "components", "kernels", "ecs", "languages"}
    reached = graph.find_upstream_modules("physicslab.systems.frame", as_package=True)
    assert {name.split(".")[1] for name in reached if "." in name} <= below


@pytest.mark.parametrize(
    ("system", "stages"),
    [(InputSystem, {Stage.INPUT}), (RenderSystem, {Stage.RENDER}), (HudSystem, {Stage.HUD})],
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
