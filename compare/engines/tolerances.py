"""The tolerances at which engines are asked."""

USUAL_TOLERANCE = 1e-9

COARSENING = 8.0
"""Factor between the two tolerances from which an error is estimated, see ``compare.claims.error_estimates``."""
