"""Many runs of one scene: spaces of fields, measures, workers, results that survive a crash and are read."""

from physicslab.ensembles.fitting import FieldFit, fit
from physicslab.ensembles.result import EnsembleResult
from physicslab.ensembles.runs import ensemble
from physicslab.ensembles.sensitivity import Derivative, SobolIndices, sensitivity, sobol_indices

__all__ = [
    "Derivative", "EnsembleResult", "FieldFit", "SobolIndices", "ensemble", "fit", "sensitivity",
    "sobol_indices",
]  # fmt: skip
