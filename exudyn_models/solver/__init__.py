"""Runs of an Exudyn model: solver calls with checks, step limits, and linearisation."""
