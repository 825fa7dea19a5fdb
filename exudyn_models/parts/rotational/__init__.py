"""Parts between rotors on one axis: gears, one-way clutches and torsional springs."""
