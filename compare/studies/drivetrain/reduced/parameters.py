"""The discs that the drivetrain is reduced to, and how exactly their motions are computed."""

from __future__ import annotations

from dataclasses import dataclass, replace

from compare.claims.error_estimates import TIGHTEST, WORKING
from compare.claims.paper_parameters import FIG8, FIG11
from compare.studies.toolkit.fig11_motion import START
from reference_model import Annulus
from reference_model.contact.contact_law import Contact
from reference_model.systems import DiscOnDisc

ENDLESS = 1e30
"""kg m²: a torque of 1 N m changes the speed of such a rotor by less than its last digit."""

INERTIAS = (250.0, 500.0, 1000.0, 2000.0)
"""kg m² of engine and vehicle, where they are slowed."""

UNTIL = 50.0
"""In s."""

TOLERANCE = 2.0 * TIGHTEST
"""Of Exudyn's DOPRI5 in m, rad, m/s and rad/s, and of the reference."""

ORDER_TOLERANCE = WORKING
"""Of DOPRI5 where inertias change much more."""

LARGEST_STEP = 1.0
"""In s: so large that the tolerance decides."""

EPSILON = 1e-6
"""m/s; these discs slip faster all the time, so that the law is that of Coulomb."""


@dataclass(frozen=True)
class Case:
    """A disc, its start (x, y in m, angle in rad, and rates), source of both, and the facing's inner radius in m."""

    disc: DiscOnDisc
    start: tuple[float, ...]
    source: str
    inner_radius: float

    @property
    def contact(self) -> Contact | None:
        """The law of the reference."""
        radius = self.disc.contact_radius
        return None if self.inner_radius == radius else Annulus(self.inner_radius, radius)


R = FIG11.contact_radius

CYCLE = Case(FIG11, START, "Fig. 11 with X0 = 0, started on its cycle", R)

CASES = {
    "Fig. 8": Case(
        FIG8,
        (FIG8.offset, 0.0, 0.0, 0.0, 0.0, FIG8.shaft_speed),
        "Fig. 8 with X0 = 0.1 as in Figs. 4 to 6",
        R,
    ),
    "the modulated cycle of Fig. 11": CYCLE,
    "Fig. 11 with an offset": Case(replace(FIG11, offset=0.02), START, "Fig. 11, X0 = 0.02 m by choice", R),
    "a facing of finite width": Case(FIG11, START, "Fig. 11, inner radius 0.08 m by choice", 0.08),
    "a support that hardens": Case(
        replace(FIG11, hardening=300.0), START, "Fig. 11, half as stiff again at 0.04 m, by choice", R
    ),
    "a support with a stop": Case(
        replace(FIG11, stop_gap=0.03, stop_stiffness=5.0), START, "Fig. 11, a stop at 0.03 m by choice", R
    ),
}
