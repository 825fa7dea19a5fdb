"""Coefficients and loads as numbers, tables and functions, and their evaluation in compiled code."""
