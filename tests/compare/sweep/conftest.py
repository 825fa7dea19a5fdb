import pytest
from long_sweeps import LONG, content

from compare.cli import app as cli


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    """What is in the store of a sweep that nothing happened to; from then on the kernel is compiled for everyone."""
    folder = tmp_path_factory.mktemp("undisturbed")
    assert cli.status([*LONG, "--output", str(folder)]) == 0
    return content(folder / "sweep.zarr")
