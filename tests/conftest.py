"""Tests of the page need a browser: without one they are deselected, except in CI."""

from __future__ import annotations

import gc
import os
import shutil

import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome", "msedge")
FIXTURE = "browser_path"

os.environ.pop("PYTEST_ADDOPTS", None)  # it has been read, and tests start pytest with their own options
gc.set_threshold(50_000, 10, 10)  # collecting all imported objects more often costs a tenth of the time


def find_browser() -> str | None:
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def browser_tests_run() -> bool:
    return find_browser() is not None or bool(os.environ.get("CI"))


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
