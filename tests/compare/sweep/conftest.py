import pytest
from long_sweeps import LONG, content

from compare.cli import app as cli


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    """Contents of the store of an undisturbed sweep."""
    folder = tmp_path_factory.mktemp("undisturbed")
    assert cli.status([*LONG, "--output", str(folder)]) == 0
    return content(folder / "sweep.zarr")
