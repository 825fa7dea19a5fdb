"""Commands that measure engines."""
