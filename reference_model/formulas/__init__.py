"""The formulas of the paper, by equation number."""
