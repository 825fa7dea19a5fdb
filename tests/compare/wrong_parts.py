"""Tests of studies whose faults are parts of Exudyn models."""

from dataclasses import replace

import pytest
from study_harness import StudyTests, engine_named


class WrongPartTests(StudyTests):
    """Checks of what is built of Exudyn's parts: each of ``faults`` puts a wrong one in by a ``MonkeyPatch``."""

    sound = ("exudyn",)

    @classmethod
    def measured_with(cls, fault, few, only):
        """Measure while a part is wrong, under a name of its own: nothing sound is remembered for it."""
        with pytest.MonkeyPatch.context() as patch:
            cls.faults[fault](patch)
            return cls.study.measure(replace(engine_named("exudyn"), name=fault), few, only)

    def test_of_nothing_nothing_is_drawn(self):
        assert self.study.draw({}) == {}
