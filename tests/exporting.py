"""Runs exported for tests, and the same runs recorded step by step."""

from __future__ import annotations

from pathlib import Path

from physicslab import World, cli, load_scene
from physicslab.diagnostics.energy import measure_account
from physicslab.export.recording import RunRecorder

__all__ = ["exported", "recorded"]


def exported(path: Path, *arguments: str) -> bytes:
    """Export a run to a file, and return the page."""
    assert cli.main(["export", *arguments, "--html", str(path)]) == 0
    return path.read_bytes()


def recorded(scene: str, seconds: float) -> tuple[World, RunRecorder]:
    """Run a scene step by step; return the world at the end and what was recorded."""
    world = load_scene(scene)
    recorder = RunRecorder(world)
    recorder.write(world, measure_account(world))
    for _ in world.stepping(seconds=seconds):
        recorder.write(world, measure_account(world))
    return world, recorder
