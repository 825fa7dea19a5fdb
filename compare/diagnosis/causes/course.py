"""Friction during one long slide: a law that changes with the time after the start cannot be a law of the place."""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from compare.diagnosis.ladder import Ladder
from compare.diagnosis.laws import DISTINCT
from compare.diagnosis.probes import FRICTION, PLANE, SETTLES_FOR, SLIDE, WEAK
from compare.engines import Engine
from reference_model.systems import FloatArray

EDGES = np.array([0.0, 0.01, 0.02, SETTLES_FOR, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0])
"""Ends in s of the intervals; in the first three, a soft contact may not yet carry its load."""

SETTLED = int(np.flatnonzero(EDGES == SETTLES_FOR)[0])
SPEED = 2.0  # at the start in m/s; friction leaves more than half of it
STOPS = 0.2  # share of the speed below which a body may stop in an interval
LEAST = 1e-4  # smallest change of friction, over μN, that counts


@dataclass(frozen=True)
class Course:
    """Friction over μN in the intervals between ``EDGES``, and its errors, shape (9,); NaN after a stop."""

    shares: FloatArray
    errors: FloatArray


def course(engine: Engine) -> Course:
    """Return the friction on a block that slides for 4 s."""
    along = cmath.rect(1.0, 0.3)
    place, velocity = -0.5 * EDGES[-1] * (SPEED - 0.5 * FRICTION * EDGES[-1]) * along, SPEED * along
    start = (place.real, place.imag, velocity.real, velocity.imag)

    def question(tolerance: float) -> FloatArray:
        states = engine.simulate(SLIDE, start, EDGES, tolerance=tolerance).states
        lengths = np.diff(EDGES)
        z, v = ((pair @ PLANE) * np.conj(along) for pair in (states[:, :2], states[:, 2:]))
        springs = 0.5 * WEAK * (z[:-1] + z[1:]).real * lengths
        found = -(SLIDE.mass * np.diff(v).real + springs) / (FRICTION * lengths)
        return np.where(np.minimum.accumulate(v.real)[1:] > STOPS * SPEED, found, math.nan)

    ladder = Ladder.of(engine, question)
    noise = DISTINCT * engine.noise * SLIDE.mass * SPEED / (FRICTION * np.diff(EDGES))
    changes = np.max(np.abs(np.diff(ladder.values[-3:], axis=0)), axis=0)
    return Course(ladder.finest, DISTINCT * changes + noise)


def change_of(found: Course) -> str:
    """Describe how friction changes during the slide after the contact has settled, or return ""."""
    shares, errors = found.shares[SETTLED:], found.errors[SETTLED:]
    known = np.flatnonzero(np.isfinite(errors))
    if not known.size or np.ptp(shares[known]) <= DISTINCT * np.max(errors[known]) + LEAST:
        return ""
    ends = sorted(int(known[find(shares[known])]) for find in (np.argmin, np.argmax))
    said = [f"{shares[i]:.3g} times μN {_interval(SETTLED + i)} after the start" for i in ends]
    return (
        f"the friction force changes during a slide, with the time or the place: it is {' and '.join(said)}"
    )


def beginning_of(found: Course) -> str:
    """Describe friction that differs in the first moments of a slide, or return ""."""
    shares, errors = found.shares[:SETTLED], found.errors[:SETTLED]
    settled = (
        float(np.nanmedian(found.shares[SETTLED:])) if np.any(np.isfinite(found.shares[SETTLED:])) else 1.0
    )
    off = np.abs(shares - settled) > DISTINCT * errors + LEAST
    if not np.any(off):
        return ""
    i = int(np.argmax(off))
    how = "a contact that settles, or a law of time"
    return f"friction is {shares[i]:.3g} times μN {_interval(i)} after the start of a slide ({how})"


def _interval(number: int) -> str:
    return f"{EDGES[number]:g} to {EDGES[number + 1]:g} s"
