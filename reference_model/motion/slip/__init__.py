"""Slip: its coordinates, steps of it, creep and stiff motions, and how it begins."""
