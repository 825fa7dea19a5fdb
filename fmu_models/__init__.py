"""The friction contact as functional mock-up units (FMUs) in C: pin, disc, and a clutch for drivetrains.

This third implementation takes only parameter names, units and bounds from the reference, not its physics.
"""

from fmu_models.archive import Exported, HeadersMissingError, export
from fmu_models.variables import CLUTCH, DISC, MODELS, PIN, Model, Variable

__all__ = [
    "CLUTCH",
    "DISC",
    "MODELS",
    "PIN",
    "Exported",
    "HeadersMissingError",
    "Model",
    "Variable",
    "export",
]
