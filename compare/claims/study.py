"""A study: what the paper says, how an engine is measured against it, and how the result is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from compare.claims.claim import Claim
from compare.engines import Engine
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Data = dict[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Findings:
    """What one study found for one engine.

    Parameters
    ----------
    claims : tuple of Claim
        Those that could be measured.
    data : dict
        Arrays that the figures are drawn from.
    not_simulated : str
        Why claims are missing that other engines have, in a sentence, see ``Engine.lacking``; "" if none is.

    """

    claims: tuple[Claim, ...] = ()
    data: Data = field(default_factory=dict)
    not_simulated: str = ""


@dataclass(frozen=True)
class Table:
    """Words and numbers in rows as long as ``header``, under a ``caption``."""

    caption: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Recorded:
    """What was found of one setting of an engine when that was recorded: no part of a run.

    Parameters
    ----------
    engine, setting : str
        "" for the setting of an engine that has one only.
    version, date : str
        Of the engine, and when it was recorded.
    claims : tuple of Claim
        A finding about that engine, whatever the verdict.

    """

    engine: str
    setting: str
    version: str
    date: str
    claims: tuple[Claim, ...]


@dataclass(frozen=True)
class Study:
    """One figure or group of statements.

    Parameters
    ----------
    name : str
        As on the command line: "fig03".
    title : str
        A line.
    paper : str
        What the paper says, in a paragraph.
    measure : callable
        ``measure(engine) -> Findings``; called once for each engine, in a process of its own. Where it
        simulates what the engine does not promise, nothing is found, and the report says so.
    draw : callable
        ``draw(data) -> {figure name: matplotlib Figure}``, where ``data`` maps engine names (those that
        found any, and "theory") to the ``Findings.data`` of each; must cope with a missing engine.
    theory : callable, optional
        ``theory() -> Findings``: statements in which no simulation takes part, and curves of formulas.
    figures : dict
        Caption for each figure and animation name.
    only : tuple of str
        Names of the engines that the study is about; empty for all.
    animations : callable, optional
        ``animations(data) -> {name: GIF}``, ``data`` as in ``draw``; see ``compare.report.animation``.
    section : str
        Heading under which the overview lists the study, with its neighbours of the same section.
    finding : str
        What the paper leaves open and the study answers, in a sentence or two for the first screen; shown
        while all claims of the study agree.
    seconds : float
        About how long an engine takes: the longest work starts first, which keeps all cores busy to the end.
    tables : callable, optional
        ``tables() -> (Table, ...)``: what the report shows besides claims and figures, none of it measured.
    recorded : callable, optional
        ``recorded() -> (Recorded, ...)``: a matrix of its own in the report, counted apart. All make the same
        claims, in the same order.
    quick : bool
        Whether the study belongs to the quick level: seconds for an engine, and something of every kind of claim.
    contact : bool
        Whether an engine's code of contact decides in it, see ``Engine.contact_only``. Where other parts decide
        too, ``measure`` leaves those out for an engine of which that is true.

    The callables are functions of a module (no lambdas), because they are sent to other processes.

    """

    name: str
    title: str
    paper: str
    measure: Callable[[Engine], Findings]
    draw: Callable[[Mapping[str, Data]], dict[str, Figure]]
    theory: Callable[[], Findings] | None = None
    figures: Mapping[str, str] = field(default_factory=dict)
    only: tuple[str, ...] = ()
    animations: Callable[[Mapping[str, Data]], dict[str, bytes]] | None = None
    section: str = ""
    finding: str = ""
    seconds: float = 1.0
    tables: Callable[[], tuple[Table, ...]] | None = None
    recorded: Callable[[], tuple[Recorded, ...]] | None = None
    quick: bool = False
    contact: bool = False
