"""``friction-discs list | errata``: what there is, without measuring anything."""

from __future__ import annotations

import typer

from compare.cli.options import studies_of


def list_studies(context: typer.Context) -> None:
    """List the studies and the engines.

    \b
    Example:
      friction-discs list
    """
    from compare.engines import engines, on_request

    studies = studies_of(context, [])
    width = max((len(study.name) for study in studies), default=0)
    usual, others = (", ".join(engine.name for engine in some) for some in (engines(), on_request()))
    print("Studies:")
    for study in studies:
        print(f"  {study.name:{width}}  {study.title}")
    print(f"Engines: {usual}; on request {others}")


def errata() -> None:
    """Print where the paper's formulas are wrong, their corrections, and the numbers that show it.

    \b
    Example:
      friction-discs errata
    """
    from compare.claims.errata import ERRATA
    from compare.report.numbers import error_text, value_text

    for erratum in ERRATA:
        evidence = erratum.evidence()
        nearest = abs(evidence.corrected_value - evidence.exact)
        print(erratum.heading)
        print(f"  printed    {erratum.printed}")
        print(f"  correct    {erratum.correct}")
        print(f"  {erratum.explanation}")
        print(f"  {evidence.quantity}: exact {value_text(evidence.exact, nearest)}")
        for name, value in (("printed", evidence.printed_value), ("corrected", evidence.corrected_value)):
            print(
                f"    {name:9}  {value_text(value, nearest)}, error {error_text(abs(value - evidence.exact))}"
            )
        print()
