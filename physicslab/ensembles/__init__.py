"""Many runs of one scene: spaces of fields, measures, workers, and results that survive a crash."""

from physicslab.ensembles.result import EnsembleResult
from physicslab.ensembles.runs import ensemble

__all__ = ["EnsembleResult", "ensemble"]
