"""Steady motions of the clutch disc on the bench against those of the reference's reduced disc.

With the shaft's axis beside the engine's the disc comes to rest in space below the onset; with both on one line it
whirls on its stop above.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.parameters import at_each
from compare.claims.study import Data
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.drivetrain_bench import (
    BRAKE,
    RPM,
    SOURCE,
    Operation,
    centre,
    facings,
    onset_speed,
    parameters_of,
    start_disc,
)
from reference_model import SpinningEquilibrium, SpinningWhirl, self_centred_equilibria, whirls
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

RESTS = "Below the onset the clutch disc comes to rest in space where the reference's reduced disc does"
RADIUS = "Above it the clutch disc whirls on its stop on the circle of the reference's reduced disc"
FREQUENCY = "It whirls with the frequency of the reference's reduced disc"
SLIP = "At rest in space and in the whirl it slips as the reference's reduced disc does"

TORQUE, SLIPPING = 80.0, 12.0
"""N m and rad/s of the bench: about what the run-up has."""

BELOW, ABOVE = (1500.0, 2200.0, 2700.0), (3600.0, 4500.0, 6000.0)
"""Speeds in turns a minute."""

DECAYS, SEEN = 20.0, 5.0
"""Length of a run in decay times of its slowest mode, and how many of them before its end the rest is inferred."""

START = 3e-4
"""In m: from where a whirl starts, at rest and within the play."""

TOLERANCE = 1e-9

SAMPLE = 5e-4
"""In s."""

RINGS, FINER = 16, 24
"""Rings of the reference's annulus, and how many show their error."""


@dataclass(frozen=True)
class Settled:
    """Quantities of a steady motion that the bench has reached, each with its error; shape (n,)."""

    values: FloatArray
    errors: FloatArray


def operations(car: Drivetrain) -> tuple[tuple[Operation, ...], tuple[Operation, ...]]:
    """Return what the bench is set to below the onset, with the car's offset, and above, without."""
    return (
        tuple(Operation(speed * RPM, SLIPPING, TORQUE, car.offset) for speed in BELOW),
        tuple(Operation(speed * RPM, SLIPPING, TORQUE) for speed in ABOVE),
    )


def rest_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningEquilibrium:
    """Return the reference's equilibrium."""
    (equilibrium,) = self_centred_equilibria(operation.reduced(car), facings(car, rings))
    return equilibrium


def whirl_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningWhirl:
    """Return the reference's whirl."""
    (whirl,) = whirls(operation.reduced(car), facings(car, rings))
    return whirl


def settled(car: Drivetrain, operation: Operation, rate: float, start: complex, whirling: bool) -> Settled:
    """Return x, y and slip, or in a whirl radius, frequency and slip, when all that decays has.

    ``rate`` in 1/s is that of the slowest mode.
    """

    def run(tolerance: float) -> tuple[FloatArray, FloatArray]:
        model = operation.build(car)
        start_disc(model, start, 0j)
        motion = model.run(DECAYS / rate, sample_every=SAMPLE, tolerance=tolerance)
        z, velocity = centre(motion.disc), centre(motion.disc_velocity)
        shape = (np.abs(z), (velocity / z).imag) if whirling else (z.real, z.imag)
        return motion.times, np.column_stack((*shape, motion.slip))

    (times, found), (_, finer) = run(TOLERANCE), run(TOLERANCE / COARSENING)
    delay = SEEN / rate
    earlier = found[(times > times[-1] - 1.2 * delay) & (times <= times[-1] - delay)]
    rest = remaining_transient(earlier, found[-1], rate, delay)
    return Settled(found[-1], change_as_error(found[-1], finer[-1], alike=False) + rest)


def predicted_rest(car: Drivetrain, operation: Operation) -> Settled:
    """Return x, y and slip of the reference's equilibrium."""

    def values(rings: int) -> FloatArray:
        rest = rest_of(car, operation, rings)
        return np.array([rest.x, rest.y, operation.speed - rest.spin])

    return Settled(values(RINGS), np.abs(values(RINGS) - values(FINER)))


def predicted_whirl(car: Drivetrain, operation: Operation) -> Settled:
    """Return radius, frequency and slip of the reference's whirl."""

    def values(rings: int) -> FloatArray:
        whirl = whirl_of(car, operation, rings)
        return np.array([whirl.radius, whirl.frequency, operation.speed - whirl.spin])

    return Settled(values(RINGS), np.abs(values(RINGS) - values(FINER)))


def claims_of_steady_motions(engine: str, car: Drivetrain) -> tuple[tuple[Claim, ...], Data]:
    """Return what the bench says of rest and whirl, and what the figure shows of it."""
    car = replace(car, unbalance=0.0)
    centred = replace(car, offset=0.0)
    below, above = operations(car)
    rests, circles = [rest_of(car, each) for each in below], [whirl_of(car, each) for each in above]
    resting = [
        (
            settled(car, each, -rest.eigenvalues[0].real, complex(each.offset), False),
            predicted_rest(car, each),
        )
        for each, rest in zip(below, rests, strict=True)
    ]
    whirling = [
        (settled(centred, each, -whirl.eigenvalues[1].real, complex(START), True), predicted_whirl(car, each))
        for each, whirl in zip(above, circles, strict=True)
    ]

    def claim(sentence: str, runs: list[tuple[Settled, Settled]], place: slice | int, unit: str) -> Claim:
        speeds = BELOW if runs is resting else ABOVE if runs is whirling else (*BELOW, *ABOVE)
        predicted = np.array([each.values[place] for _, each in runs])
        return Claim(
            sentence,
            equation="",
            engine=engine,
            predicted=predicted,
            measured=[each.values[place] for each, _ in runs],
            budget=ErrorBudget(
                np.max([measured.errors[place] + each.errors[place] for measured, each in runs]),
                resolution=1e-7 * float(np.max(np.abs(predicted))),
            ),
            parameters=parameters_of(
                car,
                without=("offset",),
                offset=0.0 if runs is whirling else car.offset,
                torque=TORQUE,
                brake=BRAKE,
            ),
            source=SOURCE,
            unit=unit,
            note=f"At {at_each('speed', speeds)} turns a minute, {TORQUE:g} N m and {SLIPPING:g} rad/s of slip, "
            f"after {DECAYS:g} decay times of the slowest mode. Numerical error: the change at a smaller tolerance, "
            f"what is left of the transient by its change in the last {SEEN:g} decay times, and of the prediction "
            "the change with finer rings of the annulus; the largest counts for all, since one alone may be right by "
            "chance.",
        )

    claims = (
        claim(RESTS, resting, slice(0, 2), "m"),
        claim(RADIUS, whirling, 0, "m"),
        claim(FREQUENCY, whirling, 1, "rad/s"),
        claim(SLIP, [*resting, *whirling], 2, "rad/s"),
    )
    return claims, {
        "rest": np.array([(speed, *run.values) for speed, (run, _) in zip(BELOW, resting, strict=True)]),
        "whirl": np.array([(speed, *run.values) for speed, (run, _) in zip(ABOVE, whirling, strict=True)]),
    }


def lines_of_reference(car: Drivetrain) -> Data:
    """Return the reference's x, y at rest and radius, frequency of a whirl over the speed in turns a minute."""
    onset = onset_speed(car, SLIPPING, TORQUE) / RPM
    slow, fast = np.linspace(300.0, onset - 1.0, 40), np.linspace(onset + 5.0, 6200.0, 25)
    rests = [rest_of(car, Operation(speed * RPM, SLIPPING, TORQUE, car.offset)) for speed in slow]
    circles = [whirl_of(car, Operation(speed * RPM, SLIPPING, TORQUE)) for speed in fast]
    return {
        "onset": np.array(onset),
        "rest": np.array([(speed, each.x, each.y) for speed, each in zip(slow, rests, strict=True)]),
        "whirl": np.array(
            [(speed, each.radius, each.frequency) for speed, each in zip(fast, circles, strict=True)]
        ),
    }
