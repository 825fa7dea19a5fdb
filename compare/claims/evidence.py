"""What kind of evidence a claim is, by what it is predicted from and which engine it is about."""

from __future__ import annotations

from compare.claims.claim import THEORY, Claim, Evidence
from compare.engines import shares_code


def evidence_of(claim: Claim) -> Evidence:
    """Return what agreement is evidence of where the claim follows from no other verdict."""
    if claim.basis != "reference":
        return claim.basis
    # What is simulated in the name of the theory is simulated by the reference.
    same = claim.engine == THEORY or shares_code(claim.engine, "reference")
    return "self-check" if same else "independent"
