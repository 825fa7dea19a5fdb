"""Modes of all contacts on axes at one time, their constraints, and the margins of these modes."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import exudyn as exu
import numpy as np
from scipy.sparse.csgraph import connected_components

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.stick.complementarity import (
    DEPENDENT,
    SharedLoad,
    independent_rows,
    rest_or_slip,
)
from exudyn_models.solver.stick.dynamics import Dynamics, mobilities
from exudyn_models.solver.stick.sticking_contacts import STILL, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

SETTLED = 1e-10
"""Largest relative change of settled forces."""

ITERATIONS = 200
"""Largest number of iterations for loads that depend on constraint forces."""

SHRUNK = 1e-6
"""Relative reduction of the capacities of contacts that cannot hold their load any more, so some release."""

REST = 1e-9
"""Share of a step within which a contact that counts as resting stops."""

NOISE = 1e-9
"""Rounding error of slips and their rates, relative to the terms in their sum."""

NEAR = 0.02
"""Unused share of capacity below which loads are computed again, because those of Exudyn's steps contain errors."""


class _Slips:
    """Slips of contacts on axes as functions of the velocities, at the state of ``dynamics``.

    ``to_rates``, shape (k, k), relates their accelerations to the moments of all contacts, and ``prescribed``, shape
    (k,), is True if no moment changes a slip.
    """

    def __init__(self, mbs: Any, dynamics: Dynamics, contacts: Sequence[StickingContact]) -> None:
        self._data, self._dynamics = mbs.systemData, dynamics
        size = self._data.ODE2Size()
        self.rows = np.vstack([contact.rows(mbs) for contact in contacts])
        self._bias = np.concatenate([contact.bias(mbs) for contact in contacts])
        self._to_velocities = dynamics.inverse[:size, :size] @ self.rows.T
        self.to_rates = self.rows @ self._to_velocities
        lengths = self.rows**2 @ mobilities(dynamics.mass)
        self.prescribed = np.diag(self.to_rates) <= DEPENDENT * lengths
        self.to_rates[self.prescribed] = self.to_rates[:, self.prescribed] = 0.0

    def now(self) -> FloatArray:
        """Return the slips in rad/s."""
        return np.asarray(self.rows @ self._data.GetODE2Coordinates_t())

    def still(self, step: float, accelerations: FloatArray, moments: FloatArray) -> FloatArray:
        """Return the slips that a ``step`` (s) may stop, or that are rounding errors."""
        rates = np.abs(self.rates(accelerations)) + np.abs(self.to_rates) @ moments
        rounding = NOISE * np.abs(self.rows) @ np.abs(self._data.GetODE2Coordinates_t())
        return np.asarray(np.maximum(REST * step * rates + rounding, STILL * self.prescribed))

    def rates(self, accelerations: FloatArray) -> FloatArray:
        """Return the slip accelerations in rad/s²."""
        return np.asarray(self.rows @ accelerations + self._bias)

    def noise(self, accelerations: FloatArray) -> FloatArray:
        """Return the rounding errors of slip accelerations, which contain a difference over time."""
        speeds = np.abs(self._data.GetODE2Coordinates_t()) * (1e-5 / self._dynamics.difference)
        return np.asarray(NOISE * np.abs(self.rows) @ (np.abs(accelerations) + speeds))

    def hold(self, locked: Sequence[int], forces: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the moments that hold contacts under generalised ``forces``, accelerations and constraint forces."""
        accelerations, constraints = self._dynamics.solution(forces)
        if not locked:
            return np.empty(0), accelerations, constraints
        moments = np.linalg.solve(self.to_rates[np.ix_(locked, locked)], -self.rates(accelerations)[locked])
        return np.asarray(moments, float), *self._dynamics.solution(forces + moments @ self.rows[locked])

    def stop(self, locked: Sequence[int]) -> None:
        """Remove the slip of contacts, with the smallest kinetic energy."""
        slips = self.now()[locked]
        if not slips.any():
            return
        impulses = np.linalg.solve(self.to_rates[np.ix_(locked, locked)], -slips)
        velocities = self._data.GetODE2Coordinates_t() + self._to_velocities[:, locked] @ impulses
        for configuration in (CURRENT, exu.ConfigurationType.Initial):
            self._data.SetODE2Coordinates_t(velocities, configuration)


@dataclass(eq=False)
class _Group:
    """Contacts at rest that share a load; the first of them are constraints with forces at ``places``."""

    mbs: Any
    contacts: list[StickingContact]
    places: list[int]
    load: SharedLoad

    def moments(self, t: float) -> tuple[FloatArray, float]:
        """Return the moment of each contact at the time t (s) and the largest share of a capacity."""
        held = -self.mbs.systemData.GetAECoordinates()[self.places]
        return self.load.distribution(held, np.array([contact.capacities(t) for contact in self.contacts]))

    def moment_of(self, i: int) -> float:
        """Return the present moment of a contact in N m."""
        return float(self.moments(self.mbs.systemData.GetTime(CURRENT))[0][i])


class RestingAxes:
    """Contacts on axes in an assembled model; the loads of ``every`` contact may depend on constraint forces."""

    def __init__(
        self,
        mbs: Any,
        dynamics: Dynamics,
        contacts: Sequence[StickingContact],
        every: Sequence[StickingContact],
        step: float,
    ) -> None:
        self._mbs, self._dynamics, self._contacts, self._every = mbs, dynamics, contacts, every
        self._step, self._data = step, mbs.systemData
        self._places = [int(self._data.GetObjectLTGAE(contact.stick.locks[0])[0]) for contact in contacts]
        self._ended, self._overloaded = set[StickingContact](), set[StickingContact]()
        self._slipped = set[StickingContact]()
        self._locked: list[int] = []
        self._alone: list[int] = []
        self._groups: list[_Group] = []

    def end(self, ended: Iterable[StickingContact]) -> None:
        """Note contacts whose slip vanishes, or whose load reaches their capacity, until they have settled."""
        self._ended = {contact for contact in ended if contact.mode != Mode.OPEN}
        for group in self._groups:
            if self._ended.intersection(group.contacts):
                self._ended.update(group.contacts)
        self._overloaded = {contact for contact in self._ended if contact.mode == Mode.LOCKED}
        self._slipped = set()

    def accelerate(self, t: float) -> None:
        """Store the accelerations and constraint forces of the present modes at the initial values."""
        self._load()
        self._dynamics.evaluate(t)
        self._iterate(t, self._present)

    def _present(self) -> tuple[FloatArray, FloatArray]:
        """Return accelerations and constraint forces of the present modes."""
        return self._dynamics.solution(self._dynamics.forces())

    def settle(self, t: float) -> None:
        """Choose the modes, and store accelerations and constraint forces.

        Until ``end``, contacts that have begun to slip have sliding friction, even if others change their modes.
        """
        if not self._contacts:
            self.accelerate(t)
            return
        self._load()
        for contact in self._contacts:
            contact.stick.shared = None
            contact.enter(self._mbs, contact.mode, lock=False)
        self._dynamics.evaluate(t)
        slips = _Slips(self._mbs, self._dynamics, self._contacts)
        now, capacities = slips.now(), np.array([contact.holding(t) for contact in self._contacts])
        accelerations, _ = self._present()
        still = np.abs(now) <= slips.still(self._step, accelerations, capacities)
        modes = [
            Mode.LOCKED if at_rest or contact in self._ended else Mode(int(np.sign(slip)))
            for contact, at_rest, slip in zip(self._contacts, still, now, strict=True)
        ]
        before = self._locked
        self._iterate(t, lambda: self._choose(t, slips, modes, before))
        self._slipped.update(
            contact
            for contact, mode in zip(self._contacts, modes, strict=True)
            if mode == Mode.LOCKED and contact.stick.slides
        )
        for i in self._locked:
            self._contacts[i].enter(self._mbs, Mode.LOCKED)
        slips.stop(self._locked)

    def _load(self) -> None:
        self._data.SetSystemState(self._data.GetSystemState(exu.ConfigurationType.Initial), CURRENT)

    def _iterate(
        self,
        t: float,
        solve: Callable[[], tuple[FloatArray, FloatArray]],
        configurations: Sequence[Any] = (CURRENT, exu.ConfigurationType.Initial),
    ) -> None:
        """Solve until loads agree with the constraint forces that they may depend on, and store the solution."""
        before: Any = np.inf
        for _ in range(ITERATIONS):
            self._dynamics.store(*solve(), configurations)
            now = np.concatenate((self._dynamics.forces(), [contact.holding(t) for contact in self._every]))
            if np.abs(now - before).max() <= SETTLED * np.abs(now).max():
                return
            before = now
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {t:.9g} s: loads that depend "
            "on constraint forces do not settle"
        )

    def _choose(
        self, t: float, slips: _Slips, modes: Sequence[Mode], before: Sequence[int]
    ) -> tuple[FloatArray, FloatArray]:
        """Enter the modes under the present loads; return accelerations and constraint forces."""
        mbs, contacts = self._mbs, self._contacts
        for contact, mode in zip(contacts, modes, strict=True):
            contact.enter(mbs, Mode.OPEN if contact.holding(t) == 0.0 else mode, lock=False)
        still = [i for i, contact in enumerate(contacts) if contact.mode == Mode.LOCKED]
        static = np.array([contacts[i].capacities(t) for i in still]).reshape(-1, 2)
        ratios = np.array([[contacts[i].stick.static_ratio] for i in still]).reshape(-1, 1)
        overloads = np.array([contacts[i] in self._overloaded for i in still])
        shrunk = (SHRUNK * overloads * static.max(axis=1, initial=0.0))[:, None]
        sliding = np.minimum(static - shrunk, static / ratios)
        slipped = np.array([contacts[i] in self._slipped for i in still], dtype=bool)[:, None]
        accelerations, _ = self._present()
        directions = rest_or_slip(
            slips.to_rates[np.ix_(still, still)],
            slips.rates(accelerations)[still],
            slips.noise(accelerations)[still],
            np.where(slipped, sliding, static - shrunk),
            sliding,
        )
        for i, direction in zip(still, directions, strict=True):
            if direction != 0.0:
                contacts[i].enter(mbs, Mode(int(direction)))
        self._group(slips, [i for i in still if contacts[i].mode == Mode.LOCKED], before)
        moments, accelerations, constraints = slips.hold(self._locked, self._dynamics.forces())
        constraints[[self._places[i] for i in self._locked]] = -moments
        return accelerations, constraints

    def _group(self, slips: _Slips, resting: Sequence[int], before: Sequence[int]) -> None:
        """Choose the contacts that become constraints, and find those that share their loads."""
        chosen, by_chosen = independent_rows(
            slips.to_rates[np.ix_(resting, resting)], [resting.index(i) for i in before if i in resting]
        )
        self._locked = [resting[i] for i in chosen]
        others = [i for i in resting if i not in self._locked]
        links = np.zeros((len(resting), len(resting)))
        links[len(chosen) :, : len(chosen)] = by_chosen
        members, self._groups, self._alone = np.array(self._locked + others, int), list[_Group](), list[int]()
        count, of_group = connected_components(links, directed=False) if resting else (0, [])
        for number in range(count):
            own = np.flatnonzero(of_group == number)
            first, rest = own[own < len(chosen)], own[own >= len(chosen)] - len(chosen)
            if not len(rest):
                self._alone += members[own].tolist()
                continue
            group = _Group(
                self._mbs,
                [self._contacts[i] for i in members[own]],
                [self._places[i] for i in members[first]],
                SharedLoad(by_chosen[np.ix_(rest, first)]),
            )
            self._groups.append(group)
            for i, contact in enumerate(group.contacts):
                contact.stick.shared = partial(group.moment_of, i)

    def margins(self, t: float) -> dict[StickingContact, float]:
        """Return numbers that fall below zero when the present modes end.

        They are the slip in the direction of sliding (rad/s), the unused share of the capacity of contacts at rest,
        or ±1 without load or coefficient.
        """
        margins = {contact: contact.margin(self._mbs, t) for contact in self._contacts}
        left = self._left(t)
        if min(left.values(), default=1.0) < NEAR:
            before = self._data.GetAECoordinates(), self._data.GetODE2Coordinates_tt()
            self._dynamics.evaluate(t)
            self._iterate(t, self._present, (CURRENT,))
            left = self._left(t)
            self._data.SetAECoordinates(before[0])
            self._data.SetODE2Coordinates_tt(before[1])
        return {contact: min(margin, left.get(contact, margin)) for contact, margin in margins.items()}

    def _left(self, t: float) -> dict[StickingContact, float]:
        """Return the unused shares of the capacities of contacts at rest; that of a one-way clutch is continuous."""
        alone = [self._contacts[i] for i in self._alone]
        limits = np.array([contact.capacities(t) for contact in alone]).reshape(-1, 2)
        held = -self._data.GetAECoordinates()[[self._places[i] for i in self._alone]]
        shares = np.minimum(limits[:, 1] - held, limits[:, 0] + held) / limits.max(axis=1, initial=0.0)
        left = dict(zip(alone, shares.tolist(), strict=True))
        for group in self._groups:
            share = max(1.0 - group.moments(t)[1], -1.0)
            for contact in group.contacts:
                left[contact] = share if group.places else 1.0 - abs(contact.slip(self._mbs)) / STILL
        return left
