"""The friction contact as functional mock-up units in C: pin, disc, and a clutch for drivetrains.

A third implementation, which takes names of parameters from the reference and no physics.
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
