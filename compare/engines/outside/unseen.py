"""Engines that consist of more than the code that Python imports."""

from __future__ import annotations

from typing import ClassVar


class Unseen:
    """An engine's function whose answers depend on what no import shows: it is always measured anew.

    ``why`` says on what, as the end of "what it depends on can't be seen: ...".
    """

    why: ClassVar[str]
