"""PhysicsLab: a 2D physics sandbox for vectors, mechanics, momentum and collisions.

Examples
--------
>>> from physicslab import load_scene
>>> world = load_scene("two_planets")
>>> world.run(seconds=1.0)
>>> world.time
1.0
"""

from importlib import import_module

__version__: str
"""The version that is installed; asking where none is raises ``PackageNotFoundError``."""

TYPE_CHECKING = False
"""That of :mod:`typing`, which takes longer to import than all that a program needs at first."""

if TYPE_CHECKING:
    from physicslab.diagnostics.description import describe
    from physicslab.ecs.config import PhysicsConfig, SimulationConfig
    from physicslab.ecs.fields import InvalidValue
    from physicslab.ecs.vector import Vector2
    from physicslab.ensembles import ensemble
    from physicslab.files.scene import SceneError, load_scene, save_scene
    from physicslab.prefabs import box, capsule, chain, circle, pendulum, polygon
    from physicslab.state.masses import Diverged
    from physicslab.state.run import Run
    from physicslab.world import World

__all__ = [
    "Diverged", "InvalidValue", "PhysicsConfig", "Run", "SceneError", "SimulationConfig", "Vector2", "World",
    "box", "capsule", "chain", "circle", "describe", "ensemble", "load_scene", "pendulum", "polygon",
    "save_scene",
]  # fmt: skip

_HOMES = {
    "Diverged": "state.masses",
    "InvalidValue": "ecs.fields",
    "PhysicsConfig": "ecs.config",
    "Run": "state.run",
    "SceneError": "files.checks",
    "SimulationConfig": "ecs.config",
    "Vector2": "ecs.vector",
    "World": "world",
    "box": "prefabs",
    "capsule": "prefabs",
    "chain": "prefabs",
    "circle": "prefabs",
    "describe": "diagnostics.description",
    "ensemble": "ensembles",
    "load_scene": "files.scene",
    "pendulum": "prefabs",
    "polygon": "prefabs",
    "save_scene": "files.scene",
}


if not TYPE_CHECKING:  # type checkers know the names above, and which there are not

    def __getattr__(name: str) -> object:
        """Import a public name when it is first asked for.

        A world brings numba with it, which takes as long to import as all else together; on the first launch,
        before Python has kept its bytecode, seconds. The window must not wait for that.
        """
        if name == "__version__":
            from importlib.metadata import version

            return version(__name__)
        if name not in _HOMES:
            if name[:1] == "_":
                raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
            words = import_module(f"{__name__}.ecs.text").no_such(__name__, "name", name, __all__)
            raise AttributeError(words, name=None)
        try:
            value = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
        except AttributeError as error:  # of which Python would say that there is no such name
            raise ImportError(f"{__name__}.{name} cannot be imported: {error}") from error
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
