"""``friction-discs simulate pin | disc``: simulates a motion and writes it to a file."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.command import BadInputError, Command, EngineFailedError, printing, refused
from compare.cli.options import (
    Settings,
    Tolerance,
    changed,
    check_file,
    finite,
    positive,
    unwritable,
    whole,
    with_options,
)
from compare.output.text_files import replacing

if TYPE_CHECKING:
    from compare.engines import Engine
    from reference_model.systems import FloatArray, System
    from reference_model.trajectory import Trajectory

MOST_SAMPLES = 10_000_000
"""Limit of ``--samples``; more samples would exhaust the memory."""

PICTURES = (".png", ".pdf", ".svg")

PATIENCE = 2.0
"""Time in s before a terminal shows the engine at work."""

simulate = typer.Typer(rich_markup_mode=None)

EngineName = Annotated[str, typer.Option("--engine", metavar="NAME", help="Engine to use.")]
PinState = Annotated[
    tuple[float, float, float, float],
    typer.Option(
        metavar="X Y VX VY", help="Position in m and velocity in m/s at time 0.", parser=finite("start")
    ),
]
DiscState = Annotated[
    tuple[float, float, float, float, float, float],
    typer.Option(
        metavar="X Y ANGLE VX VY SPIN",
        help="Position in m, angle in rad, velocity in m/s and spin in rad/s at time 0.",
        parser=finite("start"),
    ),
]
Until = Annotated[float, typer.Option(metavar="T", help="Final time in s.", parser=positive("until", "s"))]
Samples = Annotated[
    int,
    typer.Option(
        metavar="N", help="Number of times from 0 to T, >= 2.", parser=whole("samples", 2, MOST_SAMPLES)
    ),
]
File = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Output file, .csv or .json.", show_default="CSV on standard output"),
]
Plot = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Picture to draw, .png, .pdf or .svg; without --output nothing else is written.",
        show_default="no picture",
    ),
]


@dataclass(frozen=True)
class Request:
    """Options that both systems share."""

    engine: EngineName = "reference"
    settings: Settings = None
    until: Until = 400
    samples: Samples = 4001
    tolerance: Tolerance = 1e-9
    output: File = None
    plot: Plot = None


@simulate.callback()
def simulate_system() -> None:
    """Simulate a system and write its motion.

    \b
    Examples:
      friction-discs simulate pin --output whirl.json
    """


@simulate.command("pin", cls=Command)
@with_options(Request)
def simulate_pin(request: Request, start: PinState = (0.1, 0, 0.03, 0)) -> None:
    """Simulate a pin and write its motion.

    The defaults are the second case of Fig. 5.

    \b
    Parameters, with their defaults and units:
      mass=1 (kg) stiffness=1 (N/m) damping=0.1 (N s/m) friction_force=0.09 (N) disc_speed=1.5 (rad/s)
      offset=0.1 (m) hardening=0 (N/m³) stop_gap=0 (m) stop_stiffness=0 (N/m)
    \b
    Examples:
      friction-discs simulate pin --output whirl.json
      friction-discs simulate pin --engine exudyn --set disc_speed=1.2 --set friction_force=0.05
          --start 0.1 0 -0.02 0 --until 100 --samples 1001 --output pin.csv
    """
    from compare.claims.parameters import FIG5

    _simulate(FIG5, start, request)


@simulate.command("disc", cls=Command)
@with_options(Request)
def simulate_disc(request: Request, start: DiscState = (0.02, 0, 0, 0, 0, 1.3)) -> None:
    """Simulate a friction disc and write its motion.

    The defaults are Fig. 11 with X0 = 0.

    \b
    Parameters, with their defaults and units; contact_points=none is the continuous ring:
      mass=1 (kg) polar_inertia=1 (kg m²) stiffness=1 (N/m) damping=0.5 (N s/m) friction_force=0.0225 (N)
      disc_speed=1.5 (rad/s) offset=0 (m) contact_radius=0.12 (m) shaft_damping=0.015 (N m s/rad)
      shaft_speed=1.25 (rad/s) contact_points=none hardening=0 (N/m³) stop_gap=0 (m) stop_stiffness=0 (N/m)
    \b
    Examples:
      friction-discs simulate disc --output modulated.csv
      friction-discs simulate disc --engine exudyn --set contact_points=6 --set disc_speed=2
          --start 0.1 0 0 0 0 1.2 --until 100 --samples 1001 --output disc.json
    """
    from compare.claims.parameters import FIG11

    _simulate(FIG11, start, request)


def _simulate(paper: System, start: Sequence[float], request: Request) -> None:
    import numpy as np

    from compare.cli.trajectory_files import write_csv, writer
    from compare.engines import UnsupportedSystemError
    from compare.run.runner import loaded
    from compare.run.workers import Failure, Workers
    from reference_model.systems import checked_state

    output, plot = request.output, request.plot
    with Workers() as workers:
        with refused():
            (chosen,) = loaded([request.engine], workers)
            system = changed(paper, request.settings or [])
            if missing := chosen.lacking([system]):
                raise UnsupportedSystemError(missing)
            state = checked_state(system, start)
            times = np.linspace(0.0, request.until, request.samples)
            write = write_csv if output is None else writer(output)
            if plot is not None and plot.suffix not in PICTURES:
                raise ValueError(f"--plot {plot.name!r}: the file name must end in {' or '.join(PICTURES)}")
            for path in filter(None, (output, plot)):
                check_file(path)
        phases = write is not write_csv or plot is not None
        with _elapsed_time(f"{chosen.name} simulates until t = {request.until:g} s"):
            trajectory = workers.ask(_simulated, chosen, system, state, times, request.tolerance, phases)
    if isinstance(trajectory, Failure):
        raise EngineFailedError(f"engine {chosen.name!r} failed: {trajectory}")
    if plot is not None:
        _draw(trajectory, plot)
    if output is not None:
        with _writing(output, "w") as stream:
            write(trajectory, chosen.name, stream)
    elif plot is None:
        with printing():
            write(trajectory, chosen.name, sys.stdout)


def _draw(trajectory: Trajectory, plot: Path) -> None:
    from matplotlib.figure import Figure

    from compare.output.figures import paper_style

    with paper_style(), _writing(plot, "wb") as stream:
        figure = trajectory.plot(Figure(figsize=(9.0, 5.2), layout="constrained"))
        figure.savefig(stream, format=plot.suffix[1:], dpi=150)


@contextmanager
def _writing(path: Path, mode: str) -> Iterator[IO[Any]]:
    try:
        with replacing(path, mode) as stream:
            yield stream
    except OSError as error:
        raise BadInputError(unwritable(path, error)) from None


@contextmanager
def _elapsed_time(what: str) -> Iterator[None]:
    """Show on a terminal for how long the engine has worked."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    progress = Progress(*columns, console=Console(stderr=True), transient=True)
    progress.add_task(what)
    delay = threading.Timer(PATIENCE, progress.start)
    delay.start()
    try:
        yield
    finally:
        delay.cancel()
        delay.join()
        progress.stop()


def _simulated(
    engine: Engine, system: System, state: FloatArray, times: FloatArray, tolerance: float, phases: bool
) -> Trajectory:
    """Return the motion as arrays; its phases may need another simulation."""
    from reference_model.trajectory import Trajectory

    found = engine.simulate(system, state, times, tolerance=tolerance)
    return Trajectory(system, found.times, found.states, found.phases if phases else (), found.solution)
