"""Causes that explain many deviations at once, and are named before any law of friction."""
