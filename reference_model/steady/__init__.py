"""Steady motions, their stability, and stability boundaries."""
