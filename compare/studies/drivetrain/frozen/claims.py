"""The car's drivetrain at frozen speeds: onset, self-centring, whirl on the stop, and where a whirl is modulated."""

from __future__ import annotations

from dataclasses import replace

from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.drivetrain.frozen.map import maps_of_modulation
from compare.studies.drivetrain.frozen.modulated import (
    BORDER_SURPLUS,
    BORDER_TORQUES,
    claim_of_border,
    claim_of_growth,
    claim_of_linearisation,
    modulated_whirl,
)
from compare.studies.drivetrain.frozen.onset import claim_of_linearised_drivetrain, claim_of_reference
from compare.studies.drivetrain.frozen.pictures import draw
from compare.studies.toolkit.drivetrain_bench import passenger_car
from compare.studies.toolkit.drivetrain_steady import claims_of_steady_motions, lines_of_reference


def measure(engine: Engine) -> Findings:
    """Linearise and run the car's drivetrain at frozen speeds."""
    car = replace(passenger_car(), unbalance=0.0)
    centred = replace(car, offset=0.0)
    steady, data = claims_of_steady_motions(engine.name, car)
    balance, motion = modulated_whirl(engine.name, centred)
    claims = (
        claim_of_linearised_drivetrain(engine.name, centred),
        *steady,
        claim_of_linearisation(engine.name, centred),
        claim_of_border(engine.name, centred),
        claim_of_growth(engine.name, centred),
        balance,
    )
    return Findings(claims, data | motion)


def theory() -> Findings:
    """Find the onset with the reference, the lines of the figures, and where whirls are modulated."""
    car = replace(passenger_car(), unbalance=0.0)
    centred = replace(car, offset=0.0)
    return Findings((claim_of_reference(centred),), lines_of_reference(car) | maps_of_modulation(centred))


MODULATED_ABOVE = (
    f"{100.0 * BORDER_SURPLUS:g} % too much load, it is modulated above "
    f"{{border at {BORDER_TORQUES[-1]:g} N m, 4 digits}} turns a minute at a torque of {BORDER_TORQUES[-1]:g} N "
    f"m, and above {{border at {BORDER_TORQUES[0]:g} N m, 4 digits}} at {BORDER_TORQUES[0]:g} N m"
)
"""Of a whirl within the play."""

STUDY = Study(
    name="drivetrain-frozen",
    title="The clutch of a car at frozen speeds",
    section="The drivetrain",
    paper="The paper's disc turns on a shaft of constant speed behind a damper. In a car it hangs between an engine, "
    "which it slows down, and a torsional spring, and its support has a stop. While the motion is steady, that is "
    "the paper's disc all the same: what the paper calls self-centring, loss of stability and limit cycle with large "
    "displacements must be found where the reference finds them for the reduced disc. While it is not, the inertia "
    "of engine and vehicle counts, so that the modulation of a whirl is a matter of the whole drivetrain: within "
    f"the play, with {MODULATED_ABOVE}.",
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "drivetrain-steady": "On a bench that holds the flywheel's speed, 80 N m and 12 rad/s of slip. Left: where "
        "the disc rests below the onset: as the speed grows it moves from the shaft's axis along the paper's "
        "semicircle towards the engine's. Right: radius and frequency of the whirl above the onset, on the stop.",
        "drivetrain-map": "Eigenvalues of the whole drivetrain about the whirl of a clutch that is pressed more than "
        "its torque needs, from the reference's law of friction. Red: the modulation grows; blue: it decays; white: "
        "no whirl keeps the clutch from locking up; black line: the whirl reaches the stop. The star marks "
        "the whirl of the next figure.",
        "drivetrain-modulated": "The modulated whirl of the star: it starts 20 % outside of the steady one. Its "
        "swing grows as in linear theory, until it is a cycle that rolls on the stop, falls off it and rests near "
        "the axis in between.",
    },
    only=("exudyn",),
    finding="A whirl can keep a clutch slipping whose load is more than its torque needs. Within the play of "
    f"the pilot bearing, with {MODULATED_ABOVE}.",
    seconds=6.0,
)
