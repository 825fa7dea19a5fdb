"""The reduction, the theory and the simulations of measured pushes."""

import cmath
import lzma
import math

import numpy as np
import pytest

from compare.studies.plane.pushes import forward, theory
from compare.studies.plane.pushes.reduction import Push, check_table, reduce_log, reduced_pushes
from compare.studies.plane.pushes.study import GROUPS, SIMULATED, validations

SERIES = "10_90_10_10_30_130"
LOG = f"{SERIES}-exp_08_15_50.txt.xz"
TURN, SHIFT, FORCE = 0.2, 8.0 - 3.0j, 3.0 + 1.0j  # in the axes of the body halfway


def written(folder, name=LOG, spoil=lambda lines: lines):
    """Write a log of one push whose reduced values are known; return its path."""
    first, place = 2.5, 300.0 + 40.0j
    half = first + 0.5 * TURN
    last_place = place + SHIFT * cmath.exp(1j * half)
    hand, hand_angle = place + cmath.exp(1j * first) * (-2.0 + 30.0j), -0.7
    last_hand = last_place + cmath.exp(1j * (first + TURN)) * 31.0j

    def pose(at, angle, height=9.0):
        return f"{at.real} {at.imag} {height} {math.cos(angle / 2)} 0 0 {math.sin(angle / 2)}"

    in_hand = FORCE * cmath.exp(1j * (half - hand_angle))
    sensor = np.array([[1.0, 1.0], [1.0, -1.0]]) @ [in_hand.real, in_hand.imag] / -math.sqrt(2.0)
    samples = [[0.5, -0.25]] * 30 + [[0.5 + sensor[0], -0.25 + sensor[1]]] * 70
    lines = ["1", pose(place, first), pose(last_place, first + TURN, 9.5), "100"]
    lines += [f"{0.01 * i} {x} {y}" for i, (x, y) in enumerate(samples)]
    lines += ["2", f"0 {pose(hand, hand_angle)}", f"1 {pose(last_hand, hand_angle)}"]
    path = folder / name
    path.write_bytes(lzma.compress("\n".join(spoil(lines)).encode()))
    return path


def test_a_log_is_reduced_to_the_motion_and_the_force_in_the_axes_halfway(tmp_path):
    (push,) = reduce_log(written(tmp_path))
    assert (push.series, push.number, push.samples) == (SERIES, 1, 100)
    found = [complex(push.x, push.y), push.turn, complex(push.force_x, push.force_y), push.lift, push.tilt_x]
    assert found == pytest.approx([SHIFT, TURN, FORCE, 0.5, 0.0], abs=1e-9)
    assert [push.start_x, push.start_y, push.end_x, push.end_y] == pytest.approx([-2.0, 30.0, 0.0, 31.0])


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda lines: lines[:50], r"line 51: '' is not a sample of the force, 3 numbers"),
        (
            lambda lines: [*lines[:2], "1 2 3", *lines[3:]],
            r"line 3: '1 2 3' is not a pose of the body, 7 numbers",
        ),
        (
            lambda lines: [*lines[:-1], lines[-1].replace("1 ", "x ", 1)],
            r"is not a pose of the hand, 8 numbers",
        ),
        (lambda lines: ["1", *lines[1:3], "1", "0 0 0", *lines[-3:]], r"has 1 samples of the force"),
    ],
)
def test_a_log_with_another_format_is_refused_with_its_line(tmp_path, spoil, message):
    with pytest.raises(ValueError, match=message):
        reduce_log(written(tmp_path, spoil=spoil))


def test_logs_are_compared_with_the_table(tmp_path):
    with pytest.raises(ValueError, match="no logs like"):
        check_table(tmp_path)
    written(tmp_path, name="wood_" + LOG)
    agreeing, new = check_table(tmp_path)
    assert (agreeing, [push.series for push in new]) == ([], [f"wood_{SERIES}"])
    written(tmp_path)
    with pytest.raises(ValueError, match="the log has 1 pushes, the table 50"):
        check_table(tmp_path)


def obeying(push, load):
    """Return the push with the force and the place of the hand that Coulomb's law predicts."""
    wrench = theory.predicted(theory.Motion.of(push), theory.contact_of(push.series), load)
    arm = -1j * wrench.moment / wrench.force.conjugate() / theory.MM + theory.CENTRE
    changed = {
        "force_x": wrench.force.real,
        "force_y": wrench.force.imag,
        "end_x": arm.real,
        "end_y": arm.imag,
    }
    return Push(**vars(push) | changed)


@pytest.mark.parametrize("series", ["patch", "wood_30_90_30_30_30_90", SERIES])
def test_a_push_that_obeys_coulombs_law_has_no_error_and_all_laws_contain_it(series):
    push = obeying(theory.by_series()[series][3], theory.SLIDING_FORCES[theory.surface(series)])
    motion = theory.Motion.of(push)
    laws = [theory.coulomb, theory.pushed_above(0.0), theory.pressure_moved_by(0.0), theory.other_force(1.0)]
    for law in [*laws, theory.rate_dependent(0.0), theory.pressed_at_edges(0.0)]:
        assert theory.force_error(push, motion, law) == pytest.approx(0.0, abs=1e-9)
        assert theory.wrench_error(push, motion, law) == pytest.approx(0.0, abs=1e-5)
        assert theory.work_ratio(push, motion, law) == pytest.approx(1.0)


def test_shares_of_feet_follow_from_the_centre_of_mass():
    assert theory.contact_of(SERIES).shares == pytest.approx([0.25, 0.5, 0.25])
    moved = theory.contact_of(SERIES, theory.CENTRE + 4.0j)
    centre = sum(share * arm for share, arm in zip(moved.shares, moved.arms(0.0), strict=True))
    assert centre == pytest.approx(4.0j * theory.MM)


def test_errors_agree_with_the_first_look_of_the_table():
    """Median errors in degrees of an analysis by another script, with another start of the mean force."""
    expected = {"10_130_10_10_10_130": 6.3, SERIES: 4.5, "30_90_30_30_30_90": 5.3, "patch": 4.4}
    expected |= {"wood_10_130_10_10_10_130": 6.0, "wood_30_90_30_30_30_90": 8.7, "wood_patch": 6.0}
    for series, median in expected.items():
        found = theory.errors(theory.by_series()[series], theory.force_error)
        assert np.median(found) == pytest.approx(median, abs=0.5)


def test_each_push_is_validated_once():
    *directions, position = validations()
    assert sum(one.count for one in directions) == len(reduced_pushes()) == 350
    assert sorted(series for group in GROUPS.values() for series in group) == sorted(theory.by_series())
    assert position.count == sum(len(pushes[SIMULATED]) for pushes in theory.by_series().values())
    for one in (*directions, position):
        assert 0.0 < one.error_uncertainty < one.error
        assert f"{one.error:.1f} ± {one.error_uncertainty:.1f}" in one.sentence
        assert 0.0 < one.explained < 1.0


def straight(x):
    """Return a push of the patch upwards against its lower leg at ``x`` in mm, from a gap of 2 to 12 mm."""
    ends = {"start_x": x, "start_y": -2.0, "end_x": x, "end_y": 0.0}
    return Push(**vars(theory.by_series()["patch"][0]) | {"x": 0.0, "y": 10.0, "turn": 0.0} | ends)


def test_a_push_through_the_centre_of_mass_only_moves_the_body():
    position, angle = forward.QuasiStatic(straight(50.0)).motion()
    assert position == pytest.approx(0.01j, abs=1e-7)
    assert angle == pytest.approx(0.0, abs=1e-6)
    position, angle = forward.by_exudyn(straight(50.0), 1e-5)
    assert position == pytest.approx(0.01j - 4.2j / forward.STIFFNESS, abs=1e-6)
    assert angle == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("hand", [0.0, 0.3])
def test_the_hand_pushes_within_its_cone_and_the_body_follows_it(hand):
    motion = forward.QuasiStatic(straight(80.0), hand)
    slip, spin = motion._rates(0.2, 0.0j, 0.0)
    arm = motion.path.start + 0.2 * motion.path.way
    touching = slip + 1j * spin * arm
    assert touching.imag == pytest.approx(motion.path.way.imag)  # along the normal
    wrench = theory.predicted(theory.Motion(slip, spin), theory.contact_of("patch"), 1.0)
    assert wrench.moment == pytest.approx((arm.conjugate() * wrench.force).imag, abs=1e-7)
    lean = math.tan(cmath.phase(wrench.force / 1j))
    assert abs(lean) <= hand + 1e-5
    assert abs(lean) == pytest.approx(hand, abs=1e-5) or touching.real == pytest.approx(0.0, abs=1e-9)


def test_midpoint_steps_converge_with_the_second_order():
    motion = forward.QuasiStatic(straight(100.0))
    fine, *coarse = (np.array([*(m := motion.motion(steps))[:1], m[1]]) for steps in (64, 4, 8))
    errors = [abs(one - fine).max() for one in coarse]
    assert 3.0 < errors[0] / errors[1] < 5.0
