"""Ranges of the variables in C, on the command line, in the model description and through FMI."""

import ctypes
import math

import pytest

from compare.cli import app as cli
from fmu_models import MODELS

SETTABLE = [
    pytest.param(name, variable, id=f"{name} {variable.name}")
    for name, model in MODELS.items()
    for variable in model.variables
    if variable.settable
]
BROKEN = {
    "disc contact_points=2": "contact_points = 2: it must be 0 for the continuous ring, or at least 3",
    "clutch outer_radius=0.05": "inner_radius = 0.1 m: it must be at most outer_radius = 0.05 m",
    "clutch inner_radius=0.05 contact_points=3": "contact_points = 3: points need a ring, but inner_radius = 0.05 m "
    "differs from outer_radius = 0.1 m",
    "clutch pressure_mean=0.249 pressure_outer=0": "pressure_mean = 0.249: it is too small, the parabola to "
    "pressure_inner = 1 and pressure_outer = 0 would be negative between the radii",
    "clutch pressure_inner=0 pressure_mean=0 pressure_outer=0": "pressure_mean = 0: one of pressure_inner, "
    "pressure_mean and pressure_outer must be > 0",
}
"""Error message by model and contradictory start values."""


def outside(variable):
    """Return a value just below and one just above the range of a variable."""
    if variable.type == "real":
        return math.nextafter(variable.least, -math.inf), math.nextafter(variable.most, math.inf)
    return variable.least - 1.0, variable.most + 1.0


def sentence(variable, value):
    text = f"{variable.name} = {value:g} {variable.unit}".rstrip()
    return f"{text}: it must lie between {variable.least:g} and {variable.most:g}"


@pytest.mark.parametrize(("name", "variable"), SETTABLE)
def test_unit_and_command_line_refuse_values_outside_the_range(instance, tmp_path, capsys, name, variable):
    unit, output, below = instance(name), tmp_path / "unit.fmu", outside(variable)[0]
    assert (
        cli.status(["export-fmu", name, "--set", f"{variable.name}={below!r}", "--output", str(output)]) == 2
    )
    assert capsys.readouterr().err == f"{sentence(variable, below)}\n"
    assert not output.exists()
    for value in (*outside(variable), -math.inf, math.inf, math.nan):
        assert unit.set(**{variable.name: value}) == [1]
        assert unit.sentence == sentence(variable, value)
        assert unit[variable.name] == variable.start
    assert unit.set(**{variable.name: variable.least}) == unit.set(**{variable.name: variable.most}) == [0]


@pytest.mark.parametrize("wrong", BROKEN)
def test_contradictory_start_values_are_refused(instance, tmp_path, capsys, wrong):
    name, *settings = wrong.split()
    unit = instance(name, **{one: float(value) for one, value in (each.split("=") for each in settings)})
    assert unit.initialise(ctypes.c_double(0.0)) == 1
    assert unit.sentence == BROKEN[wrong]
    words = [word for each in settings for word in ("--set", each)]
    assert cli.status(["export-fmu", name, *words, "--output", str(tmp_path / "unit.fmu")]) == 2
    assert capsys.readouterr().err == f"{BROKEN[wrong]}\n"
    assert not list(tmp_path.iterdir())


def test_parabola_of_pressure_may_touch_zero(instance):
    instance("clutch", inner_radius=0.05, pressure_mean=0.25, pressure_outer=0.0).started()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", MODELS)
def test_model_description_contains_the_range_of_each_variable_and_the_state_of_each_derivative(
    unit, name, fmi
):
    fmpy = pytest.importorskip("fmpy")
    described = {one.name: one for one in fmpy.read_model_description(str(unit(name, fmi))).modelVariables}
    for one in MODELS[name].variables:
        state = described[one.name].derivative
        assert (state.name if state else "") == one.derivative_of
        bounds = described[one.name].min, described[one.name].max
        if one.settable and one.type != "boolean":
            assert tuple(map(float, bounds)) == (one.least, one.most)
        else:
            assert bounds == (None, None)


@pytest.mark.parametrize("fmi", [2, 3])
def test_invalid_inputs_are_errors_that_the_importer_logs(unit, tmp_path, fmi):
    fmpy, logged = pytest.importorskip("fmpy"), []
    file = str(unit("clutch", fmi))
    description = fmpy.read_model_description(file)
    places = {one.name: one.valueReference for one in description.modelVariables}
    fmpy.extract(file, tmp_path)
    instance = fmpy.instantiate_fmu(
        tmp_path, description, "CoSimulation", logger=lambda *message: logged.append(message[-1])
    )
    if fmi == 2:
        instance.setupExperiment()
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    put = instance.setReal if fmi == 2 else instance.setFloat64
    for name, value, reason in (
        ("normal_load", -600.0, b"normal_load = -600 N: it must lie between 0 and 1e+50"),
        ("friction_coefficient", -0.3, b"friction_coefficient = -0.3: it must lie between 0 and 1e+50"),
        ("engagement", 1.5, b"engagement = 1.5: it must lie between 0 and 1"),
    ):
        with pytest.raises(Exception, match=f"fmi{fmi}Set.* failed with status 3"):
            put([places[name]], [value])
        assert logged[-1] == reason
    instance.freeInstance()
