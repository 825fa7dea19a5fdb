import re
p="exudyn_models/drivetrain/model.py"; s=open(p).read()
s=s.replace("from reference_model.systems import FloatArray\n","from reference_model.systems import FloatArray, finite_number, positive_number, require_callable\n")
s=s.replace("""rad/s and ``ENERGY_UNIT``. Raises ``SimulationError`` if Exudyn fails or a state is not finite.
        \"\"\"
        settings""","""rad/s and ``ENERGY_UNIT``. Raises ``ValueError`` unless all four are positive, and ``SimulationError`` if
        Exudyn fails or a state is not finite.
        \"\"\"
        until, sample_every = positive_number("until", until, "s"), positive_number("sample_every", sample_every, "s")
        largest_step, tolerance = (
            positive_number("largest_step", largest_step, "s"),
            positive_number("tolerance", tolerance, "in SI units"),
        )
        settings""")
s=s.replace("""    ``ValueError`` if a number is out of range.
    \"\"\"
    container = exu""","""    ``ValueError`` if a number is out of range or not finite, or a torque is not a function.
    \"\"\"
    engine_speed, gearbox_speed, shaft_torque = (
        finite_number("engine_speed", engine_speed),
        finite_number("gearbox_speed", gearbox_speed),
        finite_number("shaft_torque", shaft_torque),
    )
    torques = {"engine": engine_torque, "vehicle": vehicle_torque}
    given = {name: torque for name, torque in torques.items() if torque is not None}
    for name, torque in given.items():
        require_callable(f"{name}_torque", torque)
    container = exu""")
a=s.index('    torques = {"engine": (engine,'); b=s.index("    balance = _add_balance(mbs, gains")
s=s[:a]+'''    nodes = {"engine": engine, "vehicle": vehicle}
    gains = {name: _add_torque(mbs, nodes[name], torque) for name, torque in given.items()}
'''+s[b:]
open(p,"w").write(s)
p="tests/exudyn_models/drivetrain/test_drivetrain.py"; s=open(p).read()
s+='''

@pytest.mark.parametrize("value", [float("nan"), True, "1_0", 1j, np.timedelta64(5, "ms")])
@pytest.mark.parametrize("name", ["engine_speed", "gearbox_speed", "shaft_torque", "engine_torque", "vehicle_torque"])
def test_drivetrain_refuses_wrong_speeds_and_torques(name: str, value: Any) -> None:
    arguments = {"normal_load": 1.0, "regularisation": 1e-3, "engine_speed": 1.0, "gearbox_speed": 0.0}
    with pytest.raises(ValueError, match=f"^{name}.* = .*: it must be"):
        build_drivetrain(PASSENGER_CAR, **(arguments | {name: value}))


@pytest.mark.parametrize("value", [float("inf"), 0.0, -1.0, True, None, "1"])
@pytest.mark.parametrize("name", ["until", "sample_every", "largest_step", "tolerance"])
def test_run_refuses_what_is_not_positive(name: str, value: Any) -> None:
    model = build_drivetrain(
        PASSENGER_CAR, normal_load=1.0, regularisation=1e-3, engine_speed=1.0, gearbox_speed=0.0
    )
    with pytest.raises(ValueError, match=f"^{name} = .*: it must be"):
        model.run(**({"until": 1e-3, "sample_every": 1e-3} | {name: value}))
'''
open(p,"w").write(s)
