"""Units, release and first slip of compiled pins, against the plain reference."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5
from reference_model import PinOnDisc
from reference_model.ensemble.core import laws
from reference_model.ensemble.core.nondimensional import units
from reference_model.ensemble.pin import slip as pin_slip
from reference_model.motion.nondimensional import Units
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import release_delay, slip_from_rest


def law_of(pin):
    return laws.PinLaw(pin.stiffness, pin.damping, pin.friction_force, pin.disc_speed, pin.offset, 0.03, 0.0)


@pytest.fixture
def work():
    return np.zeros((6, pin_slip.MOST_TERMS + 2), dtype=complex)


def test_units_agree_with_the_plain_reference():
    rng = np.random.default_rng(3)
    for _ in range(30):
        nonzero = rng.random(3) > 0.2
        pin = PinOnDisc(
            mass=1.0, stiffness=nonzero[0] * rng.uniform(0.1, 10.0), damping=rng.uniform(0.0, 2.0),
            friction_force=nonzero[1] * rng.uniform(0.1, 2.0), disc_speed=nonzero[2] * rng.normal(),
            offset=rng.normal(),
        )  # fmt: skip
        x, y, vx, vy = state = rng.normal(size=4)
        unit = Units.of(pin, state)
        length, rate = units(
            pin.natural_frequency, pin.damping, pin.friction_force, pin.disc_speed, pin.offset,
            float(np.hypot(x, y)), float(np.hypot(vx, vy)),
        )  # fmt: skip
        assert (length, rate) == pytest.approx((unit.length, 1.0 / unit.time), rel=1e-14)


def test_release_and_first_slip_agree_with_the_plain_reference(work):
    motion, law = SlipMotion.of(FIG5), law_of(FIG5)
    for angle in np.linspace(0.0, 6.0, 9):
        z = 0.05 * np.exp(1j * angle)
        delay = release_delay(motion, z)
        assert laws.release_delay(z, law) == pytest.approx(delay, rel=1e-12)
        z *= np.exp(1j * FIG5.disc_speed * delay)
        position, slip, duration, distance = pin_slip.begin_slip(z, law, 1e-13, 100.0, work)
        exact, exact_slip = slip_from_rest(motion, z).at(np.array([duration]))
        assert abs(position - exact[0]) < 1e-13
        assert abs(slip - exact_slip[0]) < 1e-12
        assert distance == pytest.approx(abs(slip) * duration / 3.0, rel=0.1)  # slip is of order t²


@pytest.mark.parametrize("excess", [1e-4, 3.6e-4, 1e-3])
def test_short_slip_phase_ends_when_the_plain_reference_rests(work, excess):
    pin = replace(FIG5, damping=0.85, friction_force=0.56, disc_speed=-0.46, offset=-0.07)
    motion, law = SlipMotion.of(pin), law_of(pin)
    z = laws.sticking_radius(law) * (1.0 + excess) + 0j
    z *= np.exp(1j * pin.disc_speed * release_delay(motion, z))
    _, slip, duration, _ = pin_slip.begin_slip(z, law, 1e-10, 100.0, work)
    assert slip == 0.0
    assert duration == pytest.approx(slip_from_rest(motion, z).rest, rel=1e-8)
