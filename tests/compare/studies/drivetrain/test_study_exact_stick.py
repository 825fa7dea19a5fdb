"""Claims about exact stick fail for faults in the code that sticks; ``test_every_study`` changes the friction."""

import pytest
import wrong_parts as wrong
from studies_under_test import DIFFERS, Patched
from tested_studies import EXACT_STICK

from reference_model.trajectory import SimulationError

ROW, BRAKES, LOOP = (
    f"switches/{name}"
    for name in (
        "three clutches in a row",
        "two brakes with static friction",
        "the same loop in another order",
    )
)

FAULTS = {
    "contacts release 1 % early": (wrong.static_friction_off(0.99), (ROW, BRAKES, LOOP)),
    "contacts do not share their load": (wrong.unshared_load, (BRAKES, LOOP)),
    "heat 0.1 % off": (wrong.sensed_heat_off(1.001), ("pendulum", "prescribed")),
    "friction drives a shaft": (wrong.friction_drives, ("prescribed",)),
}


def verdict_of(fault, part):
    try:
        (claim,) = EXACT_STICK.claims_of_fault(Patched(fault), (part,))
    except SimulationError:  # a report shows it as a failure
        return DIFFERS
    return claim.verdict


@pytest.mark.parametrize(("fault", "parts"), FAULTS.values(), ids=FAULTS)
def test_a_fault_in_exact_stick_fails_the_claims_that_depend_on_it(fault, parts):
    assert {part: verdict_of(fault, part) for part in parts} == dict.fromkeys(parts, DIFFERS)
