"""The study of the connectors agrees, and finds out a reaction without its arm and a wrong linearisation."""

from dataclasses import replace
from functools import partial

import numpy as np
from study_harness import BLIND, SEES
from wrong_parts import WrongPartTests

import exudyn_models
from compare.studies.engines.connector.claims import STUDY
from exudyn_models.forces import user_functions
from exudyn_models.forces.jit import taking_lists


def reaction_without_the_arm_of_the_force(patch):
    def without_arm(law, *arguments):
        result = law(*arguments)
        if np.ndim(result) > 1:  # the Jacobian stays as it is
            return result
        *on_master, _, fx, fy, moment = result
        return *on_master, -moment, fx, fy, moment

    patch.setattr(
        user_functions, "taking_lists", lambda law, *sizes: partial(without_arm, taking_lists(law, *sizes))
    )


def linearisation_of_another_damping(patch):
    eigenvalues = exudyn_models.eigenvalues
    patch.setattr(
        exudyn_models,
        "eigenvalues",
        lambda system, state: eigenvalues(replace(system, damping=system.damping * (1.0 + 1e-6)), state),
    )


class TestConnector(WrongPartTests):
    study = STUDY
    sound = ("exudyn", "exudyn-native")
    # The built-in contact has single points only, and Exudyn linearises it by differences.
    not_claimed = {"exudyn-native": ("ring", "linearised")}
    faults = {
        "reaction without its arm": reaction_without_the_arm_of_the_force,
        "linearisation of another damping": linearisation_of_another_damping,
    }
    columns = ("ring", "six_points", "linearised")
    table = {
        "reaction without its arm": (SEES, SEES, BLIND),
        "linearisation of another damping": (BLIND, BLIND, SEES),
    }

    def test_the_built_in_contact_says_what_is_missing_and_has_its_figure(self):
        found = self.found("exudyn-native")
        assert found.not_simulated == (
            "the built-in contact has single points only, and Exudyn linearises it by differences"
        )
        assert set(STUDY.draw({"exudyn-native": found.data})) == set(STUDY.figures)

    def test_the_discs_slip_all_the_time_and_exchange_momentum(self):
        each = self.found("exudyn").data["six points: angular momenta"]
        assert abs(each[-1, 0] - each[0, 0]) > 0.1
