"""The pin and the disc, built of bodies, support and friction."""
