"""Fixtures that export each unit once per session, and instances without FMI."""

import functools

import pytest
from units_in_c import Instance

from fmu_models import MODELS, export


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
