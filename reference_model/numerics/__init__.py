"""General numerical methods, independent of friction."""
