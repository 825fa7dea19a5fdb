"""Tosses of a cube: the recording of one toss, and the numbers that its free flights and its bounces yield."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

RATE = 148.0  # frames per second
HALF_SIDE = 0.0524  # m, stated by the authors
GRAVITY = 9.80  # m/s², in Philadelphia

FLAT = np.cos(np.radians(1.0))  # largest tilt from the resting cube
SETTLING = 2  # frames after the last larger tilt
AT_REST = 3e-4  # largest distance in m from the last place

CLEARANCE, ROUNDED = 2e-3, 5e-3  # m: height of a corner in flight, and about its radius
FLIGHT, RUN, WINDOW, CONTACT = 8, 4, 8, 4  # frames: flights, shorter ones, fits at a bounce, longest contact
OTHER_CORNER, MISS = 6e-3, 6e-4  # m: height of the other corners at a bounce, and its largest misfit
CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))


@dataclass(frozen=True, eq=False)
class Toss:
    """Recorded places (m), shape (n, 3), and attitudes, shape (n, 3, 3), of one toss."""

    number: int
    places: Array
    turns: Array

    @property
    def rest(self) -> int:
        """First frame of the cube at rest."""
        return last_of(np.linalg.norm(self.places[:, :2] - self.places[-1, :2], axis=1) > AT_REST)

    @property
    def flat(self) -> int:
        """First frame of the slide."""
        return last_of(self.turns[:, 2] @ self.turns[-1, 2] < FLAT) + SETTLING

    @property
    def axis(self) -> int:
        """Axis of the cube that is vertical at the end."""
        return int(np.argmax(np.abs(self.turns[-1, 2])))

    @property
    def sign(self) -> float:
        """1 if this axis points upwards, or -1."""
        return float(np.sign(self.turns[-1, 2, self.axis]))

    def flights(self, least: int) -> list[slice]:
        """Return the frames of each flight of at least ``least`` frames."""
        corners = np.min(CORNERS @ self.turns[:, 2].T, axis=0) * (HALF_SIDE - ROUNDED) - ROUNDED
        free = self.places[:, 2] + corners > self.places[-1, 2] - HALF_SIDE + CLEARANCE
        edges = np.flatnonzero(np.diff(np.concatenate(([0], free, [0]))))
        return [slice(a, b) for a, b in edges.reshape(-1, 2).tolist() if b - a >= least]


def last_of(bad: NDArray[np.bool_]) -> int:
    """Return the index after the last true element, 0 if there is none."""
    return int(np.flatnonzero(bad)[-1]) + 1 if bad.any() else 0


def least_squares(matrices: Sequence[Array], values: Sequence[Array]) -> tuple[Array, Array]:
    """Return the solution for groups of equations, and its standard errors from the scatter between groups.

    Groups with more than three times the median misfit are left out: something else touched the board.
    """
    used = np.ones(len(matrices), dtype=bool)
    for _ in range(10):
        matrix, value = (
            np.concatenate([group for group, use in zip(groups, used, strict=True) if use])
            for groups in (matrices, values)
        )
        found = np.linalg.lstsq(matrix, value)[0]
        left = [value - matrix @ found for matrix, value in zip(matrices, values, strict=True)]
        misfits = np.array([np.sqrt(np.mean(each**2)) for each in left])
        used = misfits < 3.0 * np.median(misfits)
    pulls = np.array([m.T @ each for m, each, use in zip(matrices, left, used, strict=True) if use])
    inverse = np.linalg.inv(matrix.T @ matrix)
    return found, np.sqrt(np.diag(inverse @ (pulls.T @ pulls) @ inverse))


def median(values: Array) -> tuple[float, float]:
    """Return the median and its standard error, by resampling."""
    draws = np.random.default_rng(1).choice(values, (1000, len(values)))
    return float(np.median(values)), float(np.median(draws, axis=1).std())


def flown(tosses: Sequence[Toss]) -> tuple[Array, Array]:
    """Return the scale of lengths and the centre of mass c (m, recorded), shape (4,), with standard errors.

    In free flight the place p and the attitude R obey p = p₀ + vt − scale·gt²/2 − Rc.
    """
    rows, values = [], []
    for toss in tosses:
        for flight in toss.flights(FLIGHT):
            t = np.arange(flight.stop - flight.start) / RATE
            line = np.column_stack((np.ones_like(t), t))
            rest = np.eye(len(t)) - line @ np.linalg.pinv(line)
            fall = np.zeros((len(t), 3, 1))
            fall[:, 2, 0] = -0.5 * GRAVITY * t**2
            unknowns = np.concatenate((fall, -toss.turns[flight]), axis=2)
            rows.append(np.einsum("ij,jkl->ikl", rest, unknowns).reshape(-1, 4))
            values.append((rest @ toss.places[flight]).ravel())
    if not rows:
        raise ValueError(f"no toss contains a free flight of {FLIGHT} frames, so the scale is unknown")
    return least_squares(rows, values)


class Bounce(NamedTuple):
    """Attitude, height of the geometric centre, and change of velocity and spin at one bounce on one corner."""

    turn: Array
    height: float
    kick: Array
    twist: Array

    @property
    def corner(self) -> Array:
        """Direction of the lowest corner in units of the half side."""
        corners = CORNERS @ self.turn.T
        return np.asarray(corners[np.argmin(corners[:, 2])])


def bounces(tosses: Sequence[Toss], scale: float, centre: Array) -> list[Bounce]:
    """Return the bounces on one corner between two flights."""
    found = []
    for toss in tosses:
        centres = toss.places / scale + toss.turns @ centre
        for before, after in pairwise(toss.flights(RUN)):
            middle = 0.5 * (before.stop - 1 + after.start)
            frames = slice(max(before.start, before.stop - WINDOW), before.stop)
            place, velocity, spin, turn = _flight(toss, centres, frames, middle)
            frames = slice(after.start, min(after.stop, after.start + WINDOW))
            apart, kick, twist, _ = _flight(toss, centres, frames, middle)
            apart, kick, twist = apart - place, kick - velocity, twist - spin
            delay = -float(apart @ kick / (kick @ kick))
            turn = Rotation.from_rotvec(spin * delay).as_matrix() @ turn
            heights = np.sort((CORNERS @ turn.T)[:, 2]) * HALF_SIDE
            alone = heights[1] - heights[0] > OTHER_CORNER and after.start - before.stop <= CONTACT
            if alone and np.linalg.norm(apart + kick * delay) < MISS and abs(delay) < 2.0 / RATE:
                height = place + velocity * delay - turn @ centre - toss.places[-1] / scale
                found.append(Bounce(turn, float(height[2]) + HALF_SIDE, kick, twist))
    return found


def _flight(toss: Toss, centres: Array, frames: slice, middle: float) -> tuple[Array, Array, Array, Array]:
    """Return place, velocity, spin and attitude at the frame ``middle``."""
    t = (np.arange(frames.start, frames.stop) - middle) / RATE
    line = np.linalg.pinv(np.column_stack((np.ones_like(t), t)))
    fallen = centres[frames] + 0.5 * GRAVITY * np.outer(t**2, (0.0, 0.0, 1.0))
    about = Rotation.from_matrix(toss.turns[(frames.start + frames.stop - 1) // 2])
    turned = (Rotation.from_matrix(toss.turns[frames]) * about.inv()).as_rotvec()
    (place, velocity), (angle, spin) = line @ fallen, line @ turned
    return place, velocity, spin, (Rotation.from_rotvec(angle) * about).as_matrix()


def corner_radius(found: Sequence[Bounce]) -> tuple[float, float]:
    """Return the radius (m) of a sphere in each corner that touches the board at the instants of the bounces."""
    steep = [(-bounce.corner[2], bounce.height) for bounce in found if bounce.corner[2] < -1.3]
    return median(np.array([(reach * HALF_SIDE - height) / (reach - 1.0) for reach, height in steep]))


def gyration(found: Sequence[Bounce], centre: Array, radius: float) -> tuple[Array, Array]:
    """Return κ² (m²) about each axis: the kick Δv at r changes the angular momentum, κ²·Δω = r × Δv."""
    below = np.array([0.0, 0.0, radius])
    arms = [bounce.corner * (HALF_SIDE - radius) - below - bounce.turn @ centre for bounce in found]
    moments = [np.cross(arm, bounce.kick) for arm, bounce in zip(arms, found, strict=True)]
    return least_squares([bounce.turn * (bounce.turn.T @ bounce.twist) for bounce in found], moments)


def board_slope(slides: Sequence[tuple[Toss, float]], scale: float, centre: Array) -> tuple[float, float]:
    """Return the mean slope (rad) across paths of a heading: gravity in flight against the resting cube."""
    found = []
    for toss, heading in slides:
        flight = max(toss.flights(RUN), key=lambda one: one.stop - one.start, default=slice(0, 0))
        if (frames := flight.stop - flight.start) > FLIGHT:
            centres = (toss.places / scale + toss.turns @ centre)[flight]
            fall = 2.0 * np.polyfit(np.arange(frames) / RATE, centres, 2)[0] / GRAVITY
            pull = fall + toss.turns[toss.rest :, :, toss.axis].mean(axis=0) * toss.sign
            across = pull[1] * np.cos(heading) - pull[0] * np.sin(heading)
            found.append((across, frames**2.5))  # inverse of the standard error
    values, weights = np.array(found).T
    mean = np.average(values, weights=weights**2)
    return float(mean), float(np.linalg.norm(weights**2 * (values - mean)) / np.sum(weights**2))
