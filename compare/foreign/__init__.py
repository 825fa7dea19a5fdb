"""Engines of other people: what each recorded, and the cases that were asked of them."""
