"""A recording in a file gives the same bits when it is played, and says where it does not."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from crowds import crowd
from random_edits import box_of_discs, state_hash

from physicslab.cli import main
from physicslab.components import Held, Mass, Name, Shape, Spring, Transform, Velocity
from physicslab.files.scene import read_scene
from physicslab.history import (
    AddComponent,
    Group,
    History,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    SetSimulation,
    Spawn,
)
from physicslab.state.masses import Diverged


def recorded(path: Path) -> History:
    """Return a history in which everything was done that can be, and write it to a file."""
    world = box_of_discs(1)
    world.remove(3)  # numbers in the file are others
    history = History(world)
    history.step(steps=10)
    history.do(Remove(2))
    made = history.next_entity
    body = Spawn(
        (Transform((0.1, 2.0), -0.0), Velocity((0.1, 1 / 3)), Mass(1.1), Shape("circle", radius=0.1))
    )
    tie = Spring(a=made, b=4, rest_length=0.5, stiffness=30.0)
    history.do(Group("tied a ball to another", [body, Spawn([tie], "tie")]))
    history.write(AddComponent(5, Held((0.0, 0.1))))
    for frame in range(5):
        history.write(SetField(5, "Velocity", "linear", (0.1 * frame, 0.7)))
        history.step()
    history.write(RemoveComponent(5, "Held"))
    history.step(0.01, steps=20)
    history.do(AddComponent(made + 1, Spring(a=made, b=6, rest_length=0.4, stiffness=20.0)))
    history.do(AddComponent(4, Name("fourth")))
    history.do(SetPhysics({"gravity": (0.1, -1.62), "bounds": (-2, 0, 2, 5)}))
    history.do(SetSimulation({"substeps": 2}))
    history.step(steps=30)
    history.do(Remove(made))
    history.undo()  # what was taken back is not in the file
    history.save(path)
    return history


def test_a_recording_is_played_with_all_bits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    history = recorded(tmp_path / "run.json")
    end, words = state_hash(history.world), [entry.words for entry in history.entries]
    assert main(["replay", str(tmp_path / "run.json")]) == 0
    assert "65 steps" in capsys.readouterr().out
    loaded = History.load(tmp_path / "run.json")
    assert loaded.step_count == 0 and loaded.steps_range == (0, 65)
    assert [entry.words for entry in loaded.entries] == words[:-1]
    loaded.seek(65)
    assert loaded.difference is None and loaded.time == history.time
    assert state_hash(history.world) == end
    loaded.seek(12)
    loaded.do(Spawn((Transform(),)))
    assert len(loaded.branches) == 1


@pytest.mark.parametrize("contacts", ["soft", "auto"])
@pytest.mark.parametrize("seed", [3, 1046, 705758920])
def test_recordings_of_crowds_are_played_with_all_bits(tmp_path: Path, seed: int, contacts: str) -> None:
    document = crowd(seed)
    document["simulation"]["contacts"] = contacts
    world = read_scene(document)
    history = History(world)
    try:
        history.step(steps=15)
        history.do(Remove(world.entities()[len(world.entities()) // 2]))
        history.step(steps=15)
    except Diverged:
        pass
    assert history.step_count > 10
    history.save(tmp_path / "run.json")
    assert main(["replay", str(tmp_path / "run.json")]) == 0


def test_it_says_at_which_step_and_in_which_column_bits_first_differ(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, report = tmp_path / "run.json", tmp_path / "report.json"
    recorded(path)
    document = json.loads(path.read_text(encoding="utf-8"))
    setting = next(e for e in document["entries"] if "edit" in e and e["command"]["do"] == "physics")
    setting["command"]["changes"]["gravity"][1] = -1.63
    path.write_text(json.dumps(document), encoding="utf-8")
    assert main(["replay", str(path), "--json", str(report)]) == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "from step 36 of 65" in said and "Velocity.linear" in said
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["same"] is False and found["first_difference"]["step"] == 36
    assert "Velocity.linear" in found["first_difference"]["columns"]


def test_the_report_of_a_recording_that_is_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded(tmp_path / "run.json")
    assert main(["replay", str(tmp_path / "run.json"), "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["same"] is True and found["steps"] == 65 and "first_difference" not in found
    same = str(tmp_path / "run.json")
    assert main(["replay", same, "--json", same]) == 2
    assert "is the recording itself" in capsys.readouterr().err


def changed(document: dict[str, Any], *path: Any, to: Any) -> dict[str, Any]:
    """Change one value of a document."""
    inner = document
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = to
    return document


BAD: list[tuple[tuple[Any, ...], Any, str]] = [
    (("format",), "physicslab-scene/1", "format"),
    (("scene",), [], "scene"),
    (("scene", "entities", 0, "Transform", "position"), "up", "Transform.position"),
    (("entries",), {}, "entries"),
    (("entries", 0), 7, "entries[0]"),
    (("entries", 0, "run"), {}, "run"),
    (("entries", 0, "run", 0), [0.0, 10], "run[0]"),
    (("entries", 0, "run", 0), [0.01, 10**15], "run[0]"),
    (("entries", 0, "run", 0), [0.01, True], "run[0]"),
    (("entries", 0, "run", 0), [0.01, 9], "digests are of 10 steps"),
    (("entries", 0, "digests"), "!", "base64"),
    (("entries", 0, "digests"), None, "base64"),
    (("entries", 0, "colour"), 1, "colour"),
    (("entries", 1, "command"), None, "command"),
    (("entries", 1, "command", "do"), "explode", "do"),
    (("entries", 1, "command", "do"), ["spawn"], "do"),
    (("entries", 1, "command", "entity"), 99, "no entity 99"),
    (("entries", 1, "command", "entity"), "ball", "entity"),
    (("entries", 1, "edit"), 3, "edit"),
    (("entries", 2, "command", "commands"), 3, "commands"),
    (("entries", 2, "command", "commands", 0, "components", "Wings"), {}, "Wings"),
    (("entries", 2, "command", "commands", 0, "components", "Mass"), {"mass": -1}, "Mass.mass"),
    (("entries", 2, "command", "commands", 0, "entity"), 1, "entity 1"),
    (("entries", 2, "command", "commands", 0, "name"), ["x"], "name"),
    (("entries", 3, "run", 0, "component"), "Name", "id"),
    (("entries", 3, "run", 1, "field"), "colour", "colour"),
    (("entries", 6, "command", "changes"), {"colour": 1}, "colour"),
    (("entries", 6, "command", "changes"), {"gravity": [0, 1e999]}, "gravity"),
    (("more",), 1, "more"),
]


@pytest.mark.parametrize(("path", "value", "named"), BAD)
def test_a_bad_recording_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], path: tuple[Any, ...], value: Any, named: str
) -> None:
    file = tmp_path / "run.json"
    recorded(file)
    document = changed(json.loads(file.read_text(encoding="utf-8")), *path, to=value)
    file.write_text(json.dumps(document), encoding="utf-8")
    assert main(["replay", str(file)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and named in said and len(said) < 400


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"", "is not JSON"),
        (b"\xff\xfe\x00", "is not UTF-8"),
        (b"[1, 2", "is not JSON"),
        (b'{"format": "physicslab-scene/1", "entities": []}', "for a recording"),
        (b"[" * 100_000, "nested too deeply"),
    ],
)
def test_a_file_that_is_no_recording_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, named: str
) -> None:
    (tmp_path / "run.json").write_bytes(content)
    for file in (tmp_path / "run.json", tmp_path, tmp_path / "none.json", "drop", "a\0b"):
        assert main(["replay", str(file)]) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert named in said or file != tmp_path / "run.json"


def test_a_file_that_cannot_be_written_loses_nothing(tmp_path: Path) -> None:
    history = recorded(tmp_path / "run.json")
    kept, before = (tmp_path / "run.json").read_bytes(), state_hash(history.world)
    with pytest.raises(OSError, match="directory"):
        history.save(tmp_path / "missing" / "run.json")
    if Path("/dev/full").exists():
        with pytest.raises(OSError, match="No space left"):
            history.save("/dev/full")
    assert state_hash(history.world) == before and (tmp_path / "run.json").read_bytes() == kept
    history.step()
    history.seek(12)
    assert history.difference is None
