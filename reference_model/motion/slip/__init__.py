"""Slip phases: coordinates, explicit and implicit steps, creep, and breakaway."""
