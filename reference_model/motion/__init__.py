"""Event-driven simulation of slip and stick."""
