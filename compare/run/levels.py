"""Levels of a report or of pytest: time limits, and the seed of the units of motions."""

LIMITS = {"quick": 17.0, "full": 120.0}
"""Limits of processor time in s for one study of one engine, by level. The quick level has about seven studies."""

QUICK_SEED = 1
"""Seed of the quick level, whose motions are mostly of 1 kg and slow in SI units."""


def seed_of(level: str, seed: int | None) -> int | None:
    """Return the given ``seed`` of the units of motions, or the default of the level "quick" or "full"."""
    return QUICK_SEED if level == "quick" and seed is None else seed
