"""A step of a lane: explicit or by collocation, and the motion inside of it."""
