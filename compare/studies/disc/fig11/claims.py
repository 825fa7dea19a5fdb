"""Fig. 11: the whirl whose radius and spin swell and shrink, how it comes about, and for which offsets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.claims.claim import Claim
from compare.claims.paper_parameters import FIG8
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.disc.fig11.cycle import (
    TIMES,
    UNTIL,
    measure_cycle,
    measure_six_points,
    predicted_modulation,
    shooting_claim,
    trajectory_claim,
)
from compare.studies.disc.fig11.growth import (
    EXPANSION,
    FOLLOWED,
    departure,
    growth_claims,
    stability_claims,
    steady_whirl,
)
from compare.studies.disc.fig11.offset import BOTH_STABLE, OFFSETS, measure_offsets, theory_of_offsets
from compare.studies.disc.fig11.pictures import draw
from compare.studies.toolkit.fig11_motion import DISCS, RING, SIX, START, integrated
from reference_model import simulate


def measure(engine: Engine, offsets: Sequence[float] = OFFSETS) -> Findings:
    """Measure what ``engine`` simulates of it: the disc on the continuous ring, on six points, or on both.

    ``offsets`` are the X0 in m of the long simulations.
    """
    claims: list[Claim] = []
    data: Data = {}
    for words, disc in DISCS.items():
        if engine.simulates(disc):
            claims += [trajectory_claim(engine, words, disc), *growth_claims(engine, words, disc)]
            times, sizes = departure(engine, disc, steady_whirl(disc), FOLLOWED)
            data |= {f"{words}: departure": np.column_stack((times, sizes))}
    if engine.simulates(RING):
        cycle, ends = measure_cycle(engine), measure_offsets(engine, offsets)
        claims += [*cycle.claims, *ends.claims]
        data |= cycle.data | ends.data
    if engine.simulates(SIX):
        six = measure_six_points(engine)
        claims += six.claims
        data |= six.data
    return Findings(tuple(claims), data, engine.lacking(DISCS.values()))


def theory() -> Findings:
    """Compare the laws of friction by their whirls, and compute what the figures need of the formulas."""
    whirls = [*(steady_whirl(disc) for disc in DISCS.values()), steady_whirl(RING, EXPANSION)]
    offsets = theory_of_offsets()
    return Findings(
        (shooting_claim(), *stability_claims(), *offsets.claims),
        {
            "eigenvalues": np.array([(whirl.eigenvalue.real, whirl.eigenvalue.imag) for whirl in whirls]),
            "whirls": np.array([(whirl.radius, whirl.state[-1]) for whirl in whirls]),
            "modulation": predicted_modulation()[0],
            "cycle": integrated(RING, START, UNTIL, len(TIMES), 1e-12),
            "(23)": simulate(RING, START, TIMES, tolerance=1e-8, contact=EXPANSION).states,
            **offsets.data,
        },
    )


STUDY = Study(
    name="fig11",
    title="The modulated cycle",
    section="The friction disc",
    finding="Fig. 11's whirl is unstable, and its modulated cycle takes over, only for offsets X0 from zero to "
    "{critical offset, mm, 3 digits} mm. Without an offset a deviation in which radius and spin swing together "
    "grows at {rate of growth on the continuous ring, 3 digits} 1/s. "
    f"With the {FIG8.offset:g} m of the other figures the disc comes to rest in space.",
    paper="Where the large whirl of the disc is unstable, radius and spin swell and shrink slowly, as Fig. 11 shows "
    "for one set of parameters. The paper leaves out the offset X0 and the initial conditions, and the analysis of "
    "stability, which would go beyond the limits of the article.\n\n"
    "Without offset the whirl is a fixed point in axes that turn with it. On the continuous ring a pair of its "
    "eigenvalues has a positive real part, {rate of growth on the continuous ring, 3 digits} 1/s; on the paper's six "
    "points it is {rate of growth on six points, 3 digits} 1/s. By (23) the pair is stable: the simplified equations "
    "would not have shown Fig. 11. What the disc tends to is periodic but for a turn about the axis, with a "
    "modulation of {period of the modulation, 4 digits} s, or {turn in it, turns, 3 digits} turns, a little "
    "longer on six points. There single points come to rest for a moment, whenever slip and rim speed become "
    "equal and one of them is at the right place, and the disc turns about them.\n\n"
    "An offset quenches the modulation. Below X0 = {critical offset, 3 digits} m, a third of μN/C, the whirl is "
    "unstable. There the modulation does not shrink to nothing but ends by a jump, a little above: at "
    f"{BOTH_STABLE:g} m steady whirl and modulated motion are both stable. Beyond, the whirl is steady, shrinks, and "
    "ends in a fold, about where the self-centred equilibrium becomes stable. So Fig. 11 needs an offset of at most "
    f"about {BOTH_STABLE:g} m, such as zero; with the {FIG8.offset:g} m of the other figures the disc comes to "
    "rest in space. It can not stick for ever at any offset, because μN·R is smaller than b|ω − Ω|.",
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "fig11-history": "Above: Fig. 11 redrawn, spin heavy and black, 20·x thin and green, X0 = 0, from the "
        "first engine. Below: the spin alone; marks: other engines. Purple: single points rest, and the disc "
        "turns about them. From the same start the disc settles on a steady whirl by (23).",
        "fig11-section": "Left: lines of the modulated cycle on the continuous ring, which is periodic in axes "
        "that turn with its mean speed about the axis (the carrier), and the spectrum of the disc on six points. "
        "Right: radius and spin once a turn; the points lie on a closed curve, those of six points near one.",
        "fig11-growth": "Growth out of the whirl, X0 = 0: share of the unstable pair of modes in the deviation, "
        "beside the exponential of its eigenvalue.",
        "fig11-offset": "Least and greatest radius and spin in the end, over the offset, on the continuous ring. "
        "Lines: the periodic whirl by shooting and the self-centred equilibrium, dotted where unstable; where "
        "the least radius of the whirl is zero it passes through the axis. Dashed: the critical offsets.",
    },
    seconds=8.0,
)
