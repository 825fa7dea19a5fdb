"""Installed foreign engines by name, for example ``mujoco`` or ``mujoco:pyramid``."""

import functools
import importlib
from importlib.metadata import version
from typing import NamedTuple

from compare.engines.engine import Engine
from compare.engines.registry import ByName, Scheme, register_scheme
from compare.output.outside_text import one_of

EVERYWHERE = "Linux, macOS and Windows"


class Installed(NamedTuple):
    """An engine with its official name, its settings, its Python package, and the platforms that have wheels.

    The first setting is the default.
    """

    title: str
    settings: tuple[str, ...]
    package: str
    wheels: str = EVERYWHERE


INSTALLED = {
    "mujoco": Installed(
        "MuJoCo",
        (
            *("ellipse", "ellipse-rk4", "elliptic", "pyramid", "shipped"),
            *("condim-4", "condim-6", "condim-4-shipped", "our-force"),
        ),
        "mujoco",
    ),
    "bullet": Installed(
        "Bullet",
        ("cone", "box", "shipped", "spinning", "our-force"),
        "pybullet",
        "Linux; elsewhere pip compiles it",
    ),
    "drake": Installed(
        "Drake",
        ("tamsi", "sap", "lagged", "hydroelastic", "cenic", "runge-kutta", "our-force"),
        "drake",
        "Linux, and macOS with newer Pythons; none for Windows",
    ),
    "dart": Installed(
        "DART",
        ("nsgs", "fbf", "dantzig", "pgs", "shipped", "our-force"),
        "dartpy",
        "Linux, and from Python 3.12 on macOS and Windows",
    ),
    "chipmunk": Installed("Chipmunk", ("pivot", "shipped", "gear"), "pymunk"),
    "box2d": Installed("Box2D", ("friction-joint", "shipped", "torque"), "box2d"),
    "ode": Installed(
        "ODE",
        ("along-slip", "shipped"),
        "Py3ODE",
        "no platform, but Debian and Ubuntu have the package python3-pyode",
    ),
    "newton": Installed("Newton", ("xpbd", "semi-implicit"), "newton"),
}
"""Engines by their names on the command line; the adapter's module is ``<name>_engine``."""


def installed_engine(name: str, setting: str) -> Engine:
    """Return the engine ``name`` with this setting, "" for the default; raise ``ValueError`` if not installed."""
    known, setting = INSTALLED[name], _known_setting(name, setting)
    module, function = f"{__package__}.{name}_engine", setting.replace("-", "_")
    try:
        adapter = importlib.import_module(module)
    except ImportError as error:
        raise ValueError(
            f"engine {name!r}: {known.title} is not installed ({error}): pip install {known.package}; "
            f"wheels exist for {known.wheels}"
        ) from None
    simulate = getattr(adapter, function)
    return Engine(
        f"{name}:{setting}" if setting != known.settings[0] else name,
        ByName(module, function),
        kinds=simulate.kinds,
        nonlinear=not simulate.model.linear,
        phases=False,
        precision=simulate.precision,
        step=simulate.step,
        version=version(known.package),
        about=f"{known.title} {simulate.says}",
    )


def _known_setting(name: str, setting: str) -> str:
    settings = INSTALLED[name].settings
    return one_of(f"setting of {name}", setting, settings) if setting else settings[0]


for _name in INSTALLED:
    register_scheme(
        _name,
        Scheme(
            functools.partial(installed_engine, _name), functools.partial(_known_setting, _name), alone=True
        ),
    )
