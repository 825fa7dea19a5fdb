"""Error of explicit coupling of a clutch unit against the communication step, and chatter of a holding clutch.

Run with ``python benchmarks/unit_coupling.py``; prints the numbers of ``docs/fmu.md`` within a few seconds.
"""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

from fmu_models import CLUTCH, export

INERTIAS = np.array([0.5, 0.3])
"""Moments of inertia of the flanges in kg m²."""

COEFFICIENT, LOAD, RADIUS = 0.3, 600.0, 0.1

STEPS = (0.01, 0.005, 0.0025, 0.00125)
"""Communication steps in s."""

Load = Callable[[float], float]


class Unit:
    """A clutch unit in co-simulation."""

    def __init__(self, folder: str, **parameters: float) -> None:
        file = export(
            CLUTCH.starting(friction_coefficient=COEFFICIENT, **parameters), Path(folder) / "clutch.fmu"
        ).file
        self.description: Any = fmpy.read_model_description(str(file))
        self.instance = fmpy.instantiate_fmu(
            fmpy.extract(str(file), folder), self.description, "CoSimulation"
        )
        self.places = {one.name: one.valueReference for one in self.description.modelVariables}

    def speeds(
        self, step: float, until: float, start: tuple[float, float], drive: float, load: Load
    ) -> np.ndarray:
        """Return the speeds of the flanges at all communication points, shape (n + 1, 2)."""
        inputs = [self.places[one] for one in ("speed_a", "speed_b", "normal_load")]
        outputs = [self.places[one] for one in ("torque_a", "torque_b")]
        self.instance.reset()
        self.instance.setupExperiment(startTime=0.0)
        self.instance.enterInitializationMode()
        self.instance.exitInitializationMode()
        found = np.empty((round(until / step) + 1, 2))
        found[0] = start
        for i in range(len(found) - 1):
            self.instance.setReal(inputs, [*found[i], load(i * step)])
            torques = np.array(self.instance.getReal(outputs)) + np.array([drive, 0.0])
            self.instance.doStep(i * step, step)
            found[i + 1] = found[i] + step * torques / INERTIAS
        return found


def main() -> None:
    """Print the tables."""
    with tempfile.TemporaryDirectory() as folder:
        unit = Unit(folder)
        ends = [
            unit.speeds(h, 0.4, (100.0, 0.0), 20.0, lambda t: LOAD * min(1.0, t / 0.2))[-1] for h in STEPS
        ]
        # at the friction limit, the torque follows from the load, which is integrated in closed form
        given = COEFFICIENT * LOAD * RADIUS * (0.4 - 0.1)
        exact = np.array([100.0 + (20.0 * 0.4 - given) / INERTIAS[0], given / INERTIAS[1]])
        for step, end in zip(STEPS, ends, strict=True):
            print(f"{1e3 * step:g} ms: {np.max(np.abs(end - exact)):.3g} rad/s")
    step, friction = 1e-3, COEFFICIENT * LOAD
    bound = 0.5 * step * friction * RADIUS**2 * float(np.sum(1.0 / INERTIAS))
    for share in (0.9, 1.1):
        with tempfile.TemporaryDirectory() as folder:
            unit = Unit(folder, regularisation=share * bound)
            late = unit.speeds(step, 2.0, (10.0, 10.05), 0.0, lambda t: LOAD)[-100:]
            chatter = np.ptp(late[:, 0] - late[:, 1])
            print(f"ε = {share:g} of {1e3 * bound:.3g} mm/s: {chatter:.2g} rad/s of chatter")


if __name__ == "__main__":
    main()
