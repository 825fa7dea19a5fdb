"""The car's drivetrain runs up from idle to 6000 turns a minute while its clutch slips under control."""

from compare.studies.drivetrain.run_up.claims import STUDY

__all__ = ["STUDY"]
