"""Modes that let all contacts of a model obey Coulomb's law at one time of a run, and the margins of these modes.

All contacts solve one problem together (``complementarity``).
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.active_set import LoadedRows
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw, OneWayLaw
from exudyn_models.solver.rows.moment_loads import Loads
from exudyn_models.solver.stick.complementarity import independent_rows, rest_or_slip
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.first_slips import FirstSlips
from exudyn_models.solver.stick.resting import NEAR, Line, Resting
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slips import Slips
from exudyn_models.solver.stick.sticking_contacts import LEAST, PlanarContact, SpringFlanks, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

SETTLED = 1e-10
"""Relative change of the forces below which they count as settled."""

ITERATIONS = 200
"""Largest number of iterations for loads that depend on constraint forces."""

SHRUNK = 1e-6
"""Relative reduction of the capacities of contacts that cannot hold their load any more, so some release."""

AHEAD = 1e-5
"""Share of a step to look ahead for the flank of a spring that is pressed."""

MOST_CHANGES = 100
"""Largest number of changes of mode at one time."""


class ModeChoice:
    """Choice of the modes of contacts in an assembled model at its initial values, before steps of ``step`` (s)."""

    def __init__(
        self,
        mbs: Any,
        t: float,
        contacts: Sequence[StickingContact],
        slides: SlidingSteps,
        step: float,
    ) -> None:
        self._springs = [contact for contact in contacts if isinstance(contact, SpringFlanks)]
        contacts = contacts[: len(contacts) - len(self._springs)]
        self._mbs, self._data, self._contacts, self._slides = mbs, mbs.systemData, contacts, slides
        self._step, self._dynamics, self._resting = step, Dynamics(mbs, t, step), Resting(mbs)
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._at_meshes = [i for i, one in enumerate(contacts) if isinstance(one.stick, MeshLaw)]
        self._one_way = [i for i, one in enumerate(contacts) if isinstance(one.stick, OneWayLaw)]
        self._growing = [i for i, one in enumerate(contacts) if isinstance(one.stick, GrowingLimit)]
        self._ratios = np.array([one.stick.static_ratio for one in contacts])[:, None]
        self._loads = Loads(mbs, [one.stick for one in contacts])
        self._meshes = self._loads.meshes
        places = [contact.force_places(self._data) for contact in contacts]
        self._places = np.hstack([np.empty((2, 0), dtype=int), *places])
        self._locks = np.unique(self._places)
        self._ended, self._overloaded = set[StickingContact](), set[StickingContact]()
        self._slipped, self._held = set[StickingContact](), set[int]()
        self.first_slips = FirstSlips(mbs, self._dynamics, slides, step)
        self._line: Line | None = None
        self._dynamics.evaluate(t, self._locks)
        self._slips = Slips(mbs, self._dynamics, contacts)
        self._holding, self._limits = np.zeros(len(contacts)), np.zeros((len(contacts), 2))
        for i, contact in enumerate(contacts):
            self._holding[i], self._limits[i] = contact.strength(t)
        self._varying = [i for i, contact in enumerate(contacts) if contact.stick.constant_forces is None]

    def begin(self, t: float) -> None:
        """Let velocities satisfy all joints and one-way clutches, by an impact without friction."""
        self._data.SetAECoordinates(self._data.GetAECoordinates(exu.ConfigurationType.Initial))
        self._dynamics.evaluate(t)
        change = self._dynamics.violation()
        if change.any():
            self._data.SetODE2Coordinates_t(self._data.GetODE2Coordinates_t() + change)
        if self._one_way:
            self._dynamics.evaluate(t, self._locks)
            Slips(self._mbs, self._dynamics, [self._contacts[i] for i in self._one_way]).collide()

    @property
    def solver(self) -> Any:
        """Initialised solver that evaluates the model."""
        return self._dynamics.solver

    @property
    def groups(self) -> list[list[StickingContact]]:
        """Contacts at rest that share a load."""
        return [group.contacts for group in self._resting.groups]

    def end(self, ended: Iterable[StickingContact]) -> None:
        """Note contacts whose slip vanishes, or whose load reaches their capacity, until they have settled."""
        self._ended = self._resting.share(
            [one for one in ended if one.mode != Mode.OPEN and not isinstance(one, SpringFlanks)]
        )
        self._overloaded = {contact for contact in self._ended if contact.mode == Mode.LOCKED}
        self._slipped = set()

    def settle(self, t: float) -> None:
        """Choose the modes, and store accelerations and constraint forces.

        Until ``end``, contacts that have begun to slip have sliding friction, even if others change their modes.
        """
        for spring in self._springs:
            spring.choose(self._mbs, AHEAD * self._step)
        for contact in self._contacts:
            if contact.stick.entered is not contact.stick.mode:
                contact.enter(self._mbs, contact.mode)
        for contact in self._planar:
            contact.motion(self._mbs)
        slips = self._slips_at(t)
        if self._planar:
            slips.allow()
        for i in self._varying:
            self._holding[i], self._limits[i] = self._contacts[i].strength(t)
        bounds = slips.bounds(self._dynamics.solution(self._dynamics.forces())[0], self._holding)
        still = slips.sets.sizes(slips.now) <= slips.still(self._step, bounds)
        for i in self._one_way:
            still[i] |= slips.now[slips.firsts[i]] < 0.0
        modes = [
            Mode.LOCKED if at_rest or contact in self._ended else contact.sliding_mode(slips.now[rows])
            for contact, at_rest, rows in zip(self._contacts, still.tolist(), slips.sets.blocks, strict=True)
        ]
        self._iterate(t, lambda: self._choose(t, slips, modes, bounds))
        self._slipped.update(
            contact
            for contact, mode in zip(self._contacts, modes, strict=True)
            if mode is Mode.LOCKED and contact.stick.mode is not mode and contact.stick.slides
        )
        self._lock(slips)
        self._rows = slips.rows[slips.firsts]
        self._directions = np.array(
            [int(one.mode) if one.stick.slides else 0 for one in self._contacts], float
        )
        self._offsets = 1.0 - np.abs(self._directions)
        simple = not (self._varying or self._springs or self._resting.groups)
        self._line = (
            Line(self._rows, self._directions, self._resting, self._limits, self._data) if simple else None
        )
        self.survey(t)
        self._slides.survey()
        self.end(())

    def _lock(self, slips: Slips) -> None:
        """Let constraints hold the rows of contacts at rest."""
        before, self._held = self._held, set(self._resting.rows)
        owner = slips.sets.owner
        for i in {int(owner[row]) for row in before ^ self._held}:
            own = enumerate(slips.rows_of([i]))
            self._contacts[i].lock(self._mbs, [k for k, row in own if row in self._held])

    def survey(self, t: float) -> None:
        """Find the slips that joints and locks allow at sliding contacts in the plane."""
        if sliding := [contact for contact in self._planar if contact.stick.slides]:
            self._dynamics.evaluate(t)
            Slips(self._mbs, self._dynamics, sliding).allow()

    def _slips_at(self, t: float) -> Slips:
        """Return the slips at the present state and the time t (s), without locks."""
        self._dynamics.evaluate(t, self._locks)
        self._slips = self._slips.at_present()
        return self._slips

    def _present(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return generalised forces, accelerations and constraint forces of the present modes."""
        forces, resting = self._dynamics.forces(), self._resting
        held, accelerations, constraints = self._slips.hold(resting.rows, resting.to_forces, forces)
        constraints[resting.places] = -held
        return forces, accelerations, constraints

    def _iterate(self, t: float, solve: Callable[[], tuple[FloatArray, FloatArray, FloatArray]]) -> None:
        """Solve until loads agree with accelerations and constraint forces, and store these."""
        for _ in range(ITERATIONS):
            seen = self._data.GetODE2Coordinates_tt(), self._data.GetAECoordinates(), self._holding.copy()
            forces, accelerations, constraints = solve()
            if _settled(seen[0], accelerations) and _settled(seen[1], constraints):
                return
            self._dynamics.store(accelerations, constraints)
            for i in self._varying:
                self._holding[i] = self._contacts[i].strength(t)[0]
            if _settled(forces, self._dynamics.forces()) and _settled(seen[2], self._holding):
                return
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {t:.9g} s: loads that depend "
            "on constraint forces do not settle"
        )

    def _choose(
        self, t: float, slips: Slips, modes: Sequence[Mode], bounds: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Enter the modes under the present loads; return these, accelerations and constraint forces."""
        contacts, blocks = self._contacts, slips.sets.blocks
        for contact, mode, holding in zip(contacts, modes, self._holding.tolist(), strict=True):
            mode = Mode.OPEN if holding == 0.0 else mode
            if contact.stick.mode is not mode:
                contact.enter(self._mbs, mode)
        still = [i for i, contact in enumerate(contacts) if contact.stick.mode is Mode.LOCKED]
        self._loads.act(False)
        accelerations, constraints = self._dynamics.solution(self._dynamics.forces())
        self._loads.act(True)
        found = self._slips_that_begin(t, slips, still, accelerations, constraints)
        wanted, resting, begun = dict[int, float](), list[int](), list[int]()
        moves = slips.sets.sizes(found)
        for i in still:
            contact, first = contacts[i], slips.firsts[i]
            if moves[i] == 0.0:
                resting.append(i)
                continue
            if isinstance(contact, PlanarContact):
                slip = found[blocks[i]]
                contact.planar.direction = np.zeros(3)
                contact.planar.direction[: len(slip)] = slip / contact.planar.scales / moves[i]
                begun.append(i)
            elif found[first] * slips.now[first] < 0.0:  # a rounding error
                wanted[first] = 0.0
            contact.enter(self._mbs, contact.sliding_mode(found[blocks[i]]))
        wanted |= self.first_slips.of(begun, slips, found, bounds)
        self._resting.divide(
            contacts, slips, resting, self._places, self._resting.rows, self._to_loads(slips)
        )
        self._give(slips, wanted)
        self._find_effects_of_meshes(slips)
        return self._present()

    def _give(self, slips: Slips, wanted: dict[int, float]) -> None:
        """Stop the slips of rows at rest, and give other rows the slips ``wanted`` unless these conflict."""
        rows, to_forces = self._resting.rows, self._resting.to_forces
        if wanted:
            held, rows = rows, [*rows, *wanted]
            chosen, to_forces, _ = independent_rows(slips.among(rows), range(len(held)))
            rows = [rows[i] for i in chosen]
        slips.give(rows, to_forces, np.array([wanted.get(row, 0.0) for row in rows]))

    def _to_loads(self, slips: Slips) -> FloatArray:
        """Return the moments that let limits grow, by unit forces along all locks, shape (m, k)."""
        if not self._growing:
            return np.zeros((0, len(slips.rows)))
        return self._loads.by_forces(slips.to_loads, slips.firsts)

    def _find_effects_of_meshes(self, slips: Slips) -> None:
        """Find how friction of meshes changes their moments while the present locks hold."""
        if not self._at_meshes:
            return
        own = [slips.firsts[i] for i in self._at_meshes]
        held, to_loads = self._resting.rows, slips.to_loads(self._meshes.places)
        holding = -self._resting.to_forces @ slips.to_rates[np.ix_(held, own)]
        self._meshes.by_friction = to_loads[:, own] + to_loads[:, held] @ holding

    def _loaded(
        self,
        slips: Slips,
        contacts: Sequence[int],
        rows: Sequence[int],
        constraints: FloatArray,
        sliding: FloatArray,
    ) -> LoadedRows | None:
        if not (self._growing or self._one_way):
            return None
        laws = [self._contacts[i].stick for i in contacts]
        to_loads = self._to_loads(slips)[:, rows]
        return LoadedRows(
            self._loads.without(to_loads, constraints),
            to_loads,
            [law if isinstance(law, GrowingLimit) else None for law in laws],
            np.array([int(self._contacts[i].mode) for i in contacts], dtype=int),
            sliding,
        )

    def _slips_that_begin(
        self,
        t: float,
        slips: Slips,
        still: Sequence[int],
        accelerations: FloatArray,
        constraints: FloatArray,
    ) -> FloatArray:
        """Return the slip accelerations of the contacts ``still``; all others are arbitrary."""
        still = [*still, *(i for i in self._growing if i not in still)]
        contacts, rows = [self._contacts[i] for i in still], slips.rows_of(still)
        for i in self._varying:
            self._limits[i] = self._contacts[i].strength(t)[1]
        static, ratios = self._limits[still], self._ratios[still]
        loaded = self._loaded(slips, still, rows, constraints, static / ratios)
        shrunk = SHRUNK * static.max(axis=1, initial=0.0)[:, None]
        if loaded is not None:
            growing = [i in self._growing for i in still]
            shrunk = np.where(np.array(growing, dtype=bool)[:, None], SHRUNK * static, shrunk)
            static[[i in self._one_way for i in still]] = 0.0, math.inf
            shrunk = np.where(np.isfinite(static), shrunk, 0.0)
        capacities = static - np.array([one in self._overloaded for one in contacts])[:, None] * shrunk
        sliding = np.minimum(capacities, static / ratios)
        slipped = np.array([one in self._slipped or one.stick.slides for one in contacts], dtype=bool)
        found = np.zeros(len(slips.rows))
        found[rows] = rest_or_slip(
            slips.among(rows),
            slips.rates(accelerations)[rows],
            slips.noise(accelerations)[rows],
            slips.sets.only(still, loaded),
            np.where(slipped[:, None], sliding, capacities),
            sliding,
        )
        return found

    def hold(self, t: float) -> bool:
        """Return whether all modes clearly go on at the present state; if False, ``margins`` decides."""
        if self._line is not None:
            return self._line.holds()
        if self._springs or len(self._planar) < len(self._contacts):
            return False
        enough = 1.0 - NEAR
        return all(contact.goes_on(self._mbs, t) for contact in self._planar) and all(
            group.forces(t, enough)[1] < enough for group in self._resting.groups
        )

    def margins(self, t: float) -> FloatArray:
        """Return numbers that fall below zero when the present modes end, shape (contacts + springs,).

        They are the slip in the direction of sliding (m/s or rad/s), or the unused share of the capacity of contacts
        at rest. They change their sign where friction vanishes or begins.
        """
        margins = self._margins_of_contacts(t)
        return (
            np.append(margins, [one.margin(self._mbs) for one in self._springs]) if self._springs else margins
        )

    def _margins_of_contacts(self, t: float) -> FloatArray:
        slips = self._rows @ self._data.GetODE2Coordinates_t(CURRENT, False)
        margins: FloatArray = self._offsets + self._directions * slips
        changed = []
        for i in self._varying:
            contact = self._contacts[i]
            if not len(contact.stick.weights):  # the gradient of the slip turns
                margins[i] = contact.margin(self._mbs)
            holding, self._limits[i] = contact.strength(t)
            if (holding == 0.0) != (contact.mode == Mode.OPEN):
                changed.append(i)
        if self._resting.rows:
            margins = np.minimum(margins, np.maximum(self._checked_left(t), -1.0))  # finite without friction
        # The margin keeps its size, so interpolation halves the interval that contains the jump.
        if changed:
            margins[changed] = -np.maximum(np.abs(margins[changed]), LEAST)
        return margins

    def _checked_left(self, t: float) -> FloatArray:
        """Return ``_left``, by new loads if one is nearly overloaded."""
        left = self._left(t)
        least = left.min()
        if least < NEAR:
            before = self._data.GetAECoordinates(), self._data.GetODE2Coordinates_tt()
            self._slips_at(t)
            self._iterate(t, self._present)
            change = self._data.GetAECoordinates() - before[0]
            if change.any():
                left = self._left(t)
            if least < -1.0 and left.min() > 0.0 and np.abs(change).max() > SETTLED * self._limits.max():
                raise SimulationError(
                    f"a locked contact held {1.0 - least:.3g} times its capacity in a step, but not at its end t = "
                    f"{t:.9g} s: a speed that a constraint prescribes jumps there; pass this time in breaks"
                )
            self._data.SetAECoordinates(before[0])
            self._data.SetODE2Coordinates_tt(before[1])
        return left

    def _left(self, t: float) -> FloatArray:
        """Return the unused shares of capacities, 1 in slip; for a one-way clutch this share is continuous."""
        left = np.ones(len(self._contacts))
        resting = self._resting
        if resting.alone:
            limits = self._limits[resting.alone]
            held = self._data.GetAECoordinates()[resting.alone_places]
            unused = np.minimum(limits[:, 1] + held, limits[:, 0] - held)
            left[resting.alone] = unused / np.maximum(limits[:, 0], limits[:, 1])
        for group in resting.groups:
            share = 1.0 - group.forces(t, 1.0 - NEAR)[1]
            for contact in group.contacts:
                left[self._contacts.index(contact)] = share
        return left


def _settled(before: FloatArray, now: FloatArray) -> bool:
    """Return whether values agree, apart from rounding errors."""
    return float(np.abs(now - before).max(initial=0.0)) <= SETTLED * float(np.abs(now).max(initial=0.0))
