"""Explicit steps of a lane."""
