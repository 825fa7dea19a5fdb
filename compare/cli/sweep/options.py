"""Options of the sweeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.command import refused
from compare.cli.options import Settings, Tolerance, changed, chosen_from, count, positive, whole
from compare.cli.sweep.run import CHUNK, run_sweep

if TYPE_CHECKING:
    from compare.sweep.plan import Plan
    from reference_model.systems import System

COARSE = 65

MOST_CHUNK, MOST_SAMPLES, MOST_AT_A_VALUE = 10_000_000, 2**31, 2**20

STARTS = {"pin": (0.1, 0.0, 0.03, 0.0), "disc": (0.02, 0.0, 0.0, 0.0, 0.0, 1.3)}
"""Default initial states, as in ``simulate``."""

UNTIL, UNTIL_ON_POINTS = 12000.0, 1200.0
"""Default of ``--until`` in s. Only then do modulated motions near the Hopf curve of Fig. 11 differ from whirls. On
single contact points it is shorter, because the plain reference simulates their rests slowly."""


@refused()
def rows(text: str) -> int:
    """Return ``text`` as a number of rows, a power of 2."""
    from compare.sweep.compute.sensitivity import LEAST_SAMPLES

    number = count("samples", text, LEAST_SAMPLES, MOST_SAMPLES)
    if number & (number - 1):
        nearest = 1 << number.bit_length()
        raise ValueError(f"samples = {number}: it must be a power of 2, for example {nearest}")
    return number


def _start_option(more: str = "") -> Any:
    text = f"Components of the initial state in SI units; the others keep their defaults in simulate.{more}"
    return typer.Option("--start", metavar="NAME=VALUE,...", help=text, show_default=False)


def _axis_option(name: str, which: str) -> Any:
    text = f"{which} axis, in SI units."
    return typer.Option(name, metavar="NAME=LOW:HIGH:POINTS", help=text, show_default=False)


SystemName = Annotated[
    str,
    typer.Argument(
        metavar="pin|disc", help="System to simulate.", parser=chosen_from("system", list(STARTS))
    ),
]
Start = Annotated[str, _start_option()]
Starts = Annotated[list[str] | None, _start_option(" Repeat for more initial states.")]
XAxis = Annotated[str, _axis_option("--x", "Horizontal")]
YAxis = Annotated[str, _axis_option("--y", "Vertical")]
Coarse = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Minimum number of points along each axis of the first grid.",
        parser=whole("coarse", 2, MOST_SAMPLES),
        show_default=str(COARSE),
    ),
]
RandomStarts = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Use N random initial states instead of a grid.",
        parser=whole("random", 1, MOST_SAMPLES),
        show_default=False,
    ),
]
Varied = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=DISTRIBUTION",
        help="Distribution of a parameter or a component of the initial state; repeat for more quantities.",
        show_default=False,
    ),
]
Rows = Annotated[
    int,
    typer.Option(
        metavar="N",
        help="Sample size, a power of 2; N·(2 + number of uncertain quantities) trajectories are simulated.",
        parser=rows,
    ),
]
Values = Annotated[
    int,
    typer.Option(
        metavar="N",
        help="Number of random initial states at each value.",
        parser=whole("samples", 1, MOST_AT_A_VALUE),
    ),
]
Until = Annotated[
    float | None,
    typer.Option(
        metavar="T",
        help="Time limit of each trajectory in s. A trajectory whose outcome is not certain by then is undecided. A "
        "longer limit decides most of these, and costs nothing for the others.",
        parser=positive("until", "s"),
        show_default=f"{UNTIL:g}; {UNTIL_ON_POINTS:g} for a disc on points",
    ),
]
Seed = Annotated[int, typer.Option(metavar="N", help="Random seed.", parser=whole("seed", 0, 2**63 - 1))]
Chunk = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Number of trajectories that are computed and written together.",
        parser=whole("chunk", 1, MOST_CHUNK),
        show_default=str(CHUNK),
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Address of a Dask scheduler, tcp://HOST:PORT, whose workers run the sweep.",
        show_default="the cores of this machine",
    ),
]
Output = Annotated[
    str,
    typer.Option(
        metavar="DIR|URL",
        help="Folder for the results, or s3://BUCKET/NAME; all workers must be able to write to it.",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Continue the sweep in the output folder.")]


@dataclass(frozen=True)
class Request:
    """Options that all sweeps share."""

    system: SystemName
    settings: Settings = None
    until: Until = None
    tolerance: Tolerance = 1e-9
    seed: Seed = 1
    chunk: Chunk = None
    scheduler: Scheduler = None
    output: Output = "sweep"
    resume: Resume = False

    def common(self) -> dict[str, Any]:
        """Return the arguments that all plans share; raise ``ValueError`` for invalid options."""
        from compare.claims.parameters import FIG5, FIG11

        papers: Mapping[str, System] = {"pin": FIG5, "disc": FIG11}
        system = changed(papers[self.system], self.settings or [])
        on_points = getattr(system, "contact_points", None) is not None
        return {
            "system": system,
            "duration": self.until or (UNTIL_ON_POINTS if on_points else UNTIL),
            "tolerance": self.tolerance,
            "seed": self.seed,
        }

    def set_names(self) -> list[str]:
        """Return the parameters that ``--set`` changes."""
        return [setting.partition("=")[0].strip() for setting in self.settings or []]

    def run(self, plan: Plan) -> int:
        """Run or resume the sweep of ``plan``."""
        return run_sweep(plan, self.chunk, self.scheduler, self.output, self.resume)
