"""Two rotors and a clutch: onset of judder, heat and temperature, and energy."""

from compare.studies.drivetrain.clutch_parts.study import STUDY as STUDY
