"""The command line."""

from compare.cli.app import main

__all__ = ["main"]
