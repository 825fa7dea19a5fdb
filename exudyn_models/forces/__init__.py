"""Laws of friction, and the force between two objects that follows from one."""
