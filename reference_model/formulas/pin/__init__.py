"""The closed forms of sections 2 and 3 of the paper, one function per equation.

The paper assumes ω > 0 and X0 > 0. Here both may have either sign:

- If ω < 0 a formula is evaluated for |ω|, and y, angles and senses of rotation change sign.
- If X0 < 0, x and y change sign, and conditions such as (5) and (8) hold with |X0|.

The balances (3) and (11) also hold for a support that hardens or has a stop. All other formulas refuse it.

A formula raises ``ValueError`` if its subject does not exist, and names the condition that fails. Only (12)–(16) are
defined without a whirl, for ω < k too: they refuse |ω| = k, where ω/(ω − k) is undefined.
"""

from reference_model.formulas.pin.rest import (
    equilibrium_angle,
    equilibrium_position,
    equilibrium_radius,
    largest_load_in_words,
    largest_load_with_equilibrium,
    release_time,
    resonant_disc_speed,
    semicircle_residual,
    squared_holding_force,
    sticking_margin,
    sticking_radius,
    turn_until_release,
)
from reference_model.formulas.pin.whirl import (
    WhirlResponse,
    characteristic_coefficients,
    characteristic_coefficients_as_printed,
    circling_speed,
    coefficient_margins,
    driven_radius,
    first_order_whirl_response,
    first_order_whirl_shift,
    lower_branch_margin,
    require_drive,
    third_order_of_whirl_shift,
    upper_branch_margin,
    variational_matrix,
    whirl_frequency,
    whirl_radius,
    whirl_shift,
    whirl_shift_error_limit,
)

__all__ = [
    "WhirlResponse",
    "characteristic_coefficients",
    "characteristic_coefficients_as_printed",
    "circling_speed",
    "coefficient_margins",
    "driven_radius",
    "equilibrium_angle",
    "equilibrium_position",
    "equilibrium_radius",
    "first_order_whirl_response",
    "first_order_whirl_shift",
    "largest_load_in_words",
    "largest_load_with_equilibrium",
    "lower_branch_margin",
    "release_time",
    "require_drive",
    "resonant_disc_speed",
    "semicircle_residual",
    "squared_holding_force",
    "sticking_margin",
    "sticking_radius",
    "third_order_of_whirl_shift",
    "turn_until_release",
    "upper_branch_margin",
    "variational_matrix",
    "whirl_frequency",
    "whirl_radius",
    "whirl_shift",
    "whirl_shift_error_limit",
]
