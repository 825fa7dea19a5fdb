"""Exit statuses of ``report``, ``matrix`` and pytest, and the share of an engine that was measured."""

from typing import NamedTuple

FINE, SOMETHING_DIFFERS, BAD_INPUT, NOTHING_SHOWN, INTERRUPTED = 0, 1, 2, 3, 130

LEAST_SHARE = 0.5
"""Smallest share of claims or parts that must be measured before an engine counts as right."""

STATUSES = {
    FINE: "nothing differs, and at least half of the claims or parts were measured",
    SOMETHING_DIFFERS: "something differs, or an engine failed: it raised, crashed or returned nonsense",
    BAD_INPUT: "invalid input (pytest: 4)",
    NOTHING_SHOWN: "nothing differs, but less than half could be measured, or the verdict is open",
    INTERRUPTED: "interrupted by Ctrl-C or SIGTERM",
}


class Share(NamedTuple):
    """Numbers of measured claims or parts, and of all that an engine's declaration includes."""

    measured: int
    of: int

    @property
    def enough(self) -> bool:
        """True if the share is at least ``LEAST_SHARE``."""
        return self.of > 0 and self.measured >= LEAST_SHARE * self.of

    def in_words(self, noun: str) -> str:
        """Return for example "measured 61 of 90 claims (68 %)"."""
        if self.of == 0:
            return "nothing was measured, because no " + noun + " applies"
        return f"measured {self.measured} of {self.of} {noun}s ({100 * self.measured // self.of} %)"
