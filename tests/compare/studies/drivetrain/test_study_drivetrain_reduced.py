"""The drivetrain reduced to a disc agrees with the reference, and finds out parts that are wrong."""

import functools

import numpy as np
from study_harness import BLIND, LEFT_OUT, SEES
from wrong_parts import WrongPartTests

from compare.studies.drivetrain.reduced import claims
from compare.studies.drivetrain.reduced.parameters import CASES, CYCLE, ENDLESS
from exudyn_models.drivetrain import model as drivetrain

FIG8, OF_FIG11, OFFSET, FACING, HARDENING, STOP = CASES


def part_off(part, name, factor):
    """Let a parameter of a part be off by ``factor``."""

    def put(patch):
        add = getattr(drivetrain, part)

        def off(*nodes, **parameters):
            return add(*nodes, **parameters | {name: factor * parameters[name]})

        patch.setattr(drivetrain, part, off)

    return put


def shaft_on_the_wrong_axis(patch):
    add = drivetrain.add_radial_support
    patch.setattr(
        drivetrain,
        "add_radial_support",
        lambda *nodes, **parameters: add(*nodes, **parameters | {"offset": (0.0, parameters["offset"][0])}),
    )


def influence_of_the_inertia(change):
    """Let engine and vehicle of finite inertia change the state by ``change(inertia)``."""

    def put(patch):
        motion = claims.drivetrain_motion
        data = functools.cache(lambda tolerance: motion(CYCLE, tolerance))

        def of_another_order(case, tolerance, inertia=ENDLESS):
            times, states = data(tolerance)
            return times, states + (change(inertia) if inertia < ENDLESS else 0.0)

        patch.setattr(claims, "drivetrain_motion", of_another_order)

    return put


class TestDrivetrainReduced(WrongPartTests):
    study = claims.STUDY
    faults = {
        "load": part_off("add_ring_friction", "normal_load", 1.0 + 1e-6),
        "outer radius": part_off("add_ring_friction", "outer_radius", 1.0 + 1e-6),
        "stiffness": part_off("add_radial_support", "stiffness", 1.0 + 1e-6),
        "damping": part_off("add_radial_support", "damping", 1.0 + 1e-6),
        "hardening": part_off("add_radial_support", "hardening", 1.0 + 1e-5),
        "stop's stiffness": part_off("add_radial_support", "stop_stiffness", 1.0 + 1e-5),
        "stop's gap": part_off("add_radial_support", "stop_gap", 1.0 + 1e-6),
        "shaft on the wrong axis": shaft_on_the_wrong_axis,
        "no influence of the inertia": influence_of_the_inertia(lambda inertia: 0.0),
        "the same influence of every inertia": influence_of_the_inertia(lambda inertia: 1e-4),
        "influence like 1/inertia²": influence_of_the_inertia(lambda inertia: 100.0 * inertia**-2.0),
    }
    columns = (*(f"moves/{name}" for name in (OF_FIG11, OFFSET, FACING, HARDENING, STOP)), "order")
    table = {
        # Off by a millionth or a hundred-thousandth: cycle, offset, facing, hardening, stop; order.
        "load": (SEES, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "outer radius": (LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "stiffness": (SEES, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "damping": (SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "hardening": (LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT),
        "stop's stiffness": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT),
        "stop's gap": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT),
        "shaft on the wrong axis": (BLIND, SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "no influence of the inertia": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
        "the same influence of every inertia": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
        "influence like 1/inertia²": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES),
    }

    def test_the_cases_have_what_their_names_say(self):
        data = self.found("exudyn").data

        def radii(name):
            return np.hypot(*data[f"{name}: states"][:, :2].T)

        assert np.ptp(radii(OF_FIG11)) > 0.01  # modulated
        assert radii(STOP).max() > CASES[STOP].disc.stop_gap
        for name in (OFFSET, FACING, HARDENING, STOP):
            assert np.abs(data[f"{name}: states"][-1] - data[f"{OF_FIG11}: states"][-1]).max() > 1e-3, name
