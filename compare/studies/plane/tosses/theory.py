"""Motion of a cube that slides with a spin, and the measured slides.

Friction at the place p from the centre of mass acts against the slip v + iωp. The load moves forwards by μL, with the
height L of the centre of mass, until its moment balances the friction force; the change of pressure is linear over
the face. With the spin ω << v/|p|, and p∥ along v,

    dω/dv = ω·(<p∥²> − μ²L²)/(κ²v),  so ω ~ v^n with n = (<p∥²> − μ²L²)/κ²,
    direction of slip: dθ/dt = −μ²gLω/v²,  because <p∥> = μL for every distribution,
    deceleration: μg·(1 − <p∥²>ω²/2v²).

<p∥²> is h² for loads at the corners of a square of side 2h, 2h²/3 for its rim and h²/3 for an even pressure. A cube
of uniform density has κ² = 2h²/3, so a rim slows it as ω ~ v.
"""

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import ComplexArray, FloatArray

HALF_SIDE, MASS, GRAVITY = 0.0524, 0.37, 9.80
"""Numbers of the authors in m and kg, and g in m/s²."""

SLOWEST, SPEEDS = 0.12, (0.30, 0.25, 0.20, 0.16, 0.12)
"""Last speed, and speeds (m/s) of the columns spin_30 to spin_12."""

STEP = 1.0 / 300.0
"""Step in s of the Runge-Kutta method, whose error is far below the measurement's."""


@dataclass(frozen=True, eq=False)
class Slides:
    """Columns of the table, shape (n,), and ``constants`` with values and errors from flights and bounces.

    ``gyration`` (m²), ``height`` and ``offset`` (m) are κ² about the vertical, L, and the distance of the centre of
    mass from the middle of the face along the heading ``axis`` (rad) relative to slip.
    """

    columns: Mapping[str, FloatArray]
    constants: Mapping[str, tuple[float, float]]

    def __getitem__(self, name: str) -> FloatArray:
        return self.columns[name]

    def where(self, chosen: NDArray[Any]) -> "Slides":
        """Return the slides with true (or of the given) indices."""
        return Slides({name: values[chosen] for name, values in self.columns.items()}, self.constants)

    def of_constant(self, name: str) -> float:
        """Return the value of a constant."""
        return self.constants[name][0]

    @property
    def reach(self) -> float:
        """Half side of the square of contact (m): the cube without its rounded edges."""
        return HALF_SIDE - 1e-3 * self.of_constant("corner_radius_mm")


@cache
def measured() -> Slides:
    text = (
        files("compare.studies.plane.tosses").joinpath("slides.csv").read_text(encoding="utf-8").splitlines()
    )
    comments = "\n".join(line for line in text if line.startswith("#"))
    found = re.findall(r"^# (\w+) = (\S+) \+- (\S+)$", comments, re.MULTILINE)
    constants = {name: (float(value), float(error)) for name, value, error in found}
    rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    numbers = {
        name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if name != "up"
    }
    up = [row["up"] for row in rows]
    flat = np.array([name[-1] == "z" for name in up])
    centre = [1e-3 * constants[f"centre_{name[-1]}_mm"][0] * (1 - 2 * (name[0] == "-")) for name in up]
    return Slides(
        numbers
        | {
            "axis": np.radians(numbers["axis_deg"]),
            "slip": np.radians(numbers["slip_deg"]),
            "height": HALF_SIDE + np.array(centre),
            "offset": np.where(flat, 0.0, 1e-3 * constants["centre_z_mm"][0]),
            "gyration": np.array([1e-6 * constants[f"gyration_{name[-1]}_mm2"][0] for name in up]),
            "spins": np.column_stack([numbers[f"spin_{100 * speed:.0f}"] for speed in SPEEDS]),
        },
        constants,
    )


class Load(NamedTuple):
    """Places of contact for a square of half side 1, and shares of the load without friction."""

    places: ComplexArray
    shares: FloatArray


def _loads() -> dict[str, Load]:
    nodes, weights = np.polynomial.legendre.leggauss(4)
    sides = np.concatenate((nodes + 1j, nodes - 1j, 1.0 + 1j * nodes, -1.0 + 1j * nodes))
    return {
        "four corners": Load(np.array([1.0 + 1j, -1.0 + 1j, -1.0 - 1j, 1.0 - 1j]), np.full(4, 0.25)),
        "rim": Load(sides, np.tile(weights, 4) / 8.0),
        "even pressure": Load(
            np.add.outer(nodes, 1j * nodes).ravel(), np.outer(weights, weights).ravel() / 4.0
        ),
    }


LOADS = _loads()


def directions_of(places: ComplexArray, slip: ComplexArray, spin: FloatArray) -> ComplexArray:
    """Return the directions of slip at ``places``, shape (n, points), of n bodies."""
    velocities = slip[:, None] + 1j * spin[:, None] * places
    return np.asarray(velocities / np.maximum(np.abs(velocities), 1e-300))


def loaded(
    places: ComplexArray, shares: FloatArray, directions: ComplexArray, shift: FloatArray
) -> FloatArray:
    """Return the loads at ``places``, shape (n, points), if friction at the distance μL = ``shift`` tilts them.

    The loads are shares·(a + b·x + c·y); their sum and their moments determine a, b and c.
    """
    ones, shifted = np.ones_like(places.real), places - shift[:, None] * directions
    tests, trials = (np.stack((ones, each.real, each.imag), axis=1) for each in (shifted, places))
    balance = np.einsum("k,nik,njk->nij", shares, tests, trials)
    tilt = np.linalg.solve(balance, np.tile([[1.0], [0.0], [0.0]], (len(places), 1, 1)))[:, :, 0]
    return np.asarray(shares * np.einsum("nj,njk->nk", tilt, trials))


def friction(
    places: ComplexArray, shares: FloatArray, slip: ComplexArray, spin: FloatArray, shift: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """Return force and moment per newton of μN; ``slip`` (m/s) and ``spin`` (rad/s) have the shape (n,)."""
    directions = directions_of(places, slip, spin)
    found = -loaded(places, shares, directions, shift) * directions
    return found.sum(axis=1), np.sum((places.conj() * found).imag, axis=1)


class Motion(NamedTuple):
    """Turn (degrees) down to ``SLOWEST``, shape (n,), and spins (rad/s) at ``SPEEDS``, shape (n, 5)."""

    turn: FloatArray
    spins: FloatArray


def predicted(slides: Slides, load: Load, half_side: float, slope: float = 0.0) -> Motion:
    """Return the motion of the slides under Coulomb's law from their first speeds and spins.

    ``half_side`` (m) belongs to the square of contact, and ``slope`` (rad) is the slope of the board down to the
    left.
    """
    mu = slides.of_constant("mean_mu")
    shift = mu * slides["height"]
    places = half_side * load.places - slides["offset"][:, None]
    state = np.array([slides["speed_first"], slides["spin_first"], slides["axis"]], dtype=complex)

    def rates(state: ComplexArray) -> ComplexArray:
        turned = places * np.exp(1j * state[2].real)[:, None]
        force, moment = friction(turned, load.shares, state[0], state[1].real, shift)
        speed_up = GRAVITY * (mu * force + 1j * slope)
        return np.array([speed_up, mu * GRAVITY * moment / slides["gyration"], state[1]])

    states = [state]
    while np.max(np.abs(states[-1][0])) > SLOWEST:
        y = states[-1]
        k1 = rates(y)
        k2 = rates(y + 0.5 * STEP * k1)
        k3 = rates(y + 0.5 * STEP * k2)
        k4 = rates(y + STEP * k3)
        step = STEP / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        # A slide that is already slow is complete; near rest its direction changes too fast for the steps.
        states.append(y + step * (np.abs(y[0]) > 0.5 * SLOWEST))
    velocities, spins, _ = np.moveaxis(np.array(states), 1, 0)
    seen = [seen_at(v, w) for v, w in zip(velocities.T, spins.real.T, strict=True)]
    return Motion(np.array([turn for turn, _ in seen]), np.array([spins for _, spins in seen]))


def seen_at(velocities: ComplexArray, spins: FloatArray) -> tuple[float, FloatArray]:
    """Return the turn (degrees) down to ``SLOWEST`` and the spins at ``SPEEDS``; NaN if it stays faster."""
    speeds = np.abs(velocities)
    until = slice(0, int(np.argmax(speeds < SLOWEST)) + 1 if np.any(speeds < SLOWEST) else None)
    directions = np.degrees(np.unwrap(np.angle(velocities[until])))
    at = -np.array([*SPEEDS, SLOWEST])
    found = [np.interp(at, -speeds[until], curve, right=np.nan) for curve in (spins[until], directions)]
    return float(found[1][-1] - directions[0]), found[0][:-1]


def box_turn(slides: Slides, turned: float = 0.0) -> FloatArray:
    """Return the turn (degrees) if friction is bounded by a box, in the axes of the record turned by ``turned`` rad.

    Both components of the velocity decrease at μg until they vanish, so their difference is constant. A pyramid with
    four sides is a box turned by 45 degrees, with √½ of its half width.
    """
    heading = slides["slip"] - turned
    x, y = (slides["speed_first"] * np.abs(part) for part in (np.cos(heading), np.sin(heading)))
    larger, gap = np.maximum(x, y), np.abs(x - y)
    left = np.where(gap >= SLOWEST, 0.0, 0.5 * (np.sqrt(np.maximum(2.0 * SLOWEST**2 - gap**2, 0.0)) - gap))
    before, after = np.arctan2(larger - gap, larger), np.arctan2(left, left + gap)
    sides = np.sign(np.cos(heading) * np.sin(heading)) * np.where(x >= y, 1.0, -1.0)
    return np.asarray(np.degrees(after - before) * sides)


def share_of(values: FloatArray, unit: FloatArray) -> tuple[float, float]:
    """Return the factor c of values ≈ c·unit by least squares, and its standard error from the scatter.

    The scatter may grow with ``unit``, as it does for spins.
    """
    factor = float(values @ unit / (unit @ unit))
    return factor, float(np.linalg.norm((values - factor * unit) * unit) / (unit @ unit))
