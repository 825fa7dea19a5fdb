"""``friction-discs diff``: the differences of two reports."""

from collections import Counter
from pathlib import Path
from typing import Annotated

import typer

from compare.cli.command import FINE, NOTHING_SHOWN, SOMETHING_DIFFERS, printing, refused, say

Old = Annotated[Path, typer.Argument(metavar="OLD", help="Folder or results.json of the older report.")]
New = Annotated[Path, typer.Argument(metavar="NEW", help="Folder or results.json of the newer report.")]
Baseline = Annotated[
    Path | None,
    typer.Option(
        "--baseline",
        metavar="FILE",
        help="Claims that are known to fail. Their changes are printed, but do not affect the exit status.",
        show_default=False,
    ),
]
WriteBaseline = Annotated[
    Path | None,
    typer.Option(
        "--write-baseline",
        metavar="FILE",
        help="Write the failing claims of NEW to a baseline.",
        show_default=False,
    ),
]


def diff(old: Old, new: New, baseline: Baseline = None, write_baseline: WriteBaseline = None) -> int:
    """Compare two reports.

    The command lists claims that changed by more than their error bars, are new or are missing.

    The exit status is 0 if no claim outside the baseline changed, got worse or is missing, else 1. It is 2 for bad
    input, and 3 if NEW contains no verdict for one of its engines.

    \b
    Examples:
      friction-discs diff report-of-main report
      friction-discs diff report report --write-baseline known.json
      friction-discs diff old new --baseline known.json
    """
    from compare.report.comparison import Kind, changes, failures, read_baseline, without_verdict
    from compare.report.comparison import write_baseline as write
    from compare.report.results_json import read_results

    with refused():
        before, after = read_results(old), read_results(new)
        known = read_baseline(baseline) if baseline is not None else frozenset()
    found = changes(before, after, known)
    counts = Counter(change.kind for change in found)
    failing = failures(after)
    with printing():
        for change in found:
            print(change)
        for claim, engine in sorted(known - failing.keys()):
            print(f"no longer fails: {claim} {engine}; remove it from {baseline}")
        print(", ".join(f"{counts[kind]} {kind.value}" for kind in Kind))
    if write_baseline is not None:
        write(write_baseline, failing)
    if any(change.counts for change in found):
        return SOMETHING_DIFFERS
    if empty := without_verdict(after):
        return say(f"{new} contains no verdict for {', '.join(empty)}; nothing was compared", NOTHING_SHOWN)
    return FINE
