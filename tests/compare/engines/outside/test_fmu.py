"""FMUs for co-simulation as engines: a correct one agrees, a wrong one differs, and invalid files are rejected."""

import functools
import re
import zipfile
from contextlib import suppress
from dataclasses import asdict, replace
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is not installed")
pytest.importorskip("fmpy.fmi3")

from fmpy.fmi2 import FMU2Slave

from compare.claims.claim import Verdict
from compare.claims.parameters import FIG5, FIG11
from compare.engines import UnsupportedSystemError, engines
from compare.engines.outside import fmu
from compare.engines.outside.fmu import FmuError
from compare.studies.engines.trajectories import STUDY
from fmu_models import PIN, export
from fmu_models.description import description
from reference_model.systems import COLUMNS

START = (0.9, 0.0, 0.0, 0.9)
DESCRIPTION = "modelDescription.xml"
STEP = (("stopTime=", 'stepSize="0.01" stopTime='),)


@pytest.fixture(scope="session")
def packed(tmp_path_factory, needs_compiler):
    """Return a function that exports a pin with a changed description, and returns its file."""
    folder = tmp_path_factory.mktemp("models")

    @functools.cache
    def exported(fmi):
        export(PIN, folder / f"pin{fmi}.fmu", fmi)
        with zipfile.ZipFile(folder / f"pin{fmi}.fmu") as unit:
            return {name: unit.read(name) for name in unit.namelist()}

    def pack(name, fmi=2, changes=(), library=True, **renamed):
        members = dict(exported(fmi))
        text = members.pop(DESCRIPTION).decode()
        for old, new in (*changes, *((f'name="{old}"', f'name="{new}"') for old, new in renamed.items())):
            text, count = re.subn(old, new, text, flags=re.DOTALL)
            assert count
        with zipfile.ZipFile(folder / f"{name}.fmu", "w") as changed:
            changed.writestr(DESCRIPTION, text)
            for path, content in members.items():
                if library or not path.startswith("binaries"):
                    changed.writestr(path, content)
        return folder / f"{name}.fmu"

    return pack


def engine_of(file):
    (engine,) = engines([f"fmu:{file}"])
    return engine


@pytest.fixture(scope="session", params=[2, 3], ids=["FMI 2, states only", "FMI 3"])
def right(packed, request):
    if request.param == 3:
        return engine_of(packed("right3", 3))
    return engine_of(packed("right2", changes=STEP, stick_count="count"))


def moves(engine):
    (claim,) = STUDY.measure(engine, only=["moves/a pin"]).claims
    return claim.verdict


def test_a_correct_fmu_agrees(right):
    assert moves(right) is Verdict.AGREES


def test_an_fmu_that_exchanges_two_parameters_differs(packed):
    wrong = packed("wrong", damping="other", friction_force="damping", other="friction_force")
    assert moves(engine_of(wrong)) is Verdict.DIFFERS


def test_the_variables_of_an_fmu_determine_its_abilities(right, packed):
    assert (right.kinds, right.nonlinear) == (("pin",), True)
    assert (right.phases, right.step) == ((False, 1e-2) if right.name == "right2" else (True, None))
    linear = engine_of(packed("linear", hardening="other"))
    assert linear.lacking([FIG11, replace(FIG5, hardening=1.0)]).endswith(
        "a disc on a continuous ring or a pin on a nonlinear support"
    )


@pytest.mark.parametrize(
    ("points", "kinds"),
    [
        ({}, ("ring",)),
        ({"contact_points": SimpleNamespace()}, ("points",)),
        ({"contact_points": SimpleNamespace(min="0")}, ("ring", "points")),
    ],
)
def test_zero_points_stand_for_the_continuous_ring(points, kinds):
    names = {*asdict(FIG11), *(name for name, _ in COLUMNS[type(FIG11)])} - {"contact_points"}
    assert fmu._kinds("disc.fmu", dict.fromkeys(names) | points) == kinds


@pytest.mark.parametrize(("disc_speed", "spin"), [(0.0, -2.0), (-2.0, 0.0)])
def test_creep_of_points_is_proportional_to_the_rim_speed_of_either_disc(disc_speed, spin):
    disc = replace(FIG11, contact_points=6, disc_speed=disc_speed)
    (creep,) = fmu._creep(disc, {"spin": spin}, {fmu.CREEPS: None}, 1e-9).values()
    assert creep == pytest.approx(1e2 * 1e-9 * 2.0 * FIG11.contact_radius)
    assert fmu._creep(disc, {"spin": spin}, {}, 1e-9) == {}


def test_a_motion_does_not_depend_on_its_start_time(right):
    times = np.array([0.0, 0.1, 0.1 + 1e-9, 1.0])
    found = [right.simulate(FIG5, START, shift + times).states for shift in (0.0, 0.0, 8.0)]
    np.testing.assert_array_equal(found[1], found[0])
    np.testing.assert_allclose(found[2], found[0], atol=1e-9)


def test_communication_steps_are_at_most_as_long_as_the_step_of_the_fmu(packed, monkeypatch):
    lengths, advance = [], FMU2Slave.doStep
    monkeypatch.setattr(
        FMU2Slave, "doStep", lambda self, at, length: (lengths.append(length), advance(self, at, length))
    )
    engine_of(packed("stepped", changes=STEP, stick_count="count")).simulate(FIG5, START, [0.0, 0.02, 0.045])
    assert lengths == pytest.approx([0.01] * 2 + [0.025 / 3.0] * 3)


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_error_of_an_fmu_without_a_step_falls_with_the_tolerance(packed, fmi):
    engine = engine_of(packed(f"tolerant{fmi}", fmi))
    coarse, fine, exact = (
        engine.simulate(FIG5, START, [0.0, 10.0], tolerance=tolerance).at_end
        for tolerance in (1e-3, 1e-6, 1e-11)
    )
    assert 0.0 < np.max(np.abs(fine - exact)) < 0.1 * np.max(np.abs(coarse - exact))


def test_a_failed_call_of_an_fmu_is_reported(right):
    with pytest.raises(FmuError, match=r"^right[23]\.fmu: fmi[23]Set\w+ failed with status 3 \(error\)\.$"):
        right.simulate(FIG5, (1e60, 0.0, 0.0, 0.0), [0.0, 1.0])


def test_a_missing_parameter_must_be_zero(packed):
    engine = engine_of(packed("centred", offset="other"))
    engine.simulate(replace(FIG5, offset=0.0), START, [0.0, 0.1])
    with pytest.raises(UnsupportedSystemError, match="the model lacks offset"):
        engine.simulate(FIG5, START, [0.0, 0.1])


def test_a_missing_library_is_reported(packed):
    engine = engine_of(packed("pin", library=False))
    with pytest.raises(FmuError, match=r"^pin\.fmu cannot be started: Cannot find shared library binaries"):
        engine.simulate(FIG5, START, [0.0, 1.0])


def refusal(file):
    """Return the message that rejects a file as an engine."""
    with pytest.raises(ValueError, match=r"\.fmu") as error:
        engines([f"fmu:{file}"])
    assert "\n" not in str(error.value)
    return str(error.value)


def test_a_file_that_is_not_a_model_of_a_system_is_rejected(packed, tmp_path):
    (tmp_path / "text.fmu").write_text("no archive")
    lacking = packed("lacking", mass="other")
    exchange = packed("exchange", changes=[("<CoSimulation.*</CoSimulation>", "")])
    assert "file not found" in refusal(tmp_path / "missing.fmu")
    assert "text.fmu cannot be used as a model: " in refusal(tmp_path / "text.fmu")
    assert "lacking.fmu is not a model of a pin: it lacks mass" in refusal(lacking)
    assert "exchange.fmu cannot be used as a model: FMI 2.0, but " in refusal(exchange)


BROKEN = {
    "absolute": ({"/etc/data": b""}, "Illegal path"),
    "file and folder": ({"data": b"", "data/more": b""}, "Not a directory: 'data/more'"),
    "long name": ({"n" * 300: b""}, "File name too long: 'nnn"),
    "large": ({"data": bytes(10**6)}, "it would unpack to 1.01e+06 bytes, the limit is 1e+05"),
    "no description": ({}, "There is no item named 'modelDescription.xml'"),
}
"""Members of the archive in addition to the description, and part of the message."""


@pytest.mark.parametrize("kind", BROKEN)
def test_an_invalid_archive_is_rejected(tmp_path, monkeypatch, kind):
    members, reason = BROKEN[kind]
    monkeypatch.setattr(fmu, "MOST_BYTES", 1e5)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "unpacked"))
    (tmp_path / "unpacked").mkdir()
    with zipfile.ZipFile(tmp_path / "broken.fmu", "w") as broken:
        if members:
            broken.writestr(DESCRIPTION, description(PIN, 2, ("pin.c",)))
        for name, content in members.items():
            broken.writestr(name, content)
    sentence = refusal(tmp_path / "broken.fmu")
    assert "broken.fmu cannot be used as a model: " in sentence
    assert reason in sentence
    assert str(tmp_path / "unpacked") not in sentence
    assert not list((tmp_path / "unpacked").iterdir())


def test_a_damaged_archive_is_used_or_rejected(packed, tmp_path):
    whole = packed("whole").read_bytes()
    for place in np.linspace(0, len(whole) - 1, 60).astype(int):
        file = tmp_path / f"{place}.fmu"
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        with suppress(ValueError):
            fmu.fmu_engine(str(file))
