"""Ranges of the variables in C, in the export, in the model description and through FMI."""

import ctypes
import math
import re

import pytest

from fmu_models import MODELS

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


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_unit_and_export_refuse_values_outside_the_range_of_each_variable(instance, model):
    unit = instance(model.name)
    for variable in model.variables:
        if not variable.settable:
            continue
        for value in (*outside(variable), -math.inf, math.inf, math.nan):
            assert unit.set(**{variable.name: value}) == [1]
            assert unit.sentence == sentence(variable, value)
            assert unit[variable.name] == variable.start
            with pytest.raises(ValueError, match=f"^{re.escape(sentence(variable, value))}$"):
                model.starting(**{variable.name: value})
        for value in (variable.least, variable.most):
            assert unit.set(**{variable.name: value}) == [0], variable.name


def test_export_refuses_a_fraction_for_a_whole_number():
    with pytest.raises(ValueError, match=r"^contact_points = 3\.5: it must be a whole number$"):
        MODELS["disc"].starting(contact_points=3.5)


@pytest.mark.parametrize("wrong", BROKEN)
def test_unit_and_export_refuse_contradictory_start_values(instance, wrong):
    name, *settings = wrong.split()
    values = {one: float(value) for one, value in (each.split("=") for each in settings)}
    unit = instance(name, **values)
    assert unit.initialise(ctypes.c_double(0.0)) == 1
    assert unit.sentence == BROKEN[wrong]
    with pytest.raises(ValueError, match=f"^{re.escape(BROKEN[wrong])}$"):
        MODELS[name].starting(**values)


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
def test_invalid_inputs_are_errors_that_the_importer_logs(unit, tmp_path, capsys, fmi):
    fmpy = pytest.importorskip("fmpy")
    file = str(unit("clutch", fmi))
    description = fmpy.read_model_description(file)
    # FMPy passes all messages to the logger it was given last, so a logger of this test would crash later ones.
    instance = fmpy.instantiate_fmu(fmpy.extract(file, tmp_path), description, "CoSimulation")
    if fmi == 2:
        instance.setupExperiment()
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    put = instance.setReal if fmi == 2 else instance.setFloat64
    (load,) = (one.valueReference for one in description.modelVariables if one.name == "normal_load")
    with pytest.raises(Exception, match=f"fmi{fmi}Set.* failed with status 3"):
        put([load], [-600.0])
    assert "normal_load = -600 N: it must lie between 0 and 1e+50" in capsys.readouterr().out
    instance.freeInstance()
