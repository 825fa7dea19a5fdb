"""Tests of studies whose claims come in families, and of those whose faults are parts of Exudyn models."""

import functools
from dataclasses import replace

import pytest
from study_harness import StudyTests, engine_named


class FamilyTests(StudyTests):
    """As ``StudyTests``, but a column may name one of a family, as "moves/Fig. 8": only that is measured."""

    @classmethod
    def claims_of_fault(cls, fault, claim):
        """Return what is claimed of an engine with a fault, in a column."""
        return _claims_of_fault(cls, fault, claim)

    @classmethod
    def measured_with(cls, fault, study, few):
        """Measure ``study``, a part of the one under test, with a fault."""
        return study.measure(cls.faults[fault], few)


class WrongPartTests(FamilyTests):
    """Checks of what is built of Exudyn's parts: each of ``faults`` puts a wrong one in by a ``MonkeyPatch``."""

    sound = ("exudyn",)

    @classmethod
    def measured_with(cls, fault, study, few):
        """Measure ``study`` while a part is wrong, under a name of its own: nothing sound is remembered for it."""
        with pytest.MonkeyPatch.context() as patch:
            cls.faults[fault](patch)
            return study.measure(replace(engine_named("exudyn"), name=fault), few)

    def test_of_nothing_nothing_is_drawn(self):
        assert self.study.draw({}) == {}


@functools.cache
def _claims_of_fault(cls, fault, claim):
    function, _, case = claim.partition("/")
    declared = [
        replace(one, each={case: one.each[case]}) if case else one
        for one in cls.study.declared
        if one.function.__name__ == function and (not case or case in one.each)
    ]
    few = cls.few if cls.few_of_faults is None else cls.few_of_faults
    return cls.measured_with(fault, replace(cls.study, declared=declared), few).claims
