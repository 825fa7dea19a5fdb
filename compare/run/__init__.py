"""Measuring: studies and engines in processes of their own, findings kept for a resumption."""
