"""A ring thrown on a table at rest: sliding and spinning end together, in a ratio that forgets the start.

Farkas, Bartels, Unger and Wolf (2003), Frictional coupling between sliding and spinning motion, Physical Review
Letters 90, 248302, for the disc; Weidman and Malhotra (2007), On the terminal motion of sliding spinning disks with
uniform Coulomb friction, Physica D 233, for ring, disc and annulus; Goyal, Ruina and Papadopoulos (1991), Wear 143,
331, for all moments of inertia.
"""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.free_ring.claims import ratios, stops, of_theory
from compare.studies.disc.free_ring.claims.study import STUDY

__all__ = ["STUDY", "of_theory", "ratios", "stops"]
