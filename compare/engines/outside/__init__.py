"""Engines that are no functions of Python: programs that talk, folders of answers, and models for co-simulation."""
