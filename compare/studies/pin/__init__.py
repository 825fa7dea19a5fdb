"""Studies of the pin on a disc: Figs. 3 to 6 of the paper and related questions."""
