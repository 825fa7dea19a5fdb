"""Measured pushes of a body on a plane."""
