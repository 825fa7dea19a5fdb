"""Set-valued laws of one slip: one-way clutches, and friction that grows with the force of a constraint."""
