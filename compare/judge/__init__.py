"""The judge of the judges: engines with one mistake each, and which claims notice it."""
