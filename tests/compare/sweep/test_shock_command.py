"""``friction-discs sweep shock``."""

import pytest

from compare.cli import app as cli
from reference_model.orbits.shock import Shock


@pytest.mark.parametrize(("bisected", "status"), [(0.1 + 2e-9, 0), (0.1 + 2e-7, 1)])
def test_what_it_takes_is_told_and_whether_both_ways_agree(bisected, status, monkeypatch, capsys):
    monkeypatch.setattr("reference_model.smallest_shock", lambda pin, tolerance: Shock(pin, 0.06, -0.08))
    monkeypatch.setattr("reference_model.orbits.shock.by_bisection", lambda shock: bisected)
    assert cli.status(["sweep", "shock", "--set", "mass=2"]) == status
    assert capsys.readouterr().out == (
        "smallest shock that leads to the whirl: 0.2 N s, a change of the velocity by 0.1 m/s, (0.06, -0.08) m/s\n"
        "  direction: -53.13° from the x-axis\n"
        f"  by bisection of ends: {bisected:.9g} m/s, relative difference {bisected / 0.1 - 1.0:.0e}\n"
    )
