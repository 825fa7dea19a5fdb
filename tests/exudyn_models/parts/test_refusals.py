"""Errors for invalid arguments of all parts: the parameter, its value, and the allowed values."""

import math

import exudyn as exu
import numba
import pytest
from free_bodies import items, new_model, planar_body, rotor

from exudyn_models import (
    add_energy_balance,
    add_native_friction,
    add_radial_support,
    add_ring_friction,
    add_thermal_node,
    spring_energy,
)

LAW = {"friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
POINTS = LAW | {"contact_radius": 0.12, "contact_points": 3}
RING = add_ring_friction, POINTS
FEET = [(0.1, 0.0, 0.4), (-0.1, 0.05, 0.6)]
ANNULUS = add_ring_friction, LAW | {"inner_radius": 0.08, "outer_radius": 0.12}
NATIVE = add_native_friction, POINTS | {"reach": 1.0}
SUPPORT = add_radial_support, {"stiffness": 1.0}
UNKNOWN = object()
KINDS = "NodeRigidBody2D, NodeRigidBodyRotVecLG, NodeRigidBodyRxyz, NodeRigidBodyEP, NodePoint2D or NodePoint"
BY_NAME = "a function may take only arguments named time, radius, slip_speed, relative_spin"

WRONG = [
    (RING, {"friction_coefficient": -1.0}, "friction_coefficient = -1: it must be >= 0"),
    (RING, {"friction_coefficient": "steel"}, "= 'steel': it must be a number"),
    (RING, {"normal_load": -1.0}, "normal_load = -1 N: it must be >= 0"),
    (RING, {"contact_radius": -0.1}, "contact_radius = -0.1 m"),
    (RING, {"contact_radius": None}, "contact_radius = None: pass contact_radius, both radii of an annulus"),
    (RING, {"contact_points": 0}, "contact_points = 0"),
    (RING, {"contact_points": 2.5}, "contact_points = 2.5"),
    (
        RING,
        {"contact_points": FEET},
        "contact_radius = 0.12: it cannot be combined with a list of points",
    ),
    (RING, {"contact_radius": None, "contact_points": FEET[:1]}, "contact_points = .*: at least two points"),
    (
        RING,
        {"contact_radius": None, "contact_points": FEET, "held": 3},
        "held = 3: it must be a whole number >= 1 and <= 2",
    ),
    (RING, {"regularisation": 0.0}, "regularisation = 0 m/s"),
    (RING, {"held": 4}, "held = 4: it must be a whole number >= 1 and <= 3"),
    (RING, {"held": True}, "held = True: it must be a whole number >= 1 and <= 3"),
    (RING, {"held": 1, "contact_points": None}, "held = 1: it must be None without contact points"),
    (RING, {"static_ratio": 0.9}, "static_ratio = 0.9: static divided by sliding friction must be >= 1"),
    (RING, {"plates": 0}, "plates = 0: it must be a whole number >= 1"),
    (RING, {"friction_coefficient": [[0.0, 0.3], [1.0]]}, "in rows of equal length"),
    (RING, {"friction_coefficient": [[0.1, 0.3], [1.0, 0.2]]}, "the first at 0 m/s"),
    (RING, {"friction_coefficient": [[0.0, 0.3], [1.0, -0.2]]}, "all numbers must be >= 0"),
    (RING, {"friction_coefficient": [[0.0, 0.3], [0.0, 0.2]]}, "slip speeds must increase"),
    (RING, {"normal_load": [[0.0, 0.3], [1.0, 0.2]]}, "normal_load = .*: it must be a single number"),
    (
        RING,
        {"friction_coefficient": lambda time, speed: 1.0},
        f"friction_coefficient takes `speed`: {BY_NAME}",
    ),
    (RING, {"normal_load": lambda *arguments: 1.0}, r"takes `\*arguments`"),
    (RING, {"normal_load": lambda time, /: 1.0}, "takes `time`: .* only arguments named"),
    (RING, {"friction_coefficient": math.sin}, "friction_coefficient takes `x`"),
    (RING, {"normal_load": max}, "= <built-in function max>: it has no readable signature"),
    (
        RING,
        {"normal_load": numba.njit(lambda time: UNKNOWN.a)},
        "normal_load is a numba function that cannot be compiled",
    ),
    (RING, {"friction_coefficient": lambda temperature: 0.1}, "may take temperature with a thermal_node"),
    (RING, {"thermal_node": 3}, "thermal_node = 3: it must be a result of add_thermal_node"),
    (RING, {"pressure": "wear"}, "pressure = 'wear': it needs an annulus"),
    (ANNULUS, {"inner_radius": -0.1}, "inner_radius = -0.1 m: it must be >= 0"),
    (ANNULUS, {"outer_radius": 0.08}, "outer_radius = 0.08 m: it must be > inner_radius = 0.08 m"),
    (ANNULUS, {"contact_radius": 0.1}, "= 0.1: it cannot be combined with inner_radius"),
    (ANNULUS, {"contact_points": 6}, "= 6: it cannot be combined with inner_radius"),
    (ANNULUS, {"pressure": "even"}, "pressure = 'even': it must be 'uniform', 'wear' or a func"),
    (ANNULUS, {"pressure": lambda r: r - 0.1}, r"pressure\(0.08 m\) = -0.02: it must be >= 0"),
    (ANNULUS, {"pressure": lambda r: 0.0}, "it must be a smooth function, > 0 somewhere"),
    (ANNULUS, {"pressure": lambda r: 1.0 + (r < 0.1)}, "deviates by 0.2 of its largest share"),
    (NATIVE, {"friction_coefficient": -1.0}, "friction_coefficient = -1: it must be >= 0"),
    (NATIVE, {"normal_load": -1.0}, "normal_load = -1 N: it must be >= 0"),
    (NATIVE, {"contact_points": None}, "contact_points = None"),
    (NATIVE, {"reach": 0.0}, "reach = 0 m: it must be > 0"),
    (SUPPORT, {"stiffness": -1.0}, "stiffness = -1 N/m: it must be >= 0"),
    (SUPPORT, {"hardening": -2.0}, "hardening = -2 N/m³: it must be >= 0"),
    (SUPPORT, {"stop_gap": -0.1}, "stop_gap = -0.1 m: it must be >= 0"),
    (SUPPORT, {"stop_stiffness": math.inf}, "stop_stiffness = inf: it must be finite"),
    (SUPPORT, {"offset": {0.0: 0.1, 1.0: 0.2}}, "offset = .*: it must be a number"),
    (SUPPORT, {"offset": 0.1}, "offset = 0.1: it must be two numbers, x and y in m"),
    (SUPPORT, {"offset": (0.0, math.nan)}, r"offset\[1\] = nan: it must be finite"),
]


@pytest.mark.parametrize(("part", "change", "message"), WRONG)
def test_arguments_of_a_part_between_two_bodies(part, change, message):
    mbs, (add, right) = new_model(), part
    master, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    with pytest.raises(ValueError, match=message):
        add(mbs, master, disc, **right | change)
    add(mbs, master, disc, **right)


@pytest.mark.parametrize(
    ("add", "wrong", "message"),
    [
        (add_thermal_node, {"heat_capacity": 0.0}, "heat_capacity = 0 J/K: it must be > 0"),
        (add_thermal_node, {"conductance": -1.0}, "conductance = -1 W/K: it must be >= 0"),
        (add_thermal_node, {"surroundings": "cold"}, "surroundings = 'cold': it must be a number"),
        (add_thermal_node, {"start": math.nan}, "start = nan: it must be finite"),
        (add_energy_balance, {"gains": None}, "gains = None: it must be a Mapping"),
        (
            add_energy_balance,
            {"gains": {"a": lambda t: 0.0}},
            r"gains\['a'\] = .*: it must be a function of mbs, t",
        ),
        (add_energy_balance, {"stored": [1.0]}, r"stored\[0\] = 1.0: it must be a function of mbs"),
        (add_energy_balance, {"unit": 0.0}, r"unit = 0 J: it must be > 0"),
        (add_energy_balance, {"unit": math.nan}, r"unit = nan: it must be finite"),
        (
            add_energy_balance,
            {},
            "gains and losses are both empty: an energy balance needs at least one power",
        ),
        (
            add_energy_balance,
            {"gains": {"brake": max}, "losses": {"brake": max}},
            r"'brake' names both a gain and a loss",
        ),
    ],
)
def test_arguments_of_a_part_of_the_model(add, wrong, message):
    right = {"heat_capacity": 1.0} if add is add_thermal_node else {"gains": {}, "losses": {}}
    with pytest.raises(ValueError, match=message):
        add(new_model(), **right | wrong)
    with pytest.raises(ValueError, match="mbs = None: it must be a MainSystem"):
        add(None, **right)


PARTS = {
    "friction": (*RING, "master_node", f"Node1D, {KINDS}$"),
    "native friction": (*NATIVE, "master_node", "Node1D or NodeRigidBody2D"),
    "support": (*SUPPORT, "base_node", f"Node1D, {KINDS}$"),
}
UNKNOWN_BODIES = {
    exu.NodeIndex(7): "7 does not exist: this model has 3 nodes",
    exu.NodeIndex(): "-1 does not exist: this model has 3 nodes",
    exu.ObjectIndex(7): "7 does not exist: this model has 3 objects",
    exu.MarkerIndex(1): "1 does not exist: this model has 0 markers",
    False: "= False is of type bool: it must be a NodeIndex",
    1.5: r"= 1\.5 is of type float: it must be a NodeIndex",
    "disc": "= 'disc' is of type str: it must be a NodeIndex, the ObjectIndex of a body or",
    exu.ObjectIndex(2): "2 is an ObjectGenericODE2: it must be a body with a node",
}


@pytest.mark.parametrize("part", PARTS)
def test_nodes(part):
    add, right, master_name, kinds = PARTS[part]
    mbs = new_model()
    master, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    one = {"referenceCoordinates": [0.0], "initialCoordinates": [0.0], "initialCoordinates_t": [0.0]}
    point = mbs.AddNode(items.NodeGenericODE2(**one, numberOfODE2Coordinates=1))
    mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=[point], massMatrix=[[1.0]]))
    wrong = [(master_name, index, disc, message) for index, message in UNKNOWN_BODIES.items()]
    wrong += [("disc_node", master, index, message) for index, message in UNKNOWN_BODIES.items()]
    wrong += [(master_name, point, disc, f"2 is a NodeGenericODE2: it must be a {kinds}")]
    wrong += [
        ("disc_node", disc, same, f"1 is also the {master_name}") for same in (disc, exu.ObjectIndex(1))
    ]
    if part != "native friction":
        wrong += [("disc_node", master, None, "= None is of type NoneType")]
    for name, first, second, message in wrong:
        with pytest.raises(ValueError, match=f"^{name} {message}"):
            add(mbs, first, second, **right)


def test_objects_without_potential_energy():
    mbs = new_model()
    node, ground = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3), mbs.AddObject(items.ObjectGround())
    markers = [
        mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=ground)),
        mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)),
    ]
    springs = {"markerNumbers": markers, "stiffness": [1.0, 1.0, 0.0]}
    right = mbs.AddObject(items.CartesianSpringDamper(**springs))
    pulling = items.CartesianSpringDamper(**springs, springForceUserFunction=lambda *arguments: [0.0] * 3)
    friction = add_ring_friction(mbs, None, node, **POINTS).item
    balance = {"gains": {}, "losses": {"none": lambda mbs, t: 0.0}}
    for number in (ground, friction, mbs.AddObject(pulling)):
        message = rf"spring_energy of object {int(number)}: this \w+ has no potential energy"
        with pytest.raises(ValueError, match=message):
            add_energy_balance(mbs, **balance, stored=[spring_energy(right), spring_energy(number)])
    with pytest.raises(
        ValueError, match=r"spring_energy\(99\): it must be the ObjectIndex of an object of this"
    ):
        add_energy_balance(mbs, **balance, stored=[spring_energy(exu.ObjectIndex(99))])
    with pytest.raises(ValueError, match="connector = 99: it must be the ObjectIndex of a spring"):
        spring_energy(99)
    add_energy_balance(mbs, **balance, stored=[spring_energy(right)])


def test_names_of_sensors():
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    for part, known in (
        (add_ring_friction(mbs, None, disc, **POINTS), "transmitted_moment, .*, heat"),
        (add_radial_support(mbs, None, disc, stiffness=1.0), "deflection, force"),
    ):
        with pytest.raises(ValueError, match=f"quantity = 'warmth': it must be one of {known}"):
            part.add_sensor("warmth")
