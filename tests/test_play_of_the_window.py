"""What the window adds to a world and the world does not know: dust, squash, sounds."""

import os
from typing import Any

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, empty_world
from recording import RecordingCanvas

from physicslab.components import MadeOf, Velocity
from physicslab.contacts.report import ImpactReader
from physicslab.prefabs import box, circle
from physicslab.theme import DARK
from physicslab.view.canvas.camera import Camera
from physicslab.view.overlay.dust import Dust
from physicslab.view.picture.bodies import draw_bodies
from physicslab.view.picture.squash import Squash
from physicslab.view.window.sounds import Sounds, voice_of, wave_of
from physicslab.world import World


def sliding(friction: float) -> World:
    """Return a world where a box slides on a floor."""
    world = empty_world()
    box(world, (0, -0.5), width=40, height=1, static=True, friction=friction)
    block = box(world, (0, 0.25), width=0.5, height=0.5, friction=friction)
    world.component(block, Velocity).linear = (3.0, 0.0)
    return world


@pytest.mark.parametrize(("friction", "seen"), [(0.3, True), (0.0, False)])
def test_dust_rises_where_a_body_is_rubbed_and_settles(friction: float, seen: bool) -> None:
    world, dust = sliding(friction), Dust()
    for _ in range(24):
        world.step(FRAME)
        dust.advance(world)
    assert bool(len(dust)) is seen
    if seen:
        assert np.abs(dust.puffs[:, 1]).max() < 0.02 and (np.diff(dust.puffs[:, 2]) >= 0.0).all()
        canvas = RecordingCanvas((1280, 720))
        dust.draw(world.time, Camera(canvas.size), DARK, canvas)
        drawn = canvas.called("lines")
        assert drawn and all((call["opacity"] < 0.25).all() for call in drawn)
        world.run(seconds=2.0)  # it rests by then
        dust.advance(world)
        assert not len(dust)


def falling(restitution: float = 0.5) -> tuple[World, int, np.ndarray[Any, Any]]:
    """Return a world in which a ball just hit the floor, the ball, and the impacts of that step."""
    world = empty_world()
    box(world, (0, -0.5), width=40, height=1, static=True, restitution=restitution)
    ball = circle(world, (0, 0.6), radius=0.5, restitution=restitution)
    world.component(ball, Velocity).linear = (0.0, -6.0)
    reader = ImpactReader()
    reader.follow(world)
    for _ in range(20):
        world.step(FRAME)
        impacts = reader.new(world)
        if len(impacts):
            return world, ball, impacts
    raise AssertionError("no impact")


def test_what_was_hit_is_smaller_for_a_moment_and_touches_what_it_hit() -> None:
    world, _, impacts = falling()
    squash, canvas = Squash(), RecordingCanvas((1280, 720))
    squash.note(impacts, world.time)
    with world.active():
        draw_bodies(world, Camera(canvas.size), DARK, canvas, squash)
        draw_bodies(world, Camera(canvas.size), DARK, canvas)
    small, real = canvas.called("discs")
    share = 1.0 - small["radius"][0] / real["radius"][0]
    assert 0.0 < share <= 0.03
    hit = Camera(canvas.size).project(np.array([(impacts["x"][0], impacts["y"][0])]))
    assert np.allclose(small["centre"] - hit, (1.0 - share) * (real["centre"] - hit))
    squash.note(impacts[:0], world.time + 0.07)
    assert squash.of(world, np.array([1]), np.zeros((1, 2)))[1].tolist() == [1.0]


def test_bodies_are_drawn_as_they_are_but_in_play() -> None:
    for level, paused, reduced, plays in (
        ("Explore", False, False, True), ("Measure", False, False, False),
        ("Explore", True, False, False), ("Explore", False, True, False),
    ):  # fmt: skip
        world, _, impacts = falling()
        canvas = RecordingCanvas((1280, 720))
        desk = Desk(world, canvas)
        desk.window.level, desk.window.pace.paused, desk.window.reduced_motion = level, paused, reduced
        desk.window.squash.note(impacts, world.time)
        desk.frames()
        drawn = canvas.called("discs")[0]["radius"][0]
        assert bool(drawn < 0.5 * desk.window.camera.scale - 1e-9) is plays
        pygame.display.quit()


def test_pitch_goes_by_size_and_material() -> None:
    world, ball, impacts = falling()
    large, plain = voice_of(world, impacts[0])
    world.add(ball, MadeOf("steel"))
    steel, look = voice_of(world, impacts[0])
    assert (plain, look) == ("plain", "metal") and steel > large
    world.discard(ball, MadeOf)
    small = circle(world, (5, 5), radius=0.125)
    world.synchronise()
    impacts["entity_b" if impacts["inverse_mass_b"][0] else "entity_a"] = small
    assert voice_of(world, impacts[0])[0] == large + 12  # a quarter of the size, two octaves, six steps each


@pytest.mark.parametrize("look", ["plain", "metal", "matt"])
def test_a_sound_begins_without_a_click_fades_and_has_its_pitch(look: str) -> None:
    wave = wave_of(12, look).astype(float)  # two octaves above 60 Hz
    assert abs(wave[0]) < 1.0 and np.abs(wave).max() <= 32767.0
    assert np.abs(wave[-200:]).max() < 0.05 * np.abs(wave).max()
    spectrum = np.abs(np.fft.rfft(wave, 22_050))
    assert abs(int(np.argmax(spectrum[:400])) - 240) <= 12


def test_impacts_are_heard_only_when_asked_for_and_silence_is_no_failure(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world, _, impacts = falling()
    monkeypatch.setitem(os.environ, "SDL_AUDIODRIVER", "dummy")
    sounds = Sounds()
    sounds.play(world, impacts)
    assert sounds.played == 0 and not pygame.mixer.get_init()
    sounds.on = True
    sounds.play(world, impacts)
    assert sounds.played == 1
    pygame.mixer.quit()
    monkeypatch.setitem(os.environ, "SDL_AUDIODRIVER", "there is none")
    mute = Sounds()
    mute.on = True
    mute.play(world, impacts)
    mute.play(world, impacts)
    assert mute.played == 0 and mute.failure


def test_a_window_without_a_device_says_so_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(os.environ, "SDL_AUDIODRIVER", "there is none")
    world, _, impacts = falling()
    desk = Desk(world)
    desk.key("s", pygame.KMOD_SHIFT)
    desk.frames()
    sounds = desk.window.sounds
    assert sounds.on
    sounds.play(world, impacts)
    desk.frames(2)
    assert sounds.failure and "No sound" in desk.window.notice
    assert not desk.window.sounds.on
    pygame.display.quit()
