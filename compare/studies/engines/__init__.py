"""Studies of the engines themselves: single motions, balances, convergence, error estimates, scale."""
