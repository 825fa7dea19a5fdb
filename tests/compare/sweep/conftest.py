import subprocess

import pytest
from long_sweeps import LONG, content
from processes import REAL, environment


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    subprocess.run(
        [*REAL, *LONG, "--output", str(folder)], env=environment(), check=True, capture_output=True
    )
    return content(folder / "sweep.zarr")
