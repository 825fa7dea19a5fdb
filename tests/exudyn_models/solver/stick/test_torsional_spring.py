"""Torsional springs with backlash against an event-driven solution with small tolerances."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import changes_of, drive, new_model, rate_of, rotor
from scipy.integrate import solve_ivp

from exudyn_models import add_energy_balance, add_torsional_spring, linearise

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
STIFFNESS, BACKLASH = 20.0, 0.05  # 7.7 rad/s: the trapezoidal rule lags by (ωh)²/12 = 5e-6
FIRST, SECOND, END = 1.0, 0.5, 1.0


def moment(t):
    return 6.0 * math.sin(9.0 * t)


def exact(damping):
    """Return times (s) and modes of all changes, and the final speeds (rad/s)."""

    def flank(side, y):
        elastic = STIFFNESS * (side * (y[1] - y[0]) - BACKLASH / 2.0)
        return elastic, elastic + side * damping * (y[3] - y[2])

    time, y, mode, found = 0.0, np.zeros(4), 2, []
    while time < END:

        def rates(t, y, mode=mode):
            press = mode * flank(mode, y)[1] if mode != 2 else 0.0
            return [y[2], y[3], (moment(t) + press) / FIRST, -press / SECOND]

        def ends(t, y, mode=mode):
            return flank(mode, y)[1] if mode != 2 else -max(min(flank(side, y)) for side in (1, -1))

        ends.terminal, ends.direction = True, -1
        run = solve_ivp(rates, (time, END), y, "DOP853", events=ends, rtol=1e-12, atol=1e-13, max_step=1e-2)
        time, y = run.t[-1], run.y[:, -1]
        if run.status == 1:
            after = 2 if mode != 2 else max((1, -1), key=lambda side: flank(side, y)[0])
            found.append((time, mode, after))
            mode, time = after, time + 1e-12
    return found, y[2:]


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize("damping", [0.0, 0.5])
def test_flanks_touch_and_separate_at_the_exact_times(solver, damping):
    right, speeds = exact(damping)
    mbs = new_model()
    rotors = [rotor(mbs, inertia, 0.0) for inertia in (FIRST, SECOND)]
    spring = add_torsional_spring(mbs, *rotors, stiffness=STIFFNESS, damping=damping, backlash=BACKLASH)
    sensors = [spring.add_sensor(name) for name in ("moment", "twist", "mode")]
    drive(mbs, rotors[0], moment)
    balance = add_energy_balance(
        mbs,
        gains={"motor": lambda mbs, t: moment(t) * rate_of(mbs, rotors[0])},
        losses={"spring": spring.power},
        stored=[spring.stored_energy],
    )
    changes = changes_of(mbs, END, 1e-3, solver)
    assert [change[2:] for change in changes] == [change[1:] for change in right]
    assert len(changes) > 4
    times = [change[0] for change in changes]
    assert times == pytest.approx([change[0] for change in right], abs=1e-5)
    assert [rate_of(mbs, node) for node in rotors] == pytest.approx(speeds, abs=1e-4)
    moments, twists, modes = (mbs.GetSensorStoredData(sensor)[:, 1] for sensor in sensors)
    assert (moments[modes == 1.0] < 0.0).all()
    assert (moments[modes == 2.0] == 0.0).all()
    assert (np.abs(twists[modes != 2.0]) > BACKLASH / 2.0).all()
    with pytest.warns(RuntimeWarning, match="energy balance is off"):  # steps of 1 ms are of second order
        energy = balance()
    assert np.abs(energy.residual).max() <= 1e-4 * energy.turnover


def test_the_state_of_a_spring_has_the_stiffness_of_its_flank():
    mbs = new_model()
    node = rotor(mbs, 2.0, 0.0, 0.3)
    add_torsional_spring(mbs, None, node, stiffness=50.0, damping=2.0, backlash=0.2)
    assert linearise(mbs).stiffness == pytest.approx(np.array([[50.0]]))
    mbs.systemData.SetODE2Coordinates([0.05], exu.ConfigurationType.Current)
    assert not linearise(mbs).stiffness.any()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"backlash": 0.0}, "backlash = 0"),
        ({"stiffness": -1.0}, "stiffness = -1"),
        ({"damping": -1.0}, "damping = -1"),
    ],
)
def test_invalid_springs_are_refused(change, message):
    mbs = new_model()
    with pytest.raises(ValueError, match=message):
        add_torsional_spring(mbs, None, rotor(mbs, 1.0, 0.0), **{"stiffness": 1.0, "backlash": 0.1} | change)
