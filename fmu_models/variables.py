"""Tables of the units' variables, the source of the description files and the C headers.

Parameters and states of pin and disc have the names, units and bounds of ``reference_model.systems``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from reference_model.systems import (
    COLUMNS,
    LEAST,
    MOST,
    MOST_POINTS,
    PARAMETERS,
    DiscOnDisc,
    PinOnDisc,
    System,
)

MOST_PLATES = 1000


@dataclass(frozen=True)
class Variable:
    """A variable of a model.

    Parameters
    ----------
    name
        Name for importers; the value reference is the index in the table.
    unit
        One of ``description.UNITS``, or "" if dimensionless.
    about
        Description.
    role
        "time", "parameter", "state", "derivative", "input", "output", "local", or "event" for an output that changes
        only at events.
    start
        Value before initialisation; None if it follows from others.
    least, most
        Allowed range.
    type
        "real", "whole" or "boolean".
    derivative_of
        Name of the state for a derivative, otherwise "".
    scale
        Scale of a state: "x" for lengths, "v" for speeds, or "1".

    """

    name: str
    unit: str
    about: str
    role: str
    start: float | None = None
    least: float = -MOST
    most: float = MOST
    type: str = "real"
    derivative_of: str = ""
    scale: str = ""

    @property
    def settable(self) -> bool:
        """True if an importer may change its start value."""
        return self.role in ("parameter", "state", "input")


@dataclass(frozen=True)
class Model:
    """A model: name, description, C source, variables in the order of value references, and rules.

    A rule is a condition on parameters, an expression valid in both Python and C, and the message if it is violated,
    with "{name:g}" for values. The export checks it, and so does the unit at initialisation.
    """

    name: str
    about: str
    source: str
    variables: tuple[Variable, ...]
    rules: tuple[tuple[str, str], ...] = ()

    @property
    def states(self) -> tuple[Variable, ...]:
        """Continuous states."""
        return self.having("state")

    @property
    def derivatives(self) -> tuple[Variable, ...]:
        """Derivatives of the states, in the same order."""
        by_state = {one.derivative_of: one for one in self.having("derivative")}
        return tuple(by_state[one.name] for one in self.states)

    def having(self, *roles: str) -> tuple[Variable, ...]:
        """Return the variables with these roles, in table order."""
        return tuple(one for one in self.variables if one.role in roles)

    def starting(self, **values: float) -> Model:
        """Return the model with other start values; raise ``ValueError`` if one is unknown or invalid."""
        known = {one.name: one for one in self.variables if one.settable}
        for name, value in values.items():
            if name not in known:
                raise ValueError(f"{name}: it must be one of {', '.join(known)}")
            known[name] = replace(known[name], start=_checked(known[name], value))
        starts = {name: one.start for name, one in known.items()}
        for condition, sentence in self.rules:
            if not eval(condition, {"sqrt": math.sqrt, "fabs": math.fabs}, starts):
                raise ValueError(sentence.format(**starts))
        return replace(self, variables=tuple(known.get(one.name, one) for one in self.variables))


def _checked(variable: Variable, value: float) -> float:
    number = float(value)
    what = f"{variable.name} = {number:g} {variable.unit}".rstrip()
    if not variable.least <= number <= variable.most:
        raise ValueError(f"{what}: it must lie between {variable.least:g} and {variable.most:g}")
    if variable.type != "real" and number != int(number):
        raise ValueError(f"{what}: it must be a whole number")
    return number


ABOUT = {
    "mass": "mass that moves in the plane of contact",
    "stiffness": "stiffness of the radial support, the same in every direction",
    "damping": "damping of the radial support",
    "friction_force": "friction force in sliding, coefficient times normal load",
    "disc_speed": "speed of the master disc",
    "offset": "position on the x-axis where the springs are relaxed; the master disc turns about 0",
    "hardening": "stiffness that grows with the square of the deflection",
    "stop_gap": "play before the stop of the support",
    "stop_stiffness": "stiffness of the stop, 0 for none",
    "polar_inertia": "moment of inertia about the axis",
    "contact_radius": "radius of the ring of contact",
    "shaft_damping": "torsional damper between disc and shaft",
    "shaft_speed": "speed of the shaft",
    "x": "position",
    "y": "position",
    "angle": "angle of the disc",
    "vx": "velocity",
    "vy": "velocity",
    "spin": "speed of the disc",
    "heat": "heat generated by friction",
}

MEASURED_BY = {"x": "x", "y": "x", "angle": "1", "vx": "v", "vy": "v", "spin": "1", "heat": "1"}

DERIVED_UNITS = {"m": "m/s", "m/s": "m/s2", "rad": "rad/s", "rad/s": "rad/s2", "J": "W"}

REFERENCE_UNITS = {"N s/m": "N.s/m", "N/m³": "N/m3", "kg m²": "kg.m2", "N m s/rad": "N.m.s/rad"}
"""Units of the reference in the spelling recommended by the standard."""

TIME = Variable("time", "s", "time", "time")
TOLERANCE = Variable(
    "tolerance", "", "relative tolerance of the integrator in co-simulation", "parameter", 1e-11, 1e-14, 1e-2
)
REGULARISATION = Variable(
    "regularisation",
    "m/s",
    "mean slip speed below which the contact is viscous",
    "parameter",
    1e-6,
    LEAST,
)
EXACT = Variable(
    "exact",
    "",
    "true if the contact sticks by state events; otherwise it creeps below regularisation",
    "parameter",
    1.0,
    0.0,
    1.0,
    type="boolean",
)
FRICTION = (
    Variable("slip_speed", "m/s", "mean slip speed of the contact", "output"),
    Variable("friction_x", "N", "friction on the mass", "output"),
    Variable("friction_y", "N", "friction on the mass", "output"),
)


def _states(names: Sequence[tuple[str, str]], start: Sequence[float]) -> tuple[Variable, ...]:
    states = tuple(
        Variable(name, unit, ABOUT[name], "state", value, scale=MEASURED_BY[name])
        for (name, unit), value in zip(names, start, strict=True)
    )
    return states + tuple(_derivative(one) for one in states)


def _derivative(state: Variable) -> Variable:
    about = f"derivative of {state.name}"
    return Variable(
        f"der_{state.name}", DERIVED_UNITS[state.unit], about, "derivative", derivative_of=state.name
    )


def _parameters(kind: type[System], values: Sequence[float]) -> tuple[Variable, ...]:
    return tuple(
        Variable(name, REFERENCE_UNITS.get(unit, unit), ABOUT[name], "parameter", value, least)
        for (name, unit, least), value in zip(PARAMETERS[kind], values, strict=True)
    )


def _points(about: str) -> Variable:
    return Variable("contact_points", "", about, "parameter", 0.0, 0.0, MOST_POINTS, type="whole")


def _supported(kind: type[System], values: Sequence[float], start: Sequence[float]) -> tuple[Variable, ...]:
    return (
        TIME,
        *_parameters(kind, values),
        REGULARISATION,
        EXACT,
        TOLERANCE,
        *_states(COLUMNS[kind], start),
        *FRICTION,
        Variable("sticks", "", "true if the contact rests as a whole", "output", type="boolean"),
        Variable("indicator", "", "changes sign when the contact sticks or is released", "local"),
        *_stick_events(COLUMNS[kind]),
    )


def _stick_events(columns: Sequence[tuple[str, str]]) -> tuple[Variable, ...]:
    """Return the outputs of an exact contact for its last stick and release."""
    places = [(name, unit) for name, unit in columns if unit in ("m", "rad")]
    return (
        Variable("stick_count", "", "number of times the contact stuck", "event", type="whole"),
        Variable("stick_time", "s", "start of the last stick, 0 if none", "event"),
        *(Variable(f"stick_{name}", unit, f"{ABOUT[name]} at that time", "event") for name, unit in places),
        Variable("release_count", "", "number of releases of the contact", "event", type="whole"),
        Variable("release_time", "s", "time of the last release, 0 if none", "event"),
    )


PIN = Model(
    "pin",
    "A pin on springs and dampers, pressed on a disc that turns at constant speed",
    "supported.c",
    _supported(PinOnDisc, (1.0, 1.0, 0.1, 0.09, 1.5, 0.1, 0.0, 0.0, 0.0), (0.1, 0.0, 0.03, 0.0)),
)

DISC = Model(
    "disc",
    "A friction disc on springs and dampers that a ring of contact, or points on it, couples to a turning disc",
    "supported.c",
    (
        *_supported(
            DiscOnDisc,
            (1.0, 1.0, 0.5, 0.0225, 1.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.12, 0.015, 1.25),
            (0.02, 0.0, 0.0, 0.0, 0.0, 1.3),
        ),
        _points("number of contact points, at least 3, or 0 for a ring; each creeps below regularisation"),
        Variable("friction_moment", "N.m", "friction on the disc about its centre", "output"),
        Variable("resting_points", "", "number of resting points: 0, 1 or all", "event", type="whole"),
        Variable(
            "rest_count", "", "number of changes of resting_points in co-simulation", "event", type="whole"
        ),
        Variable("rest_time", "s", "time of the last change, 0 if none", "event"),
        *(
            Variable(f"rest_{name}", unit, f"{ABOUT[name]} at that time", "event")
            for name, unit in COLUMNS[DiscOnDisc]
        ),
    ),
    (
        (
            "contact_points * (contact_points - 3.0) >= 0.0",
            "contact_points = {contact_points:g}: it must be 0 for the continuous ring, or at least 3",
        ),
    ),
)


CLUTCH_SUPPORT = {
    "mass": 1.0,
    "stiffness": 1e6,
    "damping": 100.0,
    "offset": 0.0,
    "hardening": 0.0,
    "stop_gap": 0.0,
    "stop_stiffness": 0.0,
}

LINING = (
    Variable(
        "inner_radius",
        "m",
        "inner radius of the contact; for a ring, equal to the outer",
        "parameter",
        0.1,
        0.0,
    ),
    Variable("outer_radius", "m", "outer radius of the contact; 0 for a pin", "parameter", 0.1, 0.0),
    Variable(
        "wear",
        "",
        "true for the pressure of worn linings, proportional to 1/r; otherwise uniform",
        "parameter",
        0.0,
        0.0,
        1.0,
        type="boolean",
    ),
    *(
        Variable(
            f"pressure_{where}",
            "",
            f"relative pressure at the {where} radius, a factor on that of wear; a parabola in between",
            "parameter",
            1.0,
            0.0,
        )
        for where in ("inner", "mean", "outer")
    ),
    _points(
        "number of points at outer_radius, which turn with flange b and creep below regularisation; or 0"
    ),
    Variable("plates", "", "pairs of faces in contact", "parameter", 1.0, 1.0, MOST_PLATES, type="whole"),
    Variable("static_ratio", "", "ratio of static to sliding friction", "parameter", 1.0, 1.0),
)

FLANGES = (
    Variable("angle_a", "rad", "angle of flange a", "input", 0.0),
    Variable("speed_a", "rad/s", "speed of flange a", "input", 0.0),
    Variable("angle_b", "rad", "angle of flange b, with which the disc turns", "input", 0.0),
    Variable("speed_b", "rad/s", "speed of flange b", "input", 0.0),
    Variable("normal_load", "N", "force along the axis", "input", 1000.0, 0.0),
    Variable("friction_coefficient", "", "coefficient of sliding friction", "input", 0.3, 0.0),
    Variable("engagement", "", "share of the normal load that acts on the contact", "input", 1.0, 0.0, 1.0),
)

CLUTCH_OUTPUTS = (
    Variable("torque_a", "N.m", "torque on flange a about its axis", "output"),
    Variable("torque_b", "N.m", "torque on flange b", "output"),
    *FRICTION,
    Variable("radial_force_x", "N", "force of the support on the ground", "output"),
    Variable("radial_force_y", "N", "force of the support on the ground", "output"),
    Variable("heat_rate", "W", "heat flow generated by friction", "output"),
)

CLUTCH = Model(
    "clutch",
    "A dry clutch between two flanges, with the radial support of its disc",
    "clutch.c",
    (
        TIME,
        *(
            replace(one, start=CLUTCH_SUPPORT[one.name])
            for one in PIN.variables
            if one.name in CLUTCH_SUPPORT
        ),
        *LINING,
        REGULARISATION,
        TOLERANCE,
        *FLANGES,
        *_states((*COLUMNS[PinOnDisc], ("heat", "J")), (0.0, 0.0, 0.0, 0.0, 0.0)),
        *CLUTCH_OUTPUTS,
    ),
    (
        (
            "inner_radius <= outer_radius",
            "inner_radius = {inner_radius:g} m: it must be at most outer_radius = {outer_radius:g} m",
        ),
        (
            "contact_points * (outer_radius - inner_radius) <= 0.0",
            "contact_points = {contact_points:g}: points need a ring, but inner_radius = {inner_radius:g} m differs "
            "from outer_radius = {outer_radius:g} m",
        ),
        (
            "pressure_inner + pressure_mean + pressure_outer > 0.0",
            "pressure_mean = {pressure_mean:g}: one of pressure_inner, pressure_mean and pressure_outer must be > 0",
        ),
        # a parabola with values a, b, c at 0, 1/2 and 1 becomes negative in between if 4 b < (sqrt(a) - sqrt(c))^2
        (
            "2.0 * sqrt(pressure_mean) >= fabs(sqrt(pressure_inner) - sqrt(pressure_outer))",
            "pressure_mean = {pressure_mean:g}: it is too small, the parabola to pressure_inner = {pressure_inner:g} "
            "and pressure_outer = {pressure_outer:g} would be negative between the radii",
        ),
    ),
)

MODELS = {model.name: model for model in (PIN, DISC, CLUTCH)}
