"""Works: integrals of powers, which solvers integrate along with all coordinates.

In implicit runs of ``solve_dynamic`` they are evaluated once at the ends of accepted steps, not in each of Newton's
iterations. Within a step the powers are a constant vector of Exudyn's object, so a load that depends on a work sees
its extrapolation, which is of second order.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.any_pair import losses_on_any, parameters_of, tables_of
from exudyn_models.forces.axial_pairs import RowLaw
from exudyn_models.forces.jit import TABLE, TABLES, entry_point
from exudyn_models.solver.contacts import Contact
from exudyn_models.solver.items import CURRENT, at_assembly, items
from exudyn_models.solver.solver_run import after_every_step, quiet
from reference_model.systems import FloatArray

_WORKS = "works of powers"

Power = Callable[[Any, float], float]
"""Function of ``mbs`` and time (s) that returns a power in W of the current motion."""


class _Powers:
    """Distinct powers of a model until its next assembly, and their copies in ``units`` W.

    The slips of contacts and couplings of rotors are one product of matrices. Their moments are kept until a mode
    changes, unless they vary within a mode. One compiled call evaluates all other regularised contacts.
    """

    def __init__(self, mbs: Any, powers: Sequence[Power], units: Sequence[float]) -> None:
        self._mbs, self._data = mbs, mbs.systemData
        sources = {power: getattr(getattr(power, "__self__", None), "dissipation", None) for power in powers}
        known = [(power, *source) for power, source in sources.items() if source is not None]
        rows = [(power, law, places) for power, law, places in known if isinstance(law, RowLaw)]
        slips = [(power, one, places) for power, one, places in known if isinstance(one, Contact)]
        slips = slips if len(slips) > 1 else []  # one contact alone is faster without the compiled call
        together = [power for power, *_ in (*rows, *slips)]
        self._others = [power for power in sources if power not in together]
        distinct = together + self._others
        self.which, self.units = np.array([distinct.index(power) for power in powers]), np.array(units)
        self.copies = list(zip(self.which.tolist(), units, strict=True))
        self._laws: list[RowLaw] = [law for _, law, _ in rows]
        self._weights = np.zeros((len(rows), self._data.ODE2Size()))
        for weights, (_, law, places) in zip(self._weights, rows, strict=True):
            weights[places] = law.weights
        self._twists = np.array([law.twist(0.0 * law.weights) for law in self._laws])
        self._modes, self._varying, self._moments = list[Any](), list[int](), np.empty(0)
        self._factors = [contact.factors for _, contact, _ in slips]
        # Compiled when first needed.
        self._losses_on_any = entry_point(losses_on_any, TABLES, TABLE, TABLE) if slips else None
        parameters = [parameters_of(one.factors.geometry, one.kinds, one.reference) for _, one, _ in slips]
        self._tables = tables_of(parameters, [places for *_, places in slips])

    def at(self, t: float) -> list[float]:
        """Return the distinct powers in W at the current state and the time t (s)."""
        found: list[float] = self._of_rows(t) if self._laws else []
        if self._losses_on_any is not None:
            data = self._data
            state = data.GetODE2Coordinates(CURRENT, False), data.GetODE2Coordinates_t(CURRENT, False)
            losses = self._losses_on_any(self._tables, *state).tolist()
            for factors, (loss, radius, speed, spin) in zip(self._factors, losses, strict=True):
                found.append(loss * factors.friction_force(t, radius, speed, spin))
        for power in self._others:
            found.append(power(self._mbs, t))
        return found

    def _of_rows(self, t: float) -> list[float]:
        modes = [law.mode for law in self._laws]
        if modes != self._modes:
            varies = [law.constant_forces is None for law in self._laws]
            self._moments = np.array(
                [0.0 if vary else -law.moment(0.0, 0.0) for vary, law in zip(varies, self._laws, strict=True)]
            )
            self._modes, self._varying = modes, np.flatnonzero(varies).tolist()
        slips = self._weights.dot(self._data.GetODE2Coordinates_t(CURRENT, False))
        found: list[float] = (self._moments * slips).tolist()
        if self._varying:
            twists = self._twists + self._weights.dot(self._data.GetODE2Coordinates(CURRENT, False))
            for i in self._varying:
                found[i] = self._laws[i].lost_power(t, float(twists[i]), float(slips[i]))
        return found


class Works:
    """Integrals of the powers of a model, in ``units`` J; one ``item`` adds them to the coordinates of its nodes."""

    def __init__(self, mbs: Any) -> None:
        self._mbs, self._data, self._powers = mbs, mbs.systemData, list[Power]()
        self.names, self.units = list[str](), list[float]()
        self.item, self.running = -1, False
        self._evaluated: _Powers | None = None
        at_assembly(mbs, self.forget)

    def forget(self) -> None:
        """Evaluate the places of coordinates and the moments again."""
        self._evaluated = None

    def add(self, powers: Mapping[str, Power], unit: float) -> Any:
        """Add powers in W before assembly; return the ``NodeIndex`` of the coordinates of their works."""
        mbs, start = self._mbs, [0.0] * len(powers)
        self.names += powers
        self._powers += powers.values()
        self.units += [unit] * len(powers)
        node = mbs.AddNode(
            items.NodeGenericODE1(
                referenceCoordinates=start, initialCoordinates=start, numberOfODE1Coordinates=len(start)
            )
        )
        if self.item < 0:
            self.item = int(
                mbs.AddObject(
                    items.ObjectGenericODE1(name=_WORKS, nodeNumbers=[node], rhsUserFunction=self.rates)
                )
            )
        else:
            nodes = mbs.GetObjectParameter(self.item, "nodeNumbers")
            mbs.SetObjectParameter(self.item, "nodeNumbers", [*nodes, node])
        return node

    @property
    def places(self) -> NDArray[np.int64]:
        """Places of the works among the first-order coordinates."""
        return np.array(self._data.GetObjectLTGODE1(self.item))

    def evaluate(self) -> _Powers:
        """Prepare the evaluation of the powers until the next assembly."""
        self._evaluated = _Powers(self._mbs, self._powers, self.units)
        return self._evaluated

    def rates(self, mbs: Any, t: float, item: int, works: Any) -> list[float]:
        """Return the powers (user function of the object, except in implicit runs of ``solve_dynamic``)."""
        evaluated = self._evaluated or self.evaluate()
        powers = evaluated.at(t)
        return [powers[i] / unit for i, unit in evaluated.copies]

    def hold(self, t: float) -> FloatArray:
        """Return the powers, and let Exudyn integrate them until the next call."""
        evaluated = self._evaluated or self.evaluate()
        powers: FloatArray = np.array(evaluated.at(t))[evaluated.which] / evaluated.units
        self._mbs.SetObjectParameter(self.item, "rhsVector", powers)
        return powers

    @contextmanager
    def at_step_ends(self) -> Iterator[None]:
        """Integrate by the trapezoidal rule after every step of an implicit run."""
        mbs, data, places, start = self._mbs, self._data, self.places, exu.ConfigurationType.StartOfStep

        def add_step(mbs: Any, t: float) -> bool:
            step = t - data.GetTime(start)
            if step > 0.0:
                powers = self.hold(t)
                both = data.GetODE1Coordinates_t(start, False)[places] + powers
                works = data.GetODE1Coordinates(start, False)[places] + step / 2.0 * both
                data.GetODE1Coordinates(CURRENT, False)[places] = works  # in Exudyn's own memory
                data.GetODE1Coordinates_t(CURRENT, False)[places] = powers
            return True

        self.forget()
        self.running = True
        mbs.SetObjectParameter(self.item, "rhsUserFunction", 0)
        try:
            with after_every_step(mbs, add_step):
                yield
        finally:
            self.running = False
            mbs.SetObjectParameter(self.item, "rhsUserFunction", self.rates)
            mbs.SetObjectParameter(self.item, "rhsVector", [])


def add_works(mbs: Any, powers: Mapping[str, Power], unit: float = 1.0) -> Any:
    """Add the integrals of powers to a model; return the ``NodeIndex`` of their coordinates, in ``unit`` J."""
    works = works_of(mbs)
    if works is None:
        works = mbs.sys[_WORKS] = Works(mbs)
    return works.add(powers, unit)


def works_of(mbs: Any) -> Works | None:
    """Return the works of a model, None without."""
    works: Works | None = mbs.sys.get(_WORKS)
    if works is None:
        return None
    with quiet():
        works.item = int(mbs.GetObjectNumber(_WORKS))
    return works if works.item >= 0 else None


def running_works(mbs: Any) -> Works | None:
    """Return the works of a model in an implicit run of ``solve_dynamic``, None without."""
    works: Works | None = mbs.sys.get(_WORKS)
    return works if works is not None and works.running else None
