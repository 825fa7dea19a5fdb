"""``friction-discs sweep``: many trajectories."""

from compare.cli.sweep.commands import sweep

__all__ = ["sweep"]
