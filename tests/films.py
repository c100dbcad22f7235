"""GIF films read back, as a browser would show them."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Shown", "shown_pictures"]


@dataclass(frozen=True)
class Shown:
    """A film as it is shown: every picture uint8 (height, width, 3), and how long each stays [1/100 s]."""

    pictures: list[NDArray[np.uint8]]
    delays: list[int]
    loops: bool


def shown_pictures(content: bytes) -> Shown:
    """Return what a GIF file shows; an error where it is none, or where something is left over."""
    signature, width, height, flags, _, _ = struct.unpack_from("<6sHHBBB", content)
    assert signature == b"GIF89a" and not flags & 0x80
    canvas = np.zeros((height, width, 3), np.uint8)
    at, found, delay, see_through, loops = 13, Shown([], [], False), 0, -1, False
    while True:
        kind = content[at]
        if kind == 0x3B:
            assert at + 1 == len(content)
            return Shown(found.pictures, found.delays, loops)
        if kind == 0x21:
            label = content[at + 1]
            data, at = blocks(content, at + 2)
            if label == 0xF9:
                packed, delay, number = struct.unpack("<BHB", data)
                assert packed >> 2 == 1  # what is shown stays
                see_through = number if packed & 1 else -1
            elif label == 0xFF:
                loops = data.startswith(b"NETSCAPE2.0") and data[-2:] == b"\0\0"
            continue
        assert kind == 0x2C
        left, top, across, down, packed = struct.unpack_from("<HHHHB", content, at + 1)
        count = 2 << (packed & 7)
        table = np.frombuffer(content, np.uint8, 3 * count, at + 10).reshape(count, 3)
        at += 10 + 3 * count
        depth = content[at]
        data, at = blocks(content, at + 1)
        numbers = np.array(unpacked(data, depth), np.uint8).reshape(down, across)
        part = canvas[top : top + down, left : left + across]
        covers = numbers != see_through
        part[covers] = table[numbers[covers]]
        found.pictures.append(canvas.copy())
        found.delays.append(delay)


def blocks(content: bytes, at: int) -> tuple[bytes, int]:
    """Return the data of blocks from a place on, and the place behind them."""
    data = b""
    while content[at]:
        data += content[at + 1 : at + 1 + content[at]]
        at += 1 + content[at]
    return data, at + 1


def unpacked(data: bytes, depth: int) -> list[int]:
    """Return the numbers that LZW codes stand for; all bits must be used up at the end code."""
    clear, end = 1 << depth, (1 << depth) + 1
    table: list[list[int]] = []
    width, place, numbers = depth + 1, 0, list[int]()
    bits, before = int.from_bytes(data, "little"), list[int]()
    while True:
        code = (bits >> place) & ((1 << width) - 1)
        place += width
        if code == clear:
            table, width, before = [[k] for k in range(clear)] + [[], []], depth + 1, []
            continue
        if code == end:
            assert 0 <= 8 * len(data) - place < 8
            return numbers
        now = table[code] if code < len(table) else [*before, before[0]]
        if before and len(table) < 4096:
            table.append([*before, now[0]])
            if len(table) == 1 << width and width < 12:
                width += 1
        numbers += now
        before = now
