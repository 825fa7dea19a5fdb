"""The studies in the order of the report; each is a module that exports ``STUDY``."""

from collections.abc import Iterable
from importlib import import_module

from compare.claims import Study
from compare.engines import one_of

PLACES = {
    "pin": (
        "fig03",
        "fig04",
        "fig05",
        "fig06",
        "basins",
        "sticking_domain",
        "whirl_stability",
        "nonlinear_support",
    ),
    "disc": ("fig08", "fig09", "fig11", "stability_map", "simulated_map", "contact_laws", "free_ring"),
    "plane": ("block", "thrown_disc", "pushes", "tosses"),
    "drivetrain": (
        "run_up",
        "frozen",
        "momentum",
        "clutch_parts",
        "coupled_clutches",
        "exact_stick",
        "joints",
    ),
    "engines": (
        "trajectories",
        "power_balance",
        "clutch_scale",
        "engine_convergence",
        "error_estimates",
        "foreign_engines",
    ),
}
"""Modules of the studies by the folder of their group."""

STUDIES: tuple[Study, ...] = tuple(
    import_module(f"{__name__}.{group}.{module}").STUDY
    for group, modules in PLACES.items()
    for module in modules
)


def studies(names: Iterable[str] = (), among: tuple[Study, ...] = STUDIES) -> tuple[Study, ...]:
    """Return the studies of the given names, or all, in report order; raise ``ValueError`` for unknown names."""
    wanted = {one_of("study", name, [study.name for study in among]) for name in names}
    return tuple(study for study in among if study.name in wanted or not wanted)
