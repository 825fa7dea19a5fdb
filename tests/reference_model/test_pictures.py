"""Figures and animations of a motion show the motion, in SI units."""

import sys

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from reference_model import DiscOnDisc, PinOnDisc, simulate

PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
DISC = DiscOnDisc(
    mass=1.0, polar_inertia=1.0, stiffness=1.0, damping=0.5, friction_force=0.0225, disc_speed=1.5,
    contact_radius=0.12, shaft_damping=0.015, shaft_speed=1.25, contact_points=6,
)  # fmt: skip


@pytest.fixture(scope="module")
def pin_motion():
    return simulate(PIN, [0.1, 0.0, 0.03, 0.0], np.linspace(0.0, 13.0, 651))


@pytest.fixture(scope="module")
def disc_motion():
    return simulate(DISC, [0.02, 0.0, 0.0, 0.0, 0.0, 1.3], np.linspace(0.0, 1.0, 51))


def test_figure_shows_the_path_and_each_curve_with_its_unit(pin_motion, disc_motion):
    for motion, units in ((pin_motion, ["m", "m/s"]), (disc_motion, ["m", "m/s", "rad/s"])):
        path, *rows = motion.plot(Figure()).axes
        assert path.lines[0].get_xydata() == pytest.approx(motion.states[:, :2])
        assert [axes.get_ylabel().partition("[")[2] for axes in rows] == [f"{unit}]" for unit in units]
        curves = motion.radius, motion.slip_speed, motion.states[:, -1]
        for axes, curve in zip(rows, curves, strict=False):
            assert axes.lines[0].get_xydata() == pytest.approx(np.column_stack((motion.times, curve)))


def test_figure_shades_the_stick_phases(pin_motion):
    assert len(pin_motion.stick_phases) == 2
    for axes in pin_motion.plot(Figure()).axes[1:]:
        to_data = axes.transData.inverted()
        spans = [to_data.transform_bbox(band.get_window_extent()).intervalx for band in axes.patches]
        assert np.ravel(spans) == pytest.approx(pin_motion.stick_times)


@pytest.mark.parametrize("places", [None, [(0.1, 0.0, 0.5), (-0.05, 0.02, 0.5)]])
def test_animation_moves_the_contact_points_with_the_disc(disc_motion, places, tmp_path):
    film = disc_motion.animate(places=places, speed=25.0)  # frames at 0 and 1 s
    film.save(tmp_path / "film.gif", writer="pillow", dpi=10)
    assert Image.open(tmp_path / "film.gif").n_frames == 2
    turns = np.exp(2j * np.pi * np.arange(6) / 6)
    arms = 0.12 * turns if places is None else np.array([complex(*place[:2]) for place in places])
    x, y, angle = disc_motion.at_end[:3]
    expected = complex(x, y) + np.exp(1j * angle) * arms
    (axes,) = film._fig.axes
    assert axes.lines[-1].get_xydata() == pytest.approx(np.column_stack((expected.real, expected.imag)))
    assert np.angle(complex(*axes.lines[0].get_xydata()[1])) == pytest.approx(DISC.disc_speed)


def test_animation_of_a_pin_ends_where_the_pin_ends(pin_motion):
    film = pin_motion.animate(speed=13.0 * 25)
    film._func(1)
    film._draw_was_started = True  # matplotlib warns of an animation that nobody saved
    assert film._fig.axes[0].lines[-1].get_xydata()[0] == pytest.approx(pin_motion.at_end[:2])


def test_invalid_speed_and_missing_matplotlib_are_errors(pin_motion, monkeypatch):
    with pytest.raises(ValueError, match=r"speed = 0 s/s: it must be > 0"):
        pin_motion.animate(speed=0.0)
    with pytest.raises(ValueError, match=r"speed = 1e-09 s/s: more than 100,000 frames; use a larger speed"):
        pin_motion.animate(speed=1e-9)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    for draw in (pin_motion.plot, pin_motion.animate):
        with pytest.raises(ModuleNotFoundError, match="pip install matplotlib"):
            draw()
