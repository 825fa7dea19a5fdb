"""Models of the pin and the disc, built from bodies, support and friction."""
