"""Installed foreign engines by name, for example ``mujoco`` or ``mujoco:pyramid``."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version

from compare.engines.engine import Engine
from compare.engines.registry import ByName, Scheme, register_scheme
from compare.output.outside_text import one_of

KINDS = ("pin", "points")
"""Systems that these engines simulate, as in ``compare.engines.KINDS``."""


@dataclass(frozen=True)
class Installed:
    """An engine provided by a Python package.

    Parameters
    ----------
    title : str
        The engine's official name.
    package : str
        The package for pip.
    wheels : str
        Platforms with wheels.
    settings : mapping
        The adapter's function for each setting, by its short name; the first is the default.

    """

    title: str
    package: str
    wheels: str
    settings: Mapping[str, str]


INSTALLED = {
    "mujoco": Installed(
        "MuJoCo",
        "mujoco",
        "Linux, macOS and Windows",
        {
            "ellipse": "simulate_elliptic",
            "ellipse-rk4": "simulate_elliptic_rk4",
            "pyramid": "simulate_pyramidal",
            "shipped": "simulate_as_shipped",
            "our-force": "simulate_with_our_force",
        },
    ),
    "bullet": Installed(
        "Bullet",
        "pybullet",
        "Linux; elsewhere pip compiles it",
        {
            "cone": "simulate_with_cone",
            "box": "simulate_with_box",
            "shipped": "simulate_as_shipped",
            "our-force": "simulate_with_our_force",
        },
    ),
    "drake": Installed(
        "Drake",
        "drake",
        "Linux, and macOS with newer Pythons; none for Windows",
        {
            "tamsi": "simulate_tamsi",
            "sap": "simulate_sap",
            "lagged": "simulate_lagged",
            "cenic": "simulate_cenic",
            "runge-kutta": "simulate_runge_kutta",
            "our-force": "simulate_with_our_force",
        },
    ),
    "dart": Installed(
        "DART",
        "dartpy",
        "Linux, and from Python 3.12 on macOS and Windows",
        {
            "nsgs": "simulate_nsgs",
            "fbf": "simulate_fbf",
            "dantzig": "simulate_dantzig",
            "pgs": "simulate_pgs",
            "shipped": "simulate_as_shipped",
            "our-force": "simulate_with_our_force",
        },
    ),
    "chipmunk": Installed(
        "Chipmunk",
        "pymunk",
        "Linux, macOS and Windows",
        {"pivot": "simulate_with_pivots", "shipped": "simulate_as_shipped"},
    ),
    "box2d": Installed(
        "Box2D",
        "box2d",
        "Linux, macOS and Windows",
        {"friction-joint": "simulate_with_friction_joints", "shipped": "simulate_as_shipped"},
    ),
    "newton": Installed(
        "Newton",
        "newton",
        "Linux, macOS and Windows",
        {"xpbd": "simulate_xpbd", "semi-implicit": "simulate_semi_implicit"},
    ),
}
"""Engines by their names on the command line; the adapter's module is ``<name>_engine``."""


def installed_engine(name: str, setting: str) -> Engine:
    """Return the engine ``name`` with this setting, "" for the default; raise ``ValueError`` if not installed."""
    known = INSTALLED[name]
    setting = _known_setting(name, setting)
    module = f"{__package__}.{name}_engine"
    try:
        adapter = importlib.import_module(module)
    except ImportError as error:
        raise ValueError(
            f"engine {name!r}: {known.title} is not installed ({error}): pip install {known.package}; "
            f"wheels exist for {known.wheels}"
        ) from None
    simulate = getattr(adapter, known.settings[setting])
    return Engine(
        f"{name}:{setting}" if setting != next(iter(known.settings)) else name,
        ByName(module, known.settings[setting]),
        kinds=KINDS,
        nonlinear=not simulate.linear,
        phases=False,
        precision=simulate.precision,
        step=simulate.step,
        version=version(known.package),
        about=f"{known.title} {simulate.says}",
    )


def _known_setting(name: str, setting: str) -> str:
    settings = INSTALLED[name].settings
    return one_of(f"setting of {name}", setting, settings) if setting else next(iter(settings))


for _name in INSTALLED:
    register_scheme(
        _name,
        Scheme(
            functools.partial(installed_engine, _name), functools.partial(_known_setting, _name), alone=True
        ),
    )
