"""Compiled force laws of friction and support, for any pair of bodies in Exudyn."""
