"""Laws of friction and support as compiled functions: the forces that Exudyn asks for, on any pair of bodies."""
