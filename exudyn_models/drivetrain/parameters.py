"""Parameters of a drivetrain: engine with flywheel, dry clutch and vehicle, and the torques on them."""

import math
from dataclasses import dataclass, fields
from typing import Any

from exudyn_models.parts.rotational.torques import Torque
from reference_model.systems import finite_number


@dataclass(frozen=True, kw_only=True)
class Drivetrain:
    """Parameters of an engine with flywheel, a dry clutch and a vehicle, reduced to the gearbox's input shaft.

    Parameters
    ----------
    engine_inertia
        Inertia of crankshaft, flywheel and clutch cover in kg m², > 0.
    disc_mass, disc_inertia
        Mass in kg and inertia in kg m² of the clutch disc, > 0.
    unbalance
        Distance in m of the disc's centre of mass from the centre of its facings, >= 0.
    inner_radius, outer_radius
        Radii of the facings in m; equal for a ring.
    faces
        Number of facings, >= 1.
    friction_coefficient
        μ of a facing, >= 0.
    offset
        X0 in m: the shaft's axis is at (X0, 0), the engine's at (0, 0).
    radial_stiffness, radial_damping
        C in N/m and β in N s/m of the disc on its shaft, >= 0.
    hardening, stop_gap, stop_stiffness
        C₃ in N/m³, clearance in m and C_s in N/m of that support, as in ``add_radial_support``.
    torsional_stiffness, torsional_damping
        Between disc and gearbox, in N m/rad and N m s/rad, >= 0.
    vehicle_inertia
        Inertia of gearbox, wheels and vehicle in kg m², reduced to the input shaft, > 0.

    Raises
    ------
    ValueError
        If a value is not a finite number or is out of range.

    """

    engine_inertia: float
    disc_mass: float
    disc_inertia: float
    unbalance: float = 0.0
    inner_radius: float
    outer_radius: float
    faces: int = 2
    friction_coefficient: float
    offset: float = 0.0
    radial_stiffness: float
    radial_damping: float
    hardening: float = 0.0
    stop_gap: float = 0.0
    stop_stiffness: float = 0.0
    torsional_stiffness: float
    torsional_damping: float
    vehicle_inertia: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = finite_number(field.name, getattr(self, field.name))
            if field.name.endswith(("inertia", "mass", "outer_radius")) and value <= 0.0:
                raise ValueError(f"{field.name} = {value:g}: it must be > 0")
            if field.name != "offset" and value < 0.0:
                raise ValueError(f"{field.name} = {value:g}: it must be >= 0")
        if self.faces < 1 or self.faces != int(self.faces):
            raise ValueError(f"faces = {self.faces}: it must be a whole number >= 1")

    @property
    def friction_radius(self) -> float:
        """Torque divided by friction force of slipping facings under uniform pressure, in m."""
        ri, ro = self.inner_radius, self.outer_radius
        return 2.0 / 3.0 * (ri * ri + ri * ro + ro * ro) / (ri + ro)

    @property
    def contact(self) -> dict[str, Any]:
        """The facings as arguments of ``add_ring_friction``."""
        if self.inner_radius == self.outer_radius:
            return {"contact_radius": self.outer_radius}
        return {"inner_radius": self.inner_radius, "outer_radius": self.outer_radius}

    def normal_load(self, torque: float) -> float:
        """Return the load in N per facing of a slipping clutch that transmits ``torque`` (N m)."""
        return torque / (self.faces * self.friction_coefficient * self.friction_radius)


PASSENGER_CAR = Drivetrain(
    engine_inertia=0.2,
    disc_mass=1.2,
    disc_inertia=0.006,
    unbalance=1.5e-5,
    inner_radius=0.075,
    outer_radius=0.114,
    friction_coefficient=0.3,
    offset=2e-4,
    radial_stiffness=1.08e5,
    radial_damping=36.0,
    stop_gap=5e-4,
    stop_stiffness=2e6,
    torsional_stiffness=1000.0,
    torsional_damping=2.0,
    vehicle_inertia=0.75,
)
"""A passenger car of 1,300 kg in first gear: typical values, and assumptions where none are published.

- Vehicle: 1300 kg on wheels of 0.3 m behind a ratio of 13 : 1, 0.69 kg m², plus the gearbox.
- Engine with flywheel, and disc: assumed, below the inertias of a light truck in Applied Sciences 9 (2019) 4287,
  table A3, 0.3 and 0.045 kg m²; clamp loads there reach 10 kN. Facings of 228 by 150 mm are sold for petrol engines
  of 150 N m; dry facings have μ = 0.2 to 0.4 (Modelica Standard Library, Rotational.Components.Clutch).
- Torsional spring: 17 N m per degree.
- Radial support, assumed: a steel shaft of 18 mm over a free length of 0.31 m, which gives a natural frequency of
  2865 rpm; 5 % of critical damping; 0.5 mm clearance in the pilot bearing; 0.2 mm between the axes; an unbalance of
  18 g mm. The radial mode can become unstable in engagement: Proceedings of the IMechE, Part C (2020), doi
  10.1177/0954406220927065.
"""


def four_cylinder(mean: float, ripple: float) -> Torque:
    """Return the torque T·(1 + r·cos 2θ) of a four-stroke engine with four cylinders.

    T = ``mean`` is in N m and r = ``ripple``.
    """
    mean, ripple = finite_number("mean", mean), finite_number("ripple", ripple)
    return lambda time, angle, speed: mean * (1.0 + ripple * math.cos(2.0 * angle))
