"""Engine, clutch and car: the drivetrain around a clutch disc, and its picture."""
