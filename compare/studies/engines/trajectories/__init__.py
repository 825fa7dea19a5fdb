"""Plain motions: state by state beside the reference, and whether velocities and forces add up along them."""

from compare.studies.engines.trajectories.claims import STUDY

__all__ = ["STUDY"]
