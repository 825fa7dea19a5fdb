"""Checks that steps resolve a model, before and during a run."""
