"""``friction-discs sweep shock``."""

import pytest

from compare.cli import app as cli
from reference_model.orbits.shock import Shock


@pytest.fixture
def found(monkeypatch):
    """The boundary gives 0.1 m/s, bisection what is asked for."""

    def both(by_bisection):
        monkeypatch.setattr("reference_model.smallest_shock", lambda pin, tolerance: Shock(pin, 0.06, -0.08))
        monkeypatch.setattr("reference_model.orbits.shock.by_bisection", lambda shock: by_bisection)

    return both


def test_what_it_takes_and_where_is_told(found, capsys):
    found(0.1 + 2e-9)
    assert cli.status(["sweep", "shock", "--set", "mass=2"]) == 0
    assert capsys.readouterr().out == (
        "smallest shock that leads to the whirl: 0.2 N s, a change of the velocity by 0.1 m/s, (0.06, -0.08) m/s\n"
        "  direction: -53.13° from the x-axis\n"
        "  by bisection of ends: 0.100000002 m/s, relative difference 2e-08\n"
    )


def test_ways_that_differ_are_told(found):
    found(0.1 + 2e-7)
    assert cli.status(["sweep", "shock"]) == 1


def test_a_pin_without_equilibrium_is_refused(capsys):
    assert cli.status(["sweep", "shock", "--set", "offset=0"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith("no equilibrium to start from")
