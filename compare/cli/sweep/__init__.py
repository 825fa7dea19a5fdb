"""``friction-discs sweep``: many trajectories."""

from compare.cli.door.command import Command
from compare.cli.sweep.commands import sweep
from compare.cli.sweep.shock import sweep_shock

sweep.command("shock", cls=Command)(sweep_shock)

__all__ = ["sweep"]
