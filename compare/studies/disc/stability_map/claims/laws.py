"""What the ring, (23) and a pin say of the whirl of Fig. 11, each by itself."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.measured import Measured, answers_of
from compare.studies.disc.stability_map.claims.study import STUDY
from compare.studies.disc.stability_map.theory import (
    BESIDE_LARGEST,
    DISC,
    SLOWLY_SETTLED,
    UNSTABLE_LOADS,
    K,
    Start,
    at,
    critical_eigenvalues,
    ends_of,
    nearest,
)
from compare.studies.toolkit.fig11_planes import LAWS, PLANES
from reference_model.formulas.pin import upper_branch_margin
from reference_model.simulation import simulate
from reference_model.steady.bifurcation_curves import crossings
from reference_model.steady.stability import whirl_eigenvalues
from reference_model.steady.steady_states import whirls
from reference_model.systems import PinOnDisc

SIGN = "Sign of the largest real part."

(LOW, _), (HIGH, _) = PLANES["dampers"].lower, PLANES["dampers"].upper
SPEEDS = np.linspace(K * (1.0 + 1e-6), PLANES["load"].upper[0], 40)
"""β in N s/m and ω in rad/s between which pins are looked at."""


@STUDY.claim(
    "At the parameters of Fig. 11 the whirl on the continuous ring is unstable",
    equation="(19), (20)",
    note=SIGN,
)
def unstable_on_ring() -> Measured:
    """See on which side of the imaginary axis the whirl of the ring is."""
    return _side("ring", 1.0)


@STUDY.claim(
    "At the parameters of Fig. 11 the whirl of (23) is stable: (23) does not have the instability there",
    equation="(19), (23)",
    note=SIGN,
)
def stable_by_23() -> Measured:
    """See on which side of the imaginary axis the whirl of (23) is."""
    return _side("(23)", -1.0)


def _side(law: str, sign: float) -> Measured:
    """See whether the largest real part of the whirl of Fig. 11 by ``law`` has this ``sign``."""
    (whirl,) = whirls(DISC, LAWS[law])
    values, error = critical_eigenvalues(DISC, whirl.state, LAWS[law])
    near = nearest(crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed, LAWS[law]), np.inf)
    return answers_of(
        sign * values[0].real,
        error,
        source="Fig. 11 with X0 = 0",
        note=f"Radius {whirl.radius:.5f} m, spin {whirl.spin:.5f} rad/s, eigenvalues {values[0].real:+.5f} ± "
        f"{abs(values[0].imag):.5f}i 1/s. At this speed the whirl of this law is unstable up to μN = {near[0]:.5f} N."
        "",
    )


@STUDY.claim(
    "A pin's whirl has no Hopf curve: it is stable for all damping wherever ω > k",
    equation="(16)",
    note=f"Whether (16), and whether the eigenvalues say so, over ω/k from 1 to {SPEEDS[-1] / K:g} and β from "
    f"{LOW:g} to {HIGH:g} N s/m; μN and the torsion do not matter.",
    swept=("disc_speed", "damping"),
)
def pin_is_stable() -> Measured:
    """Count at how many points (16), the border of the pin's whirl, is violated where the whirl exists."""
    pins = [
        PinOnDisc(
            mass=DISC.mass,
            stiffness=DISC.stiffness,
            damping=damping,
            friction_force=DISC.friction_force,
            disc_speed=speed,
        )
        for speed in SPEEDS.tolist()
        for damping in np.linspace(LOW, HIGH, 20).tolist()
    ]
    return answers_of([(upper_branch_margin(pin), -whirl_eigenvalues(pin)[1].real) for pin in pins])


@STUDY.claim(
    "Where the whirl of (23) is unstable at the speeds of Fig. 11, motions end as rotation, not in a cycle",
    equation="(19), (23)",
    basis="reference",
)
def collapses_by_23() -> Measured:
    """See what motions under (23) end as where its whirl is unstable, simulated by the reference."""
    law, plane, speed = LAWS["(23)"], PLANES["load"], DISC.disc_speed
    (fold,), (hopf,) = (crossings(plane, kind, "disc_speed", speed, law) for kind in ("fold", "Hopf"))
    starts = []
    for share in UNSTABLE_LOADS:
        disc = at(friction_force=fold + share * (hopf - fold))
        largest = whirls(disc, law)[0]
        starts += [
            Start(disc, tuple((largest.state * factors).tolist()), "rotation", SLOWLY_SETTLED)
            for factors in BESIDE_LARGEST
        ]
    _, measured = ends_of(functools.partial(simulate, contact=law), starts)
    return measured
