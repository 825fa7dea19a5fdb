"""The passenger car's clutch on a bench: the drivetrain at one speed, and the reference's disc that it amounts to.

The bench holds the flywheel's speed, and a brake b·(Ω_v − Ω) holds that of the vehicle. Whenever the motion is
steady, the torsional spring carries a constant torque, and the clutch disc is that of (19) with the brake's b and Ω
in place of the shaft's: then the two agree but for rounding, although one has five coordinates and the other three.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims import Measured, change_as_error
from compare.claims.linearised_flow import ComplexArray
from reference_model import (
    Annulus,
    DiscOnDisc,
    SpinningEquilibrium,
    SpinningWhirl,
    self_centred_equilibria,
    whirls,
)
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain, DrivetrainModel, EnergyBalance


SOURCE = "the passenger car of exudyn_models.drivetrain.parameters; torque and slip: assumed"

RPM = math.pi / 30.0
"""rad/s in one turn a minute."""

BRAKE = 100.0
"""b of the brake in N m s/rad: the slip settles within some J/b = 0.008 s."""

HELD = 1e18
"""Inertia of a flywheel in kg m² whose speed does not change: 100 N m take 1e-16 rad/s off it in a second."""

EPSILON = 1e-3
"""ε in m/s: the facings slip by a thousand times more, so that friction is Coulomb's."""


def passenger_car() -> Drivetrain:
    """Return the car's parameters; Exudyn is imported only when it is used."""
    from exudyn_models import PASSENGER_CAR

    return PASSENGER_CAR


def centred_car() -> Drivetrain:
    """Return the car without unbalance, its shaft on the engine's axis: the disc stays there unless it is pushed."""
    return replace(passenger_car(), offset=0.0, unbalance=0.0)


def parameters_of(
    car: Drivetrain, *, without: Collection[str] = (), **changes: float
) -> dict[str, float | str]:
    """Return the parameters of ``car`` for a claim, but those that it leaves out or sweeps."""
    return {name: value for name, value in asdict(car).items() if name not in without} | changes


def facings(car: Drivetrain, rings: int = 16) -> Annulus:
    """Return the reference's law of friction of the clutch."""
    return Annulus(car.inner_radius, car.outer_radius, rings)


def rotating_damping(car: Drivetrain, slip: float, torque: float) -> float:
    """Return D in N s/m: friction of the slipping clutch against small motions of the disc's centre.

    μN·∂F/∂U at U = 0, with the μN under which the clutch transmits ``torque`` (N m) at ``slip`` (rad/s). It is the
    paper's μN/(2W), averaged over the facings.
    """
    return torque / car.friction_radius * facings(car).slopes(0.0, slip).resistance_by_slip


def natural_frequency(car: Drivetrain) -> float:
    """Return k of the disc on its shaft in rad/s."""
    return math.sqrt(car.radial_stiffness / car.disc_mass)


def onset_speed(car: Drivetrain, slip: float, torque: float) -> float:
    """Return ω = k·(1 + β/D) in rad/s, above which the disc does not stay on the engine's axis."""
    return natural_frequency(car) * (1.0 + car.radial_damping / rotating_damping(car, slip, torque))


@dataclass(frozen=True)
class Operation:
    """What the bench is set to.

    Parameters
    ----------
    speed, slip : float
        Of the flywheel, and by how much the disc is slower, in rad/s, while the disc is centred.
    torque : float
        That the clutch transmits then, in N m.
    offset : float
        X0 in m.

    """

    speed: float
    slip: float
    torque: float
    offset: float = 0.0

    @property
    def brake_speed(self) -> float:
        """Ω in rad/s."""
        return self.speed - self.slip - self.torque / BRAKE

    def reduced(self, car: Drivetrain) -> DiscOnDisc:
        """Return the disc of (19) that the clutch disc is while it moves steadily."""
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
        """Return the drivetrain on the bench, without unbalance, the disc on its shaft's axis."""
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
    """Return what two balances of the same run say, the second at a smaller tolerance, see ``refined``."""
    found, finer = (np.max(np.abs(each.residual)) / each.turnover for each in balances)
    return Measured(
        predicted=0.0,
        value=found,
        error=change_as_error(found, finer),
        parameters=parameters,
        note="The largest of gains less losses less the growth of what is stored, over the energy turned over, "
        f"{balances[0].turnover:.3g} J. Numerical error: the change at a smaller tolerance.",
    )


def start_disc(model: DrivetrainModel, place: complex, velocity: complex) -> None:
    """Let the disc's centre start at ``place`` in m with ``velocity`` in m/s."""
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
    """Return x + iy of the disc's coordinates or velocities, shape (n,) from (n, 3)."""
    return np.asarray(disc[:, 0] + 1j * disc[:, 1])


# --- Where the reference's reduced disc rests on the bench, and how it whirls.

RINGS = 16
"""Of the reference's annulus."""


def rest_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningEquilibrium:
    """Return the reference's equilibrium."""
    (equilibrium,) = self_centred_equilibria(operation.reduced(car), facings(car, rings))
    return equilibrium


def whirl_of(car: Drivetrain, operation: Operation, rings: int = RINGS) -> SpinningWhirl:
    """Return the reference's whirl."""
    (whirl,) = whirls(operation.reduced(car), facings(car, rings))
    return whirl
