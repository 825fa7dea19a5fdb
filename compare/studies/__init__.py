"""The studies in the order of the report; each is a module of this package that exports ``STUDY``."""

from __future__ import annotations

from collections.abc import Iterable

from compare.engines import known
from compare.studies.basins import STUDY as BASINS
from compare.studies.clutch_scale import STUDY as CLUTCH_SCALE
from compare.studies.connector import STUDY as CONNECTOR
from compare.studies.contact_laws import STUDY as CONTACT_LAWS
from compare.studies.drivetrain_frozen import STUDY as DRIVETRAIN_FROZEN
from compare.studies.drivetrain_launch import STUDY as DRIVETRAIN_LAUNCH
from compare.studies.drivetrain_momentum import STUDY as DRIVETRAIN_MOMENTUM
from compare.studies.drivetrain_reduced import STUDY as DRIVETRAIN_REDUCED
from compare.studies.drivetrain_run_up import STUDY as DRIVETRAIN_RUN_UP
from compare.studies.engine_convergence import STUDY as ENGINE_CONVERGENCE
from compare.studies.error_estimates import STUDY as ERROR_ESTIMATES
from compare.studies.fig03_self_centring import STUDY as FIG03
from compare.studies.fig04_whirl_shift import STUDY as FIG04
from compare.studies.fig05_coexistence import STUDY as FIG05
from compare.studies.fig06_branches import STUDY as FIG06
from compare.studies.fig08_disc_spin import STUDY as FIG08
from compare.studies.fig09_disc_branches import STUDY as FIG09
from compare.studies.fig11_modulated_cycle import STUDY as FIG11
from compare.studies.foreign_engines import STUDY as FOREIGN_ENGINES
from compare.studies.free_ring import STUDY as FREE_RING
from compare.studies.nonlinear_support import STUDY as NONLINEAR_SUPPORT
from compare.studies.power_balance import STUDY as POWER_BALANCE
from compare.studies.simulated_map import STUDY as SIMULATED_MAP
from compare.studies.stability_map import STUDY as STABILITY_MAP
from compare.studies.sticking_domain import STUDY as STICKING_DOMAIN
from compare.studies.trajectories import STUDY as TRAJECTORIES
from compare.studies.whirl_stability import STUDY as WHIRL_STABILITY
from compare.study import Study

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
    DRIVETRAIN_RUN_UP,
    DRIVETRAIN_FROZEN,
    DRIVETRAIN_LAUNCH,
    DRIVETRAIN_REDUCED,
    DRIVETRAIN_MOMENTUM,
    TRAJECTORIES,
    POWER_BALANCE,
    CLUTCH_SCALE,
    CONNECTOR,
    ENGINE_CONVERGENCE,
    ERROR_ESTIMATES,
    FOREIGN_ENGINES,
)


def studies(names: Iterable[str] = (), among: tuple[Study, ...] = STUDIES) -> tuple[Study, ...]:
    """Return the studies of the given names, or all, in report order; raise ``ValueError`` for others."""
    wanted = {known("study", name, [study.name for study in among]) for name in names}
    return tuple(study for study in among if study.name in wanted or not wanted)
