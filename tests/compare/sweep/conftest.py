import pytest
from long_sweeps import LONG, content

from compare.cli import app as cli


@pytest.fixture(scope="session", autouse=True)
def one_check():
    """Let the plain reference repeat one trajectory, because it takes most of the time of a small sweep."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("compare.sweep.compute.run.CHECKED", 1)
        yield


def draw_nothing(patch):
    patch.setattr("compare.sweep.figures.write_figures", lambda store, folder: ())


@pytest.fixture
def undrawn(monkeypatch):
    """Omit the figures of sweeps."""
    draw_nothing(monkeypatch)


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    """Contents of the store of an undisturbed sweep."""
    folder = tmp_path_factory.mktemp("undisturbed")
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        assert cli.status([*LONG, "--output", str(folder)]) == 0
    return content(folder / "sweep.zarr")
