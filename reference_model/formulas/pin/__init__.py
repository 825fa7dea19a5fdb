"""The closed forms of sections 2 and 3 of the paper, one function an equation.

Signs
-----
The paper takes ω > 0 and X0 > 0. Here both may have either sign:

- A disc that turns the other way gives the motion mirrored in the x axis. So a formula of the paper is
  evaluated for |ω|, and what it says about y, about an angle or about a direction of turning changes its
  sign where ω < 0: the whirl of ω < −k has the frequency −k.
- An offset on the other side gives the motion turned by half a revolution: x and y change their signs. So
  conditions such as (5) and (8) hold with |X0|.

Those of the balances of (3) and (11) hold for a support that hardens or has a stop too, with its force in the place
of that of the spring. The others are for a linear support and refuse any else.

A formula raises ``ValueError`` where what it describes does not exist, and names the condition that fails.
The exceptions are (12)–(16), which the paper uses for ω < k too: they are statements about a matrix and its
characteristic equation, and only |ω| = k, where ω/(ω − k) has no value, is refused.
"""

from reference_model.formulas.pin.rest import (
    equilibrium_angle,
    equilibrium_position,
    equilibrium_radius,
    largest_load_in_words,
    largest_load_with_equilibrium,
    semicircle_residual,
)
from reference_model.formulas.pin.sticking import (
    release_time,
    resonant_disc_speed,
    squared_holding_force,
    sticking_margin,
    sticking_radius,
    turn_until_release,
)
from reference_model.formulas.pin.whirl import (
    circling_speed,
    driven_radius,
    require_drive,
    whirl_frequency,
    whirl_radius,
)
from reference_model.formulas.pin.whirl_stability import (
    characteristic_coefficients,
    characteristic_coefficients_as_printed,
    coefficient_margins,
    lower_branch_margin,
    upper_branch_margin,
    variational_matrix,
)
from reference_model.formulas.pin.whirl_with_offset import (
    WhirlResponse,
    first_order_whirl_response,
    first_order_whirl_shift,
    third_order_of_whirl_shift,
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
