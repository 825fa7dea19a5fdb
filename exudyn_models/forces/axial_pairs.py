"""Friction about one axis: regularised between rotors, or with exact stick between any bodies.

The slip of the centre is zero. With the mean radius r of the contact P = r·|S|, and M = −μN·r·sign(S), times P/ε if P
< ε. Points share this moment equally. Constant load and coefficient need no compiled code.

A contact with exact stick is sliding, locked or open. The moment of a sliding contact does not depend on the sign of
the slip, so the equations stay smooth across zero slip. While the contact is locked, a constraint holds the spins
together; its multiplier is the moment of friction. ``stick.switching`` finds the times of changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from operator import mul
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, mean_radius
from exudyn_models.forces.load_and_coefficient import AT_REST, LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import GROUND, NO_MOUNTS, ROTOR, Floats, Kinds
from reference_model.systems import FloatArray

FREE = 1e-12
"""Smallest ratio of the capacities in both directions, so rounding does not release a one-way clutch."""

ROUNDING = 1e-12
"""Friction, relative to the largest in a run, that a slack spring may show as the load of an open contact."""

ON_ONE_AXIS = ((ROTOR, ROTOR, NO_MOUNTS), (GROUND, ROTOR, NO_MOUNTS))
"""``Kinds`` of bodies that turn about one axis."""


def on_one_axis(kinds: Kinds, factors: LoadAndCoefficient) -> bool:
    """Return whether ``functions_on_axis`` apply to this contact."""
    return kinds in ON_ONE_AXIS and factors.geometry[4] == NONE_HELD


def functions_on_axis(kinds: Kinds, factors: LoadAndCoefficient) -> tuple[Any, Any]:
    """Return force and Jacobian as user functions for Exudyn."""
    grounded, resistance = kinds[0] == GROUND, _resistance(factors)

    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        moment = resistance(t, q_t[0] if grounded else q_t[1] - q_t[0])
        return [-moment] if grounded else [moment, -moment]

    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        spin = q_t[0] if grounded else q_t[1] - q_t[0]
        by_spin = velocity_factor * _slope(factors, t, spin)
        # Exudyn expects derivatives of the negative force.
        return -by_spin * (np.ones((1, 1)) if grounded else np.array([[1.0, -1.0], [-1.0, 1.0]]))

    return force, jacobian


def resistance_on_axis(factors: LoadAndCoefficient) -> Callable[..., float]:
    """Return the moment against the spin, as a user function of ``ObjectConnectorCoordinateSpringDamper``."""
    if factors.of_time is None:
        resistance = _resistance(factors)
        return lambda mbs, t, item, twist, spin, *parameters: resistance(t, spin)
    constant, law = factors.of_time
    radius, function = mean_radius(factors.geometry), law.function
    limit, fastest, endless = radius * constant, factors.geometry[3] / radius, math.inf
    least, backward = -limit, -fastest

    def of_time(
        mbs: Any, t: float, item: int, twist: float, spin: float, stiffness: Any, damping: Any, offset: Any
    ) -> float:
        factor = function(t)
        if factor.__class__ is not float or not 0.0 <= factor < endless:
            factor = law.checked(factor, t, math.nan, math.nan, math.nan)
        if spin > fastest:
            return limit * factor
        return least * factor if spin < backward else limit * factor * (spin / fastest)

    return of_time


def constant_law(kinds: Kinds, factors: LoadAndCoefficient) -> tuple[float, float] | None:
    """Return the sliding moment μN·r in N m, and the relative spin ε/r in rad/s below which it is proportional.

    None unless load and coefficient are numbers, r > 0, and the bodies are on one axis.
    """
    if factors.contact is None or not on_one_axis(kinds, factors):
        return None
    radius = mean_radius(factors.contact)
    return (factors.contact[2] * radius, factors.contact[3] / radius) if radius > 0.0 else None


def _resistance(factors: LoadAndCoefficient) -> Callable[[float, float], float]:
    """Return the moment against the spin as a function of time and spin."""
    radius, epsilon = mean_radius(factors.geometry), factors.geometry[3]

    def resistance(t: float, spin: float) -> float:
        speed = radius * abs(spin)
        friction = factors.friction_force(t, 0.0, speed, spin)
        return math.copysign(radius * friction * min(1.0, speed / epsilon), spin)

    return resistance


def _slope(factors: LoadAndCoefficient, t: float, spin: float) -> float:
    contact = factors.geometry
    radius, epsilon = mean_radius(contact), contact[3]
    speed = radius * abs(spin)
    motion = 0.0, speed, spin
    _, by_speed, by_spin = factors.friction_force_slopes(t, *motion)
    share = math.copysign(min(1.0, speed / epsilon), spin)
    by_share = radius / epsilon if speed < epsilon else 0.0
    change = by_speed * math.copysign(radius, spin) + by_spin
    return -radius * float(change * share + factors.friction_force(t, *motion) * by_share)


class Mode(IntEnum):
    """Mode of a contact, numbered as in Modelica's clutches."""

    BACKWARD = -1
    LOCKED = 0
    FORWARD = 1
    OPEN = 2
    """Transmits nothing, because load or coefficient is zero."""


SLIDING = (Mode.BACKWARD, Mode.FORWARD)


@dataclass(eq=False, kw_only=True)
class RowLaw:
    """Set-valued law of a force f along the gradient of one slip s, in one mode at a time.

    The force stays between two limits. At rest it may have any value within them, and otherwise it is at the limit
    against the slip. The limits may be equal (a clutch), zero and infinite (a one-way clutch), or grow with the force
    of a constraint (a gear with losses).

    ``weights``, shape (n,), are the derivatives of s by the nodes' velocities if they are constant. ``reference``,
    shape (n,), contains the reference coordinates of the nodes, ``static_ratio`` is static divided by
    sliding friction, >= 1, and ``locks`` are the object numbers of the constraints, one for each direction of slip.
    ``running`` is True while ``solve_dynamic`` runs, the only solver that switches modes, and ``called`` if Exudyn
    calls ``force``. ``point`` is the number of a point, from 1, of a contact at several points. ``on_axis`` is False
    if the bodies can slide sideways. ``largest`` is the largest friction in the run. Exudyn knows the mode
    ``entered``, and for each lock whether it is ``held``. ``holds`` returns the forces of a contact at rest along its
    locks.
    """

    weights: FloatArray = field(default_factory=lambda: np.empty(0))
    reference: FloatArray = field(default_factory=lambda: np.empty(0))
    static_ratio: float = 1.0
    locks: tuple[int, ...] = ()
    mode: Mode | None = None
    entered: Mode | None = None
    held: tuple[bool, ...] | None = None
    running: bool = False
    called: bool = True
    point: int | None = None
    on_axis: bool = True
    largest: float = 0.0
    holds: Callable[[], FloatArray] | None = None

    @property
    def parts(self) -> Sequence[RowLaw]:
        """Laws that lock: this law, or a law for each point."""
        return (self,)

    @property
    def active(self) -> Sequence[RowLaw]:
        """Parts that stick and slide in this model."""
        return self.parts

    @property
    def constraints(self) -> tuple[int, ...]:
        """Object numbers of all constraints of the law."""
        return self.locks

    def use(self, constraints: Sequence[int]) -> None:
        """Stick by the constraints with these object numbers."""
        self.locks = tuple(constraints)

    @property
    def visible_mode(self) -> Mode:
        """Mode that a sensor shows."""
        return Mode.LOCKED if self.mode is None else self.mode

    def gradient(self, q: Floats | FloatArray) -> Floats:
        """Return the derivatives of s with respect to the nodes' velocities; ``q`` excludes reference values."""
        weights: Floats = self.weights.tolist()
        return weights

    def limits(self, t: float) -> tuple[float, float]:
        """Return the largest moments in N m of a locked contact against sliding forward and backward."""
        raise NotImplementedError

    def moment(self, t: float, spin: float) -> float:
        """Return the moment f in N m in slip, without the moment of the constraint."""
        raise NotImplementedError

    def rows(self, coordinates: FloatArray) -> FloatArray:
        """Return the gradients of the locked slips, shape (k, n), at ``coordinates`` with reference values."""
        raise NotImplementedError

    def bias(self, state: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
        """Return the rates of the locked slips without accelerations, shape (k,)."""
        raise NotImplementedError

    def slip(self, q: Floats | FloatArray, q_t: Floats | FloatArray) -> float:
        """Return s in rad/s."""
        return float(np.dot(self.gradient(q), q_t))

    def twist(self, q: Floats | FloatArray) -> float:
        """Return the angle of the slip in rad; ``q`` excludes reference values."""
        return float(self.weights @ q)

    def mode_at(self, twist: float, rate: float) -> Mode:
        """Return the mode that a sensor shows."""
        return self.visible_mode

    def moment_and_friction(self, t: float, twist: float, rate: float) -> tuple[float, float]:
        """Return the moment along the slip and the friction in N m that sensors show."""
        moment = float(self.held_forces()[0]) if self.mode == Mode.LOCKED else self.moment(t, rate)
        return moment, moment

    def lost_power(self, t: float, twist: float, rate: float) -> float:
        """Return the lost power in W."""
        return -self.moment(t, rate) * rate if self.slides else 0.0

    def energy(self, twist: float) -> float:
        """Return the stored energy in J."""
        return 0.0

    def without_rounding(self, friction: float) -> float:
        """Return ``friction``, or zero if it is a rounding error of the largest friction so far."""
        self.largest = max(self.largest, friction)
        return friction if friction > ROUNDING * self.largest else 0.0

    @property
    def constant_forces(self) -> FloatArray | None:
        """Moments on the nodes in N m in the present mode, or None if they vary."""
        return None

    @property
    def slides(self) -> bool:
        """True if the contact slides under a load."""
        return self.mode in SLIDING

    def held_forces(self) -> FloatArray:
        """Return the forces of a contact at rest along its locks, shape (k,)."""
        return self.holds() if self.holds is not None else np.zeros(1)

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float, angle: float) -> FloatArray:
        """Return force (N) and moment (N m) on the disc, in the master's axes, shape (3,)."""
        moment = float(self.held_forces()[0]) if self.mode == Mode.LOCKED else self.moment(t, float(slip[2]))
        return np.array([0.0, 0.0, moment])

    def capacity_share(self, mbs: Any, t: float, angle: float = 0.0) -> float:
        """Return moment divided by capacity: 1 while the contact slides, 0 while it is open."""
        if self.mode == Mode.LOCKED:
            held = float(self.held_forces()[0])
            return abs(held) / max(self.limits(t)[held > 0.0], FREE * max(self.limits(t)))
        return 1.0 if self.slides else 0.0

    def check_running(self) -> None:
        """Raise ``ValueError`` unless ``solve_dynamic`` switches modes."""
        if not self.running:
            raise ValueError(
                "a contact without regularisation sticks exactly, which needs exudyn_models.solve_dynamic; "
                "give add_ring_friction a regularisation for any other solver"
            )

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        """Return the moments on the nodes (user function of the connector)."""
        self.check_running()
        if not self.slides:
            return [0.0] * len(q)
        gradient = self.gradient(q)
        moment = self.moment(t, sum(map(mul, gradient, q_t)))
        return [moment * share for share in gradient]

    def jacobian(
        self,
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        """Return the derivatives of minus the moments (user function of the connector)."""
        return np.zeros((len(q), len(q)))


@dataclass(eq=False)
class AxialStick(RowLaw):
    """Friction between two bodies that turn about one axis, in one mode at a time."""

    kinds: Kinds
    factors: LoadAndCoefficient

    def renew(self) -> None:
        """Use the present load and coefficient; nothing to do here, because every call reads them."""

    @cached_property
    def mean_radius(self) -> float:
        """P/|S| of a disc that turns in place, in m."""
        return mean_radius(self.factors.geometry)

    def sliding_moment(self, t: float, spin: float) -> float:
        """Return the magnitude of the moment in N m."""
        return self.mean_radius * self.factors.friction_force(t, 0.0, self.mean_radius * abs(spin), spin)

    def sliding_slope(self, t: float, spin: float) -> float:
        """Return the derivative of the magnitude of the moment by the relative spin, in N m s."""
        return self.slope_of(self.factors, t, spin)

    def slope_of(self, factors: LoadAndCoefficient, t: float, spin: float) -> float:
        """Return ``sliding_slope`` under these ``factors``."""
        radius = self.mean_radius
        _, by_speed, by_spin = factors.friction_force_slopes(t, 0.0, radius * abs(spin), spin)
        return radius * float(by_speed * math.copysign(radius, spin) + by_spin)

    def limits(self, t: float) -> tuple[float, float]:
        """Return the largest moments in N m of a locked contact against sliding forward and backward.

        They differ in a one-way clutch.
        """
        if self.factors.contact is not None:  # constant; every step needs it
            limit = self.static_ratio * self.mean_radius * self.factors.contact[2]
            return limit, limit
        forward = self.static_ratio * self.sliding_moment(t, AT_REST)
        if not self.factors.depends_on_direction:
            return forward, forward
        return forward, self.static_ratio * self.sliding_moment(t, -AT_REST)

    @property
    def constant_forces(self) -> FloatArray | None:
        """Moments on the nodes in N m in the present mode, or None if they vary."""
        if self.factors.contact is None:
            return None
        return self.moment(0.0, 0.0) * np.array(self.gradient([]))

    def moment(self, t: float, spin: float) -> float:
        """Return the moment in N m on the disc, without the moment of the constraint."""
        if self.mode == Mode.FORWARD:
            return -self.sliding_moment(t, max(spin, AT_REST))
        return self.sliding_moment(t, min(spin, -AT_REST)) if self.mode == Mode.BACKWARD else 0.0

    def jacobian(
        self,
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        """Return the derivatives of minus the moments (user function of the connector)."""
        gradient = np.array(self.gradient(q))
        slope = 0.0
        if self.factors.depends_on_motion and self.slides:
            spin, direction = float(gradient @ q_t), int(self.mode or 0)
            if direction * spin > 0.0:  # ``moment`` is constant beyond zero slip
                slope = direction * self.sliding_slope(t, spin)
        return velocity_factor * slope * np.outer(gradient, gradient)


def spanned(rows: FloatArray, by: FloatArray) -> bool:
    """Return whether ``rows``, shape (k, n), are linear combinations of others, shape (m, n)."""
    return bool(np.linalg.matrix_rank(np.vstack([by, rows])) == (np.linalg.matrix_rank(by) if len(by) else 0))
