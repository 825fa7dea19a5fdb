"""The systems of the paper: frozen, validated parameters in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class PinOnDisc:
    """A pin on springs and dampers, pressed on a disc that turns at constant speed (Fig. 2, eq. 1).

    Parameters
    ----------
    mass : float
        m in kg, > 0.
    stiffness : float
        C of the support in N/m, >= 0, the same in every radial direction.
    damping : float
        β of the support in N s/m, >= 0.
    friction_force : float
        μN in N, >= 0.
    disc_speed : float
        ω in rad/s, of either sign.
    offset : float
        X0 in m: the springs are relaxed at (X0, 0), the disc turns about (0, 0).

    Raises
    ------
    ValueError
        If a value is not a finite number or is outside of its range.

    """

    mass: float
    stiffness: float
    damping: float
    friction_force: float
    disc_speed: float
    offset: float = 0.0

    state_size = 4  # x, y, vx, vy

    def __post_init__(self) -> None:
        """Refuse what no pin can be."""
        for field in fields(self):
            object.__setattr__(self, field.name, finite_number(field.name, getattr(self, field.name)))
        if self.mass <= 0.0:
            raise ValueError(f"mass = {self.mass:g} kg: it must be > 0")
        for name, unit in (("stiffness", "N/m"), ("damping", "N s/m"), ("friction_force", "N")):
            value = getattr(self, name)
            if value < 0.0:
                raise ValueError(f"{name} = {value:g} {unit}: it must be >= 0")

    @property
    def natural_frequency(self) -> float:
        """k = √(C/m) of eq. 11, in rad/s."""
        return math.sqrt(self.stiffness / self.mass)


def finite_number(name: str, value: Any) -> float:
    """Return ``value`` as a float; raise ``ValueError`` naming it if it is not a finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {value!r}: it must be a number") from None
    except OverflowError:  # an integer beyond all floats
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(f"{name} = {number}: it must be finite")
    return number


def checked_state(system: PinOnDisc, initial_state: ArrayLike) -> FloatArray:
    """Return ``initial_state`` as an array of shape ``(system.state_size,)``, or raise ``ValueError``."""
    state = _float_array("initial_state", initial_state)
    if state.shape != (system.state_size,):
        raise ValueError(
            f"initial_state has shape {state.shape}: "
            f"{type(system).__name__} takes {system.state_size} numbers"
        )
    _require_finite("initial_state", state)
    return state


def checked_times(times: ArrayLike) -> FloatArray:
    """Return ``times`` as an increasing array of shape (n,) in s; raise ``ValueError`` otherwise."""
    result = _float_array("times", times)
    if result.ndim != 1 or result.size == 0:
        raise ValueError(f"times has shape {result.shape}: it must be a list of at least one time")
    _require_finite("times", result)
    steps = np.diff(result)
    if np.any(steps <= 0.0):
        i = int(np.argmax(steps <= 0.0))
        raise ValueError(f"times[{i + 1}] = {result[i + 1]:g} follows {result[i]:g}: times must increase")
    return result


def checked_tolerance(tolerance: float) -> float:
    """Return ``tolerance`` if double precision can reach it, or raise ``ValueError``."""
    number = finite_number("tolerance", tolerance)
    if not 1e-14 <= number <= 1e-2:
        raise ValueError(f"tolerance = {number:g}: it must lie between 1e-14 and 1e-2")
    return number


def _float_array(name: str, values: ArrayLike) -> FloatArray:
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {values!r}: it must be a list of numbers") from None
    except OverflowError:
        raise ValueError(f"{name} holds an integer too large for a float: it must be finite") from None


def _require_finite(name: str, values: FloatArray) -> None:
    if not np.all(np.isfinite(values)):
        i = int(np.argmin(np.isfinite(values)))
        raise ValueError(f"{name}[{i}] = {values[i]}: it must be finite")
