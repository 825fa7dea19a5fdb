"""Engines of other people, live: adapters that simulate our systems with them, and their names when installed."""
