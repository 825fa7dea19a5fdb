"""Fixtures that compile the C sources of the units once per session, as libraries and as units."""

import ctypes
import functools
import shutil
from pathlib import Path

import pytest
from units_in_c import Instance

from fmu_models import MODELS, archive, export
from fmu_models.archive import compile_library, compiler, write_sources

DRIVER = Path(__file__).with_name("driver.c")


@pytest.fixture(scope="session")
def needs_compiler():
    if compiler() is None:
        pytest.skip("there is no C compiler")
    # Optimising takes longer than all tests together.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(archive, "OPTIONS", tuple("-O0" if one == "-O2" else one for one in archive.OPTIONS))
        yield


@pytest.fixture(scope="session")
def library(tmp_path_factory, needs_compiler):
    """Return a function that compiles a model with a driver instead of FMI, which needs no FMI headers."""

    @functools.cache
    def of(name):
        folder = tmp_path_factory.mktemp(name)
        write_sources(MODELS[name], folder)
        shutil.copyfile(DRIVER, folder / DRIVER.name)
        compile_library(sorted(folder.glob("*.c")), folder / "model.so", "-Wall", "-Wextra", "-Werror")
        return ctypes.CDLL(str(folder / "model.so"))

    return of


@pytest.fixture(scope="session")
def unit(tmp_path_factory, needs_compiler):
    """Return a function that exports units, for tests that need FMPy."""
    pytest.importorskip("fmpy", reason="FMPy is not installed")
    folder = tmp_path_factory.mktemp("units")

    @functools.cache
    def of(name, fmi=2):
        export(MODELS[name], folder / f"{name}{fmi}.fmu", fmi)
        return folder / f"{name}{fmi}.fmu"

    return of


@pytest.fixture
def instance(library):
    """Return a function that creates uninitialised instances of a model."""
    return lambda name, **values: Instance(library(name), MODELS[name], **values)
