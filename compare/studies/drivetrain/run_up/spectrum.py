"""The order-tracked spectrum of the disc's motion, and its strongest line."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims.study import Data
from compare.studies.drivetrain.run_up.parameters import SAMPLES, TURNS
from compare.studies.toolkit.drivetrain_bench import centre
from reference_model.systems import FloatArray


def order_spectrum(found: Data) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return speeds in rad/s (m,), orders (n,) and amplitudes of x + iy in m (n, m).

    Sampled at equal angles of the engine, so that an order stays what it is while the speed rises.
    """
    from scipy.signal import ShortTimeFFT  # takes long to load, and other studies do without

    angle, speed = found["engine"].T
    even = np.arange(angle[0], angle[-1], 2.0 * math.pi / SAMPLES)
    times = np.interp(even, angle, found["times"])
    z = CubicSpline(found["times"], centre(found["disc"]))(times)
    window = np.hanning(TURNS * SAMPLES)
    transform = ShortTimeFFT(
        window / np.sum(window),
        2 * SAMPLES,
        SAMPLES,
        fft_mode="centered",
        mfft=2 * len(window),
        phase_shift=None,
    )
    first, end = transform.lower_border_end[1], transform.upper_border_begin(len(z))[1]
    amplitude = np.abs(transform.stft(z, p0=first, p1=end))
    middles = even[0] + 2.0 * math.pi * transform.t(len(z), first, end)
    return np.interp(middles, angle, speed), transform.f, amplitude


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
