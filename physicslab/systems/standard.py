"""The physics systems, in the order in which they run within a stage. A new system is added here."""

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
from physicslab.systems.strobe import StrobeSystem
from physicslab.systems.system import System
from physicslab.systems.thrust import ThrustSystem
from physicslab.systems.trail import TrailSystem

PHYSICS_SYSTEMS: tuple[type[System], ...] = (
    GravitySystem,
    SpringSystem,
    DragSystem,
    ThrustSystem,
    PullSystem,
    CoulombSystem,
    ElectricFieldSystem,
    MagneticFieldSystem,
    MoleculeSystem,
    MediumSystem,
    IntegrateSystem,
    JointSystem,
    BroadPhaseSystem,
    ContactSystem,
    SleepSystem,
    ResolveSystem,
    TrailSystem,
    StrobeSystem,
    GateSystem,
    BreakSystem,
)


def standard_systems() -> tuple[System, ...]:
    """Return one of each physics system, for a world that may hold anything."""
    return tuple(system() for system in PHYSICS_SYSTEMS)
