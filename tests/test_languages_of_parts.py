"""Texts that the window puts together of parts are in its language, part by part."""

import pygame
import pytest
from desk import SETTLED, Desk, click, click_at, empty_world, point, sized, tap

from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import SceneError
from physicslab.files.reader import read_scene
from physicslab.files.scene import load_scene, parse_json
from physicslab.languages.language import language
from physicslab.languages.sentence import Sentence
from physicslab.prefabs import box
from physicslab.view.canvas.quantities import vector_quantity
from physicslab.view.controls.file_actions import open_scene
from physicslab.view.toolkit.axes import _ticks

SCENE = '{"format": "physicslab-scene/1", "entities": [{%s}]}'


@pytest.fixture
def german() -> Desk:
    """Return a desk in German on a paused scene of a ball and a floor."""
    desk = sized((1280, 800), load_scene("drop"))
    desk.window.language = "de"
    desk.frames(60)
    tap(desk, "space")
    return desk


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (0.0, "erlaubt: eine endliche Zahl > 0 kg"),
        (1e-320, "erlaubt: eine endliche Zahl > 0 kg, mindestens 1e-300"),
        ("3 m/s", "erlaubt: eine endliche Zahl > 0 kg: '3 m/s' ist in m/s, dies in kg"),
        ("5 deg", "erlaubt: eine endliche Zahl > 0 kg: '5 deg' ist ohne Einheit, dies in kg"),
        ("1e400", "erlaubt: eine endliche Zahl > 0 kg: '1e400' ist nicht endlich"),
        ("", "erlaubt: eine endliche Zahl > 0 kg: hier fehlt eine Zahl"),
    ],
)
def test_a_refused_number_is_refused_in_the_language(value: float | str, said: str) -> None:
    with pytest.raises(InvalidValue) as refused:
        Mass(value)
    assert language("de").reword(f"must be {refused.value.allowed}") == said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[", "a.json: ist kein JSON: Expecting value in Zeile 1, Spalte 2"),
        ('{"a": 1, "a": 2}', 'a.json: der Schlüssel "a" steht zweimal da; erlaubt ist einmal'),
        ('{"format": 1}', 'a.json: format = 1: erlaubt: "physicslab-scene/1"'),
        (SCENE % '"id": "a", "mass": {}', "unbekannt: component; möglich sind id"),
        (
            SCENE % '"id": "a", "Transform": {"position": [1e999, 0]}',
            "zwei endliche Zahlen [x, y] m, je höchstens",
        ),
        (SCENE % '"id": " "', "erlaubt: ein Text, der nicht leer ist"),
    ],
)
def test_a_refused_file_is_refused_in_the_language(text: str, said: str) -> None:
    with pytest.raises(SceneError) as refused:
        read_scene(parse_json(text, "a.json"), "a.json")
    assert said in language("de").reword(str(refused.value))


def test_what_is_opened_is_named_in_the_language(german: Desk) -> None:
    open_scene(german.window, "stack")
    assert language("de").reword(german.window.notice) == "Ein Turm aus zehn Kästen geöffnet"


def test_edits_and_runs_are_listed_in_the_language(german: Desk) -> None:
    german.window.selection.take(german.world.entity("ball"))
    tap(german, "up")
    tap(german, "u")
    assert [one for one in german.ui.words if one[:3] in ("1. ", "2. ")] == [
        "1. 1,1 s gelaufen",
        "2. ball verschoben",
    ]


def test_numbers_that_differ_are_a_span_in_the_language(german: Desk) -> None:
    for x, mass in ((1.0, 0.5), (3.0, 1.5)):
        german.world.spawn(Transform((x, 3.0)), Velocity(), Mass(mass), Shape.circle(0.2))
    tap(german, "a", pygame.KMOD_CTRL)
    assert "0,5 bis 1,5" in german.ui.words
    assert "various" not in german.ui.words


def test_gravity_of_no_planet_is_named_in_the_language() -> None:
    desk = sized((1280, 800), empty_world(gravity=(0.0, -5.0)))
    desk.window.language = "de"
    desk.frames(SETTLED)
    assert "eigene" in desk.ui.words


def test_a_step_of_the_tour_is_counted_in_the_language(german: Desk) -> None:
    tap(german, "f1", pygame.KMOD_CTRL)
    assert "1 von 8: Werfen" in german.ui.words


@pytest.mark.parametrize(
    ("english", "said"),
    [
        (Sentence("normal, from {body}", body=Sentence("the wall")).capitalize(), "Normalkraft von der Wand"),
        (Sentence("{force}: {size}", force=Sentence("weight"), size="1.5 N"), "Gewichtskraft: 1,5 N"),
        (Sentence("{how}, μ = {mu}", how=Sentence("sticks"), mu="0.5"), "haftet, μ = 0,5"),
        (Sentence("{motion} {speed}x", motion=Sentence("SLOW MOTION"), speed="0.25"), "ZEITLUPE 0,25x"),
    ],
)
def test_a_sentence_of_sentences_is_said_in_the_language(english: Sentence, said: str) -> None:
    assert language("de").reword(english) == said


def test_a_name_stays_as_it_is_where_its_sentence_begins_a_line() -> None:
    assert Sentence("normal, from {body}", body="Cart A").capitalize() == "Normal, from Cart A"


def test_a_key_is_named_once_for_both_of_its_places(german: Desk) -> None:
    german.window.language = "en"
    tap(german, "f1")
    assert "Enter" in german.ui.words


def test_a_part_that_is_rounded_to_zero_has_no_sign() -> None:
    assert vector_quantity(Vector2(-0.001, -103.0), "N") == "(0, -103) N"


@pytest.mark.parametrize(("low", "high"), [(0.85, 1.95), (-3.0, 12.0), (0.0, 1e-4)])
def test_ticks_of_an_axis_have_as_many_decimals_as_their_step(low: float, high: float) -> None:
    texts = [text for _, text in _ticks(low, high, 10)]
    assert len(texts) > 4
    assert len({len(text.partition(".")[2]) for text in texts}) == 1


@pytest.mark.parametrize("key", ["f8", "f9"])
def test_what_makes_nothing_is_called_cancel(german: Desk, key: str) -> None:
    tap(german, key)
    click(german, "Cancel")
    assert "Abbrechen" not in german.ui.words


def test_what_can_be_put_down_is_listed_in_the_language(german: Desk) -> None:
    point(german, german.pixel(0.0, 5.0))
    tap(german, "menu")
    assert {"Mauer ...", "Dominos ..."} <= set(german.ui.words)


def test_what_a_method_costs_is_said_in_the_language() -> None:
    desk = sized((1280, 800), load_scene("sandbox"))
    desk.window.language, desk.window.level = "de", "Engineer"
    desk.frames(SETTLED)
    costs = "Es kostet 1 Auswertung aller Kräfte je Schritt; die halbe Schrittweite braucht doppelt so lange"
    assert any(words.startswith(costs) and words.endswith("driftet nicht.") for words in desk.ui.words)


@pytest.mark.parametrize(
    ("place", "reason"),
    [((0.0, 0.0), "hier ist kein Platz, Kasten 1 ist im Weg"), ((0.0, 2.9), "es ragte durch die Wände")],
)
def test_why_nothing_is_made_is_said_in_the_language_and_as_a_refusal(
    place: tuple[float, float], reason: str
) -> None:
    desk = sized((1280, 720), empty_world(bounds=(-5.0, -3.0, 5.0, 3.0)))
    for x in (-1.1, 1.1):
        box(desk.world, (x, 0.0), width=2.0, height=2.0, static=True)
    desk.frames(SETTLED)
    click_at(desk, desk.pixel(*place), "right")
    assert language("de").reword(desk.window.notice) == f"Kasten: {reason}"
    assert desk.window.notice_failed


def test_impacts_are_counted_in_the_language() -> None:
    desk = sized((1280, 720), load_scene("carts"))
    desk.window.language = "de"
    tap(desk, "z")
    desk.frames(90)
    assert len(desk.window.impacts.records) == 1
    assert "1 Stoß" in desk.ui.words
