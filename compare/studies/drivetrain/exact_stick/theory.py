"""Models of contacts that stick exactly, and closed forms of their motion."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from compare.studies.toolkit.rotors import Rotors
from compare.studies.toolkit.torsional_chain import BACKWARD, FORWARD, STUCK, Chain, Harmonic
from reference_model.systems import FloatArray, System

NEWTON = 1e-11
"""Relative tolerance of Newton's iteration, small compared with the errors of the steps."""


class Event(NamedTuple):
    """Contact in the order of the closed form, time in s, and the mode that begins."""

    contact: int
    time: float
    mode: int


class Model(Rotors):
    """Rotors and bodies in the plane (2 kg, 0.1 kg m²) with contacts that stick exactly."""

    def __init__(self, inertias: Sequence[float] = (), speeds: Sequence[float] = ()) -> None:
        super().__init__(inertias, speeds)
        self.contacts: list[Any] = []

    def rub(self, pair: Sequence[Any], moment: Any, **law: Any) -> Any:
        """Add friction between master and disc, by default on a ring of 1 m with a coefficient of 1."""
        from exudyn_models import add_ring_friction

        law = {"contact_radius": 1.0, "friction_coefficient": 1.0, "normal_load": moment} | law
        self.contacts.append(add_ring_friction(self.mbs, *pair, **law))
        return self.contacts[-1]

    def drive(self, node: Any, torque: Callable[[Any], Any]) -> None:
        """Load the first coordinate of a node with a torque (N m), a function of time."""
        load = {"load": 1.0, "loadUserFunction": lambda mbs, t, load: float(torque(t))}
        self.mbs.AddLoad(self.items.LoadCoordinate(markerNumber=self.marker(node), **load))

    def prescribe(self, node: Any, way: Callable[[float], float], rate: Callable[[float], float]) -> None:
        """Prescribe the first coordinate of a node by a constraint."""
        constraint = self.items.CoordinateConstraint(
            markerNumbers=[self.marker(self.mbs.AddNode(self.items.NodePointGround())), self.marker(node)],
            offsetUserFunction=lambda mbs, t, item, offset: way(t),
            offsetUserFunction_t=lambda mbs, t, item, offset: rate(t),
        )
        self.mbs.AddObject(constraint)

    def body(self, place: Sequence[float], velocity: Sequence[float]) -> tuple[Any, Any]:
        """Add a body in the plane; return its node and its object."""
        start = {"referenceCoordinates": list(place), "initialVelocities": list(velocity)}
        node = self.mbs.AddNode(self.items.NodeRigidBody2D(**start))
        return node, self.mbs.AddObject(
            self.items.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=INERTIA)
        )

    def follow(self, until: float, step: float, solver: str, breaks: Sequence[float] = ()) -> FloatArray:
        """Return the times (s) of a run and the values of all sensors, one column each."""
        return self.run(until, round(until / step), solver=solver, breaks=breaks, newton=NEWTON)

    def times(self, expected: Sequence[Event]) -> FloatArray:
        """Return the times (s) of the ``expected`` events in the last run, or NaN if the run has other events."""
        numbers = [int(contact.item) for contact in self.contacts]
        found = sorted(
            Event(numbers.index(int(one.contact)), one.time, int(one.after)) for one in self.changes
        )
        if [(one.contact, one.mode) for one in found] != [(one.contact, one.mode) for one in expected]:
            return np.full(len(expected), math.nan)
        return np.array([one.time for one in found])


# ---------------------------------------------------------------- clutches and gears under harmonic torques


def _constant(torque: float) -> tuple[tuple[float, Harmonic], ...]:
    return ((0.0, Harmonic(torque)),)


IN_A_ROW = Chain(
    (1.0, 0.5, 2.0, 1.0),
    [((0.0, Harmonic(10.0, 8.0, 0.0)),), *[_constant(0.0)] * 3],
    [_constant(capacity) for capacity in (6.0, 5.0, 4.0)],
    static_ratio=1.2,
)

SHIFT, RATE = (1.0, 1.1), 5.0 * math.pi
"""Times in s between which the clutch of a gear takes over from its brake; rate in rad/s of both loads."""

TO_CARRIER = np.array([1.0, 1.5]) / 2.5
"""Speed of a planet carrier from the speeds of sun and ring."""

GEAR = Chain(
    np.diag([1.0, 0.0]) + 10.0 * np.outer(TO_CARRIER, TO_CARRIER),
    [_constant(torque) for torque in np.array([20.0, 0.0]) - 3.0 * TO_CARRIER],
    [
        (*_constant(0.0), (SHIFT[0], Harmonic(100.0, RATE, -RATE * SHIFT[0])), (SHIFT[1], Harmonic(100.0))),
        (
            *_constant(100.0),
            (SHIFT[0], Harmonic(100.0, RATE, RATE * (0.1 - SHIFT[0]))),
            (SHIFT[1], Harmonic()),
        ),
    ],
    slips=np.array([[1.0, -1.0], [0.0, 1.0]]),
)
"""Modelica's SimpleGearShift with other torques: its ring has no mass, a clutch to the sun and a brake."""


def chained(chain: Chain, pairs: Sequence[tuple[int | None, int]], speeds: Sequence[float]) -> Model:
    """Return the model of a chain whose clutches connect ``pairs`` of rotors; None is the ground."""
    import exudyn as exu  # deferred: the command line must start without it

    model = Model()
    model.nodes = [model.mbs.AddNode(model.items.Node1D(initialVelocities=[speed])) for speed in speeds]
    masses = np.asarray(chain.inertias)
    masses = np.diag(masses) if masses.ndim == 1 else masses
    model.mbs.AddObject(model.items.ObjectGenericODE2(nodeNumbers=model.nodes, massMatrix=masses))
    for node, pieces in zip(model.nodes, chain.torques, strict=True):
        model.drive(node, pieces[0][1])
    for pair, pieces in zip(pairs, chain.capacities, strict=True):
        ends = [None if i is None else model.nodes[i] for i in pair]
        model.rub(ends, lambda time, pieces=pieces: _load(pieces, time), static_ratio=chain.static_ratio)
    model.sensors = [model.sensor(node, exu.OutputVariableType.Coordinates_t) for node in model.nodes]
    return model


def _load(pieces: Sequence[tuple[float, Harmonic]], time: float) -> float:
    return max(0.0, float([f for begin, f in pieces if begin <= time][-1](np.asarray(time))))


def switches(chain: Chain, speeds: Sequence[float], until: float) -> list[Event]:
    motion = chain.motion(speeds, until)
    return [Event(i, *one) for i in range(len(chain.capacities)) for one in motion.switches(i)]


# ---------------------------------------------------------------- contacts that hold each other

STATIC_RATIO, RAMP = 1.5, 100.0
"""Static divided by sliding friction, and growth of the load in N m/s."""

BRAKES, WHEEL, WHEEL_UNTIL = (10.0, 8.0), 0.5, 0.3
"""Moments in N m of two brakes, inertia in kg m² of their wheel, and end of its load in s."""

LOOP, LOOPED, LOOP_UNTIL = (6.0, 4.0, 8.0), (1.0, 0.5), 0.4
"""Moments in N m between the ground and two rotors and between both rotors, their inertias, and the end of the first
load."""


def loaded(inertias: Sequence[float], until: float, moments: Sequence[float], order: Sequence[int]) -> Model:
    """Return rotors at rest whose contacts are added in an ``order``."""
    model = Model(inertias, [0.0] * len(inertias))
    one, other = model.nodes[0], model.nodes[-1]
    pairs = ((None, one), (None, other), (one, other))
    model.drive(one, lambda t: RAMP * t if t < until else 0.0)
    contacts = {i: model.rub(pairs[i], moments[i], static_ratio=STATIC_RATIO) for i in order}
    model.contacts = [contacts[i] for i in sorted(order)]
    return model


def of_brakes() -> list[Event]:
    """Return the events of the wheel, whose brakes hold the sum of their static moments."""
    release = STATIC_RATIO * sum(BRAKES) / RAMP
    stop = WHEEL_UNTIL + WHEEL * float(speed_of_wheel(np.array(WHEEL_UNTIL))) / sum(BRAKES)
    return [Event(i, *one) for i in range(2) for one in ((release, FORWARD), (stop, STUCK))]


def speed_of_wheel(t: FloatArray) -> FloatArray:
    """Return the exact speed of the wheel in rad/s."""
    release = STATIC_RATIO * sum(BRAKES) / RAMP
    loaded = np.clip(t, release, WHEEL_UNTIL)
    momentum = 0.5 * RAMP * (loaded**2 - release**2) - sum(BRAKES) * (np.maximum(t, release) - release)
    return np.asarray(np.maximum(momentum, 0.0) / WHEEL)


def of_loop() -> list[Event]:
    """Return the events of the loop: both rotors release together, part, meet again and stop."""
    (first, second, between), (j, k) = LOOP, LOOPED
    release = STATIC_RATIO * (first + second) / RAMP
    # At the common acceleration a, the contact between the rotors transmits second + k·a.
    part = ((STATIC_RATIO * between - second) * (j + k) / k + first + second) / RAMP
    together = 0.5 * RAMP * (part**2 - release**2) - (first + second) * (part - release)
    slows, drags = (first + between) / j, (between - second) / k
    gained = 0.5 * RAMP / j * (LOOP_UNTIL**2 - part**2)
    meet = part + gained / (slows + drags)
    speed = together / (j + k) + drags * (meet - part)
    stop = meet + speed * (j + k) / (first + second)
    held = [Event(i, *one) for i in range(2) for one in ((release, FORWARD), (stop, STUCK))]
    return [*held, Event(2, part, BACKWARD), Event(2, meet, STUCK)]


# ---------------------------------------------------------------- prescribed motion

SPEED, GROWTH, PLACE, COIN, GRAVITY = 4.0, 0.73, 0.15, 0.35, 9.81
"""Turntable in rad/s and rad/s², place of a coin in m, its coefficient, and gravity in m/s²."""

TURNING, STROKE, FRICTION = 5.0, 3.0, (30.0, 20.0)
"""Rate in rad/s of a shaft that swings by 1 rad, acceleration of a slider in m/s², and friction in N m and N."""


def turntable() -> Model:
    model = Model((1.0,), (SPEED,))
    model.prescribe(model.nodes[0], lambda t: SPEED * t + 0.5 * GROWTH * t * t, lambda t: SPEED + GROWTH * t)
    coin, _ = model.body([PLACE, 0.0, 0.0], [0.0, PLACE * SPEED, SPEED])
    model.rub((model.nodes[0], coin), MASS * GRAVITY, contact_radius=0.0, friction_coefficient=COIN)
    return model


def of_coin() -> list[Event]:
    release = ((COIN * GRAVITY / PLACE) ** 2 - GROWTH**2) ** 0.25
    return [Event(0, (release - SPEED) / GROWTH, BACKWARD)]


def shaft_and_slider() -> Model:
    """Return a swinging shaft and a slider; the sensors read their heat and the moment on the shaft."""
    model = Model((1.0,), (TURNING,))
    slider, _ = model.body([0.0] * 3, [0.0] * 3)
    model.prescribe(
        model.nodes[0], lambda t: math.sin(TURNING * t), lambda t: TURNING * math.cos(TURNING * t)
    )
    model.prescribe(slider, lambda t: 0.5 * STROKE * t * t, lambda t: STROKE * t)
    shaft = model.rub((None, model.nodes[0]), FRICTION[0])
    heat = model.rub((None, slider), FRICTION[1], contact_radius=0.0).add_sensor("heat")
    model.sensors = [shaft.add_sensor("heat"), heat, shaft.add_sensor("transmitted_moment")]
    return model


# ---------------------------------------------------------------- pendulum

MASS, INERTIA, LENGTH, SWING = 2.0, 0.1, 0.4, 0.5
"""Mass in kg, inertia in kg m², distance of the centre from the pivot in m, and initial speed in rad/s."""

BEARING = 0.02 * 0.3 * MASS * GRAVITY
"""Moment in N m of a bearing of 20 mm under the weight, with a coefficient of 0.3."""


def pendulum() -> Model:
    """Return a pendulum; the sensors read position and angle, and the heat of its bearing."""
    import exudyn as exu

    model = Model()
    node, rod = model.body([0.0, -LENGTH, -0.5 * math.pi], [LENGTH * SWING, 0.0, SWING])
    mbs, items = model.mbs, model.items

    def marker(body: Any, place: float) -> Any:
        return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[place, 0.0, 0.0]))

    mbs.AddLoad(items.Force(markerNumber=marker(rod, 0.0), loadVector=[0.0, -MASS * GRAVITY, 0.0]))
    pins = [marker(mbs.AddObject(items.ObjectGround()), 0.0), marker(rod, -LENGTH)]
    mbs.AddObject(items.GenericJoint(markerNumbers=pins, constrainedAxes=[1, 1, 0, 0, 0, 0]))
    model.sensors = [model.sensor(node, exu.OutputVariableType.Coordinates)]
    model.sensors.append(model.rub(pins, BEARING).add_sensor("heat"))
    return model


def swings() -> FloatArray:
    """Return the angles (rad) where the pendulum reverses, and at last rests, from its energy."""
    angles: list[float] = []
    weight, high = MASS * GRAVITY * LENGTH, 0.0
    energy = 0.5 * (INERTIA + MASS * LENGTH**2) * SWING**2

    def left(angle: float, high: float, energy: float) -> float:
        return energy + weight * (math.cos(angle) - math.cos(high)) - BEARING * (high + angle)

    while not angles or weight * math.sin(high) > BEARING:
        high, energy = float(brentq(left, 0.0, 1.0, args=(high, energy), xtol=1e-15)), 0.0
        angles.append(high * (-1.0) ** len(angles))
    return np.array(angles)


# ---------------------------------------------------------------- the paper's pin and disc


def paper(system: System, start: Sequence[float]) -> Model:
    """Return the paper's model; the sensors read coordinates and velocities of its body."""
    from exudyn_models.paper.model import build_model

    model = Model()

    def stick(mbs: Any, *pair: Any, normal_load: float, regularisation: float, **law: Any) -> Any:
        model.mbs = mbs
        return model.rub(pair, normal_load, **law)

    built = build_model(system, np.array(start), regularisation=0.0, friction=stick)
    model.container, model.sensors = built.container, list(built.sensors[:2])
    return model
