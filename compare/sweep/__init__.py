"""Many trajectories at once: basins of attraction, maps over two parameters, uncertain parameters."""
