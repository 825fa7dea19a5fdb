/* Engines from npm for friction-discs: a pin on a rotating plate, with the contact or joint of each engine.
 *
 *     npm install @dimforge/rapier3d-compat jolt-physics cannon-es planck
 *     friction-discs matrix --engine "exec:node exec_contact.js rapier" --engine "exec:node exec_contact.js jolt shipped"
 *
 * A ball with locked rotations is pressed on the plate by its weight m*g = N, with a coefficient of friction of 1. The
 * plate is kinematic and rotates at the disc speed. Springs and dampers are a force that is set before each step. With
 * "shipped", everything else has the engine's defaults. Without it, bodies do not sleep, and the settings are those
 * that converge best, with reasons next to them. Motions that leave the plate are not supported. planck is planar and
 * has no normal load, so friction is its joint with a force limit, recommended for scenes seen from above. These
 * adapters simulate a pin but not a disc. */
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

const shipped = process.argv[3] === "shipped";

const engines = {
  async rapier() {
    const R = installed("@dimforge/rapier3d-compat");
    await R.init();
    const build = (pin, [x, y, vx, vy]) => {
      const world = new R.World({ x: 0, y: 0, z: -pin.friction_force / pin.mass });
      if (!shipped) world.numSolverIterations = 1; /* more iterations are substeps with a constant force */
      const plate = world.createRigidBody(R.RigidBodyDesc.kinematicVelocityBased().setTranslation(0, 0, -PLATE[2]));
      plate.setAngvel({ x: 0, y: 0, z: pin.disc_speed }, true);
      const sticky = (shape) => shape.setFriction(1).setRestitution(0);
      world.createCollider(sticky(R.ColliderDesc.cuboid(...PLATE)), plate);
      const place = R.RigidBodyDesc.dynamic().setTranslation(x, y, RADIUS).setLinvel(vx, vy, 0);
      const ball = world.createRigidBody(place.lockRotations().setCanSleep(shipped));
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
    return { build, reach: PLATE[0], name: "Rapier", version: versionOf("@dimforge/rapier3d-compat") };
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
      if (!shipped) physics.mUseBodyPairContactCache = false; /* otherwise contact positions and slip lag by up to a millimetre */
      system.SetPhysicsSettings(physics);
      const body = (shape, at, motion, layer, more) => {
        const made = new J.BodyCreationSettings(shape, new J.RVec3(...at), new J.Quat(0, 0, 0, 1), motion, layer);
        made.mFriction = 1;
        if (!shipped) Object.assign(made, { mLinearDamping: 0, mAngularDamping: 0, mAllowSleeping: false });
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
    return { build, reach: PLATE[0], name: "Jolt", version: versionOf("jolt-physics") };
  },

  async cannon() {
    const C = installed("cannon-es");
    const build = (pin, [x, y, vx, vy]) => {
      const gravity = new C.Vec3(0, 0, -pin.friction_force / pin.mass);
      const world = new C.World({ gravity, allowSleep: shipped });
      Object.assign(world.defaultContactMaterial, { friction: 1, restitution: 0 });
      const plate = new C.Body({ type: C.Body.KINEMATIC, shape: new C.Plane() });
      plate.angularVelocity.set(0, 0, pin.disc_speed);
      const place = { position: new C.Vec3(x, y, RADIUS), velocity: new C.Vec3(vx, vy, 0) };
      const ball = new C.Body({ mass: pin.mass, shape: new C.Sphere(RADIUS), fixedRotation: true, ...place });
      if (!shipped) ball.linearDamping = 0;
      world.addBody(plate);
      world.addBody(ball);
      const state = () => [ball.position.x, ball.position.y, ball.velocity.x, ball.velocity.y];
      const step = (h) => {
        ball.applyForce(new C.Vec3(...support(pin, ...state()), 0));
        /* The bound on friction is an impulse per step of mu*N*(1 s), so mu is h to correct it. */
        if (!shipped) world.defaultContactMaterial.friction = h;
        world.step(h);
      };
      return { state, step, close: () => {} };
    };
    return { build, name: "cannon-es", version: versionOf("cannon-es"), precision: 0 };
  },

  async planck() {
    const P = installed("planck");
    const build = (pin, [x, y, vx, vy]) => {
      const world = new P.World({ gravity: { x: 0, y: 0 }, allowSleep: shipped });
      const plate = world.createKinematicBody();
      const at = { position: { x, y }, linearVelocity: { x: vx, y: vy } };
      const body = world.createDynamicBody({ ...at, fixedRotation: true });
      body.setMassData({ mass: pin.mass, center: { x: 0, y: 0 }, I: 0 });
      world.createJoint(new P.FrictionJoint({ maxForce: pin.friction_force, maxTorque: 0 }, plate, body, { x: 0, y: 0 }));
      const state = () => [body.getPosition().x, body.getPosition().y, body.getLinearVelocity().x, body.getLinearVelocity().y];
      const step = (h) => {
        const now = state();
        const [x, y] = support(pin, ...now);
        plate.setLinearVelocity({ x: -pin.disc_speed * now[1], y: pin.disc_speed * now[0] });
        body.applyForceToCenter({ x, y }, true);
        world.step(h, 8, 3);
      };
      return { state, step, close: () => {} };
    };
    return { build, name: "planck", version: versionOf("planck"), precision: 0 };
  },

};

function simulate(build, reach, { system, state, times, step: longest }) {
  const world = build(system, state);
  const states = [state];
  const outside = ([x, y]) => Math.hypot(x, y) > reach;
  let left = outside(state);
  for (let i = 1; i < times.length; i++) {
    const steps = Math.ceil(((times[i] - times[i - 1]) / longest) * (1 - 1e-9));
    for (let k = 0; k < steps; k++) {
      world.step((times[i] - times[i - 1]) / steps);
      left = left || outside(world.state());
    }
    states.push(world.state());
  }
  world.close();
  return left ? { unsupported: `the motion leaves the plate, which ends ${reach} m from the origin` } : { states };
}

engines[process.argv[2]]().then(({ build, name, version, reach = Infinity, precision = 1e-6 }) => {
  const ranges = reach < Infinity ? { coordinate: reach } : {};
  const who = { name: shipped ? `${name}, as shipped` : name, version };
  const greeting = { ...who, kinds: ["pin"], step: 2e-3, precision, ranges };
  process.stdout.write(JSON.stringify(greeting) + "\n");
  require("readline")
    .createInterface({ input: process.stdin })
    .on("line", (line) => process.stdout.write(JSON.stringify(simulate(build, reach, JSON.parse(line))) + "\n"));
});
