"""Forces of contacts at rest on axes, and the sharing of their loads.

The slip accelerations are r = g + A·f. The forces f minimise fᵀ·A·f/2 + gᵀ·f between the limits of static friction
(Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts, 1996). A contact within its limits rests, and a
contact at a limit may slip against its force. Redundant contacts share a load, and make A singular.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from reference_model.systems import FloatArray

REGULAR = 1e-12
"""Relative compliance that makes the forces of redundant contacts unique."""

SLIPS = 1e-8
"""Smallest slip acceleration, relative to that of friction alone; less is a rounding error."""

DEPENDENT = 1e-9
"""Part of a gradient of slip, relative to its length in the metric of the mass, that other contacts do not hold."""

ACTIVE = 1e-9
"""Smallest multiplier of a share that determines the largest one."""


def bounded_forces(
    to_rates: FloatArray, rates: FloatArray, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the forces between ``low`` and ``high``, shape (k,), and the slip accelerations that they leave.

    ``to_rates``, shape (k, k), is A, and ``rates`` is g. An active-set method finds the minimum.
    """
    size = np.maximum(np.maximum(np.abs(low), np.abs(high)), np.finfo(float).tiny)
    matrix, vector = size[:, None] * to_rates * size, size * rates
    weight = np.maximum(np.diag(matrix), np.abs(vector))
    weight[weight == 0.0] = 1.0
    matrix = matrix + np.diag(REGULAR * weight)
    low, high = low / size, high / size
    x = np.clip(np.zeros(len(rates)), low, high)
    free = low < high
    for _ in range(20 * len(x) + 20):
        wanted = x.copy()
        wanted[free] = np.linalg.solve(
            matrix[np.ix_(free, free)], -(vector + matrix[:, ~free] @ x[~free])[free]
        )
        change = wanted - x
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(
                change > 0.0, (high - x) / change, np.where(change < 0.0, (low - x) / change, np.inf)
            )
        first = int(np.argmin(shares)) if len(x) else 0
        if len(x) and shares[first] < 1.0:
            x = np.clip(x + max(shares[first], 0.0) * change, low, high)
            x[first] = high[first] if change[first] > 0.0 else low[first]
            free[first] = False
            continue
        x, slope = wanted, (matrix @ wanted + vector) / weight
        against = np.where(free | (low == high), 0.0, np.where(x >= high, slope, -slope))
        if not len(x) or against.max() <= REGULAR:
            break
        free[int(np.argmax(against))] = True
    forces = size * x
    return forces, rates + to_rates @ forces


def rest_or_slip(
    to_rates: FloatArray,
    rates: FloatArray,
    noise: FloatArray,
    static: FloatArray,
    sliding: FloatArray,
) -> FloatArray:
    """Return the directions of the slip that begins at contacts without slip, shape (k,), 0 at rest.

    ``static`` and ``sliding``, shape (k, 2), are the largest forces against slip forward and backward. Static
    friction acts on all contacts first; those that slip then have sliding friction, until no other slips. Contacts
    that can rest after all, because others slip, do so. Slip accelerations below ``noise`` count as zero.
    """

    def directions(slips: NDArray[np.bool_]) -> FloatArray:
        low, high = np.where(slips, sliding.T, static.T) * [[-1.0], [1.0]]
        forces, left = bounded_forces(to_rates, rates, low, high)
        least = np.maximum(SLIPS * np.maximum(np.diag(to_rates) * static.max(axis=1), np.abs(rates)), noise)
        edge = ACTIVE * (high - low)
        pressed = np.where(forces <= low + edge, left > least, (forces >= high - edge) & (left < -least))
        return np.where(pressed, np.sign(left), 0.0)

    slips = np.zeros(len(rates), dtype=bool)
    while (found := (directions(slips) != 0.0) & ~slips).any():
        slips |= found
    for i in np.flatnonzero(slips)[::-1] if slips.sum() > 1 and (static > sliding).any() else ():
        others = slips & (np.arange(len(slips)) != i)
        if not directions(others)[~others].any():
            slips = others
    return directions(slips)


def independent_rows(gram: FloatArray, preferred: Sequence[int]) -> tuple[list[int], FloatArray]:
    """Return the contacts that hold all others, and how the slips of the others depend on theirs.

    ``gram``, shape (k, k), contains the products of the gradients of slip in the metric of the mass; joints reduce
    them. ``preferred`` contacts are chosen first. The second result, shape (k - chosen, chosen), has the rows of the
    remaining contacts in their order.
    """
    rest, lengths = gram, np.diag(gram)
    chosen: list[int] = []
    for i in (*preferred, *range(len(gram))):
        if rest[i, i] > DEPENDENT * lengths[i]:
            rest = rest - np.outer(rest[:, i], rest[i]) / rest[i, i]
            chosen.append(i)
    chosen.sort()
    others = [i for i in range(len(gram)) if i not in chosen]
    if not chosen or not others:
        return chosen, np.zeros((len(others), len(chosen)))
    by_chosen = np.linalg.solve(gram[np.ix_(chosen, chosen)], gram[np.ix_(chosen, others)]).T
    by_chosen[np.abs(by_chosen) < DEPENDENT] = 0.0
    return chosen, np.asarray(by_chosen, float)


@dataclass(eq=False)
class SharedLoad:
    """Load on contacts at rest that hold each other: the distribution with the least largest share of capacity.

    Forces of the first contacts, which are constraints, hold it alone. ``by_chosen``, shape (p, c), relates the slips
    of the p others to theirs.
    """

    by_chosen: FloatArray
    _active: NDArray[Any] = field(default_factory=lambda: np.empty(0, int))

    def distribution(self, held: FloatArray, limits: FloatArray) -> tuple[FloatArray, float]:
        """Return all forces, shape (c + p,), and their largest share, for the forces ``held`` by the first alone.

        ``limits``, shape (c + p, 2), are the largest forces against slip forward and backward.
        """
        others = len(self.by_chosen)
        if not held.any():
            return np.zeros(len(limits)), 0.0
        to_forces = np.vstack((-self.by_chosen.T, np.eye(others)))
        start = np.concatenate((held, np.zeros(others)))
        # Rows are the conditions to_forces·x − share·limit <= −start, in both directions.
        rows = np.vstack((to_forces, -to_forces))
        right = np.concatenate((-start, start))
        sizes = np.concatenate((limits[:, 1], limits[:, 0]))
        rows = np.hstack((rows, -sizes[:, None]))
        found = self._at_active(rows, right)
        if found is None:
            scale = max(np.abs(held).max(initial=0.0), np.finfo(float).tiny)
            result = linprog(
                np.eye(others + 1)[-1], rows, right / scale, bounds=[(None, None)] * others + [(0.0, None)]
            )
            self._active = np.flatnonzero(result.ineqlin.marginals < -ACTIVE / sizes.max())
            found = self._at_active(rows, right)
            if found is None:
                found = scale * result.x
        forces = start + to_forces @ found[:-1]
        return forces, largest_share(forces, limits)

    def _at_active(self, rows: FloatArray, right: FloatArray) -> FloatArray | None:
        """Return the minimum at the conditions that determined the last one, or None if others do."""
        if not len(self._active):
            return None
        active = rows[self._active]
        found = np.linalg.lstsq(active, right[self._active], rcond=None)[0]
        multipliers = np.linalg.lstsq(active.T, -np.eye(active.shape[1])[-1], rcond=None)[0]
        is_minimum = np.abs(active.T @ multipliers + np.eye(active.shape[1])[-1]).max() < ACTIVE
        tolerance = ACTIVE * np.abs(right).max()
        if is_minimum and (multipliers >= 0.0).all() and (rows @ found <= right + tolerance).all():
            return np.asarray(found)
        return None


def largest_share(forces: FloatArray, limits: FloatArray) -> float:
    """Return the largest share of the ``limits`` against slip forward and backward that ``forces`` use."""
    capacity = np.where(forces > 0.0, limits[:, 1], limits[:, 0])
    return float(np.max(np.abs(forces) / capacity, initial=0.0))
