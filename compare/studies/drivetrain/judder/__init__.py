"""Judder: a clutch disc that friction excites, since it falls with the slip."""

from compare.studies.drivetrain.judder.claims import STUDY as STUDY
