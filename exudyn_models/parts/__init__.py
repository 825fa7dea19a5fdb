"""What goes into other people's models: friction of a ring, its sensors, radial support, energy."""
