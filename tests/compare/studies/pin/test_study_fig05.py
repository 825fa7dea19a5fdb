import functools
import io
import itertools
import math
from dataclasses import replace

import numpy as np
import PIL.Image
import PIL.ImageSequence
import pytest
from faults.reference import simulate
from studies_under_test import GROSS, engine_named

from compare.claims.claim import Verdict
from compare.claims.parameters import FIG5_STARTS
from compare.engines import Engine
from compare.studies.pin.fig05 import study
from compare.studies.pin.fig05.pictures import animate
from compare.studies.pin.fig05.study import STUDY


def never_released(system, initial_state, times, *, tolerance=1e-9):
    """Let the pin turn with the disc from its first stick phase on."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    if not trajectory.stick_phases:
        return trajectory
    first = trajectory.stick_phases[0]
    stuck = trajectory.times >= first.start
    z = complex(*first.initial_state[:2]) * np.exp(
        1j * system.disc_speed * (trajectory.times[stuck] - first.start)
    )
    v = 1j * system.disc_speed * z
    states = trajectory.states.copy()
    states[stuck] = np.column_stack((z.real, z.imag, v.real, v.imag))
    before = trajectory.phases[: trajectory.phases.index(first)]
    return replace(trajectory, states=states, phases=(*before, replace(first, end=float(times[-1]))))


@pytest.mark.parametrize(("shift", "verdict"), [(5e-8, Verdict.AGREES), (2e-7, Verdict.DIFFERS)])
def test_stick_times_without_change_may_deviate_by_1e_5_of_the_resolution(shift, verdict):
    @functools.cache
    def exact():
        return simulate(study.FIG5, FIG5_STARTS["equilibrium"], [0.0, study.UNTIL])

    def late(*_, tolerance):
        """Return the same phases at all tolerances, as if the change were zero by chance."""
        starts = [one.start + shift if one.start > 0.0 else 0.0 for one in exact().phases]
        ends = [*starts[1:], study.UNTIL]
        moved = zip(exact().phases, starts, ends, strict=True)
        return replace(exact(), phases=tuple(replace(one, start=start, end=end) for one, start, end in moved))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "SAMPLES", 2)
        (claim,) = STUDY.measure(Engine("late", late), only=("all_sticks/equilibrium",)).claims
    assert claim.verdict is verdict


@pytest.fixture(scope="module")
def right():
    return STUDY.measure(engine_named("reference"), only=("all_sticks",)).data


def test_an_engine_that_sticks_too_often_is_drawn_without_errors_of_times(right):
    more = {f"{name}: sticks": np.append(right[f"{name}: sticks"], [90.0, 91.0]) for name in FIG5_STARTS}
    (figure,) = STUDY.draw({"reference": right, "exudyn": right, "broken": right | more}).values()
    labels = [line.get_label() for line in figure.axes[3].lines]
    assert labels.count("exudyn") == 1
    assert "broken" not in labels


def test_the_animation_is_a_gif_of_frames_that_move(right):
    (content,) = animate({"reference": right}, until=4.0).values()
    with PIL.Image.open(io.BytesIO(content)) as picture:
        assert (picture.format, picture.n_frames, picture.info["loop"]) == ("GIF", 11, 0)
        frames = [
            np.asarray(frame.convert("RGB"), dtype=int) for frame in PIL.ImageSequence.Iterator(picture)
        ]
    assert min(np.abs(after - before).max() for before, after in itertools.pairwise(frames)) > 50
    assert animate({}) == {}


@pytest.mark.parametrize("count", [-1, 1])
def test_a_missing_or_additional_stick_phase_differs(count):
    def simulated(system, initial_state, times, *, tolerance=1e-9):
        trajectory = simulate(system, initial_state, times, tolerance=tolerance)
        *phases, last_stick, last = trajectory.phases
        if count > 0:
            middle = (last.start + last.end) / 2.0
            last, more = replace(last, end=middle), replace(last, kind="stick", start=middle)
            return replace(trajectory, phases=(*phases, last_stick, last, more))
        return replace(trajectory, phases=(*phases, last))

    found = STUDY.measure(Engine("miscounting", simulated), only=("all_sticks",)).claims
    assert [claim.verdict for claim in found] == [Verdict.DIFFERS] * len(FIG5_STARTS)


def test_the_critical_velocity_is_nan_without_enough_stick_phases():
    assert math.isnan(study.critical_velocity(Engine("stick never ends", never_released), 1e-8))
    assert math.isnan(study.critical_velocity(GROSS["friction along the slip"], 1e-6))


@pytest.mark.parametrize("name", FIG5_STARTS)
def test_first_stick_and_release_by_a_plain_event_agree_with_the_reference(name):
    """Compare an event on the slip of (1), followed by (7), with the reference's slip-polar coordinates."""
    times = study.first_stick_and_release(name, 4e-13)
    assert times == pytest.approx(study.reference_events(name)[:2], abs=1e-10)
