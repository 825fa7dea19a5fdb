"""``friction-discs export-fmu pin | disc | clutch``: a contact as a functional mock-up unit (FMU)."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, cast

import typer

from compare.cli.command import Command, EngineFailedError, refused
from compare.cli.options import Settings, changes_of, check_file, unwritable, whole, with_options

export_fmu = typer.Typer(rich_markup_mode=None)

File = Annotated[Path, typer.Option("--output", metavar="FILE", help="Output file, .fmu.")]
Standard = Annotated[
    int,
    typer.Option(
        "--fmi",
        metavar="2|3",
        help="FMI version; every importer reads 2, and 3 adds intermediate updates.",
        parser=whole("fmi", 2, 3),
    ),
]


@dataclass(frozen=True)
class Unit:
    """Options that all units share."""

    output: File
    settings: Settings = None
    fmi: Standard = 2


@export_fmu.callback()
def export() -> None:
    """Write a contact as a functional mock-up unit (FMU).

    Simulink, Dymola and other FMI importers can read the unit. It supports model exchange and co-simulation, and
    contains its C sources and a library for this platform. --set gives initial parameters, which an importer may
    change.

    \b
    Examples:
      friction-discs export-fmu clutch --set plates=4 --set static_ratio=1.1 --output clutch.fmu
      friction-discs export-fmu pin --fmi 3 --set disc_speed=2 --output pin.fmu
    """


@export_fmu.command("pin", cls=Command)
@with_options(Unit)
def export_pin(unit: Unit) -> None:
    """Write the pin on a rotating disc.

    The defaults are the second case of Fig. 5.

    \b
    Parameters: as for `friction-discs simulate pin`, the initial state x, y (m), vx, vy (m/s), and
      exact=1 (0: creeps below the slip speed regularisation)
      regularisation=1e-6 (m/s) tolerance=1e-11
    \b
    Example:
      friction-discs export-fmu pin --set disc_speed=2 --set vx=0 --output pin.fmu
    """
    _export("pin", unit)


@export_fmu.command("disc", cls=Command)
@with_options(Unit)
def export_disc(unit: Unit) -> None:
    """Write the friction disc on a ring or on points.

    The defaults are Fig. 11 with X0 = 0.

    \b
    Parameters: as for `friction-discs simulate disc`, the initial state x, y (m), angle (rad), vx, vy (m/s),
      spin (rad/s), and
      exact=1 (0: creeps below the slip speed regularisation)
      regularisation=1e-6 (m/s) tolerance=1e-11
      contact_points=0 (0: continuous ring; 3 or more: points, which always creep)
    \b
    Example:
      friction-discs export-fmu disc --set shaft_speed=1.3 --output disc.fmu
    """
    _export("disc", unit)


@export_fmu.command("clutch", cls=Command)
@with_options(Unit)
def export_clutch(unit: Unit) -> None:
    """Write a clutch between two flanges.

    Inputs are speeds, load, friction coefficient and engagement; outputs are torques and forces.

    \b
    Parameters, with their defaults and units:
      inner_radius=0.1 (m) outer_radius=0.1 (m) wear=0 pressure_inner=1 pressure_mean=1 pressure_outer=1
      contact_points=0 plates=1 static_ratio=1 regularisation=1e-6 (m/s) tolerance=1e-11 mass=1 (kg)
      stiffness=1e6 (N/m) damping=100 (N s/m) offset=0 (m) hardening=0 (N/m³) stop_gap=0 (m) stop_stiffness=0 (N/m)
    \b
    Example:
      friction-discs export-fmu clutch --set inner_radius=0.08 --set outer_radius=0.12 --output clutch.fmu
    """
    _export("clutch", unit)


def _export(name: str, unit: Unit) -> None:
    import fmu_models

    with refused():
        model = fmu_models.MODELS[name]
        known = [one.name for one in model.variables if one.settable]
        model = model.starting(**_numbers(changes_of(unit.settings or [], known)))
        check_file(unit.output)
        try:
            made = fmu_models.export(model, unit.output, cast(Literal[2, 3], unit.fmi))
        except RuntimeError as error:
            raise EngineFailedError(str(error)) from None
        except OSError as error:
            raise ValueError(unwritable(unit.output, error)) from None
    what = f"with its sources and a library for {made.platform}" if made.platform else made.remark
    print(f"{made.file}: {name}, FMI {unit.fmi}, {what}.")


def _numbers(changes: dict[str, str]) -> dict[str, float]:
    from reference_model.systems import number_in_text

    words = {"true": "1", "false": "0"}
    return {
        name: number_in_text(name, words.get(value.strip().lower(), value)) for name, value in changes.items()
    }
