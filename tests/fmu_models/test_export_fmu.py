"""Exported units: both FMI versions, FMPy as importer and solver, units as engines, and export without a compiler."""

import ctypes
import functools
import zipfile
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is not installed")
pytest.importorskip("fmpy.fmi3")

import fmpy
from fmpy.validation import validate_fmu

import reference_model
from compare.claims.claim import Verdict
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from compare.cli import app as cli
from compare.engines import engines
from compare.studies.engines.trajectories import STUDY
from fmu_models import CLUTCH, PIN, HeadersMissingError, archive, export
from fmu_models.archive import sources_of
from reference_model.systems import COLUMNS, DiscOnDisc

SIX = replace(FIG11, contact_points=6)
BOTH = pytest.mark.parametrize("fmi", [2, 3])


@BOTH
@pytest.mark.parametrize("name", ["pin", "disc", "clutch"])
def test_validator_accepts_the_unit(unit, name, fmi):
    assert validate_fmu(str(unit(name, fmi))) == []


@functools.cache
def reference(system, start):
    return reference_model.simulate(system, start, [0.0, 60.0], tolerance=1e-12)


@pytest.mark.parametrize(
    ("name", "system", "start", "fmi"),
    [
        *(("pin", FIG5, FIG5_STARTS["whirl"], fmi) for fmi in (2, 3)),
        ("disc", SIX, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), 3),
    ],
    ids=["pin that sticks, FMI 2", "pin that sticks, FMI 3", "six points"],
)
def test_cvode_finds_motion_stick_and_release(unit, name, system, start, fmi):
    states = [column for column, _ in COLUMNS[type(system)]]
    points = {"contact_points": 6} if system is SIX else {}
    run = fmpy.simulate_fmu(
        str(unit(name, fmi)),
        fmi_type="ModelExchange",
        output=[*states, "sticks"],
        set_stop_time=False,
        stop_time=60.0,
        output_interval=1.0,
        solver="CVode",
        relative_tolerance=1e-12,
        start_values=dict(zip(states, start, strict=True)) | points,
    )
    exact = reference(system, start)
    np.testing.assert_allclose([run[one][-1] for one in states], exact.at_end, rtol=0.0, atol=1e-8)
    expected = [phase.start for phase in exact.phases[1:]]
    assert (len(expected) > 8) == (name == "pin")
    found = run["time"][1:][np.diff(run["sticks"].astype(int)) != 0]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-7)


@BOTH
def test_co_simulation_rolls_back_and_returns_derivatives(unit, tmp_path, fmi):
    file = str(unit("pin", fmi))
    description = fmpy.read_model_description(file)
    instance = fmpy.instantiate_fmu(fmpy.extract(file, tmp_path), description, "CoSimulation")
    places = {one.name: one.valueReference for one in description.modelVariables}
    if fmi == 2:
        instance.setupExperiment()
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    get = instance.getReal if fmi == 2 else instance.getFloat64
    outputs, rates = ([places[one] for one in names] for names in (("x", "vx"), ("der_x", "der_vx")))
    along = instance.getDirectionalDerivative(rates, outputs[1:], [1.0])
    assert along[0] == 1.0
    assert along[1] < -0.1
    state = "FMUstate" if fmi == 2 else "FMUState"
    kept = getattr(instance, f"get{state}")()
    instance.doStep(0.0, 5.0)
    reached = get(outputs)
    saved = getattr(instance, f"serialize{state}")(kept)
    restored = getattr(instance, f"de{'S' if fmi == 2 else 's'}erialize{state}")(saved)
    for one in (kept, restored):
        getattr(instance, f"set{state}")(one)
        assert get(outputs) != reached
        instance.doStep(0.0, 5.0)
        assert get(outputs) == reached
    assert derivatives_of_outputs(instance, fmi, outputs) == get(rates)
    instance.terminate()
    instance.freeInstance()


def derivatives_of_outputs(instance, fmi, outputs):
    if fmi == 2:
        return instance.getRealOutputDerivatives(outputs, [1] * len(outputs))
    size = len(outputs)
    found = (ctypes.c_double * size)()
    references, orders = (ctypes.c_uint32 * size)(*outputs), (ctypes.c_int32 * size)(*[1] * size)
    instance.fmi3GetOutputDerivatives(instance.component, references, size, orders, found, size)
    return list(found)


COMES_TO_REST = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.4, disc_speed=1.2, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=0.0, contact_points=3,
)  # fmt: skip


@pytest.mark.parametrize(
    ("fmi", "system", "start", "kinds"),
    [
        (2, SIX, (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664), ["slip", "pivot", "slip", "pivot", "slip"]),
        (3, COMES_TO_REST, (0.3, 0.1, 0.0, 0.2, 0.3, 0.4), ["slip", "pivot", "stick"]),
    ],
    ids=["single ones", "all"],
)
def test_unit_reports_when_points_stick_and_are_released(unit, fmi, system, start, kinds):
    (engine,) = engines([f"fmu:{unit('disc', fmi)}"])
    expected = reference_model.simulate(system, start, [0.0, 40.0], tolerance=1e-12).phases
    assert [phase.kind for phase in expected] == kinds
    # At 1e-10 points pass the creep speed many times before their release.
    for tolerance, most, times in ((2e-8, 1e-3, [0.0, 40.0]), (1e-10, 3e-4, np.linspace(0.0, 40.0, 81))):
        found = engine.simulate(system, start, times, tolerance=tolerance).phases
        assert [phase.kind for phase in found] == kinds
        for mine, theirs in zip(found[1:], expected[1:], strict=True):
            assert abs(mine.start - theirs.start) < most
            assert np.max(np.abs(mine.initial_state - theirs.initial_state)) < 2.0 * most


@pytest.mark.parametrize(
    ("fmi", "times"), [(3, (0.0, 60.0)), (2, np.linspace(0.0, 60.0, 1201))], ids=["one step", "many steps"]
)
def test_unit_reports_all_phases_for_any_communication_steps(unit, fmi, times):
    (engine,) = engines([f"fmu:{unit('pin', fmi)}"])
    found = engine.simulate(FIG5, FIG5_STARTS["whirl"], times, tolerance=1e-11)
    expected = reference(FIG5, FIG5_STARTS["whirl"])
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in expected.phases]
    assert len(found.phases) > 8
    for mine, theirs in zip(found.phases, expected.phases, strict=True):
        np.testing.assert_allclose((mine.start, mine.end), (theirs.start, theirs.end), rtol=0.0, atol=1e-7)
        np.testing.assert_allclose(mine.initial_state, theirs.initial_state, rtol=0.0, atol=1e-7)


def test_disc_that_sticks_from_the_start_is_released_at_the_exact_time(unit):
    (engine,) = engines([f"fmu:{unit('disc')}"])
    place, speed = -0.01, FIG11.disc_speed
    disc = replace(FIG11, shaft_damping=0.0, damping=0.0, offset=0.015)  # the holding force rises with x
    carried = (place, 0.0, 0.0, 0.0, speed * place, speed)
    expected = reference_model.simulate(disc, carried, [0.0, 2.0], tolerance=1e-13)
    found = engine.simulate(disc, carried, [0.0, 0.5, 2.0], tolerance=1e-6)
    assert [phase.kind for phase in expected.phases][:2] == ["stick", "slip"]
    assert [phase.kind for phase in found.phases][:2] == ["stick", "slip"]
    assert abs(found.phases[0].end - expected.phases[0].end) < 1e-13
    np.testing.assert_allclose(found.phases[1].initial_state, expected.phases[1].initial_state, atol=1e-14)


@pytest.mark.parametrize("kind", ["a disc on the continuous ring", "a disc on six points"])
def test_claims_agree_with_the_unit(unit, kind):
    (engine,) = engines([f"fmu:{unit('disc')}"])
    (claim,) = STUDY.measure(engine, only=[f"moves/{kind}"]).claims
    assert claim.verdict is Verdict.AGREES


@BOTH
def test_export_without_a_compiler_writes_sources_only_and_reports_it(tmp_path, monkeypatch, capsys, fmi):
    monkeypatch.setattr(archive, "compiler", lambda: None)
    output = tmp_path / "clutch.fmu"
    assert cli.status(["export-fmu", "clutch", "--fmi", str(fmi), "--output", str(output)]) == 0
    assert "no C compiler found: the unit contains only its sources" in capsys.readouterr().out
    names = zipfile.ZipFile(output).namelist()
    assert {f"sources/{one}" for one in sources_of(CLUTCH, fmi)} <= set(names)
    assert not any(one.startswith("binaries") for one in names)
    assert ("sources/buildDescription.xml" in names) == (fmi == 3)


def test_export_sets_start_values_and_a_unit_with_creep_reports_no_phases(needs_compiler, tmp_path, capsys):
    output = tmp_path / "mine.fmu"
    settings = ["--set", "contact_points=4", "--set", "exact=false", "--set", "damping=5"]
    assert cli.status(["export-fmu", "disc", *settings, "--output", str(output)]) == 0
    starts = {one.name: one.start for one in fmpy.read_model_description(str(output)).modelVariables}
    assert (starts["contact_points"], starts["exact"], starts["damping"]) == ("4", "false", "5.0")
    assert "with its sources and a library for" in capsys.readouterr().out
    (engine,) = engines([f"fmu:{output}"])
    assert not engine.phases


def test_missing_headers_are_reported_with_the_package_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(HeadersMissingError, match="pip install fmpy"):
        export(PIN, tmp_path / "pin.fmu")
