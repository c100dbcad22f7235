"""The built-in scenes, a file each, in one explicit list.

They are Python and not JSON: ten lines that call prefabs say what a scene of two thousand bodies is, can be
read and varied (the pyramid's base, the gas's seed), and are the examples that a contributor starts from.
``save_scene`` makes a file of any of them.

To add one: write a file with a function of its name that a :class:`Scene` decorates, and name it here.
"""

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from physicslab.scenes.scene import Scene

__all__ = ["SCENES", "Scene"]

_NAMES = (
    "sandbox",
    "drop",
    "bounces",
    "slope",
    "stack",
    "pyramid",
    "dominoes",
    "seesaw",
    "loop_the_loop",
    "pile",
    "gas",
    "billiards",
    "newtons_cradle",
    "carts",
    "pendulum",
    "double_pendulum",
    "piston",
    "four_bar",
    "gear_train",
    "pulleys",
    "bridge",
    "crane",
    "car",
    "catapult",
    "ragdoll",
    "spring_chain",
    "resonance",
    "rocket",
    "floating",
    "droplets",
    "rutherford",
    "crossed_fields",
    "cyclotron",
    "two_planets",
    "solar_system",
)


class _Scenes(Mapping[str, "Scene"]):
    """Scenes by name, each imported when it is looked up: names are available before there is a world."""

    def __getitem__(self, name: str) -> "Scene":
        if name not in _NAMES:
            raise KeyError(name)
        scene: Scene = getattr(import_module(f"{__name__}.{name}"), name)
        return scene

    def __contains__(self, name: object) -> bool:
        return name in _NAMES

    def __iter__(self) -> Iterator[str]:
        return iter(_NAMES)

    def __len__(self) -> int:
        return len(_NAMES)


SCENES = _Scenes()
"""Every built-in scene by name: the playground that opens by itself, then from the simplest on."""


def __getattr__(name: str) -> object:
    if name != "Scene":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"{__name__}.scene").Scene
