"""Studies of the pin on a disc: Figs. 3 to 6 and related questions."""
