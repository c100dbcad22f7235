"""What tests of graphs, meters and sliders share."""

from __future__ import annotations

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk
from imgui_bundle import implot

from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.history import Spawn
from physicslab.view.window.dashboard import GraphShown

CTRL, SHIFT = pygame.KMOD_LCTRL, pygame.KMOD_LSHIFT


def ball_of(desk: Desk, name: str = "ball", y: float = 0.0) -> int:
    parts = [Transform((0, y)), Velocity((2, 0)), Mass(1.0), Shape.circle(0.3)]
    (ball,) = desk.window.edits.do(Spawn(parts, name))
    desk.window.selection.take(ball)
    desk.frames()
    return ball


def graph_of(desk: Desk) -> GraphShown:
    (graph,) = desk.window.dashboard.graphs
    return graph


def in_plot(desk: Desk, across: float, up: float = 0.5, number: int = 1) -> tuple[int, int]:
    left, top, width, height = desk.ui.places[f"Plot of graph {number}"]
    return round(left + across * width), round(top + (1.0 - up) * height)


def drawn_lines(monkeypatch: pytest.MonkeyPatch) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a list to which the points of every line are added that is plotted."""
    drawn: list[tuple[np.ndarray, np.ndarray]] = []
    plot_line = implot.plot_line

    def note(name: str, x: np.ndarray, y: np.ndarray, look: implot.Spec) -> None:
        drawn.append((x, y))
        plot_line(name, x, y, look)

    monkeypatch.setattr(implot, "plot_line", note)
    return drawn


def pause(desk: Desk) -> None:
    desk.window.pace.paused = True
    desk.frames(SETTLED)
