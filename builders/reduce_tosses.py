"""Reduce recorded tosses of a cube to one row per slide: ``python builders/reduce_tosses.py FILE --output TABLE``.

FILE contains the columns toss, frame, x_m, y_m, z_m, qw, qx, qy, qz and may be compressed by xz. The recordings are
those of S. Pfrommer, M. Halm and M. Posa (ContactNets, CoRL 2020); the project contains only the table.

Three parts of a toss give independent numbers. The free flight yields the scale of lengths (from gravity), the centre
of mass and, with the resting cube, the slope of the board. Bounces on one corner yield the radius of the corners and
the inertia. Only the slide to rest yields the rows. Frames may be turned about the vertical, so no number depends on
an axis of the board. A slide is fitted by polynomials in time; the scatter of frames at rest, propagated through the
fit, is the error of each number.
"""

import argparse
import lzma
import sys
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation
from toss_flights import (
    GRAVITY,
    RATE,
    SETTLING,
    Array,
    Toss,
    board_slope,
    bounces,
    corner_radius,
    flown,
    gyration,
    last_of,
    median,
)

Constants = dict[str, tuple[float, float]]
"""Values and standard errors."""

SOURCE = """\
# Measured slides of a tossed cube, reduced by builders/reduce_tosses.py from recordings of the repository
# DAIRLab/contact-nets, commit c3dc21c9, folder data/tosses_processed (S. Pfrommer, M. Halm, M. Posa, 2020).
# Copyright (c) 2020, Dynamic Autonomy and Intelligent Robotics Lab. Licence of the recordings and of this table:
# BSD-3-Clause (https://opensource.org/license/bsd-3-clause), without warranty.
"""
MEANING = """\
# centre: of mass, relative to the recorded place. gyration: squared radius of gyration. slope: of the board, downward
# to the left of the path. up: axis of the cube that points upwards. slip_deg: direction of slip at the first speed,
# in a frame that may be turned at random. axis_deg: heading of the cube's z axis, or of its x axis if z is vertical,
# relative to slip_deg. mu: mean deceleration over g to 0.12 m/s; mu_fast above and mu_slow below 0.24 m/s. turn: of
# the direction of slip, positive to the left. spin_left: at 0.2 m/s, over the first spin. spin_30: at 0.30 m/s.
# Units: m/s, rad/s, degrees. A row's error is the scatter of frames at rest, propagated through the fit.
"""

COLUMNS = "toss,frame,x_m,y_m,z_m,qw,qx,qy,qz"

LEAST_AT_REST = 4  # frames
FASTEST, SLOWEST, UNTIL = 0.35, 0.12, 0.06  # m/s: least initial speed, last speed used, end of the fit
MIDDLE = 0.24  # m/s, between mu_fast and mu_slow
SPEEDS = (0.30, 0.25, 0.20, 0.16, 0.12)  # m/s, of the columns spin_30 to spin_12
LEAST_SPIN = 0.5  # rad/s, for spin_left
DEGREE = 4
FILTERS = {
    "rest": f"fewer than {LEAST_AT_REST} frames at rest",
    "fast": f"slower than {FASTEST:g} m/s when {SETTLING} frames have passed since the last tilt above 1 degree",
}


def read(path: Path) -> list[Toss]:
    """Return the tosses of a file; raise ``ValueError`` for an invalid line, ``OSError`` if it cannot be read."""
    raw = path.read_bytes()
    try:
        lines = (lzma.decompress(raw) if path.suffix == ".xz" else raw).decode().splitlines()
    except (lzma.LZMAError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: {error}") from None
    if not lines or lines[0] != COLUMNS:
        raise ValueError(f"{path}, line 1: expected the columns {COLUMNS}")
    rows = []
    for i, line in enumerate(lines[1:], 2):
        try:
            row = np.array([float(word) for word in line.split(",")])
        except ValueError:
            row = np.empty(0)
        if row.shape != (9,) or not np.isfinite(row).all() or abs(np.linalg.norm(row[5:]) - 1.0) > 1e-3:
            raise ValueError(f"{path}, line {i}: expected nine numbers, the last four a unit quaternion")
        rows.append(row)
    found = []
    for number, group in groupby(rows, lambda row: row[0]):
        own = np.array(list(group))
        if np.any(np.diff(own[:, 1]) != 1.0):
            raise ValueError(f"{path}: frames of toss {number:g} are missing or not in order")
        found.append(Toss(int(number), own[:, 2:5], Rotation.from_quat(own[:, [6, 7, 8, 5]]).as_matrix()))
    return found


class Fit(NamedTuple):
    """Polynomials of x, y (m) and heading (rad): coefficients, shape (3, n), and covariance of unit errors.

    ``slopes`` contains the derivatives of the powers at ``times``.
    """

    coefficients: Array
    covariance: Array
    times: Array
    slopes: Array
    frames: int

    @classmethod
    def of(cls, curves: Array) -> "Fit":
        """Return the fit of x, y and heading at successive frames, shape (frames, 3)."""
        t = np.arange(len(curves)) / RATE
        inverse = np.linalg.pinv(np.vander(t, DEGREE + 1, increasing=True))
        times = np.linspace(0.0, t[-1], 30 * len(t))
        slopes = np.column_stack([i * times ** max(i - 1, 0) for i in range(DEGREE + 1)])
        return cls((inverse @ curves).T, inverse @ inverse.T, times, slopes, len(t))

    def rates(self, coefficients: Array) -> tuple[Array, Array, Array]:
        """Return speed (m/s), direction of slip (rad, continuous) and spin (rad/s) at ``times``."""
        vx, vy, spin = (self.slopes @ coefficients.T).T
        return np.hypot(vx, vy), np.unwrap(np.arctan2(vy, vx)), spin

    def numbers(self, coefficients: Array) -> Array:
        """Return the numbers of ``WITH_ERROR`` and ``SPINS``."""
        speed, direction, spin = self.rates(coefficients)

        def at(value: float, curve: Array) -> float:
            return float(np.interp(-value, -speed, curve))

        def deceleration(fast: float, slow: float) -> float:
            return (fast - slow) / (at(slow, self.times) - at(fast, self.times)) / GRAVITY

        first = float(speed[0])
        spins = [float(spin[0]), *(at(value, spin) for value in SPEEDS)]
        decelerations = [deceleration(*way) for way in ((first, SLOWEST), (first, MIDDLE), (MIDDLE, SLOWEST))]
        turn = np.degrees(at(SLOWEST, direction) - direction[0])
        return np.array([*decelerations, turn, at(0.20, spin) / spin[0], *spins])

    def with_errors(self, noise: Array) -> tuple[Array, Array]:
        """Return the numbers and their standard errors for the ``noise`` of x, y and heading."""
        value = self.numbers(self.coefficients)
        steps = [
            np.outer(unit, size * vector)
            for unit, size in zip(np.eye(3), noise, strict=True)
            for vector in np.linalg.cholesky(self.covariance).T
        ]
        changes = [self.numbers(self.coefficients + step) - value for step in steps]
        return value, np.linalg.norm(changes, axis=0)


WITH_ERROR = ("mu", "mu_fast", "mu_slow", "turn", "spin_left")
SPINS = ("spin_first", *(f"spin_{100 * speed:.0f}" for speed in SPEEDS))
NAMES = (
    *("toss", "frames", "up", "slip_deg", "axis_deg", "speed_first"),
    *(column for name in WITH_ERROR for column in (name + "_deg" * (name == "turn"), f"{name}_error")),
    *(*SPINS, "spin_error"),
)

Row = dict[str, float | int | str]


def fitted(toss: Toss, scale: float, centre: Array) -> Fit | str:
    """Return the fit of the slide, or the name of the filter that removes the toss."""
    if len(toss.places) - toss.rest < LEAST_AT_REST:
        return "rest"
    centres = (toss.places / scale + toss.turns @ centre)[:, :2]
    chords = np.linalg.norm(centres[4:] - centres[:-4], axis=1) * RATE / 4.0  # speeds at frames 2, 3, ...
    slide = slice(toss.flat, last_of(chords > UNTIL) + 2)
    if slide.stop - slide.start < 2 * DEGREE:
        return "fast"
    turns = Rotation.from_matrix(toss.turns[slide])
    headings = np.unwrap((turns * turns[0].inv()).as_rotvec()[:, 2])
    found = Fit.of(np.column_stack((centres[slide], headings)))
    speed = found.rates(found.coefficients)[0]
    return found if speed[0] >= FASTEST and speed[-1] <= SLOWEST else "fast"


def noise_at_rest(tosses: Sequence[Toss], scale: float) -> Array:
    """Return the standard deviation of x, y (m) and heading (rad) of one frame, from successive frames at rest."""
    steps = []
    for toss in tosses:
        turns = Rotation.from_matrix(toss.turns[toss.rest :])
        headings = (turns * turns[0].inv()).as_rotvec()[:, 2]
        steps.append(np.diff(np.column_stack((toss.places[toss.rest :, :2] / scale, headings)), axis=0))
    x, y, heading = np.sqrt(np.mean(np.concatenate(steps) ** 2, axis=0) / 2.0)
    place = np.hypot(x, y) / np.sqrt(2.0)
    return np.array([place, place, heading])


def row_of(toss: Toss, found: Fit, noise: Array) -> Row:
    """Return the row of a slide."""
    values, errors = found.with_errors(noise)
    speed, direction, _ = found.rates(found.coefficients)
    x, y = toss.turns[toss.flat, :2, 0 if toss.axis == 2 else 2]
    numbers: list[float | int | str] = [toss.number, found.frames, "-" * (toss.sign < 0) + "xyz"[toss.axis]]
    axis = np.angle(complex(x, y) * np.exp(-1j * direction[0]))
    numbers += [np.degrees(direction[0]), np.degrees(axis), speed[0]]
    for name, value, error in zip(WITH_ERROR, values, errors, strict=False):
        known = name != "spin_left" or abs(values[len(WITH_ERROR)]) >= LEAST_SPIN
        numbers += [value, error] if known else ["", ""]
    spins = slice(len(WITH_ERROR), None)
    numbers += [*values[spins], np.sqrt(np.mean(errors[spins] ** 2))]
    return dict(zip(NAMES, numbers, strict=True))


def reduce(tosses: Sequence[Toss]) -> tuple[list[Row], list[str]]:
    """Return the rows of the table, and comments with constants; raise ``ValueError`` if there is no slide."""
    (scale, *centre), (scale_error, *centre_error) = flown(tosses)
    c = np.array(centre) / scale
    found = [(toss, fitted(toss, scale, c)) for toss in tosses]
    slides = [(toss, fit) for toss, fit in found if isinstance(fit, Fit)]
    if not slides:
        raise ValueError(f"none of {len(tosses)} tosses ends with a slide from above {FASTEST:g} m/s")
    noise = noise_at_rest(tosses, scale)
    rows = [row_of(*slide, noise) for slide in slides]
    hit = bounces(tosses, scale, c)
    if len(hit) < 3:
        raise ValueError(f"{len(hit)} bounces on one corner are too few to find the inertia")
    radius, radius_error = corner_radius(hit)
    squares, errors = gyration(hit, c, radius)
    for other in ((c, radius + radius_error), (c + np.array(centre_error) / scale, radius)):
        errors = np.hypot(errors, gyration(hit, *other)[0] - squares)
    headings = np.radians([row["slip_deg"] for row in rows])
    slope = board_slope([(toss, h) for (toss, _), h in zip(slides, headings, strict=True)], scale, c)
    constants: Constants = {"length_scale": (scale, scale_error)}
    for axis, i in zip("xyz", range(3), strict=True):
        constants[f"centre_{axis}_mm"] = 1e3 * c[i], 1e3 * centre_error[i] / scale
        constants[f"gyration_{axis}_mm2"] = 1e6 * squares[i], 1e6 * errors[i]
    constants["corner_radius_mm"] = 1e3 * radius, 1e3 * radius_error
    constants["slope_mrad"] = 1e3 * slope[0], 1e3 * slope[1]
    share = len(rows) / len(tosses)
    constants["slides_per_toss"] = share, float(np.sqrt(share * (1.0 - share) / len(tosses)))
    constants |= summary(rows)
    removed = [fit for _, fit in found if isinstance(fit, str)]
    return rows, [
        f"# {len(tosses)} tosses, {len(rows)} slides, {len(hit)} bounces on one corner",
        *(f"# - {removed.count(name)} tosses removed: {why}" for name, why in FILTERS.items()),
        f"# noise of a frame at rest: {1e3 * noise[0]:.3f} mm, {1e3 * noise[2]:.2f} mrad",
        *(f"# {name} = {value:.6g} +- {error:.2g}" for name, (value, error) in constants.items()),
    ]


def summary(rows: Sequence[Row]) -> Constants:
    """Return the numbers that other tosses should reproduce."""
    mu, turns = (np.array([row[name] for row in rows], dtype=float) for name in ("mu", "turn_deg"))
    left = np.array([row["spin_left"] for row in rows if row["spin_left"] != ""], dtype=float)
    scatters = np.random.default_rng(2).choice(mu, (1000, len(mu))).std(axis=1)
    return {
        "mean_mu": (float(mu.mean()), float(mu.std() / np.sqrt(len(mu)))),
        "scatter_of_mu": (float(mu.std()), float(scatters.std())),
        "median_turn_deg": median(np.abs(turns)),
        **({"median_spin_left": median(left)} if left.size else {}),
    }


def table(rows: Sequence[Row], comments: Sequence[str]) -> Iterator[str]:
    """Yield the lines of the table, with the comments above it."""
    yield from (SOURCE + "".join(f"{line}\n" for line in comments) + MEANING).splitlines()
    yield ",".join(NAMES)
    for row in rows:
        yield ",".join(
            f"{row[name]:.4f}" if isinstance(row[name], float) else str(row[name]) for name in NAMES
        )


def main(arguments: list[str]) -> int:
    """Reduce a file; return the exit status."""
    parser = argparse.ArgumentParser(description="Reduce recorded tosses of a cube to a table of slides.")
    parser.add_argument(
        "file", type=Path, metavar="FILE", help="CSV file of recordings; may be compressed by xz"
    )
    parser.add_argument("--output", type=Path, metavar="TABLE", required=True, help="table to write")
    options = parser.parse_args(arguments)
    try:
        rows, comments = reduce(read(options.file))
        options.output.write_text("\n".join([*table(rows, comments), ""]), encoding="utf-8")
    except (ValueError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    print(*comments, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
