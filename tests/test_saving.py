"""New scenes, and files that are saved from the window: nothing goes astray, nothing is lost."""

from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, empty_world, tap, write
from test_hud import frame, recorded

from physicslab import World
from physicslab.components import Gate, Graph, Held, Material, Note, Ruler, Transform, Velocity
from physicslab.desktop import session_window
from physicslab.files.scene import load_scene, save_scene
from physicslab.history import Spawn
from physicslab.prefabs import circle
from physicslab.view.controls import dashboard_actions, file_actions, saving
from physicslab.view.controls.saving import new_scene_paths

CTRL, SHIFT = pygame.KMOD_CTRL, pygame.KMOD_SHIFT


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def opened(path: Path, world: World | None = None) -> Desk:
    """Return a window in which a scene file was opened, paused."""
    save_scene(world or load_scene("drop"), path)
    desk = Desk(empty_world())
    file_actions.open_scene(desk.window, path)
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    return desk


def text_of(path: Path, key: str) -> str:
    return str(getattr(load_scene(path), key))


# ---- save --------------------------------------------------------------------------------------------------


def test_the_first_time_a_name_is_asked_for_and_then_the_file_is_written(folder: Path) -> None:
    desk = Desk(load_scene("newtons_cradle"))
    desk.key("space")
    desk.frames(3)
    tap(desk, "s", CTRL)
    assert desk.window.scenes.naming is not None and not list(folder.iterdir())
    name_it(desk, "mine")
    assert bits(load_scene(folder / "mine.json")) == bits(desk.world)
    ball = circle(desk.world, (0, 3))
    tap(desk, "s", CTRL)
    assert [path.name for path in folder.iterdir()] == ["mine.json"], "the open file, and no other"
    assert len(load_scene(folder / "mine.json").entities()) == len(desk.world.entities()) and ball


def test_a_copy_leaves_the_window_with_its_file(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    click(desk, "Circle")
    circle_at(desk, 2.0, 3.0)
    tap(desk, "s", CTRL | SHIFT)
    name_it(desk, "other")
    assert desk.window.scenes.source == folder / "mine.json" and desk.window.has_unsaved
    many, few = (len(load_scene(folder / name).entities()) for name in ("other.json", "mine.json"))
    assert many == few + 1


def name_it(desk: Desk, name: str) -> None:
    click(desk, "File name")
    tap(desk, "a", CTRL)
    write(desk, name)
    tap(desk, "return")


def circle_at(desk: Desk, x: float, y: float) -> None:
    desk.press(x, y)
    desk.frames(2)
    desk.release(x, y)
    desk.frames(2)


def test_a_file_that_another_program_wrote_is_written_over_only_on_request(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    theirs = load_scene("pendulum")
    save_scene(theirs, folder / "mine.json")
    tap(desk, "s", CTRL)
    naming = desk.window.scenes.naming
    assert naming is not None and "changed by another program" in naming.refused
    assert text_of(folder / "mine.json", "name") == "pendulum"
    click(desk, "Replace it")
    assert desk.window.scenes.naming is None and text_of(folder / "mine.json", "name") == "drop"
    tap(desk, "s", CTRL)
    assert desk.window.scenes.naming is None, "it is this window's again"


def test_a_name_that_is_there_is_asked_about_and_another_name_takes_the_question_back(folder: Path) -> None:
    save_scene(load_scene("drop"), folder / "there.json")
    (folder / "notes.json").write_text("[1]")
    desk = Desk(load_scene("pendulum"))
    desk.window.pace.paused = True
    tap(desk, "s", CTRL)
    name_it(desk, "there")
    assert "Replace it" in desk.ui.places and text_of(folder / "there.json", "name") == "drop"
    name_it(desk, "notes.json")
    assert desk.window.scenes.naming is not None and "no scene" in desk.window.scenes.naming.refused
    assert "Replace it" not in desk.ui.places
    name_it(desk, "there")
    click(desk, "Replace it")
    assert text_of(folder / "there.json", "name") == "pendulum"
    assert (folder / "notes.json").read_text() == "[1]"


@pytest.mark.parametrize(
    ("name", "file"), [("a.b", "a.b.json"), (" Zürich 🚀 ", "Zürich 🚀.json"), ("x.txt", "x.txt.json")]
)
def test_odd_names_get_the_ending_of_scenes(folder: Path, name: str, file: str) -> None:
    desk = Desk(load_scene("drop"))
    saving.begin_copy(desk.world, desk.window)
    saving.save_under(desk.world, desk.window, name)
    assert [path.name for path in folder.iterdir()] == [file]


@pytest.mark.parametrize("name", ["no/folder", "x" * 300, "a\0b", "~nobody-at-all/x", "..", ""])
def test_names_that_cannot_be_are_refused_at_the_field(folder: Path, name: str) -> None:
    desk = Desk(load_scene("drop"))
    saving.begin_copy(desk.world, desk.window)
    saving.save_under(desk.world, desk.window, name)
    naming = desk.window.scenes.naming
    assert naming is not None and naming.refused and "\n" not in naming.refused and not list(folder.iterdir())


def test_after_a_name_that_is_refused_another_is_written_at_once(folder: Path) -> None:
    desk = Desk(load_scene("drop"))
    tap(desk, "s", CTRL | pygame.KMOD_SHIFT)
    for name in ("no/folder", "mine.json"):
        write(desk, name)
        tap(desk, "return")
        desk.frames(SETTLED)
    assert [path.name for path in folder.iterdir()] == ["mine.json"]


def test_a_full_disk_leaves_the_file_and_the_work(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    desk = opened(folder / "mine.json")
    before = (folder / "mine.json").read_bytes()
    desk.window.pending.append(lambda world, window: circle(world, (0, 3)))
    monkeypatch.setattr("physicslab.files.replace.os.fsync", full)
    tap(desk, "s", CTRL)
    naming = desk.window.scenes.naming
    assert naming is not None and naming.refused == "The scene could not be saved: No space left on device"
    assert [path.name for path in folder.iterdir()] == ["mine.json"]
    assert (folder / "mine.json").read_bytes() == before


def test_enter_in_the_notes_gives_the_keys_back_that_tab_brought_there(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    click(desk, "Title and notes")
    desk.frames(SETTLED)
    tap(desk, "tab")
    write(desk, "Two carts")
    tap(desk, "return")
    assert "Two carts" in desk.world.description
    desk.window.pace.paused = True
    steps = desk.world.steps
    tap(desk, ".")
    assert desk.world.steps == steps + 1


def test_what_is_half_written_is_saved_too(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    click(desk, "Title and notes")
    write(desk, "Two carts")
    tap(desk, "s", CTRL)
    assert text_of(folder / "mine.json", "title") == "Two carts"


@pytest.mark.parametrize(
    ("name", "file"),
    [("", "scene-1.json"), ("a/b c", "a-b-c-1.json"), ("drop-7", "drop-1.json"), ("../..", "scene-1.json")],
)
def test_names_of_scenes_as_names_of_files(folder: Path, name: str, file: str) -> None:
    assert next(new_scene_paths(folder, name)) == folder / file


def test_a_world_that_no_file_can_hold_is_reported(folder: Path) -> None:
    world = empty_world()
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.window.scenes.source = folder / "mine.json"
    desk.window.pace.paused = True
    desk.frames()
    world.table(Velocity)["linear"][world.entity_index.row_of[ball]] = float("nan")
    desk.key("s", CTRL)
    desk.frames()
    assert "could not be saved" in desk.window.notice
    assert not list(folder.iterdir())


# ---- the mark of unsaved work ------------------------------------------------------------------------------


def test_a_dot_says_that_there_is_unsaved_work(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    title = desk.world.title

    def bar() -> str:
        return session_window._title(desk.world, desk.window)

    assert bar() == f"{title} (mine.json) - PhysicsLab"
    desk.window.pace.paused = False
    desk.frames(10)
    assert not desk.window.has_unsaved, "time went on, and nothing was done"
    click(desk, "Circle")
    circle_at(desk, 2.0, 3.0)
    assert bar() == f"\u2022 {title} (mine.json) - PhysicsLab"
    assert any(words.startswith("\u2022 ") for words in desk.ui.words)
    tap(desk, "z", CTRL)
    tap(desk, "z", CTRL)
    assert not desk.window.has_unsaved, "it was taken back"
    tap(desk, "y", CTRL)
    tap(desk, "y", CTRL)
    tap(desk, "s", CTRL)
    assert not desk.window.has_unsaved


def test_a_click_on_a_body_while_time_stands_still_is_no_edit(folder: Path) -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk = opened(folder / "mine.json", world)
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
    (ball,) = desk.world.entities()
    desk.window.pace.paused = True
    desk.press(0, 0)
    desk.frames(3)
    desk.release(0, 0)
    desk.frames(3)
    assert desk.window.selection.entities == (ball,) and not desk.window.has_unsaved
    desk.press(0, 0)
    desk.frames(3)
    desk.move(0.5, 0)
    desk.frames(3)
    desk.release(0.5, 0)
    desk.frames(3)
    assert desk.world.component(ball, Transform).position.x == pytest.approx(0.5, abs=0.02)
    assert desk.window.has_unsaved


# ---- new ---------------------------------------------------------------------------------------------------


def test_new_is_empty_with_a_floor_at_zero_and_undo_brings_unsaved_work_back(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    click(desk, "Circle")
    circle_at(desk, 2.0, 3.0)
    desk.window.pace.paused = False
    desk.frames(20)
    left, there = desk.world, bits(desk.world)
    tap(desk, "n", CTRL)
    made = desk.world
    assert made is not left and [made.label(entity) for entity in made.entities()] == ["floor"]
    assert (made.time, made.title, made.description) == (0.0, "", "") and desk.window.pace.paused
    assert (made.steps, made.collisions) == (0, 0) and not desk.window.has_unsaved
    (floor,) = made.entities()
    assert made.component(floor, Material).restitution == 1.0, "a pair has the smaller one: that of the body"
    tap(desk, "s", CTRL)
    assert desk.window.scenes.naming is not None, "the file of the scene that was left is not written"
    tap(desk, "escape")
    tap(desk, "z", CTRL)
    assert desk.world is left and bits(left) == there and desk.window.scenes.source == folder / "mine.json"


def test_starting_a_new_scene_again_keeps_what_was_built() -> None:
    desk = Desk(load_scene("drop"))
    tap(desk, "n", CTRL)
    circle_at(desk, 0.0, 2.0)
    desk.window.pace.paused = False
    desk.frames(20)
    tap(desk, "r", CTRL)
    assert desk.world.time == 0.0 and len(desk.world.entities()) == 2


def test_starting_again_keeps_what_measures(folder: Path) -> None:
    """A gate that was put there to time a run was gone with its next start."""
    desk = opened(folder / "mine.json")
    ball, do = desk.world.entity("ball"), desk.window.edits.do
    gate = [Gate(start=(1.0, 0.0), end=(1.0, 2.0))]
    for parts, name in ((gate, "finish"), ([Note("here", (0.0, 1.0))], None), ([Ruler(end_body=ball)], None)):
        do(Spawn(parts, name))
    desk.frames(20)
    for _ in range(2):
        before, count = desk.world, len(desk.world.entities())
        tap(desk, "r", CTRL)
        assert desk.world is not before and len(desk.world.entities()) == count
        assert desk.world.has("finish", Gate) and len(desk.world.batch(Note)) == 1
        (ruler,) = desk.world.batch(Ruler).entities.tolist()
        assert desk.world.component(ruler, Ruler).end_body == desk.world.entity("ball")
    file_actions.open_scene(desk.window, folder / "mine.json")
    desk.frames(SETTLED)
    assert not len(desk.world.batch(Gate)) and len(desk.world.entities()) < count


def test_clear_takes_the_title_too_and_undo_brings_it_back() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.pace.paused = True
    title = desk.world.title
    tap(desk, "r")
    assert (desk.world.title, desk.world.description, desk.world.entities()) == ("", "", [])
    tap(desk, "z", CTRL)
    assert desk.world.title == title and desk.world.entities()


# ---- title and notes ---------------------------------------------------------------------------------------


def test_title_and_notes_are_written_in_the_panel_as_one_edit() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    title = desk.world.title
    click(desk, "Title and notes")
    write(desk, "Two carts")
    tap(desk, "tab")
    tap(desk, "a", CTRL)
    write(desk, "They meet.")
    tap(desk, "return")
    assert (desk.world.title, desk.world.description) == ("Two carts", "They meet.")
    tap(desk, "escape")  # Tab went through the panel: keys are the world's again
    tap(desk, "z", CTRL)
    assert desk.world.title == title
    click(desk, "Title and notes")
    write(desk, "not kept")
    tap(desk, "escape")
    assert desk.world.title == title and not desk.window.closing


def test_a_title_that_is_too_long_is_refused_beside_its_field() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    before = desk.world.title
    click(desk, "Title and notes")
    pygame.event.post(pygame.Event(pygame.TEXTINPUT, text="x" * 201))
    desk.frames(SETTLED)
    tap(desk, "return")
    assert desk.world.title == before and any("at most 200" in words for words in desk.ui.words)


# ---- open --------------------------------------------------------------------------------------------------


def test_saving_and_opening_brings_back_every_bit(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    desk.key(".")
    desk.frames()
    tap(desk, "s", CTRL)
    saved, state = desk.world, bits(load_scene(folder / "mine.json"))
    desk.key("r")
    desk.frames()
    file_actions.open_scene(desk.window, folder / "mine.json")
    desk.frames()
    assert desk.world is not saved and bits(desk.world) == state
    assert "Opened" in desk.window.notice
    assert {"InputSystem", "RenderSystem", "HudSystem"} <= {s.name for s in desk.world.schedule.running}
    desk.key("space")
    desk.frames(10)
    assert bits(desk.world) != state, "the world that was opened runs"


def test_opening_closes_the_graphs_of_the_scene_left_and_starting_again_keeps_them(folder: Path) -> None:
    desk = opened(folder / "mine.json")
    dashboard_actions.plot_selected(desk.world, desk.window)
    desk.frames(SETTLED)
    tap(desk, "s", CTRL)
    for _ in range(2):
        file_actions.open_scene(desk.window, folder / "mine.json")
        desk.frames(SETTLED)
        assert len(desk.world.batch(Graph)) == 1
    dashboard_actions.plot_selected(desk.world, desk.window)
    desk.frames(SETTLED)
    tap(desk, "r", CTRL)
    assert len(desk.world.batch(Graph)) == 2, "a new run of the same scene, beside the one before"
    file_actions.open_scene(desk.window, folder / "mine.json")
    desk.frames(SETTLED)
    assert len(desk.world.batch(Graph)) == 1, "one that was not saved is not in the file"


@pytest.mark.parametrize(
    "text", ["not json at all", '{"format": "physicslab-scene/1", "entities": [{"Mas": 1}]}']
)
def test_a_bad_file_is_reported_and_nothing_is_lost(folder: Path, text: str) -> None:
    (folder / "bad.json").write_text(text)
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk, canvas = recorded(world)
    desk.press(0, 0)
    desk.window.do_next(file_actions.open_from_list, folder / "bad.json")
    frame(desk, canvas)
    assert desk.world is world and world.has(ball, Held)
    assert "Not opened" in desk.window.notice and "bad.json" in desk.window.notice
    (reported,) = [t for t in canvas.called("text") if t["words"].startswith("Not opened")]
    assert reported["style"].colour == desk.window.theme.error


def test_what_is_held_is_let_go_when_another_world_comes(folder: Path) -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk = opened(folder / "mine.json", world)
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
    before = desk.world
    (ball,) = before.entities()
    desk.press(0, 0)
    desk.frames()
    desk.move(0.1, 0)
    desk.frames()
    assert before.has(ball, Held)
    desk.window.do_next(file_actions.open_from_list, folder / "mine.json")
    desk.frames(3)
    assert desk.window.hand.entity is None and not before.has(ball, Held)
    desk.release(0, 0)
    desk.frames()
    assert len(desk.world.entities()) == 1


def test_s_and_o_alone_save_and_open_nothing(folder: Path) -> None:
    desk = Desk(empty_world())
    desk.key("s")
    desk.key_up("s")
    desk.key("o")
    desk.frames()
    assert not list(folder.iterdir())
    assert desk.world.physics.gravity_mode == "planet"
