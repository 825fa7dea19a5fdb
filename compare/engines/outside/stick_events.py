"""Stick phases from a model's own record of its last events.

The outputs ``NAMES`` count sticks and releases and give their last times and the position of the last stick.
``NAMES_OF_POINTS`` give the number of resting points, how often it changed, and time and state of the last change.
The adapter rejects and halves a step with several events of a kind.
"""

import cmath
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Literal

import numpy as np

from reference_model.systems import COLUMNS, DiscOnDisc, FloatArray, System
from reference_model.trajectory import Phase, phases_of

COUNTS = ("stick_count", "release_count")

TIMES = ("stick_time", "release_time")
NAMES = (*COUNTS, *TIMES, "stick_x", "stick_y")  # required outputs; a disc also needs ``stick_angle``
STATE_OF_POINTS = tuple(f"rest_{name}" for name, _ in COLUMNS[DiscOnDisc])

NAMES_OF_POINTS = ("rest_count", "rest_time", "resting_points", *STATE_OF_POINTS)
"""Further outputs for the rest of single points."""

Kind = Literal["slip", "pivot", "stick"]


def tells_stick(description: Any, variables: Mapping[str, Any]) -> bool:
    """Return whether a model reports stick; a model with ``exact`` off by default creeps and has no events."""
    exact = variables.get("exact")
    return (
        set(NAMES) <= set(variables)
        and ("spin" not in variables or "stick_angle" in variables)
        and bool(getattr(description.coSimulation, "canGetAndSetFMUstate", False))
        and (exact is None or str(exact.start).lower() in ("true", "1"))
    )


class Events:
    """Phases of an initialised instance, collected while it takes steps; of FMI 3 if ``newer``, else of FMI 2."""

    counts: ClassVar[tuple[str, ...]]

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
        """Advance the instance from ``begin`` to ``end``, in s."""
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
        """Return the phases up to ``end`` in s."""
        return phases_of(self._begun, end)

    def _of(self, *names: str) -> list[int]:
        return [self._variables[name].valueReference for name in names]

    def _first(self) -> Kind:
        raise NotImplementedError

    def _note(self, counts: list[int]) -> None:
        raise NotImplementedError


class PointRests(Events):
    """Phases of a disc on single points, which may pivot about one of them."""

    counts = ("rest_count",)

    def _first(self) -> Kind:
        (resting,) = self._whole(self._of("resting_points"))
        return "slip" if resting == 0 else "pivot" if resting == 1 else "stick"

    def _note(self, counts: list[int]) -> None:
        time, *state = self._real(self._of("rest_time", *STATE_OF_POINTS))
        self._begun.append((self._first(), time, np.array(state)))


class StickEvents(Events):
    """Phases of a contact that sticks as a whole."""

    counts = COUNTS

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        places = [f"stick_{name}" for name, unit in COLUMNS[type(self._system)] if unit in ("m", "rad")]
        self._timed, self._placed = self._of(*TIMES), self._of(*places)

    def _first(self) -> Kind:
        return "stick" if self._counts[0] > self._counts[1] else "slip"

    def _note(self, counts: list[int]) -> None:
        """Record the new stick and release: a stuck contact is released before it sticks again."""
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
        _, stuck, state = self._begun[-1]
        return self._carried(state[: len(self._placed)], time - stuck)

    def _carried(self, place: Any, lasted: float) -> FloatArray:
        omega = self._system.disc_speed
        z = complex(*place[:2]) * cmath.exp(1j * omega * lasted)
        velocity = 1j * omega * z
        centre = [z.real, z.imag], [velocity.real, velocity.imag]
        if isinstance(self._system, DiscOnDisc):
            return np.array([*centre[0], place[2] + omega * lasted, *centre[1], omega])
        return np.array([*centre[0], *centre[1]])
