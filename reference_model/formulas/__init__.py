"""The formulas of the paper, by its equation numbers."""
