"""Contacts that stick exactly in an assembled model: their modes, and when each mode ends."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, ClassVar, cast

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import FREE, AxialStick, Mode, spanned
from exudyn_models.solver.contacts import contacts_of
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.planar_stick import NEGLIGIBLE, SPIN, PlanarStick
from exudyn_models.solver.stick.slip_motion import SlipMotion
from reference_model.systems import FloatArray

STILL = 1e-8
"""Largest slip in m/s or rad/s of a contact at rest whose slip joints and prescribed motions determine."""

AHEAD = 1e-3
"""Time in s that shows whether a prescribed motion starts to move a contact at rest."""


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
    stick: AxialStick
    places: NDArray[Any]
    """Positions of its coordinates among the model's."""

    rest_share: ClassVar[float] = 1e-9
    """Share of a step within which a contact that counts as resting stops."""

    @property
    def mode(self) -> Mode:
        """Present mode."""
        assert self.stick.mode is not None
        return self.stick.mode

    def enter(self, mbs: Any, mode: Mode, lock: bool = True) -> None:
        """Switch to a mode; without a ``lock``, others hold the contact at rest."""
        self.stick.mode = mode
        mbs.SetObjectParameter(self.stick.locks[0], "activeConnector", lock and mode == Mode.LOCKED)
        if (forces := self.stick.constant_forces) is not None:
            mbs.SetObjectParameter(self.item, "forceVector", forces)

    def omit_user_functions(self, mbs: Any) -> None:
        """Let Exudyn evaluate constant moments itself."""
        if self.stick.constant_forces is not None:
            for name in ("forceUserFunction", "jacobianUserFunction"):
                mbs.SetObjectParameter(self.item, name, 0)

    def restore_user_functions(self, mbs: Any) -> None:
        """Undo ``omit_user_functions``."""
        if self.stick.constant_forces is None:
            return
        mbs.SetObjectParameter(self.item, "forceVector", np.zeros(len(self.places)))
        mbs.SetObjectParameter(self.item, "forceUserFunction", self.stick.force)
        mbs.SetObjectParameter(self.item, "jacobianUserFunction", self.stick.jacobian)

    def enter_first(self, mbs: Any, t: float) -> None:
        """Switch to the mode that load and initial slip suggest."""
        slip = self.slip(mbs, exu.ConfigurationType.Initial)
        self.enter(mbs, Mode.OPEN if self.holding(t) == 0.0 else Mode(int(np.sign(slip))))

    def holding(self, t: float) -> float:
        """Return the static friction, a moment in N m."""
        return self.stick.without_rounding(max(self.stick.limits(t)))

    def capacities(self, t: float) -> tuple[float, float]:
        """Return the largest moments in N m against sliding forward and backward, > 0 of a one-way clutch too."""
        forward, backward = self.stick.limits(t)
        least = FREE * max(forward, backward)
        return max(forward, least), max(backward, least)

    def opens_or_closes(self, holding: float) -> bool:
        """Return whether static friction has vanished, or acts on an open contact."""
        return (holding == 0.0) != (self.mode == Mode.OPEN)

    def rows(self, mbs: Any) -> FloatArray:
        """Return the gradients of the locked slips for all velocities of the model."""
        return self._widened(mbs, self.stick.rows)

    def _widened(self, mbs: Any, gradients_at: Callable[[FloatArray], FloatArray]) -> FloatArray:
        data = mbs.systemData
        coordinates = data.GetODE2Coordinates(exu.ConfigurationType.Initial)[self.places]
        gradients = gradients_at(self.stick.reference + coordinates)
        rows = np.zeros((len(gradients), data.ODE2Size()))
        rows[:, self.places] = gradients
        return rows

    def active_locks(self) -> Sequence[int]:
        """Return the object numbers of the active constraints."""
        return self.stick.locks[:1]

    def bias(self, mbs: Any) -> FloatArray:
        """Return the rates of the locked slips without accelerations, shape (k,), in m/s² or rad/s²."""
        return self.stick.bias(self._state(mbs))

    def _state(self, mbs: Any, configuration: Any = CURRENT) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return coordinates without reference values, and their derivatives."""
        data, places = mbs.systemData, self.places
        return (
            data.GetODE2Coordinates(configuration)[places],
            data.GetODE2Coordinates_t(configuration)[places],
            data.GetODE2Coordinates_tt(configuration)[places],
        )

    def slip(self, mbs: Any, configuration: Any = CURRENT) -> float:
        """Return S in rad/s."""
        return self.stick.slip(*self._state(mbs, configuration)[:2])

    def margin(self, mbs: Any, t: float) -> float:
        """Return a number that falls below zero when the present mode ends.

        It is the slip in the direction of sliding (rad/s), 1 at rest, or ±1 without load or coefficient.
        """
        stick, mode = self.stick, self.mode
        limits = stick.limits(t)
        if self.opens_or_closes(stick.without_rounding(max(limits))):
            return -1.0
        return int(mode) * self.slip(mbs) if stick.slides else 1.0


class PlanarContact(StickingContact):
    """Contact between bodies that may slide sideways."""

    rest_share: ClassVar[float] = 1e-6

    @property
    def planar(self) -> PlanarStick:
        """Law of friction."""
        return cast(PlanarStick, self.stick)

    @property
    def free_to_slide(self) -> bool:
        """True if the contact slides and nothing else determines its slip."""
        return self.stick.slides and not self.planar.held

    def allow(self, mbs: Any, by_joints: FloatArray, velocities: FloatArray) -> None:
        """Let the contact lock the slips of ``velocities``, shape (n, m); joints allow those ``by_joints``."""
        slips = self.slip_rows(mbs)
        self.planar.allowed = self.planar.span(slips @ by_joints)
        self.planar.set_basis(self.planar.span(slips @ velocities))

    def slip_rows(self, mbs: Any) -> FloatArray:
        """Return the map from all velocities of the model to the slip, shape (3, n)."""
        return self._widened(mbs, self.planar.slip_map)

    def scaled(self, gradient: FloatArray) -> FloatArray:
        """Return a dimensionless gradient of P."""
        return gradient / [1.0, 1.0, self.planar.mean_radius or 1.0]

    def enter(self, mbs: Any, mode: Mode, lock: bool = True) -> None:
        """Switch to a mode."""
        self.stick.mode = mode
        active = self.active_locks() if lock and mode == Mode.LOCKED else ()
        for own in self.stick.locks:
            mbs.SetObjectParameter(own, "activeConnector", own in active)

    def enter_first(self, mbs: Any, t: float) -> None:
        """Switch to the mode that load and initial slip suggest."""
        self.enter(mbs, self._free_mode(mbs, t, exu.ConfigurationType.Initial))

    def following(self, mbs: Any, t: float) -> Mode:
        """Return the next mode at the end of the present one, if no other contact changes."""
        if self.planar.rests and self.holding(t) > 0.0:
            return self.driven(mbs)
        return self._free_mode(mbs, t, CURRENT)

    def holding(self, t: float) -> float:
        """Return the static friction in N."""
        return self.planar.without_rounding(self.planar.holding_force(t))

    def driven(self, mbs: Any) -> Mode:
        """Return the mode into which the load or a prescribed motion drives a contact, and store the direction."""
        slip, moved = self.carried(mbs)
        _, share = self.planar.load_share(self.planar.held_wrench(mbs), 1.0)
        self.planar.direction = slip / moved if moved > STILL else share
        return self._sliding_mode(self.planar.direction)

    def carried(self, mbs: Any, ahead: float = AHEAD) -> tuple[FloatArray, float]:
        """Return the slip that joints impose on a contact at rest after a time ``ahead`` (s), and its potential."""
        if not self.planar.rests or self.planar.allowed.shape[1] == self.planar.most_locks:
            return np.zeros(3), 0.0
        motion = self.motion(mbs)
        slip = motion.slip + ahead * motion.rate
        return slip, self.planar.potential_of(slip)

    def motion(self, mbs: Any, configuration: Any = CURRENT) -> SlipMotion:
        """Return the present motion, and store its radius for the capacity in stick."""
        motion = self.planar.motion(*self._state(mbs, configuration))
        self.planar.radius = motion.radius
        return motion

    def active_locks(self) -> Sequence[int]:
        """Return the object numbers of the active constraints."""
        return self.stick.locks[: self.planar.basis.shape[1]]

    def start_step(self, mbs: Any) -> None:
        """Prepare the friction for the next step."""
        q, q_t, _ = self._state(mbs)
        self.planar.start_step(q, q_t)

    def slid(self, mbs: Any) -> SlipMotion:
        """Return the present motion, and store its direction as the mode."""
        motion = self.motion(mbs)
        self.stick.mode = self._sliding_mode(motion.slip)
        return motion

    def margin(self, mbs: Any, t: float) -> float:
        """Return the unused share of the capacity, or ±1 if open; ``sliding_steps`` finds the end of sliding."""
        holding = self.holding(t)
        if self.opens_or_closes(holding):
            return -1.0
        if self.stick.slides and self.planar.held and not self.stick.idle:  # a prescribed motion may end
            return self.slid(mbs).potential / STILL - 0.5
        return 1.0 - max(self.overload(mbs, t), self.carried(mbs, 0.0)[1] / STILL)

    def overload(self, mbs: Any, t: float) -> float:
        """Return the share of the capacity that a contact at rest holds, else 0."""
        return self.planar.capacity_share(mbs, t) if self.planar.rests else 0.0

    def hold(self, mbs: Any, held: bool) -> None:
        """Note whether joints or other contacts hold a sliding contact, and whether it rests."""
        self.planar.held = self.stick.idle = held
        self.stick.idle = held and self.carried(mbs)[1] <= STILL

    def reverses(self, mbs: Any, time: float) -> bool:
        """Return whether a sliding contact stops within a ``time`` (s)."""
        return self.free_to_slide and self.motion(mbs).rests_within(time)

    def _free_mode(self, mbs: Any, t: float, configuration: Any) -> Mode:
        motion = self.motion(mbs, configuration)
        if self.holding(t) == 0.0:
            return Mode.OPEN
        return self._sliding_mode(motion.slip) if motion.is_resolved else Mode.LOCKED

    def _sliding_mode(self, slip: FloatArray) -> Mode:
        sideways, rim = math.hypot(slip[0], slip[1]), slip[2] * (self.planar.mean_radius or 1.0)
        return Mode.BACKWARD if rim < -NEGLIGIBLE * sideways else Mode.FORWARD  # spin may be a rounding error


def sticking_contacts(mbs: Any, start: float, end: float) -> list[StickingContact]:
    """Return the contacts of a model that stick exactly, on one axis or in the plane, in a run between two times (s).

    Joints at the initial values keep the centre of a contact on one axis, and no motion that they prescribe moves it.
    """
    contacts = [
        StickingContact(item, contact.stick, np.array(mbs.systemData.GetObjectLTGODE2(item)))
        for item, contact in contacts_of(mbs).items()
        if contact.stick is not None
    ]
    # Powers keep periodic motions from vanishing at all of these times.
    _locate(mbs, start + (end - start) * np.linspace(0.0, 1.0, 30) ** 1.1, contacts)
    return [
        (StickingContact if part.on_axis else PlanarContact)(contact.item, part, contact.places)
        for contact in contacts
        for part in contact.stick.active
    ]


def _locate(mbs: Any, times: FloatArray, contacts: Sequence[StickingContact]) -> None:
    """Find the parts of contacts that joints hold on one axis at all ``times`` (s)."""
    parts = [
        PlanarContact(contact.item, part, contact.places)
        for contact in contacts
        for part in contact.stick.parts
        if isinstance(part, PlanarStick)
    ]
    if not parts:
        return
    dynamics = Dynamics(mbs, times[0], 1.0)
    dynamics.evaluate(times[0])
    joints, speeds = dynamics.gradients, dynamics.prescribed_speeds(times)
    for part in parts:
        across = part.slip_rows(mbs)[:2]
        across[np.abs(across) < NEGLIGIBLE] = 0.0
        part.planar.on_axis = part.planar.mean_radius > 0.0 and spanned(across, joints)
        if part.planar.on_axis and speeds.any():
            shares = np.linalg.lstsq(joints.T, across.T, rcond=None)[0]
            part.planar.on_axis = bool(
                (np.abs(speeds @ shares) <= NEGLIGIBLE * np.abs(speeds) @ np.abs(shares)).all()
            )
        part.planar.set_basis(SPIN)


@contextmanager
def first_modes(mbs: Any, contacts: Sequence[StickingContact], t: float) -> Iterator[None]:
    """Give contacts the modes of load and slip at the start of a run."""
    try:
        for contact in contacts:
            contact.stick.running, contact.stick.largest = True, 0.0
            contact.omit_user_functions(mbs)
        for contact in contacts:
            contact.enter_first(mbs, t)
        yield
    finally:
        for contact in contacts:
            contact.stick.running = False
            contact.restore_user_functions(mbs)
            for lock in contact.stick.locks:  # it must not hold after the contact is deleted
                mbs.SetObjectParameter(lock, "activeConnector", False)


def joints_of(mbs: Any, dynamics: Dynamics, contacts: Sequence[StickingContact]) -> FloatArray:
    """Return the gradients of all constraints except the locks of ``contacts``, shape (m, n), as last evaluated."""
    locks = [lock for contact in contacts for lock in contact.stick.locks]
    places = [int(mbs.systemData.GetObjectLTGAE(lock)[0]) for lock in locks]
    return np.delete(dynamics.gradients, places, axis=0)
