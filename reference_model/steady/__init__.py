"""Steady motions, their stability, and the curves on which it changes."""
