"""Keys of one's own choice: chosen in the list of keys, shown wherever a key is shown, kept."""

import json
from pathlib import Path

import pytest
from desk import SETTLED, Desk, click, empty_world, sized, tap
from hypothesis import given
from hypothesis import strategies as st
from plotting import CTRL, SHIFT

from physicslab.components import Spring
from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.prefabs import circle
from physicslab.view.controls import choosing_keys, commands
from physicslab.view.controls.controls import CONTROLS, KEYS, Control
from physicslab.view.window.window import Window

CHOICES = [control for control in CONTROLS if choosing_keys.is_open(control)]


@pytest.fixture
def desk() -> Desk:
    return sized((1280, 720), empty_world(gravity=(0, 0)))


def give(desk: Desk, does: str, key: str, mod: int = 0) -> None:
    """Choose a key as a person does, in the list of keys."""
    if not desk.window.help:
        tap(desk, "f1")
        desk.frames(SETTLED)
    if not desk.window.keys.open:
        click(desk, "Choose keys")
    click(desk, f"Key of {does}")
    assert desk.window.keys.asks == does
    tap(desk, key, mod)
    desk.frames(SETTLED)


def test_a_key_that_was_chosen_does_it_and_the_usual_one_does_not(desk: Desk) -> None:
    give(desk, "pause", ";")
    assert desk.window.keys.asks == "" and not desk.window.pace.paused
    tap(desk, "escape")
    desk.frames(SETTLED)
    tap(desk, "space")
    assert not desk.window.pace.paused
    tap(desk, ";")
    assert desk.window.pace.paused


def test_the_chosen_key_stands_in_menus_help_and_search(desk: Desk) -> None:
    give(desk, "trails", "j", CTRL)
    assert desk.window.keys.chosen == {"trails": "ctrl+j"}
    tap(desk, "escape")
    click(desk, "View")
    control = next(control for control in CONTROLS if control.does == "trails")
    assert choosing_keys.label_of(control, desk.window) == "Ctrl+J"
    tap(desk, "escape")
    tap(desk, "k", CTRL)
    desk.frames(SETTLED)
    assert [one.keys for one in commands.commands(desk.window) if one.words == "Trails"] == ["Ctrl+J"]


def test_a_key_that_does_something_else_is_refused_with_what_it_does(desk: Desk) -> None:
    give(desk, "trails", "g")
    assert desk.window.notice == "G already does: gravity. Press another key, or Esc"
    assert desk.window.keys.asks == "trails" and desk.window.keys.chosen == {}
    tap(desk, "1")
    assert desk.window.notice.startswith("1 moves things or takes a tool")
    tap(desk, "left")
    assert desk.window.keys.chosen == {}
    tap(desk, "f11")
    assert desk.window.keys.chosen == {"trails": "f11"}


def test_one_key_or_all_become_the_usual_ones_again(desk: Desk) -> None:
    give(desk, "trails", ";")
    give(desk, "gravity", "t")
    assert desk.window.keys.chosen == {"trails": ";", "gravity": "t"}
    give(desk, "trails", "backspace")
    assert desk.window.keys.asks == "trails", "T is that of gravity now"
    tap(desk, "escape")
    assert desk.window.keys.asks == "" and desk.window.help
    give(desk, "gravity", "backspace")
    give(desk, "trails", "backspace")
    assert desk.window.keys.chosen == {}
    give(desk, "grid", ";", SHIFT)
    click(desk, "All usual keys")
    desk.frames(2)
    assert desk.window.keys.chosen == {}


def test_a_key_that_is_held_is_let_go_of_under_its_new_name(desk: Desk) -> None:
    circle(desk.world, (0.0, 0.0), radius=0.5)
    give(desk, "spring: hold, drag", ";")
    tap(desk, "escape")
    desk.frames(SETTLED)
    desk.move(0.0, 0.0)
    desk.frames()
    before = desk.window.tool
    desk.key(";")
    desk.frames()
    desk.move(0.0, 2.0)
    desk.frames(4)
    desk.key_up(";")
    desk.frames(4)
    assert len(desk.world.batch(Spring)) == 1 and desk.window.tool == before


def test_chosen_keys_are_kept(desk: Desk, tmp_path: Path) -> None:
    path = tmp_path / "preferences.json"
    desk.window.keys.chosen = {"trails": "ctrl+j", "gravity": "t"}
    save_preferences(path, desk.window)
    again = Window(desk.window.canvas)
    load_preferences(path, again)
    assert again.keys.chosen == desk.window.keys.chosen and again.notice == ""


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (5, "keys = 5: must be an object"),
        ({"fly": ";"}, "keys[\"fly\"] = ';': nothing with a key of its own does that"),
        ({"trails": 3}, 'keys["trails"] = 3: must be the name of a key'),
        ({"trails": "hyperspace"}, "keys[\"trails\"] = 'hyperspace': must be the name of a key"),
        ({"trails": "g"}, "keys[\"trails\"] = 'g': G already does: gravity"),
        ({"quit": ";"}, "keys[\"quit\"] = ';': nothing with a key of its own does that"),
    ],
)
def test_bad_keys_of_preferences_are_named_and_the_usual_ones_taken(
    desk: Desk, tmp_path: Path, keys: object, words: str
) -> None:
    path = tmp_path / "preferences.json"
    path.write_text(json.dumps({"keys": keys, "text": 1.25}))
    load_preferences(path, desk.window)
    assert desk.window.notice == f"Preferences: {words}. The usual key is taken"
    assert desk.window.keys.chosen == {} and desk.window.text_scale == 1.25


@given(
    st.lists(
        st.tuples(st.sampled_from(CHOICES), st.sampled_from([*KEYS, ";", "k", "ctrl+j", "f11"])), max_size=12
    )
)
def test_no_key_ever_means_two_things(steps: list[tuple[Control, str]]) -> None:
    desk = DESK
    desk.window.keys.chosen = {}
    for control, key in steps:
        desk.window.keys.asks = control.does
        choosing_keys.choose_key(desk.world, desk.window, key)
    desk.window.keys.asks = ""
    own = [desk.window.keys.chosen.get(one.does, one.key) for one in CONTROLS if one.key]
    assert len(set(own)) == len(own)
    for control in CHOICES:
        pressed = (desk.window.keys.chosen.get(control.does, control.key),)
        assert choosing_keys.usual(pressed, desk.window) == (control.key,)
    read, wrong = choosing_keys.read_choice(desk.window.keys.chosen)
    assert (read, wrong) == (desk.window.keys.chosen, "")


DESK = sized((1280, 720), empty_world(gravity=(0, 0)))
