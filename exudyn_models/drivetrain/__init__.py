"""The drivetrain around a clutch disc: its parameters, the model made of public parts, and a picture of it."""
