"""Brakes in the joints of random chains of spatial bodies, against minimal coordinates."""

import math
from functools import cache
from itertools import pairwise

import exudyn as exu
import numpy as np
import pytest
from exact_chains import Chain
from free_bodies import changes_of, items, new_model, rotations

from exudyn_models import add_ring_friction

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
NODES = [
    exu.NodeType.RotationEulerParameters,
    exu.NodeType.RotationRxyz,
    exu.NodeType.RotationRotationVector,
]
END, STEP = 0.4, 1e-3  # s


def random_chain(seed):
    """Return a chain of one to three bodies with inertia tensors and axes in any direction."""
    rng = np.random.default_rng(seed)
    count = 1 + seed % 3
    frames = [np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(count)]
    inertias = [frame @ np.diag(rng.uniform(0.4, 1.0, 3)) @ frame.T for frame in frames]
    axes = [vector / np.linalg.norm(vector) for vector in rng.normal(size=(count, 3))]
    places, centres = rng.uniform(-0.3, 0.3, (2, count, 3))
    places[0] = 0.0
    motors = [lambda t, a=a, b=b: a + b * t for a, b in rng.uniform([-3.0, -40.0], [3.0, 40.0], (count, 2))]
    slides, ratios = rng.uniform(1.0, 6.0, count), rng.uniform(1.0, 1.5, count)
    speeds = rng.choice([0.0, -1.0, 0.5], count)
    return Chain(
        rng.uniform(1.0, 4.0, count), inertias, places, axes, centres, motors, slides, ratios, speeds
    )


def add_joint(mbs, chain, k, bodies, place):
    """Add a joint with its motor and brake; return the brake's number."""
    axis = chain.axes[k]
    mbs.CreateRevoluteJoint(itemNumbers=bodies, position=place, axis=axis, useGlobalFrame=True)
    for body, sign in zip(bodies, (-1.0, 1.0), strict=True):
        mbs.CreateTorque(
            itemNumber=body,
            bodyFixed=True,
            loadVectorUserFunction=lambda mbs, t, _, sign=sign: (sign * chain.motors[k](t) * axis).tolist(),
        )
    ends = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=arm))
        for body, arm in zip(bodies, (chain.places[k], -chain.centres[k]), strict=True)
    ]
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    turned = {"master_rotation": np.column_stack([across, np.cross(axis, across), axis])}
    turned["disc_rotation"] = turned["master_rotation"]
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0, "normal_load": float(chain.slides[k])}
    ratio = chain.statics[k] / chain.slides[k]
    return int(add_ring_friction(mbs, *ends, static_ratio=ratio, **law, **turned).item)


def model_of(chain, kind):
    """Return the chain as a model, its bodies, and the numbers of its brakes."""
    mbs = new_model()
    bodies = [mbs.CreateGround()]
    start = chain.bodies(np.zeros(len(chain.speeds)), chain.speeds)
    for k, (_, centre, spin, _, _, axes, joints) in enumerate(start):
        inertia = rotations.RigidBodyInertia(mass=chain.masses[k], inertiaTensor=chain.inertias[k])
        bodies.append(
            mbs.CreateRigidBody(
                inertia=inertia,
                nodeType=kind,
                referencePosition=centre,
                initialVelocity=np.cross(axes, centre - joints).T @ chain.speeds[: k + 1],
                initialAngularVelocity=spin,
            )
        )
    pairs = enumerate(pairwise(bodies))
    brakes = [add_joint(mbs, chain, k, list(pair), start[k][-1][k]) for k, pair in pairs]
    return mbs, bodies[1:], brakes


@cache
def exact_chain(seed):
    """Return a random chain, its exact changes and its final state."""
    chain = random_chain(seed)
    return chain, *chain.motion(END)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_random_chains_change_their_modes_at_the_exact_times(solver):
    total = 0
    for seed in (3, 10, 73, 89):
        chain, exact, state = exact_chain(seed)
        mbs, bodies, brakes = model_of(chain, NODES[seed // 3 % 3])
        changes = changes_of(mbs, END, STEP, solver)
        found = sorted((time, brakes.index(item), after) for time, item, _, after in changes)
        assert [change[1:] for change in found] == [(joint, after) for _, joint, _, after in exact]
        np.testing.assert_allclose(
            [time for time, *_ in found], [time for time, *_ in exact], atol=1e-5, rtol=0.0
        )
        spins = [
            mbs.GetNodeOutput(mbs.GetObject(body)["nodeNumber"], exu.OutputVariableType.AngularVelocity)
            for body in bodies
        ]
        right = [body[2] for body in chain.bodies(*np.split(state, 2))]
        np.testing.assert_allclose(spins, right, atol=1e-4 * max(1.0, np.abs(right).max()), rtol=0.0)
        total += len(exact)
    assert total > 9


def test_the_exact_chain_conserves_energy_and_releases_a_leaning_pendulum_on_time():
    """A motor of 4·t N m about a tilted axis overcomes 1.25·2 N m at 0.625 s; without brakes energy is conserved."""
    chain = random_chain(2)
    chain.motors, chain.slides, chain.speeds = [lambda t: 0.0] * 3, np.zeros(3), np.array([1.0, -0.5, 2.0])
    _, state = chain.motion(END)

    def energy(q, v):
        return sum(
            mass * np.square(np.cross(axes, centre - joints).T @ v[: len(axes)]).sum()
            + spin @ rotation @ inertia @ rotation.T @ spin
            for mass, inertia, (rotation, centre, spin, _, _, axes, joints) in zip(
                chain.masses, chain.inertias, chain.bodies(q, v), strict=True
            )
        )

    assert energy(*np.split(state, 2)) == pytest.approx(energy(np.zeros(3), chain.speeds), rel=1e-8)
    tilted = np.array([0.0, math.sin(0.7), math.cos(0.7)])
    zero = [np.zeros(3)]
    single = Chain([1.0], [np.eye(3)], zero, [tilted], zero, [lambda t: 4.0 * t], [2.0], [1.25], [0.0])
    ((time, *modes),), _ = single.motion(1.0)
    assert modes == [0, 0, 1]
    assert time == pytest.approx(0.625, abs=1e-9)
