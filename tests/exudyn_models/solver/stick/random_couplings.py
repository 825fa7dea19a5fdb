"""Random trains of all parts, as a model and as an exact description, and their comparison."""

from functools import cached_property

import exudyn as exu
import numpy as np
from exact_couplings import Couplings, Friction, Loaded, Mesh, Spring, exact_motion_of, one_way_clutch
from free_bodies import changes_of, coordinate, items, new_model, planar_body, rotor, spatial_body
from test_random_trains import locks, random_moment

from exudyn_models import (
    add_differential,
    add_gear,
    add_one_way_clutch,
    add_planetary,
    add_ring_friction,
    add_road_load,
    add_slider_friction,
    add_torque,
    add_torque_converter,
    add_torsional_spring,
    add_tyre,
    shift_sequence,
    torque_table,
)

END, STEP = 0.5, 1e-3  # s
TIMES, SPEEDS = 1e-5, 1e-4  # s, rad/s
KINDS = ("rotor", "slider", "point", "body", "space")
CONVERTER = np.array(
    [[0.0, 1.4, 2.1], [0.5, 1.45, 1.55], [0.85, 1.7, 1.0], [0.95, 2.7, 1.0], [1.0, np.inf, 1.0]]
)


def converter_torques(pump, turbine):
    ratios, factors, gains = CONVERTER.T
    if abs(turbine) > abs(pump):
        back = np.interp(pump / turbine, ratios, factors**-2.0) * turbine * abs(turbine)
        return back, -back * (1.0 + max(0.0, -pump / turbine) * (gains[0] - 1.0))
    lost = np.interp(turbine / pump, ratios, factors**-2.0) * pump * abs(pump)
    return -lost, lost * np.interp(turbine / pump, ratios, gains)


class RandomTrain:
    """A random tree of rotors: its exact description, and functions that add the same parts to a model."""

    def __init__(self, seed, loaded=False, kinds=("rotor",), everything=False):
        self.rng = rng = np.random.default_rng(seed)
        self.count = int(rng.integers(2, 5 if loaded else 9))
        self.rows, self.springs, self.ideals, self.torques, self.controllers = [], [], [], [], []
        #: Functions that add parts, and their places among rows and then springs, or None.
        self.adds, self.samples, self.edges, self.grounded = [], [], (), False
        self.kinds = [kinds[k] for k in np.random.default_rng(seed).integers(len(kinds), size=self.count)]
        self.speeds, k, self.everything = [float(rng.choice([0.0, 2.0, -1.5]))], 1, everything
        if everything:
            self.plan_shifts()
        while k < self.count:
            parts = [self.clutch, self.one_way, self.gear]
            if loaded and self.rows:
                parts += [self.loaded] * 3
            if k + 1 < self.count:
                parts += [self.planetary, self.differential]
            if everything:
                parts += [
                    self.shifted,
                    self.controlled,
                    self.spring,
                    self.converter,
                    self.tyre,
                    self.parallel,
                ]
                parts += [self.loaded] * bool(self.rows)
            k += parts[rng.integers(len(parts))](int(rng.integers(k)), k)
        if not self.grounded:
            ground = self.road if everything and rng.integers(2) else self.clutch
            ground(None, int(rng.integers(self.count)))
        if everything:
            for add in (self.table, self.regulator):
                if rng.integers(2):
                    add(int(rng.integers(self.count)))
        self.train = Couplings(
            tuple(rng.uniform(0.3, 2.0, self.count)),
            tuple(self.speeds),
            tuple(random_moment(rng) for _ in self.speeds),
            tuple(self.rows),
            tuple(self.springs),
            tuple(self.ideals),
            tuple(self.torques),
            tuple(self.controllers),
            self.edges,
        )

    @cached_property
    def exact(self):
        """Exact changes until the end, and final speeds."""
        return exact_motion_of(self.train, END)

    def weights(self, pairs):
        row = np.zeros(self.count)
        for node, weight in pairs:
            if node is not None:
                row[node] += weight
        return tuple(row)

    def between(self, j, k):
        return self.weights([(j, -1.0), (k, 1.0)])

    def row(self, row, add):
        self.rows.append(row)
        self.adds.append((("row", len(self.rows) - 1), add))

    def clutch(self, j, k):
        if j is not None:
            self.speeds.append(self.rng.choice([self.speeds[j], 0.0, 3.0]))
        capacity, ratio = self.rng.uniform(1.0, 8.0), self.rng.uniform(1.0, 1.5)
        return self.friction_row(j, k, capacity, ratio, capacity)

    def friction_row(self, j, k, capacity, ratio, load):
        law = {"friction_coefficient": 1.0, "normal_load": load, "static_ratio": ratio}
        add = lambda mbs, at: self.friction(mbs, at(j), at(k), **law)  # noqa: E731
        self.row(Friction(self.between(j, k), capacity, ratio), add)
        return 1

    def friction(self, *bodies, **law):
        if set(self.kinds) == {"rotor"}:
            return add_ring_friction(*bodies, contact_radius=1.0, **law)
        return add_slider_friction(*bodies, **law)

    def plan_shifts(self):
        """Plan a shift from the element "off" to the element "on"."""
        start, duration = (float(number) for number in self.rng.uniform((0.05, 0.05), (0.25, 0.2)))
        full = {name: float(self.rng.uniform(2.0, 8.0)) for name in ("off", "on")}
        gears = {"1": ["off"], "2": ["on"]}
        self.shifts = shift_sequence(full, gears, start="1", shifts=[(start, "2")], duration=duration)
        self.edges = (start, start + duration)
        self.capacities = {
            name: lambda t, name=name, ends=ends: full[name] * float(np.interp(t, self.edges, ends))
            for name, ends in (("off", (1.0, 0.0)), ("on", (0.0, 1.0)))
        }

    def shifted(self, j, k):
        """Add a clutch that a shift sequence opens or closes."""
        self.speeds.append(self.rng.choice([self.speeds[j], 3.0]))
        name, ratio = str(self.rng.choice(["off", "on"])), self.rng.uniform(1.0, 1.5)
        return self.friction_row(
            j, k, self.capacities[name], ratio, lambda time: self.shifts.loads[name](time)
        )

    def command(self, law, sensed):
        """Add a controller that holds a function of a speed; return its present output, exactly and in the model."""
        period = float(self.rng.choice([0.05, 0.08]))
        now, held = [law(0.0)], [law(0.0)]
        self.controllers.append((period, lambda v: now.__setitem__(0, law(float(v[sensed])))))
        self.samples.append((period, lambda speeds: held.__setitem__(0, law(speeds[sensed]))))
        return now, held

    def controlled(self, j, k):
        """Add a clutch whose load a controller sets."""
        self.speeds.append(self.rng.choice([self.speeds[j], 3.0]))
        base, gain = float(self.rng.uniform(1.0, 6.0)), float(self.rng.uniform(-2.0, 2.0))
        now, held = self.command(lambda speed: min(max(base + gain * speed, 0.5), 9.0), j)
        ratio = self.rng.uniform(1.0, 1.5)
        return self.friction_row(j, k, lambda t: now[0], ratio, lambda time: held[0])

    def regulator(self, k):
        """Add a sampled torque on a rotor."""
        wanted, gain = (float(number) for number in self.rng.uniform((-2.0, 1.0), (3.0, 5.0)))
        now, held = self.command(lambda speed: gain * (wanted - speed), k)
        unit = np.array(self.weights([(k, 1.0)]))
        self.torques.append(lambda t, q, v: now[0] * unit)
        self.adds.append((None, lambda mbs, at: add_torque(mbs, at(k), lambda time, angle, speed: held[0])))

    def table(self, k):
        """Add a motor by table, with a throttle of time and a load of its angle."""
        rows = np.column_stack(
            ([-6.0, 0.0, 4.0], self.rng.uniform(-10.0, 10.0, 3), self.rng.uniform(-3.0, 0.0, 3))
        )
        unit, stiff = np.array(self.weights([(k, 1.0)])), float(self.rng.uniform(0.0, 5.0))

        def torque(t, q, v):
            least, most = (np.interp(v[k], rows[:, 0], rows[:, i]) for i in (2, 1))
            return (least + 0.5 * (1.0 + np.sin(5.0 * t)) * (most - least) - stiff * q[k]) * unit

        self.torques.append(torque)
        motor = torque_table(rows, lambda time: 0.5 * (1.0 + np.sin(5.0 * time)))
        self.adds.append((None, lambda mbs, at: add_torque(mbs, at(k), motor)))
        self.adds.append(
            (None, lambda mbs, at: add_torque(mbs, at(k), lambda time, angle, speed: -stiff * angle))
        )

    def spring(self, j, k):
        """Add a spring with backlash, perhaps with friction beside it."""
        self.speeds.append(self.rng.choice([self.speeds[j], 0.0, 3.0]))
        stiffness, damping, clearance = self.rng.uniform((2.0, 0.0, 0.02), (10.0, 0.5, 0.2)).tolist()
        self.springs.append(Spring(self.between(j, k), stiffness, damping, clearance))
        law = {"stiffness": stiffness, "damping": damping, "backlash": clearance}
        place = "spring", len(self.springs) - 1
        self.adds.append((place, lambda mbs, at: add_torsional_spring(mbs, at(j), at(k), **law)))
        if self.rng.integers(2):
            capacity = self.rng.uniform(0.2, 2.0)
            self.friction_row(j, k, capacity, self.rng.uniform(1.0, 1.5), capacity)
        return 1

    def converter(self, j, k):
        """Add a torque converter, perhaps with a lock-up clutch."""
        if self.speeds[j] <= 0.0:
            return self.spring(j, k)
        self.speeds.append(self.rng.choice([0.0, 0.5, 1.5]) * self.speeds[j])

        def torques(t, q, v):
            pump, turbine = converter_torques(v[j], v[k])
            return self.weights([(j, pump), (k, turbine)])

        self.torques.append(torques)
        self.adds.append((None, lambda mbs, at: add_torque_converter(mbs, at(j), at(k), table=CONVERTER)))
        if self.rng.integers(2):
            ratio = self.rng.uniform(1.0, 1.5)
            self.friction_row(j, k, self.capacities["on"], ratio, lambda time: self.shifts.loads["on"](time))
        return 1

    def tyre(self, j, k):
        """Add a tyre of the wheel j on the vehicle k."""
        radius, capacity, ratio = self.rng.uniform((0.3, 1.0, 1.0), (1.5, 8.0, 1.5)).tolist()
        self.speeds.append(self.rng.choice([radius * self.speeds[j], 0.0, 3.0]))
        law = {"radius": radius, "friction_coefficient": 0.5, "normal_load": 2.0 * capacity}
        row = Friction(self.weights([(j, -radius), (k, 1.0)]), capacity, ratio)
        self.row(row, lambda mbs, at: add_tyre(mbs, at(j), at(k), **law, static_ratio=ratio))
        return 1

    def road(self, _, k):
        """Add a road load; its rolling resistance is a row."""
        self.grounded = True
        mass, rolling, drag, slope = self.rng.uniform((0.3, 0.02, 0.0, -0.1), (1.0, 0.3, 1.0, 0.1)).tolist()
        unit, weight = np.array(self.weights([(k, 1.0)])), mass * 9.81
        self.torques.append(lambda t, q, v: -(0.6 * drag * v[k] * abs(v[k]) + weight * np.sin(slope)) * unit)
        law = {"mass": mass, "rolling": rolling, "drag_area": drag, "slope": slope}
        row = Friction(tuple(unit), rolling * weight * np.cos(slope))
        self.row(row, lambda mbs, at: add_road_load(mbs, at(k), **law).rolling)

    def parallel(self, j, k):
        """Add a one-way clutch beside a friction clutch; both change their modes together."""
        self.speeds.append(self.speeds[j] + self.rng.choice([0.0, 2.0]))
        capacity, ratio = self.rng.uniform((1.0, 1.0), (8.0, 1.5)).tolist()
        law = {"friction_coefficient": 1.0, "normal_load": capacity, "static_ratio": ratio}

        def add(mbs, at):
            return self.friction(mbs, at(j), at(k), **law), add_one_way_clutch(mbs, at(j), at(k))

        self.row(Friction(self.between(j, k), capacity, ratio, one_way=True), add)
        return 1

    def loaded(self, j, k):
        """Add a clutch that a part before it loads."""
        self.speeds.append(self.rng.choice([self.speeds[j], 0.0, 3.0]))
        capacity, gain, ratio = self.rng.uniform((0.0, 0.1, 1.0), (3.0, 1.0, 1.5)).tolist()
        part = int(self.rng.integers(len(self.rows)))
        law = {
            "friction_coefficient": 0.5,
            "normal_load": 2.0 * capacity,
            "load_gain": gain,
            "static_ratio": ratio,
        }

        def add(mbs, at):
            loading = self.parts["row", part]
            loading = loading[0] if isinstance(loading, tuple) else loading
            return self.friction(mbs, at(j), at(k), **law, load_part=loading)

        if self.everything and self.rows[part].one_way:  # its moment alone is not determined
            return self.friction_row(j, k, capacity, ratio, capacity)
        self.row(Loaded(self.between(j, k), capacity, 0.5 * gain, part, ratio), add)
        return 1

    def one_way(self, j, k):
        self.speeds.append(self.speeds[j] + self.rng.choice([0.0, 2.0]))
        self.row(one_way_clutch(self.between(j, k)), lambda mbs, at: add_one_way_clutch(mbs, at(j), at(k)))
        return 1

    def mesh(self, first, second, carrier, ratio):
        efficiency = float(self.rng.uniform(0.6, 1.0)), float(self.rng.uniform(-0.1, 1.0))
        weights = self.weights([(first, 1.0), (carrier, -1.0)])
        constraint = self.weights([(first, 1.0), (second, -ratio), (carrier, ratio - 1.0)])
        return efficiency, Mesh(weights, constraint, 0.0, 1.0 / efficiency[0] - 1.0, 1.0 - efficiency[1])

    def gear(self, j, k):
        if self.grounded and not self.everything:
            return self.clutch(j, k)
        ratio = float(self.rng.choice([-2.0, 0.5, 3.0]))
        self.speeds.append(self.speeds[j] / ratio)
        if self.grounded:
            self.ideals.append(self.weights([(j, 1.0), (k, -ratio)]))
            self.adds.append((None, lambda mbs, at: add_gear(mbs, at(j), at(k), ratio=ratio)))
            return 1
        self.grounded = True
        efficiency, mesh = self.mesh(j, k, None, ratio)
        self.row(mesh, lambda mbs, at: add_gear(mbs, at(j), at(k), ratio=ratio, efficiency=efficiency))
        return 1

    def planetary(self, j, k):
        ratio, ring = float(self.rng.uniform(1.5, 3.0)), self.speeds[j] + float(self.rng.choice([0.0, 1.0]))
        self.speeds += [(self.speeds[j] + ratio * ring) / (1.0 + ratio), ring]
        efficiency, mesh = self.mesh(j, k + 1, k, -ratio)
        law = {"ratio": ratio, "efficiency": efficiency}
        self.row(mesh, lambda mbs, at: add_planetary(mbs, at(j), at(k), at(k + 1), **law))
        return 2

    def differential(self, j, k):
        apart = float(self.rng.choice([0.0, 1.0]))
        self.speeds += [self.speeds[j] + apart, self.speeds[j] - apart]
        preload, ramp = float(self.rng.uniform(0.0, 3.0)), float(self.rng.uniform(0.0, 0.4))
        weights = self.weights([(k, 1.0), (k + 1, -1.0)])
        constraint = self.weights([(j, -2.0), (k, 1.0), (k + 1, 1.0)])
        law = {"preload": preload, "ramp": ramp}
        row = Mesh(weights, constraint, preload, 2.0 * ramp, 2.0 * ramp)
        self.row(row, lambda mbs, at: add_differential(mbs, at(j), at(k), at(k + 1), **law))
        return 2

    def model(self):
        """Return the model, the markers of its freedoms, and the place among the exact parts of each object."""
        mbs, train = new_model(), self.train
        bodies = [body(mbs, *one) for one in zip(self.kinds, train.inertias, train.speeds, strict=True)]
        for (_, marker), moment in zip(bodies, train.moments, strict=True):
            mbs.AddLoad(
                items.LoadCoordinate(
                    markerNumber=marker, loadUserFunction=lambda mbs, t, _, moment=moment: float(moment(t))
                )
            )
        self.parts, places = {}, {}
        for place, add in self.adds:
            part = add(mbs, lambda k: None if k is None else bodies[k][0])
            self.parts[place] = part
            for one in part if isinstance(part, tuple) else (part,):
                if place is not None:
                    places[int(one.item)] = place[1] + len(self.rows) * (place[0] == "spring")
        return mbs, [marker for _, marker in bodies], places


def check(random, solver, step=STEP):
    """Compare a run with the exact motion; return the number of changes."""
    train = random.train
    exact, speeds = random.exact
    mbs, markers, places = random.model()
    sampled = {}
    for period, function in random.samples:
        sampled.setdefault(period, []).append(function)
    calls = {
        period: lambda mbs, t, own=own: [function(rates_of(mbs, markers)) for function in own]
        for period, own in sampled.items()
    }
    changes = changes_of(mbs, END, step, solver, breaks=train.breaks(END), sampled=calls)
    # Parallel parts change together, and an open clutch without load and slip is at rest for the exact solver.
    found = {(time, places[item], *modes) for time, item, *modes in changes if {*modes} != {0, 2}}
    kinds, times = locks(sorted(found))
    right_kinds, right_times = locks([(one.time, one.link, one.before, one.after) for one in exact])
    assert kinds == right_kinds
    np.testing.assert_allclose(times, right_times, atol=TIMES, rtol=0.0)
    flanks, right_flanks = (
        sorted((place, time, *modes) for time, place, *modes in all_changes if place >= len(train.rows))
        for all_changes in (found, [(one.time, one.link, one.before, one.after) for one in exact])
    )
    assert [(place, *modes) for place, _, *modes in flanks] == [
        (place, *modes) for place, _, *modes in right_flanks
    ]
    np.testing.assert_allclose(
        [one[1] for one in flanks], [one[1] for one in right_flanks], atol=TIMES, rtol=0.0
    )
    np.testing.assert_allclose(rates_of(mbs, markers), speeds, atol=SPEEDS, rtol=0.0)
    return len(exact)


def rates_of(mbs, markers):
    """Return the rates of the coordinates of markers."""
    rates = []
    for marker in markers:
        at = mbs.GetMarker(marker)
        found = mbs.GetNodeOutput(at["nodeNumber"], exu.OutputVariableType.Coordinates_t)
        rates.append(float(np.atleast_1d(found)[at["coordinate"]]))
    return rates


def body(mbs, kind, inertia, speed):
    """Add a freedom of a kind; return the argument that parts take for it, and a marker of its coordinate."""
    if kind == "rotor":
        node = rotor(mbs, inertia, speed)
        return node, coordinate(mbs, node)
    if kind == "slider":
        node = mbs.AddNode(items.Node1D(initialVelocities=[speed]))
        return mbs.AddObject(items.ObjectMass1D(nodeNumber=node, mass=inertia)), coordinate(mbs, node)
    if kind == "point":
        node, place = mbs.AddNode(items.NodePoint2D(initialVelocities=[0.3, speed])), 1
        mbs.AddObject(items.ObjectMassPoint2D(nodeNumber=node, mass=inertia))
    elif kind == "space":
        start = [0.0, speed, 0.2, 0.5, -1.0, 2.0]
        node = spatial_body(mbs, items.NodeRigidBodyRxyz, inertia, [0.1, 0.2, 0.25], [0.0] * 6, start)
        place = 1
    else:
        node, place = planar_body(mbs, 1.0, inertia, [0.0] * 3, [0.0, 0.1, speed]), 2
    marker = coordinate(mbs, node, place)
    return marker, marker
