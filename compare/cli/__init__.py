"""The command line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from compare.run.interrupts import ending_soon

if TYPE_CHECKING:
    from compare.claims.study import Study

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None, studies: tuple[Study, ...] | None = None) -> None:
    """Run the command line and exit with its status.

    ``studies`` replaces the studies of the paper in a project with its own studies and engines.
    """
    with ending_soon():  # including the imports
        from compare.cli.app import run

        run(arguments, studies)
