"""Computation of a sweep: chunks of work, executors and results."""
