"""Running an Exudyn model: its steps, its limits, and an end that is told."""
