"""Studies of a clutch in a drivetrain, beyond the paper."""
