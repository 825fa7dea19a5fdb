"""Single trajectories of discs on points by the compiled kernels."""

import time

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact, contact_of
from reference_model.ensemble.disc.driver import follow_disc
from reference_model.ensemble.recording import ROUNDED, Recording
from reference_model.ensemble.simulate import require_supported
from reference_model.motion.nondimensional import Units
from reference_model.systems import DiscOnDisc, checked_state, checked_times, checked_tolerance
from reference_model.trajectory import SimulationError, Solution, Trajectory, phases_of

METHOD = "compiled DOP853 in stretched time, Radau IIA where it is stiff; closed-form stick phases"


def simulate_points(
    system: DiscOnDisc,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
) -> Trajectory:
    """Simulate a disc on points like :func:`reference_model.simulate`, by the kernel of ensembles."""
    clock = time.perf_counter()
    state = checked_state(system, initial_state)
    times = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    if contact_of(system, contact) != contact_of(system):
        raise ValueError(
            f"contact = {contact}: compiled runs support only the law of the system's parameters, "
            f"{contact_of(system)}; omit compiled=True"
        )
    require_supported(system)
    delays, unit = times - times[0], Units.of(system, state).time
    # For a single time only the phase that begins is needed.
    duration = float(delays[-1]) if len(times) > 1 else unit
    states = np.full((len(times), system.state_size), np.nan)
    recording = Recording(delays, states, duration, ROUNDED * max(duration, unit))
    follow_disc(system, state, tolerance, recording)
    recording.states[0] = state
    if not np.all(np.isfinite(recording.states)):
        raise SimulationError(
            "the states are not finite: the parameters differ by too many orders of magnitude"
        )
    lasting = [phase for phase in recording.phases if phase[1] < delays[-1]] or recording.phases[:1]
    begun = [(kind, float(times[0]) + start, first) for kind, start, first in lasting]
    solution = Solution(
        METHOD, tolerance, recording.evaluations, recording.steps, wall_time=time.perf_counter() - clock
    )
    return Trajectory(system, times, recording.states, phases_of(begun, float(times[-1])), solution)
