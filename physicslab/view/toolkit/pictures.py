"""Draw lists of Dear ImGui as pictures that are kept for as long as the lists stay the same."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pygame
from imgui_bundle import imgui
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels
from physicslab.kernels.triangles import paint_triangles

__all__ = ["Pictures"]

_VERTEX_BYTES = 20
"""Place, place in the texture and colour: what ``ImDrawVert`` takes."""
_MASKS = (0x00FF0000, 0x0000FF00, 0x000000FF, 0xFF000000)
"""Where red, green, blue and alpha are in a pixel."""
_UNUSED_FRAMES = 120
"""A picture that was not shown for so many frames is let go of."""


@dataclass(slots=True)
class _Picture:
    """What was drawn, and the surface that shows it."""

    content: bytes
    surface: pygame.Surface
    corner: tuple[int, int]
    used: int


class Pictures:
    """Paints the draw lists of a frame, each on a surface of its own, and keeps these.

    Most panels are the same from frame to frame: their pictures are laid over the world as they are.
    """

    def __init__(self) -> None:
        self._textures: dict[int, NDArray[np.uint8]] = {}
        self._pictures: dict[str, _Picture] = {}
        self._frame = self._texture_changes = 0
        self._shown: list[_Picture] = []
        self._of: dict[str, _Picture] = {}
        self.painted = 0

    def take(self, data: imgui.ImDrawData) -> None:
        """Paint what is new of a frame of Dear ImGui; to be called after each ``imgui.render``."""
        self._frame += 1
        self._follow_textures(data)
        self._shown, self._of = [], {}
        for n, commands in enumerate(data.cmd_lists):
            if commands.idx_buffer.size() == 0:
                continue
            picture = self._picture(f"{n} {commands._owner_name}", commands, data)
            if picture is not None:
                self._shown.append(picture)
                self._of[commands._owner_name] = picture
        old = [name for name, kept in self._pictures.items() if self._frame - kept.used > _UNUSED_FRAMES]
        for name in old:
            del self._pictures[name]

    def show(self, surface: pygame.Surface) -> None:
        """Lay the pictures over a surface, in their order."""
        for picture in self._shown:
            surface.blit(picture.surface, picture.corner, special_flags=pygame.BLEND_PREMULTIPLIED)

    def of(self, ending: str, paper: pygame.Color) -> pygame.Surface | None:
        """Return the window whose name ends so as it is painted, on paper; ``None`` if there is none."""
        picture = next((one for name, one in self._of.items() if name.endswith(ending)), None)
        if picture is None:
            return None
        surface = pygame.Surface(picture.surface.get_size(), 0, 32)
        surface.fill(paper)
        surface.blit(picture.surface, (0, 0), special_flags=pygame.BLEND_PREMULTIPLIED)
        return surface

    def forget(self) -> None:
        """Let Dear ImGui know that no texture is used any more; its context can then be ended."""
        self._shown, self._of, self._pictures, self._textures = [], {}, {}, {}

    def _follow_textures(self, data: imgui.ImDrawData) -> None:
        """Take over the letters that were added to the texture since the last frame."""
        for texture in data.textures:
            if texture.status == imgui.ImTextureStatus.ok:
                continue
            if texture.status == imgui.ImTextureStatus.want_destroy:
                self._textures.pop(texture.unique_id, None)
                texture.set_tex_id(0)
                texture.set_status(imgui.ImTextureStatus.destroyed)
                continue
            values = np.asarray(texture.get_pixels_array()).reshape(texture.height, texture.width, -1)
            self._textures[texture.unique_id] = np.ascontiguousarray(values[:, :, -1])
            texture.set_tex_id(texture.unique_id)
            texture.set_status(imgui.ImTextureStatus.ok)
            self._texture_changes += 1

    def _picture(self, name: str, commands: imgui.ImDrawList, data: imgui.ImDrawData) -> _Picture | None:
        """Return the picture of a draw list, painted now if it is not the one that is kept."""
        vertices, indices, content = _arrays(commands)
        clips = [(c.clip_rect.x, c.clip_rect.y, c.clip_rect.z, c.clip_rect.w) for c in commands.cmd_buffer]
        content += np.array(clips).tobytes()
        kept = self._pictures.get(name)
        if kept is not None and kept.content == content:
            kept.used = self._frame
            return kept
        box = _extent(vertices, clips, data)
        if box is None:
            return None
        if not _can_paint():
            return None
        left, top, right, bottom = box
        surface = pygame.Surface((right - left, bottom - top), pygame.SRCALPHA, 32, _MASKS)
        pixels = np.frombuffer(surface.get_buffer(), np.uint32).reshape(
            bottom - top, surface.get_pitch() // 4
        )
        moved, order = (
            vertices.copy(),
            indices.copy(),
        )  # what is kept cannot be written, and kernels ask for more
        moved[:, :2] -= (left, top)
        for command, (x0, y0, x1, y1) in zip(commands.cmd_buffer, clips, strict=True):
            x0, y0 = max(int(x0) - left, 0), max(int(y0) - top, 0)
            x1, y1 = min(int(x1) - left, right - left), min(int(y1) - top, bottom - top)
            if command.elem_count and x1 > x0 and y1 > y0:
                paint_triangles(
                    pixels, moved, moved.view(np.uint32), order, command.idx_offset, command.elem_count,
                    command.vtx_offset, self._textures[command.get_tex_id()], x0, y0, x1, y1,
                )  # fmt: skip
        del pixels  # or the surface stays locked
        self.painted += 1
        self._pictures[name] = picture = _Picture(content, surface, (left, top), self._frame)
        return picture


def _can_paint() -> bool:
    """Whether the painter is compiled; interpreted it would take seconds a frame."""
    painter: Any = paint_triangles
    if not painter.compiled:
        compile_kernels((painter,))
    return bool(painter.compiled)


def _arrays(commands: imgui.ImDrawList) -> tuple[NDArray[np.float32], NDArray[np.uint32], bytes]:
    """Return a draw list's vertices, its indices, and both as bytes."""
    points, corners = commands.vtx_buffer.size(), commands.idx_buffer.size()
    raw = ctypes.string_at(commands.vtx_buffer.data_address(), points * _VERTEX_BYTES)
    order = ctypes.string_at(commands.idx_buffer.data_address(), corners * 4)
    vertices = np.frombuffer(raw, np.float32).reshape(points, 5)
    return vertices, np.frombuffer(order, np.uint32), raw + order


def _extent(
    vertices: NDArray[np.float32], clips: list[tuple[float, float, float, float]], data: imgui.ImDrawData
) -> tuple[int, int, int, int] | None:
    """Return which part of the display a draw list paints: left, top, right, bottom [px]."""
    width, height = int(data.display_size.x), int(data.display_size.y)
    low, high = vertices[:, :2].min(axis=0), vertices[:, :2].max(axis=0)
    left = max(math.floor(max(low[0], min(c[0] for c in clips))), 0)
    top = max(math.floor(max(low[1], min(c[1] for c in clips))), 0)
    right = min(math.ceil(min(high[0], max(c[2] for c in clips))), width)
    bottom = min(math.ceil(min(high[1], max(c[3] for c in clips))), height)
    return (left, top, right, bottom) if right > left and bottom > top else None
