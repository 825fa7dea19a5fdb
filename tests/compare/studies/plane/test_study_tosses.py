"""The study of tosses: wrong laws of friction are named by claims, and its formulas agree with another way."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import dblquad, trapezoid
from studies_under_test import AGREES, DIFFERS, theory_of, verdicts

from compare.claims.validation import EXPECTED
from compare.engines import EVERY_KIND, Engine
from compare.studies.plane.tosses import STUDY, study, theory
from reference_model.trajectory import Phase, Solution, Trajectory

TEXT = STUDY.prose.paper


# --- Laws of friction in an engine of this test


def coulomb(slips, spin, places):
    return -slips / np.maximum(np.abs(slips), 1e-3)


def box(share):
    def law(slips, spin, places):
        limited = [np.clip(part / 1e-3, -1.0, 1.0) for part in (slips.real, slips.imag)]
        return (1.0 - share) * coulomb(slips, spin, places) - share * (limited[0] + 1j * limited[1])

    return law


def pyramid(slips, spin, places):
    along = np.abs(slips.real) > np.abs(slips.imag)
    return np.where(along, -np.clip(slips.real / 1e-3, -1, 1), -1j * np.clip(slips.imag / 1e-3, -1, 1))


def falling(slips, spin, places):
    """Fall by 10 % from the mean of the speeds below 0.24 m/s to that of the speeds above."""
    return coulomb(slips, spin, places) * (1.0 - 0.1 * (np.abs(slips) - 0.18) / 0.2)


def apart(slips, spin, places):
    """Resist sliding with μN and spinning with μN times the radius, whatever the other does."""
    sliding = coulomb(np.mean(slips, axis=1, keepdims=True), spin, places)
    return sliding - 1j * np.clip(spin / 1e-2, -1.0, 1.0)[:, None] * places / np.abs(places)


def sliding_by(law):
    """Return an engine for discs on points that slide freely, by Runge-Kutta steps of all discs at once."""

    def simulate_many(systems, starts, times, *, tolerance=1e-6):
        first, spans = np.array([each[0] for each in times]), np.array(times)
        state = np.array(starts, dtype=float).T
        mass, inertia, force, radius = (
            np.array([getattr(system, name) for system in systems])
            for name in ("mass", "polar_inertia", "friction_force", "contact_radius")
        )

        def rates(state):
            places = (radius * np.exp(1j * state[2]))[:, None] * 1j ** np.arange(4)
            velocity = state[3] + 1j * state[4]
            friction = (
                0.25
                * force[:, None]
                * law(velocity[:, None] + 1j * state[5][:, None] * places, state[5], places)
            )
            total, moment = friction.sum(axis=1), (places.conj() * friction).imag.sum(axis=1)
            return np.array([*state[3:], total.real / mass, total.imag / mass, moment / inertia])

        found, steps = [state], 8 if tolerance < 1e-6 else 6
        assert not first.any()
        for i in range(1, spans.shape[1]):
            h = (spans[:, i] - spans[:, i - 1]) / steps
            for _ in range(steps):
                middle = state + 0.5 * h * rates(state)
                state = state + h * rates(middle)
            found.append(state)
        states, solution = (
            np.transpose(found, (2, 0, 1)),
            Solution("midpoint", tolerance, 0, steps, 0.0, 1e-3),
        )
        return [
            Trajectory(system, time, own, (Phase("slip", time[0], time[-1], own[0]),), solution)
            for system, time, own in zip(systems, times, states, strict=True)
        ]

    def simulate_one(system, start, times, *, tolerance=1e-6):
        return simulate_many([system], [start], [times], tolerance=tolerance)[0]

    simulate_one.simulate_many = simulate_many
    return Engine("wrong", simulate_one, EVERY_KIND)


@pytest.mark.parametrize(
    ("law", "named"),
    [
        (coulomb, set()),
        (box(1.0), {"turns"}),
        (box(0.2), {"turns"}),
        (pyramid, {"turns"}),
        (falling, {"decelerates"}),
        (apart, {"spins"}),
    ],
)
def test_wrong_laws_of_friction_are_named_by_claims(law, named):
    found = verdicts(STUDY.measure(sliding_by(law)))
    parts = STUDY.sentences()
    differing = {parts[sentence] for sentence, verdict in found.items() if verdict is DIFFERS}
    assert differing == named if law is coulomb else named <= differing
    assert set(found.values()) <= {AGREES, DIFFERS}
    assert len(found) == 3


# --- Wrong measurements


def with_columns(monkeypatch, **columns):
    slides = theory.measured()
    monkeypatch.setattr(study, "measured", lambda: replace(slides, columns={**slides.columns, **columns}))
    study.left_by.cache_clear()


@pytest.mark.parametrize("turned", study.LAWS.values(), ids=study.LAWS)
def test_a_tenth_of_a_box_or_a_pyramid_would_be_seen(monkeypatch, turned):
    slides = theory.measured()
    with_columns(monkeypatch, turn_deg=slides["turn_deg"] + 0.1 * theory.box_turn(slides, turned))
    assert theory_of(STUDY, "straight") == {"straight": DIFFERS}


def test_friction_of_a_box_in_the_cube_other_loads_and_a_uniform_cube_would_be_seen(monkeypatch):
    slides = theory.measured()
    sides = np.maximum(np.abs(np.cos(slides["axis"])), np.abs(np.sin(slides["axis"])))
    with_columns(monkeypatch, mu=slides["mu"] / sides)
    assert theory_of(STUDY, "isotropic") == {"isotropic": DIFFERS}
    for load in study.OTHERS:
        with_columns(monkeypatch, spins=theory.predicted(slides, theory.LOADS[load], slides.reach).spins)
        assert set(theory_of(STUDY, "spin", "excluded").values()) == {DIFFERS}
    with_columns(monkeypatch, gyration=np.full(len(slides["gyration"]), 2.0 / 3.0 * theory.HALF_SIDE**2))
    assert set(theory_of(STUDY, "spin", "excluded").values()) == {DIFFERS}
    study.left_by.cache_clear()


# --- Numbers


def test_friction_on_a_face_is_the_integral_over_its_pressure():
    """The even load against an adaptive integral, with a shift and a fast spin."""
    half, shift, spin = 0.05, 0.01, 3.0
    load = theory.LOADS["even pressure"]
    arguments = np.array([0.4 + 0.1j]), np.array([spin]), np.array([shift])
    force, _ = theory.friction(half * load.places[None], load.shares, *arguments)
    places = half * load.places[None]
    directions = theory.directions_of(places, *arguments[:2])
    loads = theory.loaded(places, load.shares, directions, arguments[2])
    # The load balances friction at the height L: its centre is μL behind the friction force.
    assert np.sum(loads) == pytest.approx(1.0)
    assert np.sum(loads * places) == pytest.approx(-shift * force[0])
    level = theory.friction(places, load.shares, *arguments[:2], np.zeros(1))

    def part(x, y, of):
        place = complex(x, y)
        slip = 0.4 + 0.1j + 1j * spin * place
        friction = -slip / abs(slip) / (2.0 * half) ** 2
        return (friction.real, friction.imag, (place.conjugate() * friction).imag)[of]

    exact = [dblquad(part, -half, half, -half, half, args=(of,), epsabs=1e-6)[0] for of in range(3)]
    assert [level[0][0].real, level[0][0].imag, level[1][0]] == pytest.approx(exact, abs=2e-4)


def test_the_turn_of_a_box_is_that_of_two_independent_components():
    slides = theory.measured().where(np.arange(12))
    for turned in study.LAWS.values():
        for i, turn in enumerate(theory.box_turn(slides, turned)):
            start = slides["speed_first"][i] * np.exp(1j * (slides["slip"][i] - turned))
            times = np.linspace(0.0, 1.0, 100_001)
            parts = [np.sign(v) * np.maximum(abs(v) - times, 0.0) for v in (start.real, start.imag)]
            at = int(np.argmax(np.hypot(*parts) < theory.SLOWEST))
            assert turn == pytest.approx(
                np.degrees(np.angle(complex(parts[0][at], parts[1][at]) / start)), abs=0.02
            )


def test_the_validations_state_how_little_the_cameras_explain():
    found = study.validations()
    assert [one.count for one in found] == [284] * 2
    for one in found:
        assert 0.0 < one.explained < EXPECTED  # a study that validates the law would need another text
        assert 0.0 < one.data < one.error


def test_the_text_contains_the_numbers_of_the_measurements():
    slides, text = theory.measured(), " ".join(TEXT.split())
    share, error = (row[2] for row in study.spins_left(slides["spins"], slides["spin_first"]))
    left = [shares[2] for shares in study.loads_on_the_face().values()]
    ratio = slides["mu_slow"] / slides["mu_fast"]
    first, begin, end = slides["spin_first"], slides["spin_30"], slides["spin_12"]
    last = (end @ first) / (begin @ first)
    last_error = np.linalg.norm((end - last * begin) * first) / abs(begin @ first)
    predicted_last = [shares[4] / shares[0] for shares in study.loads_on_the_face().values()]
    whole, square = theory.HALF_SIDE, 2.0 / 3.0 * theory.HALF_SIDE**2
    others = []
    for load, half, gyration in (
        ("rim", whole, square),
        ("rim", slides.reach, square),
        ("four corners", slides.reach, 0.81e-3 / 0.37),
        ("rim", whole, 0.81e-3 / 0.37),
        ("rim", whole, slides["gyration"]),
    ):
        cube = replace(slides, columns=slides.columns | {"gyration": gyration + 0.0 * first})
        others.append(theory.share_of(theory.predicted(cube, theory.LOADS[load], half).spins[:, 2], first)[0])
    speeds = np.column_stack((slides["speed_first"], np.tile(theory.SPEEDS, (len(first), 1))))
    squares = (slides.reach * np.column_stack((first, slides["spins"])) / speeds) ** 2
    squares = trapezoid(squares, speeds) / (theory.SLOWEST - speeds[:, 0])
    slower = -2.0 * (slides["mu"] / np.mean(slides["mu"]) - 1.0)
    by_spin = theory.share_of(slower - slower.mean(), squares - squares.mean())
    box, pyramid = (
        theory.share_of(slides["turn_deg"], theory.box_turn(slides, by)) for by in study.LAWS.values()
    )
    for words in (
        f"312 recordings to {len(ratio)} slides",
        "median of {:.1f} degrees. A box would turn the same slides by {:.1f} degrees".format(
            *(np.median(np.abs(turn)) for turn in (slides["turn_deg"], theory.box_turn(slides)))
        ),
        f"contain −{-box[0]:.3f} ± {box[1]:.3f} of the box and −{-pyramid[0]:.3f} ± {pyramid[1]:.3f} of the pyramid",
        f"it is {100 - 100 * ratio.mean():.1f} ± {100 * ratio.std() / len(ratio) ** 0.5:.1f} % lower",
        f"{share:.3f} ± {error:.3f} of the spin",
        "flat face leave {:.3f}, a load along its rim {:.3f}, and an even pressure {:.3f}".format(*left),
        f"a factor of {last:.3f} ± {last_error:.3f}. Corners predict "
        "{:.3f}, the rim {:.3f} and an even pressure {:.3f}".format(*predicted_last),
        "a share of {:.3f} ± {:.3f} would be left".format(*theory.share_of(end, begin)),
        "rim: {:.3f} if the edges were sharp, {:.3f} on the flat face".format(*others[:2]),
        "four corners leave {:.3f} and a rim with sharp edges {:.3f}".format(*others[2:4]),
        f"leaves {others[4]:.3f}. This is {(others[4] - share) / error:.1f} standard errors",
        "c = {:.1f} ± {:.1f}".format(*by_spin),
        "slope of {:.1f} ± {:.1f} mrad".format(*slides.constants["slope_mrad"]),
    ):
        assert words in text


def test_the_curl_is_part_of_the_prediction():
    slides = theory.measured()
    level, tilted = (
        theory.predicted(slides, study.CORNERS, slides.reach, slope=slope).turn
        for slope in (0.0, 1e-3 * slides.of_constant("slope_mrad"))
    )
    (curl, slope), *_ = np.linalg.lstsq(np.column_stack((level, tilted - level)), slides["turn_deg"])
    assert curl == pytest.approx(0.55, abs=0.005)
    assert slope == pytest.approx(0.70, abs=0.005)


@pytest.mark.parametrize(
    ("load", "square"), [("four corners", 1.0), ("rim", 2.0 / 3.0), ("even pressure", 1.0 / 3.0)]
)
def test_a_slow_spin_falls_as_a_power_of_the_speed_and_curls_the_path(load, square):
    slides = theory.measured()
    columns = {"spin_first": 1e-3 * slides["spin_first"], "offset": 0.0 * slides["offset"]}
    slow = replace(slides, columns=slides.columns | columns)
    found = theory.predicted(slow, theory.LOADS[load], slides.reach)
    first, shift = slow["speed_first"], slides.of_constant("mean_mu") * slow["height"]
    power = (square * slides.reach**2 - shift**2) / slow["gyration"]
    ratios = found.spins[:, -1] / slow["spin_first"]
    assert ratios == pytest.approx((theory.SLOWEST / first) ** power, rel=1e-3)
    whole = (theory.SLOWEST ** (power - 1.0) - first ** (power - 1.0)) / (1.0 - power) / first**power
    assert found.turn == pytest.approx(-np.degrees(shift * slow["spin_first"] * whole), rel=5e-3)


def test_the_table_of_recorded_engines_shows_which_boxes_contradict_the_measurement():
    rows = {name: cells for name, *cells in STUDY.tables()[1].rows}
    assert rows["measured"][2] == "0.66, 0.58, 0.49, 0.41, 0.32"
    assert [cell[0] for cell in rows["MuJoCo, elliptic cone"]] == ["✓"] * 3
    assert [cell[0] for cell in rows["MuJoCo, pyramidal cone"]] == ["✗", "✓", "✗"]
    assert all(rows[f"{name}, contact"][2] == "✗ 0.03, 0.00, 0.00, 0.00, 0.00" for name in ("Rapier", "Jolt"))
