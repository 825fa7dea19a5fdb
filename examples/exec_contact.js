/* Rapier and Jolt as engines for friction-discs: a ball on a rotating plate, with the contact of each engine.
 *
 *     npm install @dimforge/rapier3d-compat jolt-physics
 *     friction-discs matrix --engine "exec:node exec_contact.js rapier" --engine "exec:node exec_contact.js jolt"
 *
 * A ball with locked rotations is pressed on the plate by its weight m*g = N, with a coefficient of friction of 1. The
 * plate is kinematic and rotates at the disc speed. Springs and dampers are a force that is set before each step. Both
 * engines compute in single precision. Bodies must not sleep. These adapters simulate a pin but not a disc. */
"use strict";
const path = require("path");

/* Returns what the npm package in the current folder, or beside this file, exports. */
const installed = (name) => require(require.resolve(name, { paths: [process.cwd(), __dirname] }));
const versionOf = (name) => {
  const [file] = [process.cwd(), __dirname].flatMap((folder) => {
    try {
      return [require(path.join(folder, "node_modules", name, "package.json"))];
    } catch {
      return [];
    }
  });
  return file ? file.version : "";
};

const RADIUS = 0.5; /* of the ball in m; the engines are made for contacts above 0.1 m */
const PLATE = [20, 20, 1]; /* half edge lengths in m */

/* Returns the force of springs, stop and dampers. */
function support(pin, x, y, vx, vy) {
  const w = Math.hypot(x - pin.offset, y);
  const stop = w > pin.stop_gap ? pin.stop_stiffness * (1 - pin.stop_gap / w) : 0;
  const spring = pin.stiffness + pin.hardening * w * w + stop;
  return [-spring * (x - pin.offset) - pin.damping * vx, -spring * y - pin.damping * vy];
}

const engines = {
  async rapier() {
    const R = installed("@dimforge/rapier3d-compat");
    await R.init();
    const build = (pin, [x, y, vx, vy]) => {
      const world = new R.World({ x: 0, y: 0, z: -pin.friction_force / pin.mass });
      world.numSolverIterations = 1; /* more iterations are substeps with a constant force */
      const plate = world.createRigidBody(R.RigidBodyDesc.kinematicVelocityBased().setTranslation(0, 0, -PLATE[2]));
      plate.setAngvel({ x: 0, y: 0, z: pin.disc_speed }, true);
      const sticky = (shape) => shape.setFriction(1).setRestitution(0);
      world.createCollider(sticky(R.ColliderDesc.cuboid(...PLATE)), plate);
      const place = R.RigidBodyDesc.dynamic().setTranslation(x, y, RADIUS).setLinvel(vx, vy, 0);
      const ball = world.createRigidBody(place.lockRotations().setCanSleep(false));
      world.createCollider(sticky(R.ColliderDesc.ball(RADIUS).setDensity(0)), ball);
      ball.setAdditionalMass(pin.mass, true);
      const state = () => {
        const [p, v] = [ball.translation(), ball.linvel()];
        return [p.x, p.y, v.x, v.y];
      };
      const step = (h) => {
        const [x, y] = support(pin, ...state());
        world.timestep = h;
        ball.resetForces(true);
        ball.addForce({ x, y, z: 0 }, true);
        world.step();
      };
      return { state, step, close: () => world.free() };
    };
    return { build, name: "Rapier", version: versionOf("@dimforge/rapier3d-compat") };
  },

  async jolt() {
    const J = await installed("jolt-physics").default();
    const build = (pin, [x, y, vx, vy]) => {
      const settings = new J.JoltSettings();
      const [objects, broad] = [new J.ObjectLayerPairFilterTable(2), new J.BroadPhaseLayerInterfaceTable(2, 2)];
      objects.EnableCollision(0, 1);
      const layers = [new J.BroadPhaseLayer(0), new J.BroadPhaseLayer(1)];
      layers.forEach((layer, i) => broad.MapObjectToBroadPhaseLayer(i, layer));
      settings.mObjectLayerPairFilter = objects;
      settings.mBroadPhaseLayerInterface = broad;
      settings.mObjectVsBroadPhaseLayerFilter = new J.ObjectVsBroadPhaseLayerFilterTable(broad, 2, objects, 2);
      const world = new J.JoltInterface(settings);
      const system = world.GetPhysicsSystem();
      const bodies = system.GetBodyInterface();
      system.SetGravity(new J.Vec3(0, 0, -pin.friction_force / pin.mass));
      const physics = system.GetPhysicsSettings();
      physics.mUseBodyPairContactCache = false; /* otherwise contact positions and slip lag by up to a millimetre */
      system.SetPhysicsSettings(physics);
      const body = (shape, at, motion, layer, more) => {
        const made = new J.BodyCreationSettings(shape, new J.RVec3(...at), new J.Quat(0, 0, 0, 1), motion, layer);
        Object.assign(made, { mFriction: 1, mRestitution: 0, mLinearDamping: 0, mAngularDamping: 0, mAllowSleeping: false });
        more(made);
        const found = bodies.CreateBody(made);
        bodies.AddBody(found.GetID(), J.EActivation_Activate);
        return found;
      };
      const plate = body(new J.BoxShape(new J.Vec3(...PLATE), 0), [0, 0, -PLATE[2]], J.EMotionType_Kinematic, 0, () => {});
      plate.SetAngularVelocity(new J.Vec3(0, 0, pin.disc_speed));
      const ball = body(new J.SphereShape(RADIUS), [x, y, RADIUS], J.EMotionType_Dynamic, 1, (made) => {
        made.mAllowedDOFs =
          J.EAllowedDOFs_TranslationX | J.EAllowedDOFs_TranslationY | J.EAllowedDOFs_TranslationZ;
        made.mOverrideMassProperties = J.EOverrideMassProperties_CalculateInertia;
        made.mMassPropertiesOverride.mMass = pin.mass;
      });
      ball.SetLinearVelocity(new J.Vec3(vx, vy, 0));
      const state = () => {
        const [p, v] = [ball.GetPosition(), ball.GetLinearVelocity()];
        return [p.GetX(), p.GetY(), v.GetX(), v.GetY()];
      };
      const step = (h) => {
        const force = new J.Vec3(...support(pin, ...state()), 0);
        bodies.AddForce(ball.GetID(), force, J.EActivation_Activate);
        J.destroy(force);
        world.Step(h, 1);
      };
      return { state, step, close: () => J.destroy(world) };
    };
    return { build, name: "Jolt", version: versionOf("jolt-physics") };
  },
};

function simulate(build, { system, state, times, step: longest }) {
  const world = build(system, state);
  const states = [state];
  for (let i = 1; i < times.length; i++) {
    const steps = Math.ceil(((times[i] - times[i - 1]) / longest) * (1 - 1e-9));
    for (let k = 0; k < steps; k++) world.step((times[i] - times[i - 1]) / steps);
    states.push(world.state());
  }
  world.close();
  return { states };
}

engines[process.argv[2]]().then(({ build, name, version }) => {
  const greeting = { name, version, kinds: ["pin"], step: 2e-3, precision: 1e-6 };
  process.stdout.write(JSON.stringify(greeting) + "\n");
  require("readline")
    .createInterface({ input: process.stdin })
    .on("line", (line) => process.stdout.write(JSON.stringify(simulate(build, JSON.parse(line))) + "\n"));
});
