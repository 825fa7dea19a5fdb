"""A three-dimensional picture of a drivetrain by Exudyn's ray tracer, which needs no display.

The clutch cover is cut open, and radial motion is enlarged because a tenth of a millimetre would be invisible.
"""

import functools
import math
from collections.abc import Sequence
from typing import Any

import exudyn as exu
import exudyn.graphics
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from exudyn_models.drivetrain.parameters import Drivetrain
from exudyn_models.solver.items import items
from reference_model.systems import FloatArray

graphics: Any = exudyn.graphics  # its type hints reject valid calls

Image = NDArray[np.uint8]

Colour = tuple[float, float, float, float]

IRON, STEEL = (0.40, 0.43, 0.48, 1.0), (0.72, 0.74, 0.78, 1.0)
LINING, BRASS = (0.80, 0.42, 0.16, 1.0), (0.95, 0.75, 0.25, 1.0)

SHAFT = 0.11
"""Ratio of the shaft's radius to the disc's."""

BEARING = 1.5
"""Ratio of the bearing's distance to the disc's radius."""

VIEW = Rotation.from_euler("yx", [-0.85, 0.4])
"""Orientation of the model: engine in the back on the right, gearbox in front on the left."""

SPRINGS = 6

COVERED = 1.25 * math.pi
"""Drawn part of the cover in rad."""


def draw_drivetrain(
    drivetrain: Drivetrain,
    *,
    engine_angle: float,
    disc: ArrayLike,
    magnification: float,
    size: tuple[int, int] = (640, 480),
) -> Image:
    """Return a picture of flywheel, clutch disc and shaft, shape (height, width, 3).

    ``engine_angle`` is in rad; ``disc`` contains x, y in m and the angle in rad. ``magnification`` multiplies x, y,
    the offset and the clearance of the shaft. ``size`` is in pixels.
    """
    outer = drivetrain.outer_radius
    x, y, angle = np.asarray(disc, dtype=float).tolist()
    place = np.array([magnification * x, magnification * y, 0.0])
    bearing = np.array([magnification * drivetrain.offset, 0.0, BEARING * outer])
    tilt, _ = Rotation.align_vectors([bearing - place], [[0.0, 0.0, 1.0]])
    engine_parts, disc_parts, shaft, housing = _parts(drivetrain, magnification * drivetrain.stop_gap)
    return _rendered(
        [
            *(_moved(part, np.zeros(3), engine_angle) for part in engine_parts),
            *(_moved(part, place, angle) for part in disc_parts),
            graphics.Move(shaft, place.tolist(), tilt.as_matrix()),
            _moved(housing, bearing, 0.0),
        ],
        3.0 * outer,
        [0.0, 0.0, 0.35 * outer],
        size,
    )


@functools.lru_cache(maxsize=4)
def _parts(drivetrain: Drivetrain, play: float) -> tuple[tuple[Any, ...], tuple[Any, ...], Any, Any]:
    """Return the parts on the engine and on the disc, shaft and bearing; the shaft has its length without tilt."""
    outer, inner, shaft = drivetrain.outer_radius, drivetrain.inner_radius, SHAFT * drivetrain.outer_radius
    on_engine = (
        _ring(1.25 * outer, play + shaft, -0.3 * outer, -0.04 * outer, IRON),
        _ring(1.3 * outer, 1.2 * outer, -0.24 * outer, -0.14 * outer, STEEL),
        _sector(1.25 * outer, 1.12 * outer, -0.04 * outer, 0.3 * outer, IRON),
        _sector(1.12 * outer, 0.8 * outer, 0.24 * outer, 0.3 * outer, IRON),
    )
    on_disc = (
        _ring(outer, inner, -0.03 * outer, 0.03 * outer, LINING),
        _ring(inner, 1.2 * shaft, -0.012 * outer, 0.012 * outer, STEEL),
        _ring(2.0 * shaft, shaft, -0.1 * outer, 0.1 * outer, STEEL),
        *(_spring(0.45 * outer, 2.0 * math.pi * i / SPRINGS, 0.07 * outer) for i in range(SPRINGS)),
    )
    through, bearing = -0.15 * BEARING * outer, BEARING * outer
    on_axis = graphics.Cylinder(
        [0.0, 0.0, through], [0.0, 0.0, bearing - through], SHAFT * outer, list(STEEL), nTiles=48
    )
    housing = _ring(2.2 * SHAFT * outer, SHAFT * outer, -0.15 * outer, 0.0, IRON)
    return on_engine, on_disc, on_axis, housing


def _ring(outer: float, inner: float, low: float, high: float, colour: Colour) -> Any:
    return graphics.Cylinder(
        [0.0, 0.0, low], [0.0, 0.0, high - low], outer, list(colour), radiusInner=inner, nTiles=64
    )


def _sector(outer: float, inner: float, low: float, high: float, colour: Colour) -> Any:
    around = np.exp(1j * np.linspace(0.0, COVERED, 64))
    edge = np.concatenate((outer * around, inner * around[::-1]))
    corners = len(edge)
    return graphics.SolidExtrusion(
        vertices=np.column_stack((edge.real, edge.imag)).tolist(),
        segments=[[i, (i + 1) % corners] for i in range(corners)],
        height=high - low,
        pOff=[0.0, 0.0, low],
        color=list(colour),
    )


def _spring(radius: float, angle: float, thickness: float) -> Any:
    middle, along = radius * np.exp(1j * angle), 1j * np.exp(1j * angle)
    length = 3.0 * thickness
    start = middle - 0.5 * length * along
    return graphics.Cylinder(
        [start.real, start.imag, 0.0],
        [length * along.real, length * along.imag, 0.0],
        thickness,
        list(BRASS),
        nTiles=32,
    )


def _moved(part: Any, place: FloatArray, angle: float) -> Any:
    return graphics.Move(part, place.tolist(), Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix())


def _rendered(parts: list[Any], height: float, centre: Sequence[float], size: tuple[int, int]) -> Image:
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.AddObject(items.ObjectGround(visualization=items.VObjectGround(graphicsData=parts)))
    mbs.Assemble()
    settings: Any = container.visualizationSettings
    settings.general.backgroundColor = [1.0, 1.0, 1.0, 1.0]
    settings.raytracer.numberOfThreads = 1  # more would cost more time than they save
    view = settings.view0
    view.window.renderWindowSize = list(size)
    view.window.showComputationInfo = False
    view.scene.drawCoordinateSystem = False
    start = settings.openGL.advanced  # the ray tracer's camera, until the first picture exists
    start.initialModelRotation = VIEW.as_matrix().T.tolist()
    start.initialCenterPoint = list(centre)
    start.initialZoom = start.initialMaxSceneSize = 0.5 * height
    return np.array(container.renderer.RedrawAndGetImage(useRaytracer=True))
