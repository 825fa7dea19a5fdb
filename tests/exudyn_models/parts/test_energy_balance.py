"""Where the energy of a model goes, against closed forms and with parts left out."""

import math
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import planar_body, rotor, run_explicitly, spatial_body

from exudyn_models import add_energy_balance, add_ring_friction, spring_energy

items: Any = exudyn.itemInterface

INERTIA, STIFFNESS, DAMPING, TORQUE, SPEED = 2.0, 18.0, 0.4, 3.0, 1.5
UNTIL = 2.0


def coordinate(mbs, node):
    return mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))


def driven_oscillator(unit=1.0, **left_out):
    """Return the balance of a rotor on a spring and a damper under a constant torque, after a run."""
    mbs = exu.SystemContainer().AddSystem()
    node, ground = rotor(mbs, INERTIA, SPEED), mbs.AddNode(items.NodePointGround())
    spring = mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[coordinate(mbs, ground), coordinate(mbs, node)],
            stiffness=STIFFNESS,
            damping=DAMPING,
        )
    )
    mbs.AddLoad(items.LoadCoordinate(markerNumber=coordinate(mbs, node), load=TORQUE))

    def speed(mbs):
        return float(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates_t))

    parts = {
        "gains": {"drive": lambda mbs, t: TORQUE * speed(mbs)},
        "losses": {"damper": lambda mbs, t: DAMPING * speed(mbs) ** 2},
        "stored": [spring_energy(spring)],
    }
    read = add_energy_balance(mbs, **parts | left_out, unit=unit)
    mbs.Assemble()
    run_explicitly(mbs, UNTIL, 400)
    return read()


def angle_and_speed(t):
    """Return the oscillator's motion in closed form."""
    decay, rest = DAMPING / (2.0 * INERTIA), TORQUE / STIFFNESS
    w = math.sqrt(STIFFNESS / INERTIA - decay**2)
    b = (SPEED - decay * rest) / w
    swing = np.exp(-decay * t)
    angle = rest + swing * (-rest * np.cos(w * t) + b * np.sin(w * t))
    speed = swing * ((b * w + decay * rest) * np.cos(w * t) + (rest * w - decay * b) * np.sin(w * t))
    return angle, speed


@pytest.mark.parametrize("unit", [1.0, 1e3])
def test_works_and_stored_energy_are_those_of_the_closed_form(unit):
    balance = driven_oscillator(unit)
    angle, speed = angle_and_speed(balance.times)
    stored = (INERTIA * speed**2 + STIFFNESS * angle**2) / 2.0
    put_in = TORQUE * angle
    # 400 steps of RK67 with ωh = 0.015: an error of some (ωh)⁷ = 2e-13.
    np.testing.assert_allclose(balance.stored, stored, atol=1e-12)
    np.testing.assert_allclose(balance.gains["drive"], put_in, atol=1e-12)
    np.testing.assert_allclose(balance.losses["damper"], put_in - (stored - stored[0]), atol=1e-12)
    np.testing.assert_allclose(balance.residual, 0.0, atol=1e-12)


def test_turnover_is_the_largest_of_works_and_changes_of_what_is_stored():
    balance = driven_oscillator()
    works = [balance.gains["drive"], balance.losses["damper"], balance.stored - balance.stored[0]]
    assert balance.turnover == max(np.abs(work).max() for work in works)


@pytest.mark.parametrize(
    ("part", "empty", "missing"),
    [
        ("gains", {}, lambda balance: -balance.gains["drive"]),
        ("losses", {}, lambda balance: balance.losses["damper"]),
        ("stored", [], lambda balance: STIFFNESS * angle_and_speed(balance.times)[0] ** 2 / 2.0),
    ],
)
def test_residual_is_what_has_been_left_out(part, empty, missing):
    whole, lacking = driven_oscillator(), driven_oscillator(**{part: empty})
    assert np.abs(missing(whole)).max() > 0.1
    np.testing.assert_allclose(lacking.residual, missing(whole), atol=1e-12)


@pytest.mark.parametrize("kind", [items.NodeRigidBodyRotVecLG, items.NodeRigidBodyRxyz])
def test_kinetic_energy_of_every_kind_of_body_is_counted_and_friction_takes_it(kind):
    mbs = exu.SystemContainer().AddSystem()
    mbs.AddObject(items.ObjectGround())
    bodies = [
        rotor(mbs, 0.5, 3.0),
        planar_body(mbs, 1.0, 0.08, [0.1, 0.05, 1.0], [-0.2, 0.1, -2.0]),
        spatial_body(
            mbs, kind, 1.5, [0.02, 0.02, 0.03], [0.0, 0.1, 0.0, 0.0, 0.0, 0.0], [0.3, 0.0, 0.4, 0.0, 0.0, 5.0]
        ),
    ]
    frictions = [
        add_ring_friction(
            mbs,
            bodies[0],
            disc,
            contact_radius=0.12,
            friction_coefficient=0.3,
            normal_load=1.0,
            regularisation=1e-3,
        )
        for disc in bodies[1:]
    ]
    read = add_energy_balance(
        mbs, gains={}, losses={f"friction {i}": friction.power for i, friction in enumerate(frictions)}
    )
    mbs.Assemble()
    run_explicitly(mbs, 0.4, 400)
    balance = read()
    kinetic = (0.5 * 3.0**2 + 1.0 * 0.05 + 0.08 * 2.0**2 + 1.5 * (0.3**2 + 0.4**2) + 0.03 * 5.0**2) / 2.0
    assert balance.stored[0] == pytest.approx(kinetic, rel=1e-14)
    assert balance.stored[0] - balance.stored[-1] > 0.1
    np.testing.assert_allclose(balance.residual, 0.0, atol=1e-10 * balance.turnover)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"unit": 0.0}, r"unit = 0 J: it must be > 0"),
        ({"unit": math.nan}, r"unit = nan: it must be finite"),
        ({"gains": {"brake": None}, "losses": {"brake": None}}, r"'brake' is among gains and losses"),
    ],
)
def test_what_is_no_balance_is_refused(wrong, message):
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(ValueError, match=message):
        add_energy_balance(mbs, **{"gains": {}, "losses": {}} | wrong)


@pytest.mark.parametrize("what", ["body", "ground", "joint", "friction", "spring with a function"])
def test_what_tells_no_potential_energy_is_refused_where_it_is_added(what):
    mbs = exu.SystemContainer().AddSystem()
    node, ground = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3), mbs.AddObject(items.ObjectGround())
    markers = [
        mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=ground)),
        mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)),
    ]
    springs = {"markerNumbers": markers, "stiffness": [1.0, 1.0, 0.0]}
    wrong = {
        "body": lambda: 0,
        "ground": lambda: ground,
        "joint": lambda: mbs.AddObject(
            items.ObjectJointSpherical(markerNumbers=markers, constrainedAxes=[1, 1, 0])
        ),
        "friction": lambda: (
            add_ring_friction(
                mbs,
                rotor(mbs, 1.0, 0.0),
                node,
                contact_radius=0.1,
                friction_coefficient=0.3,
                normal_load=1.0,
                regularisation=1e-3,
            ).item
        ),
        "spring with a function": lambda: mbs.AddObject(
            items.CartesianSpringDamper(**springs, springForceUserFunction=lambda *arguments: [0.0, 0.0, 0.0])
        ),
    }[what]()
    right = mbs.AddObject(items.CartesianSpringDamper(**springs))
    balance = {"gains": {}, "losses": {"none": lambda mbs, t: 0.0}}
    with pytest.raises(
        ValueError, match=rf"spring_energy of object {int(wrong)}: this \w+ tells no potential energy"
    ):
        add_energy_balance(mbs, **balance, stored=[spring_energy(right), spring_energy(wrong)])
    with pytest.raises(
        ValueError, match=r"spring_energy\(99\): it must be the ObjectIndex of an object of this"
    ):
        add_energy_balance(mbs, **balance, stored=[spring_energy(99)])
    add_energy_balance(mbs, **balance, stored=[spring_energy(right)])
