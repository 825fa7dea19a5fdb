"""The kernel of a pin."""
