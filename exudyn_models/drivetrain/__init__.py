"""The drivetrain around a clutch disc: parameters, a model made of public parts, and a picture."""
