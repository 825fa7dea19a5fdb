"""Forces of rows at rest or in slip whose limits may be infinite, or grow with the moments of meshes.

The slip accelerations are r = g + A·f, and the moments of the meshes T = T₀ + W·f. Each row has r = 0 within its
limits, or f at a limit against r. All rows change their states together until every row agrees with its state. If
that takes too long, only the first row that disagrees changes, which always ends without meshes (K. G. Murty,
Mathematical Programming 7 (1974) 231). With meshes, random states follow.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.rows.laws import GrowingLimit
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

REGULAR = 1e-12
"""Relative compliance that makes the forces of redundant rows unique."""

TOGETHER, MOST = 20, 4000
"""Number of iterations that change all rows together from the same start, and number of all iterations."""

CLOSE = 1e-11
"""Relative tolerance of forces, moments and slip accelerations."""


@dataclass(frozen=True, eq=False)
class LoadedRows:
    """Rows with infinite limits, or limits that grow with moments.

    ``loads``, shape (m,), is T₀ and ``by_force``, shape (m, k), W. ``laws`` contains growing limits, and None for
    other rows, and ``pinned``, shape (k,), the direction of rows that slide already, or 0. Growing limits are scaled
    like the present ones, ``sliding``, shape (k, 2), in slip.
    """

    loads: FloatArray
    by_force: FloatArray
    laws: Sequence[GrowingLimit | None]
    pinned: NDArray[np.int_]
    sliding: FloatArray

    def forces(
        self, to_rates: FloatArray, rates: FloatArray, limits: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the forces, shape (k,), and the slip accelerations that they leave.

        ``limits``, shape (k, 2), are the present limits of the forces against slip forward and backward.
        """
        states, power, diagonal = self.pinned.copy(), self.loads, np.diag(to_rates)
        meshes, pinned = any(law is not None for law in self.laws), self.pinned != 0
        matrix = to_rates.copy()
        matrix.flat[:: len(matrix) + 1] += REGULAR * np.where(diagonal > 0.0, diagonal, 1.0)
        random = np.random.default_rng(0) if meshes else None
        for tried in range(MOST):
            if random is not None and tried and tried % TOGETHER == 0:
                states = np.where(pinned, self.pinned, random.integers(-1, 2, len(states)))
                states[np.isinf(limits[:, 1]) & (states < 0)] = 0
            forces, power = self._at(states, power, matrix, rates, limits)
            left = rates + to_rates @ forces
            forward, backward = (self._limits(power, limits) if meshes else limits).T
            sizes = np.abs(forces)
            above = CLOSE * sizes
            wanted = np.subtract(forces < -forward - above, forces > backward + above, dtype=int)
            if states.any():
                turns = states * left < -CLOSE * np.maximum(np.abs(rates), diagonal * sizes)
                wanted = np.where(states == 0, wanted, np.where(turns, 0, states))
                wanted[pinned] = self.pinned[pinned]
            wrong = np.flatnonzero(wanted != states)
            if not len(wrong):
                return forces, left
            changed = wrong if meshes or tried < TOGETHER else wrong[:1]
            states[changed] = wanted[changed]
        raise SimulationError("found no forces of gears and contacts that satisfy their laws: a gear jams")

    def _limits(self, loads: FloatArray, limits: FloatArray) -> FloatArray:
        found = limits.copy()
        for i, law in enumerate(self.laws):
            if law is not None:
                found[i] *= [law.limit(loads[law.place], way) for way in (1, -1)] / self.sliding[i]
        return found

    def _at(
        self,
        states: NDArray[np.int_],
        power: FloatArray,
        matrix: FloatArray,
        rates: FloatArray,
        limits: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Return the forces in these states, and the moments of the meshes; these begin with ``power``."""
        slides, loads = np.flatnonzero(states).tolist(), power
        for _ in range(4 * len(loads) + 4):
            system, right = matrix.copy(), -rates
            for i in slides:
                law, way = self.laws[i], int(states[i])
                at = (1, -1).index(way)
                system[i] = 0.0
                system[i, i], right[i] = 1.0, -way * limits[i, at]
                if law is not None:
                    scale = limits[i, at] / self.sliding[i, at]
                    slope = scale * law.slope_at(loads[law.place], way)
                    system[i] += slope * self.by_force[law.place]
                    right[i] = -scale * way * law.limit(0.0, way) - slope * self.loads[law.place]
            forces = np.linalg.solve(system, right)
            if not len(loads):
                break
            found = self.loads + self.by_force @ forces
            same = np.abs(found - loads).max(initial=0.0) <= CLOSE * np.abs(found).max(initial=0.0)
            loads = found
            if same:
                break
        return np.asarray(forces, float), loads


def unloaded(count: int) -> LoadedRows:
    """Return ``count`` rows without meshes that may all rest."""
    none = np.zeros((0, count))
    return LoadedRows(np.empty(0), none, [None] * count, np.zeros(count, int), np.ones((count, 2)))
