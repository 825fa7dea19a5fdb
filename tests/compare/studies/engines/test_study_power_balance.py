"""The study of power: which motions it takes, and over which time."""

from dataclasses import replace

from faults.reference import simulate
from studies_under_test import (
    engine_named,
    verdicts,
)
from tested_studies import POWER_BALANCE

from compare.engines import EVERY_KIND, Engine
from compare.studies.engines import power_balance as study
from compare.studies.engines.power_balance import (
    motions_of_the_disc,
    motions_of_the_pin,
)

_, _, _, STICKS, *_ = motions_of_the_pin()
*_, SIX_TO_REST = motions_of_the_disc()


def test_an_engine_of_which_only_the_contact_is_its_own_is_measured_where_that_alone_acts():
    engine = Engine("mine", simulate, EVERY_KIND, contact_only=True)
    found = study.STUDY.measure(engine, POWER_BALANCE.few)
    assert set(verdicts(found)) == {study.SENTENCE.format(SIX_TO_REST)}
    assert not found.not_simulated


def test_the_budget_takes_every_second_sample_over_the_same_time():
    """An odd number of intervals would leave out the last sample, and the error would be of another motion."""
    for until in (2.5, 2.0, 0.04, 0.1):
        motion = replace(motions_of_the_pin()[STICKS], until=until)
        trajectory = study._run(engine_named("reference"), motion, 1e-10)
        assert study._every_second(trajectory).times[-1] == trajectory.times[-1]
