"""The memory of a run between calls, and the motion of a body that sticks."""

import math

from reference_model.core.forces.law import CENTRE, Law
from reference_model.core.forces.points import centre_slip, slip_of
from reference_model.core.steps.explicit import Unknowns
from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

SLIPS, STICKS, PIVOTS = 1.0, 2.0, 3.0
"""Kinds of phases."""

(
    STEP, SPAN, SHORT, PATIENCE, SIDE_OF_STOP, SIDE_OF_RIM, SIDE_OF_HOLE, SIDE_OF_GRIP, SIDE_OF_SPIN, POINT, SENSE,
    PHASE, CREEPS, STEPS, EVALUATIONS, WORK, RECORDED, PHASES, STATUS, SLOTS,
) = range(20)  # fmt: skip
"""Indices into the memory of a run, which continues from it in the next call.

The memory contains the next explicit step, the time of the last step, the number of recent short steps and the number
that calls for collocation, the signs of the surfaces, the contact point that the slip belongs to, the sense of a
pivot, the kind of the current phase, whether slip decays forever, the numbers of steps and evaluations, the work in
explicit steps, the numbers of recorded times and phases, and whether the run continues.
"""

RUNS, ENDS, FAILS, FULL = 0.0, 1.0, 2.0, 3.0
"""Values of the status; FULL asks for more room for phases."""


@inlined
def speed_of(y: Unknowns, law: Law) -> float:
    """Return the slip speed: of centre and rim together, of a point, or of the rotation about a point."""
    return math.sqrt(along(y, y, law))


@inlined
def along(a: Unknowns, y: Unknowns, law: Law) -> float:
    """Return the product of ``a`` with the slip in ``y``."""
    result = 0.0
    if law.sense == 0.0:
        result += a[2] * y[2] + a[3] * y[3]
    if law.point == CENTRE or law.sense != 0.0:
        result += a[4] * y[4]
    return result


@part
def seen(y: Unknowns, law: Law, new: Law) -> Unknowns:
    """Convert the unknowns of ``law`` to the unknowns of ``new``; only the point differs."""
    ux, uy = centre_slip(y[2], y[3], y[4], y[5], law)
    vx, vy = slip_of(ux, uy, y[4], y[5], new)
    return (y[0], y[1], vx, vy, y[4], y[5], y[6])


@part
def put(row: FloatArray, y: Unknowns, law: Law) -> None:
    """Write x, y, the slip of the centre, r and the angle."""
    row[0], row[1], row[4], row[5] = y[0], y[1], y[4], y[5]
    row[2], row[3] = centre_slip(y[2], y[3], y[4], y[5], law)


@part
def carried(y: Unknowns, delay: float, way: float, slip: float, law: Law) -> Unknowns:
    """Return the unknowns of a body that sticks or creeps; ``way`` and ``slip`` in units of the slip of ``y``."""
    c, s = math.cos(law.omega * delay), math.sin(law.omega * delay)
    x, z = y[0] + way * y[2], y[1] + way * y[3]
    ux, uy = slip * y[2], slip * y[3]
    return (
        c * x - s * z, s * x + c * z, c * ux - s * uy, s * ux + c * uy, slip * y[4],
        y[5] + law.omega * delay + way * y[4] / law.gyration, y[6] + delay,
    )  # fmt: skip


@part
def enter(memory: FloatArray, phases: FloatArray, kind: float, y: Unknowns, law: Law) -> None:
    """Begin a phase unless it is of the current kind."""
    if memory[PHASE] != kind:
        memory[PHASE] = kind
        row = phases[int(memory[PHASES])]
        row[0], row[1] = kind, y[6]
        put(row[2:], y, law)
        memory[PHASES] += 1.0


@inlined
def pending(memory: FloatArray, times: FloatArray, until: float) -> bool:
    """Return whether a requested time up to ``until`` is still to be recorded."""
    return bool(memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= until)
