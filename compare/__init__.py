"""Comparison of engines with each other and with formulas: studies, claims, report and command line."""
