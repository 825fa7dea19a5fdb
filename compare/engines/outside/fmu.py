"""``fmu:FILE``: a model for co-simulation by the standards FMI 2 and 3 as an engine, by FMPy.

Its parameters are called as those of the systems, and its outputs as their states: x, y, vx, vy, and angle and spin
of a disc. A motion starts with ``x_start`` where there is such a variable, else with x itself, and so do the others.
Phases are told by models that have the outputs of ``stick_events``; for all others stick is found from states.
"""

from __future__ import annotations

import functools
import importlib
import itertools
import math
import os
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.engine import Engine, UnsupportedSystemError
from compare.engines.outside.stick_events import NAMES_OF_POINTS, Events, PointRests, StickEvents, tells_stick
from compare.engines.registry import Scheme, register_scheme
from reference_model.systems import COLUMNS, DiscOnDisc, FloatArray, PinOnDisc, System
from reference_model.trajectory import Trajectory

POINTS = "contact_points"

NONLINEAR = ("hardening", "stop_gap", "stop_stiffness")

OPTIONAL = ("offset", *NONLINEAR)
"""Parameters that a model may leave out: then they are 0."""


CREEPS, CREEP, MOST_CREEP = "regularisation", 1e2, 1e-2
"""The parameter with the slip speed below which points creep, and that over tolerance times speed of the motion.

A model that tells when its contact sticks does so for pins and rings. Errors of creep have to fall with tolerance.
"""

LEAST_CREEP = 1e-12
"""In m/s: of a motion without any speed."""

MOST_BYTES = 2**30
"""Largest size of an unpacked archive; models of pins and discs are far smaller."""


class FmuError(RuntimeError):
    """A model has no answer; the message says why."""


@dataclass(frozen=True)
class Fmu:
    """The ``simulate`` of a model.

    Parameters
    ----------
    file : str
        Where it is.

    """

    file: str

    @property
    def files(self) -> set[Path]:
        """The archive: all that the model consists of."""
        return {Path(self.file)}

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return the motion, in communication steps of at most the step in s, or from one time to the next.

        Raises
        ------
        UnsupportedSystemError
            If the system has a parameter that the model has not.
        FmuError
            If a call of the model fails.

        """
        name, model = Path(self.file).name, _model(self.file)
        at, state = np.array(times, dtype=float), np.asarray(initial_state, dtype=float)
        values = _values(system, state, model.variables)
        try:
            instance = model.instance()
        except (
            Exception
        ) as error:  # of the library: for another platform, or without what a model has to have
            raise FmuError(f"cannot start {name}: {_reason(error, model.folder)}") from None
        try:
            return _motion(instance, model, values, system, at, **accuracy)
        except Exception as error:  # of FMPy, which has one class for each version of the standard
            raise FmuError(f"{name}: {_reason(error, model.folder)}") from None
        finally:
            instance.freeInstance()


@dataclass(frozen=True)
class _Model:
    """What is known of a model, and where its files are; ``folder`` is removed with this."""

    description: Any
    folder: tempfile.TemporaryDirectory[str]
    variables: Mapping[str, Any]

    @property
    def newer(self) -> bool:
        """Whether it is of FMI 3, which calls the same things by other names."""
        return str(self.description.fmiVersion).startswith("3")

    @property
    def tells_stick(self) -> bool:
        """Whether it tells when its contact sticks."""
        return tells_stick(self.description, self.variables)

    def events(self, system: System) -> type[Events] | None:
        """Return what follows its phases, if it tells those of a system."""
        if not self.tells_stick:
            return None
        if isinstance(system, DiscOnDisc) and system.contact_points is not None:
            return PointRests if set(NAMES_OF_POINTS) <= set(self.variables) else None
        return StickEvents

    def instance(self) -> Any:
        """Return a new instance, which has to be freed."""
        return _fmpy().instantiate_fmu(self.folder.name, self.description, "CoSimulation")


def _fmpy() -> Any:
    """Return FMPy, which is loaded only when a model is asked for."""
    try:
        return importlib.import_module("fmpy.simulation")
    except ImportError as error:
        raise ValueError(f"fmu:FILE needs FMPy, pip install 'friction-discs[fmu]': {error}") from None


@functools.cache
def _model(file: str) -> _Model:
    """Return the model of a file, unpacked; raise ``ValueError`` if it cannot be used."""
    _fmpy()
    fmpy, name = importlib.import_module("fmpy"), Path(file).name
    folder = tempfile.TemporaryDirectory(prefix="friction-discs-")
    try:
        with zipfile.ZipFile(file) as archive:
            size = sum(member.file_size for member in archive.infolist())
        if size > MOST_BYTES:
            raise ValueError(f"it would unpack to {size:.3g} bytes, the limit is {MOST_BYTES:.3g}")
        description = fmpy.read_model_description(file)
        if description.coSimulation is None or not str(description.fmiVersion).startswith(("2", "3")):
            raise ValueError(f"FMI {description.fmiVersion}, but it must be for co-simulation by FMI 2 or 3")
        fmpy.extract(file, folder.name)
    except Exception as error:  # of the archive, of its XML, or of what stands in it
        folder.cleanup()
        raise ValueError(f"{name} cannot be used as a model: {_reason(error, folder)}") from None
    return _Model(description, folder, {one.name: one for one in description.modelVariables})


def _reason(error: Exception, folder: tempfile.TemporaryDirectory[str]) -> str:
    """Return the message of an error in one line, with paths relative to ``folder``."""
    return " ".join(str(error).replace(f"{folder.name}{os.sep}", "").split()) or type(error).__name__


def _values(system: System, state: FloatArray, variables: Mapping[str, Any]) -> dict[str, float]:
    """Return what to set: parameters of the system, and the start."""
    parameters = {name: value for name, value in asdict(system).items() if value is not None}
    lacking = [name for name, value in parameters.items() if name not in variables and value != 0.0]
    if lacking:
        raise UnsupportedSystemError(f"the model has no {', '.join(lacking)}")
    starts = zip((name for name, _ in COLUMNS[type(system)]), state.tolist(), strict=True)
    known = {name: value for name, value in parameters.items() if name in variables}
    if isinstance(system, DiscOnDisc) and POINTS in variables:
        known[POINTS] = system.contact_points or 0
    return known | {
        f"{name}_start" if f"{name}_start" in variables else name: value for name, value in starts
    }


def _motion(
    instance: Any,
    model: _Model,
    values: Mapping[str, float],
    system: System,
    times: FloatArray,
    tolerance: float | None = None,
    step: float = math.inf,
) -> Trajectory:
    """Return the motion at ``times`` (n,) of an instance that was not asked before."""
    if model.tells_stick and isinstance(system, DiscOnDisc) and system.contact_points is not None:
        values = {**values, **_creep(system, values, model.variables, tolerance)}
    for name, value in values.items():
        variable = model.variables[name]
        whole = "Int" in variable.type  # the number of points, by any of the standard's types
        getattr(instance, f"set{variable.type}")(
            [variable.valueReference], [int(value) if whole else float(value)]
        )
    if model.newer:
        instance.enterInitializationMode(tolerance=tolerance, startTime=times[0])
    else:
        instance.setupExperiment(tolerance=tolerance, startTime=times[0])
        instance.enterInitializationMode()
    instance.exitInitializationMode()
    get = instance.getFloat64 if model.newer else instance.getReal
    outputs = [model.variables[name].valueReference for name, _ in COLUMNS[type(system)]]
    states = np.empty((len(times), len(outputs)))
    states[0] = get(outputs)
    told_by = model.events(system)
    events = (
        None
        if told_by is None
        else told_by(instance, model.variables, system, times[0], states[0], newer=model.newer)
    )
    advance = (lambda at, until: instance.doStep(at, until - at)) if events is None else events.step
    for i, (start, end) in enumerate(itertools.pairwise(times), 1):
        bounds = np.linspace(start, end, max(1, math.ceil((end - start) / step)) + 1)
        for at, until in itertools.pairwise(bounds):
            advance(at, until)
        states[i] = get(outputs)
    instance.terminate()
    return Trajectory(system, times, states, () if events is None else events.phases(times[-1]))


def _creep(
    system: DiscOnDisc, values: Mapping[str, float], variables: Mapping[str, Any], tolerance: float | None
) -> dict[str, float]:
    """Return below which slip speed in m/s points creep, in proportion to the tolerance, if the model takes that."""
    if CREEPS not in variables or tolerance is None:
        return {}
    x, y, _, vx, vy, spin = (
        values.get(f"{name}_start", values.get(name, 0.0)) for name, _ in COLUMNS[DiscOnDisc]
    )
    radius = system.contact_radius
    turning = max(abs(system.disc_speed) * max(math.hypot(x, y), radius), abs(spin) * radius)
    creep = min(CREEP * tolerance, MOST_CREEP) * max(math.hypot(vx, vy), turning)
    return {CREEPS: max(creep, LEAST_CREEP)}


def fmu_engine(text: str) -> Engine:
    """Return the engine "fmu:TEXT"; raise ``ValueError`` if the file is no model of a system."""
    file = Path(text).resolve()
    if not file.is_file():
        raise ValueError(f"fmu:{text}: file not found")
    model = _model(str(file))
    kinds = _kinds(file.name, model.variables)
    experiment = model.description.defaultExperiment
    step = None if experiment is None or experiment.stepSize is None else float(experiment.stepSize)
    nonlinear = set(NONLINEAR) <= set(model.variables)
    return Engine(file.stem, Fmu(str(file)), kinds, nonlinear=nonlinear, phases=model.tells_stick, step=step)


def _kinds(name: str, variables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the kinds of systems that variables of these names are those of."""
    disc = "spin" in variables
    system = DiscOnDisc if disc else PinOnDisc
    needed = [*(field.name for field in fields(system)), *(name for name, _ in COLUMNS[system])]
    lacking = [one for one in needed if one not in variables and one not in (*OPTIONAL, POINTS)]
    if lacking:
        raise ValueError(
            f"{name} is no model of a {'disc' if disc else 'pin'}: it has no {', '.join(lacking)}"
        )
    if not disc:
        return ("pin",)
    if POINTS not in variables:
        return ("ring",)
    least = getattr(variables[POINTS], "min", None)
    return ("ring", "points") if least is not None and float(least) <= 0.0 else ("points",)


register_scheme("fmu", Scheme(fmu_engine, fmu_engine))
