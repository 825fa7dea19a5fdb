"""Wrong calls of the public interfaces: parameters x bad values."""
import sys, warnings, traceback, signal, collections, pathlib, datetime as dt, os
os.chdir("/tmp")
warnings.simplefilter("ignore")
import numpy as np, exudyn as exu
from exudyn.itemInterface import *
import exudyn_models as em, fmu_models as fm
from compare.engines import Engine, register, engines, is_registered
import reference_model as rm
from fractions import Fraction
from decimal import Decimal

import itertools; N = itertools.count()
def nested(n):
    v = 1.0
    for _ in range(n): v = [v]
    return v
masked = np.ma.masked_array([1.0], mask=[True])
class Odd:
    def __repr__(self): return "an odd object"
class Loud:
    def __float__(self): raise RuntimeError("boom")
    def __repr__(self): return "loud"
class Quantity(float): pass
EV = [  # bad for any number
 ("timedelta64", np.timedelta64(5, "ms")), ("datetime64", np.datetime64("2020-01-01")), ("date", dt.date(2020,1,1)),
 ("timedelta", dt.timedelta(seconds=1)), ("masked", masked[0]), ("maskedarray", masked), ("complex", 1+0j), ("npcomplex", np.complex128(1)),
 ("'1_0'", "1_0"), ("'1'", "1"), ("b'1'", b"1"), ("True", True), ("np.True", np.True_), ("arabic", "\u0661"), ("nan", float("nan")),
 ("npnan", np.float64("nan")), ("inf", float("inf")), ("-inf", float("-inf")), ("list", [1.0, 2.0]), ("list1", [1.0]), ("nested9", nested(9)), ("ragged", [[1.0],[1.0,2.0]]),
 ("dict", {"a": 1}), ("set", {1.0}), ("odd", Odd()), ("loud", Loud()), ("class", float), ("lambda", lambda: 1.0), ("huge", 10**400), ("array2", np.ones((2,2))), ("strarray", np.array("1")),
 ("boolarray", np.array(True)), ("objarr", np.array(None)), ("fraction", Fraction(1,2)), ("decimal", Decimal("1")), ("empty", []), ("'nan'", "nan"), ("''", ""), ("gen", (x for x in [1.0])), ("slice", slice(1)), ("Ellipsis", ...),
]
NONE = [("None", None)]
NEG = [("-1", -1.0), ("-tiny", -1e-300), ("np-1", np.float64(-1.0))]
ZERO = [("0", 0.0), ("-0", -0.0), ("int0", 0)]
FRAC = [("1.5", 1.5), ("np1.5", np.float32(1.5))]
BOOL = [("None", None), ("0", 0), ("1", 1), ("'no'", "no"), ("[]", []), ("nan", float("nan")), ("odd", Odd()), ("1.0", 1.0), ("arr", np.array([True, False]))]
OBJ = [("None", None), ("0", 0), ("1.5", 1.5), ("'a'", "a"), ("b", b"1"), ("list", []), ("nested9", nested(9)), ("odd", Odd()), ("class", int), ("lambda", lambda: 1), ("nan", float("nan")), ("dict", {}), ("True", True), ("array", np.ones(3)), ("date", dt.date(2020,1,1)), ("ellipsis", ...)]
CALLBAD = [("0args", lambda: 1.0), ("5args", lambda a, b, c, d, e: 1.0), ("kw", lambda *, other: 1.0), ("1arg", lambda zz: 1.0), ("int", int), ("print", print)]
NAMESTR = [("None", None), ("1", 1), ("b", b"RK44"), ("''", ""), ("other", "other"), ("list", ["RK44"]), ("nan", float("nan")), ("True", True), ("odd", Odd()), ("arr", np.array(["a", "b"])), ("case", "rK44"), ("dict", {}), ("lambda", lambda: 1)]

pin = rm.PinOnDisc(mass=1., stiffness=1., damping=.1, friction_force=.09, disc_speed=1.5, offset=.1)
t = np.linspace(0, .1, 3); s = [0.1, 0, .03, 0]
def arrays(n):
    base = [0.1]*n
    out = [(k, v) for k, v in EV if k not in ("list1", "list", "empty")] + NONE
    out += [("short", base[:-1]), ("long", base+[1.0]), ("bad elt "+"str", ["1"]+base[1:]), ("elt None", [None]+base[1:]), ("elt nan", [float("nan")]+base[1:]), ("elt inf", [float("inf")]+base[1:]),
            ("elt True", [True]+base[1:]), ("elt complex", [1j]+base[1:]), ("td array", np.arange(n).astype("timedelta64[ms]")), ("dt array", np.arange(n).astype("datetime64[s]")), ("masked", np.ma.masked_array(base, mask=[1]+[0]*(n-1))),
            ("cplx arr", np.array(base)+0j), ("bool arr", np.ones(n, bool)), ("str arr", np.array(["1"]*n)), ("bytes arr", np.array([b"1"]*n)), ("2d", [base]), ("dict", dict.fromkeys(range(n), 1.0)), ("elt td", [np.timedelta64(1, "s")]+base[1:]), ("elt list", [[1.0]]+base[1:]), ("elt arab", ["\u0661"]+base[1:]), ("set", set(np.arange(n)*1.0)), ("empty", [])]
    return out
POS = EV+NONE+NEG+ZERO; NNEG = EV+NONE+NEG; ANY = EV+NONE
OPT = EV  # None allowed
def drop(l, *names): return [x for x in l if x[0] not in names]

def model():
    c = exu.SystemContainer(); mbs = c.AddSystem()
    a = mbs.AddNode(Node1D(initialCoordinates=[0.], initialVelocities=[1.])); mbs.AddObject(ObjectRotationalMass1D(nodeNumber=a, inertia=1.))
    b = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[0,0,0], initialCoordinates=[.1,0,0], initialVelocities=[0,0,0])); mbs.AddObject(ObjectRigidBody2D(nodeNumber=b, mass=1, inertia=1))
    return c, mbs, a, b
KEEP = []
def friction(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, master_node=a, disc_node=b); base = dict(contact_radius=.1, friction_coefficient=.3, normal_load=1.0, regularisation=1e-3)
    if k.pop("_annulus", 0): base.pop("contact_radius"); base |= dict(inner_radius=.1, outer_radius=.2)
    args |= base | k
    f = em.add_ring_friction(args.pop("mbs"), args.pop("master_node"), args.pop("disc_node"), **args)
    return f, mbs, a, b
def support(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, base_node=None, disc_node=b, stiffness=1.0) | k
    return em.add_radial_support(args.pop("mbs"), args.pop("base_node"), args.pop("disc_node"), **args)
def native(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, master_node=a, disc_node=b, contact_radius=.1, friction_coefficient=.3, normal_load=1.0, regularisation=1e-3, contact_points=3, reach=1.0) | k
    return em.add_native_friction(args.pop("mbs"), args.pop("master_node"), args.pop("disc_node"), **args)
def thermal(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, heat_capacity=1.0) | k
    return em.add_thermal_node(args.pop("mbs"), **args)
def energy(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, gains={"a": lambda mbs, t: 0.0}, losses={}) | k
    return em.add_energy_balance(args.pop("mbs"), **args)
def settings():
    st = exu.SimulationSettings(); st.timeIntegration.endTime = .01; st.timeIntegration.numberOfSteps = 2; st.timeIntegration.verboseMode = 0; st.solution.file.write = False
    return st
def solve(**k):
    c, mbs, a, b = model(); KEEP.append(c)
    args = dict(mbs=mbs, simulationSettings=settings(), solverType=exu.DynamicSolverType.RK44, updateInitialValues=False, breaks=()) | k
    return em.solve_dynamic(**args)
def limit(**k):
    f, mbs, a, b = friction(); mbs.Assemble()
    args = dict(mbs=mbs, solver_type=exu.DynamicSolverType.RK44) | k
    return em.largest_stable_step(**args)
def build(**k):
    args = dict(drivetrain=em.PASSENGER_CAR, normal_load=1000.0, regularisation=1e-3, engine_speed=100.0, gearbox_speed=0.0) | k
    m = em.build_drivetrain(args.pop("drivetrain"), **args); KEEP.append(m); return m
def run(**k):
    m = build()
    args = dict(until=.002, sample_every=.001) | k
    return m.run(args.pop("until"), **args)
from dataclasses import asdict
def drivetrain(**k): return em.Drivetrain(**(asdict(em.PASSENGER_CAR) | k))
def sim(**k):
    args = dict(system=pin, initial_state=s, times=t, tolerance=1e-6) | k
    return em.simulate(args.pop("system"), args.pop("initial_state"), args.pop("times"), **args)
def fixed(**k):
    args = dict(system=pin, initial_state=s, times=t, step=.01) | k
    return em.simulate_fixed_step(args.pop("system"), args.pop("initial_state"), args.pop("times"), **args)
def nat(**k):
    args = dict(system=pin, initial_state=s, times=t, tolerance=1e-4) | k
    return em.simulate_with_native_contact(args.pop("system"), args.pop("initial_state"), args.pop("times"), **args)
def bm(**k):
    args = dict(system=pin, initial_state=np.array(s), regularisation=1e-3) | k
    return em.build_model(args.pop("system"), args.pop("initial_state"), **args)
def eig(**k):
    args = dict(system=pin, state=[1, 0, .3, 0]) | k
    return em.eigenvalues(**args)
def four(**k): return em.four_cylinder(**(dict(mean=1.0, ripple=.5) | k))
def change(**k):
    f, *_ = friction(); return f.change(**k)
def fsensor(**k):
    f, *_ = friction(); return f.add_sensor(**k)
def ssensor(**k): return support().add_sensor(**k)
def starting(model, **k): return model.starting(**k)
def export(**k):
    args = dict(model=fm.PIN, file=pathlib.Path("/work/scratch/files/a.fmu"), fmi=2) | k
    return fm.export(**args)
def engine(**k): return Engine(**(dict(name="mine", function=lambda system, initial_state, times, *, tolerance: None) | k))
def reg(**k): return register(**k)
def engs(**k): return engines(**k)

TABLE = []  # (label, function, parameter, values, fixed)
def add(label, f, par, values, **fixed): TABLE.append((label, f, par, values, fixed))
for p in ("engine_inertia","disc_mass","disc_inertia","outer_radius","vehicle_inertia"): add("Drivetrain", drivetrain, p, POS)
for p in ("unbalance","inner_radius","friction_coefficient","radial_stiffness","radial_damping","hardening","stop_gap","stop_stiffness","torsional_stiffness","torsional_damping"): add("Drivetrain", drivetrain, p, NNEG)
add("Drivetrain", drivetrain, "offset", ANY); add("Drivetrain", drivetrain, "faces", POS+FRAC)
for p in ("mean","ripple"): add("four_cylinder", four, p, ANY)
CP = drop(EV, "list", "list1", "nested9", "ragged", "empty", "array2")
def norule(l): return l
add("add_ring_friction", friction, "contact_radius", NNEG)
for p in ("inner_radius","outer_radius"): add("add_ring_friction", friction, p, NNEG+([] if p[0]=="i" else ZERO), _annulus=1)
add("add_ring_friction", friction, "friction_coefficient", NNEG+CALLBAD); add("add_ring_friction", friction, "normal_load", NNEG+CALLBAD)
add("add_ring_friction", friction, "regularisation", OPT+NEG+ZERO)
add("add_ring_friction", friction, "contact_points", EV+NEG+ZERO+FRAC+[("pair", [(0,0)]), ("rows2", [(0,0),(1,0)]), ("same", [(0,0,.5),(0,0,.5)]), ("sum", [(0,0,.5),(1,0,.6)]), ("text", ["abc","def"]), ("bool", [(True,0,.5),(0,0,.5)])])
add("add_ring_friction", friction, "static_ratio", POS+[(".5", .5)]); add("add_ring_friction", friction, "plates", POS+FRAC)
add("add_ring_friction", friction, "pressure", OBJ+CALLBAD+NAMESTR, _annulus=1); add("add_ring_friction", friction, "thermal_node", drop(OBJ, "None"))
add("add_ring_friction", friction, "held", drop(EV)+NEG+ZERO+FRAC, contact_points=3)
for p in ("master_rotation","disc_rotation"): add("add_ring_friction", friction, p, EV+[("2I", 2*np.eye(3)), ("mirror", np.diag([1,1,-1])), ("2x2", np.eye(2)), ("text", [["1","0","0"],["0","1","0"],["0","0","1"]]), ("bool", np.eye(3, dtype=bool)), ("complex", np.eye(3)+0j), ("td", np.eye(3, dtype=int).astype("timedelta64[s]")), ("masked", np.ma.masked_array(np.eye(3), mask=np.eye(3))), ("nan", np.full((3,3), np.nan))])
for n, f, ps in (("add_ring_friction", friction, ("mbs","disc_node")), ("add_radial_support", support, ("mbs","disc_node")), ("add_native_friction", native, ("mbs","master_node","disc_node")), ("add_thermal_node", thermal, ("mbs",)), ("add_energy_balance", energy, ("mbs",)), ("solve_dynamic", solve, ("mbs","simulationSettings")), ("largest_stable_step", limit, ("mbs","solver_type")), ("build_drivetrain", build, ("drivetrain",)), ("simulate", sim, ("system","friction")), ("simulate_fixed_step", fixed, ("system",)), ("simulate_with_native_contact", nat, ("system",)), ("build_model", bm, ("system","friction")), ("eigenvalues", eig, ("system",))):
    for p in ps: add(n, f, p, OBJ)
for n, f, p in (("add_ring_friction", friction, "master_node"), ("add_radial_support", support, "base_node"), ("solve_dynamic", solve, "solverType")): add(n, f, p, drop(OBJ, "None"))
for p in ("stiffness","damping","hardening","stop_gap","stop_stiffness"): add("add_radial_support", support, p, NNEG)
add("add_radial_support", support, "offset", arrays(2))
add("add_native_friction", native, "contact_radius", NNEG); add("add_native_friction", native, "friction_coefficient", NNEG+CALLBAD); add("add_native_friction", native, "normal_load", NNEG+CALLBAD); add("add_native_friction", native, "regularisation", POS); add("add_native_friction", native, "reach", POS); add("add_native_friction", native, "contact_points", EV+NEG+ZERO+FRAC)
add("add_thermal_node", thermal, "heat_capacity", POS); add("add_thermal_node", thermal, "conductance", NNEG); add("add_thermal_node", thermal, "surroundings", ANY); add("add_thermal_node", thermal, "start", EV)
P2 = lambda mbs, t: 0.0
for p in ("gains","losses"): add("add_energy_balance", energy, p, drop(OBJ, "dict", *(() if p=="gains" else ()))+[("val", {"x": 1.0}), ("0args", {"x": lambda: 1.0}), ("1arg", {"x": lambda a: 1.0}), ("3", {"x": lambda a,b,c: 1.0}), ("key", {1: P2}), ("same", {"a": P2}) if p=="losses" else ("keyNone", {None: P2})])
add("add_energy_balance", energy, "stored", drop(OBJ, "list", "dict")+[("nums", [1.0]), ("0args", [lambda: 1.0]), ("2args", [lambda a, b: 1.0])])
add("add_energy_balance", energy, "unit", POS)
add("solve_dynamic", solve, "updateInitialValues", BOOL)
add("solve_dynamic", solve, "breaks", drop(EV, "empty", "gen", "list1", "list")+NONE+[("elt str", ["0.005"]), ("elt True", [True]), ("elt nan", [float("nan")]), ("late", [1.0]), ("desc", [.006, .004]), ("td", np.array([5]).astype("timedelta64[ms]")), ("2d", [[.005]]), ("complex", [.005+0j]), ("masked", np.ma.masked_array([.005], mask=[1])), ("neg", [-1.0])])
add("spring_energy", lambda **k: em.spring_energy(**k), "connector", OBJ)
add("build_drivetrain", build, "normal_load", NNEG+CALLBAD); add("build_drivetrain", build, "regularisation", EV+NEG+ZERO)
for p in ("engine_speed","gearbox_speed","shaft_torque"): add("build_drivetrain", build, p, ANY)
for p in ("engine_torque","vehicle_torque"): add("build_drivetrain", build, p, drop(OBJ, "None", "class", "lambda")+CALLBAD)
for p in ("until","sample_every","largest_step","tolerance"): add("DrivetrainModel.run", run, p, POS)
for n, f in (("simulate", sim), ("simulate_fixed_step", fixed), ("simulate_with_native_contact", nat)):
    add(n, f, "initial_state", arrays(4)); add(n, f, "times", [x for x in arrays(3) if x[0] not in ("short","long","list")]+[("desc", [1.,0.]), ("same", [0.,0.])])
for n, f in (("simulate", sim), ("simulate_with_native_contact", nat)): add(n, f, "tolerance", POS+[("1", 1.0), ("1e-20", 1e-20)])
add("simulate", sim, "regularisation", EV+NEG+ZERO); add("simulate", sim, "solver", NAMESTR)
add("simulate_fixed_step", fixed, "step", POS); add("simulate_fixed_step", fixed, "regularisation", POS); add("simulate_fixed_step", fixed, "integrator", NAMESTR)
add("build_model", bm, "initial_state", arrays(4)); add("build_model", bm, "regularisation", POS); add("build_model", bm, "axes_speed", ANY)
add("eigenvalues", eig, "state", arrays(4))
add("RingFriction.change", change, "friction_coefficient", NNEG[:-3] + NEG + CALLBAD if False else drop(NNEG, "None")+CALLBAD); add("RingFriction.change", change, "normal_load", drop(NNEG, "None")+CALLBAD)
add("RingFriction.add_sensor", fsensor, "quantity", NAMESTR); add("RadialSupport.add_sensor", ssensor, "quantity", NAMESTR)
for m in (fm.PIN, fm.CLUTCH):
    add(f"{m.name}.starting", lambda m=m, **k: starting(m, **k), "mass", POS); add(f"{m.name}.starting", lambda m=m, **k: starting(m, **k), "damping", NNEG)
    add(f"{m.name}.starting", lambda m=m, **k: starting(m, **k), "tolerance", POS)
add("clutch.starting", lambda **k: starting(fm.CLUTCH, **k), "plates", POS+FRAC); add("clutch.starting", lambda **k: starting(fm.CLUTCH, **k), "wear", drop(ANY, "True", "np.True")+FRAC); add("pin.starting", lambda **k: starting(fm.PIN, **k), "nothing", ANY[:5])
add("disc.starting", lambda **k: starting(fm.DISC, **k), "contact_points", ANY+NEG+FRAC+[("2", 2)])
add("export", export, "model", OBJ); add("export", export, "file", drop(OBJ)+[("noext", pathlib.Path("a")), ("str noext", "abc")]); add("export", export, "fmi", drop(EV)+NONE+[("1", 1), ("4", 4), ("2.0", 2.0), ("'2'", "2")])
add("Engine", engine, "name", drop(NAMESTR, "other", "case")); add("Engine", engine, "function", drop(OBJ, "class", "lambda")); add("Engine", engine, "kinds", drop(OBJ, "list")+[("str", "pin"), ("unknown", ("pin","foo")), ("empty", ())])
for p in ("sticks","nonlinear","phases","contact_only"): add("Engine", engine, p, BOOL)
add("Engine", engine, "precision", NNEG); add("Engine", engine, "step", EV+NEG+ZERO); add("Engine", engine, "order", POS)
add("Engine", engine, "seed", drop(EV, "huge")+NEG+FRAC)
for p in ("kin","version","about"): add("Engine", engine, p, drop(OBJ, "'a'"))
add("register", reg, "engine", OBJ+[("taken", engines(["reference"])[0])])
add("register", lambda **k: reg(engine=engine(name=f"mine{next(N)}"), **k), "on_request", BOOL)
add("engines", engs, "names", drop(OBJ, "list", "dict")+[("unknown", ["foo"]), ("ints", [1]), ("None", [None]), ("file", ["nosuch:f"]), ("b", [b"reference"]), ("str", "reference")])

ALIAS = {"names": ("engine",), "kinds": ("kind",), "until": ("until",), "state": ("initial_state",)}
if __name__ == "__main__":
    class Late(Exception): pass
    def alarm(*_): raise Late
    signal.signal(signal.SIGALRM, alarm)
    only = sys.argv[1:]
    n = 0; bad = []
    RULE = ("takes", "taken", "allowed", "must", "needs", "cannot", "choose", "unknown", "did you mean", "pass ", "does not exist", "use two names", "expected")
    for label, f, par, values, fixed_ in TABLE:
        if only and label not in only: continue
        for what, v in values:
            if what == "gen": v = (x for x in [1.0])
            n += 1
            try:
                signal.alarm(60)
                r = f(**fixed_, **{par: v})
            except ValueError as e:
                m = str(e)
                miss = []
                if not any(x in m for x in (par, *ALIAS.get(par, ()))): miss.append("name")
                if not any(w in m for w in RULE): miss.append("rule")
                if "\n" in m: miss.append("oneline")
                if len(m) > 400: miss.append("long")
                if miss: bad.append((label, par, what, "ValueError lacks " + ",".join(miss), m[:160]))
            except Late: bad.append((label, par, what, "TIME", ""))
            except BaseException as e:
                bad.append((label, par, what, type(e).__name__, str(e).strip().replace("\n", " | ")[:160]))
            else: bad.append((label, par, what, "ACCEPTED", repr(r)[:60]))
            finally: signal.alarm(0)
            KEEP.clear()
    print(n, "calls,", len(bad), "not refused as they should be")
    for b in bad: print(" ; ".join(map(str, b)))
    print(collections.Counter((b[0], b[1], b[3].split()[0]) for b in bad))
