"""A validation: a prediction of theory against a measured experiment.

It is not a verdict. Two codes that solve the same equations agree or differ, but a law of friction describes a
real contact only to some extent. A validation states how far, and how much of the difference the known
uncertainties explain.

ASME V&V 20-2009, Standard for Verification and Validation in Computational Fluid Dynamics and Heat Transfer.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Validation:
    """Result of a comparison with measurements.

    Parameters
    ----------
    sentence : str
        Result in a sentence, with its numbers.
    quantity, unit : str
        Compared quantity, and the unit of all following numbers.
    error : float
        Median size of the comparison error E = S − D over all measurements.
    error_uncertainty : float
        Standard error of this median, from the scatter of the measurements.
    data, input, numerical : float
        Median standard uncertainties of the measured data, of the parameters and of the computation.
    explained : float
        Share of the measurements with |E| at most twice their total uncertainty.
    count : int
        Number of measurements.

    """

    sentence: str
    quantity: str
    unit: str
    error: float
    error_uncertainty: float
    data: float
    input: float
    numerical: float
    explained: float
    count: int
