"""An engine: a function that simulates, and what it promises."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.answer import BadTrajectoryError, as_many_as, checked
from compare.engines.precision import LEAST_PRECISE, USUAL_TOLERANCE, blurred, blurred_start
from compare.engines.stick import StatesOnly, slip_of
from compare.output.outside_text import one_line, one_of
from reference_model.support import Support
from reference_model.systems import FloatArray, PinOnDisc, System, finite_number
from reference_model.trajectory import Trajectory

KINDS = {
    "block": "a block on a plane at rest",
    "pin": "a pin",
    "points": "a disc on single points",
    "ring": "a disc on a continuous ring",
}
"""The kinds of systems that an engine may promise, and what they are in words.

A block is a pin on a disc that does not turn: who simulates pins simulates blocks as well.
"""

EVERY_KIND = tuple(KINDS)


LEAST_STEP = 1e-9
"""In s: with a shorter one the studies' motions of 10 s and more would take over 10¹⁰ steps."""

COARSE_STEP = 30.0
"""How coarse a fixed step is, see ``StatesOnly``: contact that sticks along tangents creeps by ωh/2 of its speed."""


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


class SimulateMany(Protocol):
    """What an engine may implement besides: many motions at once, at a tolerance as in ``Simulate``."""

    def __call__(
        self,
        systems: list[System],
        initial_states: list[ArrayLike],
        times: list[ArrayLike],
        **accuracy: float,
    ) -> Sequence[Trajectory]:
        """Return what ``Simulate`` does for each of as many systems, states and times."""
        ...


class UnsupportedSystemError(ValueError):
    """An engine was asked for a system or motion that it never promised to simulate; the message says which."""


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
        What ``function`` promises to simulate: "block" (a pin on a disc that does not turn), "pin" (blocks too),
        "points" (a disc on single points), "ring" (a disc on the continuous ring).
    sticks : bool
        Whether it simulates motions that stick. An engine that does not is asked for motions only in which the
        reference finds none, and which do not start at rest on the disc below.
    nonlinear : bool
        Whether it simulates supports that harden or have a stop.
    phases : bool
        Whether its trajectories tell when bodies stick. Otherwise, and where one has no phases at all, stick is found
        from the states, see ``compare.engines.stick``.
    precision : float
        What its states may be off by whatever the tolerance, relative to the motion's own lengths and speeds:
        1e-6 for single precision. See ``compare.engines.precision``.
    step : float, optional
        For an integrator with a fixed step, which takes ``step`` in place of ``tolerance``: the step in s for a
        tolerance of 1e-9, see ``step_at``.
    order : float
        By which errors fall with a fixed step.
    kin : str
        Name of the engine whose code it shares, so that neither is independent evidence about the other.
    contact_only : bool
        Whether all but its contact is its kin's: then it is measured only where the contact decides, see
        ``Study.contact``, unless it is asked for by its name.
    version : str
        What the engine calls its version.
    about : str
        What a reader of the report has to know of it, in a sentence or two.

    Raises
    ------
    ValueError
        For a kind that there is not, a step below ``LEAST_STEP``, or ``sticks``, ``nonlinear`` or ``phases`` that is
        not True or False.

    """

    name: str
    function: Callable[..., Trajectory]
    kinds: tuple[str, ...] = ("pin",)
    sticks: bool = True
    nonlinear: bool = True
    phases: bool = True
    precision: float = 0.0
    step: float | None = None
    order: float = 1.0
    kin: str = ""
    contact_only: bool = False
    version: str = ""
    about: str = ""

    def __post_init__(self) -> None:
        """Refuse a promise that no study could ask for."""
        for name in ("name", "version", "about"):
            object.__setattr__(self, name, one_line(getattr(self, name)))
        object.__setattr__(self, "kinds", tuple(self.kinds))
        for kind in self.kinds:
            one_of("kind of system", kind, KINDS)
        for name in ("sticks", "nonlinear", "phases"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"{name} = {getattr(self, name)!r}: it must be True or False")
        object.__setattr__(self, "precision", finite_number("precision", self.precision))
        if not 0.0 <= self.precision <= LEAST_PRECISE:
            raise ValueError(f"precision = {self.precision:g}: it must lie between 0 and {LEAST_PRECISE:g}")
        if self.step is not None:
            object.__setattr__(self, "step", finite_number("step", self.step))
            if self.step < LEAST_STEP:
                raise ValueError(f"step = {self.step:g} s: it must be at least {LEAST_STEP:g} s")
        object.__setattr__(self, "order", finite_number("order", self.order))
        if self.order <= 0.0:
            raise ValueError(f"order = {self.order:g}: it must be > 0")

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
        self._refuse(system, initial_state, times)
        answer = self.function(
            system, self._start(system, initial_state, tolerance), times, **self._accuracy(tolerance)
        )
        return self._seen(answer, system, initial_state, times, tolerance)

    def simulate_many(
        self, motions: Iterable[tuple[System, ArrayLike, ArrayLike]], *, tolerance: float = USUAL_TOLERANCE
    ) -> list[Trajectory]:
        """Return the motion of each system from its initial state at its times, as ``simulate`` does.

        They are asked for at once where ``function`` has an attribute ``simulate_many``, a function of the systems,
        the initial states and the times, each a list, else one after the other.

        Raises
        ------
        UnsupportedSystemError, TypeError, BadTrajectoryError
            As ``simulate`` does, or for another number of trajectories than was asked for.

        """
        motions = list(motions)
        at_once: SimulateMany | None = getattr(self.function, "simulate_many", None)
        if at_once is None:
            return [self.simulate(*motion, tolerance=tolerance) for motion in motions]
        for motion in motions:
            self._refuse(*motion)
        systems = [system for system, _, _ in motions]
        starts = [self._start(system, state, tolerance) for system, state, _ in motions]
        answers = at_once(systems, starts, [times for *_, times in motions], **self._accuracy(tolerance))
        found = []
        for i, answer in enumerate(as_many_as(answers, len(motions))):
            try:
                found.append(self._seen(answer, *motions[i], tolerance))
            except BadTrajectoryError as error:
                raise BadTrajectoryError(f"motion {i + 1} of {len(motions)}: {error}") from None
        return found

    def _refuse(self, system: System, initial_state: ArrayLike, times: ArrayLike) -> None:
        """Raise ``UnsupportedSystemError`` for a motion that the engine does not promise."""
        if not self.simulates(system):
            raise UnsupportedSystemError(self.lacking([system]))
        if not self.sticks and not _slips(system, tuple(np.ravel(initial_state)), *_ends(times)):
            raise UnsupportedSystemError(f"{self.name} does not simulate stick")

    def _accuracy(self, tolerance: float) -> dict[str, float]:
        return {"tolerance": tolerance} if self.step is None else {"step": self.step_at(tolerance)}

    def _start(self, system: System, initial_state: ArrayLike, tolerance: float) -> ArrayLike:
        """Return the state that the function is asked to start from."""
        if self.precision == 0.0:
            return initial_state
        return blurred_start(system, np.asarray(initial_state, dtype=float), self.precision, tolerance)

    def _seen(
        self, answer: object, system: System, initial_state: ArrayLike, times: ArrayLike, tolerance: float
    ) -> Trajectory:
        """Return the function's ``answer`` as studies see it: looked at, in its precision, and with its stick."""

        def looked_at(answer: object, times: ArrayLike) -> Trajectory:
            found = checked(answer, system, times)
            if self.precision == 0.0:
                return found
            return blurred(found, self.precision, tolerance, np.asarray(initial_state, dtype=float))

        def more(times: FloatArray) -> FloatArray:
            start = self._start(system, initial_state, tolerance)
            return looked_at(self.function(system, start, times, **self._accuracy(tolerance)), times).states

        found = looked_at(answer, times)
        if (self.phases and found.phases) or any(phase.kind != "slip" for phase in found.phases):
            return found
        coarseness = tolerance / USUAL_TOLERANCE
        if self.step is not None:
            coarseness = COARSE_STEP * self.step_at(tolerance) / self.step
        return StatesOnly(found, more, coarseness, self.precision)

    @property
    def root(self) -> float:
        """The root of the tolerance with which a fixed step goes: its order, so that errors go with the tolerance.

        It is 2 for orders below, whose steps would become too many: where errors are estimated, at an eighth of the
        tolerance, an error of first order then falls to a third.
        """
        return max(self.order, 2.0)

    def step_at(self, tolerance: float) -> float:
        """Return the fixed step in s at ``tolerance``."""
        return (self.step or 0.0) * math.pow(tolerance / USUAL_TOLERANCE, 1.0 / self.root)

    def simulates(self, system: System) -> bool:
        """Return whether the engine promises to simulate ``system``."""
        return self._promises(_kind(system)) and (self.nonlinear or Support.of(system).linear)

    def _promises(self, kind: str) -> bool:
        return kind in self.kinds or (kind == "block" and "pin" in self.kinds)

    def lacking(self, systems: Iterable[System]) -> str:
        """Return in a sentence what of ``systems`` the engine does not simulate, "" if it simulates all."""
        words = dict.fromkeys(
            KINDS[_kind(system)] + (" on a nonlinear support" if self._promises(_kind(system)) else "")
            for system in systems
            if not self.simulates(system)
        )
        return f"{self.name} does not simulate {' or '.join(words)}" if words else ""


def _kind(system: System) -> str:
    if isinstance(system, PinOnDisc):
        return "block" if system.disc_speed == 0.0 else "pin"
    return "ring" if system.contact_points is None else "points"


def _ends(times: ArrayLike) -> tuple[float, float]:
    times = np.asarray(times, dtype=float)
    return float(times[0]), float(times[-1])


@functools.lru_cache(maxsize=64)  # the same motion is asked for at two tolerances, one after the other
def _slips(system: System, initial_state: tuple[float, ...], start: float, end: float) -> bool:
    """Return whether the contact slips from ``start``, and then on, to ``end``, by the reference."""
    import reference_model

    run = reference_model.simulate(system, initial_state, [start, end], tolerance=1e-6)
    # without slip, friction has a direction only for who knows what it holds
    return slip_of(run)[0] > 0.0 and all(phase.kind == "slip" for phase in run.phases)
