"""Definition of a fault."""

from __future__ import annotations

from dataclasses import dataclass

from compare.engines import Engine


@dataclass(frozen=True)
class Fault:
    """One mistake, and an engine with only this mistake.

    Parameters
    ----------
    name : str
        Name on the command line.
    says : str
        Description in a sentence.
    engine : Engine
        Engine of the same name.

    """

    name: str
    says: str
    engine: Engine
