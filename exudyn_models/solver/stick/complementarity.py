"""Forces of contacts at rest, and the sharing of their loads.

The slip accelerations are r = g + A·f. The forces f minimise fᵀ·A·f/2 + gᵀ·f within the limits of static friction
(Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts, 1996). A contact within its limits rests, and a
contact at a limit may slip against its force. Redundant contacts share a load, and make A singular.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate, combinations, islice, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from exudyn_models.solver.rows.active_set import LoadedRows, unloaded
from reference_model.systems import FloatArray

SLIPS = 1e-8
"""Smallest slip acceleration, relative to the acceleration by friction alone; less is a rounding error."""

DEPENDENT = 1e-9
"""Part of a gradient of slip, relative to its length in the metric of the mass, that other contacts do not hold."""

SUBSETS = 64
"""Largest number of sets of slipping contacts to try, beginning with the smallest."""

CLEARLY = 1e-6
"""Part of each gradient that those before it do not hold if all are independent, far above ``DEPENDENT``."""

PREFERRED = 1e3
"""Factor on the independent part of preferred gradients; with a tiny part, forces on others would be large."""

SMOOTH, CLOSE, ROUNDING = 1e-11, 1e-4, 1e-14
"""Last share of a slip acceleration that smooths friction, and tolerances of forces and of rounding errors."""


Law = Callable[[FloatArray], tuple[float, FloatArray, FloatArray]]
"""Support function P of slips at a contact in the plane, its gradient, and P times its second derivatives."""


@dataclass(frozen=True, eq=False)
class Sets:
    """Sets of friction of contacts: ``blocks`` of rows, and their laws; None is an interval on an axis.

    ``loaded`` is not None if the limits of some rows are infinite or grow with moments.
    """

    blocks: Sequence[slice]
    laws: Sequence[Law | None]
    loaded: LoadedRows | None = None

    def only(self, chosen: Sequence[int], loaded: LoadedRows | None) -> "Sets":
        """Return the sets of chosen contacts, whose rows follow each other and may be ``loaded``."""
        if self.on_axes:
            return Sets(self.blocks[: len(chosen)], self.laws[: len(chosen)], loaded)
        ends = accumulate((self.blocks[i].stop - self.blocks[i].start for i in chosen), initial=0)
        return Sets([slice(*pair) for pair in pairwise(ends)], [self.laws[i] for i in chosen], loaded)

    @property
    def on_axes(self) -> bool:
        """True if each contact has one row."""
        return not any(self.laws)

    @property
    def owner(self) -> NDArray[Any]:
        """Number of the contact of each row, shape (k,)."""
        if self.on_axes:
            return np.arange(len(self.blocks))
        return np.repeat(np.arange(len(self.blocks)), [rows.stop - rows.start for rows in self.blocks])

    def sizes(self, slips: FloatArray) -> FloatArray:
        """Return the size of the slip of each contact."""
        if self.on_axes:
            return np.abs(slips)
        pairs = zip(self.blocks, self.laws, strict=True)
        return np.array([law(slips[rows])[0] if law else abs(slips[rows.start]) for rows, law in pairs])

    def forces(
        self, to_rates: FloatArray, rates: FloatArray, limits: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the forces, shape (k,), and the slip accelerations that they leave.

        ``limits``, shape (contacts, 2), are the largest forces against slip forward and backward.
        """
        if self.on_axes:
            return (self.loaded or unloaded(len(rates))).forces(to_rates, rates, limits)
        if (inverse := _clear_inverse(to_rates)) is not None:
            holding = -inverse @ rates
            if self._clearly_contain(holding, limits):
                return holding, rates + to_rates @ holding
        return self._smooth_forces(to_rates, rates, limits)

    def _clearly_contain(self, forces: FloatArray, limits: FloatArray) -> bool:
        """Return whether ``forces`` lie in intervals, or in the hull that every limit surface contains."""
        own = [forces[rows].tolist() for rows in self.blocks]
        return all(
            size_in_hull(force) < forward if law else -forward < force[0] < backward
            for law, force, (forward, backward) in zip(self.laws, own, limits.tolist(), strict=True)
        )

    def _smooth_forces(
        self, to_rates: FloatArray, rates: FloatArray, limits: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the same as ``forces``, by Newton's method for ½·fᵀ·A·f + Σ s·√(P(r)² + ε²), ε → ``SMOOTH``.

        Each iteration for a smaller ε starts from an extrapolation.
        """
        middle, radii = (limits[:, 1] - limits[:, 0]) / 2.0, limits.mean(axis=1)
        counts = [rows.stop - rows.start for rows in self.blocks]
        shift = np.where(
            np.repeat([law is None for law in self.laws], counts), np.repeat(middle, counts), 0.0
        )
        rates, size = rates + to_rates @ shift, np.repeat(radii, counts)
        pairs = zip(self.blocks, radii, strict=True)
        scales = np.array(
            [max(np.linalg.norm(to_rates[b, b]) * s, np.linalg.norm(rates[b])) for b, s in pairs]
        )
        scales[scales == 0.0] = 1.0

        def terms(z: FloatArray, share: float) -> tuple[float, FloatArray, FloatArray, FloatArray]:
            left, value = rates + to_rates @ z, 0.5 * z @ to_rates @ z
            forces, slopes, by_share = np.zeros(len(z)), np.zeros_like(to_rates), np.zeros(len(z))
            for rows, law, radius, scale in zip(self.blocks, self.laws, radii, scales, strict=True):
                slip, smooth = left[rows], share * scale
                size, gradient, curvature = (
                    law(slip) if law else (abs(slip[0]), np.sign(slip), np.zeros((1, 1)))
                )
                root = math.hypot(size, smooth)
                value += radius * root
                forces[rows] = -radius * size / root * gradient
                bent = np.outer(gradient, gradient) if size > 0.0 else np.eye(len(slip))
                slopes[rows, rows] = radius / root * (bent * (smooth / root) ** 2 + curvature)
                by_share[rows] = radius * scale * size * smooth / root**3 * gradient
            return float(value), forces, slopes, np.asarray(by_share)

        z, share, one = np.zeros(len(rates)), 1.0, np.eye(len(rates))
        while True:
            value, forces, slopes, by_share = terms(z, share)
            for _ in range(100):
                error = forces - z
                if (np.abs(error) <= CLOSE * size).all():
                    break
                change, part = np.linalg.solve(one + slopes @ to_rates, error), 1.0
                fall = 1e-4 * error @ to_rates @ change
                while (found := terms(z + part * change, share))[0] > value - part * fall + ROUNDING * value:
                    if part < 1e-6:
                        break
                    part /= 2.0
                z = z + part * change
                value, forces, slopes, by_share = found
            if share <= SMOOTH:
                return z + shift, rates + to_rates @ z
            z = z + np.linalg.solve(one + slopes @ to_rates, by_share) * (0.1 - 1.0) * share
            share *= 0.1


def rest_or_slip(
    to_rates: FloatArray,
    rates: FloatArray,
    noise: FloatArray,
    sets: Sets,
    static: FloatArray,
    sliding: FloatArray,
) -> FloatArray:
    """Return the slip accelerations that begin at contacts without slip, shape (k,), 0 at rest.

    ``static`` and ``sliding``, shape (contacts, 2), are the largest forces against slip forward and backward. Static
    friction acts on all contacts first. Contacts that slip then have sliding friction, until no other contact slips.
    As few contacts as possible slip in the end, because some can rest only if others slip. Slip accelerations below
    ``noise`` count as zero.
    """
    count, owner = len(sets.blocks), sets.owner
    own = np.abs(np.diag(to_rates))
    if not sets.on_axes:
        own = np.sqrt(np.bincount(owner, (to_rates**2 * (owner[:, None] == owner)).sum(axis=1), count))
    finite = np.where(np.isfinite(static), static, 0.0)
    least = np.maximum(SLIPS * np.maximum(own * finite.max(axis=1), sets.sizes(rates)), sets.sizes(noise))

    def slips(slides: NDArray[np.bool_]) -> tuple[FloatArray, NDArray[np.bool_]]:
        limits = np.where(slides[:, None], sliding, static)
        forces, left = sets.forces(to_rates, rates, limits)
        terms = sets.sizes(np.abs(to_rates) @ np.abs(forces))
        return left, sets.sizes(left) > np.maximum(least, SLIPS * terms)

    slides = np.zeros(count, dtype=bool)
    left, moves = slips(slides)
    if (static > sliding).any():
        while (found := moves & ~slides).any():
            slides |= found
            left, moves = slips(slides)
        chosen = np.flatnonzero(slides)
        fewer = (subset for size in range(1, len(chosen)) for subset in combinations(chosen, size))
        for subset in islice(fewer, SUBSETS):
            rests = np.isin(np.arange(count), subset, invert=True)
            found_left, found = slips(~rests)
            if not found[rests].any():
                left, moves = found_left, found
                break
    return np.asarray(left * moves[owner])


def size_in_hull(forces: Sequence[float]) -> float:
    """Return the friction (N) whose hull of forces alone and of moments alone the ``forces`` along locks reach."""
    x, y, *rim = forces
    return math.hypot(x, y) + abs(sum(rim))


def linked(links: FloatArray) -> tuple[int, NDArray[Any]]:
    """Return the number of groups that ``links``, shape (n, n), leave apart, and the group of each member."""
    if len(links) < 2:  # SciPy takes 0.2 ms
        return len(links), np.zeros(len(links), dtype=int)
    count, of_group = connected_components(links, directed=False)
    return int(count), of_group


def independent_rows(gram: FloatArray, preferred: Sequence[int]) -> tuple[list[int], FloatArray, FloatArray]:
    """Return the contacts that hold all others, the inverse of ``gram`` among them, and how others depend on them.

    ``gram``, shape (k, k), contains the products of the gradients of slip in the metric of the mass; joints reduce
    them. ``preferred`` contacts are chosen first. The last result, shape (k - chosen, chosen), has the rows of the
    remaining contacts in their order.
    """
    rest, lengths = gram, np.diag(gram)
    if (of_all := _clear_inverse(gram)) is not None:
        return list(range(len(gram))), of_all, np.zeros((0, len(gram)))
    weights = np.zeros(len(gram))
    np.divide(1.0, lengths, out=weights, where=lengths > 0.0)
    weights[list(preferred)] *= PREFERRED
    chosen: list[int] = []
    while len(gram):
        i = int(np.argmax(np.diag(rest) * weights))
        if rest[i, i] <= DEPENDENT * lengths[i]:
            break
        rest = rest - np.outer(rest[:, i], rest[i]) / rest[i, i]
        chosen.append(i)
        weights[i] = 0.0
    chosen.sort()
    others = [i for i in range(len(gram)) if i not in chosen]
    of_chosen = np.linalg.inv(gram[np.ix_(chosen, chosen)])
    by_chosen = (of_chosen @ gram[np.ix_(chosen, others)]).T
    by_chosen[np.abs(by_chosen) < DEPENDENT] = 0.0
    return chosen, np.asarray(of_chosen, float), np.asarray(by_chosen, float)


def _clear_inverse(gram: FloatArray) -> FloatArray | None:
    """Return the inverse, or None if rows are not clearly independent."""
    lengths = np.diag(gram)
    if not (lengths > 0.0).all():
        return None
    try:
        inverse = np.linalg.inv(gram)
    except np.linalg.LinAlgError:
        return None
    # The inverse of this product is the part of each squared length that the others do not hold.
    shares = lengths * np.diag(inverse)
    return np.asarray(inverse, float) if ((shares > 0.0) & (shares * CLEARLY < 1.0)).all() else None
