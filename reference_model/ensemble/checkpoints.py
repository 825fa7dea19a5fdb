"""Notes that compiled code takes of a trajectory on its way, from which :mod:`recording` finds the motion.

A note is a row of kind, time in s and state in SI units. A kernel that is given room for them takes one every so
often, at the end of a step, and wherever slip begins or ends; they stand behind the other items of the lane's page of
the book.
"""

NONE, ON_THE_WAY, SLIPS, STICKS = 0.0, 1.0, 2.0, 3.0
"""Kinds: room left over; nothing begins here; slip does; stick does."""

KIND, TIME, STATE = 0, 1, 2
"""Places in a note; the state is the rest of it."""

EVERY = 1.0
"""From note to note, in units of time: a few steps."""
