"""How studies are measured in tests: sound engines, and engines that are wrong on purpose.

A claim is worth what it fails on. ``tested_studies`` lists for each study with which faults.
"""

from __future__ import annotations

import functools
import io
from collections.abc import Callable, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from faults import FAULTS, SOUND
from faults.make import Make
from faults.plain import simulate as simulate_plainly
from faults.reference import simulate
from faults.wrong_parameters import off_by, with_parameters

from compare.claims.claim import Verdict
from compare.claims.study import Study
from compare.engines import EVERY_KIND, Engine, engines

# ---------------------------------------------------------------- engines


def with_changed(change):
    """Return the reference with the parameters that ``change`` returns for a system."""
    return Engine("changed", functools.partial(with_parameters, change), EVERY_KIND)


def altered(**factors):
    """Return the reference with parameters that are wrong by ``factors``, where a system has them."""

    def change(system):
        found = {}
        for name, factor in factors.items():
            found |= off_by(name, factor - 1.0, system)
        return found

    return with_changed(change)


def made(**make):
    """Return the plain engine with one part made wrong."""
    return Engine("made", functools.partial(simulate_plainly, make=Make(**make)), EVERY_KIND)


def fault(name):
    """Return a wrong engine of the catalogue."""
    return next(fault.engine for fault in FAULTS if fault.name == name)


@functools.cache
def engine_named(name):
    """Return a registered engine, the plain one that shares nothing ("intact"), or the reference "as reported".

    "reference" is compiled where it can be, and remembers what it has simulated, for as long as the tests run: claims
    that ask for the same motion, and engines under other names that promise less, get it once. ``test_engines`` has
    that equal runs are equal. Reports measure it plain.
    """
    if name == "intact":
        return SOUND[1]
    if name == "as reported":
        return engines(["reference"])[0]
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


# ---------------------------------------------------------------- faults


@dataclass(frozen=True)
class Patched:
    """A fault in the code that a sound engine or the study itself calls.

    Parameters
    ----------
    put : callable
        Puts the fault in by a ``MonkeyPatch``.
    engine : str
        The engine to measure with.
    name : str
        What this engine is called meanwhile: by default a new name, because nothing that is remembered for another
        one may serve it.
    only : tuple of str
        Functions of the claims that are tried with it; all by default.

    """

    put: Callable[[pytest.MonkeyPatch], None]
    engine: str = "exudyn"
    name: str = ""
    only: tuple[str, ...] = ()


COARSE, FINER = {"order": 4, "step": 0.01}, {"order": 4, "step": 0.004}
"""Fixed steps, and ε by them: coarse and quick will do for an engine that is grossly wrong.

Where it may hold a body at rest, ε is small enough for one that is held to hardly creep.
"""

GROSS = {
    "friction along the slip": made(friction=-1.0, **COARSE),
    "a box for the cone": made(sides=4, circumscribed=True, **FINER),
    "half the damping": altered(damping=0.5),
    "half the friction": altered(friction_force=0.5),
}

SMALL = {
    "friction 0.1 % off": altered(friction_force=1.001),
    "damping 0.1 % off": altered(damping=1.001),
    "offset 0.1 % off": altered(offset=1.001),
    "friction 1.5 % too weak": altered(friction_force=0.985),
    "friction 1.5 % too strong": altered(friction_force=1.015),
    "damping 1 % off": altered(damping=1.01),
    "offset 1 % off": altered(offset=1.01),
    "speed 1 % off": altered(disc_speed=1.01),
    "mass 1 % off": altered(mass=1.01),
    "inertia 1 % off": altered(polar_inertia=1.01),
}
"""Faults of a per cent and less, from those that most claims see to those that see the rest."""


# ---------------------------------------------------------------- studies


@dataclass(frozen=True, eq=False)
class Tested:
    """How one study is measured in tests.

    Parameters
    ----------
    study : Study
        The study.
    few : mapping
        Arguments of the claims' functions, and of "curves", with which less than all is measured.
    sound : tuple of str
        Engines with which every claim must agree.
    parts : mapping
        For an engine that takes long, the claims that it is asked for: functions, or "function/case".
    not_claimed : mapping
        For an engine, the functions that claim nothing of it.
    gross, small : mapping
        Faults by what is wrong, tried in this order until every claim has failed: ones that nobody should miss, and
        ones of about a per cent or less.
    few_of_faults : mapping, optional
        Takes the place of ``few`` for faults.
    blind : mapping
        Claims which no small fault can break, and why. Claims whose error budget is coarser than a per cent of what
        they predict, and those that count answers, need no entry.
    open_theory : tuple of str
        Claims of the theory that are inconclusive with so ``few`` numbers.
    drawn : bool
        Whether so ``few`` numbers are enough for the figures.

    """

    __test__ = False  # a name that pytest would collect

    study: Study
    few: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    sound: tuple[str, ...] = ("reference", "intact")
    parts: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    not_claimed: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    gross: Mapping[str, Engine | Patched] = field(default_factory=lambda: GROSS)
    small: Mapping[str, Engine | Patched] = field(default_factory=lambda: SMALL)
    few_of_faults: Mapping[str, Mapping[str, object]] | None = None
    blind: Mapping[str, str] = field(default_factory=dict)
    open_theory: tuple[str, ...] = ()
    drawn: bool = True

    @functools.cache  # noqa: B019, the table of all studies lives as long as the tests
    def found(self, name):
        """Return the findings about a sound engine, or "theory", measured once for all tests."""
        with redirect_stdout(io.StringIO()) as printed:
            if name == "theory":
                findings = self.study.measure_theory(self.few)
            else:
                findings = self.study.measure(engine_named(name), self.few, self.parts.get(name, ()))
        assert printed.getvalue() == ""  # it would spoil the progress bar
        return findings

    def claims_of_fault(self, fault, only):
        """Return the claims that are measured with a fault, for ``only`` some functions."""
        few = self.few if self.few_of_faults is None else self.few_of_faults
        if isinstance(fault, Engine):
            return self.study.measure(fault, few, only).claims
        with pytest.MonkeyPatch.context() as patch:
            fault.put(patch)
            engine = replace(engine_named(fault.engine), name=fault.name or f"fault {id(fault)}")
            return self.study.measure(engine, few, only).claims


def verdicts(findings):
    """Return the verdict of every sentence."""
    return {claim.sentence: claim.verdict for claim in findings.claims}


def sentences(findings, verdict):
    """Return the sentences with a verdict."""
    return {sentence for sentence, found in verdicts(findings).items() if found is verdict}


def theory_of(study, *functions, few=None):
    """Return the verdicts of the theory's claims that ``functions`` of a study make, by the functions' names."""
    found = study.measure_theory(few or {}, only=functions).claims
    assert len(found) == len(functions)
    return dict(zip(functions, (claim.verdict for claim in found), strict=True))


DIFFERS, AGREES, INCONCLUSIVE = Verdict.DIFFERS, Verdict.AGREES, Verdict.INCONCLUSIVE
