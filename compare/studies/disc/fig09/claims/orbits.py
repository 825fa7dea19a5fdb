"""Whirls with an offset, which are periodic orbits, and how the offset shifts and changes them."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.claims.error_estimates import TIGHTEST, Measurement, refined
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.fig09.claims.searches import extrapolated, with_tolerance
from compare.studies.disc.fig09.claims.study import STUDY
from compare.studies.disc.fig09.theory import (
    HALVED_OFFSETS,
    OFFSET_LOAD,
    ORBIT_TOLERANCE,
    ORBITS,
    RING,
    circle_of,
    extent,
    first_order_shift,
    orbit_of_reference,
)
from compare.studies.toolkit.self_centred import with_load
from reference_model import Orbit, whirl_orbit
from reference_model.systems import FloatArray

EXTRAPOLATED = (
    f"X0 = {', '.join(f'{offset:g}' for offset in HALVED_OFFSETS)} m, extrapolated; model error: the extrapolation's "
    "own step."
)


@STUDY.claim(
    "With the offset the whirls, stable or not, are the periodic orbits of exact Coulomb friction",
    equation="(19), (20)",
    kind="trajectory",
    unit="s, m, rad/s",
    resolution=1e-6,
    note="The second of the two at the same μN is the unstable one. Found by shooting with the engine; predicted: "
    f"the reference at tolerance {TIGHTEST:g}.",
    swept=("friction_force",),
)
def orbits(engine: Engine, whirls: Sequence[tuple[float, int]] = ORBITS) -> Measured:
    """Compare the engine's periodic orbits, by μN in N and number, with those of the reference."""
    exact = [orbit_of_reference(*one) for one in whirls]
    predicted = np.array([sizes_of(orbit) for orbit in exact])
    found = refined(
        lambda tolerance: [sizes_of(orbit_of(engine, *one, tolerance)) for one in whirls], ORBIT_TOLERANCE
    )
    # The multiplier of a shift in time is 1; the one next to it tells by how much an error of the flow is amplified.
    distances = [sorted(abs(1.0 - value) for value in orbit.multipliers) for orbit in exact]
    found = with_tolerance(found, predicted[:, 2] / np.array(distances)[:, 1])
    loads = [load for load, _ in whirls]
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=(
            "period in s",
            "least radius in m",
            "greatest radius in m",
            "least spin in rad/s",
            "greatest spin in rad/s",
            "mean spin in rad/s",
        ),
        data={"orbit load": loads, "orbit": found.value},
    )


def orbit_of(engine: Engine, load: float, which: int, tolerance: float, offset: float = RING.offset) -> Orbit:
    """Return the same whirl as the engine has it."""
    guess = orbit_of_reference(load, which, offset)
    return whirl_orbit(
        guess.system,
        simulate=engine.simulate,
        guess=guess,
        tolerance=tolerance,
        samples=64,
        precision=engine.precision,
    )


def sizes_of(orbit: Orbit) -> FloatArray:
    """Return period, least and greatest radius, least, greatest and mean spin, in s, m and rad/s."""
    spin = orbit.trajectory.states[:-1, -1]
    return np.array([orbit.period, *extent(orbit), np.min(spin), np.max(spin), np.mean(spin)])


@functools.lru_cache(maxsize=4)
def parts(engine: Engine) -> Measurement:
    """Return centre, amplitude of the first harmonic, mean spin of whirls with ``HALVED_OFFSETS``, shape (3, 4)."""

    def found(tolerance: float) -> FloatArray:
        whirls = [orbit_of(engine, OFFSET_LOAD, 0, tolerance, offset) for offset in HALVED_OFFSETS]
        return np.array([(*orbit.mean, *circle_in(orbit)) for orbit in whirls])

    return refined(found, ORBIT_TOLERANCE, alike=False)


def circle_in(orbit: Orbit) -> tuple[float, float]:
    """Return the amplitude of the first harmonic of x + iy in m, and the mean spin in rad/s."""
    states = orbit.trajectory.states[:-1]
    harmonics = np.fft.fft(states[:, 0] + 1j * states[:, 1]) / len(states)
    return float(np.abs(harmonics[1])), float(np.mean(states[:, -1]))


@STUDY.claim(
    "The offset shifts the centre of the whirl by the first-order response, with an error like X0³",
    equation="(18)",
    kind="order",
    resolution=0.05,
    note=f"Order for {EXTRAPOLATED} Not in the paper, whose (18) is for the pin: here it is the linear response of "
    "the circle to the offset, which turns backwards in the axes that turn with it.",
    basis="reference",
    swept=("offset",),
)
def offset_shifts(engine: Engine) -> Measured:
    """Observe the order of what the first-order response leaves of the shift."""
    found = parts(engine)
    discs = [with_load(replace(RING, offset=offset), OFFSET_LOAD) for offset in HALVED_OFFSETS]
    response = [first_order_shift(disc) for disc in discs]
    gaps = np.abs(found.value[:, 0] + 1j * found.value[:, 1] - response)[:, np.newaxis]
    return _orders(gaps, np.hypot(found.error[:, 0], found.error[:, 1])[:, np.newaxis], 3.0, ("shift",))


@STUDY.claim(
    "The offset changes radius and spin of the whirl like X0²",
    kind="order",
    resolution=0.05,
    note=f"Orders of the change of the first harmonic's amplitude, and of the mean spin, for {EXTRAPOLATED}",
    basis="reference",
    swept=("offset",),
)
def offset_changes_size(engine: Engine) -> Measured:
    """Observe the orders of the changes against the circle without offset."""
    found, circle = parts(engine), circle_of(OFFSET_LOAD, 0)
    _, _, radius, spin = found.value[1]
    return replace(
        _orders(
            np.abs(found.value[:, 2:] - [circle.radius, circle.spin]),
            found.error[:, 2:],
            2.0,
            ("radius", "spin"),
        ),
        note=f"At X0 = {HALVED_OFFSETS[1]:g} m they change by {radius / circle.radius - 1.0:.2g} of themselves and "
        f"{spin - circle.spin:.2g} rad/s.",
    )


def _orders(gaps: FloatArray, noise: FloatArray, order: float, components: tuple[str, ...]) -> Measured:
    observed, numerical, model = extrapolated(gaps, noise)
    return Measured(
        predicted=np.full(len(observed), order),
        value=observed,
        error=numerical,
        model=model,
        components=components,
        system=with_load(RING, OFFSET_LOAD),
    )
