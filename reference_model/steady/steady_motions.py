"""Steady motions: position or circle, spin, and eigenvalues of small deviations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reference_model.systems import FloatArray


@dataclass(frozen=True, kw_only=True)
class SelfCentredEquilibrium:
    """A pin or disc whose centre rests in space while the master disc slides below it (3), (24).

    The position ``x``, ``y`` is in m. ``eigenvalues`` are in 1/s, slowest decay first: four for a pin, five for a
    disc, whose angle drops out. The equilibrium is ``stable`` if all small deviations decay.
    """

    x: float
    y: float
    eigenvalues: tuple[complex, ...]
    stable: bool

    @property
    def state(self) -> FloatArray:
        """State for a simulation, shape (4,)."""
        return np.array([self.x, self.y, 0.0, 0.0])


@dataclass(frozen=True, kw_only=True)
class SpinningEquilibrium(SelfCentredEquilibrium):
    """The self-centred equilibrium of a disc, which spins about its resting centre with ``spin`` φ̇ in rad/s."""

    spin: float

    @property
    def state(self) -> FloatArray:
        """State for a simulation, with the angle zero, shape (6,)."""
        return resting(self.x, self.y, self.spin)


@dataclass(frozen=True, kw_only=True)
class Whirl:
    """A motion on a circle about the axis with permanent slip (11).

    ``radius`` is in m, ``frequency`` in rad/s, negative if clockwise. ``eigenvalues`` are in 1/s in the frame that
    turns with the whirl: first the exact zero of the free phase, then the others, slowest decay first: three for a
    pin, four for a disc, whose angle drops out. The whirl is ``stable`` if all small deviations decay, apart from a
    shift in phase.
    """

    radius: float
    frequency: float
    eigenvalues: tuple[complex, ...]
    stable: bool

    @property
    def state(self) -> FloatArray:
        """State for a simulation, with the centre on the x axis, shape (4,)."""
        return np.array([self.radius, 0.0, 0.0, self.frequency * self.radius])


@dataclass(frozen=True, kw_only=True)
class SpinningWhirl(Whirl):
    """The whirl of a disc, which spins about its circling centre with a constant ``spin`` φ̇ in rad/s."""

    spin: float

    @property
    def state(self) -> FloatArray:
        """State for a simulation, with the centre on the x axis and the angle zero, shape (6,)."""
        return circling(self.radius, self.frequency, self.spin)


def resting(x: float, y: float, spin: float) -> FloatArray:
    """Return the state of a disc that spins about its resting centre."""
    return np.array([x, y, 0.0, 0.0, 0.0, spin])


def circling(radius: float, frequency: float, spin: float) -> FloatArray:
    """Return the state of a disc that spins about its circling centre, which is on the x axis."""
    return np.array([radius, 0.0, 0.0, 0.0, frequency * radius, spin])
