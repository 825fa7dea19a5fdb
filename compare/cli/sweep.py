"""The command line of sweeps: ``friction-discs sweep basin | map | uncertainty | figures``."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.options import (
    BAD_INPUT,
    FINE,
    INTERRUPTED,
    SOMETHING_DIFFERS,
    BadInputError,
    Command,
    Settings,
    Tolerance,
    changed,
    check_folder,
    count,
    positive,
    printing,
    refused,
    say,
)

if TYPE_CHECKING:
    from compare.sweep.compute.executors import Executor
    from compare.sweep.compute.run import Progress
    from compare.sweep.compute.store import SweepStore
    from compare.sweep.define.axes import Axis
    from compare.sweep.define.plan import Plan
    from reference_model.systems import System

STORE = "sweep.zarr"
"""Name of the store in its folder."""

CHUNK = 32768
"""Trajectories in a chunk, unless another number is asked for."""

COARSE = "65"

MOST_CHUNK, MOST_SAMPLES, MOST_POINTS = 10_000_000, 2**27, 100_000_000

PLANES = {
    "pin": ("x=-0.3:0.5:257", "vx=-0.4:0.4:257"),
    "disc": ("x=-0.1:0.1:65", "vx=-0.1:0.1:65"),
}
MAPS = {
    "pin": ("disc_speed=1.05:3:64", "friction_force=0.01:0.15:64"),
    "disc": ("disc_speed=1.05:1.95:64", "friction_force=0.005:0.06:64"),
}
"""Axes x and y unless others are asked for."""

STARTS = {"pin": (0.1, 0.0, 0.03, 0.0), "disc": (0.02, 0.0, 0.0, 0.0, 0.0, 1.3)}
"""As of ``simulate``."""

UNTIL, UNTIL_ON_POINTS = "12000", "1200"
"""In s. The modulated motions of Fig. 11 near its Hopf curve take as long to be told from whirls. Where single points
of contact come to rest, which the plain reference has to follow, a longer time costs most and settles nothing."""

sweep = typer.Typer(rich_markup_mode=None)

SystemName = Annotated[str, typer.Argument(metavar="pin|disc", help="What is simulated.")]
Start = Annotated[
    str,
    typer.Option(
        metavar="NAME=VALUE,...",
        help="Components of the state at time 0; the others are as for simulate.",
        show_default=False,
    ),
]
Starts = Annotated[
    list[str] | None,
    typer.Option(
        "--start",
        metavar="NAME=VALUE,...",
        help="Components of the state at time 0; the others are as for simulate. Several times for several starts.",
        show_default=False,
    ),
]
XAxis = Annotated[
    str, typer.Option("--x", metavar="NAME=LOW:HIGH:POINTS", help="Across.", show_default=False)
]
YAxis = Annotated[str, typer.Option("--y", metavar="NAME=LOW:HIGH:POINTS", help="Up.", show_default=False)]
Until = Annotated[
    str,
    typer.Option(
        metavar="T",
        help="Longest time in s that an end is waited for. What is not certain until then is undecided; a longer "
        "time settles most of that, and costs nothing where ends are certain before.",
        show_default=f"{UNTIL}, of a disc on single points {UNTIL_ON_POINTS}",
    ),
]
Seed = Annotated[str, typer.Option(metavar="N", help="Of all that is random.")]
Chunk = Annotated[
    str | None,
    typer.Option(
        metavar="N", help="Trajectories that are computed and written together.", show_default=str(CHUNK)
    ),
]
Output = Annotated[Path, typer.Option(metavar="DIR", help="Folder for the store and the figures.")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="A Dask scheduler, tcp://HOST:PORT, whose workers compute.",
        show_default="the cores of this machine",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the sweep that is there.")]


@sweep.callback()
def sweep_command() -> None:
    """Simulate many trajectories: basins of attraction, maps over two parameters, uncertain parameters.

    What is not set is Fig. 5 for a pin and Fig. 11 with X0 = 0 for a disc, as for simulate. Results go into a Zarr
    store of labelled arrays, which xarray opens, chunk by chunk: after an interruption of any kind the same command
    with --resume does the rest.

    \b
    Examples:
      friction-discs sweep basin pin
      friction-discs sweep map disc --help
    """  # noqa: D301


@sweep.command("basin", cls=Command)
def sweep_basin(
    system: SystemName,
    settings: Settings = None,
    start: Start = "",
    x: XAxis = "",
    y: YAxis = "",
    coarse: Annotated[
        str,
        typer.Option(
            metavar="N",
            help="Least points along each axis before the boundary is refined.",
            show_default=COARSE,
        ),
    ] = "",
    random: Annotated[
        str | None,
        typer.Option(metavar="N", help="Take N random starts in place of the grid.", show_default=False),
    ] = None,
    until: Until = "",
    tolerance: Tolerance = "1e-9",
    seed: Seed = "1",
    chunk: Chunk = None,
    scheduler: Scheduler = None,
    output: Output = Path("basin"),
    resume: Resume = False,
) -> int:
    """Find what starts in a plane of two components of the state end as, and how large a share of them.

    The grid is first a coarse one, and then refined where neighbouring points end differently.

    \b
    Axes, unless others are given:
      pin   --x x=-0.3:0.5:257 --y vx=-0.4:0.4:257
      disc  --x x=-0.1:0.1:65 --y vx=-0.1:0.1:65
    \b
    Examples:
      friction-discs sweep basin pin --x x=-0.3:0.5:1000 --y vx=-0.4:0.4:1000
      friction-discs sweep basin pin --random 20000 --seed 7 --output shares
      friction-discs sweep basin disc --set contact_points=6 --start spin=1.2 --x x=-0.2:0.2:129 --y y=-0.2:0.2:129
    """  # noqa: D301
    from compare.sweep.define.axes import Axis
    from compare.sweep.define.plan import Basin, RandomBasin
    from compare.sweep.define.quantities import components

    with refused():
        common = _common(system, settings, until, tolerance, seed)
        names = components(common["system"])
        axes = _axes("component", names, (x, y), PLANES[system])
        state = _start(system, start, names)
        _check_given_once({"--start": _names_of(start)}, "--x or --y", [axis.name for axis in axes])
        _check_states(common["system"], state, list(names), axes)
        plan: Plan
        if random is None:
            points = count("coarse", coarse or COARSE, 2, MOST_SAMPLES)
            plan = Basin(**common, start=state, x=axes[0], y=axes[1], coarse=points)
        else:
            if coarse:
                raise ValueError("--coarse is of a grid: leave it out with --random")
            samples = count("random", random, 1, MOST_SAMPLES)
            ranges = [Axis(axis.name, axis.low, axis.high, 2) for axis in axes]
            plan = RandomBasin(**common, start=state, x=ranges[0], y=ranges[1], samples=samples)
    return _sweep(plan, chunk, scheduler, output, resume)


@sweep.command("map", cls=Command)
def sweep_map(
    system: SystemName,
    settings: Settings = None,
    starts: Starts = None,
    x: XAxis = "",
    y: YAxis = "",
    until: Until = "",
    tolerance: Tolerance = "1e-9",
    seed: Seed = "1",
    chunk: Chunk = None,
    scheduler: Scheduler = None,
    output: Output = Path("map"),
    resume: Resume = False,
) -> int:
    """Find what motions end as over a plane of two parameters, with the boundaries that formulas draw there.

    \b
    Axes, unless others are given:
      pin   --x disc_speed=1.05:3:64 --y friction_force=0.01:0.15:64
      disc  --x disc_speed=1.05:1.95:64 --y friction_force=0.005:0.06:64
    \b
    Examples:
      friction-discs sweep map pin --start x=0.1,vx=0.03 --start x=0.02,vx=0
      friction-discs sweep map disc --x damping=0.2:2:100 --y shaft_damping=0.004:0.026:100
    """  # noqa: D301
    from compare.sweep.define.plan import Map
    from compare.sweep.define.quantities import components, parameters

    with refused():
        common = _common(system, settings, until, tolerance, seed)
        axes = _axes("parameter", parameters(common["system"]), (x, y), MAPS[system])
        given = {"--set": [setting.partition("=")[0].strip() for setting in settings or []]}
        _check_given_once(given, "--x or --y", [axis.name for axis in axes])
        for axis in axes:
            for end in (axis.low, axis.high):
                changed(common["system"], [f"{axis.name}={end!r}"])
        names = components(common["system"])
        states = tuple(_start(system, start, names) for start in starts or [""])
        plan = Map(**common, starts=states, x=axes[0], y=axes[1])
    return _sweep(plan, chunk, scheduler, output, resume)


@sweep.command("uncertainty", cls=Command)
def sweep_uncertainty(
    system: SystemName,
    settings: Settings = None,
    start: Start = "",
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=DISTRIBUTION",
            help="An uncertain parameter or component of the state at time 0, several times for several.",
            show_default=False,
        ),
    ] = None,
    samples: Annotated[
        str,
        typer.Option(
            metavar="N",
            help="A power of 2; N·(2 + number of uncertain quantities) trajectories are simulated.",
        ),
    ] = "1024",
    until: Until = "",
    tolerance: Tolerance = "1e-9",
    seed: Seed = "1",
    chunk: Chunk = None,
    scheduler: Scheduler = None,
    output: Output = Path("uncertainty"),
    resume: Resume = False,
) -> int:
    """Find how likely the whirl is, how large it is, and what that depends on, where parameters are uncertain.

    \b
    Distributions, with numbers in SI units:
      normal(mean, deviation)        truncnorm(mean, deviation, low, high)
      uniform(low, high)             triangular(low, mode, high)
      lognormal(median, deviation of the logarithm)
    \b
    Example:
      friction-discs sweep uncertainty pin --vary "offset=normal(0.1, 0.005)"
          --vary "friction_force=truncnorm(0.09, 0.01, 0.05, 0.13)" --vary "vx=uniform(-0.1, 0.1)"
    """  # noqa: D301
    from compare.sweep.compute.sensitivity import LEAST_SAMPLES
    from compare.sweep.define.distributions import Uncertain
    from compare.sweep.define.plan import Uncertainty
    from compare.sweep.define.quantities import components

    with refused():
        common = _common(system, settings, until, tolerance, seed)
        varied = tuple(Uncertain.parse(text, common["system"]) for text in vary or [])
        names = [uncertain.name for uncertain in varied]
        _check_varied(names)
        given = {
            "--set": [setting.partition("=")[0].strip() for setting in settings or []],
            "--start": _names_of(start),
        }
        _check_given_once(given, "--vary", names)
        number = count("samples", samples, LEAST_SAMPLES, MOST_SAMPLES)
        if number & (number - 1):
            nearest = 1 << number.bit_length()
            raise ValueError(f"samples = {number}: it must be a power of 2, {nearest} for instance")
        state = _start(system, start, components(common["system"]))
        plan = Uncertainty(**common, start=state, varied=varied, samples=number)
    return _sweep(plan, chunk, scheduler, output, resume)


@sweep.command("figures", cls=Command)
def sweep_figures(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished sweep.")],
) -> None:
    """Draw the figures of a finished sweep once more and print its results.

    \b
    Example:
      friction-discs sweep figures basin
    """  # noqa: D301
    from compare.sweep.compute.store import SweepStore

    with refused():
        store = SweepStore.open(folder / STORE)
        _check_finished(store)
    _finish(store, folder)


def _check_finished(store: SweepStore) -> None:
    from compare.sweep.compute.run import finished

    if finished(store):
        return
    if store.broken:
        raise ValueError(
            f"{str(store.path)!r} is broken ({'; '.join(store.broken)}): --resume computes that again"
        )
    raise ValueError(f"the sweep in {str(store.path)!r} is not finished: --resume goes on with it")


def _common(
    name: str, settings: Sequence[str] | None, until: str, tolerance: str, seed: str
) -> dict[str, Any]:
    """Return what all plans have; raise ``ValueError`` for what can't be."""
    from compare.claims.paper_parameters import FIG5, FIG11
    from compare.engines import known
    from reference_model.support import require_linear_support
    from reference_model.systems import checked_tolerance, finite_number

    papers: Mapping[str, System] = {"pin": FIG5, "disc": FIG11}
    system = changed(papers[known("system", name, papers)], settings or [])
    require_linear_support(system)
    on_points = getattr(system, "contact_points", None) is not None
    return {
        "system": system,
        "duration": positive("until", until or (UNTIL_ON_POINTS if on_points else UNTIL), "s"),
        "tolerance": checked_tolerance(finite_number("tolerance", tolerance)),
        "seed": count("seed", seed, 0, 2**63 - 1),
    }


def _axes(kind: str, names: Mapping[str, str], texts: Sequence[str], defaults: Sequence[str]) -> list[Any]:
    """Return the axes x and y; raise ``ValueError`` for what is none, or the same one twice."""
    from compare.sweep.define.axes import Axis

    axes = [Axis.parse(text or default, kind, names) for text, default in zip(texts, defaults, strict=True)]
    if axes[0].name == axes[1].name:
        raise ValueError(f"{axes[0].name} is on both axes: they must be different")
    if axes[0].points * axes[1].points > MOST_POINTS:
        raise ValueError(
            f"{axes[0].points} times {axes[1].points} points: there may be {MOST_POINTS} in a plane"
        )
    return axes


def _start(system: str, text: str, names: Mapping[str, str]) -> tuple[float, ...]:
    """Return the state of "NAME=VALUE,..."; raise ``ValueError`` for what is none."""
    from compare.engines import known
    from reference_model.systems import finite_number

    state = dict(zip(names, STARTS[system], strict=True))
    for part in filter(None, text.split(",")):
        name, equals, value = part.partition("=")
        if not equals:
            raise ValueError(f"--start {text!r}: write it as NAME=VALUE,NAME=VALUE")
        name = known("component", name.strip(), names)
        if _names_of(text).count(name) > 1:
            raise ValueError(f"--start {text!r}: {name} is there more than once")
        state[name] = finite_number(name, value)
    return tuple(state.values())


def _names_of(text: str) -> list[str]:
    """Return the names in "NAME=VALUE,..."."""
    return [part.partition("=")[0].strip() for part in text.split(",")]


def _check_given_once(given: Mapping[str, Sequence[str]], by: str, names: Sequence[str]) -> None:
    """Raise ``ValueError`` if an option gives a value to what has its values from elsewhere."""
    for option, of_option in given.items():
        for name in of_option:
            if name in names:
                raise ValueError(f"{option} {name}: it has its values from {by}, leave one of them out")


def _check_states(system: System, state: Sequence[float], names: Sequence[str], axes: Sequence[Axis]) -> None:
    """Raise ``ValueError`` if a start in a plane can't be one."""
    from reference_model.systems import checked_state

    for axis in axes:
        for end in (axis.low, axis.high):
            at_end = [end if name == axis.name else value for name, value in zip(names, state, strict=True)]
            checked_state(system, at_end)


def _check_varied(names: Sequence[str]) -> None:
    if not names:
        raise ValueError('nothing is uncertain: say what is, --vary "offset=normal(0.1, 0.005)" for instance')
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"--vary {name}: it is there more than once")


def _sweep(plan: Plan, chunk: str | None, scheduler: str | None, folder: Path, resume: bool) -> int:
    """Run a sweep, or the rest of it; print and draw its results."""
    from compare.run.workers import lacks_memory
    from compare.sweep.compute.executors import ClusterError
    from compare.sweep.compute.run import OtherCodeError, run
    from compare.sweep.compute.store import SweepStore

    path = folder / STORE
    with refused():
        check_folder(folder)
        size = None if chunk is None else count("chunk", chunk, 1, MOST_CHUNK)
        store = _there(path, plan, size, resume)
    try:
        with _executor(scheduler) as executor, _progress() as progress:
            if store is None:
                store = SweepStore.create(path, plan, size or CHUNK)
            run(store, executor, progress)
    except (ClusterError, OtherCodeError) as error:
        return say(f"{error}. The same command with --resume goes on.", SOMETHING_DIFFERS)
    except (OSError, MemoryError) as error:
        if lacks_memory(error):
            return say(
                "there is not enough memory. The same command with --resume goes on.", SOMETHING_DIFFERS
            )
        reason = error.strerror or str(error)  # type: ignore[union-attr]
        return say(
            f"can't write to {str(path)!r}: {reason}. What is written stays valid; "
            "the same command with --resume goes on.",
            BAD_INPUT,
        )
    except KeyboardInterrupt:
        return say("Interrupted. The same command with --resume goes on.", INTERRUPTED)
    finally:
        if store is not None and store.broken:
            say(f"{str(path)!r} was broken and is computed again: {'; '.join(store.broken)}", FINE)
    return _finish(store, folder)


def _there(path: Path, plan: Plan, chunk: int | None, resume: bool) -> SweepStore | None:
    """Return the store to go on with, if there is one; raise ``ValueError`` if it is not that of ``plan``."""
    from compare.sweep.compute.stamp import sweep_stamp
    from compare.sweep.compute.store import SweepStore

    if not path.exists():
        return None
    store = SweepStore.open(path)
    if store.plan != plan:
        raise ValueError(f"{str(path)!r} belongs to another sweep: take another --output")
    if not resume:
        raise ValueError(
            f"{str(path)!r} is there already: --resume goes on with it, or take another --output"
        )
    if store.stamp != sweep_stamp():
        raise ValueError(
            f"{str(path)!r} was computed by other code or libraries ({store.stamp}): take another --output"
        )
    if chunk not in (None, store.chunk):
        raise ValueError(f"chunk = {chunk}: {str(path)!r} has chunks of {store.chunk}")
    return store


@contextmanager
def _executor(scheduler: str | None) -> Iterator[Executor]:
    """Yield what does the work."""
    from compare.sweep.compute.executors import Cluster, ClusterError, InProcess

    if scheduler is None:
        yield InProcess()
        return
    try:
        cluster = Cluster(scheduler)
    except (ValueError, ClusterError) as error:
        raise BadInputError(str(error)) from None
    except ModuleNotFoundError:
        raise BadInputError("--scheduler needs Dask: pip install 'friction-discs[cluster]'") from None
    with cluster:
        yield cluster


def _finish(store: SweepStore, folder: Path) -> int:
    """Print and draw the results; return whether the plain reference finds the same."""
    from compare.sweep.show.figures import write_figures
    from compare.sweep.show.summary import same_ends, summary

    written = write_figures(store, folder)
    with printing():
        for line in summary(store):
            print(line)
        print(f"Results: {store.path}; figures: {', '.join(str(path) for path in written)}")
    return FINE if same_ends(store) else SOMETHING_DIFFERS


@contextmanager
def _progress() -> Iterator[Progress]:
    """Show how much is done, how fast and for how long still on a terminal, and nothing at all elsewhere."""
    if not sys.stderr.isatty():
        yield lambda what, done, total: None
        return
    from rich import progress as rich
    from rich.console import Console
    from rich.text import Text

    class Rate(rich.ProgressColumn):
        def render(self, task: rich.Task) -> Text:
            return Text("" if task.speed is None else f"{task.speed:.3g}/s")

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        Rate(),
        rich.TimeRemainingColumn(),
    )
    with rich.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")

        def show(what: str, done: int, total: int) -> None:
            if bar.tasks[0].description != what:
                bar.reset(task, total=total, completed=done, description=what)
            bar.update(task, completed=done)

        yield show
