"""Explicit and implicit steps of a lane."""
