"""The study of the stability map, to which the modules beside this one add its claims."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.disc.stability_map.pictures import draw
from compare.studies.disc.stability_map.theory import DISC, SOURCE, curves


def border(name: str, unit: str, digits: int = 3) -> str:
    """Return the quote of a border in one parameter, "lower friction_force", and how far that is from Fig. 11."""
    here = getattr(DISC, name.split()[1])
    return f"{{{name}, {digits} digits}} {unit} ({{{name}, % from {here!r}, 2 digits}} %)"


def borders(parameter: str, unit: str, digits: int = 3) -> str:
    """Return the quotes of both borders in one parameter."""
    return " and ".join(border(f"{side} {parameter}", unit, digits) for side in ("lower", "upper"))


STUDY = Study.beside(
    __file__,
    "stability-map",
    source=SOURCE,
    system=DISC,
    seconds=7.5,
    words={
        "borders_of_load": borders("friction_force", "N"),
        "borders_of_shaft_damping": borders("shaft_damping", "N m s/rad"),
        "borders_of_damping": borders("damping", "N s/m"),
        "borders_of_shaft_speed": borders("shaft_speed", "rad/s", 4),
        "border_of_inertia": border("lower polar_inertia", "kg m²", 2),
    },
)
STUDY.provides(figures=draw, curves=curves)
