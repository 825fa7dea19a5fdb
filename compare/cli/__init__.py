"""The command line."""

from compare.cli.commands import main

__all__ = ["main"]
