"""Exact stick: laws of locked contacts, choice of their modes, and runs from one change to the next."""
