"""Runs of an Exudyn model: one call of a solver and what it is checked for, step limits, linearisation."""
