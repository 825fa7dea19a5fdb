"""The studies in the order of the report; each is a module that exports ``STUDY``."""

from __future__ import annotations

from collections.abc import Iterable

from compare.claims import Study
from compare.engines import one_of
from compare.studies.disc.contact_laws import STUDY as CONTACT_LAWS
from compare.studies.disc.fig08 import STUDY as FIG08
from compare.studies.disc.fig09 import STUDY as FIG09
from compare.studies.disc.fig11 import STUDY as FIG11
from compare.studies.disc.free_ring import STUDY as FREE_RING
from compare.studies.disc.simulated_map import STUDY as SIMULATED_MAP
from compare.studies.disc.stability_map import STUDY as STABILITY_MAP
from compare.studies.drivetrain.clutch_parts import STUDY as CLUTCH_PARTS
from compare.studies.drivetrain.coupled_clutches import STUDY as COUPLED_CLUTCHES
from compare.studies.drivetrain.frozen import STUDY as DRIVETRAIN_FROZEN
from compare.studies.drivetrain.momentum import STUDY as DRIVETRAIN_MOMENTUM
from compare.studies.drivetrain.run_up import STUDY as DRIVETRAIN_RUN_UP
from compare.studies.engines.clutch_scale import STUDY as CLUTCH_SCALE
from compare.studies.engines.engine_convergence import STUDY as ENGINE_CONVERGENCE
from compare.studies.engines.error_estimates import STUDY as ERROR_ESTIMATES
from compare.studies.engines.foreign_engines import STUDY as FOREIGN_ENGINES
from compare.studies.engines.power_balance import STUDY as POWER_BALANCE
from compare.studies.engines.trajectories import STUDY as TRAJECTORIES
from compare.studies.pin.basins import STUDY as BASINS
from compare.studies.pin.fig03 import STUDY as FIG03
from compare.studies.pin.fig04 import STUDY as FIG04
from compare.studies.pin.fig05 import STUDY as FIG05
from compare.studies.pin.fig06 import STUDY as FIG06
from compare.studies.pin.nonlinear_support import STUDY as NONLINEAR_SUPPORT
from compare.studies.pin.sticking_domain import STUDY as STICKING_DOMAIN
from compare.studies.pin.whirl_stability import STUDY as WHIRL_STABILITY
from compare.studies.plane.block import STUDY as BLOCK
from compare.studies.plane.pushes import STUDY as PUSHES
from compare.studies.plane.thrown_disc import STUDY as THROWN_DISC

STUDIES: tuple[Study, ...] = (
    FIG03,
    FIG04,
    FIG05,
    FIG06,
    BASINS,
    STICKING_DOMAIN,
    WHIRL_STABILITY,
    NONLINEAR_SUPPORT,
    FIG08,
    FIG09,
    FIG11,
    STABILITY_MAP,
    SIMULATED_MAP,
    CONTACT_LAWS,
    FREE_RING,
    BLOCK,
    THROWN_DISC,
    PUSHES,
    DRIVETRAIN_RUN_UP,
    DRIVETRAIN_FROZEN,
    DRIVETRAIN_MOMENTUM,
    CLUTCH_PARTS,
    COUPLED_CLUTCHES,
    TRAJECTORIES,
    POWER_BALANCE,
    CLUTCH_SCALE,
    ENGINE_CONVERGENCE,
    ERROR_ESTIMATES,
    FOREIGN_ENGINES,
)


def studies(names: Iterable[str] = (), among: tuple[Study, ...] = STUDIES) -> tuple[Study, ...]:
    """Return the studies of the given names, or all, in report order; raise ``ValueError`` for unknown names."""
    wanted = {one_of("study", name, [study.name for study in among]) for name in names}
    return tuple(study for study in among if study.name in wanted or not wanted)
