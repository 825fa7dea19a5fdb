"""The largest stable step of explicit solvers while contacts stick.

Sticking contacts are dampers between their bodies (``stick_dampers``). With all dampers the fastest decay rate is the
largest eigenvalue λ of M⁻¹·D. The step must stay below Z/λ, with Z the ``INTERVALS`` of the solver. For one
contact of two rotors λ = (μN/ε)·(R²/J₁ + R²/J₂).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.stick_dampers import StickDampers
from exudyn_models.solver.contacts import contacts_of
from exudyn_models.solver.linear.matrices import matrices_of_model, singular_mass
from exudyn_models.solver.solver_run import raise_interrupt
from reference_model.systems import FloatArray, require_kind

INTERVALS = {
    "ExplicitEuler": 2.0,
    "ExplicitMidpoint": 2.0,
    "RK33": 2.5127453,
    "RK44": 2.7852935,
    "RK67": 2.8656205,
    "VelocityVerlet": 2.0,  # as implemented in Exudyn, with velocities that lag behind in dampers
}
"""Z of the solvers with a fixed step: ẋ = −λx decays while λ·step < Z. All other solvers choose their steps."""


@dataclass(frozen=True, eq=False)
class ModelInStick:
    """Model with all contacts in stick, linearised about its initial values.

    ``mass`` and ``damping``, shape (n, n), are its matrices; ``damping`` excludes the ``contacts``, which list the
    coordinates and dampers of each contact.
    """

    mass: FloatArray
    damping: FloatArray
    contacts: tuple[tuple[Any, StickDampers], ...]

    @classmethod
    def of(cls, mbs: Any, t: float) -> ModelInStick | None:
        """Return the linearisation at the time t (s); None if the model has no contact."""
        found = {item: contact for item, contact in contacts_of(mbs).items() if contact.stick is None}
        if not found:
            return None
        with _inactive(mbs, [item for item, contact in found.items() if contact.built_in]):
            mass, _, damping = matrices_of_model(mbs, t)
        data, initial = mbs.systemData, exu.ConfigurationType.Initial
        q, q_t = data.GetODE2Coordinates(initial), data.GetODE2Coordinates_t(initial)
        contacts = []
        for item, contact in found.items():
            places = np.array(data.GetObjectLTGODE2(item))
            if not contact.built_in:
                jacobian = contact.functions["jacobian"]
                now = jacobian(mbs, t, item, q[places].tolist(), q_t[places].tolist(), 0.0, 1.0)
                damping[np.ix_(places, places)] -= now
            contacts.append((places, contact.dampers))
        return cls(mass, damping, tuple(contacts))

    @property
    def varies(self) -> bool:
        """True if a load or coefficient is a function."""
        return any(dampers.vary for _, dampers in self.contacts)

    def decay(self, t: float, coordinates: FloatArray) -> float:
        """Return the fastest decay rate λ in 1/s at the time t (s) and the model's ``coordinates``, shape (n,)."""
        own = [
            (np.ix_(places, places), dampers.at(t, coordinates[places])) for places, dampers in self.contacts
        ]
        total = self.damping.copy()
        for places, (creeping, *_) in own:
            total[places] += creeping
        cases = [total]
        for places, (creeping, *alone) in own:
            for point in alone:
                cases.append(total.copy())
                cases[-1][places] += point - creeping
        return float(np.linalg.eigvals(np.linalg.solve(self.mass, np.array(cases))).real.max())


def largest_stable_step(mbs: Any, solver_type: Any) -> float:
    """Return the largest stable step in s of an explicit solver while all contacts of a model stick.

    It refers to the initial values and time 0, and is infinite without contacts. A disc that creeps about a point on
    or near its circle of contact chatters from a quarter of this step on. At half of this step the chatter is below 7
    % of the creep. The model is assembled if necessary.

    ``solver_type`` is ``ExplicitEuler``, ``ExplicitMidpoint``, ``RK33``, ``RK44``, ``RK67`` or ``VelocityVerlet``.
    Raises ``ValueError`` for any other solver, or a model with constraints or a singular mass matrix.
    """
    require_kind("mbs", mbs, exu.MainSystem)
    require_kind("solver_type", solver_type, exu.DynamicSolverType)
    if solver_type.name not in INTERVALS:
        raise ValueError(
            f"solver_type = {solver_type.name}: it must be explicit with a fixed step: {', '.join(INTERVALS)}"
        )
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    if constraints := mbs.systemData.AEsize():
        raise ValueError(
            f"this model has {constraints} constraint equations, which an explicit solver would ignore; a "
            "NodeRigidBodyEP has one"
        )
    model = ModelInStick.of(mbs, 0.0)
    if model is None:
        return math.inf
    if massless := singular_mass(mbs):
        raise ValueError(f"{massless}; no explicit solver can run this model")
    decay = model.decay(0.0, mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial))
    return INTERVALS[solver_type.name] / decay if decay > 0.0 else math.inf


LOOKS = 100
"""Number of checks of functions for loads and coefficients after the start of a run."""


class StepCheck:
    """Warns once if the fixed step of a run is too large for stick."""

    def __init__(self, mbs: Any, solver: str, options: Any) -> None:
        self._solver, self._span = solver, options.endTime - options.startTime
        self._step = self._span / options.numberOfSteps
        #: Time in s of the next check.
        self.next_time = math.inf
        self._model = _in_stick(mbs, options.startTime) if solver in INTERVALS else None

    def warn(self, t: float, coordinates: FloatArray) -> None:
        """Warn if the step is too large at the time t (s) and the model's ``coordinates``."""
        if self._model is None:
            return
        self.next_time = t + self._span / LOOKS if self._model.varies else math.inf
        try:
            decay = self._model.decay(t, coordinates)
        except Exception:  # the run itself will report the error, with its time
            return
        limit = INTERVALS[self._solver] / decay if decay > 0.0 else math.inf
        if self._step <= limit:
            return
        self.next_time = math.inf
        warnings.warn(
            f"{self._solver} with steps of {self._step:.3g} s is unstable while the contacts of this model stick; "
            f"with the friction at t = {t:.6g} s the limit is {limit:.3g} s: use numberOfSteps >= "
            f"{math.ceil(self._span / limit):,}, a larger regularisation, DOPRI5 with automatic steps, or "
            "an implicit solver",
            RuntimeWarning,
            stacklevel=5,
        )


def _in_stick(mbs: Any, t: float) -> ModelInStick | None:
    try:
        return ModelInStick.of(mbs, t)
    except Exception as error:  # the run itself will report the error, with its time
        if isinstance(error, exu.ExudynError):
            raise_interrupt(error)
        return None


@contextmanager
def _inactive(mbs: Any, items: Sequence[int]) -> Iterator[None]:
    for item in items:
        mbs.SetObjectParameter(item, "activeConnector", False)
    try:
        yield
    finally:
        for item in items:
            mbs.SetObjectParameter(item, "activeConnector", True)
