"""Measurement of studies with sound engines and with deliberate faults, see ``tested_studies``."""

from __future__ import annotations

import functools
import io
from collections.abc import Callable, Mapping
from contextlib import nullcontext, redirect_stdout
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
    return Engine("changed", functools.partial(with_parameters, change), (*EVERY_KIND, "joint"))


def altered(**factors):
    """Return the reference with parameters multiplied by ``factors``."""

    def change(system):
        found = {}
        for name, factor in factors.items():
            found |= off_by(name, factor - 1.0, system)
        return found

    return with_changed(change)


def made(**make):
    """Return the plain engine with one wrong part."""
    return Engine("made", functools.partial(simulate_plainly, make=Make(**make)), EVERY_KIND)


def fault(name):
    return next(fault for fault in FAULTS if fault.name == name)


@functools.cache
def engine_named(name):
    """Return a registered engine, the independent plain one ("intact"), or a variant of the reference.

    "reference" caches its trajectories, also under other names, such as "points", which simulates nothing else;
    ``test_engines`` checks that repeated runs are equal. The reference "as reported" simulates every time.
    """
    if name == "intact":
        return SOUND[1]
    if name == "as reported":
        return engines(["reference"])[0]
    if name == "points":
        return replace(engine_named("reference"), name=name, kinds=("points",))
    (engine,) = engines([name])
    return replace(engine, function=remembering(simulate)) if name == "reference" else engine


def remembering(function):
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
    """A fault that ``put`` inserts in the code of a sound engine or of the study.

    A new ``name`` of the engine, the default, prevents the use of cached results. ``only`` restricts the claims.
    Every measurement must warn with a text that ``warns`` matches.
    """

    put: Callable[[pytest.MonkeyPatch], None]
    engine: str = "exudyn"
    name: str = ""
    only: tuple[str, ...] = ()
    warns: str = ""


COARSE, FINER = {"order": 4, "step": 0.01}, {"order": 4, "step": 0.004}
"""Fixed steps, which determine ε. Coarse steps suffice for an engine with a gross fault.

If an engine may hold a body at rest, ε is small enough to limit creep.
"""

GROSS = {
    "half the friction": altered(friction_force=0.5, friction_moment=0.5),
    "friction along the slip": made(friction=-1.0, **COARSE),
    "a box for the cone": made(sides=4, **FINER),
    "half the damping": altered(damping=0.5),
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
"""Faults of at most 1 %; those that break most claims come first."""


# ---------------------------------------------------------------- studies


@dataclass(frozen=True, eq=False)
class Tested:
    """Test settings of one study.

    - ``few``: arguments of claims and "curves" that reduce the measurement; ``few_of_faults`` replaces it for faults.
    - ``sound``: engines that must agree with every claim. A report measures this project's engines in full, so the
      tests need one, and more only for engines that a report does not contain.
    - ``parts``: claims to measure with a slow engine, functions or "function/case".
    - ``not_claimed``: functions that claim nothing about an engine.
    - ``gross``, ``small``: faults, obvious ones and ones of about 1 %, tried until every claim has failed.
    - ``blind``: claims that no small fault can break, with the reason. Claims about orders, claims with an error
      budget above 1 % and claims that count answers need no entry.
    - ``open_theory``: claims of the theory that ``few`` leaves inconclusive.
    - ``drawn``: whether ``few`` suffices for the figures.
    """

    __test__ = False  # pytest would collect the class by its name

    study: Study
    few: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    sound: tuple[str, ...] = ("reference",)
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
        """Return the findings about a sound engine or "theory", measured once."""
        with redirect_stdout(io.StringIO()) as printed:
            if name == "theory":
                findings = self.study.measure_theory(self.few)
            else:
                findings = self.study.measure(engine_named(name), self.few, self.parts.get(name, ()))
        assert printed.getvalue() == ""  # output would corrupt the progress bar
        return findings

    @functools.cache  # noqa: B019, as above
    def claims_of_fault(self, fault, only):
        few = self.few if self.few_of_faults is None else self.few_of_faults
        if isinstance(fault, Engine):
            return self.study.measure(fault, few, only).claims
        with pytest.MonkeyPatch.context() as patch:
            fault.put(patch)
            engine = replace(engine_named(fault.engine), name=fault.name or f"fault {id(fault)}")
            with pytest.warns(match=fault.warns) if fault.warns else nullcontext():
                return self.study.measure(engine, few, only).claims


def verdicts(findings):
    return {claim.sentence: claim.verdict for claim in findings.claims}


def sentences(findings, verdict):
    return {sentence for sentence, found in verdicts(findings).items() if found is verdict}


def theory_of(study, *functions, few=None):
    found = study.measure_theory(few or {}, only=functions).claims
    assert len(found) == len(functions)
    return dict(zip(functions, (claim.verdict for claim in found), strict=True))


DIFFERS, AGREES, INCONCLUSIVE = Verdict.DIFFERS, Verdict.AGREES, Verdict.INCONCLUSIVE
