import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG9
from reference_model import Annulus, Ring, ThreeTermRing, simulate
from reference_model.contact.contact_law import Pin
from reference_model.ensemble import EndState, simulate_ensemble

START = [0.1, 0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("system", "states", "options", "message"),
    [
        ("pin", START, {}, r"system = 'pin': it must be a PinOnDisc or a DiscOnDisc"),
        (FIG9, [0.1] * 6, {"contact": ThreeTermRing(0.1)}, r"ensembles support a Ring, Points, and an Annulus"),
        (FIG5, START, {"contact": Ring(0.1)}, r"a pin has point contact"),
        (FIG5, [0.1, 0.0], {}, r"initial_states has shape \(1, 2\): PinOnDisc takes 4 numbers"),
        (FIG5, np.zeros((0, 4)), {}, r"initial_states has shape \(0, 4\)"),
        (FIG5, [START, [0.1, 0.0, np.nan, 0.0]], {}, r"initial_states\[1, 2\] = nan: it must be finite"),
        (FIG5, [START, [0.1]], {}, r"initial_states = .*: it must contain only numbers, in rows of equal length"),
        (FIG5, START, {"duration": 0.0}, r"duration = 0 s: it must be > 0"),
        (FIG5, START, {"tolerance": 1.0}, r"tolerance = 1: it must lie between"),
        (FIG5, START, {"threads": 0}, r"threads = 0: it must be a whole number >= 1 and <= 1024"),
        (FIG5, START, {"parameters": ""}, r"parameters = '': it must be a Mapping"),
        (FIG5, START, {"parameters": {"ofset": [0.1]}}, r"'ofset' cannot vary .* choose from mass, stiffness"),
        (FIG5, START, {"parameters": {"hardening": [-0.1]}}, r"hardening = -0.1 N/m³: it must be >= 0"),
        (FIG5, START, {"parameters": {"offset": 0.1}}, r"offset has shape \(\): it must be a list"),
        (FIG5, START, {"parameters": {"damping": [0.1, -0.1]}}, r"damping = -0.1 N s/m: it must be >= 0"),
        (FIG5, START, {"parameters": {"mass": [1.0, np.inf]}}, r"mass\[1\] = inf: it must be finite"),
        (FIG5, [START] * 3, {"parameters": {"offset": [0.1, 0.2]}}, r"offset is for 2 trajectories, but there are 3"),
        (FIG5, [START] * 2, {"parameters": {"offset": [0.1] * 3}}, r"initial_states is for 2 trajectories"),
    ],
)  # fmt: skip
def test_invalid_ensemble_is_refused(system, states, options, message):
    with pytest.raises(ValueError, match=message):
        simulate_ensemble(system, states, **({"duration": 10.0} | options))


@pytest.mark.parametrize(
    ("system", "options", "message"),
    [
        (FIG9, {"contact": Pin()}, "a disc with point contact never comes to rest"),
        (FIG9, {"contact": ThreeTermRing(0.1)}, "compiled code supports a Ring, Points, and an Annulus"),
        (FIG9, {"contact": Annulus(0.1, 0.2, pressure=lambda r: 1.0)}, "an Annulus under uniform pressure"),
        (FIG9, {"contact": Annulus(0.19999, 0.2)}, "that is not very thin; omit compiled=True"),
        (FIG5, {"contact": Ring(0.1)}, "a pin has point contact"),
        (FIG5, {"times": [0.0, -1.0]}, "times must increase"),
    ],
)  # fmt: skip
def test_invalid_compiled_run_is_refused(system, options, message):
    arguments = {"initial_state": [0.1] * getattr(system, "state_size", 4), "times": [0.0, 1.0]} | options
    with pytest.raises(ValueError, match=message):
        simulate(system, compiled=True, **arguments)


def test_one_start_is_used_for_all_parameters_and_results_are_immutable():
    loads = np.array([0.09, 0.5])
    found = simulate_ensemble(FIG5, START, duration=400.0, parameters={"friction_force": loads})
    assert found.end.tolist() == [EndState.SELF_CENTRED, EndState.STUCK]
    assert found.states.shape == (2, 4)
    with pytest.raises(ValueError, match="read-only"):
        found.end[0] = 3
