"""When the contact of a model sticks and is let go, by what the model itself tells of its last events.

It has as outputs how often it stuck and was let go, when it did last, and where it then was: ``NAMES``; and of single
points how many rest, how often that changed, when it did last, and the state then: ``NAMES_OF_POINTS``. It is asked
at communication points, and a step in which there was more than the last of each is taken back and halved.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Literal

import numpy as np

from reference_model.systems import COLUMNS, DiscOnDisc, FloatArray, System
from reference_model.trajectory import Phase, phases_of

COUNTS = ("stick_count", "release_count")

TIMES = ("stick_time", "release_time")

NAMES = (*COUNTS, *TIMES, "stick_x", "stick_y")
"""What a model has to have, and ``stick_angle`` for a disc."""

STATE_OF_POINTS = tuple(f"rest_{name}" for name, _ in COLUMNS[DiscOnDisc])

NAMES_OF_POINTS = ("rest_count", "rest_time", "resting_points", *STATE_OF_POINTS)
"""What a model that tells of sticking has to have besides, to tell when single points rest."""

Kind = Literal["slip", "pivot", "stick"]


def tells_stick(description: Any, variables: Mapping[str, Any]) -> bool:
    """Return whether a model tells it: one whose ``exact`` is off from the start creeps, and knows no events."""
    exact = variables.get("exact")
    return (
        set(NAMES) <= set(variables)
        and ("spin" not in variables or "stick_angle" in variables)
        and bool(getattr(description.coSimulation, "canGetAndSetFMUstate", False))
        and (exact is None or str(exact.start).lower() in ("true", "1"))
    )


class Events:
    """The phases of an instance, which was initialised, while it takes steps.

    Parameters
    ----------
    instance : FMPy's
        Of FMI 3 if ``newer``.
    variables : mapping
        Those of its model by name.
    system : PinOnDisc or DiscOnDisc
        Which it simulates.
    time : float
        Where it starts, in s.
    state : array of shape (4,) or (6,)
        From where.

    """

    counts: ClassVar[tuple[str, ...]]
    """Outputs that count what happened."""

    def __init__(
        self,
        instance: Any,
        variables: Mapping[str, Any],
        system: System,
        time: float,
        state: FloatArray,
        *,
        newer: bool,
    ) -> None:
        self._instance, self._variables, self._system = instance, variables, system
        self._whole = instance.getInt32 if newer else instance.getInteger
        self._real = instance.getFloat64 if newer else instance.getReal
        name = "FMUState" if newer else "FMUstate"
        self._kept, self._put_back, self._freed = (
            getattr(instance, f"{verb}{name}") for verb in ("get", "set", "free")
        )
        self._counted = self._of(*self.counts)
        self._counts = self._whole(self._counted)
        self._begun: list[tuple[Kind, float, FloatArray]] = [(self._first(), time, np.array(state))]

    def step(self, begin: float, end: float) -> None:
        """Let the instance go from ``begin`` to ``end`` in s."""
        before, middle = self._kept(), 0.5 * (begin + end)
        try:
            self._instance.doStep(begin, end - begin)
            counts = self._whole(self._counted)
            more = max(now - then for now, then in zip(counts, self._counts, strict=True))
            halve = more > 1 and begin < middle < end
            if halve:
                self._put_back(before)
            elif more > 0:
                self._note(counts)
                self._counts = counts
        finally:
            self._freed(before)
        if halve:
            self.step(begin, middle)
            self.step(middle, end)

    def phases(self, end: float) -> tuple[Phase, ...]:
        """Return them up to ``end`` in s."""
        return phases_of(self._begun, end)

    def _of(self, *names: str) -> list[int]:
        """Return the value references of variables."""
        return [self._variables[name].valueReference for name in names]

    def _first(self) -> Kind:
        """Return the kind of phase in which the motion starts."""
        raise NotImplementedError

    def _note(self, counts: list[int]) -> None:
        """Note what happened, each at most once, since ``_counts``."""
        raise NotImplementedError


class PointRests(Events):
    """Those of a disc on single points, of which one may rest while the disc turns about it."""

    counts = ("rest_count",)

    def _first(self) -> Kind:
        (resting,) = self._whole(self._of("resting_points"))
        return "slip" if resting == 0 else "pivot" if resting == 1 else "stick"

    def _note(self, counts: list[int]) -> None:
        time, *state = self._real(self._of("rest_time", *STATE_OF_POINTS))
        self._begun.append((self._first(), time, np.array(state)))


class StickEvents(Events):
    """Those of a contact that rests as a whole."""

    counts = COUNTS

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        places = [f"stick_{name}" for name, unit in COLUMNS[type(self._system)] if unit in ("m", "rad")]
        self._timed, self._placed = self._of(*TIMES), self._of(*places)

    def _first(self) -> Kind:
        return "stick" if self._counts[0] > self._counts[1] else "slip"

    def _note(self, counts: list[int]) -> None:
        """Note the last of each that is new: what sticks is let go before it sticks again."""
        changed = [now > then for now, then in zip(counts, self._counts, strict=True)]
        stuck, released = self._real(self._timed)
        happened: dict[Kind, tuple[bool, float, Callable[[float], FloatArray]]] = {
            "stick": (changed[0], stuck, lambda time: self._carried(self._real(self._placed), 0.0)),
            "slip": (changed[1], released, self._released),
        }
        order: tuple[Kind, Kind] = ("slip", "stick") if self._begun[-1][0] == "stick" else ("stick", "slip")
        for kind in order:
            new, time, state = happened[kind]
            if new:
                self._begun.append((kind, time, state(time)))

    def _released(self, time: float) -> FloatArray:
        """Return the state at release: where the disc below has carried it since it stuck."""
        _, stuck, state = self._begun[-1]
        return self._carried(state[: len(self._placed)], time - stuck)

    def _carried(self, place: Any, lasted: float) -> FloatArray:
        """Return the state of what turned with the disc below for a time in s."""
        omega = self._system.disc_speed
        z = complex(*place[:2]) * cmath.exp(1j * omega * lasted)
        velocity = 1j * omega * z
        centre = [z.real, z.imag], [velocity.real, velocity.imag]
        if isinstance(self._system, DiscOnDisc):
            return np.array([*centre[0], place[2] + omega * lasted, *centre[1], omega])
        return np.array([*centre[0], *centre[1]])
