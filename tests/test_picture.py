"""save_png: a picture of a world without any display."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pygame
import pytest
from desk import bits, empty_world

from physicslab.ecs.config import WindowConfig
from physicslab.files.scene import load_scene
from physicslab.prefabs import circle
from physicslab.theme import DARK
from physicslab.view.picture.picture import save_png


def test_a_file_and_a_stream_get_the_same_picture(tmp_path: Path) -> None:
    world = load_scene("sandbox")
    path, stream = tmp_path / "picture.png", io.BytesIO()
    save_png(world, path)
    save_png(world, stream)
    assert path.read_bytes() == stream.getvalue()
    assert stream.getvalue().startswith(b"\x89PNG")


def test_it_has_the_size_of_the_window_and_shows_the_world(tmp_path: Path) -> None:
    world = empty_world()
    circle(world, (1000, -500), radius=3)
    save_png(world, tmp_path / "picture.png")
    picture = pygame.image.load(tmp_path / "picture.png")
    assert picture.get_size() == WindowConfig().size
    seen = {tuple(one) for one in pygame.surfarray.array3d(picture)[540:740, 260:460].reshape(-1, 3).tolist()}
    assert len(seen & set(DARK.bodies)) == 1, "the rim of the one body"


def test_an_empty_world_is_a_picture_too() -> None:
    stream = io.BytesIO()
    save_png(empty_world(), stream)
    assert stream.tell() > 100


def test_the_world_is_not_changed() -> None:
    world = load_scene("sandbox")
    world.run(steps=5)
    before = bits(world), world.time, world.schedule.systems
    save_png(world, io.BytesIO())
    assert (bits(world), world.time, world.schedule.systems) == before


def test_a_path_that_cannot_be_written_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="nowhere"):
        save_png(empty_world(), tmp_path / "nowhere" / "picture.png")


def test_no_display_is_opened_and_nothing_is_printed(tmp_path: Path) -> None:
    code = (
        "import sys; from physicslab import load_scene\n"
        "from physicslab.view.picture.picture import save_png\n"
        "import pygame; save_png(load_scene('drop'), sys.argv[1]); assert not pygame.display.get_init()"
    )
    environment = {k: v for k, v in os.environ.items() if k not in ("SDL_VIDEODRIVER", "DISPLAY")}
    environment.pop("PYGAME_HIDE_SUPPORT_PROMPT", None)
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, str(tmp_path / "picture.png")],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == done.stderr == ""
