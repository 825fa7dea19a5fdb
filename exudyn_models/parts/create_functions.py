"""``mbs.CreateRingFriction`` and ``mbs.CreateRadialSupport``: the parts as functions in Exudyn's style."""

from collections.abc import Sequence
from typing import Any

import exudyn as exu
from exudyn.misc.extensionRegistry import extends, install

from exudyn_models.forces.laws.pressures import Pressure
from exudyn_models.forces.load_and_coefficient import Coefficient, NumberOrFunction
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import ContactPoints, add_ring_friction
from exudyn_models.parts.thermal_node import ThermalNode


@extends(exu.MainSystem)
def MainSystemCreateRingFriction(
    mbs: Any,
    bodyNumbers: Sequence[Any],
    *,
    frictionCoefficient: Coefficient,
    normalLoad: NumberOrFunction,
    regularisation: float | None = None,
    contactRadius: float | None = None,
    innerRadius: float | None = None,
    outerRadius: float | None = None,
    contactPoints: ContactPoints | None = None,
    staticRatio: float = 1.0,
    plates: int = 1,
    pressure: Pressure = "uniform",
    thermalNode: ThermalNode | None = None,
    masterRotation: Any = None,
    discRotation: Any = None,
    loadGain: float | Sequence[float] = 0.0,
    loadPart: Any = None,
) -> RingFriction:
    """Add friction between two bodies, master and disc; return its handle, which contains the connector's ``item``.

    Each of ``bodyNumbers`` is an ObjectIndex, a NodeIndex or a MarkerIndex. An Exudyn ground, or None, is a master at
    rest. All other arguments and errors are those of ``add_ring_friction``.
    """
    master, disc = _two_bodies(bodyNumbers)
    return add_ring_friction(
        mbs,
        master,
        disc,
        contact_radius=contactRadius,
        inner_radius=innerRadius,
        outer_radius=outerRadius,
        friction_coefficient=frictionCoefficient,
        normal_load=normalLoad,
        regularisation=regularisation,
        contact_points=contactPoints,
        static_ratio=staticRatio,
        plates=plates,
        pressure=pressure,
        thermal_node=thermalNode,
        master_rotation=masterRotation,
        disc_rotation=discRotation,
        load_gain=loadGain,
        load_part=loadPart,
    )


@extends(exu.MainSystem)
def MainSystemCreateRadialSupport(
    mbs: Any,
    bodyNumbers: Sequence[Any],
    *,
    stiffness: float,
    damping: float = 0.0,
    hardening: float = 0.0,
    stopGap: float = 0.0,
    stopStiffness: float = 0.0,
    offset: Sequence[float] = (0.0, 0.0),
) -> RadialSupport:
    """Add springs, a stop and a damper from a base to a disc; return the handle with the connector's ``item``.

    Each of ``bodyNumbers`` is an ObjectIndex, a NodeIndex or a MarkerIndex. The base may be an Exudyn ground, or
    None. All other arguments and errors are those of ``add_radial_support``.
    """
    base, disc = _two_bodies(bodyNumbers)
    return add_radial_support(
        mbs,
        base,
        disc,
        stiffness=stiffness,
        damping=damping,
        hardening=hardening,
        stop_gap=stopGap,
        stop_stiffness=stopStiffness,
        offset=offset,
    )


def _two_bodies(numbers: Sequence[Any]) -> tuple[Any, Any]:
    if not isinstance(numbers, (list, tuple)) or len(numbers) != 2:
        raise ValueError(f"bodyNumbers = {numbers!r}: it must be a list of two bodies")
    return numbers[0], numbers[1]


install()  # type: ignore[no-untyped-call]
