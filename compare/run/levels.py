"""Levels of a report or of pytest: time limits, and the seed of the units of motions."""

LIMITS = {"quick": 85.0, "full": 120.0}
"""Limits of processor time in s for one study of one engine, by level. The quick level has about seven studies."""

QUICK_STEPS = 850_000.0
"""Largest number of steps of an engine in one study of the quick level: 17 s at 20 µs a step.

The choice of claims follows from this number, and not from a measured time, which depends on the machine's load.
"""

QUICK_SEED = 1
"""Seed of the quick level, whose motions are mostly of 1 kg and slow in SI units."""


def seed_of(level: str, seed: int | None) -> int | None:
    """Return the given ``seed`` of the units of motions, or the default of the level "quick" or "full"."""
    return QUICK_SEED if level == "quick" and seed is None else seed
