"""FMUs for co-simulation as engines: a correct one agrees, a wrong one differs, and invalid files are rejected."""

import shutil
import subprocess
import zipfile
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed")
pytest.importorskip("fmpy.fmi3")

from compare.claims.claim import Verdict  # noqa: E402
from compare.claims.parameters import FIG5, FIG11  # noqa: E402
from compare.engines import UnsupportedSystemError, engines  # noqa: E402
from compare.engines.outside import fmu  # noqa: E402
from compare.engines.outside.fmu import FmuError  # noqa: E402
from compare.studies.engines.trajectories import STUDY  # noqa: E402
from reference_model.systems import COLUMNS  # noqa: E402

SOURCE = Path(__file__).with_name("pin_fmu.c")
COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
PARAMETERS = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")
STATES = ("x", "y", "vx", "vy")
START = (0.9, 0.0, 0.0, 0.9)
STEP = '<DefaultExperiment stepSize="0.002"/>'

pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")


def description(fmi, names, interface="CoSimulation"):
    """Return the model description with these variables, in the order of the source."""
    places = [(PARAMETERS + STATES).index(name) for name in names]
    parameter, output = 'causality="parameter" variability="tunable"', 'causality="output"'
    known = [
        f'name="{name}" valueReference="{at}" initial="exact" {parameter if name in PARAMETERS else output}'
        for name, at in zip(names, places, strict=True)
    ]
    if fmi == 2:
        head = 'fmiVersion="2.0" guid="{1}"'
        variables = (f'<ScalarVariable {one}><Real start="0"/></ScalarVariable>' for one in known)
        unknown = (f'<Unknown index="{i}"/>' for i, name in enumerate(names, 1) if name in STATES)
        structure = f"<Outputs>{''.join(unknown)}</Outputs>"
    else:
        head = 'fmiVersion="3.0" instantiationToken="{1}"'
        time = '<Float64 name="time" valueReference="99" causality="independent" variability="continuous"/>'
        variables = (time, *(f'<Float64 {one} start="0"/>' for one in known))
        structure = "".join(f'<Output valueReference="{at}"/>' for at in places if at >= len(PARAMETERS))
    return (
        f'<fmiModelDescription {head} modelName="pin"><{interface} modelIdentifier="pin"/>'
        f"{STEP if fmi == 2 else ''}<ModelVariables>{''.join(variables)}</ModelVariables>"
        f"<ModelStructure>{structure}</ModelStructure></fmiModelDescription>"
    )


def rest(folder, fmi):
    """Write a C source with the required functions that no test calls."""
    master = fmpy.fmi2.FMU2Slave if fmi == 2 else fmpy.fmi3.FMU3Slave
    names = [name for name in dir(master) if name.startswith(f"fmi{fmi}") and name not in SOURCE.read_text()]
    path = folder / f"rest{fmi}.c"
    path.write_text("".join(f"int {name}(void) {{ return 3; }}\n" for name in names))
    return path


@pytest.fixture(scope="session")
def packed(tmp_path_factory):
    """Return a function that builds a model and returns its file."""
    folder = tmp_path_factory.mktemp("models")

    def pack(name, fmi=2, mistake=1, names=PARAMETERS + STATES, **more):
        library = folder / f"{name}.so"
        options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC"]
        defined = [f"-DFMI={fmi}", f"-DMISTAKE={mistake}"]
        sources = [str(SOURCE), str(rest(folder, fmi))]
        subprocess.run([COMPILER, *options, *defined, "-o", str(library), *sources, "-lm"], check=True)
        platform = fmpy.platform if fmi == 2 else fmpy.platform_tuple
        with zipfile.ZipFile(folder / f"{name}.fmu", "w") as archive:
            archive.writestr("modelDescription.xml", description(fmi, names, **more))
            archive.write(library, f"binaries/{platform}/pin{fmpy.sharedLibraryExtension}")
        return folder / f"{name}.fmu"

    return pack


@pytest.fixture(scope="session", params=[2, 3], ids=["FMI 2", "FMI 3"])
def right(packed, request):
    (engine,) = engines([f"fmu:{packed(f'right{request.param}', request.param)}"])
    return engine


def moves(engine):
    (claim,) = STUDY.measure(engine, only=["moves/a pin"]).claims
    return claim.verdict


def test_a_correct_fmu_agrees(right):
    assert moves(right) is Verdict.AGREES


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_wrong_fmu_differs(packed, fmi):
    (engine,) = engines([f"fmu:{packed(f'wrong{fmi}', fmi, mistake=2)}"])
    assert moves(engine) is Verdict.DIFFERS


def test_the_variables_of_an_fmu_determine_its_abilities(right):
    assert (right.kinds, right.nonlinear, right.phases) == (("pin",), False, False)
    assert right.step == (2e-3 if right.name == "right2" else None)
    assert right.lacking([FIG11, replace(FIG5, hardening=1.0)]).endswith(
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


def test_creep_of_a_spinning_disc_is_proportional_to_its_rim_speed():
    disc = replace(FIG11, contact_points=6, disc_speed=0.0)
    (creep,) = fmu._creep(disc, {"spin": -2.0}, {fmu.CREEPS: None}, 1e-9).values()
    assert creep == pytest.approx(1e2 * 1e-9 * 2.0 * FIG11.contact_radius)
    assert fmu._creep(disc, {"spin": -2.0}, {}, 1e-9) == {}


def test_a_motion_does_not_depend_on_its_start_time(right):
    times = np.array([0.0, 0.1, 0.1 + 1e-9, 1.0])
    found = [right.simulate(FIG5, START, shift + times).states for shift in (0.0, 0.0, 8.0)]
    np.testing.assert_array_equal(found[1], found[0])
    np.testing.assert_allclose(found[2], found[0], atol=1e-9)


def test_a_failed_call_of_an_fmu_is_reported(right):
    with pytest.raises(FmuError, match=r"^right[23]\.fmu: fmi[23]DoStep failed with status 3 \(error\)\.$"):
        right.simulate(replace(FIG5, mass=200.0), START, [0.0, 1.0])


def test_a_missing_parameter_must_be_zero(packed):
    centred = tuple(name for name in PARAMETERS + STATES if name != "offset")
    (engine,) = engines([f"fmu:{packed('centred', names=centred)}"])
    engine.simulate(replace(FIG5, offset=0.0), START, [0.0, 0.1])
    with pytest.raises(UnsupportedSystemError, match="the model lacks offset"):
        engine.simulate(FIG5, START, [0.0, 0.1])


def refusal(file):
    """Return the message that rejects a file as an engine."""
    with pytest.raises(ValueError, match=r"\.fmu") as error:
        engines([f"fmu:{file}"])
    assert "\n" not in str(error.value)
    return str(error.value)


def test_a_file_that_is_not_a_model_of_a_system_is_rejected(packed, tmp_path):
    (tmp_path / "text.fmu").write_text("no archive")
    lacking = packed("lacking", names=tuple(name for name in PARAMETERS + STATES if name != "mass"))
    exchange = packed("exchange", interface="ModelExchange")
    assert "file not found" in refusal(tmp_path / "missing.fmu")
    assert "text.fmu cannot be used as a model: " in refusal(tmp_path / "text.fmu")
    assert "lacking.fmu is not a model of a pin: it lacks mass" in refusal(lacking)
    assert "exchange.fmu cannot be used as a model: FMI 2.0, but " in refusal(exchange)


BROKEN = {
    "backslash": ({"resources\\data": b""}, "Illegal path"),
    "colon": ({"C:/data": b""}, "Illegal path"),
    "absolute": ({"/etc/data": b""}, "Illegal path"),
    "file and folder": ({"data": b"", "data/more": b""}, "Not a directory: 'data/more'"),
    "long name": ({"n" * 300: b""}, "File name too long: 'nnn"),
    "large": ({"data": bytes(10**6)}, "it would unpack to 1e+06 bytes, the limit is 1e+05"),
    "no description": ({}, "There is no item named 'modelDescription.xml'"),
}
"""Members of the archive in addition to the description, and part of the message."""


@pytest.mark.parametrize("kind", BROKEN)
def test_an_invalid_archive_is_rejected(tmp_path, monkeypatch, kind):
    members, reason = BROKEN[kind]
    monkeypatch.setattr(fmu, "MOST_BYTES", 1e5)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "unpacked"))
    (tmp_path / "unpacked").mkdir()
    with zipfile.ZipFile(tmp_path / "broken.fmu", "w") as archive:
        if members:
            archive.writestr("modelDescription.xml", description(2, PARAMETERS + STATES))
        for name, content in members.items():
            archive.writestr(name, content)
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


def test_a_missing_library_is_reported(tmp_path):
    with zipfile.ZipFile(tmp_path / "pin.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", description(2, PARAMETERS + STATES))
    (engine,) = engines([f"fmu:{tmp_path}/pin.fmu"])
    with pytest.raises(FmuError, match=r"^pin\.fmu cannot be started: Cannot find shared library binaries"):
        engine.simulate(FIG5, START, [0.0, 1.0])
