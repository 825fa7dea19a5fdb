"""Engines compared with each other and with every formula: studies, claims, report, command line."""
