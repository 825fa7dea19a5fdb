"""Benchmarks for ``asv``, which compares commits: ``asv run``, then ``asv publish``.

In your own environment, ``asv run --python=same --quick`` measures each number once and stores nothing.
"""
