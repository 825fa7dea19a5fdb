"""A study: statements of the paper, measurements that test engines against them, and figures."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import numpy as np

from compare.claims.claim import DOUBT, GRADES, THEORY, Basis, Claim, ErrorBudget, Grade, Kind, Verdict
from compare.claims.error_estimates import decided
from compare.claims.measured import Measured
from compare.claims.parameters import parameters_of
from compare.claims.prose import Prose, Table, slug
from compare.claims.validation import Recorded, Validation
from compare.engines import DeclaredLackError, Engine, UnsupportedSystemError
from compare.output.figures import Figure
from compare.output.outside_text import Failure, printable
from reference_model.orbits import NoOrbitError
from reference_model.systems import (
    FloatArray,
    System,
    positive_number,
    require_flag,
    require_kind,
    require_system,
)

Data = dict[str, FloatArray]

ByEngine = Mapping[str, Data]
"""Data of the figures by engine, and by "theory"."""

Figures: TypeAlias = "dict[str, Figure]"
"""Matplotlib figures by the names of their captions."""

Few = Mapping[str, Mapping[str, Any]]
Value = TypeVar("Value")
Measure = TypeVar("Measure", bound=Callable[..., "Measured | None"])


@dataclass(frozen=True, eq=False)
class Findings:
    """Results of one study for one engine: measured claims, and arrays for the figures.

    ``not_simulated`` contains the declared gaps of the engine, see ``Engine.lacking``. ``gaps`` contains, by its
    sentence, the failure of each claim that failed, or the reason why it was not measured.
    """

    claims: tuple[Claim, ...] = ()
    data: Data = field(default_factory=dict)
    not_simulated: str = ""
    gaps: dict[str, Failure | str] = field(default_factory=dict)

    def and_claim(self, sentence: str, found: Findings | Failure | str) -> Findings:
        """Return these findings with the findings of another claim, or with its gap."""
        if not isinstance(found, Findings):
            return replace(self, gaps=self.gaps | {sentence: found})
        reasons = dict.fromkeys(f"{self.not_simulated}; {found.not_simulated}".strip("; ").split("; "))
        claims = (*self.claims, *found.claims)
        return Findings(claims, self.data | found.data, "; ".join(reasons), self.gaps | found.gaps)


@dataclass(frozen=True)
class Declared:
    """All properties of a claim that do not depend on the engine.

    - ``function``: ``function(engine) -> Measured``, without an argument for the theory, or None if the claim does
      not apply to the engine. In a family it also takes a value of ``each``.
    - ``resolution``: largest total error of a conclusive agreement; None if the measurement contains it.
    - ``swept``: parameters of the system that the claim varies.
    - ``each``: names and values of the members of a family; empty for a single claim.
    - ``duration``: total duration in s of a long claim's motions, weighted for finer steps, for the quick level.

    All other fields are fields of :class:`compare.claims.claim.Claim`. In a family, braces in the sentences stand for
    the member's name.
    """

    function: Callable[..., Measured | None]
    sentence: str
    kind: Kind = "formula"
    basis: Basis = ""  # type: ignore[assignment]  # the usual one, see ``Claim``
    equation: str = ""
    unit: str = ""
    resolution: float | None = None
    note: str = ""
    implied_by: str = ""
    friction: bool = True
    named: Mapping[str, int | None] = field(default_factory=dict)
    swept: Collection[str] = ()
    each: Mapping[str, Any] = field(default_factory=dict)
    duration: float = 0.0

    @property
    def of_engine(self) -> bool:
        """True if the claim is about an engine: the first argument of its function."""
        return next(iter(inspect.signature(self.function).parameters), "") == "engine"

    @property
    def place(self) -> tuple[Path, int]:
        """File and line of the function."""
        code = inspect.unwrap(self.function).__code__
        return Path(code.co_filename), code.co_firstlineno

    def cases(self) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Yield each member of the family with additional arguments of its function."""
        if not self.each:
            yield "", ()
        for name, value in self.each.items():
            yield name, (value,)

    def sentence_of(self, case: str) -> str:
        """Return the sentence of a member of the family."""
        return self.sentence.format(case) if self.each else self.sentence

    def part(self, case: str) -> str:
        """Return the selector "function/case" of a member of the family, or "function" of a single claim."""
        return f"{self.function.__name__}/{case}" if self.each else self.function.__name__

    def identity(self, study: str, case: str) -> str:
        """Return the permanent id of the claim, such as "fig06/rests"."""
        parts = (study, self.function.__name__, case)
        return "/".join(slug(part) for part in parts if part)


PROVIDED = ("figures", "animations", "curves", "tables", "recorded", "validations")
"""Optional functions of a study."""


@dataclass(frozen=True, eq=False)
class Study:
    """One figure or group of statements, with claims declared by the decorator ``claim``.

    - ``only``: names of the engines that the study is about; empty for all.
    - ``system``, ``source``: system whose parameters repeat the measurements, and their origin.
    - ``seconds``: approximate time in s for one engine; the longest work starts first.
    - ``quick``: True for the quick level, which takes seconds and covers every kind of claim.
    - ``contact``: True if the study tests an engine's contact code. With ``Engine.contact_only``, its claims leave
      out cases that depend on other code.
    - ``declared``: claims in the order of the report.
    - ``provided``: additional functions, see ``provides``.

    Raises ``ValueError`` for an argument of another type.
    """

    name: str
    prose: Prose
    source: str = ""
    system: System | None = None
    seconds: float = 1.0
    only: tuple[str, ...] = ()
    quick: bool = False
    contact: bool = False
    declared: list[Declared] = field(default_factory=list)
    provided: dict[str, Callable[..., Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the arguments."""
        kinds: dict[str, tuple[type, ...]] = {
            "name": (str,),
            "prose": (Prose,),
            "source": (str,),
            "only": (tuple, list),
        }
        for name, allowed in kinds.items():
            require_kind(name, getattr(self, name), *allowed)
        for engine in self.only:
            require_kind("only", engine, str)
        if self.system is not None:
            require_system(self.system)
        positive_number("seconds", self.seconds, "s")
        require_flag("quick", self.quick)
        require_flag("contact", self.contact)

    @classmethod
    def beside(cls, file: str, name: str, *, words: Mapping[str, str] | None = None, **more: Any) -> Study:
        """Return the study of the module ``file`` with the texts next to it, see :meth:`Prose.of`.

        ``words`` replace their names in braces; ``more`` are fields of :class:`Study`.
        """
        return cls(name, Prose.of(Path(file), words or {}), **more)

    def provides(self, **functions: Callable[..., Any]) -> None:
        """Add functions under these names; no lambdas, because the functions are sent to other processes.

        =============== ==========================================================================================
        ``figures``     ``draw(data: ByEngine) -> Figures``; must accept missing engines
        ``animations``  ``animate(data: ByEngine) -> {name: GIF}``, see ``compare.report.animation``
        ``curves``      ``curves() -> Data``: curves of formulas for the figures
        ``tables``      ``tables() -> (Table, ...)``: additional tables for the report, not measured
        ``recorded``    ``recorded() -> (Recorded, ...)``: a separate matrix in the report; all make the same claims
                        in the same order
        ``validations`` ``validations() -> (Validation, ...)``: comparisons with measurements
        =============== ==========================================================================================

        Raises ``TypeError`` for another name.
        """
        if unknown := functions.keys() - PROVIDED:
            raise TypeError(
                f"study {self.name} cannot provide {', '.join(unknown)}: expected {', '.join(PROVIDED)}"
            )
        self.provided.update(functions)

    @property
    def title(self) -> str:
        """Title of the study."""
        return self.prose.title

    @property
    def figures(self) -> Mapping[str, str]:
        """Captions by figure; a study that draws has at least one figure, with its name and title."""
        return self.prose.figures or ({self.name: self.title} if "figures" in self.provided else {})

    def draw(self, data: ByEngine) -> Figures:
        """Return the figures by name."""
        return self._provided("figures", {}, data)

    def animate(self, data: ByEngine) -> dict[str, bytes]:
        """Return the animations (GIF) by name."""
        return self._provided("animations", {}, data)

    def tables(self) -> tuple[Table, ...]:
        """Return additional tables."""
        return self._provided("tables", ())

    def recorded(self) -> tuple[Recorded, ...]:
        """Return recorded results of engines."""
        return self._provided("recorded", ())

    def validations(self) -> tuple[Validation, ...]:
        """Return comparisons with measurements."""
        return self._provided("validations", ())

    def _provided(self, name: str, otherwise: Value, *arguments: Any) -> Value:
        found: Value = self.provided[name](*arguments) if name in self.provided else otherwise
        return found

    def claim(
        self,
        sentence: str,
        *,
        implied_by: Callable[..., Any] | None = None,
        each: Mapping[str, Any] | Sequence[str] = (),
        **more: Any,
    ) -> Callable[[Measure], Measure]:
        """Declare that the decorated function measures ``sentence``; the function is unchanged.

        The parameters and ``more`` are fields of :class:`Declared`; ``implied_by`` is the function of another claim
        of this study, and ``each`` may be a sequence of names.
        """

        def declare(function: Measure) -> Measure:
            declared = Declared(
                function,
                sentence,
                implied_by=""
                if implied_by is None
                else next(one.sentence for one in self.declared if one.function is implied_by),
                each=each if isinstance(each, Mapping) else {name: name for name in each},
                **more,
            )
            for case, _ in declared.cases():
                if (identity := declared.identity(self.name, case)) in self.identities:
                    raise ValueError(f"duplicate claim id {identity}: rename the function or the case")
            self.declared.append(declared)
            return function

        return declare

    @property
    def identities(self) -> set[str]:
        """Permanent ids of all claims."""
        return {one.identity(self.name, case) for one in self.declared for case, _ in one.cases()}

    @property
    def has_theory(self) -> bool:
        """True if claims or curves need no engine."""
        return "curves" in self.provided or any(not one.of_engine for one in self.declared)

    def measure(self, engine: Engine | None, few: Few | None = None, only: Collection[str] = ()) -> Findings:
        """Measure all claims on ``engine``, or the claims of the theory if it is None.

        ``few`` contains arguments of claims' functions by their names, to measure fewer cases. ``only`` selects
        functions by name, or members of a family by "function/case".
        """
        claims: list[Claim] = []
        data: Data = {}
        lacking: list[str] = []
        gaps: dict[str, Failure | str] = {}
        for declared in self.declared:
            name = declared.function.__name__
            if declared.of_engine != (engine is not None):
                continue
            for case, arguments in declared.cases():
                if only and not {name, declared.part(case)} & set(only):
                    continue
                try:
                    ask = partial(self._asked, declared, case, arguments, (few or {}).get(name, {}))
                    found, note = decided(
                        engine, ask, lambda it: it is not None and it[0].verdict is Verdict.INCONCLUSIVE
                    )
                except DeclaredLackError as error:
                    lacking.append(printable(error))
                    continue
                except UnsupportedSystemError as error:
                    gaps[declared.sentence_of(case)] = printable(error)
                    continue
                if found is not None:
                    claims.append(replace(found[0], note=f"{found[0].note} {note}".strip()))
                    data |= found[1]
                elif engine is not None and not (self.only or engine.contact_only):
                    gaps[declared.sentence_of(case)] = Failure("the motion does not allow this measurement")
        return Findings(tuple(claims), data, "; ".join(dict.fromkeys(lacking)), gaps)

    def measure_theory(self, few: Few | None = None, only: Collection[str] = ()) -> Findings:
        """Measure the claims of the theory, or ``only`` some; without ``only`` add the curves."""
        found = self.measure(None, few, only)
        if "curves" in self.provided and not only:
            found.data.update(_arrays(self.provided["curves"](**(few or {}).get("curves", {}))))
        return found

    def _asked(
        self,
        declared: Declared,
        case: str,
        arguments: Sequence[Any],
        few: Mapping[str, Any],
        engine: Engine | None,
    ) -> tuple[Claim, Data] | None:
        try:
            measured = declared.function(*(() if engine is None else (engine,)), *arguments, **few)
        except NoOrbitError as error:
            if engine is None:
                raise
            if error.residual < GRADES[Grade.FINE]:
                why = f"is too inaccurate for shooting, because it misses its start by {error.residual:.1e}"
                raise UnsupportedSystemError(f"{engine.name} {why}; declare its precision") from None
            raise RuntimeError(
                f"{engine.name} has no periodic motion near that of exact Coulomb friction, so this claim cannot be "
                f"measured; check its friction law and shorten its step ({str(error).partition(';')[0]})"
            ) from None
        if measured is None:
            return None
        claim = self._claim_of(declared, case, measured, engine)
        try:
            data, lost = _arrays(measured.data() if callable(measured.data) else measured.data), ""
        except Exception as error:  # a figure must not cost a verdict
            data, lost = {}, f"Not drawn, because of {type(error).__name__}: {printable(error)}."
        return replace(claim, note=" ".join(filter(None, (claim.note, claim.caution, lost)))), data

    def _claim_of(self, declared: Declared, case: str, measured: Measured, engine: Engine | None) -> Claim:
        system = measured.system or self.system
        known = {} if system is None else parameters_of(system, without=declared.swept)
        resolution = declared.resolution if measured.resolution is None else measured.resolution
        if resolution is None:
            raise ValueError(
                f"claim {declared.sentence!r}: no resolution given, neither declared nor measured"
            )
        doubt = 1.0 if engine is None else DOUBT
        claim = Claim(
            declared.sentence_of(case),
            equation=declared.equation,
            kind=declared.kind,
            engine=THEORY if engine is None else engine.name,
            predicted=np.asarray(measured.predicted),
            measured=np.asarray(measured.value),
            budget=ErrorBudget(measured.error, model=measured.model, resolution=resolution, doubt=doubt),
            parameters=known | dict(measured.parameters),
            source=measured.source or self.source,
            unit=declared.unit,
            note=" ".join(note for note in (declared.note, measured.note) if note),
            basis=declared.basis,
            implied_by=declared.implied_by.format(case) if declared.each else declared.implied_by,
            answers=measured.answers,
            friction=declared.friction and measured.friction,
            named={**declared.named, **measured.named},
            identity=declared.identity(self.name, case),
            size=None if measured.size is None else np.asarray(measured.size),
            axes=measured.axes,
        )
        return claim.strict if engine is None or engine.is_smooth else claim

    def sentences(self) -> dict[str, str]:
        """Return the sentences about engines with their selectors in ``only``."""
        of_engines = (declared for declared in self.declared if declared.of_engine)
        return {one.sentence_of(case): one.part(case) for one in of_engines for case, _ in one.cases()}

    def duration(self, part: str) -> float:
        """Return the ``duration`` in s of the claim ``part``."""
        return next(
            one.duration for one in self.declared for case, _ in one.cases() if part == one.part(case)
        )


def _arrays(data: Mapping[str, Any]) -> Data:
    return {name: np.asarray(values) for name, values in data.items()}
