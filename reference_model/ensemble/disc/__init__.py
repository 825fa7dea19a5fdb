"""The kernel of a disc."""
