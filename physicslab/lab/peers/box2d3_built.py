"""A world's scene in Box2D 3 in C, compiled here from its sources with a driver of our own, ``box2d3.c``."""

import ctypes
import math
import os
import shlex
import subprocess
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar, override

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Spring
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.mirrors import STRONG
from physicslab.lab.peers.peer import CannotBuild, Peer, PeerBody, PeerJoint

SUBSTEPS = 4
_CONTACT_HZ = 30.0
"""Its usual stiffness of contacts [Hz]: an eighth of the rate of those substeps at 60 steps a second."""
_DRIVER = Path(__file__).with_name("box2d3.c")
_OPTIONS = ("-std=c17", "-O3", "-DNDEBUG", "-ffp-contract=off", "-w", "-shared", "-fPIC")
"""Those of Box2D's own release build, for a library."""
_WIDE = ("-mavx2", "-DBOX2D_AVX2")
_KINDS = ("static", "kinematic", "dynamic")
_JOINTS = ("rod", "rope", "pin", "slot", "weld")
"""By the numbers that the driver has for them."""
_Numbers = ctypes.POINTER(ctypes.c_double)


class BuildError(Exception):
    """Box2D's sources cannot be compiled; the message has the reason."""


class BuiltBox2D(Peer):
    """A world in one of Box2D 3's in C: one worker, no Python within a step.

    Contacts have their usual stiffness, in shorter steps as much more as these allow.
    Made of a subclass that has a library: :func:`built_box2d`.
    """

    title, module = "Box2D 3 C", "ctypes"
    library: ClassVar[ctypes.CDLL]

    @override
    def make_space(self) -> None:
        self.space = self.library.scene_open(*self.gravity)
        weakref.finalize(self, self.library.scene_close, self.space)
        self.library.scene_stiffness(self.space, _CONTACT_HZ * self.finer)
        self.ground = self.add_body(PeerBody("static", (0.0, 0.0), 0.0))
        surface = self.world.physics.bounds_friction, self.world.physics.bounds_restitution
        for wall in self.walls():
            self.library.scene_wall(self.space, self.ground, _array(wall), *surface)

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self.library.scene_gravity(self.space, *gravity)

    @override
    def add_body(self, body: PeerBody) -> int:
        state = *body.place, math.cos(body.angle), math.sin(body.angle), *body.linear, body.angular
        return int(self.library.scene_body(self.space, _KINDS.index(body.kind), _array(state)))

    @override
    def add_shape(self, body: int, shape: Shape, material: Material) -> None:
        surface = material.friction, material.restitution
        if shape.kind == "circle":
            self.library.scene_disc(self.space, body, shape.radius, *surface)
        else:
            core = [float(part) for vertex in shape.core for part in vertex]
            self.library.scene_polygon(
                self.space, body, _array(core), len(core) // 2, shape.rounding, *surface
            )

    @override
    def weigh(self, body: int, mass: float, inertia: float) -> None:
        self.library.scene_mass(self.space, body, mass, inertia)

    @override
    def add_drag(self, body: int, rate: float) -> None:
        self.library.scene_drag(self.space, body, rate)

    @override
    def add_spring(self, spring: Spring, ends: Sequence[int], entity: int) -> None:
        anchors = _array((*spring.anchor_a, *spring.anchor_b))
        numbers = spring.rest_length, *self.frequency(entity, spring)
        self.library.scene_spring(self.space, *ends, anchors, *numbers)

    @override
    def add_joint(self, joint: PeerJoint) -> None:
        if joint.kind == "slot" and joint.angle is None:
            raise CannotBuild("no slot in which a body turns")
        axis = math.atan2(joint.axis[1], joint.axis[0])
        frames = (0.0, 0.0) if joint.angle is None else (axis, axis - joint.angle)
        most = 0.99 * math.pi if joint.kind == "pin" else STRONG
        numbers = (
            *joint.anchors[0], *joint.anchors[1], *frames, joint.length, max(joint.lower, -most),
            min(joint.upper, most), joint.speed, min(joint.strongest, STRONG),
        )  # fmt: skip
        flags = joint.collide, joint.is_limited
        self.library.scene_joint(self.space, _JOINTS.index(joint.kind), *joint.ends, *flags, _array(numbers))

    @override
    def run(self, dt: float, steps: int) -> None:
        self.library.scene_step(self.space, dt / self.finer, SUBSTEPS, steps * self.finer)

    @override
    def positions(self) -> NDArray[np.float64]:
        return self._every_state()[:, :2]

    def _every_state(self) -> NDArray[np.float64]:
        """Return x, y, vx, vy, angle and angular velocity of the ground and of every body (n, 6)."""
        found = np.empty((len(self._bodies) + 1, 6))
        self.library.scene_state(self.space, found.ctypes.data_as(_Numbers))
        return found

    @override
    def states(self) -> NDArray[np.float64]:
        found: NDArray[np.float64] = self._every_state()[[self._bodies[entity] for entity in self.moving]]
        return found

    @override
    def state(self, entity: int) -> Sequence[float]:
        found: list[float] = self._every_state()[self._bodies[entity]].tolist()
        return found


def built_box2d(sources: Path, folder: Path) -> type[BuiltBox2D]:
    """Compile Box2D and return it as an engine.

    The compiler is ``cc``, or what the environment's ``CC`` is. If this processor has AVX2, Box2D's
    vectors of eight are used.

    Parameters
    ----------
    sources : Path
        A checkout of Box2D 3.2 or later, with its folders ``include`` and ``src``.
    folder : Path
        Where the library is written; it must stay there while the engine is in use.

    Raises
    ------
    BuildError
        If there is no such checkout, or no compiler, or the sources do not compile.
    """
    if not (sources / "include" / "box2d" / "box2d.h").is_file():
        raise BuildError(f"{sources}: no checkout of Box2D 3: there is no include/box2d/box2d.h")
    compiler = shlex.split(os.environ.get("CC", "cc"))
    wide = "__AVX2__" in _run([*compiler, "-march=native", "-dM", "-E", "-x", "c", os.devnull])
    library = folder / "box2d3.so"
    found = map(str, (_DRIVER, *sorted((sources / "src").glob("*.c"))))
    places = "-I", str(sources / "include"), "-I", str(sources / "src"), "-o", str(library)
    _run([*compiler, *_OPTIONS, *(_WIDE if wide else ()), *places, *found, "-lm", "-lpthread"])

    class Engine(BuiltBox2D):
        title = f"{BuiltBox2D.title} AVX2" if wide else BuiltBox2D.title

    Engine.library = _loaded(library)
    return Engine


def _run(command: Sequence[str]) -> str:
    """Run a compiler and return what it printed."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise BuildError(f"no compiler: {command[0]}: {error.strerror}") from error
    if done.returncode:
        reason = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr[:200])
        raise BuildError(f"{command[0]} cannot compile Box2D: {reason}")
    return done.stdout


def _loaded(library: Path) -> ctypes.CDLL:
    """Return a library with the types of its functions, all of which take a scene first."""
    loaded = ctypes.CDLL(str(library))
    number, whole, scene = ctypes.c_double, ctypes.c_int, ctypes.c_void_p
    for name, types in {
        "close": (), "gravity": (number,) * 2, "body": (whole, _Numbers), "disc": (whole, *(number,) * 3),
        "polygon": (whole, _Numbers, whole, *(number,) * 3), "joint": (*(whole,) * 5, _Numbers),
        "wall": (whole, _Numbers, number, number),
        "mass": (whole, number, number), "drag": (whole, number),
        "spring": (whole, whole, _Numbers, *(number,) * 3),
        "step": (number, whole, whole), "stiffness": (number,), "state": (_Numbers,),
    }.items():  # fmt: skip
        function = getattr(loaded, f"scene_{name}")
        function.argtypes, function.restype = (scene, *types), whole if name == "body" else None
    loaded.scene_open.argtypes, loaded.scene_open.restype = (number, number), scene
    return loaded


def _array(numbers: Sequence[float]) -> ctypes.Array[ctypes.c_double]:
    return (ctypes.c_double * len(numbers))(*numbers)
