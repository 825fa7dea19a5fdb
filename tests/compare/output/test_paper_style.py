"""Figures do not depend on the user's settings of matplotlib."""

import matplotlib

from compare.output.figures import axis, new_figure, paper_style, saved


def drawn():
    with paper_style():
        figure, (panel,) = new_figure()
        panel.plot([0.0, 1.0], [1.0, 0.0], label="line")
        panel.set(xlabel=axis("x", "m"), title="Title")
        panel.legend()
    return saved(figure)


def test_figures_use_the_defaults_of_matplotlib_in_place_of_the_users_settings():
    own = {
        "text.usetex": True,
        "axes.facecolor": "red",
        "font.family": "no such font",
        "path.sketch": (9.0, 9.0, 9.0),
    }
    plain = drawn()
    with matplotlib.rc_context(own):
        assert drawn() == plain
        assert matplotlib.rcParams["axes.facecolor"] == "red"
