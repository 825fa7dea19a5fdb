"""The energy balance of a model, which checks any run without a reference solution.

For any bodies and force laws, gains equal losses plus the change of the stored energy. The solver integrates powers
along with all coordinates, so works are as accurate as the motion.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import repeat
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_models.solver.items import IN_MEMORY, at_assembly, items, node_sensor
from exudyn_models.solver.solver_run import quiet
from exudyn_models.solver.works import Power, add_works
from reference_model.systems import FloatArray, positive_number, require_callable, require_kind, shown

Energy: TypeAlias = Callable[[Any], float]
"""Function of ``mbs`` that returns an energy in J of the current motion."""


CLOSED = 1e-6
"""Residual, as a share of the energy turned over, above which a balance issues a warning."""

ROUNDING = 1e-14
"""Rounding error of the stored energy, relative to it."""


@dataclass(frozen=True, eq=False)
class EnergyBalance:
    """Energies of a model at the output times of its sensors, in J and of shape (n,).

    ``gains`` and ``losses`` are the energies supplied by each source and removed by each sink since the start.
    ``stored`` is the kinetic energy plus the energy of the springs.
    """

    times: FloatArray
    gains: dict[str, FloatArray]
    losses: dict[str, FloatArray]
    stored: FloatArray

    @property
    def residual(self) -> FloatArray:
        """Gains minus losses minus the change of stored energy: zero for the exact motion."""
        put_in, taken_out = (
            sum(parts.values(), np.zeros(len(self.times))) for parts in (self.gains, self.losses)
        )
        return np.asarray(put_in - taken_out - (self.stored - self.stored[0]))

    @property
    def turnover(self) -> float:
        """Largest of all works and changes of stored energy."""
        parts = [*self.gains.values(), *self.losses.values(), self.stored - self.stored[0]]
        return float(max(np.max(np.abs(part)) for part in parts))

    @property
    def imbalance(self) -> str:
        """Sentence about the largest residual, or "" if it is below ``CLOSED`` of the turnover."""
        worst = int(np.argmax(np.abs(self.residual)))
        size, turnover = abs(float(self.residual[worst])), self.turnover
        rounding = ROUNDING * float(np.max(np.abs(self.stored)))  # large if a heavy flywheel holds a speed
        if size <= CLOSED * turnover + rounding:
            return ""
        return (
            f"the energy balance is off by {size:.2g} J at t = {self.times[worst]:.6g} s, {size / turnover:.1e} of "
            "the energy turned over; use a smaller step or tolerance, or add the missing source, sink or spring"
        )


def add_energy_balance(
    mbs: Any,
    *,
    gains: Mapping[str, Power],
    losses: Mapping[str, Power],
    stored: Sequence[Energy] = (),
    unit: float = 1.0,
) -> Callable[[], EnergyBalance]:
    """Add an energy balance to ``mbs``; return a function that reads it after a run.

    It issues a ``RuntimeWarning`` if the residual exceeds 1e-6 of the energy turned over. The kinetic energy of all
    bodies is included automatically. Use ``spring_energy`` for native connectors with an output ``PotentialEnergy``.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model with all its bodies, not yet assembled.
    gains, losses : dict of Power
        Powers by name: drives and loads; friction (``RingFriction.power``) and dampers.
    stored : sequence of Energy
        Energies of all springs.
    unit : float
        Energy in J per unit of the work coordinates, which determines the weight of their errors in DOPRI5.

    Raises
    ------
    ValueError
        If ``unit`` is not > 0, ``gains`` and ``losses`` are both empty or share a name, or a ``spring_energy`` refers
        to an object without potential energy.

    """
    require_kind("mbs", mbs, exu.MainSystem)
    unit = positive_number("unit", unit, "J")
    require_kind("stored", stored, Sequence)
    for i, energy in enumerate(stored):
        require_callable(f"stored[{i}]", energy, "mbs")
    _check_powers(gains, losses)
    _check_springs(mbs, [spring for spring in stored if isinstance(spring, _SpringEnergy)])
    works = add_works(mbs, {**gains, **losses}, unit)
    works_sensor = node_sensor(mbs, works, exu.OutputVariableType.Coordinates)
    energy_sensor = _add_energy(mbs, stored)

    def read() -> EnergyBalance:
        times, *works = mbs.GetSensorStoredData(works_sensor).T
        parts = dict(zip((*gains, *losses), (unit * work for work in works), strict=True))
        balance = EnergyBalance(
            times,
            {name: parts[name] for name in gains},
            {name: parts[name] for name in losses},
            mbs.GetSensorStoredData(energy_sensor)[:, 1],
        )
        if text := balance.imbalance:
            warnings.warn(text, RuntimeWarning, stacklevel=2)
        return balance

    return read


def _check_powers(gains: Mapping[str, Power], losses: Mapping[str, Power]) -> None:
    for name, powers in (("gains", gains), ("losses", losses)):
        require_kind(name, powers, Mapping)
        for key, power in powers.items():
            require_callable(f"{name}[{key!r}]", power, "mbs", "t")
    if not gains and not losses:
        raise ValueError("gains and losses are both empty: an energy balance needs at least one power")
    for name in gains:
        if name in losses:
            raise ValueError(f"gains, losses: {name!r} names both a gain and a loss; use two names")


def _add_energy(mbs: Any, stored: Sequence[Energy]) -> Any:
    bodies: list[int] = []
    at_assembly(mbs, bodies.clear)

    def energy(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
        if not bodies:  # they have outputs only after assembly
            bodies[:] = _bodies(mbs)
        kinetic = map(mbs.GetObjectOutputBody, bodies, repeat(exu.OutputVariableType.KineticEnergy))
        return [float(sum(kinetic)) + sum(spring(mbs) for spring in stored)]

    return mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=energy, **IN_MEMORY))


def spring_energy(connector: Any) -> Energy:
    """Return the energy of a native connector with springs, from its ``ObjectIndex``."""
    if type(connector).__name__ != "ObjectIndex":
        raise ValueError(f"connector = {shown(connector)}: it must be the ObjectIndex of a spring")
    return _SpringEnergy(connector)


@dataclass(frozen=True)
class _SpringEnergy:
    connector: Any

    def __call__(self, mbs: Any) -> float:
        return float(mbs.GetObjectOutput(self.connector, exu.OutputVariableType.PotentialEnergy))


def _check_springs(mbs: Any, springs: Sequence[_SpringEnergy]) -> None:
    """Raise ``ValueError`` if a spring has no energy, unless the model is still incomplete."""
    for spring in springs:
        try:
            kind = mbs.GetObject(spring.connector)["objectType"]
        except exu.ExudynError:
            raise ValueError(
                f"spring_energy({spring.connector!r}): it must be the ObjectIndex of an object of this model"
            ) from None
        with quiet():
            try:
                mbs.Assemble()
            except exu.ExudynError:
                return
            try:
                spring(mbs)
            except exu.ExudynError:
                raise ValueError(
                    f"spring_energy of object {int(spring.connector)}: this {kind} has no potential energy; use "
                    "an Exudyn spring without user function, or a function of mbs that returns the energy"
                ) from None


def _bodies(mbs: Any) -> list[int]:
    """Return the objects with a kinetic energy, without the massless connectors of this package."""
    found = []
    for item in range(mbs.systemData.NumberOfObjects()):
        try:
            mbs.GetObjectOutputBody(item, exu.OutputVariableType.KineticEnergy)
        except exu.ExudynError:  # grounds and connectors
            continue
        body = mbs.GetObject(item)
        mass = body.get("massMatrix")
        if mass is None or body["massMatrixUserFunction"] or mass.Convert2DenseMatrix().any():
            found.append(item)
    return found
