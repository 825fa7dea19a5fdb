"""Exact simulation: equations of motion, slip, stick, and the way from one to the other."""
