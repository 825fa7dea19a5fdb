import pytest
from long_sweeps import LONG, content

from compare.cli import app as cli


@pytest.fixture(scope="session", autouse=True)
def few_checks():
    """Let the plain reference repeat two trajectories, because it takes most of the time of a small sweep."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("compare.sweep.compute.run.CHECKED", 2)
        yield


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    """Contents of the store of an undisturbed sweep."""
    folder = tmp_path_factory.mktemp("undisturbed")
    assert cli.status([*LONG, "--output", str(folder)]) == 0
    return content(folder / "sweep.zarr")
