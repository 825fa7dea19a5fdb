"""Engines outside this process: programs asked by JSON, folders of computed motions, and co-simulation models."""
