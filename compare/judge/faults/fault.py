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
    changes_physics : bool
        Whether any motion can tell; otherwise ``why_not_caught`` says why not.

    """

    name: str
    says: str
    engine: Engine
    changes_physics: bool = True
    why_not_caught: str = ""
