"""Sentences of the engine: each has a code, and is worded where it is shown; names in them stay."""

import ast
import copy
import json
import pickle
from pathlib import Path

import pytest
from desk import SETTLED, sized

import physicslab
from physicslab.cli import main
from physicslab.components import Name, Shape, Transform
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.sentences import SENTENCES, sentence
from physicslab.files.scene import load_scene
from physicslab.history.commands import Remove
from physicslab.languages.language import language
from physicslab.languages.sentence import Sentence, coded, proper
from physicslab.scenes import SCENES
from physicslab.view.controls.actions import undo

SAYING = ("sentence", "listed")
"""What makes a sentence by its code."""


def test_every_code_is_of_a_sentence_and_every_sentence_is_said() -> None:
    used: set[str] = set()
    sources = (path.read_text(encoding="utf-8") for path in Path(physicslab.__file__).parent.rglob("*.py"))
    for source in (one for one in sources if any(f"{name}(" in one for name in SAYING)):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in SAYING and node.args:
                used |= {str(one.value) for one in ast.walk(node.args[0]) if isinstance(one, ast.Constant)}
    assert used == set(SENTENCES)


@pytest.mark.parametrize("name", SCENES)
def test_every_reason_of_a_scene_has_a_code(name: str) -> None:
    world = load_scene(name)
    world.run(steps=1)
    reasons = [world.plan.reason, world.plan.collision_reason, world.plan.contact_reason]
    reasons += [left.reason for left in (*world.schedule.left_out, *world.steppers.left_out)]
    reasons += [stepper.reason for stepper in world.steppers.usable]
    reasons += [warning.what for warning in find_warnings(world)]
    assert not [words for words in reasons if not coded(words)]
    german = language("de")
    assert not [words for words in reasons if german.reword(words) == words and " " in words]


def test_names_in_sentences_stay_and_sentences_in_gaps_are_said() -> None:
    german = language("de")
    inner = sentence("off_line", body="Box")
    assert german.reword(inner) == "Box bleibt nicht auf der Linie seiner Federn"
    both = sentence("no_closed_form", why=inner)
    assert (
        german.reword(both)
        == f"exact war verlangt, und es gibt keine geschlossene Form: {german.reword(inner)}"
    )
    assert german.reword(proper("Box")) == "Box" and german.reword("Box") == "Kasten"
    assert german.reword(sentence("resolved", phase="0.25")).endswith("= 0,25")
    assert language().reword(both) == both


def test_a_sentence_is_a_text_and_is_copied_whole() -> None:
    made = sentence("exact_refused", obstacle=sentence("many_pairs", limit=3))
    assert (
        made == "exact was asked for, and more than 3 pairs may meet" and json.loads(json.dumps(made)) == made
    )
    for other in (copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
        assert isinstance(other, Sentence) and coded(other) == coded(made)
    assert coded(made) == {
        "code": "exact_refused", "values": {"obstacle": {"code": "many_pairs", "values": {"limit": "3"}}},
    }  # fmt: skip
    with pytest.raises(KeyError):
        sentence("no such code")
    with pytest.raises(KeyError):
        sentence("many_pairs")


def test_a_report_has_words_and_codes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "pendulum", "--steps", "2", "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["reason_codes"]["integrator"]["code"] in SENTENCES
    filled = SENTENCES[report["left_out"][0]["code"]].format(**report["left_out"][0]["values"])
    assert report["left_out"][0]["reason"] == filled
    assert len(report["advice"]) == len(report["advice_codes"])


def test_the_window_says_reasons_in_its_language_and_leaves_names() -> None:
    world = load_scene("drop")
    world.spawn(Name("Box"), Transform((3, -5)), Shape.box(1, 1))
    desk = sized((1280, 720), world)
    desk.window.language, desk.window.level = "de", "Engineer"
    desk.frames(60)  # figures are read a few times a second
    assert [words for words in desk.ui.words if words.startswith("weil: ")]
    assert not [words for words in desk.ui.words if "because" in words or "no Spring" in words]
    desk.window.selection.entities = (world.entity("Box"),)
    desk.frames(SETTLED)
    assert "Box" in desk.ui.words
    desk.window.edits.do(Remove(world.entity("Box")))
    undo(world, desk.window)
    assert language("de").reword(desk.window.notice) == "Zurückgenommen: Box entfernt"
