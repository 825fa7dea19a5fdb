"""Studies of the disc on a disc: the paper's Figs. 8 to 11 and related questions."""
