"""Commands of ``friction-discs sweep``; each turns its options into a plan."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from compare.cli.command import FINE, SOMETHING_DIFFERS, BadInputError, Command, printing, refused
from compare.cli.options import Settings, Tolerance, changed, with_options
from compare.cli.sweep.options import (
    COARSE,
    STARTS,
    Coarse,
    RandomStarts,
    Request,
    Rows,
    Start,
    Starts,
    Values,
    Varied,
    XAxis,
    YAxis,
)
from compare.cli.sweep.run import redraw
from compare.output.outside_text import one_of

if TYPE_CHECKING:
    from compare.sweep.plan import Plan
    from compare.sweep.quantities import Axis
    from reference_model.systems import System


PLANES = {
    "pin": ("x=-0.3:0.5:257", "vx=-0.4:0.4:257"),
    "disc": ("x=-0.1:0.1:65", "vx=-0.1:0.1:65"),
}
MAPS = {
    "pin": ("disc_speed=1.05:3:64", "friction_force=0.01:0.15:64"),
    "disc": ("disc_speed=1.05:1.95:64", "friction_force=0.005:0.06:64"),
}
"""Default axes x and y."""

ALONG = {"pin": "disc_speed=1.05:3:100", "disc": "disc_speed=1.05:1.95:100"}
SCATTERED = {
    "pin": ("x=uniform(-0.3, 0.5)", "vx=uniform(-0.4, 0.4)"),
    "disc": ("x=uniform(-0.1, 0.1)", "vx=uniform(-0.1, 0.1)"),
}
"""Default axis and random starts of a continuation."""

sweep = typer.Typer(rich_markup_mode=None)


@sweep.callback()
def sweep_command() -> None:
    """Simulate many trajectories.

    Sweeps compute basins of attraction, maps of parameters, effects of uncertain parameters and motions along a
    parameter.

    The defaults are Fig. 5 for a pin and Fig. 11 with X0 = 0 for a disc, as for simulate. Results are written chunk
    by chunk into a Zarr store of labelled arrays, which xarray can open. After an interruption, repeat the command
    with --resume.

    The exit status is 0 if the plain reference confirms a sample of outcomes, and 1 if it does not or the work was
    lost. It is 2 for bad input, 3 if more than half of the trajectories are undecided, and 130 after Ctrl-C.

    \b
    Examples:
      friction-discs sweep basin pin
      friction-discs sweep map disc --help
    """


@sweep.command("basin", cls=Command)
@with_options(Request, output="basin")
def sweep_basin(
    request: Request,
    start: Start = "",
    x: XAxis = "",
    y: YAxis = "",
    coarse: Coarse = None,
    random: RandomStarts = None,
) -> int:
    """Compute basins of attraction in a plane of initial states.

    The results are the outcome (final motion) of each start and the share of each outcome. The command begins with a
    coarse grid and refines it where neighbouring points have different outcomes.

    \b
    Default axes:
      pin   --x x=-0.3:0.5:257 --y vx=-0.4:0.4:257
      disc  --x x=-0.1:0.1:65 --y vx=-0.1:0.1:65
    \b
    Examples:
      friction-discs sweep basin pin --x x=-0.3:0.5:1000 --y vx=-0.4:0.4:1000
      friction-discs sweep basin pin --random 20000 --seed 7 --output shares
    """
    from compare.sweep.plan import Basin, RandomBasin
    from compare.sweep.quantities import Axis, components

    with refused():
        common = request.common()
        names = components(common["system"])
        axes = _axes("component", names, (x, y), PLANES[request.system])
        state = _start(request.system, start, names)
        _check_given_once({"--start": _names_of(start)}, "--x or --y", [axis.name for axis in axes])
        _check_states(common["system"], state, list(names), axes)
        if random is not None and coarse is not None:
            raise ValueError("--coarse cannot be combined with --random")
        if random is None:
            plan: Plan = Basin(**common, start=state, x=axes[0], y=axes[1], coarse=coarse or COARSE)
        else:
            ranges = [Axis(axis.name, axis.low, axis.high, 2) for axis in axes]
            plan = RandomBasin(**common, start=state, x=ranges[0], y=ranges[1], samples=random)
    return request.run(plan)


@sweep.command("map", cls=Command)
@with_options(Request, output="map")
def sweep_map(request: Request, starts: Starts = None, x: XAxis = "", y: YAxis = "") -> int:
    """Map the outcomes over a plane of two parameters.

    The map also shows the theory's boundaries.

    \b
    Default axes:
      pin   --x disc_speed=1.05:3:64 --y friction_force=0.01:0.15:64
      disc  --x disc_speed=1.05:1.95:64 --y friction_force=0.005:0.06:64
    \b
    Examples:
      friction-discs sweep map pin --start x=0.1,vx=0.03 --start x=0.02,vx=0
      friction-discs sweep map disc --x damping=0.2:2:100 --y shaft_damping=0.004:0.026:100
    """
    from compare.sweep.plan import Map
    from compare.sweep.quantities import components, parameters

    with refused():
        common = request.common()
        axes = _axes("parameter", parameters(common["system"]), (x, y), MAPS[request.system])
        _check_given_once({"--set": request.set_names()}, "--x or --y", [axis.name for axis in axes])
        _check_parameters(common["system"], axes)
        names = components(common["system"])
        states = tuple(_start(request.system, start, names) for start in starts or [""])
        plan = Map(**common, starts=states, x=axes[0], y=axes[1])
    return request.run(plan)


@sweep.command("uncertainty", cls=Command)
@with_options(Request, output="uncertainty")
def sweep_uncertainty(request: Request, start: Start = "", vary: Varied = None, samples: Rows = 1024) -> int:
    """Compute the effects of uncertain parameters and starts.

    The results are the probability of the whirl, the distribution of its radius, and the sensitivities of both.

    \b
    Distributions, in SI units:
      normal(mean, deviation)        truncnorm(mean, deviation, low, high)
      uniform(low, high)             triangular(low, mode, high)
      lognormal(median, deviation of the logarithm)
    \b
    Example:
      friction-discs sweep uncertainty pin --vary "offset=normal(0.1, 0.005)"
          --vary "friction_force=truncnorm(0.09, 0.01, 0.05, 0.13)" --vary "vx=uniform(-0.1, 0.1)"
    """
    from compare.sweep.distributions import Uncertain
    from compare.sweep.plan import Uncertainty
    from compare.sweep.quantities import components

    with refused():
        common = request.common()
        varied = tuple(Uncertain.parse(text, common["system"]) for text in vary or [])
        names = [uncertain.name for uncertain in varied]
        _check_varied(names)
        _check_given_once({"--set": request.set_names(), "--start": _names_of(start)}, "--vary", names)
        state = _start(request.system, start, components(common["system"]))
        plan = Uncertainty(**common, start=state, varied=varied, samples=samples)
    return request.run(plan)


@sweep.command("continuation", cls=Command)
@with_options(Request, output="continuation")
def sweep_continuation(
    request: Request, start: Start = "", x: XAxis = "", vary: Varied = None, samples: Values = 1000
) -> int:
    """Follow the outcomes of random starts along one parameter.

    The starts are the same at each value, and the command connects the final motions into branches. The figure also
    shows the stable and unstable motions that formulas and continuation give.

    \b
    Default axis and starts:
      pin   --x disc_speed=1.05:3:100 --vary "x=uniform(-0.3, 0.5)" --vary "vx=uniform(-0.4, 0.4)"
      disc  --x disc_speed=1.05:1.95:100 --vary "x=uniform(-0.1, 0.1)" --vary "vx=uniform(-0.1, 0.1)"
    \b
    Example:
      friction-discs sweep continuation pin --x friction_force=0.02:0.12:50 --samples 4000
    """
    from compare.sweep.distributions import Uncertain
    from compare.sweep.plan import Continuation
    from compare.sweep.quantities import Axis, components, parameters

    with refused():
        common = request.common()
        axis = Axis.parse(x or ALONG[request.system], "parameter", parameters(common["system"]))
        _check_given_once({"--set": request.set_names()}, "--x", [axis.name])
        _check_parameters(common["system"], [axis])
        varied = tuple(Uncertain.parse(text, common["system"]) for text in vary or SCATTERED[request.system])
        names = [one.name for one in varied]
        _check_varied(names)
        for name in names:
            one_of("component", name, components(common["system"]))
        _check_given_once({"--start": _names_of(start)}, "--vary", names)
        state = _start(request.system, start, components(common["system"]))
        plan = Continuation(**common, start=state, x=axis, varied=varied, samples=samples)
    return request.run(plan)


@sweep.command("figures", cls=Command)
def sweep_figures(
    folder: Annotated[str, typer.Argument(metavar="DIR|URL", help="Folder or URL of a finished sweep.")],
) -> int:
    """Redraw and print the results of a finished sweep.

    \b
    Example:
      friction-discs sweep figures basin
    """
    return redraw(folder)


def _axes(kind: str, names: Mapping[str, str], texts: Sequence[str], defaults: Sequence[str]) -> list[Any]:
    from compare.sweep.quantities import Axis

    axes = [Axis.parse(text or default, kind, names) for text, default in zip(texts, defaults, strict=True)]
    if axes[0].name == axes[1].name:
        raise ValueError(f"{axes[0].name} is on both axes; --x and --y must be different quantities")
    return axes


def _start(system: str, text: str, names: Mapping[str, str]) -> tuple[float, ...]:
    from reference_model.systems import number_in_text

    state = dict(zip(names, STARTS[system], strict=True))
    for part in filter(None, text.split(",")):
        name, equals, value = part.partition("=")
        if not equals:
            raise ValueError(f"--start {text!r}: write it as NAME=VALUE,NAME=VALUE")
        name = one_of("component", name.strip(), names)
        if _names_of(text).count(name) > 1:
            raise ValueError(f"--start {text!r}: {name} is given more than once")
        state[name] = number_in_text(name, value)
    return tuple(state.values())


def _names_of(text: str) -> list[str]:
    return [part.partition("=")[0].strip() for part in text.split(",")]


def _check_given_once(given: Mapping[str, Sequence[str]], by: str, names: Sequence[str]) -> None:
    for option, of_option in given.items():
        for name in of_option:
            if name in names:
                raise ValueError(f"{option} {name}: {by} already varies {name}; leave one of them out")


def _check_parameters(system: System, axes: Sequence[Axis]) -> None:
    for axis in axes:
        for end in (axis.low, axis.high):
            changed(system, [f"{axis.name}={end!r}"])


def _check_states(system: System, state: Sequence[float], names: Sequence[str], axes: Sequence[Axis]) -> None:
    from reference_model.systems import checked_state

    for axis in axes:
        for end in (axis.low, axis.high):
            at_end = [end if name == axis.name else value for name, value in zip(names, state, strict=True)]
            checked_state(system, at_end)


def _check_varied(names: Sequence[str]) -> None:
    if not names:
        raise ValueError(
            'no uncertain quantity given; use --vary, for example --vary "offset=normal(0.1, 0.005)"'
        )
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"--vary {name} is given more than once; give it once")


# --- Smallest shock that leads to the whirl

AGREEMENT = 1e-6  # largest relative difference between the orbit's result and the bisection


def sweep_shock(settings: Settings = None, tolerance: Tolerance = 1e-9) -> int:
    """Find the smallest shock that moves a pin to the whirl.

    The pin starts in its self-centred equilibrium. The shock is the smallest change of velocity that reaches the
    boundary of the basin, the stable manifold of a stick–slip orbit. A bisection with simulated motions checks it.

    \b
    Example:
      friction-discs sweep shock --set disc_speed=2
    """
    from compare.claims.parameters import FIG5
    from reference_model import smallest_shock
    from reference_model.orbits.shock import by_bisection
    from reference_model.systems import PinOnDisc

    with refused():
        pin = changed(FIG5, settings or [])
    assert isinstance(pin, PinOnDisc)
    try:
        shock = smallest_shock(pin, tolerance=tolerance)
        checked = by_bisection(shock)
    except ArithmeticError:
        raise BadInputError("the parameters differ by too many orders of magnitude to find a shock") from None
    except (ValueError, RuntimeError) as error:
        raise BadInputError(str(error)) from None
    difference = abs(checked / shock.speed - 1.0)
    with printing():
        print(
            f"smallest shock that leads to the whirl: {shock.impulse:.9g} N s, a velocity change of "
            f"{shock.speed:.9g} m/s, ({shock.vx:.6g}, {shock.vy:.6g}) m/s"
        )
        print(f"  direction: {math.degrees(shock.direction):.2f}° from the x-axis")
        print(f"  check by bisection: {checked:.9g} m/s, relative difference {difference:.0e}")
    return FINE if difference <= AGREEMENT else SOMETHING_DIFFERS
