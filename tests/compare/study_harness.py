"""What every study is tested for: the test of a study subclasses ``StudyTests`` and says with what."""

import functools
import io
from contextlib import redirect_stdout
from dataclasses import replace

import numpy as np
from faults import SOUND
from faults.reference import simulate

from compare.claims.claim import Verdict
from compare.engines import engines

SEES, BLIND, OPEN = Verdict.DIFFERS, Verdict.AGREES, Verdict.INCONCLUSIVE
LEFT_OUT = None
"""In a table: measuring it takes too long."""


@functools.cache
def engine_named(name):
    """Return a registered engine, or the plain one that shares nothing ("intact").

    The reference is compiled where it can be; every report measures the plain one. It remembers what it has
    simulated, for as long as the tests run: claims that ask for the same motion, and engines under other names that
    promise less, get it once. ``test_engines`` has that equal runs are equal.
    """
    if name == "intact":
        return SOUND[1]
    (engine,) = engines([name])
    return replace(engine, function=remembering(simulate)) if name == "reference" else engine


def remembering(function):
    """Return an engine's ``function`` with a store of its trajectories."""
    store = {}

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        start, at = (np.asarray(values, dtype=float).tobytes() for values in (initial_state, times))
        key = (system, start, at, tolerance)
        if key not in store:
            store[key] = function(system, initial_state, times, tolerance=tolerance)
        return store[key]

    return simulated


@functools.cache
def findings_of(study, engine, sound_few, only=()):
    """Measure a part of ``study`` with a sound engine, or its theory if there is none, once for all tests."""
    few = {function: dict(options) for function, options in sound_few}
    with redirect_stdout(io.StringIO()) as printed:
        found = study.measure(engine, few, only) if engine else study.measure_theory(few)
    assert printed.getvalue() == ""  # or it stands across the progress bar
    return found


class StudyTests:
    """Checks of one study.

    ``study`` is it; ``engine_named`` finds its sound engines; ``few`` are the arguments, by the functions of its
    claims and for "curves", with which less than all is measured; ``sound`` are engines of which every claim must
    agree, and ``not_claimed`` the functions that claim nothing of one of them. Of an engine that takes long
    ``parts`` names what alone is asked: functions, or "function/case".

    ``faults`` are broken engines, ``columns`` functions of claims, or "function/case" for one of a family, and
    ``table`` says for each fault which of them see it: SEES, BLIND, OPEN, LEFT_OUT, a part of the message of an
    error, or a tuple of what may be; of a family that holds for every member. ``few_of_faults`` take the place of
    ``few`` there.
    """

    study = None
    engine_named = staticmethod(engine_named)
    few = {}
    sound = ("reference", "intact")
    not_claimed = {}
    parts = {}
    faults = {}
    few_of_faults = None
    columns = ()
    table = {}

    def pytest_generate_tests(self, metafunc):
        cls = metafunc.cls
        if "sound_engine" in metafunc.fixturenames:
            metafunc.parametrize("sound_engine", cls.sound)
        if "expected" in metafunc.fixturenames:
            cells = [
                (fault, claim, expected)
                for fault, row in cls.table.items()
                for claim, expected in zip(cls.columns, row, strict=True)
                if expected is not LEFT_OUT
            ]
            ids = [f"{fault}-{claim}" for fault, claim, _ in cells]
            metafunc.parametrize(("fault", "claim", "expected"), cells, ids=ids)

    @classmethod
    def found(cls, name):
        """Return the findings about a sound engine, or "theory"."""
        few = tuple((function, tuple(options.items())) for function, options in cls.few.items())
        engine = None if name == "theory" else cls.engine_named(name)
        return findings_of(cls.study, engine, few, cls.parts.get(name, ()))

    @classmethod
    def claims_of_fault(cls, fault, claim):
        """Return what is claimed of an engine with a fault, in a column; measured once."""
        return _claims_of_fault(cls, fault, claim)

    @classmethod
    def measured_with(cls, fault, few, only):
        """Measure a part of the study with a fault."""
        return cls.study.measure(cls.faults[fault], few, only)

    def test_every_claim_holds_in_a_sound_engine(self, sound_engine):
        parts, not_claimed = (of.get(sound_engine, ()) for of in (self.parts, self.not_claimed))
        declared = [
            one.sentence_of(case)
            for one in self.study.declared
            if one.of_engine and (name := one.function.__name__) not in not_claimed
            for case, _ in one.cases()
            if not parts or name in parts or f"{name}/{case}" in parts
        ]
        found = {claim.sentence: claim.verdict for claim in self.found(sound_engine).claims}
        assert found == dict.fromkeys(declared, Verdict.AGREES)

    def test_the_theory_holds(self):
        claims = self.found("theory").claims
        assert len(claims) == sum(not one.of_engine for one in self.study.declared for _ in one.cases())
        assert {claim.verdict for claim in claims} <= {Verdict.AGREES}

    def test_each_claim_sees_the_faults_that_concern_it(self, fault, claim, expected):
        allowed = expected if isinstance(expected, tuple) else (expected,)
        try:
            claims = self.claims_of_fault(fault, claim)
        except Exception as error:
            if not any(isinstance(one, str) and one in str(error) for one in allowed):
                raise
            return
        verdicts = {claim.verdict for claim in claims}
        assert verdicts
        assert verdicts <= set(allowed)

    def test_figures_are_drawn_whatever_is_there(self):
        data = {name: self.found(name).data for name in (*self.sound[:1], "theory")}
        engine, theory = self.sound[0], {"theory": data["theory"]}
        alone = {engine: data[engine]}
        everything = alone | theory | {"exudyn": data[engine]}
        for case in (theory, alone | theory, alone, everything):
            present = {name: values for name, values in case.items() if values}
            if not present:
                continue
            figures = self.study.draw(present)
            assert set(figures) <= set(self.study.figures)
            if case is everything:
                for figure in figures.values():
                    figure.set_layout_engine("none")  # tests of reports and of saved figures lay out
                    figure.draw_without_rendering()  # all but the pixels, a quarter of the time
        assert set(self.study.figures) >= set(figures) > set() or not self.study.figures


@functools.cache
def _claims_of_fault(cls, fault, claim):
    few = cls.few if cls.few_of_faults is None else cls.few_of_faults
    return cls.measured_with(fault, few, (claim,)).claims
