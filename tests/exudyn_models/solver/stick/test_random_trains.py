"""Random trains with contacts that stick exactly, against the exact solver of this folder."""

import exudyn as exu
import numpy as np
import pytest
from exact_trains import GROUND, Link, Signal, Train, exact_motion
from free_bodies import changes_of, drive, new_model, rate_of, rotor

from exudyn_models import add_ring_friction

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
END, STEP = 0.5, 1e-3  # s
TIMES, SPEEDS = 1e-5, 1e-4  # largest errors in s, and relative to the largest speed


def random_moment(rng):
    wave = {
        "amplitude": rng.uniform(5.0, 30.0),
        "frequency": rng.uniform(0.5, 1.5),
        "phase": rng.uniform(0.0, 6.0),
    }
    steps = ((round(rng.uniform(0.05, 0.45), 4), rng.uniform(-15.0, 15.0)),)
    ramp = {"offset": rng.uniform(-5.0, 5.0), "slope": rng.uniform(-40.0, 40.0)}
    return Signal(**[{}, wave, ramp, {"steps": steps}][rng.integers(4)])


def random_train(seed, static):
    """Return a train of 2 to 5 rotors: a chain, and contacts of any pairs, also parallel ones or to the ground."""
    rng = np.random.default_rng([seed, static])
    count = int(rng.integers(2, 6))
    pairs = [(int(rng.integers(-1, k)), k) for k in range(count)]
    pairs += [tuple(rng.choice(np.arange(GROUND, count), 2, replace=False).tolist()) for _ in range(2)]
    links = tuple(
        Link(a, b, Signal(rng.uniform(1.0, 8.0)), rng.uniform(1.0, 1.8) if static else 1.0) for a, b in pairs
    )
    speeds = rng.choice([0.0, -2.0, 1.5, 3.0], count)
    return Train(
        tuple(rng.uniform(0.3, 2.0, count)), tuple(speeds), tuple(random_moment(rng) for _ in speeds), links
    )


def locks(changes):
    """Return the link and the kind of each lock (True) and release, and their times (s)."""
    found = sorted((link, time, after == 0) for time, link, before, after in changes if 0 in (before, after))
    return [(link, lock) for link, _, lock in found], [time for _, time, _ in found]


def check(train, solver):
    exact, speeds = exact_motion(train, END)
    mbs = new_model()
    nodes = [rotor(mbs, inertia, speed) for inertia, speed in zip(train.inertias, train.speeds, strict=True)]
    for node, moment in zip(nodes, train.moments, strict=True):
        drive(mbs, node, lambda t, moment=moment: float(moment(t)))
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0}
    contacts = [
        int(
            add_ring_friction(
                mbs,
                *(None if end == GROUND else nodes[end] for end in sorted((link.a, link.b))),
                normal_load=float(link.capacity(0.0)),
                static_ratio=link.static_ratio,
                **law,
            ).item
        )
        for link in train.links
    ]
    changes = changes_of(mbs, END, STEP, solver, breaks=train.breaks())
    kinds, times = locks([(time, contacts.index(item), *modes) for time, item, *modes in changes])
    right_kinds, right_times = locks(
        [(change.time, change.link, change.before, change.after) for change in exact]
    )
    assert kinds == right_kinds
    np.testing.assert_allclose(times, right_times, atol=TIMES, rtol=0.0)
    found = [rate_of(mbs, node) for node in nodes]
    np.testing.assert_allclose(found, speeds, atol=SPEEDS * max(1.0, np.abs(speeds).max()), rtol=0.0)
    return len(exact)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_random_trains_without_static_friction_change_their_modes_at_the_exact_times(solver):
    assert sum(check(random_train(seed, static=False), solver) for seed in (0, 2, 4, 7)) > 20


@pytest.mark.parametrize("solver", IMPLICIT)
def test_random_trains_with_static_friction_change_their_modes_at_the_exact_times(solver):
    """Some have parallel contacts, or a contact that holds only because another one slips."""
    assert sum(check(random_train(seed, static=True), solver) for seed in (0, 1, 4, 33, 37, 43)) > 40


@pytest.mark.parametrize("solver", IMPLICIT)
def test_redundant_contacts_at_rest_report_no_changes(solver):
    check(random_train(5, static=False), solver)
