"""Engines: whatever can simulate a system takes part in the comparison, with the systems that it promises.

A study of a single system just calls ``engine.simulate``: where the engine never promised that system, the report
says "not simulated" in place of its claims, which is neither a pass nor a failure. A study of several systems
measures those that the engine simulates and hands on what is missing::

    mine = [disc for disc in discs if engine.simulates(disc)]
    return Findings(claims_of(mine), data_of(mine), not_simulated=engine.lacking(discs))

What an engine returns is looked at before a study sees it: times and shapes as asked for, numbers all finite.
"""

from __future__ import annotations

import difflib
import functools
import importlib
import math
import os
import reprlib
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib.metadata import entry_points
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from reference_model.support import Support
from reference_model.systems import PinOnDisc, System, finite_number
from reference_model.trajectory import Trajectory

# A user's ~/.exudyn/config.json would change what is measured. Exudyn reads it when it is imported: after this, since
# every study imports this module, and in all processes that are started from here.
os.environ["EXUDYN_NO_USER_SETTINGS"] = "1"

KINDS = {"pin": "a pin", "points": "a disc on single points", "ring": "a disc on a continuous ring"}
"""The kinds of systems that an engine may promise, and what they are in words."""

EVERY_KIND = tuple(KINDS)


class Simulate(Protocol):
    """The one function that an engine implements.

    ``tolerance`` is the accuracy to aim at: whatever the engine approximates (step, iteration, a smoothed
    friction law) must get better when it gets smaller, because errors are estimated by tightening it.
    """

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        """Return the motion of ``system`` from ``initial_state`` (at ``times[0]``) at all ``times``."""
        ...


class UnsupportedSystemError(ValueError):
    """An engine was asked for a system or motion that it never promised to simulate; the message says which."""


class BadTrajectoryError(RuntimeError):
    """An engine returned what is no answer to the question; the message says why."""


ENTRY_POINTS = "friction_discs.engines"
"""The group of entry points in which an installed package names its engines: ``mine = "package.module:simulate"``."""

USUAL_TOLERANCE = 1e-9

DECLARED = ("kinds", "sticks", "nonlinear", "step")
"""Attributes of a function that say what it is for, named like the parameters of ``Engine``."""

TIME_ROUNDING = 1e-12
"""Relative: times of the same grid that were added up in another order agree to this."""


@dataclass(frozen=True)
class Engine:
    """A name, a simulate() and what it is for.

    Parameters
    ----------
    name : str
        As on the command line.
    function : callable
        The engine's ``simulate``; to take part in work on several cores, a function of an importable module.
    kinds : tuple of str
        What ``function`` promises to simulate: "pin", "points" (a disc on single points), "ring" (a disc on the
        continuous ring).
    sticks : bool
        Whether it simulates motions that stick. An engine that does not is asked for motions only in which the
        reference finds none.
    nonlinear : bool
        Whether it simulates supports that harden or have a stop.
    step : float, optional
        For an integrator with a fixed step, which takes ``step`` in place of ``tolerance``: the step in s for a
        tolerance of 1e-9. It goes with the square root of the tolerance.
    kin : str
        Name of the engine whose code it shares, so that neither is independent evidence about the other.
    contact_only : bool
        Whether all but its contact is its kin's: then it is measured only where the contact decides, see
        ``Study.contact``, unless it is asked for by its name.
    about : str
        What a reader of the report has to know of it, in a sentence or two.

    Raises
    ------
    ValueError
        For a kind that there is not, a step that is not > 0, or ``sticks`` or ``nonlinear`` that is no yes or no.

    """

    name: str
    function: Callable[..., Trajectory]
    kinds: tuple[str, ...] = ("pin",)
    sticks: bool = True
    nonlinear: bool = True
    step: float | None = None
    kin: str = ""
    contact_only: bool = False
    about: str = ""

    def __post_init__(self) -> None:
        """Refuse a promise that no study could ask for."""
        object.__setattr__(self, "kinds", tuple(self.kinds))
        for kind in self.kinds:
            one_of("kind of system", kind, KINDS)
        for name in ("sticks", "nonlinear"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"{name} = {getattr(self, name)!r}: it must be True or False")
        if self.step is not None:
            object.__setattr__(self, "step", finite_number("step", self.step))
            if self.step <= 0.0:
                raise ValueError(f"step = {self.step:g} s: it must be > 0")

    def simulate(
        self,
        system: System,
        initial_state: ArrayLike,
        times: ArrayLike,
        *,
        tolerance: float = USUAL_TOLERANCE,
    ) -> Trajectory:
        """Do as ``function``, and look at what it returns.

        Raises
        ------
        UnsupportedSystemError
            For a system or a motion that the engine does not promise.
        TypeError
            If the function returns no ``Trajectory``.
        BadTrajectoryError
            If it is not the one that was asked for, or has numbers that are not finite.

        """
        if not self.simulates(system):
            raise UnsupportedSystemError(self.lacking([system]))
        if not self.sticks and not _slips(system, tuple(np.ravel(initial_state)), *_ends(times)):
            raise UnsupportedSystemError(f"{self.name} does not simulate stick")
        accuracy = {"tolerance": tolerance} if self.step is None else {"step": self._step(tolerance)}
        return _checked(self.function(system, initial_state, times, **accuracy), system, times)

    def _step(self, tolerance: float) -> float:
        """Return the step in s, which goes with the square root of ``tolerance``.

        Where errors are estimated, see ``compare.claims.error_estimates.COARSENING``, an error of first order then
        falls to a third.
        """
        return (self.step or 0.0) * math.sqrt(tolerance / USUAL_TOLERANCE)

    def simulates(self, system: System) -> bool:
        """Return whether the engine promises to simulate ``system``."""
        return _kind(system) in self.kinds and (self.nonlinear or Support.of(system).linear)

    def lacking(self, systems: Iterable[System]) -> str:
        """Return in a sentence what of ``systems`` the engine does not simulate, "" if it simulates all."""
        words = dict.fromkeys(
            KINDS[_kind(system)] + (" on a nonlinear support" if _kind(system) in self.kinds else "")
            for system in systems
            if not self.simulates(system)
        )
        return f"{self.name} does not simulate {' or '.join(words)}" if words else ""


def _kind(system: System) -> str:
    if isinstance(system, PinOnDisc):
        return "pin"
    return "ring" if system.contact_points is None else "points"


def _ends(times: ArrayLike) -> tuple[float, float]:
    times = np.asarray(times, dtype=float)
    return float(times[0]), float(times[-1])


@functools.lru_cache(maxsize=64)  # the same motion is asked for at two tolerances, one after the other
def _slips(system: System, initial_state: tuple[float, ...], start: float, end: float) -> bool:
    """Return whether the contact slips from ``start`` to ``end``, by the reference."""
    import reference_model

    phases = reference_model.simulate(system, initial_state, [start, end], tolerance=1e-6).phases
    return all(phase.kind == "slip" for phase in phases)


def _checked(trajectory: object, system: System, times: ArrayLike) -> Trajectory:
    """Return ``trajectory`` if it is one of ``system`` at ``times`` (n,); raise ``BadTrajectoryError`` otherwise."""
    if not isinstance(trajectory, Trajectory):
        raise TypeError(f"simulate() returned {reprlib.repr(trajectory)}: it must be a Trajectory")
    asked, got = np.asarray(times, dtype=float), np.asarray(trajectory.times)
    if got.shape != asked.shape:
        raise BadTrajectoryError(
            f"the trajectory's times have shape {got.shape}: {asked.shape} were asked for"
        )
    strange = ~(np.abs(got - asked) <= TIME_ROUNDING * np.max(np.abs(asked)))  # also true for NaN
    if np.any(strange):
        i = int(np.argmax(strange))
        raise BadTrajectoryError(
            f"the trajectory's times[{i}] = {float(got[i])!r} s: {float(asked[i])!r} s was asked for"
        )
    states, shape = np.asarray(trajectory.states), (len(asked), system.state_size)
    if states.shape != shape:
        raise BadTrajectoryError(f"the trajectory's states have shape {states.shape}: they must have {shape}")
    broken = ~np.all(np.isfinite(states), axis=1)
    if np.any(broken):
        i = int(np.argmax(broken))
        raise BadTrajectoryError(f"the state at t = {asked[i]:g} s is not finite: {states[i].tolist()}")
    return trajectory


_REGISTRY: dict[str, Engine] = {}
_ON_REQUEST: set[str] = set()


def register(engine: Engine, *, on_request: bool = False) -> Engine:
    """Add ``engine`` to those that every study runs, or that are only run where they are named.

    Raises ``ValueError`` if its name is taken.
    """
    if engine.name in _REGISTRY or engine.name == "theory":
        raise ValueError(f"engine {engine.name!r}: the name is taken")
    _REGISTRY[engine.name] = engine
    if on_request:
        _ON_REQUEST.add(engine.name)
    return engine


def engines(names: Iterable[str] = ()) -> tuple[Engine, ...]:
    """Return the engines of the given names, or all that are registered but those on request.

    One that is named is measured in all that it promises, see ``Engine.contact_only``.
    A name of the form "module:function" is imported (from the current folder too) and needs no registration, nor
    does one of the entry points "friction_discs.engines" of an installed package.
    Raises ``ValueError`` for a name that is unknown or can't be imported.
    """
    return tuple(_named(name) for name in names) or tuple(
        engine for name, engine in _REGISTRY.items() if name not in _ON_REQUEST
    )


def on_request() -> tuple[Engine, ...]:
    """Return the registered engines that take part only where they are named."""
    return tuple(_REGISTRY[name] for name in sorted(_ON_REQUEST))


def shares_code(name: str, other: str) -> bool:
    """Return whether the engine called ``name`` is the one called ``other``, or shares code with it."""
    return name == other or (name in _REGISTRY and _REGISTRY[name].kin == other)


def repeated_by(name: str) -> str:
    """Return the engine that the one called ``name`` repeats in all but its contact, "" if there is none."""
    engine = _REGISTRY.get(name)
    return engine.kin if engine is not None and engine.contact_only else ""


def _named(name: str) -> Engine:
    if ":" in name:
        return imported(name, name)
    if name in _REGISTRY:
        return replace(_REGISTRY[name], contact_only=False)
    return imported(name, _installed()[known_name(name)])


def known_name(name: str) -> str:
    """Return ``name`` if an engine can be looked for by it; raise ``ValueError`` that suggests one otherwise."""
    return name if ":" in name else one_of("engine", name, [*_REGISTRY, *_installed()])


def _installed() -> dict[str, str]:
    """Return "module:function" of the engines of installed packages, by name."""
    return {point.name: point.value for point in entry_points(group=ENTRY_POINTS)}


def imported(name: str, place: str) -> Engine:
    """Return the engine of the function at ``place``, "module:function"; raise ``ValueError`` if there is none.

    It is taken for an engine of the pin only, unless attributes of the function, named like the parameters of
    ``Engine``, say something else::

        simulate.kinds = ("pin", "points", "ring")
        simulate.sticks = False
        simulate.nonlinear = False
        simulate.step = 1e-3
    """
    module_name, _, function_name = place.partition(":")
    if os.getcwd() not in sys.path:  # a console script does not look into the current folder
        sys.path.append(
            os.getcwd()
        )  # last, or a file of the user's would take the place of a library's module
    try:
        simulate = getattr(importlib.import_module(module_name), function_name)
    except Exception as error:  # whatever a module may do when it is imported
        kind = "" if isinstance(error, ImportError | AttributeError) else f"{type(error).__name__}: "
        raise ValueError(f"engine {name!r} can't be imported: {kind}{error}") from None
    if not callable(simulate):
        raise ValueError(f"engine {name!r} is no function")
    declared = {key: getattr(simulate, key) for key in DECLARED if hasattr(simulate, key)}
    try:
        return Engine(name, simulate, **declared)
    except (TypeError, ValueError) as error:
        attributes = ", ".join(f"{key} = {value!r}" for key, value in declared.items())
        raise ValueError(f"engine {name!r}, attribute {attributes}: {error}") from None


def one_of(kind: str, name: str, names: Iterable[str]) -> str:
    """Return ``name`` if it is among ``names``; raise ``ValueError`` that suggests the nearest otherwise."""
    names = list(names)
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"known are {', '.join(names)}"
    raise ValueError(f"unknown {kind} {name!r}: {hint}")


@dataclass(frozen=True)
class ByName:
    """Calls a function of a module that is imported then: the command line must start without SciPy and Exudyn."""

    module: str
    function: str

    def __call__(self, *arguments: Any, **options: Any) -> Trajectory:
        """Call it."""
        trajectory: Trajectory = getattr(importlib.import_module(self.module), self.function)(
            *arguments, **options
        )
        return trajectory


_simulate_reference = ByName("reference_model", "simulate")

reference = register(Engine("reference", _simulate_reference, EVERY_KIND))
exudyn = register(Engine("exudyn", ByName("exudyn_models", "simulate"), EVERY_KIND))
exudyn_native = register(
    Engine(
        "exudyn-native",
        ByName("exudyn_models", "simulate_with_native_contact"),
        ("pin", "points"),
        kin="exudyn",
        contact_only=True,
        about="exudyn-native is Exudyn with its built-in contact in place of the connector of exudyn_models. "
        "Integrator, support and the smoothing of friction are the same, so it is asked only where the contact's own "
        "code decides: the contact by itself, a motion of each kind, a whirl, and free bodies. With --engine "
        "exudyn-native it is measured in all that it simulates.",
    )
)
compiled = register(
    Engine(
        "compiled",
        functools.partial(_simulate_reference, compiled=True),
        EVERY_KIND,
        nonlinear=False,
        kin="reference",
    ),
    on_request=True,
)
plain = register(
    Engine(
        "plain",
        ByName("reference_model.plain", "simulate"),
        EVERY_KIND,
        sticks=False,
        about="plain is the equations as the paper prints them, integrated by SciPy, with friction that is viscous "
        "at slow slip: what sticks creeps, and it tells no stick from slip. It takes only the parameters from the "
        "reference.",
    ),
    on_request=True,
)
