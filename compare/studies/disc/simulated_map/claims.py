"""The surroundings of Fig. 11 by simulation: what thousands of discs end in, under the stability map's curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.measured import Measured, answers_of
from compare.claims.paper_parameters import FIG11
from compare.claims.study import Study
from compare.studies.disc.simulated_map.parameters import (
    DAMPING,
    EVERY,
    GROWN,
    MARGIN,
    SHAFT_DAMPING,
    SIDE,
    START,
    UNDECIDED_IS_OPEN,
    UNTIL,
)
from compare.studies.disc.simulated_map.pictures import draw
from compare.studies.disc.simulated_map.theory import Ends, curves, discs, growth, simulated
from reference_model import onset_load

STUDY = Study.beside(
    __file__,
    "simulated-map",
    source=f"Fig. 11 with X0 = 0; β, b and the start {START} are ours",
    system=FIG11,
    only=("theory",),  # the plane is simulated by the ensemble of the reference alone
    seconds=2.0,
    words={"side": f"{SIDE}"},
)
STUDY.provides(figures=draw, curves=curves)


@STUDY.claim(
    "Motions that begin beside the axis come back to it where μN is below the onset, and leave it above",
    equation="(19)–(21)",
    note=f"Those within {MARGIN:g} of the onset's μN and those that stick are left out. By the compiled ensemble "
    f"to t = {UNTIL:g} s, which may leave one in a thousand undecided.",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def leaves_axis(ends: Ends | None = None) -> Measured:
    """Count the motions that stay at the axis where they should leave it, and the other way round."""
    from reference_model.ensemble import EndState

    ends = simulated() if ends is None else ends
    ratio = np.array([disc.friction_force / onset_load(disc) for disc in discs()]).reshape(ends.shape)
    asked = (np.abs(ratio - 1.0) > MARGIN) & (ends != EndState.STUCK)
    right = (ratio < 1.0) == (ends == EndState.SELF_CENTRED)
    return answers_of(
        right[asked],
        UNDECIDED_IS_OPEN * (ends[asked] == EndState.UNDECIDED),
        may_be_open=int(np.count_nonzero(asked)) // 1000,
        note=f"{np.count_nonzero(asked)} of {ends.size} discs.",
    )


@STUDY.claim(
    "No motion ends as a steady whirl that has had time to amplify a deviation by exp(15)",
    equation="(19)–(21)",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def no_unstable_whirl(ends: Ends | None = None) -> Measured:
    """Count the motions that end as a whirl that is unstable."""
    from reference_model.ensemble import EndState

    ends = simulated() if ends is None else ends
    rows = slice(EVERY // 2, None, EVERY)
    rates = np.array(
        [
            [growth(replace(FIG11, damping=beta, shaft_damping=b)) for beta in DAMPING[rows].tolist()]
            for b in SHAFT_DAMPING[rows].tolist()
        ]
    )
    unstable, left = rates * UNTIL > GROWN, ends[rows, rows]
    return answers_of(
        (left != EndState.WHIRL)[unstable],
        UNDECIDED_IS_OPEN * (left == EndState.UNDECIDED)[unstable],
        note=f"So it is of {np.count_nonzero(unstable)} of {rates.size} discs, each fifth in both directions: they "
        "have no other whirl.",
    )
