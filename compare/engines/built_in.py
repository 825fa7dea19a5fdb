"""The engines of this project."""

from __future__ import annotations

import functools

from compare.engines.by_name import ByName
from compare.engines.engine import EVERY_KIND, Engine
from compare.engines.registry import register

_simulate_reference = ByName("reference_model", "simulate")

reference = register(Engine("reference", _simulate_reference, EVERY_KIND))
exudyn = register(Engine("exudyn", ByName("exudyn_models", "simulate"), EVERY_KIND))
exudyn_native = register(
    Engine(
        "exudyn-native",
        ByName("exudyn_models", "simulate_with_native_contact"),
        ("pin", "points"),
        kin="exudyn",
        contact_only=True,
        about="exudyn-native is Exudyn with its built-in contact in place of the connector of exudyn_models. "
        "Integrator, support and the smoothing of friction are the same, so it is asked only where the contact's own "
        "code decides: the contact by itself, a motion of each kind, a whirl, and free bodies. With --engine "
        "exudyn-native it is measured in all that it simulates.",
    )
)
compiled = register(
    Engine(
        "compiled",
        functools.partial(_simulate_reference, compiled=True),
        EVERY_KIND,
        nonlinear=False,
        kin="reference",
    ),
    on_request=True,
)
plain = register(
    Engine(
        "plain",
        ByName("reference_model.plain", "simulate"),
        EVERY_KIND,
        sticks=False,
        about="plain is the equations as the paper prints them, integrated by SciPy, with friction that is viscous "
        "at slow slip: what sticks creeps, and it tells no stick from slip. It takes only the parameters from the "
        "reference.",
    ),
    on_request=True,
)
