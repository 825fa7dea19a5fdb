"""``friction-discs sweep``: sweeps over initial states and parameters."""

from compare.cli.command import Command
from compare.cli.sweep.commands import sweep, sweep_shock

sweep.command("shock", cls=Command)(sweep_shock)

__all__ = ["sweep"]
