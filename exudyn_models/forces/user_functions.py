"""Force and Jacobian of a friction contact as user functions for Exudyn.

Rotors on one axis with a constant friction force need no compiled code.
"""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

from exudyn_models.forces.any_pair import force_on_any, jacobian_on_any, parameters_of
from exudyn_models.forces.axial_pairs import functions_on_axis, on_one_axis
from exudyn_models.forces.jit import FLOATS, entry_point
from exudyn_models.forces.laws.product import LAW
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.planar_pairs import IN_THE_PLANE, force_in_the_plane, jacobian_in_the_plane
from exudyn_models.forces.slip_kinematics import Floats, Kinds
from reference_model.systems import FloatArray

ForceFunction = Callable[[Any, float, int, Floats, Floats], Floats]
JacobianFunction = Callable[[Any, float, int, Floats, Floats, float, float], FloatArray]


def force_and_jacobian(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient
) -> tuple[ForceFunction, JacobianFunction]:
    """Return the user functions of force and Jacobian; ``reference`` contains the nodes' coordinates."""
    if on_one_axis(kinds, factors):
        return functions_on_axis(kinds, factors)
    in_plane = kinds in IN_THE_PLANE
    parameters = parameters_of(factors.contact or factors.geometry, kinds, factors.law, reference)
    force = entry_point(force_in_the_plane if in_plane else force_on_any, *FORCE)

    @cache  # compiled when first needed; explicit solvers never need it
    def derive() -> Callable[..., Any]:
        in_closed_form = in_plane and not factors.depends_on_motion
        return entry_point(jacobian_in_the_plane if in_closed_form else jacobian_on_any, *JACOBIAN)

    def jacobian(*arguments: Any) -> Any:
        return derive()(parameters, *arguments)

    return partial(force, parameters), jacobian


FORCE = LAW, None, float, None, FLOATS, FLOATS

JACOBIAN = *FORCE, float, float
