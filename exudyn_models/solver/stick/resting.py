"""Contacts at rest: their constraints, and how they share their loads."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.sparse.csgraph import connected_components

from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw
from exudyn_models.solver.stick.complementarity import independent_rows
from exudyn_models.solver.stick.slips import Slips
from exudyn_models.solver.stick.sticking_contacts import PlanarContact, StickingContact
from reference_model.systems import FloatArray

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
    """Contacts at rest of a model, in groups that share loads; ``rows`` are held by constraints."""

    def __init__(self, mbs: Any) -> None:
        self._data, self._mbs = mbs.systemData, mbs
        self.rows: list[int] = []
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
        own_rows = [range(len(slips.rows))[slips.sets.blocks[i]] for i in resting]
        rows = [row for own in own_rows for row in own]
        owner = np.repeat(np.arange(len(resting)), [len(own) for own in own_rows]).astype(int)
        chosen, by_chosen = independent_rows(
            slips.to_rates[np.ix_(rows, rows)], [i for i, row in enumerate(rows) if row in before]
        )
        others = [i for i in range(len(rows)) if i not in chosen]
        self.rows, self.groups, self.alone = [rows[i] for i in chosen], [], []
        complete = [len(set(own).difference(self.rows)) == 0 for own in own_rows]
        self.places = places[np.array(complete, dtype=int)[owner[chosen]], self.rows]
        links = np.zeros((len(resting), len(resting)))
        for i, shares in zip(others, by_chosen, strict=True):
            links[owner[i], owner[[chosen[j] for j in np.flatnonzero(shares)]]] = 1.0
        alone = not others and not any(isinstance(contacts[i], PlanarContact) for i in resting)
        if alone:
            self.alone = list(resting)
        count, of_group = (
            (0, np.zeros(len(resting))) if alone else connected_components(links, directed=False)
        )
        of_first, of_rest = of_group[owner[chosen]], of_group[owner[others]]
        for number in range(count):
            own, first, rest = (np.flatnonzero(group == number) for group in (of_group, of_first, of_rest))
            members = [contacts[resting[k]] for k in own.tolist()]
            if not len(rest) and not isinstance(members[0], PlanarContact):
                self.alone.append(resting[int(own[0])])
                continue
            order = [chosen[k] for k in first] + [others[k] for k in rest]
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
        self.alone_places = places[0, [slips.sets.blocks[i].start for i in self.alone]]
        for i, place in zip(self.alone, self.alone_places, strict=True):
            stick = contacts[i].stick
            stick.holds = partial(self._force_at, int(place))
            if isinstance(stick, MeshLaw):
                stick.shifts = None

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
    """Margins of contacts with constant limits that share no load: the least of two lines in the model's unknowns."""

    def __init__(
        self, rows: FloatArray, directions: FloatArray, resting: Resting, limits: FloatArray, data: Any
    ) -> None:
        count, size = rows.shape
        slopes = np.zeros((2, count, size + data.AEsize()))
        slopes[:, :, :size], self._constants = (
            directions[:, None] * rows,
            np.tile(1.0 - np.abs(directions), (2, 1)),
        )
        alone, places = resting.alone, size + resting.alone_places
        largest = limits[alone].max(axis=1)
        for side, sign in enumerate((1.0, -1.0)):
            self._constants[side, alone] = limits[alone, 1 - side] / largest
            slopes[side, alone, places] = sign / largest
        self._slopes = slopes

    def margins(self, data: Any) -> FloatArray:
        """Return the present margins, shape (contacts,)."""
        velocities, forces = data.GetODE2Coordinates_t(CURRENT, False), data.GetAECoordinates(CURRENT, False)
        both = self._constants + self._slopes @ np.concatenate((velocities, forces))
        return np.asarray(np.minimum(both[0], both[1]))


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
