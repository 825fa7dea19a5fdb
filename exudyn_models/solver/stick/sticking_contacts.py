"""Contacts that stick exactly in an assembled model: their modes, and when each mode ends."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, cast

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import FREE, Mode, RowLaw, spanned
from exudyn_models.solver.contacts import laws_of
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.backlash import Backlash
from exudyn_models.solver.rows.laws import LEAST as UNLOADED
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw, RotaryLaw
from exudyn_models.solver.stick.complementarity import DEPENDENT, Law, size_in_hull
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.planar_stick import NEGLIGIBLE, TINY, PlanarStick
from exudyn_models.solver.stick.slip_motion import RESOLVED, SlipMotion
from reference_model.systems import FloatArray

STILL = 1e-8
"""Largest slip in m/s or rad/s of a contact at rest whose slip joints and prescribed motions determine."""

LEAST = 1e-200
"""Least capacity in N m: shares of loads stay finite if friction vanishes."""

AHEAD = 1e-3
"""Time in s that shows whether a prescribed motion moves a contact."""


@dataclass(frozen=True)
class ModeChange:
    """Change of the mode of a contact.

    Parameters
    ----------
    time : float
        Time in s.
    contact : int
        Object number of the contact's connector.
    before, after : Mode
        Mode until and from that time.
    point : int or None
        Number of the point, from 1, of a contact at several points that stick one by one.

    """

    time: float
    contact: int
    before: Mode
    after: Mode
    point: int | None = None


@dataclass(frozen=True, eq=False)
class StickingContact:
    """Contact on one axis that sticks exactly."""

    item: int
    """Object number of the connector."""
    stick: RowLaw
    places: NDArray[Any]
    """Positions of its coordinates among the model's."""
    whole: RowLaw
    """Law of the connector; ``stick`` is one of its parts."""

    resolution: ClassVar[float] = 1e-9
    """Share of a step within which a contact that counts as resting stops, and relative error of slips."""

    @property
    def directions(self) -> int:
        """Number of directions of slip that locks hold."""
        return 1

    @property
    def mode(self) -> Mode:
        """Present mode."""
        assert self.stick.mode is not None
        return self.stick.mode

    def enter(self, mbs: Any, mode: Mode) -> None:
        """Switch to a mode, without its locks."""
        before, self.stick.mode, self.stick.entered = self.stick.entered, mode, mode
        if before is not mode and (forces := self.stick.constant_forces) is not None:
            mbs.SetObjectParameter(self.item, "forceVector", forces)

    def lock(self, mbs: Any, directions: Sequence[int] = ()) -> None:
        """Let constraints hold these directions of slip; in the plane, the last constraint holds all of them."""
        if len(directions) == self.directions > 1:
            directions = [self.directions]
        before = self.stick.held
        self.stick.held = tuple(i in directions for i in range(len(self.stick.locks)))
        if self.stick.held != before:
            for lock, holds in zip(self.stick.locks, self.stick.held, strict=True):
                mbs.SetObjectParameter(lock, "activeConnector", holds)

    def force_places(self, data: Any) -> NDArray[Any]:
        """Return the places of the forces of constraints for one direction each, and for all, shape (2, k)."""
        places = [np.array(data.GetObjectLTGAE(lock)) for lock in self.stick.locks]
        alone = np.concatenate(places[: self.directions])
        return np.array([alone, places[self.directions] if self.directions > 1 else alone])

    def omit_user_functions(self, mbs: Any) -> None:
        """Let Exudyn evaluate constant moments itself."""
        if self.stick.constant_forces is not None:
            self._call(mbs, False)

    def restore_user_functions(self, mbs: Any) -> None:
        """Let Exudyn call the user functions of the connector."""
        if self.stick.constant_forces is not None:
            mbs.SetObjectParameter(self.item, "forceVector", np.zeros(len(self.places)))
        self._call(mbs, True)

    def _call(self, mbs: Any, calls: bool) -> None:
        if calls != self.whole.called:
            self.whole.called = calls
            mbs.SetObjectParameter(self.item, "forceUserFunction", self.whole.force if calls else 0)
            mbs.SetObjectParameter(self.item, "jacobianUserFunction", self.whole.jacobian if calls else 0)

    def sliding_mode(self, slip: FloatArray) -> Mode:
        """Return the mode of a contact with a slip along its locks."""
        return Mode.FORWARD if slip[0] > 0.0 else Mode.BACKWARD if slip[0] < 0.0 else Mode.LOCKED

    @property
    def law(self) -> Law | None:
        """Support function of friction, or None on an axis."""
        return None

    def shares(self, forces: FloatArray, limits: FloatArray) -> tuple[Sequence[float], Sequence[FloatArray]]:
        """Return shares of the ``limits`` of forces along the locks, and their slopes; the largest share counts."""
        return [forces[0] / limits[1], -forces[0] / limits[0]], [1.0 / limits[1:], -1.0 / limits[:1]]

    def effective(self) -> FloatArray:
        """Return the projection of forces along the locks onto forces that joints cannot carry, shape (k, k)."""
        return np.eye(1)

    def strength(self, t: float) -> tuple[float, tuple[float, float]]:
        """Return the static friction, a moment in N m, and its limits against sliding forward and backward.

        The limits are > 0, also without friction and for a one-way clutch.
        """
        forward, backward = self.stick.limits(t)
        largest = max(forward, backward)
        least = max(FREE * largest, LEAST)
        return self.stick.without_rounding(largest), (max(forward, least), max(backward, least))

    def rows_and_bias(self, state: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Return the gradients of the locked slips, shape (k, n), and their rates without accelerations, shape (k,).

        ``state`` contains the coordinates of the model, without reference values, and their derivatives.
        """
        if len(self.stick.weights):
            return self.stick.weights[None], np.zeros(1)
        q, q_t = state
        own = q[self.places], q_t[self.places], np.zeros(len(self.places))
        return self.stick.rows(self.stick.reference + own[0]), self.stick.bias(own)

    def _state(self, mbs: Any) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return coordinates without reference values, and their derivatives."""
        data, places = mbs.systemData, self.places
        return (
            data.GetODE2Coordinates(CURRENT, False)[places],
            data.GetODE2Coordinates_t(CURRENT, False)[places],
            data.GetODE2Coordinates_tt(CURRENT, False)[places],
        )

    def margin(self, mbs: Any) -> float:
        """Return the slip in the direction of sliding (rad/s), which falls below zero when it ends, or 1."""
        return int(self.mode) * self.stick.slip(*self._state(mbs)[:2]) if self.stick.slides else 1.0


class RotorCoupling(StickingContact):
    """One-way clutch, mesh or contact whose load grows with a moment, which never opens."""

    def strength(self, t: float) -> tuple[float, tuple[float, float]]:
        """Return a moment in N m without effect on the choice of modes, and the limits by the present moments."""
        return UNLOADED, super().strength(t)[1]


class SpringFlanks(StickingContact):
    """Flanks of a torsional spring with backlash."""

    @property
    def flanks(self) -> Backlash:
        """Law of the spring."""
        return cast(Backlash, self.stick)

    def choose(self, mbs: Any, ahead: float) -> None:
        """Choose the flank that is pressed a time ``ahead`` (s) from now."""
        twist, rate = self._motion(mbs)
        self.flanks.mode = self.flanks.pressed(twist + ahead * rate, rate)

    def margin(self, mbs: Any) -> float:
        """Return a moment in N m that falls below zero when the pressed flank changes."""
        return self.flanks.margin(*self._motion(mbs))

    def _motion(self, mbs: Any) -> tuple[float, float]:
        q, q_t, _ = self._state(mbs)
        return self.flanks.twist(q), self.flanks.slip(q, q_t)


class PlanarContact(StickingContact):
    """Contact between bodies that may slide sideways."""

    resolution: ClassVar[float] = RESOLVED

    @cached_property
    def planar(self) -> PlanarStick:
        """Law of friction."""
        return cast(PlanarStick, self.stick)

    @property
    def directions(self) -> int:
        """Number of directions of slip that locks hold."""
        return self.planar.most_locks

    def enter(self, mbs: Any, mode: Mode) -> None:
        """Switch to a mode; a contact at rest needs no user functions."""
        super().enter(mbs, mode)
        self._call(mbs, any(part.slides for part in self.whole.active))

    @property
    def free_to_slide(self) -> bool:
        """True if the contact slides and nothing else determines its slip."""
        return self.stick.slides and self.planar.allowed.shape[1] > 0

    def passes(self, motion: SlipMotion) -> bool:
        """Return whether joints, locks and prescribed motions accelerate a slip, so it may only pass through zero."""
        free = self.planar.allowed
        imposed = motion.rate - free @ np.linalg.lstsq(free, motion.rate, rcond=None)[0]
        return AHEAD * self.planar.potential_of(imposed) > STILL

    @property
    def law(self) -> Law | None:
        """Support function of friction."""
        return self.planar.potential_along_locks

    def allow(self, compliance: FloatArray, lengths: FloatArray) -> None:
        """Store the slips that joints allow.

        ``compliance``, shape (k, k), relates accelerations to forces along the locks, also without joints, which
        gives the ``lengths`` of its diagonal, shape (k,).
        """
        sizes, axes = np.linalg.eigh(compliance)
        free = axes[:, sizes > DEPENDENT * lengths.max()] / self.planar.scales[:, None]
        self.planar.allowed = np.vstack([free, np.zeros((3 - len(free), free.shape[1]))])

    def strength(self, t: float) -> tuple[float, tuple[float, float]]:
        """Return the static friction in N, and twice the same, > 0."""
        holding = self.planar.without_rounding(self.planar.holding_force(t))
        return holding, (max(holding, TINY),) * 2

    def effective(self) -> FloatArray:
        """Return the projection of forces along the locks onto forces that joints cannot carry, shape (k, k)."""
        axes = self.planar.allowed[: self.planar.most_locks] * self.planar.scales[:, None]
        return np.asarray(axes @ axes.T)

    def shares(self, forces: FloatArray, limits: FloatArray) -> tuple[Sequence[float], Sequence[FloatArray]]:
        """Return the share of the ``limits`` of forces along the locks, and its slope."""
        scales, wrench, count = self.planar.scales, np.zeros(3), len(forces)
        wrench[:count] = scales * forces
        share, slip = self.planar.load_share(wrench, limits[0])
        return [share], [slip[:count] * (-scales / limits[0])]

    def share_bound(self, forces: FloatArray, limit: float) -> float:
        """Return a bound of this share."""
        return size_in_hull(forces.tolist()) / limit

    def motion(self, mbs: Any) -> SlipMotion:
        """Return the present motion, and store its radius for the capacity in stick."""
        motion = self.planar.motion(*self._state(mbs))
        self.planar.radius = motion.radius
        return motion

    def start_step(self, mbs: Any) -> None:
        """Prepare the friction for the next step."""
        if self.stick.slides:
            self.planar.start_step(self._state(mbs))

    def slid(self, mbs: Any) -> SlipMotion:
        """Return the present motion, and store its direction as the mode."""
        motion = self.motion(mbs)
        self.stick.mode = self.sliding_mode(motion.slip)
        return motion

    def margin(self, mbs: Any) -> float:
        """Return 1, or a number that falls below zero when the slip of a held contact begins or vanishes."""
        if self.stick.slides:
            return 1.0 if self.free_to_slide else self.slid(mbs).potential / STILL - 0.5
        if self.mode == Mode.OPEN or self.planar.allowed.shape[1] == self.planar.most_locks:
            return 1.0
        return 1.0 - self.motion(mbs).potential / STILL

    def goes_on(self, mbs: Any, t: float) -> bool:
        """Return whether the contact neither opens nor closes, and no slip begins or vanishes."""
        return (self.strength(t)[0] == 0.0) is (self.mode is Mode.OPEN) and self.margin(mbs) == 1.0

    def sliding_mode(self, slip: FloatArray) -> Mode:
        """Return the mode of a contact with a slip."""
        x, y, *spin = slip.tolist()
        rim = spin[0] * (self.planar.mean_radius or 1.0) if spin else 0.0
        return (
            Mode.BACKWARD if rim < -NEGLIGIBLE * math.hypot(x, y) else Mode.FORWARD
        )  # spin may be a rounding error


def sticking_contacts(mbs: Any, start: float, end: float) -> list[StickingContact]:
    """Return the contacts of a model that stick exactly in a run between two times (s), and after them the springs.

    A contact counts as on one axis if, at the initial values, joints keep its centre there and no prescribed motion
    moves it. Raises ``ValueError`` if a contact in the plane accompanies a gear with losses or a one-way clutch.
    """
    contacts = [
        StickingContact(item, law, np.array(mbs.systemData.GetObjectLTGODE2(item)), law)
        for item, law in laws_of(mbs).items()
        if not (isinstance(law, MeshLaw) and law.lossless)
    ]
    # Powers keep periodic motions from vanishing at all of these times.
    _locate(mbs, start + (end - start) * np.linspace(0.0, 1.0, 30) ** 1.1, contacts)
    found = [
        _kind(part)(contact.item, part, contact.places, contact.stick)
        for contact in contacts
        for part in contact.stick.active
    ]
    planar = next((contact for contact in found if isinstance(contact, PlanarContact)), None)
    if planar is not None and any(isinstance(contact, RotorCoupling) for contact in found):
        raise ValueError(
            f"object {planar.item}: a contact in the plane that sticks exactly cannot be combined with a gear with "
            "losses, a one-way clutch or a load that grows with a moment; give the contact a regularisation, or "
            "hold it on one axis by joints"
        )
    return sorted(found, key=lambda contact: isinstance(contact, SpringFlanks))


def _kind(part: RowLaw) -> type[StickingContact]:
    if isinstance(part, Backlash):
        return SpringFlanks
    if isinstance(part, (RotaryLaw, GrowingLimit)):
        return RotorCoupling
    return StickingContact if part.on_axis else PlanarContact


def _locate(mbs: Any, times: FloatArray, contacts: Sequence[StickingContact]) -> None:
    """Find the parts of contacts that joints hold on one axis at all ``times`` (s)."""
    parts = [
        PlanarContact(contact.item, part, contact.places, contact.stick)
        for contact in contacts
        for part in contact.stick.parts
        if isinstance(part, PlanarStick)
    ]
    if not parts:
        return
    dynamics = Dynamics(mbs, times[0], 1.0)
    dynamics.evaluate(times[0])
    start = mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial)
    joints, speeds = dynamics.gradients, dynamics.prescribed_speeds(times)
    for part in parts:
        across = np.zeros((2, joints.shape[1]))
        across[:, part.places] = part.planar.slip_map(part.stick.reference + start[part.places])[:2]
        across[np.abs(across) < NEGLIGIBLE] = 0.0
        part.planar.on_axis = part.planar.mean_radius > 0.0 and spanned(across, joints)
        if part.planar.on_axis and speeds.any():
            shares = np.linalg.lstsq(joints.T, across.T, rcond=None)[0]
            part.planar.on_axis = bool(
                (np.abs(speeds @ shares) <= NEGLIGIBLE * np.abs(speeds) @ np.abs(shares)).all()
            )


@contextmanager
def running(mbs: Any, contacts: Sequence[StickingContact]) -> Iterator[None]:
    """Let contacts stick and slide in a run, at first without friction."""
    try:
        for contact in contacts:
            contact.stick.running, contact.stick.largest = True, 0.0
            contact.stick.entered = contact.stick.held = None
            contact.omit_user_functions(mbs)
            contact.enter(mbs, Mode.OPEN)
            contact.lock(mbs)
        yield
    finally:
        for contact in contacts:
            contact.stick.running = False
            contact.restore_user_functions(mbs)
            for lock in contact.stick.locks:  # it must not hold after the contact is deleted
                mbs.SetObjectParameter(lock, "activeConnector", False)
