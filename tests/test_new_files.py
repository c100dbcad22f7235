"""New files under names that nothing has: exclusive, whole, and short enough for a file system."""

import os
import sys
from pathlib import Path

import pygame
import pytest
from at_once import run_at_once
from desk import Desk, bits, click, empty_world, tap

from physicslab.files.replace import create_file
from physicslab.files.scene import file_stem, load_scene, save_last_good, save_scene
from physicslab.view.controls import saving

AT_ONCE = """
import sys
from pathlib import Path
from physicslab.files.scene import save_last_good
from physicslab.files.scene import save_new_scene
from physicslab.files.scene import load_scene
from physicslab.view.controls.saving import new_scene_paths
folder, world = Path(sys.argv[1]), load_scene("drop")
input("ready\\n")
for _ in range(10):
    print(save_last_good(world, "boom", folder))
    print(save_new_scene(world, new_scene_paths(folder, "boom")))
"""


def test_programs_that_save_at_once_get_a_file_each(tmp_path: Path) -> None:
    said = run_at_once(AT_ONCE, str(tmp_path), count=4)
    assert len(said) == 80 and len(set(said)) == 80, "each has a file of its own"
    assert sorted(said) == sorted(map(str, tmp_path.iterdir())), "and nothing else is left"


def test_a_name_that_is_taken_is_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"mine")
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    for name in ("file", "link"):
        with pytest.raises(FileExistsError):
            create_file(tmp_path / name, b"new")
    create_file(tmp_path / "free", b"new")
    assert sorted(os.listdir(tmp_path)) == ["file", "free", "link"]
    assert (tmp_path / "file").read_bytes() == b"mine" and (tmp_path / "free").read_bytes() == b"new"


def test_where_files_have_one_name_alone_they_are_created_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    create_file(tmp_path / "free", b"new")
    with pytest.raises(FileExistsError):
        create_file(tmp_path / "free", b"newer")
    assert os.listdir(tmp_path) == ["free"] and (tmp_path / "free").read_bytes() == b"new"


def test_saving_follows_no_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene-1.json").symlink_to(tmp_path / "elsewhere.json")
    desk = Desk(empty_world())
    for name in ("scene-1", "scene-2"):
        saving.begin_copy(desk.world, desk.window)
        saving.save_under(desk.world, desk.window, name)
    assert sorted(os.listdir(tmp_path)) == ["scene-1.json", "scene-2.json"]
    assert not (tmp_path / "elsewhere.json").exists()


@pytest.mark.parametrize("name", ["x" * 240, "\u7403" * 80, "\U0001f600" * 1000, "a" + "\u0301" * 200])
def test_a_long_name_is_shortened_for_its_file(name: str, tmp_path: Path) -> None:
    assert len(file_stem(name).encode()) <= 100
    world = load_scene("drop")
    world.name = name
    path = save_last_good(world, world.name, tmp_path)
    assert path.name.endswith("-before-divergence.json") and len(path.name.encode()) <= 143
    assert save_last_good(world, world.name, tmp_path).name.endswith("-before-divergence-2.json")
    assert load_scene(path).name == name and bits(load_scene(path)) == bits(world)


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="file names are Unicode there")
def test_a_file_name_that_is_not_utf_8_is_listed_opened_and_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in (os.fsdecode(b"caf\xe9.json"), "\u200b.json"):
        save_scene(load_scene("two_planets"), name)
    desk = Desk(empty_world())
    desk.frames(3)
    click(desk, "Scenes")
    assert {"caf\\udce9.json", "\\u200b.json"} <= set(desk.ui.places)
    Path("\u200b.json").unlink()
    tap(desk, "escape")
    desk.key("o", pygame.KMOD_LCTRL)
    desk.frames(3)
    click(desk, "caf\\udce9.json")
    assert desk.world.name == "two_planets" and desk.window.notice.endswith("caf\\udce9.json")
