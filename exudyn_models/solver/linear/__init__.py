"""Linearisation of Exudyn models."""
