"""Studies of a clutch in a drivetrain, which no formula of the paper covers."""
