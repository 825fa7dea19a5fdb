"""Studies of the disc on a disc: Figs. 8 to 11 and related questions."""
