"""Explicit and implicit steps of a lane, and the motion within a step."""
