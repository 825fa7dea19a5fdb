"""Claims on steady motions of the drivetrain and the onset of its vibrations."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.linalg import eig, matrix_balance, norm
from scipy.optimize import brentq

import compare.studies.drivetrain.frozen.theory as theory
from compare.claims import COARSENING, WORKING, Measured, Measurement, change_as_error
from compare.engines import Engine
from compare.studies.drivetrain.frozen.theory import STUDY
from compare.studies.toolkit import drivetrain_bench as bench
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.drivetrain_bench import RPM, Operation, centre, centred_car, passenger_car
from reference_model.steady.stability import jacobian_without_angle
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain


# --- Onset speed, where the disc leaves the engine's axis

IN_WORDS = [f"{torque:g} N m and {slip:g} rad/s" for torque, slip in theory.CASES]

NAMED = {f"onset at {words}": i for i, words in enumerate(IN_WORDS)}

ONSET_NOTE = (
    "D = μN·∂F/∂U at U = 0, averaged over the facings, is the damping of small motions by friction; it turns with "
    "the flywheel. The onset is the zero of the real part of the radial eigenvalue over ω. Numerical error: "
    "rounding of that eigenvalue, from its condition number, divided by the slope."
)


@STUDY.claim(
    "According to Exudyn's linearisation of the whole drivetrain, the centred disc becomes unstable at "
    "ω = k(1 + β/D)",
    unit="rad/s",
    resolution=1e-9,
    note=ONSET_NOTE,
    named=NAMED,
)
def loses_stability(engine: Engine) -> Measured:
    """Let the car's flywheel turn freely in the linearisation."""
    from exudyn_models import build_drivetrain
    from exudyn_models.paper.linearisation import REGULARISATION
    from exudyn_models.solver.linear.matrices import state_matrix

    car = centred_car()

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        model = build_drivetrain(
            car,
            normal_load=car.normal_load(torque),
            regularisation=REGULARISATION,
            engine_speed=speed,
            gearbox_speed=speed - slip,
        )
        return state_matrix(model.mbs)

    return _onset_of(matrix)


@STUDY.claim(
    "According to the reference's eigenvalues of the reduced disc, the centred disc becomes unstable at "
    "ω = k(1 + β/D)",
    unit="rad/s",
    resolution=1e-9,
    note=ONSET_NOTE,
    named=NAMED,
)
def reduced_disc_loses_stability() -> Measured:
    car = centred_car()

    def matrix(speed: float, slip: float, torque: float) -> FloatArray:
        disc = Operation(speed, slip, torque).reduced(car)
        return jacobian_without_angle(disc, [0.0] * 5 + [speed - slip], bench.facings(car))

    return _onset_of(matrix)


def _onset_of(matrix: Callable[..., FloatArray]) -> Measured:
    car = centred_car()
    closed = [bench.onset_speed(car, slip, torque) for torque, slip in theory.CASES]
    found = [
        _onset(partial(matrix, slip=slip, torque=torque), near, bench.natural_frequency(car))
        for (torque, slip), near in zip(theory.CASES, closed, strict=True)
    ]
    measured, errors = np.transpose(found)
    return Measured(
        predicted=closed,
        value=measured,
        error=errors,
        at={"torque and slip": IN_WORDS},
        parameters=bench.parameters_of(car),
    )


def _onset(matrix: Callable[[float], FloatArray], near: float, frequency: float) -> tuple[float, float]:
    """Return the speed of zero real part of the eigenvalue nearest to ``frequency``, and its error."""

    def radial(speed: float) -> tuple[float, float]:
        balanced, _ = matrix_balance(matrix(speed))
        values, left, right = eig(balanced, left=True)
        i = int(np.argmin(np.abs(values - 1j * frequency)))
        condition = 1.0 / abs(np.vdot(left[:, i], right[:, i]))
        return float(values[i].real), len(values) * np.finfo(float).eps * float(norm(balanced)) * condition

    low, high = 0.98 * near, 1.02 * near
    speed = float(brentq(lambda speed: radial(speed)[0], low, high, xtol=1e-12))
    slope = (radial(high)[0] - radial(low)[0]) / (high - low)
    return speed, 2.0 * radial(speed)[1] / slope


# --- Steady motions on the bench: rest below the onset, whirl on the stop above it

NOTE = (
    f"At {theory.TORQUE:g} N m and {theory.SLIPPING:g} rad/s of slip, after {theory.DECAYS:g} decay times of the "
    "slowest mode. Numerical error: the change at a smaller tolerance, the remaining transient, judged by its "
    f"change in the last {theory.SEEN:g} decay times, and the change of the prediction with finer rings of the "
    "annulus. The largest error counts for all values, because a single small error may be a coincidence."
)


class Steady(NamedTuple):
    """A steady motion on the bench at ``speed`` (rpm), measured and predicted by the reference, shape (3,) each.

    The values are x, y (m), or radius (m) and frequency (rad/s) of a whirl, and the slip (rad/s).
    """

    speed: float
    found: Measurement
    predicted: Measurement


@STUDY.claim(
    "Below the onset, the clutch disc comes to rest in space at the position of the reference's reduced disc",
    unit="m",
    note=NOTE,
)
def rests(engine: Engine, below: tuple[float, ...] = theory.BELOW) -> Measured:
    motions = _motions(engine, below, whirling=False)
    data = {"rest": _shown(motions)}
    return _measured(motions, slice(0, 2), passenger_car().offset, components=("x", "y"), data=data)


@STUDY.claim(
    "Above the onset, the clutch disc whirls on its stop with the radius of the reference's reduced disc",
    unit="m",
    note=NOTE,
)
def radius(engine: Engine, above: tuple[float, ...] = theory.ABOVE) -> Measured:
    motions = _motions(engine, above, whirling=True)
    return _measured(motions, 0, 0.0, data={"whirl": _shown(motions)})


@STUDY.claim(
    "Above the onset, the clutch disc whirls at the frequency of the reference's reduced disc",
    unit="rad/s",
    note=NOTE,
)
def frequency(engine: Engine, above: tuple[float, ...] = theory.ABOVE) -> Measured:
    return _measured(_motions(engine, above, whirling=True), 1, 0.0)


@STUDY.claim(
    "At rest in space and in the whirl, the clutch disc has the slip of the reference's reduced disc",
    unit="rad/s",
    note=NOTE,
)
def slips(
    engine: Engine, below: tuple[float, ...] = theory.BELOW, above: tuple[float, ...] = theory.ABOVE
) -> Measured:
    motions = (*_motions(engine, below, whirling=False), *_motions(engine, above, whirling=True))
    return _measured(motions, 2, passenger_car().offset)


def _measured(motions: Sequence[Steady], place: slice | int, offset: float, **more: Any) -> Measured:
    predicted = np.array([one.predicted.value[place] for one in motions])
    changed = {"unbalance": 0.0, "offset": offset, "torque": theory.TORQUE, "brake": bench.BRAKE}
    return Measured(
        predicted=predicted,
        value=[one.found.value[place] for one in motions],
        error=np.max([one.found.error[place] + one.predicted.error[place] for one in motions]),
        resolution=1e-9 * float(np.max(np.abs(predicted))),
        at={"speed in rpm": [one.speed for one in motions]},
        parameters=bench.parameters_of(passenger_car(), without=("offset",), **changed),
        **more,
    )


def _shown(motions: Sequence[Steady]) -> FloatArray:
    return np.array([(one.speed, *one.found.value) for one in motions])


@functools.lru_cache(maxsize=4)
def _motions(engine: Engine, speeds: tuple[float, ...], whirling: bool) -> tuple[Steady, ...]:
    return tuple(_motion(speed, whirling) for speed in speeds)


def _motion(speed: float, whirling: bool) -> Steady:
    car = passenger_car()
    point = Operation(speed * RPM, theory.SLIPPING, theory.TORQUE, 0.0 if whirling else car.offset)

    def by_reference(rings: int) -> tuple[FloatArray, float]:
        if whirling:
            whirl = bench.whirl_of(car, point, rings)
            values = (whirl.radius, whirl.frequency, point.speed - whirl.spin)
            return np.array(values), -whirl.eigenvalues[1].real
        rest = bench.rest_of(car, point, rings)
        return np.array([rest.x, rest.y, point.speed - rest.spin]), -rest.eigenvalues[0].real

    (values, rate), (finer, _) = by_reference(bench.RINGS), by_reference(theory.FINER)
    found = _settled(car, point, rate, whirling=whirling)
    return Steady(speed, found, Measurement(values, np.abs(values - finer)))


def _settled(car: Drivetrain, operation: Operation, rate: float, *, whirling: bool) -> Measurement:
    """Return the values after all transients, with the decay rate (1/s) of the slowest mode."""

    def run(tolerance: float) -> tuple[FloatArray, FloatArray]:
        model = operation.build(car)
        bench.start_disc(model, complex(theory.START if whirling else operation.offset), 0j)
        motion = model.run(theory.DECAYS / rate, sample_every=theory.SAMPLE, tolerance=tolerance)
        z, velocity = centre(motion.disc), centre(motion.disc_velocity)
        shape = (np.abs(z), (velocity / z).imag) if whirling else (z.real, z.imag)
        return motion.times, np.column_stack((*shape, motion.slip))

    (times, found), (_, finer) = run(WORKING), run(WORKING / COARSENING)
    delay = theory.SEEN / rate
    earlier = found[(times > times[-1] - 1.2 * delay) & (times <= times[-1] - delay)]
    rest = remaining_transient(earlier, found[-1], rate, delay)
    return Measurement(found[-1], change_as_error(found[-1], finer[-1], alike=False) + rest)
