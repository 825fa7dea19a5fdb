"""Exact stick: laws of locked contacts, the switching of their modes, and runs from one change to the next."""
