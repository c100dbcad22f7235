"""The stages of a substep as kernels that Python calls, with plain tuples of arrays."""

from physicslab.kernels import kernel
from physicslab.kernels.arguments import (
    Acting,
    ActingTuple,
    Bounds,
    BoundsTuple,
    Inverse,
    InverseTuple,
    Log,
    Materials,
    MaterialsTuple,
    Motion,
    MotionTuple,
    NearTuple,
    Sizes,
    SizesTuple,
    Softness,
    SoftnessTuple,
    named_near,
)
from physicslab.kernels.records import Impacts
from physicslab.kernels.solver.stages import find_touching, press, relax, resolve_all_impacts

__all__ = ["find_stage", "impact_stage", "relax_stage", "solve_stage"]


@kernel
def find_stage(
    near: NearTuple, motion: MotionTuple, sizes: SizesTuple, materials: MaterialsTuple,
    inverse: InverseTuple, bounds: BoundsTuple, first: bool, h: float, start: float,
    speculative_margin: float,
) -> None:  # fmt: skip
    """Find where near bodies touch (:func:`~physicslab.kernels.solver.stages.find_touching`)."""
    find_touching(
        named_near(near), Motion(*motion), Sizes(*sizes), Materials(*materials),
        Inverse(*inverse), Bounds(*bounds), first, h, start, speculative_margin,
    )  # fmt: skip


@kernel
def impact_stage(
    near: NearTuple, motion: MotionTuple, sizes: SizesTuple, inverse: InverseTuple, acting: ActingTuple,
    log: Impacts, moment: float, h: float, start: float, end: float,
) -> int:  # fmt: skip
    """Bounce what meets (:func:`~physicslab.kernels.solver.stages.resolve_all_impacts`)."""
    of = named_near(near)
    return resolve_all_impacts(
        of, Motion(*motion), Sizes(*sizes), Inverse(*inverse), Acting(*acting),
        Log(log, moment, of.account), h, start, end,
    )  # fmt: skip


@kernel
def solve_stage(
    near: NearTuple, motion: MotionTuple, inverse: InverseTuple, acting: ActingTuple,
    softness: SoftnessTuple, h: float, impulse_dt: float, iterations: int,
) -> float:  # fmt: skip
    """Find the impulses that keep bodies apart (:func:`~physicslab.kernels.solver.stages.press`)."""
    return press(
        named_near(near), Motion(*motion), Inverse(*inverse), Acting(*acting),
        Softness(*softness), h, impulse_dt, iterations,
    )  # fmt: skip


@kernel
def relax_stage(
    near: NearTuple, motion: MotionTuple, inverse: InverseTuple, acting: ActingTuple,
    softness: SoftnessTuple, h: float, iterations: int,
) -> None:  # fmt: skip
    """Take back what the correction left (:func:`~physicslab.kernels.solver.stages.relax`)."""
    relax(
        named_near(near), Motion(*motion), Inverse(*inverse), Acting(*acting), Softness(*softness), h,
        iterations,
    )  # fmt: skip
