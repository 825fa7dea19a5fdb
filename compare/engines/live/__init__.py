"""Adapters that simulate our systems with installed foreign engines, and the names of these engines."""
