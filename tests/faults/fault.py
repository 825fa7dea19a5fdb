"""What a fault is."""

from __future__ import annotations

from dataclasses import dataclass

from compare.engines import Engine


@dataclass(frozen=True)
class Fault:
    """One mistake, and an engine that makes it and no other.

    Parameters
    ----------
    name : str
        As on the command line.
    says : str
        What is wrong, in a sentence.
    engine : Engine
        Of the same name.

    """

    name: str
    says: str
    engine: Engine
