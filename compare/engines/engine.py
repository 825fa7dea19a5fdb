"""An engine: a function that simulates, and the kinds of systems that it supports."""

import functools
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.answer import BadTrajectoryError, as_many_as, checked
from compare.engines.precision import (
    LEAST_PRECISE,
    SINGLE,
    USUAL_TOLERANCE,
    are_single,
    blurred,
    blurred_start,
)
from compare.engines.ranges import EVERYWHERE, Ranges
from compare.engines.stick import StatesOnly, slip_of
from compare.engines.units import InOtherUnits
from compare.output.outside_text import one_line, one_of
from reference_model.support import Support
from reference_model.systems import (
    FloatArray,
    PinOnDisc,
    finite_number,
    require_callable,
    require_flag,
    require_kind,
    require_whole,
)
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Trajectory

KINDS = {
    "block": "a block on a plane at rest",
    "pin": "a pin",
    "points": "a disc on single points",
    "ring": "a disc on a continuous ring",
    "joint": "a joint with friction",
}
"""Kinds of systems that an engine may simulate. A block is a pin on a disc at rest."""

EVERY_KIND = ("block", "pin", "points", "ring")
"""Kinds of the systems of the paper."""


LEAST_STEP = 1e-9
"""Shortest fixed step in s."""

COARSE_STEP = 30.0
"""Coarseness of a fixed step, see ``StatesOnly``; a contact stuck along tangents creeps at ωh/2 of its speed."""


class Simulate(Protocol):
    """The one function that an engine must implement. All its approximations must improve with ``tolerance``."""

    def __call__(
        self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        """Return the motion of ``system`` from ``initial_state`` (at ``times[0]``) at all ``times``."""
        ...


class UnsupportedSystemError(ValueError):
    """The engine does not simulate the requested system or motion; the message says which."""


class DeclaredLackError(UnsupportedSystemError):
    """The engine declares that it does not simulate the requested system or motion."""


class OutOfRangeError(DeclaredLackError):
    """The requested motion leaves the ranges that the engine declares; the message says which."""


@dataclass(frozen=True)
class Engine:
    """An engine's name, its ``simulate``, and its capabilities.

    - ``function``: the engine's ``simulate``, of an importable module if several processes are to use it.
    - ``kinds``: the ``KINDS`` of systems that it simulates; "pin" includes blocks.
    - ``sticks``: True if it simulates motions that stick. Otherwise it gets only motions that neither stick in the
      reference nor start at rest on the master disc.
    - ``nonlinear``: True if it simulates supports that harden or have a stop.
    - ``phases``: True if its trajectories contain the stick phases. Otherwise ``compare.engines.stick`` finds them.
    - ``precision``: declared error of its states at any tolerance, relative to the lengths and speeds of the motion,
      see ``noise``.
    - ``step``: fixed step in s for a tolerance of 1e-9, if any; ``function`` then takes ``step`` in place of
      ``tolerance``.
    - ``order``: order of the error in a fixed step.
    - ``kin``: name of the engine whose code it shares; neither is independent evidence for the other.
    - ``contact_only``: True if it shares all but the contact with its kin. Unless requested by name, it is then
      measured only in studies of the contact, see ``Study.contact``.
    - ``about``: one or two sentences for readers of the report.
    - ``ranges``: its largest coordinate, speed and time, and its masses, as ``Ranges`` or a mapping.
    - ``seed``: seed of the units that ``function`` receives, see ``compare.engines.units``. None for SI units.

    Raises ``ValueError`` if an argument is unknown, out of range or of another type.
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
    seed: int | None = None
    ranges: Ranges | Mapping[str, object] = EVERYWHERE
    _seen_noise: float = field(default=0.0, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("name", "kin", "version", "about"):
            require_kind(name, getattr(self, name), str)
            object.__setattr__(self, name, one_line(getattr(self, name)))
        if not self.name:
            raise ValueError("name = '': it must not be empty")
        require_callable("function", self.function)
        object.__setattr__(self, "ranges", Ranges.of(self.ranges))
        require_kind("kinds", self.kinds, tuple, list)
        object.__setattr__(self, "kinds", tuple(self.kinds))
        if not self.kinds:
            raise ValueError(f"kinds = (): it must contain at least one of {', '.join(KINDS)}")
        for kind in self.kinds:
            require_kind("kinds", kind, str)
            one_of("kind of system", kind, KINDS)
        if self.seed is not None:
            require_whole("seed", self.seed, least=0)
        for name in ("sticks", "nonlinear", "phases", "contact_only"):
            require_flag(name, getattr(self, name))
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
        system: AnySystem,
        initial_state: ArrayLike,
        times: ArrayLike,
        *,
        tolerance: float = USUAL_TOLERANCE,
    ) -> Trajectory:
        """Call ``function``, check the trajectory and return it.

        Raises ``UnsupportedSystemError`` if the engine does not simulate the motion, ``TypeError`` if ``function``
        does not return a ``Trajectory``, and ``BadTrajectoryError`` if the trajectory is invalid.
        """
        self._refuse(system, initial_state, times)
        answer = self._asked(
            system, self._start(system, initial_state, tolerance), times, **self._accuracy(tolerance)
        )
        return self._seen(answer, system, initial_state, times, tolerance)

    def simulate_many(
        self, motions: Iterable[tuple[AnySystem, ArrayLike, ArrayLike]], *, tolerance: float = USUAL_TOLERANCE
    ) -> list[Trajectory]:
        """Return the motion of each system from its initial state at its times.

        If ``function`` has an attribute ``simulate_many``, one call with lists of systems, initial states and times
        computes all motions. Raises the errors of ``simulate``.
        """
        motions = list(motions)
        at_once = getattr(self._asked, "simulate_many", None)
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

    @property
    def noise(self) -> float:
        """The declared precision, or single precision if the engine has returned such numbers."""
        return self.precision or self._seen_noise

    @property
    def is_smooth(self) -> bool:
        """True if errors depend smoothly on the tolerance: no fixed step and no limited precision.

        Otherwise differences within the resolution of a claim are negligible.
        """
        return self.step is None and self.noise == 0.0

    @property
    def limits(self) -> Ranges:
        """The declared ranges."""
        return Ranges.of(self.ranges)

    @property
    def _asked(self) -> Callable[..., Any]:
        return self.function if self.seed is None else InOtherUnits(self.function, self.seed)

    def _refuse(self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike) -> None:
        if not self.simulates(system):
            raise DeclaredLackError(self.lacking([system]))
        ends = np.asarray(times, dtype=float)[[0, -1]].tolist()
        if not self.sticks and not _slips(system, tuple(np.ravel(initial_state)), *ends):
            raise DeclaredLackError(f"{self.name} does not simulate stick")
        motion = system, initial_state, times
        asked = motion if self.seed is None else InOtherUnits(self.function, self.seed).motion(*motion)
        if excess := self.limits.excess(*asked):
            raise OutOfRangeError(f"{self.name} declares {excess}")

    def _accuracy(self, tolerance: float) -> dict[str, float]:
        return {"tolerance": tolerance} if self.step is None else {"step": self.step_at(tolerance)}

    def _start(self, system: AnySystem, initial_state: ArrayLike, tolerance: float) -> ArrayLike:
        if self.precision == 0.0:
            return initial_state
        return blurred_start(system, np.asarray(initial_state, dtype=float), self.precision, tolerance)

    def _seen(
        self, answer: object, system: AnySystem, initial_state: ArrayLike, times: ArrayLike, tolerance: float
    ) -> Trajectory:
        def looked_at(answer: object, times: ArrayLike) -> Trajectory:
            found = checked(answer, system, times)
            if self.precision == 0.0 and are_single(found.states):
                object.__setattr__(self, "_seen_noise", SINGLE)
            if self.noise == 0.0:
                return found
            return blurred(found, self.noise, tolerance, np.asarray(initial_state, dtype=float))

        def more(times: FloatArray) -> FloatArray:
            start = self._start(system, initial_state, tolerance)
            return looked_at(self._asked(system, start, times, **self._accuracy(tolerance)), times).states

        found = looked_at(answer, times)
        if isinstance(system, FrictionJoint):  # no claim asks for its phases
            return found
        if (self.phases and found.phases) or any(phase.kind != "slip" for phase in found.phases):
            return found
        if self.step is None:
            return StatesOnly(found, more, tolerance / USUAL_TOLERANCE, self.noise)
        step = self.step_at(tolerance)
        return StatesOnly(found, more, COARSE_STEP * step / self.step, self.noise, step)

    @property
    def root(self) -> float:
        """Exponent p of the fixed step h ∝ tolerance^(1/p): the order, but at least 2 to limit the steps."""
        return max(self.order, 2.0)

    def step_at(self, tolerance: float) -> float:
        """Return the fixed step in s at ``tolerance``."""
        return (self.step or 0.0) * math.pow(tolerance / USUAL_TOLERANCE, 1.0 / self.root)

    def simulates(self, system: AnySystem) -> bool:
        """Return whether the engine simulates ``system``."""
        linear = self.nonlinear or isinstance(system, FrictionJoint) or Support.of(system).linear
        return linear and self._promises(kind_of(system))

    def _promises(self, kind: str) -> bool:
        return kind in self.kinds or (kind == "block" and "pin" in self.kinds)

    def lacking(self, systems: Iterable[AnySystem]) -> str:
        """Return a sentence with the kinds of ``systems`` that are not simulated, or ""."""
        words = dict.fromkeys(
            KINDS[kind_of(system)] + (" on a nonlinear support" if self._promises(kind_of(system)) else "")
            for system in systems
            if not self.simulates(system)
        )
        return f"{self.name} does not simulate {' or '.join(words)}" if words else ""


def kind_of(system: AnySystem) -> str:
    """Return one of ``KINDS``."""
    if isinstance(system, FrictionJoint):
        return "joint"
    if isinstance(system, PinOnDisc):
        return "block" if system.disc_speed == 0.0 else "pin"
    return "ring" if system.contact_points is None else "points"


@functools.lru_cache(maxsize=64)  # each motion is requested at two tolerances
def _slips(system: AnySystem, initial_state: tuple[float, ...], start: float, end: float) -> bool:
    """Return whether the contact of the reference always slips."""
    import reference_model

    run = reference_model.simulate(system, initial_state, [start, end], tolerance=1e-6)
    # zero slip has no direction without a model of stick
    return slip_of(run)[0] > 0.0 and all(phase.kind == "slip" for phase in run.phases)
