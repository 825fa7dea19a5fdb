"""The order-tracked spectrum of the disc's motion, and its strongest line."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims.study import Data
from compare.studies.drivetrain.run_up.parameters import SAMPLES, TURNS
from compare.studies.toolkit.drivetrain_bench import centre
from reference_model.systems import FloatArray

HOP = 2 * SAMPLES
"""From one window to the next: two turns."""


def order_spectrum(found: Data) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return speeds in rad/s (m,), orders (n,) and amplitudes of x + iy in m (n, m).

    Sampled at equal angles of the engine, so that an order stays what it is while the speed rises.
    """
    angle, speed = found["engine"].T
    even = np.arange(angle[0], angle[-1], 2.0 * math.pi / SAMPLES)
    times = np.interp(even, angle, found["times"])
    z = CubicSpline(found["times"], centre(found["disc"]))(times)
    window = np.hanning(TURNS * SAMPLES)
    # scipy.signal has this too, but takes longer to load than a run-up to transform.
    first = -(-(len(window) // 2) // HOP) * HOP  # the first middle whose window is within the run-up
    samples = np.lib.stride_tricks.sliding_window_view(z, len(window))[first - len(window) // 2 :: HOP]
    lines = 2 * len(window)
    spectrum = np.fft.fft(samples * (window / np.sum(window)), lines)
    amplitude = np.abs(np.fft.fftshift(spectrum, axes=1)).T
    orders = np.fft.fftshift(np.fft.fftfreq(lines, 1.0 / SAMPLES))
    middles = even[0] + 2.0 * math.pi / SAMPLES * (first + HOP * np.arange(len(samples)))
    return np.interp(middles, angle, speed), orders, amplitude


def strongest_line(found: Data) -> tuple[FloatArray, FloatArray]:
    """Return the speed in rad/s in each window and the order of what circles forwards the most, shape (m,) each.

    A disc that all but rests is left out, by half an order; the top lies between the lines, on a parabola through
    three logarithms.
    """
    speed, orders, amplitude = order_spectrum(found)
    first = int(np.searchsorted(orders, 0.5))
    top = first + np.argmax(amplitude[first:-1], axis=0)
    low, middle, high = (np.log(np.take_along_axis(amplitude, (top + i)[None], 0)[0]) for i in (-1, 0, 1))
    return speed, orders[top] + (orders[1] - orders[0]) * 0.5 * (low - high) / (low - 2.0 * middle + high)
