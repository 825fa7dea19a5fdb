"""Studies of the pin on a disc: the paper's Figs. 3 to 6 and what belongs to them."""
