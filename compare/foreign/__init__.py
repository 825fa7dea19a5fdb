"""Foreign engines: the cases that measure them, and their recorded results."""

import functools
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.claims.claim import Kind
from compare.claims.error_estimates import TRUTH
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from reference_model import Trajectory, simulate
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System

# --- Motions that measure foreign engines: five of a pin and one of a disc on six points.

Quantity = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Case:
    """A motion and the quantity that is compared, complex numbers in m."""

    name: str  # heading of a column
    sentence: str  # the claim's
    system: System
    start: tuple[float, ...]
    times: FloatArray
    quantity: Callable[[Trajectory], Quantity]
    resolution: float  # a tenth of the change due to another friction law or to a release
    formula: Callable[[], Quantity] | None = None  # closed form of the quantity; None: from the reference
    equation: str = ""  # number in the paper, for ``formula``

    @property
    def negligible(self) -> float:
        """Negligible error in m: 1 % of the effect of another law."""
        return 0.1 * self.resolution

    @property
    def kind(self) -> Kind:
        """Source of the exact quantity."""
        return "formula" if self.formula else "trajectory"

    @property
    def truth(self) -> str:
        """Source of the exact motion in words."""
        return f"closed form {self.equation}" if self.formula else "our reference"

    def exact(self) -> Quantity:
        """Return the exact quantity."""
        return self.formula() if self.formula else _simulated(self)


@functools.cache
def _simulated(case: Case) -> Quantity:
    return case.quantity(simulate(case.system, case.start, case.times, tolerance=TRUTH))


def _places(trajectory: Trajectory) -> Quantity:
    """Return the positions of the pin, or of a disc's first contact point, which depends on its angle too."""
    system, states = trajectory.system, trajectory.states
    places = states[:, 0] + 1j * states[:, 1]
    if isinstance(system, DiscOnDisc):
        places = places + system.contact_radius * np.exp(1j * states[:, ANGLE])
    return np.asarray(places)


def _radius(trajectory: Trajectory) -> Quantity:
    late = trajectory.times >= 0.8 * trajectory.times[-1]
    return np.array([np.mean(np.abs(_places(trajectory)[late]))], dtype=complex)


_CENTRED = replace(FIG5, offset=0.0)
_ON_THE_WHIRL = (0.9, 0.0, 0.0, 0.9)
_ON_THE_DISC = (0.05, 0.0, 0.0, 0.05 * _CENTRED.disc_speed)
_UNTIL_RELEASE = (-0.022, 0.033, -0.033 * FIG5.disc_speed, -0.022 * FIG5.disc_speed)
_PIN_TIMES = np.linspace(0.0, 100.0, 101)
_STUCK_TIMES = np.linspace(0.0, 20.0, 21)


def _exact_radius() -> Quantity:
    return np.array([whirl_radius(_CENTRED)], dtype=complex)


def _exact_stuck() -> Quantity:
    """Return the positions of a pin that turns with the disc, whatever the law of slip."""
    return np.asarray(_ON_THE_DISC[0] * np.exp(1j * _CENTRED.disc_speed * _STUCK_TIMES))


CASES = {
    "slip": Case(
        name="pin slides",
        sentence="A pin that slides follows Coulomb's law",
        system=FIG5,
        start=_ON_THE_WHIRL,
        times=_PIN_TIMES,
        quantity=_places,
        resolution=0.025,
    ),
    "stick-slip": Case(
        name="pin sticks 9 times",
        sentence="A pin that sticks nine times follows Coulomb's law",
        system=FIG5,
        start=FIG5_STARTS["whirl"],
        times=_PIN_TIMES,
        quantity=_places,
        resolution=0.08,
    ),
    "whirl": Case(
        name="pin whirls",
        sentence="The whirl's radius is that of (11)",
        system=_CENTRED,
        start=_ON_THE_WHIRL,
        times=_PIN_TIMES,
        quantity=_radius,
        formula=_exact_radius,
        resolution=9e-3,
        equation="(11)",
    ),
    "stuck": Case(
        name="pin stays stuck",
        sentence="A pin that sticks turns with the disc",
        system=_CENTRED,
        start=_ON_THE_DISC,
        times=_STUCK_TIMES,
        quantity=_places,
        formula=_exact_stuck,
        resolution=5e-3,
        equation="(6)",
    ),
    "release": Case(
        name="pin is released",
        sentence="The release of a pin follows Coulomb's law",
        system=FIG5,
        start=_UNTIL_RELEASE,
        times=np.linspace(0.0, 4.0, 41),
        quantity=_places,
        resolution=3.5e-3,
    ),
    "disc": Case(
        name="disc on 6 points",
        sentence="A disc on six points follows Coulomb's law",
        system=replace(FIG11, contact_points=6),
        start=(0.05, 0.0, 0.0, 0.0, 0.05, 1.3),
        times=np.linspace(0.0, 50.0, 51),
        quantity=_places,
        resolution=2.5e-3,
    ),
}
"""Cases with the parameters of Figs. 5 and 11; initial states on the disc and on the whirl are ours."""


# --- Results of foreign engines and of our own, recorded by ``builders/record.py``.

FOLDER = Path(__file__).parent

COLUMNS = ("tolerance", "steps", "error", "change", "seconds", "wall")
"""Columns of a recorded run.

"error" is the largest error over time in m. "change" is the change in m against the previous run, whose tolerance is
larger by ``compare.claims.error_estimates.COARSENING``. "seconds" is processor time, or wall-clock time for an engine
in another process; "wall" is wall-clock time.
"""

TOLERANCE, STEPS, ERROR, CHANGE, SECONDS, WALL = range(len(COLUMNS))

DIGITS = 4


@dataclass(frozen=True, eq=False)
class Recording:
    """One setting of an engine.

    ``runs`` are arrays of shape (n, len(COLUMNS)) for each supported case, the largest tolerance first.
    """

    engine: str
    version: str
    recorded: str
    platform: str
    setting: str  # name; "" for one of our own engines
    says: str
    step: float | None  # in s at the usual tolerance; None if the engine has a tolerance
    runs: Mapping[str, FloatArray]
    probes: Mapping[str, Any]  # parts ``compare.diagnosis.findings.PROBES`` as JSON; empty if not recorded
    claims: Mapping[str, Mapping[str, Any]]  # claims as JSON by study and identity

    @property
    def name(self) -> str:
        """Engine and setting, separated by a comma."""
        return f"{self.engine}, {self.setting}" if self.setting else self.engine


def recordings() -> tuple[Recording, ...]:
    """Return all recordings: the reference, then our other engines, then foreign engines.

    Raises ``ValueError`` if the columns of a file differ from ``COLUMNS``.
    """
    found: list[Recording] = []
    for path in sorted(FOLDER.glob("*.json")):
        file = json.loads(path.read_text(encoding="utf-8"))
        if tuple(file["columns"]) != COLUMNS:
            raise ValueError(f"{path.name}: columns = {file['columns']}: they must be {list(COLUMNS)}")
        about = {key: file[key] for key in ("engine", "version", "recorded", "platform")}
        for setting in file["settings"]:
            runs = {case: np.array(rows, dtype=float) for case, rows in setting["runs"].items()}
            own = {"setting": setting["name"], "says": setting["says"], "step": setting.get("step")}
            laws = {"probes": setting.get("probes", {}), "claims": setting.get("claims", {})}
            found.append(Recording(**about, **own, runs=runs, **laws))
    return tuple(sorted(found, key=lambda it: (it.setting != "", it.engine != "reference", it.engine)))


ORDERS = np.linspace(0.4, 8.0, 153)
"""Orders of convergence among which the fit chooses. At the smallest step, the changes do not fall."""

SAFETY = 2.0
"""Ratio of the estimate to the extrapolated error; the recordings of first order need 1.4."""


def estimate(runs: FloatArray) -> float:
    """Return the error estimate in m of the finest of ``runs``, by Richardson's extrapolation; 0 of a single run.

    For an error C·h^p with the recorded step h = 1/``STEPS``, the order p fits the last three changes, and C the last
    two. If the changes do not fall, the estimate is ``SAFETY`` times the last change.
    """
    last = runs[-4:]
    known = np.isfinite(last[1:, CHANGE])
    if not np.any(known):
        return 0.0
    with np.errstate(divide="ignore", over="ignore"):
        fall = -np.diff((1.0 / last[:, STEPS]) ** ORDERS[:, np.newaxis])[:, known]
        factors = last[1:, CHANGE][known] / fall
        best = int(np.argmin(np.ptp(np.log(factors), axis=1)))
        left = np.max(factors[best, -2:]) * last[-1, STEPS] ** -ORDERS[best]
    return float(SAFETY * (left if best else last[-1, CHANGE]))
