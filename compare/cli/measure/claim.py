"""One claim of a study, to measure it by itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from compare.engines import one_of

if TYPE_CHECKING:
    from compare.claims.study import Study


def with_claim(studies: Sequence[Study], identity: str) -> Study:
    """Return the study that makes the claim ``identity``, "fig06/rests", with no other claim and no figures.

    Raises ``ValueError`` for a claim that no study declares.
    """
    found = {
        declared.identity(study.name, case): (study, declared, case)
        for study in studies
        for declared in study.declared
        for case, _ in declared.cases()
    }
    name, _, _ = identity.partition("/")
    one_of("study", name, [study.name for study in studies])
    study, declared, case = found[
        one_of("claim", identity, (one for one in found if one.startswith(f"{name}/")))
    ]
    alone = replace(declared, each={case: declared.each[case]}) if declared.each else declared
    return replace(study, prose=replace(study.prose, finding="", figures={}), declared=[alone], provided={})
