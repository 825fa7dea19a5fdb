"""Studies of the engines: single motions, balances, convergence, error estimates and scale."""
