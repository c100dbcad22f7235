"""Draw lists of Dear ImGui as pictures that are kept for as long as the lists stay the same."""

import ctypes
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pygame
from imgui_bundle import imgui
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels
from physicslab.kernels.triangles import paint_triangles
from physicslab.theme import Colour

_VERTEX_BYTES = 20
"""Place, place in the texture and colour: what ``ImDrawVert`` takes."""
_MASKS = (0x00FF0000, 0x0000FF00, 0x000000FF, 0xFF000000)
"""The places of red, green, blue and alpha in a pixel."""


type Clip = tuple[float, float, float, float]
type Overlay = tuple[pygame.Surface, tuple[int, int], pygame.Rect]
"""A surface, its corner, and the part of the window in which it is seen [px]."""


@dataclass(frozen=True, slots=True)
class _Sheet:
    """A job to paint: a draw list, and its part of the display [px]."""

    vertices: bytes
    indices: bytes
    commands: list[tuple[int, int, int, int, Clip]]
    box: pygame.Rect


@dataclass(frozen=True)
class _Picture:
    """A draw list as it is painted when it is looked at, the textures of then, and the number painted before.

    Panels are built several times after each event, and seen once.
    """

    sheet: _Sheet
    textures: dict[int, NDArray[np.uint8]]
    number: int

    @cached_property
    def surface(self) -> pygame.Surface:
        """The painted picture."""
        box = self.sheet.box
        surface = pygame.Surface(box.size, pygame.SRCALPHA, 32, _MASKS)
        pixels = np.frombuffer(surface.get_buffer(), np.uint32).reshape(box.h, -1)
        vertices = np.frombuffer(bytearray(self.sheet.vertices), np.float32).reshape(-1, 5)
        vertices[:, :2] -= box.topleft
        indices = np.frombuffer(bytearray(self.sheet.indices), np.uint32)
        for first, count, offset, texture, (x0, y0, x1, y1) in self.sheet.commands:
            clip = pygame.Rect(int(x0), int(y0), int(x1) - int(x0), int(y1) - int(y0)).clip(box)
            clip.move_ip(-box.x, -box.y)
            paint_triangles(
                pixels, vertices, vertices.view(np.uint32), indices, first, count, offset,
                self.textures[texture], clip.left, clip.top, clip.right, clip.bottom,
            )  # fmt: skip
        del pixels  # or the surface stays locked
        return surface


class Pictures:
    """Paints the draw lists of a frame, each on a surface of its own, and keeps these.

    Most panels are the same from frame to frame: their pictures are laid over the world as they are. Where
    figures of several change at once, their pictures are painted in turn, one a frame.
    """

    def __init__(self) -> None:
        self._textures: dict[int, NDArray[np.uint8]] = {}
        self._sheets: dict[str, _Sheet] = {}
        self._pictures: dict[str, _Picture] = {}
        self.painted = 0

    @property
    def due(self) -> list[str]:
        """The names of those that show what was there earlier."""
        return [name for name, one in self._pictures.items() if one.sheet is not self._sheets[name]]

    def take(self, data: imgui.ImDrawData, pointer: tuple[float, float], *, at_once: bool) -> None:
        """Note what there is to see; to be called after each ``imgui.render``.

        A list that is new, elsewhere than before or under the pointer is painted now, or all of them at once.
        """
        self._follow_textures(data)
        lists = [one for one in data.cmd_lists if one.idx_buffer.size()]
        sheets = {str(one._owner_name): _sheet(one, data) for one in lists}
        self._sheets = {name: sheet for name, sheet in sheets.items() if sheet.box}
        before, self._pictures = self._pictures, {}
        for name, sheet in self._sheets.items():
            kept = before.get(name)
            if kept is not None and kept.sheet == sheet:
                self._sheets[name] = kept.sheet
            elif at_once or kept is None or kept.sheet.box != sheet.box or sheet.box.collidepoint(pointer):
                self._paint(name)
                continue
            self._pictures[name] = kept

    def paint_next(self) -> None:
        """Paint the picture that is the oldest of those that are due."""
        if due := self.due:
            self._paint(min(due, key=lambda name: self._pictures[name].number))

    def show(self, surface: pygame.Surface, overlays: Mapping[str, Sequence[Overlay]] | None = None) -> None:
        """Lay the pictures over a surface, in their order, each with the overlays that are named after it."""
        for name, picture in self._pictures.items():
            surface.blit(picture.surface, picture.sheet.box, special_flags=pygame.BLEND_PREMULTIPLIED)
            for overlay, corner, clip in overlays.get(name, ()) if overlays else ():
                surface.set_clip(clip)
                surface.blit(overlay, corner)
                surface.set_clip(None)

    def of(self, ending: str, paper: Colour) -> pygame.Surface | None:
        """Return the window whose name ends so as it is painted, on paper; ``None`` if there is none."""
        picture = next((one for name, one in self._pictures.items() if name.endswith(ending)), None)
        if picture is None:
            return None
        surface = pygame.Surface(picture.surface.get_size(), 0, 32)
        surface.fill(paper)
        surface.blit(picture.surface, (0, 0), special_flags=pygame.BLEND_PREMULTIPLIED)
        return surface

    def forget(self) -> None:
        """Let Dear ImGui know that no texture is used any more; its context can then be ended."""
        self._sheets, self._pictures, self._textures = {}, {}, {}

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

    def _paint(self, name: str) -> None:
        """Have what there is to see under a name painted, unless the painter is not there yet."""
        if _can_paint():
            self._pictures[name] = _Picture(self._sheets[name], dict(self._textures), self.painted)
            self.painted += 1


def _can_paint() -> bool:
    """Whether the painter is compiled; interpreted it would take seconds a frame."""
    painter: Any = paint_triangles
    if not painter.compiled:
        compile_kernels((painter,))
    return bool(painter.compiled)


def _sheet(commands: imgui.ImDrawList, data: imgui.ImDrawData) -> _Sheet:
    """Return a draw list as arrays of its own."""
    points, corners = commands.vtx_buffer.size(), commands.idx_buffer.size()
    raw = ctypes.string_at(commands.vtx_buffer.data_address(), points * _VERTEX_BYTES)
    order = ctypes.string_at(commands.idx_buffer.data_address(), corners * 4)
    parts = [
        (c.idx_offset, c.elem_count, c.vtx_offset, c.get_tex_id(),
         (c.clip_rect.x, c.clip_rect.y, c.clip_rect.z, c.clip_rect.w))
        for c in commands.cmd_buffer if c.elem_count
    ]  # fmt: skip
    places, limits = np.frombuffer(raw, np.float32).reshape(points, 5), np.array([part[4] for part in parts])
    left = math.floor(max(places[:, 0].min(), limits[:, 0].min()))
    top = math.floor(max(places[:, 1].min(), limits[:, 1].min()))
    right = math.ceil(min(places[:, 0].max(), limits[:, 2].max()))
    bottom = math.ceil(min(places[:, 1].max(), limits[:, 3].max()))
    box = pygame.Rect(left, top, max(right - left, 0), max(bottom - top, 0))
    return _Sheet(raw, order, parts, box.clip((0, 0, data.display_size.x, data.display_size.y)))
