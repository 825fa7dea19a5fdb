"""Fixtures of several packages, which need a browser or a C compiler.

Tests of the page run only where a browser is installed; CI must have one.
"""

from __future__ import annotations

import ctypes
import functools
import gc
import os
import shutil
from pathlib import Path

import pytest

from fmu_models import MODELS, archive
from reference_model.simulation import prepare

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome", "msedge")
FIXTURE = "browser_path"

os.environ.pop("PYTEST_ADDOPTS", None)  # it has been read, and tests start pytest with their own options
gc.set_threshold(50_000, 10, 10)  # collecting all imported objects more often costs a tenth of the time


def find_browser() -> str | None:
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def browser_tests_run() -> bool:
    return find_browser() is not None or bool(os.environ.get("CI"))


def pytest_sessionstart() -> None:
    if "PYTEST_XDIST_WORKER" in os.environ:  # many tests will simulate
        prepare()


def pytest_report_header() -> str:
    if browser_tests_run():
        return f"browser: {find_browser() or 'missing, which fails under CI'}"
    return f"browser: none of {', '.join(BROWSERS)} found, the tests of the page are deselected"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if browser_tests_run():
        return
    deselected = [item for item in items if FIXTURE in getattr(item, "fixturenames", ())]
    config.hook.pytest_deselected(items=deselected)
    items[:] = [item for item in items if item not in deselected]


@pytest.fixture(scope="session")
def browser_path() -> str:
    path = find_browser()
    if path is None:
        pytest.fail(f"CI is set, and no browser is there: install one of {', '.join(BROWSERS)}")
    return path


@pytest.fixture(scope="session")
def needs_compiler():
    if archive.compiler() is None:
        pytest.skip("there is no C compiler")
    # Optimising takes longer than all tests together.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(archive, "OPTIONS", tuple("-O0" if one == "-O2" else one for one in archive.OPTIONS))
        yield


@pytest.fixture(scope="session")
def library(tmp_path_factory, needs_compiler):
    """Return a function that compiles a model with a driver instead of FMI, which needs no FMI headers."""
    driver = Path(__file__).parent / "fmu_models" / "driver.c"

    @functools.cache
    def of(name):
        folder = tmp_path_factory.mktemp(name)
        archive.write_sources(MODELS[name], folder)
        shutil.copyfile(driver, folder / driver.name)
        strict = ("-Wall", "-Wextra", "-Werror")
        archive.compile_library(sorted(folder.glob("*.c")), folder / "model.so", *strict)
        return ctypes.CDLL(str(folder / "model.so"))

    return of
