from dataclasses import replace

from studies_under_test import engine_named

from compare.studies.engines import power_balance as study
from compare.studies.engines.power_balance import motions_of_the_pin

_, _, _, STICKS, *_ = motions_of_the_pin()


def test_every_second_sample_covers_the_same_time():
    """With an odd number of intervals, the last sample would be missing."""
    for until in (2.5, 2.0, 0.04, 0.1):
        motion = replace(motions_of_the_pin()[STICKS], until=until)
        trajectory = study._run(engine_named("reference"), motion, 1e-10)
        assert study._every_second(trajectory).times[-1] == trajectory.times[-1]
