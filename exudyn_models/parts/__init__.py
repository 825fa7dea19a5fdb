"""What goes into other people's models: friction with its sensors, Exudyn's own contact, a radial support, energy."""
