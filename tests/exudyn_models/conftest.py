import exudyn as exu
import pytest


@pytest.fixture(autouse=True)
def _quiet():
    before = exu.config.printToConsole
    exu.config.printToConsole = False
    yield
    exu.config.printToConsole = before
