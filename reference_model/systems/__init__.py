"""The paper's systems: frozen, validated parameters in SI units."""

import inspect
import math
import re
import reprlib
from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from numbers import Integral
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MOST_POINTS = 1000
"""Largest number of contact points; a continuous ring is cheaper than more."""

MOST_COUNT = 1_000_000
"""Largest number of samples and other parts, because more would exhaust the memory."""

LEAST, MOST = 1e-50, 1e50
"""Smallest positive parameter, and largest size of any and of a state: products of several then stay finite."""

MOST_RATIO = 1e25
"""Largest rate in 1/s and largest m·R²/J: powers stay finite, and no integrator could follow faster rates."""


@dataclass(frozen=True, kw_only=True)
class _SupportedMass:
    mass: float
    stiffness: float
    damping: float
    friction_force: float
    disc_speed: float
    offset: float = 0.0
    hardening: float = 0.0
    stop_gap: float = 0.0
    stop_stiffness: float = 0.0

    state_size: ClassVar[int]
    _parameters: ClassVar[dict[str, tuple[str, float]]] = {  # unit and smallest value
        "mass": ("kg", LEAST),
        "stiffness": ("N/m", 0.0),
        "damping": ("N s/m", 0.0),
        "friction_force": ("N", 0.0),
        "disc_speed": ("rad/s", -MOST),
        "offset": ("m", -MOST),
        "hardening": ("N/m³", 0.0),
        "stop_gap": ("m", 0.0),
        "stop_stiffness": ("N/m", 0.0),
    }

    def __post_init__(self) -> None:
        values = vars(self)
        # Valid values must pass quickly, because searches create many systems.
        for name, (unit, least) in self._parameters.items():
            value = values[name]
            if type(value) is not float or not least <= value <= MOST:
                object.__setattr__(self, name, checked_parameter(name, value, unit, least))
        for name, (formula, ratio) in self._ratios().items():
            if ratio > MOST_RATIO:
                raise ValueError(
                    f"{name} = {getattr(self, name):g} {self._parameters[name][0]}: {formula} = {ratio:g} "
                    f"must be at most {MOST_RATIO:g}"
                )

    def _ratios(self) -> dict[str, tuple[str, float]]:
        """Return formula and value of each bounded ratio, by the parameter named in the error."""
        return {
            "stiffness": ("√(stiffness/mass)", self.natural_frequency),
            "stop_stiffness": ("√(stop_stiffness/mass)", math.sqrt(self.stop_stiffness / self.mass)),
            "damping": ("damping/mass", self.damping / self.mass),
        }

    @property
    def natural_frequency(self) -> float:
        """k = √(C/m) of eq. 11 in rad/s, of the linear spring alone."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def linear_support(self) -> bool:
        """True for the paper's linear spring, without hardening or stop."""
        return self.hardening == 0.0 and self.stop_stiffness == 0.0


@dataclass(frozen=True, kw_only=True)
class PinOnDisc(_SupportedMass):
    """A pin on springs and dampers, pressed on a disc that turns at constant speed (Fig. 2, eq. 1).

    The state is x, y in m and vx, vy in m/s. Raises ``ValueError`` if a value is not finite or out of range.

    Parameters
    ----------
    mass
        m in kg, > 0.
    stiffness
        C of the support in N/m, >= 0, equal in all radial directions.
    damping
        β of the support in N s/m, >= 0.
    friction_force
        μN in N, >= 0.
    disc_speed
        ω in rad/s, of either sign.
    offset
        X0 in m: the springs are relaxed at (X0, 0), the disc turns about (0, 0).
    hardening
        C₃ in N/m³, >= 0: at the deflection w = x + iy − X0 the springs pull with C·|w| + C₃·|w|³.
    stop_gap, stop_stiffness
        Clearance in m and C_s in N/m, >= 0: the stop pushes back with C_s·(|w| − gap) if |w| > gap.

    """

    state_size: ClassVar[int] = 4


@dataclass(frozen=True, kw_only=True)
class DiscOnDisc(_SupportedMass):
    """A friction disc on springs and dampers, in contact with a turning master disc along a ring (Fig. 7).

    A torsional damper connects it to a shaft that turns at constant speed (19). The state is x, y in m, the angle in
    rad, vx, vy in m/s and the spin in rad/s. Errors and other parameters are the same as in :class:`PinOnDisc`, with
    μN of the whole ring and ω of the master disc.

    Parameters
    ----------
    polar_inertia
        J in kg m², > 0.
    contact_radius
        R of the ring in m, > 0.
    shaft_damping
        b of the torsional damper in N m s/rad, >= 0.
    shaft_speed
        Ω of the shaft in rad/s, of either sign.
    contact_points
        Number n of contact points, from 3 to 1000. Point i lies at φ + 2πi/n and carries N/n. None: the continuous
        ring of (20).

    """

    polar_inertia: float
    contact_radius: float
    shaft_damping: float
    shaft_speed: float
    contact_points: int | None = None

    state_size: ClassVar[int] = 6
    _parameters: ClassVar[dict[str, tuple[str, float]]] = _SupportedMass._parameters | {
        "polar_inertia": ("kg m²", LEAST),
        "contact_radius": ("m", LEAST),
        "shaft_damping": ("N m s/rad", 0.0),
        "shaft_speed": ("rad/s", -MOST),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.contact_points is not None:
            points = finite_number("contact_points", self.contact_points)
            if not (points.is_integer() and 3 <= points <= MOST_POINTS):
                raise ValueError(
                    f"contact_points = {self.contact_points}: it must be a whole number from 3 to {MOST_POINTS}, or "
                    "None for the continuous ring; use PinOnDisc for a single point"
                )
            object.__setattr__(self, "contact_points", int(points))

    def _ratios(self) -> dict[str, tuple[str, float]]:
        return super()._ratios() | {
            "contact_radius": (
                "mass·contact_radius²/polar_inertia",
                self.mass * self.contact_radius**2 / self.polar_inertia,
            ),
            "shaft_damping": ("shaft_damping/polar_inertia", self.shaft_damping / self.polar_inertia),
        }


System: TypeAlias = PinOnDisc | DiscOnDisc

COLUMNS: dict[type, tuple[tuple[str, str], ...]] = {
    PinOnDisc: (("x", "m"), ("y", "m"), ("vx", "m/s"), ("vy", "m/s")),
    DiscOnDisc: (("x", "m"), ("y", "m"), ("angle", "rad"), ("vx", "m/s"), ("vy", "m/s"), ("spin", "rad/s")),
}
"""Name and unit of each state."""

PARAMETERS: dict[type[System], tuple[tuple[str, str, float], ...]] = {
    kind: tuple((name, *unit_and_least) for name, unit_and_least in kind._parameters.items())
    for kind in (PinOnDisc, DiscOnDisc)
}
"""Name, unit and smallest value of each parameter except ``contact_points``."""

UNITS = {name: unit for name, unit, _ in PARAMETERS[DiscOnDisc]}
"""Unit of each parameter of a disc or a pin."""

SMALLEST_TOLERANCE = 1e-14
"""Smallest tolerance that double precision can reach."""

ANGLE = 2
"""Index of the angle in the state of a disc."""


def shown(value: Any) -> str:
    """Return ``value`` as a short line for a message."""
    return " ".join(reprlib.repr(value).split())


def real_numbers(name: str, values: Any) -> FloatArray:
    """Return ``values``, a number or an array of any shape, as an array of floats, which may be infinite or NaN.

    Numbers are integers and floats of Python or NumPy, also within lists and in objects that convert themselves to
    an array, such as a series of pandas. Raises ``ValueError`` for everything else: truth values, text, dates,
    complex numbers, masked elements, numbers with a unit, and rows of unequal length.
    """
    if np.ma.is_masked(values):
        raise ValueError(
            f"{name} = {shown(values)}: it must not contain masked elements; fill or remove them"
        )
    if not isinstance(values, (int, float)) and (
        unit := getattr(values, "units", getattr(values, "unit", None))
    ):
        raise ValueError(f"{name} = {shown(values)}: it has the unit {unit}; pass plain numbers in SI units")
    if isinstance(values, (bytearray, memoryview)):  # NumPy would take bytes as numbers
        values = bytes(values)
    array = np.asarray(values, dtype=None if hasattr(values, "__array__") else object)
    kinds = {type(value) for value in array.flat} if array.dtype == object else {array.dtype.type}
    if not all(issubclass(kind, _NUMBERS) and not issubclass(kind, _NO_NUMBERS) for kind in kinds):
        rule = "contain only numbers, in rows of equal length" if array.ndim else "be a number"
        raise ValueError(f"{name} = {shown(values)}: it must {rule}")
    try:
        return np.array(array, dtype=float, order="C")
    except OverflowError:  # an integer larger than any float
        largest = f"{np.finfo(float).max:.2g}"
        raise ValueError(f"{name} = {shown(values)}: it must be finite, at most {largest} in size") from None


_NUMBERS, _NO_NUMBERS = (int, float, np.integer, np.floating), (bool, np.timedelta64)


def finite_numbers(name: str, values: Any) -> FloatArray:
    """Return ``values`` as ``real_numbers`` does; raise ``ValueError`` unless all are finite."""
    result = real_numbers(name, values)
    if not np.all(np.isfinite(result)):
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(result))[0])
        where = f"[{', '.join(map(str, place))}]" if place else ""
        raise ValueError(f"{name}{where} = {result[place]}: it must be finite")
    return result


def finite_number(name: str, value: Any) -> float:
    """Return ``value``, an integer or a float, as a float; raise ``ValueError`` unless it is finite."""
    result = finite_numbers(name, value)
    if result.ndim > 0:
        raise ValueError(f"{name} = {shown(value)}: it must be a single number, not an array")
    return float(result)


def number_in_text(name: str, text: str) -> float:
    """Return the number that ``text`` contains, such as "-1.5e3"; raise ``ValueError`` unless it is finite."""
    words = text.strip().lower()
    if not _NUMERAL.fullmatch(words):
        raise ValueError(f"{name} = {text!r}: it must be a number, such as 0.5 or -1e-3")
    return finite_number(name, float(words))


_NUMERAL = re.compile(r"[+-]?((\d+\.?\d*|\.\d+)(e[+-]?\d+)?|nan|inf|infinity)", re.ASCII)


def require_flag(name: str, value: Any) -> None:
    """Raise ``ValueError`` unless ``value`` is True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} = {shown(value)}: it must be True or False")


def checked_parameter(name: str, value: Any, unit: str, least: float) -> float:
    """Return a parameter as a float; raise ``ValueError`` if it is below ``least`` or not finite."""
    number, positive = finite_number(name, value), least > 0.0
    given = f"{name} = {number:g} {unit}".rstrip()
    if (positive and number <= 0.0) or number < 0.0 == least:
        raise ValueError(f"{given}: it must be {'> 0' if positive else '>= 0'}")
    if abs(number) > MOST or (positive and number < LEAST):
        allowed = f"between {LEAST:g} and" if positive else "at most"
        raise ValueError(f"{given}: its size must be {allowed} {MOST:g}")
    return number


def positive_number(name: str, value: Any, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` unless it is finite and > 0."""
    number = finite_number(name, value)
    if number <= 0.0:
        raise ValueError(f"{name} = {number:g} {unit}: it must be > 0")
    return number


def require_whole(name: str, value: int, *, least: int, most: int = MOST_COUNT) -> None:
    """Raise ``ValueError`` unless ``value`` is an integer from ``least`` to ``most``."""
    if not (isinstance(value, Integral) and not isinstance(value, _NO_NUMBERS) and least <= value <= most):
        raise ValueError(f"{name} = {shown(value)}: it must be a whole number >= {least} and <= {most}")


def require_callable(name: str, value: Any, *arguments: str, named: Collection[str] = ()) -> None:
    """Raise ``ValueError`` unless ``value`` is a function, which takes these arguments if given."""
    try:
        if arguments or not callable(value):
            inspect.signature(value).bind(*arguments, **dict.fromkeys(named))
    except TypeError:
        of = f" of {', '.join((*arguments, *named))}" if arguments else ""
        raise ValueError(f"{name} = {shown(value)}: it must be a function{of}") from None
    except ValueError:  # some functions in C have no signature
        pass


def require_choice(name: str, value: Any, allowed: Collection[str]) -> None:
    """Raise ``ValueError`` unless ``value`` is one of the texts ``allowed``."""
    if not isinstance(value, str) or value not in allowed:
        raise ValueError(f"{name} = {shown(value)}: it must be one of {', '.join(map(str, allowed))}")


def require_kind(name: str, value: Any, *kinds: type) -> None:
    """Raise ``ValueError`` unless ``value`` is an instance of one of ``kinds``."""
    if not isinstance(value, kinds):
        names = " or ".join(("an " if k.__name__[0] in "AEIOU" else "a ") + k.__name__ for k in kinds)
        raise ValueError(f"{name} = {shown(value)}: it must be {names}")


Place: TypeAlias = tuple[float, float, float]
"""Position x, y of a contact point in m in the frame of the disc, and its share of the load."""

SHARES = 1e-12
"""Largest rounding error of a sum of a thousand shares."""


def checked_places(name: str, places: Iterable[Iterable[float]]) -> tuple[Place, ...]:
    """Return x, y and share of contact points; raise ``ValueError`` if invalid.

    At least two positions must differ; shares must be positive and sum to 1.
    """
    try:
        given = [tuple(place) for place in places]
    except TypeError:
        raise ValueError(f"{name} = {shown(places)}: it must be a list of (x, y, share)") from None
    result: list[Place] = []
    for i, place in enumerate(given):
        if len(place) != 3:
            raise ValueError(f"{name}[{i}] = {place}: it must be (x, y, share), with x and y in m")
        x, y, share = (finite_number(f"{name}[{i}]", value) for value in place)
        if share <= 0.0:
            raise ValueError(f"{name}[{i}] = {place}: the share must be > 0")
        result.append((x, y, share))
    if len(result) < 2:
        raise ValueError(f"{name} = {result}: at least two points are needed; use a pin for a single one")
    (place, number), *_ = Counter((x, y) for x, y, _ in result).most_common(1)
    if number > 1:
        raise ValueError(f"{name}: {number} points lie at {place}; combine their shares in one point")
    total = math.fsum(share for _, _, share in result)
    if abs(total - 1.0) > SHARES:
        raise ValueError(f"{name}: the shares sum to {total:.12g}; they must sum to 1")
    return tuple(result)


def require_system(system: System) -> None:
    """Raise ``ValueError`` unless ``system`` is a pin or a disc."""
    require_kind("system", system, PinOnDisc, DiscOnDisc)


def checked_state(system: System, given: ArrayLike, name: str = "initial_state") -> FloatArray:
    """Return a state as an array, shape ``(system.state_size,)``; raise ``ValueError`` if invalid."""
    require_system(system)
    state = finite_numbers(name, given)
    if state.shape != (system.state_size,):
        kind, size = type(system).__name__, system.state_size
        raise ValueError(f"{name} = {shown(given)}: {kind} takes {size} numbers, not shape {state.shape}")
    if np.any(abs(state) > MOST):
        i = int(np.argmax(abs(state)))
        raise ValueError(
            f"{name}[{i}] = {state[i]:g}: it must not be larger than {MOST:g}, or powers of it overflow"
        )
    return state


def checked_times(times: ArrayLike) -> FloatArray:
    """Return ``times`` in s, shape (n,); raise ``ValueError`` unless they increase."""
    result = finite_numbers("times", times)
    if result.ndim != 1 or result.size == 0:
        raise ValueError(f"times has shape {result.shape}: it must be a list of at least one time")
    steps = np.diff(result)
    if np.any(steps <= 0.0):
        i = int(np.argmax(steps <= 0.0))
        raise ValueError(
            f"times must increase, but times[{i + 1}] = {result[i + 1]:g} follows times[{i}] = {result[i]:g}"
        )
    return result


def checked_tolerance(tolerance: float) -> float:
    """Return ``tolerance``; raise ``ValueError`` unless it lies between 1e-14 and 1e-2."""
    number = finite_number("tolerance", tolerance)
    if not SMALLEST_TOLERANCE <= number <= 1e-2:
        raise ValueError(f"tolerance = {number:g}: it must lie between {SMALLEST_TOLERANCE} and 1e-2")
    return number
