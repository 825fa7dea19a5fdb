"""Contacts at rest: their constraints, and how they share their loads."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw
from exudyn_models.solver.stick.complementarity import independent_rows, linked
from exudyn_models.solver.stick.slips import Slips
from exudyn_models.solver.stick.sticking_contacts import PlanarContact, StickingContact
from reference_model.systems import FloatArray

NEAR = 0.02
"""Unused share of capacity below which loads are computed again, because the loads in Exudyn's steps contain
errors."""

UNDETERMINED = 1e-9
"""Relative effect of an undetermined force on the capacity shares below which it is ignored."""


@dataclass(eq=False)
class Group:
    """Contacts at rest that share a load.

    The first of their rows are constraints with forces at ``places``; ``blocks`` are the rows of each contact, and
    ``by_chosen`` relates the slips of the other rows to the slips of the first rows. Forces along the rows change the
    moments of meshes by ``to_loads``, shape (m, k).
    """

    mbs: Any
    contacts: list[StickingContact]
    blocks: list[NDArray[Any]]
    places: NDArray[Any]
    by_chosen: FloatArray
    to_loads: FloatArray
    _others: FloatArray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        to_forces = np.vstack((-self.by_chosen.T, np.eye(len(self.by_chosen))))
        effects = np.zeros((len(to_forces), len(to_forces)))
        for contact, rows in zip(self.contacts, self.blocks, strict=True):
            effects[np.ix_(rows, rows)] = contact.effective()
        _, sizes, axes = np.linalg.svd(effects @ to_forces, full_matrices=False)
        self._undetermined = to_forces @ axes[sizes > UNDETERMINED].T
        self._others = np.zeros(self._undetermined.shape[1])

    def forces(self, t: float, enough: float = 0.0) -> tuple[FloatArray, float]:
        """Return the forces along all rows at the time t (s), and the largest share of a capacity.

        This share is as small as possible, or below ``enough``.
        """
        held = -self.mbs.systemData.GetAECoordinates()[self.places]
        if not len(self.by_chosen):  # a contact in the plane alone
            contact, own, limit = self.contacts[0], held[self.blocks[0]], self.contacts[0].strength(t)[1]
            assert isinstance(contact, PlanarContact)
            bound = contact.share_bound(own, limit[0])
            return held, bound if bound < enough else float(contact.shares(own, np.array(limit))[0][0])
        limits = [
            (0.0, 0.0) if isinstance(contact.stick, GrowingLimit) else contact.strength(t)[1]
            for contact in self.contacts
        ]
        start = np.concatenate((held, np.zeros(len(self.by_chosen))))

        for contact in self.contacts:
            if isinstance(contact.stick, GrowingLimit):
                contact.stick.rest(t)

        def shares(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            forces = start + self._undetermined @ x
            values, slopes = list[float](), list[FloatArray]()
            for contact, rows, limit in zip(self.contacts, self.blocks, limits, strict=True):
                by_x, law = self._undetermined[rows], contact.stick
                if isinstance(law, GrowingLimit):
                    to_load = self.to_loads[law.place]
                    by_x = np.vstack((by_x, to_load @ self._undetermined))
                    load = law.load_at(float(to_load @ start) if to_load.any() else None)
                    shares_of = law.shares(float(forces[rows[0]]), load + float(by_x[1] @ x))
                else:
                    shares_of = contact.shares(forces[rows], np.array(limit))
                values += shares_of[0]
                slopes += [slope @ by_x for slope in shares_of[1]]
            return np.array(values), np.array(slopes)

        share = shares(self._others)[0].max()
        if share >= enough and len(self._others):
            self._others = least_maximum(shares, self._others)
            share = shares(self._others)[0].max()
        return start + self._undetermined @ self._others, float(share)

    def load_of(self, mesh: MeshLaw) -> float:
        """Return the change of the present T (N m) of a mesh by the forces of rows that are not constraints."""
        self.forces(self.mbs.systemData.GetTime(CURRENT))
        return float(self.to_loads[mesh.place] @ self._undetermined @ self._others)

    def forces_of(self, i: int) -> FloatArray:
        """Return the present forces of a contact along its locks."""
        forces, _ = self.forces(self.mbs.systemData.GetTime(CURRENT))
        return np.asarray(forces[self.blocks[i]])


class Resting:
    """Contacts at rest of a model, in groups that share loads.

    ``rows`` are held by constraints, and ``to_forces`` is the inverse of ``Slips.among`` these rows.
    """

    def __init__(self, mbs: Any) -> None:
        self._data, self._mbs = mbs.systemData, mbs
        self.rows: list[int] = []
        self.to_forces = np.empty((0, 0))
        self.places = np.empty(0, dtype=int)
        self.alone, self.alone_places = list[int](), np.empty(0, dtype=int)
        self.groups: list[Group] = []

    def divide(
        self,
        contacts: Sequence[StickingContact],
        slips: Slips,
        resting: Sequence[int],
        places: NDArray[Any],
        before: Sequence[int],
        to_loads: FloatArray,
    ) -> None:
        """Choose the rows of ``resting`` contacts that become constraints, and find contacts that share loads.

        ``places``, shape (2, k), locate the forces of constraints of rows, and of constraints that hold all rows of a
        contact; rows ``before`` are preferred. Forces along all rows change the moments of meshes by ``to_loads``,
        shape (m, k).
        """
        rows = slips.rows_of(resting)
        chosen, self.to_forces, by_chosen = independent_rows(
            slips.among(rows), [i for i, row in enumerate(rows) if row in before]
        )
        self.rows, self.groups, self.alone = [rows[i] for i in chosen], [], []
        if len(chosen) == len(rows) and slips.sets.on_axes:
            self.places, self.alone = places[0, self.rows], list(resting)
        else:
            held = set(self.rows)
            whole = set(slips.rows_of([i for i in resting if held.issuperset(slips.rows_of([i]))]))
            self.places = places[[int(row in whole) for row in self.rows], self.rows]
            self._group(contacts, slips, resting, rows, chosen, by_chosen, to_loads)
        self.alone_places = places[0, [slips.firsts[i] for i in self.alone]]
        for i, place in zip(self.alone, self.alone_places.tolist(), strict=True):
            stick = contacts[i].stick
            stick.holds = partial(self._force_at, place)
            if isinstance(stick, MeshLaw):
                stick.shifts = None

    def _group(
        self,
        contacts: Sequence[StickingContact],
        slips: Slips,
        resting: Sequence[int],
        rows: Sequence[int],
        chosen: Sequence[int],
        by_chosen: FloatArray,
        to_loads: FloatArray,
    ) -> None:
        """Find the groups of ``resting`` contacts; ``chosen`` of their ``rows`` are constraints."""
        owner = np.repeat(np.arange(len(resting)), [len(slips.rows_of([i])) for i in resting]).astype(int)
        others = [i for i in range(len(rows)) if i not in chosen]
        links = np.zeros((len(resting), len(resting)))
        for i, shares in zip(others, by_chosen, strict=True):
            links[owner[i], owner[[chosen[j] for j in np.flatnonzero(shares).tolist()]]] = 1.0
        count, of_group = linked(links)
        of_first, of_rest = of_group[owner[chosen]], of_group[owner[others]]
        for number in range(count):
            own, first, rest = (np.flatnonzero(group == number) for group in (of_group, of_first, of_rest))
            members = [contacts[resting[k]] for k in own.tolist()]
            if not len(rest) and not isinstance(members[0], PlanarContact):
                self.alone.append(resting[int(own[0])])
                continue
            order = [chosen[k] for k in first.tolist()] + [others[k] for k in rest.tolist()]
            blocks = [np.array([order.index(i) for i in np.flatnonzero(owner == k).tolist()]) for k in own]
            self.groups.append(
                Group(
                    self._mbs,
                    members,
                    blocks,
                    self.places[first],
                    by_chosen[np.ix_(rest, first)],
                    to_loads[:, [rows[i] for i in order]],
                )
            )
            for i, contact in enumerate(members):
                contact.stick.holds = partial(self.groups[-1].forces_of, i)
                if isinstance(contact.stick, MeshLaw):
                    contact.stick.shifts = partial(self.groups[-1].load_of, contact.stick)

    def _force_at(self, place: int) -> FloatArray:
        return -np.asarray(self._data.GetAECoordinates()[place : place + 1])

    def share(self, contacts: Sequence[StickingContact]) -> set[StickingContact]:
        """Return contacts with all others of their groups."""
        found = set(contacts)
        for group in self.groups:
            if found.intersection(group.contacts):
                found.update(group.contacts)
        return found


class Line:
    """Conditions in the model's unknowns for contacts with constant limits that share no load to keep their modes."""

    def __init__(
        self, rows: FloatArray, directions: FloatArray, resting: Resting, limits: FloatArray, data: Any
    ) -> None:
        slides, alone = np.flatnonzero(directions), resting.alone
        size, count, first = rows.shape[1], len(alone), len(slides)
        unknowns = size + data.AEsize()
        self._slopes = slopes = np.zeros((first + 2 * count, unknowns + 1))
        slopes[:first, :size] = directions[slides, None] * rows[slides]
        largest = limits[alone].max(axis=1)
        for i, sign in enumerate((1.0, -1.0)):
            own = np.arange(first + i * count, first + (i + 1) * count)
            slopes[own, size + resting.alone_places] = sign
            slopes[own, unknowns] = limits[alone, 1 - i] - NEAR * largest
        self._unknowns, self._size, self._data = np.ones(unknowns + 1), size, data

    def holds(self) -> bool:
        """Return whether all contacts clearly keep their modes at the present state."""
        unknowns, size = self._unknowns, self._size
        unknowns[:size] = self._data.GetODE2Coordinates_t(CURRENT, False)
        unknowns[size:-1] = self._data.GetAECoordinates(CURRENT, False)
        unused = self._slopes.dot(unknowns)
        return bool(unused[unused.argmin()] >= 0.0)


def least_maximum(
    functions: Callable[[FloatArray], tuple[FloatArray, FloatArray]], start: FloatArray
) -> FloatArray:
    """Return the minimiser, shape (size,), of the maximum of convex functions, from a ``start``.

    ``functions`` returns their values, shape (n,), and derivatives, shape (n, size).
    """

    def above(z: FloatArray) -> FloatArray:
        return np.asarray(z[0] - functions(z[1:])[0])

    def slopes(z: FloatArray) -> FloatArray:
        gradients = functions(z[1:])[1]
        return np.hstack((np.ones((len(gradients), 1)), -gradients))

    found = minimize(
        lambda z: z[0],
        [np.max(functions(start)[0]), *start],
        jac=lambda z: np.eye(len(start) + 1)[0],
        constraints={"type": "ineq", "fun": above, "jac": slopes},
        method="SLSQP",
        options={"ftol": 1e-13, "maxiter": 200},
    )
    return np.asarray(found.x[1:])
