"""``friction-discs sweep``: many trajectories."""

import compare.cli.sweep.shock  # noqa: F401  # registers itself
from compare.cli.sweep.commands import sweep

__all__ = ["sweep"]
