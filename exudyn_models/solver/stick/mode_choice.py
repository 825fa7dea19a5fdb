"""Modes that let all contacts of a model obey Coulomb's law at one time of a run, and the margins of these modes.

All contacts solve one problem together (``complementarity``). A contact in the plane begins to slide with a slip that
its acceleration reaches within a millionth of a step, or that Newton's method can resolve. ``take_back`` removes this
slip when the contact slides faster.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import exudyn as exu
import numpy as np
from scipy.sparse.csgraph import connected_components

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.active_set import LoadedRows
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw, OneWayLaw
from exudyn_models.solver.rows.moment_loads import Loads
from exudyn_models.solver.stick.complementarity import rest_or_slip
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.resting import Line, Resting
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED
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

NEAR = 0.02
"""Unused share of capacity below which loads are computed again, because the loads in Exudyn's steps contain
errors."""

AHEAD = 1e-5
"""Share of a step to look ahead for the flank of a spring that is pressed."""

GROWN = 10.0
"""Least slip for ``take_back``, relative to the first slip."""

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
        self._loads = Loads(mbs, [one.stick for one in contacts])
        self._meshes = self._loads.meshes
        locks = [lock for contact in contacts for lock in contact.stick.locks[: contact.directions]]
        self._places = np.array([int(self._data.GetObjectLTGAE(lock)[0]) for lock in locks], dtype=int)
        self._ended, self._overloaded, self._slipped = (set[StickingContact]() for _ in range(3))
        self._first_slips: dict[PlanarContact, float] = {}
        self._line: Line | None = None
        self._holding, self._limits = np.zeros(len(contacts)), np.zeros((len(contacts), 2))
        for i, contact in enumerate(contacts):
            self._holding[i], self._limits[i] = contact.strength(t)
        self._varying = [i for i, contact in enumerate(contacts) if contact.stick.constant_forces is None]

    def begin(self, t: float) -> None:
        """Let velocities satisfy all joints and one-way clutches, by an impact without friction."""
        initial = exu.ConfigurationType.Initial
        self._load()
        self._dynamics.evaluate(t)
        change = self._dynamics.violation()
        if change.any():
            self._data.SetODE2Coordinates_t(self._data.GetODE2Coordinates_t(initial) + change, initial)
        if self._one_way:
            self._load()
            self._dynamics.evaluate(t, self._places)
            Slips(self._mbs, self._dynamics, [self._contacts[i] for i in self._one_way]).collide()

    @property
    def groups(self) -> list[list[StickingContact]]:
        """Contacts at rest that share a load."""
        return [group.contacts for group in self._resting.groups]

    def take_back(self, t: float) -> None:
        """Subtract the first slips, together as they were given, once all contacts are much faster at t (s).

        Friction keeps this excess of speed in the direction of the slip, so subtract it in this direction.
        """
        self._first_slips = {one: size for one, size in self._first_slips.items() if one.free_to_slide}
        sliding, firsts = list(self._first_slips), np.array(list(self._first_slips.values()))
        sizes = np.array([one.motion(self._mbs, exu.ConfigurationType.Initial).potential for one in sliding])
        if sliding and (sizes >= GROWN * firsts).all():
            self._dynamics.evaluate(t)
            slips = Slips(self._mbs, self._dynamics, sliding)
            slips.give(dict(enumerate((1.0 - firsts / sizes)[slips.sets.owner] * slips.now)), [])
            self._first_slips.clear()
        self._slides.starts = bool(self._first_slips)

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
        self._load()
        for spring in self._springs:
            spring.choose(self._mbs, AHEAD * self._step)
        for contact in self._contacts:
            contact.enter(self._mbs, contact.mode)
        for contact in self._planar:
            contact.motion(self._mbs)
        self._dynamics.evaluate(t, self._places)
        slips = Slips(self._mbs, self._dynamics, self._contacts)
        for i in self._varying:
            self._holding[i], self._limits[i] = self._contacts[i].strength(t)
        bounds = slips.bounds(self._present()[1], self._holding)
        still = slips.sets.sizes(slips.now) <= slips.still(self._step, bounds)
        still[self._one_way] |= slips.now[[slips.sets.blocks[i].start for i in self._one_way]] < 0.0
        modes = [
            Mode.LOCKED if at_rest or contact in self._ended else contact.sliding_mode(slips.now[rows])
            for contact, at_rest, rows in zip(self._contacts, still.tolist(), slips.sets.blocks, strict=True)
        ]
        self._iterate(t, lambda: self._choose(t, slips, modes, bounds))
        held = set(self._resting.rows)
        for contact, mode, rows in zip(self._contacts, modes, slips.sets.blocks, strict=True):
            if mode == Mode.LOCKED and contact.stick.slides:
                self._slipped.add(contact)
            own = range(rows.start, rows.stop) if contact.mode == Mode.LOCKED else ()
            contact.lock(self._mbs, [i for i, row in enumerate(own) if row in held])
        self._rows = slips.rows[[rows.start for rows in slips.sets.blocks]]
        self._directions = np.array([int(one.mode) * one.stick.slides for one in self._contacts], float)
        self._offsets = 1.0 - np.abs(self._directions)
        simple = not (self._varying or self._springs or self._resting.groups)
        self._line = (
            Line(self._rows, self._directions, self._resting, self._limits, self._data) if simple else None
        )
        self.survey(t)
        self._slides.survey()
        self.end(())

    def survey(self, t: float) -> None:
        """Find the slips that joints and locks allow at sliding contacts in the plane."""
        if sliding := [contact for contact in self._planar if contact.stick.slides]:
            self._dynamics.evaluate(t)
            Slips(self._mbs, self._dynamics, sliding)

    def _load(self) -> None:
        self._data.SetSystemState(self._data.GetSystemState(exu.ConfigurationType.Initial), CURRENT)

    def _present(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return generalised forces, accelerations and constraint forces of the present modes."""
        forces = self._dynamics.forces()
        return forces, *self._dynamics.solution(forces)

    def _iterate(
        self,
        t: float,
        solve: Callable[[], tuple[FloatArray, FloatArray, FloatArray]],
        configurations: Sequence[Any] = (CURRENT, exu.ConfigurationType.Initial),
    ) -> None:
        """Solve until loads agree with the constraint forces that they may depend on, and store the solution."""
        for _ in range(ITERATIONS):
            forces, accelerations, constraints = solve()
            before = np.concatenate((forces, self._holding))
            self._dynamics.store(accelerations, constraints, configurations)
            for i in self._varying:
                self._holding[i] = self._contacts[i].strength(t)[0]
            now = np.concatenate((self._dynamics.forces(), self._holding))
            if np.abs(now - before).max() <= SETTLED * np.abs(now).max():
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
            contact.enter(self._mbs, Mode.OPEN if holding == 0.0 else mode)
        still = [i for i, contact in enumerate(contacts) if contact.mode == Mode.LOCKED]
        self._loads.act(False)
        _, accelerations, constraints = self._present()
        self._loads.act(True)
        found = self._slips_that_begin(t, slips, still, accelerations, constraints)
        wanted, first, begun = dict[int, float](), list[int](), list[int]()
        for i in still:
            contact, slip, own = contacts[i], found[blocks[i]], range(len(found))[blocks[i]]
            if not slip.any():
                wanted.update(dict.fromkeys(own, 0.0))
                first += own
            elif isinstance(contact, PlanarContact):
                contact.planar.direction = np.zeros(3)
                contact.planar.direction[: len(slip)] = (
                    slip / contact.planar.scales / slips.sets.sizes(found)[i]
                )
                begun.append(i)
            elif slip[0] * slips.now[own[0]] < 0.0:  # a rounding error
                wanted[own[0]] = 0.0
        wanted |= self._first_slips_of(begun, slips, found, bounds)
        resting = [i for i in still if not found[blocks[i]].any()]
        for i in still:
            if i not in resting:
                contacts[i].enter(self._mbs, contacts[i].sliding_mode(found[blocks[i]]))
        to_loads = self._to_loads(slips)
        self._resting.divide(contacts, slips, resting, self._places, self._resting.rows, to_loads)
        slips.give(wanted, first)
        self._find_effects_of_meshes(slips)
        forces = self._dynamics.forces()
        held, accelerations, constraints = slips.hold(self._resting.rows, forces)
        constraints[self._resting.places] = -held
        return forces, accelerations, constraints

    def _to_loads(self, slips: Slips) -> FloatArray:
        """Return the moments that let limits grow, by unit forces along all locks, shape (m, k)."""
        return self._loads.by_forces(slips.to_loads, [rows.start for rows in slips.sets.blocks])

    def _find_effects_of_meshes(self, slips: Slips) -> None:
        """Find how friction of meshes changes their moments while the present locks hold."""
        if not self._at_meshes:
            return
        own = [slips.sets.blocks[i].start for i in self._at_meshes]
        held, to_loads = self._resting.rows, slips.to_loads(self._meshes.places)
        holding = np.linalg.solve(slips.to_rates[np.ix_(held, held)], -slips.to_rates[np.ix_(held, own)])
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
        contacts = [self._contacts[i] for i in still]
        rows = [row for i in still for row in range(len(slips.rows))[slips.sets.blocks[i]]]
        for i in self._varying:
            self._limits[i] = self._contacts[i].strength(t)[1]
        static = self._limits[list(still)]
        ratios = np.array([[contact.stick.static_ratio] for contact in contacts]).reshape(-1, 1)
        overloads = np.array([contact in self._overloaded for contact in contacts])
        growing = np.array([i in self._growing for i in still], dtype=bool)[:, None]
        largest = np.where(growing, static, static.max(axis=1, initial=0.0)[:, None])
        shrunk = SHRUNK * overloads[:, None] * largest
        loaded = self._loaded(slips, still, rows, constraints, static / ratios)
        if loaded is not None:
            static[[i in self._one_way for i in still]] = 0.0, math.inf
            shrunk = np.where(np.isfinite(static), shrunk, 0.0)
        sliding = np.minimum(static - shrunk, static / ratios)
        slipped = np.array([one in self._slipped or one.stick.slides for one in contacts], dtype=bool)[
            :, None
        ]
        found = np.zeros(len(slips.rows))
        found[rows] = rest_or_slip(
            slips.to_rates[np.ix_(rows, rows)],
            slips.rates(accelerations)[rows],
            slips.noise(accelerations)[rows],
            replace(slips.sets.only(still), loaded=loaded),
            np.where(slipped, sliding, static - shrunk),
            sliding,
        )
        return found

    def _first_slips_of(
        self, begun: Sequence[int], slips: Slips, found: FloatArray, bounds: FloatArray
    ) -> dict[int, float]:
        """Return the slips of the rows of contacts in the plane that begin to slide, in proportion if linked."""
        if not begun:
            return {}
        sizes, blocks = slips.sets.sizes(found), slips.sets.blocks
        shortest = RESOLVED * self._step
        speeds = 2.0 * np.maximum(shortest * bounds, RESOLVED * slips.terms())
        links = [[slips.to_rates[blocks[i], blocks[j]].any() for j in begun] for i in begun]
        count, of_group = connected_components(np.array(links, float), directed=False)
        wanted: dict[int, float] = {}
        for number in range(count):
            group = [begun[k] for k in np.flatnonzero(of_group == number).tolist()]
            time = max(speeds[i] / sizes[i] for i in group)
            for i in group:
                contact = self._contacts[i]
                assert isinstance(contact, PlanarContact)
                self._first_slips[contact] = float(time * sizes[i])
                self._slides.begin(max(shortest, float(speeds[i] / bounds[i])))
                wanted.update((row, float(time * found[row])) for row in range(len(found))[blocks[i]])
        return wanted

    def margins(self, t: float) -> FloatArray:
        """Return numbers that fall below zero when the present modes end, shape (contacts + springs,).

        They are the slip in the direction of sliding (m/s or rad/s), or the unused share of the capacity of contacts
        at rest. They change their sign where friction vanishes or begins.
        """
        if self._line is not None:
            now = self._line.margins(self._data)
            if now.min() >= NEAR or (now[self._resting.alone] >= NEAR).all():
                return now
        springs = [spring.margin(self._mbs) for spring in self._springs]
        return np.append(self._margins_of_contacts(t), springs)

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
        margins[changed] = -np.maximum(np.abs(margins[changed]), LEAST)
        return margins

    def _checked_left(self, t: float) -> FloatArray:
        """Return ``_left``, by new loads if one is nearly overloaded."""
        left = self._left(t)
        least = left.min()
        if least < NEAR:
            before = self._data.GetAECoordinates(), self._data.GetODE2Coordinates_tt()
            self._dynamics.evaluate(t)
            self._iterate(t, self._present, (CURRENT,))
            left = self._left(t)
            change = self._data.GetAECoordinates() - before[0]
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
