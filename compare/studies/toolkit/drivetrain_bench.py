"""Clutch of a passenger car on a bench, and the equivalent disc of the reference.

The bench holds the flywheel's speed, and a brake b·(Ω_v − Ω) the vehicle's. In steady motion the torque of the
torsional spring is constant, so the clutch disc obeys (19) with b and Ω of the brake.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims import Measured, change_as_error
from compare.claims.linearised_flow import ComplexArray
from reference_model import Annulus, DiscOnDisc, self_centred_equilibria, whirls
from reference_model.steady.steady_states import SpinningEquilibrium, SpinningWhirl
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain, DrivetrainModel, EnergyBalance


SOURCE = "passenger car of exudyn_models.drivetrain.parameters; torque and slip are assumed"

RPM = math.pi / 30.0

BRAKE, HELD = 100.0, 1e18
"""b of the brake in N m s/rad; inertia in kg m² of a flywheel that 100 N m slow by only 1e-16 rad/s in 1 s."""

EPSILON = 1e-3
"""ε in m/s; the facings slip a thousand times faster, so friction is Coulomb's."""


def passenger_car() -> Drivetrain:
    """Return the car's parameters; importing Exudyn is deferred."""
    from exudyn_models import PASSENGER_CAR

    return PASSENGER_CAR


def centred_car() -> Drivetrain:
    """Return the car without unbalance and offset."""
    return replace(passenger_car(), offset=0.0, unbalance=0.0)


def parameters_of(
    car: Drivetrain, *, without: Collection[str] = (), **changes: float
) -> dict[str, float | str]:
    """Return the parameters of ``car`` except those in ``without``; ``changes`` adds or replaces some."""
    return {name: value for name, value in asdict(car).items() if name not in without} | changes


def facings(car: Drivetrain, rings: int = 16) -> Annulus:
    return Annulus(car.inner_radius, car.outer_radius, rings)


def rotating_damping(car: Drivetrain, slip: float, torque: float) -> float:
    """Return the damping D (N s/m) that friction exerts on small motions of the disc's centre.

    D = μN·∂F/∂U at U = 0, with the μN that transmits ``torque`` (N m) at ``slip`` (rad/s): the paper's μN/(2W),
    averaged over the facings.
    """
    return torque / car.friction_radius * facings(car).slopes(0.0, slip).resistance_by_slip


def natural_frequency(car: Drivetrain) -> float:
    """Return k in rad/s."""
    return math.sqrt(car.radial_stiffness / car.disc_mass)


def onset_speed(car: Drivetrain, slip: float, torque: float) -> float:
    """Return the stability limit ω = k·(1 + β/D) in rad/s; above it the disc leaves the engine's axis."""
    return natural_frequency(car) * (1.0 + car.radial_damping / rotating_damping(car, slip, torque))


@dataclass(frozen=True)
class Operation:
    """Operating point: speed of the flywheel and slip (rad/s), transmitted torque (N m) and X0 (m)."""

    speed: float
    slip: float
    torque: float
    offset: float = 0.0

    @property
    def brake_speed(self) -> float:
        """Ω of the brake (rad/s)."""
        return self.speed - self.slip - self.torque / BRAKE

    def reduced(self, car: Drivetrain) -> DiscOnDisc:
        """Return the disc of (19) that is equivalent to the clutch disc in steady motion."""
        return DiscOnDisc(
            mass=car.disc_mass,
            polar_inertia=car.disc_inertia + car.vehicle_inertia,
            stiffness=car.radial_stiffness,
            damping=car.radial_damping,
            stop_gap=car.stop_gap,
            stop_stiffness=car.stop_stiffness,
            friction_force=self.torque / car.friction_radius,
            disc_speed=self.speed,
            contact_radius=car.outer_radius,
            shaft_damping=BRAKE,
            shaft_speed=self.brake_speed,
            offset=self.offset,
        )

    def build(self, car: Drivetrain) -> DrivetrainModel:
        """Return the drivetrain on the bench without unbalance."""
        from exudyn_models import build_drivetrain

        return build_drivetrain(
            replace(car, engine_inertia=HELD, unbalance=0.0, offset=self.offset),
            normal_load=car.normal_load(self.torque),
            regularisation=EPSILON,
            engine_speed=self.speed,
            gearbox_speed=self.speed - self.slip,
            vehicle_torque=lambda time, angle, speed: -BRAKE * (speed - self.brake_speed),
            shaft_torque=self.torque,
        )


def balance_of(balances: Sequence[EnergyBalance], parameters: Mapping[str, float | str]) -> Measured:
    """Return the relative residual of the first balance; the second, at a smaller tolerance, gives its error."""
    found, finer = (np.max(np.abs(each.residual)) / each.turnover for each in balances)
    return Measured(
        predicted=0.0,
        value=found,
        error=change_as_error(found, finer),
        parameters=parameters,
        note="Largest difference between gains, losses and the growth of stored energy, relative to the energy "
        f"turned over, {balances[0].turnover:.3g} J. Numerical error: the change at a smaller tolerance.",
    )


def start_disc(model: DrivetrainModel, place: complex, velocity: complex) -> None:
    """Set the initial position (m) and velocity (m/s) of the disc's centre."""
    import exudyn as exu

    data: Any = model.mbs.systemData
    initial = exu.ConfigurationType.Initial
    first = model.mbs.GetNodeODE2Index(model.disc)
    for read, write, value in (
        (data.GetODE2Coordinates, data.SetODE2Coordinates, place),
        (data.GetODE2Coordinates_t, data.SetODE2Coordinates_t, velocity),
    ):
        coordinates = read(configuration=initial)
        coordinates[first : first + 2] = value.real, value.imag
        write(coordinates, configuration=initial)


def centre(disc: FloatArray) -> ComplexArray:
    """Return x + iy of coordinates or velocities, shape (n,) from (n, 3)."""
    return np.asarray(disc[:, 0] + 1j * disc[:, 1])


RINGS = 16
"""Rings of the reference's annulus."""


def rest_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningEquilibrium:
    (equilibrium,) = self_centred_equilibria(operation.reduced(car), facings(car, rings))
    return equilibrium


def whirl_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningWhirl:
    (whirl,) = whirls(operation.reduced(car), facings(car, rings))
    return whirl
