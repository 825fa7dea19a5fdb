"""``fmu:FILE``: a model for co-simulation (FMI 2 or 3) as an engine, by FMPy.

``docs/judge-your-engine.md`` specifies the names. Models with the outputs of ``stick_events`` report phases; for
others, stick is found from states.
"""

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

from compare.engines.engine import DeclaredLackError, Engine
from compare.engines.outside.stick_events import NAMES_OF_POINTS, Events, PointRests, StickEvents, tells_stick
from compare.engines.registry import Scheme, register_scheme
from reference_model.systems import COLUMNS, DiscOnDisc, FloatArray, PinOnDisc, System
from reference_model.trajectory import Trajectory

POINTS = "contact_points"

NONLINEAR = ("hardening", "stop_gap", "stop_stiffness")
OPTIONAL = ("offset", *NONLINEAR)  # parameters that a model may omit; they are then 0


CREEPS, CREEP, MOST_CREEP = "regularisation", 1e2, 1e-2
"""Parameter for the regularisation speed of points, and the ratio of this speed to tolerance times speed.

The error of the creep must fall with the tolerance.
"""

LEAST_CREEP = 1e-12  # regularisation speed in m/s for a motion without speed
MOST_BYTES = 2**30  # largest size of an unpacked archive


class FmuError(RuntimeError):
    """A model failed; the message says why."""


@dataclass(frozen=True)
class Fmu:
    """The ``simulate`` of a model."""

    file: str

    @property
    def files(self) -> set[Path]:
        """The model's archive."""
        return {Path(self.file)}

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return the motion, with communication steps up to ``step`` (s) if given, else from time to time.

        Raises ``DeclaredLackError`` if the model lacks a parameter, and ``FmuError`` if a call fails.
        """
        name, model = Path(self.file).name, _model(self.file)
        at, state = np.array(times, dtype=float), np.asarray(initial_state, dtype=float)
        values = _values(system, state, model.variables)
        try:
            instance = model.instance()
        except Exception as error:  # from the library, e.g. for another platform
            raise FmuError(f"{name} cannot be started: {_reason(error, model.folder)}") from None
        try:
            return _motion(instance, model, values, system, at, **accuracy)
        except Exception as error:  # FMPy has a class for each version of the standard
            raise FmuError(f"{name}: {_reason(error, model.folder)}") from None
        finally:
            instance.freeInstance()


@dataclass(frozen=True)
class _Model:
    """A model's description, unpacked files and variables; ``folder`` lives as long."""

    description: Any
    folder: tempfile.TemporaryDirectory[str]
    variables: Mapping[str, Any]

    @property
    def newer(self) -> bool:
        """True for FMI 3, which has other names for the same functions."""
        return str(self.description.fmiVersion).startswith("3")

    @property
    def tells_stick(self) -> bool:
        """True if the model reports stick."""
        return tells_stick(self.description, self.variables)

    def events(self, system: System) -> type[Events] | None:
        """Return the class that tracks the phases of ``system``, or None if the model does not report them."""
        if not self.tells_stick:
            return None
        if isinstance(system, DiscOnDisc) and system.contact_points is not None:
            return PointRests if set(NAMES_OF_POINTS) <= set(self.variables) else None
        return StickEvents

    def instance(self) -> Any:
        """Return a new instance, which the caller must free."""
        return _fmpy().instantiate_fmu(self.folder.name, self.description, "CoSimulation")


def _fmpy() -> Any:
    try:
        return importlib.import_module("fmpy.simulation")
    except ImportError as error:
        raise ValueError(f"fmu:FILE needs FMPy; install it with: pip install fmpy ({error})") from None


@functools.cache
def _model(file: str) -> _Model:
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
            raise ValueError(f"FMI {description.fmiVersion}, but co-simulation by FMI 2 or 3 is required")
        fmpy.extract(file, folder.name)
    except Exception as error:  # from the archive, its XML or the contents
        folder.cleanup()
        raise ValueError(f"{name} cannot be used as a model: {_reason(error, folder)}") from None
    return _Model(description, folder, {one.name: one for one in description.modelVariables})


def _reason(error: Exception, folder: tempfile.TemporaryDirectory[str]) -> str:
    return " ".join(str(error).replace(f"{folder.name}{os.sep}", "").split()) or type(error).__name__


def _values(system: System, state: FloatArray, variables: Mapping[str, Any]) -> dict[str, float]:
    parameters = {name: value for name, value in asdict(system).items() if value is not None}
    lacking = [name for name, value in parameters.items() if name not in variables and value != 0.0]
    if lacking:
        raise DeclaredLackError(f"the model lacks {', '.join(lacking)}")
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
    if model.tells_stick and isinstance(system, DiscOnDisc) and system.contact_points is not None:
        values = {**values, **_creep(system, values, model.variables, tolerance)}
    for name, value in values.items():
        variable = model.variables[name]
        whole = "Int" in variable.type  # the number of points has an integer type
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
    """Return the regularisation speed of points in m/s, if it is a parameter."""
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
    """Return the engine "fmu:TEXT"; raise ``ValueError`` if the file is not a model of a system."""
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
    disc = "spin" in variables
    system = DiscOnDisc if disc else PinOnDisc
    needed = [*(field.name for field in fields(system)), *(name for name, _ in COLUMNS[system])]
    lacking = [one for one in needed if one not in variables and one not in (*OPTIONAL, POINTS)]
    if lacking:
        raise ValueError(
            f"{name} is not a model of a {'disc' if disc else 'pin'}: it lacks {', '.join(lacking)}"
        )
    if not disc:
        return ("pin",)
    if POINTS not in variables:
        return ("ring",)
    least = getattr(variables[POINTS], "min", None)
    return ("ring", "points") if least is not None and float(least) <= 0.0 else ("points",)


register_scheme("fmu", Scheme(fmu_engine, fmu_engine))
