"""The self-centred equilibrium, and small deviations from it and from the whirl."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import Measurement, refined
from compare.claims.linearised_flow import real_and_imaginary
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.fig09.claims.searches import rests_of
from compare.studies.disc.fig09.claims.study import STUDY
from compare.studies.disc.fig09.theory import (
    CENTRED,
    DECAY,
    DISPLACED,
    GROWTHS,
    ORBIT_TOLERANCE,
    REST_LOADS,
    RING,
    circle_of,
    rest_of,
)
from compare.studies.toolkit.self_centred import with_load
from compare.studies.toolkit.steady_motion import mode_growth
from reference_model.steady.steady_states import SpinningEquilibrium, SpinningWhirl
from reference_model.systems import DiscOnDisc, FloatArray

FOLLOWED = (
    f"Half the difference of two simulations that start {DISPLACED:g} of the way from the axis to either side. "
    "Error: the change at a smaller tolerance, and with twice the deviation, which is three times what is not linear."
)


@STUDY.claim(
    "Place and spin of the self-centred disc are those of the balance of forces and moments, stable or not",
    equation="(19), (20)",
    resolution=1e-7,
    note="In units of X0 and ω. Measured: the state that the engine itself brings back.",
    basis="reference",
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = REST_LOADS) -> Measured:
    """Compare the equilibria with the balance of forces and moments."""
    found = rests_of(engine, RING, loads)
    exact = [rest_of(load) for load in loads]
    return Measured(
        predicted=[(one.x / RING.offset, one.y / RING.offset, one.spin / RING.disc_speed) for one in exact],
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        data={"rest load": loads, "rest": found.value},
    )


@STUDY.claim(
    "Small deviations from the equilibrium decay at a small μN and grow at larger ones, as its eigenvalues say",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-6,
    note=f"Over {', '.join(f'{duration:g}' for _, duration in GROWTHS)} s. Not in the paper, which has this "
    "equilibrium stable at every speed: that of the pin is. The friction of a ring grows with its slip, which on a "
    f"master disc faster than k drives the disc around more than β damps it. {FOLLOWED}",
    basis="reference",
    swept=("friction_force",),
)
def deviations_grow(engine: Engine) -> Measured:
    """Compare the growth of deviations from the equilibrium with its slowest eigenvalue."""
    loads = [load for load, _ in GROWTHS]
    motions = [(with_load(RING, load), rest_of(load), duration) for load, duration in GROWTHS]
    found = _growth(engine, motions, [DISPLACED * RING.offset * np.eye(6)[0]] * len(motions))
    return Measured(
        predicted=real_and_imaginary([rest_of(load).eigenvalues[0] for load in loads]),
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("real part", "imaginary part"),
    )


@STUDY.claim(
    "A disc beside the whirl approaches it at the rate of the slowest eigenvalue",
    equation="(19), (20)",
    unit="1/s",
    resolution=1e-6,
    note=f"Over {DECAY[1]:g} s. X0 = 0 here. {FOLLOWED}",
    basis="reference",
    swept=("friction_force",),
)
def whirl_attracts(engine: Engine) -> Measured:
    """Compare the decay of a deviation from the whirl with its slowest eigenvalue."""
    load, duration = DECAY
    circle = circle_of(load, 0)
    larger = DISPLACED * np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]) * circle.state
    found = _growth(engine, [(with_load(CENTRED, load), circle, duration)], [larger])
    return Measured(
        predicted=real_and_imaginary([circle.eigenvalues[1]]),  # the first is that of a turn about the axis
        value=found.value,
        error=found.error,
        at={"μN in N": [load]},
        components=("real part", "imaginary part"),
        system=CENTRED,
    )


def _growth(
    engine: Engine,
    motions: Sequence[tuple[DiscOnDisc, SpinningEquilibrium | SpinningWhirl, float]],
    displacements: Sequence[FloatArray],
) -> Measurement:
    """Return real and imaginary part in 1/s of the growth of each displacement from a motion, followed so long."""

    def rates(tolerance: float, scale: float = 1.0) -> FloatArray:
        return real_and_imaginary(
            [
                mode_growth(engine, disc, motion, scale * displacement, duration, tolerance)
                for (disc, motion, duration), displacement in zip(motions, displacements, strict=True)
            ]
        )

    found = refined(rates, ORBIT_TOLERANCE)
    # Two flows may be the same to within the tolerance: an error of the deviation of that size.
    unseen = [[ORBIT_TOLERANCE / (DISPLACED * duration)] for _, _, duration in motions]
    with_larger = found.plus(np.abs(rates(ORBIT_TOLERANCE, 2.0) - found.value))
    return Measurement(found.value, with_larger.rows + unseen)
