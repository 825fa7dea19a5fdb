"""A clutch disc centres itself, shown in Exudyn's own viewer: ``python examples/14_in_exudyns_viewer.py --view``.

The example prints the final position. Pass a path to save a picture that the viewer renders.
"""

import sys
from pathlib import Path

import exudyn as exu
import exudyn.graphics as graphics
from exudyn.itemInterface import (
    Node1D,
    NodeRigidBody2D,
    ObjectGround,
    ObjectRigidBody2D,
    ObjectRotationalMass1D,
    VObjectGround,
    VObjectRigidBody2D,
)
from exudyn.utilities import RotationMatrixX

from exudyn_models import add_radial_support, add_ring_friction, solve_dynamic

RADIUS, OFFSET = 0.1, 0.04  # m

container = exu.SystemContainer()
mbs = container.AddSystem()
plate = graphics.Cylinder([0.0, 0.0, -0.02], [0.0, 0.0, 0.01], 0.2, graphics.color.steelblue, nTiles=64)
start = graphics.Cylinder(
    [OFFSET, 0.0, 0.0], [0.0, 0.0, 0.05], 0.004, graphics.color.red
)  # of the disc's centre
mbs.AddObject(ObjectGround(visualization=VObjectGround(graphicsData=[plate, start])))
flywheel = mbs.AddNode(Node1D(initialVelocities=[30.0]))
mbs.AddObject(ObjectRotationalMass1D(nodeNumber=flywheel, inertia=1e3))
disc = mbs.AddNode(NodeRigidBody2D(initialCoordinates=[OFFSET, 0.0, 0.0]))
drawn = [
    graphics.Cylinder([0.0, 0.0, 0.0], [0.0, 0.0, 0.02], RADIUS, graphics.color.orange, nTiles=64),
    graphics.Cylinder([0.0, 0.0, 0.02], [0.0, 0.0, 0.04], 0.006, graphics.color.black),  # its centre
    graphics.Brick(
        [RADIUS / 2.0, 0.0, 0.022], [RADIUS, 0.01, 0.005], graphics.color.black
    ),  # shows the rotation
]
mbs.AddObject(
    ObjectRigidBody2D(
        nodeNumber=disc, mass=0.6, inertia=0.01, visualization=VObjectRigidBody2D(graphicsData=drawn)
    )
)
add_radial_support(mbs, None, disc, stiffness=4e3, damping=20.0, offset=(OFFSET, 0.0))
add_ring_friction(
    mbs,
    flywheel,
    disc,
    contact_radius=RADIUS,
    friction_coefficient=0.3,
    normal_load=480.0,
    regularisation=1e-2,
)
mbs.Assemble()
settings = exu.SimulationSettings()
settings.solution.file.write = False
options = settings.timeIntegration
options.verboseMode, options.endTime, options.numberOfSteps = 0, 1.0, 1000


def final_position():
    """Run the model and return the final position of the disc's centre in m: (3) of the paper with μN = 144 N."""
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)
    return mbs.GetNodeOutput(disc, exu.OutputVariableType.Position)[:2]


def render(path):
    """Save a picture from Exudyn's viewer, which needs a display (on a server: ``xvfb-run``)."""
    look = container.visualizationSettings
    look.exportImages.saveImageFileName = str(Path(path).with_suffix(""))
    look.exportImages.saveImageSingleFile = True
    look.view0.window.renderWindowSize = [640, 400]
    look.general.autoFitScene = False
    look.connectors.show = False
    look.openGL.advanced.initialZoom = 0.25
    look.openGL.advanced.initialModelRotation = RotationMatrixX(-0.8).tolist()  # rad, a view at an angle
    container.renderer.Start()
    shown = exu.ConfigurationType.Visualization
    mbs.systemData.SetODE2Coordinates(mbs.systemData.GetODE2Coordinates(), shown)
    mbs.systemData.SetTime(options.endTime, shown)
    container.renderer.DoIdleTasks(0.5)
    container.renderer.RedrawAndSaveImage()
    container.renderer.Stop()


if __name__ == "__main__":
    if "--view" in sys.argv:
        options.simulateInRealtime = True
        container.renderer.Start()
    x, y = final_position()
    print(f"the disc's centre is at ({1e3 * x:.2f}, {1e3 * y:.2f}) mm; it started at {1e3 * OFFSET:.0f} mm")
    if "--view" in sys.argv:
        container.renderer.DoIdleTasks()
        container.renderer.Stop()
    elif len(sys.argv) > 1:
        render(sys.argv[1])
