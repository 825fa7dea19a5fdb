"""Results that a run does not measure: recorded results of engines, and validations.

A validation compares a prediction of theory with a measured experiment. It is not a verdict, because a friction law
describes a real contact only to some extent. A validation states how much of the difference the known uncertainties
explain (ASME V&V 20-2009).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from compare.claims.claim import Claim

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


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recorded results for one setting of an engine, not measured in a run.

    - ``setting``, ``date``: name of the setting ("" if there is only one), and date of the recording.
    - ``own``, ``shipped``: False if the friction is a user-defined force; True if all settings are the defaults.
    - ``cases``: name of the motion, and the source of its exact course, by the sentence of each claim.
    - ``reasons``, ``costs``: why a claim does not agree, and the step or tolerance and time of its run, by sentence.
    - ``law``, ``says``, ``adapter``: shape of the friction law, description of the setting, and file of the adapter.
    - ``advice``: refinement for a small error, or the error of the finest run, as a clause.
    - ``whirl``: relative error of the radius of the whirl; NaN if not simulated.
    """

    engine: str
    setting: str
    version: str
    date: str
    claims: tuple[Claim, ...]
    own: bool = True
    shipped: bool = False
    cases: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    costs: Mapping[str, str] = field(default_factory=dict)
    law: str = ""
    says: str = ""
    adapter: str = ""
    advice: str = ""
    whirl: float = math.nan
