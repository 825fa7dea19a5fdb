"""A validation: a prediction of theory against a measured experiment.

It is not a verdict, because a friction law describes a real contact only to some extent. A validation states how much
of the difference the known uncertainties explain (ASME V&V 20-2009).
"""

from dataclasses import dataclass

EXPECTED = 0.95
"""Share of measurements within twice their standard uncertainty, if nothing but the known uncertainties acts."""


@dataclass(frozen=True)
class Validation:
    """Result of a comparison with measurements.

    - ``quantity``, ``unit``: compared quantity, and the unit of all following numbers.
    - ``error``, ``error_uncertainty``: median of the comparison error E = S − D, and its standard error from the
      scatter.
    - ``data``, ``input``, ``numerical``: median standard uncertainties of the data, the parameters and the
      computation.
    - ``explained``: share of the ``count`` measurements with |E| at most twice their total uncertainty.
    - ``factor``: ratio between the uncertainties that would explain a share of ``EXPECTED`` and the known ones.
    - ``model``: standard deviation of an error of the theory that would have the same effect.
    """

    quantity: str
    unit: str
    error: float
    error_uncertainty: float
    data: float
    input: float
    numerical: float
    explained: float
    factor: float
    model: float
    count: int
