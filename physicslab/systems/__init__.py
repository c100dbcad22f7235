"""The systems, one file each, and what new ones begin with: ``from physicslab.systems import GravitySystem``.

Those of a frame, which are given what they draw with, are in :mod:`physicslab.systems.frame`.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from physicslab.systems.breaking import BreakSystem
    from physicslab.systems.broad_phase import BroadPhaseSystem
    from physicslab.systems.charged import ElectricFieldSystem, MagneticFieldSystem
    from physicslab.systems.contact import ContactSystem
    from physicslab.systems.coulomb import CoulombSystem
    from physicslab.systems.drag import DragSystem
    from physicslab.systems.gate import GateSystem
    from physicslab.systems.gravity import GravitySystem
    from physicslab.systems.integrate import IntegrateSystem
    from physicslab.systems.joint import JointSystem
    from physicslab.systems.medium import MediumSystem
    from physicslab.systems.molecule import MoleculeSystem
    from physicslab.systems.pull import PullSystem
    from physicslab.systems.resolve import ResolveSystem
    from physicslab.systems.sleep import SleepSystem
    from physicslab.systems.spring import SpringSystem
    from physicslab.systems.standard import standard_systems
    from physicslab.systems.strobe import StrobeSystem
    from physicslab.systems.system import ForceSystem, Stage, System
    from physicslab.systems.thrust import ThrustSystem
    from physicslab.systems.trail import TrailSystem

__all__ = [
    "BreakSystem", "BroadPhaseSystem", "ContactSystem", "CoulombSystem", "DragSystem", "ElectricFieldSystem",
    "ForceSystem", "GateSystem", "GravitySystem", "IntegrateSystem", "JointSystem", "MagneticFieldSystem",
    "MediumSystem", "MoleculeSystem", "PullSystem", "ResolveSystem", "SleepSystem", "SpringSystem", "Stage",
    "StrobeSystem", "System", "ThrustSystem", "TrailSystem", "standard_systems",
]  # fmt: skip


if not TYPE_CHECKING:  # type checkers know the names above, and which there are not

    def __getattr__(name: str) -> object:
        """Import a public name when it is first used: modules of systems import others of this package."""
        if name not in __all__:
            if name[:1] == "_":
                raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
            raise AttributeError(
                import_module("physicslab.ecs.text").no_such(__name__, "name", name, __all__)
            )
        home = "system" if name in ("ForceSystem", "Stage") else "standard"
        return getattr(import_module(f"{__name__}.{home}"), name)
