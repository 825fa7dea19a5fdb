"""A clutch that warms up: heat into a temperature, and friction that fades with it."""

from compare.studies.drivetrain.warm_clutch.claims import STUDY as STUDY
