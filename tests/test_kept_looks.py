"""What is seen of a scene is in its file: colours, view, level, and what is shown beside the world."""

import json
from pathlib import Path

import pytest
from desk import SETTLED, Desk, bits, empty_world

from physicslab import World, load_scene, save_scene
from physicslab.components import Spring, Transform
from physicslab.files.reader import read_scene
from physicslab.files.scene import SceneError
from physicslab.files.writer import write_scene
from physicslab.history import History, Remove, SetField
from physicslab.prefabs import box, circle
from physicslab.view.controls import file_actions, saving


def worn() -> World:
    """Return a world from which bodies were removed: numbers are no places any more."""
    world = empty_world()
    made = [circle(world, (0.7 * n, 0.26), radius=0.25) for n in range(9)]
    box(world, (0, -0.5), width=20, height=1, static=True)
    world.spawn(Spring(a=made[6], b=made[8], rest_length=1.4))
    for gone in made[:3]:
        world.remove(gone)
    return world


def test_bodies_keep_their_numbers_and_so_their_colours_and_labels() -> None:
    world = worn()
    world.run(seconds=0.5)
    again = read_scene(json.loads(json.dumps(write_scene(world))))
    assert again.entities() == world.entities()
    assert [again.label(one) for one in again.entities()] == [world.label(one) for one in world.entities()]
    (spring,) = again.batch(Spring).entities.tolist()
    assert (again.component(spring, Spring).a, again.component(spring, Spring).b) == (7, 9)
    for each in (world, again):
        each.run(seconds=0.5)
    assert bits(again) == bits(world)


def test_where_nothing_was_removed_a_file_says_no_numbers() -> None:
    assert "numbers" not in write_scene(load_scene("newtons_cradle"))


def test_a_recording_goes_by_the_same_numbers(tmp_path: Path) -> None:
    history = History(worn())
    history.do(SetField(5, "Transform", "position", (0.0, 5.0)))
    history.do(Remove(6))
    history.save(tmp_path / "mine.replay")
    again = History.load(tmp_path / "mine.replay")
    again.redo(), again.redo()
    assert again.world.entities() == history.world.entities()
    assert again.world.component(5, Transform).position.y == 5.0


@pytest.mark.parametrize(
    "numbers", [[[1]], [[1, 0]], [[2, 1]], [[3, 9]], [[1, 5], [2, 5]], [[1, 10**9]], {}, [[1, True]]]
)
def test_numbers_that_cannot_be_are_refused(numbers: object) -> None:
    scene = {"format": "physicslab-scene/1", "entities": [{}, {}], "numbers": numbers}
    with pytest.raises(SceneError, match=r"^scene: numbers"):
        read_scene(scene)


def test_view_level_and_what_is_shown_come_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    desk = Desk(load_scene("drop"))
    window = desk.window
    window.pace.paused = True
    window.level, window.overlays.arrows, window.grid, window.impacts.shown = "Engineer", True, False, True
    desk.frames(SETTLED)
    window.camera.zoom(1.7, window.framing.middle)
    window.camera.pan(40.0, -25.0)
    saving.begin_copy(desk.world, window)
    saving.save_under(desk.world, window, "mine")
    seen = (*window.camera.centre, window.camera.scale)
    for _ in range(2):  # nothing drifts from one saving to the next
        window.level, window.overlays.arrows, window.grid = "Explore", False, True
        window.impacts.shown = False
        file_actions.open_scene(window, tmp_path / "mine.json")
        desk.frames(SETTLED)
        assert (*window.camera.centre, window.camera.scale) == pytest.approx(seen)
        assert (window.level, window.overlays.arrows, window.grid) == ("Engineer", True, False)
        assert window.impacts.shown
        saving.save(desk.world, window)


@pytest.mark.parametrize(
    "desk", [[], {"level": "Expert"}, {"level": "Explore", "shown": ["all"]}, {"level": "Explore", "x": 1}]
)
def test_what_cannot_be_shown_is_refused(desk: object) -> None:
    with pytest.raises(SceneError, match=r"^scene: desk"):
        read_scene({"format": "physicslab-scene/1", "entities": [], "desk": desk})


def test_a_file_with_the_looks_is_read_by_the_program(tmp_path: Path) -> None:
    world = worn()
    save_scene(world, tmp_path / "mine.json")
    assert load_scene(tmp_path / "mine.json").entities() == world.entities()
