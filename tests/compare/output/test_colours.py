"""Colours of the figures as a deuteranope sees them."""

import itertools

import numpy as np
import pytest

from compare.output.figures import BLACK, PALETTE

DEUTERANOPIA = np.array(
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
)
"""Matrix for linear sRGB; Machado, Oliveira and Fernandes (2009), severity 1."""

XYZ_OF_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ_OF_RGB.sum(axis=1)

APART = 20.0
"""Smallest distance in CIELAB; two marks with a distance of 10 are easily confused."""


def linear(colour):
    values = np.array([int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)])
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    x, y, z = np.cbrt(XYZ_OF_RGB @ np.clip(rgb, 0.0, 1.0) / WHITE)  # not exact below 0.9 % of white
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


@pytest.mark.parametrize("sight", [np.eye(3), DEUTERANOPIA], ids=["all cones", "deuteranopia"])
def test_colours_of_the_figures_differ_in_pairs(sight):
    close = [
        pair
        for pair in itertools.combinations((BLACK, *PALETTE), 2)
        if np.linalg.norm(np.subtract(*(lab(sight @ linear(colour)) for colour in pair))) < APART
    ]
    assert close == []


def test_neighbours_of_the_palette_differ_in_lightness():
    lightness = [lab(linear(colour))[0] for colour in PALETTE]
    assert min(abs(np.diff(lightness))) > 8.0
