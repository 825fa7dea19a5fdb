"""Studies of the engines."""
