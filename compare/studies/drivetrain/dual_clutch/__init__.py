"""A gear change of a dual clutch: two contacts hand over the torque."""

from compare.studies.drivetrain.dual_clutch.claims import STUDY as STUDY
