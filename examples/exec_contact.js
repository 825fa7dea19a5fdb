/* Engines from npm for friction-discs: bodies on a rotating plate, and joints with friction.
 *
 *     npm install @dimforge/rapier3d-compat jolt-physics cannon-es planck physx-js-webidl @babylonjs/havok
 *     friction-discs matrix --engine "exec:node exec_contact.js rapier" --engine "exec:node exec_contact.js jolt shipped"
 *
 * A pin is a ball with locked rotations, pressed on the plate by its weight m*g = N, with a coefficient of friction of
 * 1. A disc on four points is a box that turns only about the vertical and touches with its corners; with the word
 * "box", this box also stands for a ring. The plate is kinematic and rotates at the disc speed. Springs and dampers
 * are a force that is set before each step. A joint is a hinge with the engine's own friction, or with a motor of
 * speed 0 and a limit. With "shipped", everything else has the engine's defaults. Without it, bodies do not sleep, and
 * the settings are those that converge best, with reasons next to them. Motions that leave the plate are not
 * supported. planck is planar and has no normal load, so friction is its joint with a force limit, recommended for
 * scenes seen from above, and it has no box. */
"use strict";
const fs = require("fs");
const path = require("path");
const { pathToFileURL } = require("url");

/* Returns the file of the npm package in the current folder, or beside this file; then what it exports. */
const fileOf = (name) => require.resolve(name, { paths: [process.cwd(), __dirname] });
const installed = (name) => require(fileOf(name));
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

const [name, ...words] = process.argv.slice(2);
const [shipped, boxes] = ["shipped", "box"].map((word) => words.includes(word));

const RADIUS = 0.5; /* of the ball in m; the engines are made for contacts above 0.1 m */
const PLATE = [20, 20, 1]; /* half edge lengths in m */

/* Returns half the edge length of the box whose corners are the contact points, or 0 for a pin. */
const halfOf = (system) => (system.contact_radius || 0) / Math.SQRT2;
const heightOf = (system) => halfOf(system) || RADIUS;
const quaternion = (yaw) => [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
const yawOf = (z, w) => 2 * Math.atan2(z, w);

/* Returns the force of springs, stop and dampers, and the torque of the shaft. */
function support(system, [x, y, vx, vy, , spin]) {
  const w = Math.hypot(x - system.offset, y);
  const stop = w > system.stop_gap ? system.stop_stiffness * (1 - system.stop_gap / w) : 0;
  const spring = system.stiffness + system.hardening * w * w + stop;
  const torque = halfOf(system) ? system.shaft_damping * (system.shaft_speed - spin) : 0;
  return [-spring * (x - system.offset) - system.damping * vx, -spring * y - system.damping * vy, torque];
}

/* Each engine returns functions that build a body on the plate, plane(system, [x, y, vx, vy, yaw, spin]), and a joint,
 * hinge(joint, spin). The results have state() (x, y, vx, vy, yaw, spin, or yaw and spin), step(h, forces) and close(). */
const engines = {
  async rapier() {
    const R = installed("@dimforge/rapier3d-compat");
    await R.init();
    const xyz = ([x, y, z]) => ({ x, y, z });
    const made = (gravity) => {
      const world = new R.World({ x: 0, y: 0, z: gravity });
      if (!shipped) world.numSolverIterations = 1; /* more iterations are substeps with a constant force */
      return world;
    };
    const heavy = (body, mass, inertia) =>
      body.setAdditionalMassProperties(mass, xyz([0, 0, 0]), xyz([inertia, inertia, inertia]), { ...xyz([0, 0, 0]), w: 1 }, true);
    const spinOf = (body) => [yawOf(body.rotation().z, body.rotation().w), body.angvel().z];
    const plane = (system, [x, y, vx, vy, yaw, spin]) => {
      const [half, world] = [halfOf(system), made(-system.friction_force / system.mass)];
      const plate = world.createRigidBody(R.RigidBodyDesc.kinematicVelocityBased().setTranslation(0, 0, -PLATE[2]));
      plate.setAngvel(xyz([0, 0, system.disc_speed]), true);
      const sticky = (shape) => shape.setFriction(1).setRestitution(0).setDensity(0);
      world.createCollider(sticky(R.ColliderDesc.cuboid(...PLATE)), plate);
      const [, , z, w] = quaternion(yaw);
      const place = R.RigidBodyDesc.dynamic().setTranslation(x, y, heightOf(system)).setRotation({ x: 0, y: 0, z, w });
      place.setLinvel(vx, vy, 0).setAngvel(xyz([0, 0, spin])).enabledRotations(false, false, half > 0);
      const body = world.createRigidBody(place.setCanSleep(shipped));
      world.createCollider(sticky(half ? R.ColliderDesc.cuboid(half, half, half) : R.ColliderDesc.ball(RADIUS)), body);
      heavy(body, system.mass, system.polar_inertia || system.mass);
      const state = () => {
        const [p, v] = [body.translation(), body.linvel()];
        return [p.x, p.y, v.x, v.y, ...spinOf(body)];
      };
      const step = (h, [x, y, torque]) => {
        world.timestep = h;
        body.resetForces(true);
        body.resetTorques(true);
        body.addForce(xyz([x, y, 0]), true);
        body.addTorque(xyz([0, 0, torque]), true);
        world.step();
      };
      return { state, step, close: () => world.free() };
    };
    const hinge = (joint, spin) => {
      const [world, none] = [made(0), xyz([0, 0, 0])];
      const place = R.RigidBodyDesc.dynamic().setAngvel(xyz([0, 0, spin])).setCanSleep(shipped);
      const [ground, body] = [world.createRigidBody(R.RigidBodyDesc.fixed()), world.createRigidBody(place)];
      heavy(body, joint.inertia, joint.inertia);
      const axle = world.createImpulseJoint(R.JointData.revolute(none, none, xyz([0, 0, 1])), ground, body, true);
      axle.configureMotorModel(R.MotorModel.ForceBased);
      axle.configureMotorVelocity(0, 1e9 * joint.inertia);
      axle.setMotorMaxForce(joint.friction_moment);
      const step = (h, [torque]) => {
        world.timestep = h;
        body.resetTorques(true);
        body.addTorque(xyz([0, 0, torque]), true);
        world.step();
      };
      return { state: () => spinOf(body), step, close: () => world.free() };
    };
    return { plane, hinge, reach: PLATE[0], title: "Rapier", version: versionOf("@dimforge/rapier3d-compat") };
  },

  async jolt() {
    const J = await installed("jolt-physics").default();
    const made = (gravity) => {
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
      system.SetGravity(new J.Vec3(0, 0, gravity));
      const physics = system.GetPhysicsSettings();
      if (!shipped) physics.mUseBodyPairContactCache = false; /* otherwise contact positions and slip lag by up to a millimetre */
      system.SetPhysicsSettings(physics);
      return { world, system, bodies: system.GetBodyInterface() };
    };
    const bodyIn = ({ bodies }, shape, at, yaw, motion, layer, more) => {
      const turned = new J.Quat(...quaternion(yaw));
      const settings = new J.BodyCreationSettings(shape, new J.RVec3(...at), turned, motion, layer);
      settings.mFriction = 1;
      if (!shipped) Object.assign(settings, { mLinearDamping: 0, mAngularDamping: 0, mAllowSleeping: false });
      more(settings);
      const found = bodies.CreateBody(settings);
      bodies.AddBody(found.GetID(), J.EActivation_Activate);
      return found;
    };
    const heavy = (settings, mass, inertia) => {
      settings.mOverrideMassProperties = J.EOverrideMassProperties_MassAndInertiaProvided;
      settings.mMassPropertiesOverride.mMass = mass;
      settings.mMassPropertiesOverride.mInertia = J.Mat44.prototype.sScale(inertia);
    };
    const step = ({ world, bodies }, body) => (h, forces) => {
      const [x, y, torque] = forces.length > 1 ? forces : [0, 0, ...forces];
      const [force, moment] = [new J.Vec3(x, y, 0), new J.Vec3(0, 0, torque)];
      bodies.AddForce(body.GetID(), force, J.EActivation_Activate);
      bodies.AddTorque(body.GetID(), moment, J.EActivation_Activate);
      [force, moment].forEach((one) => J.destroy(one));
      world.Step(h, 1);
    };
    const spinOf = (body) => [yawOf(body.GetRotation().GetZ(), body.GetRotation().GetW()), body.GetAngularVelocity().GetZ()];
    const plane = (system, [x, y, vx, vy, yaw, spin]) => {
      const [half, made_] = [halfOf(system), made(-system.friction_force / system.mass)];
      const ground = new J.BoxShape(new J.Vec3(...PLATE), 0);
      const plate = bodyIn(made_, ground, [0, 0, -PLATE[2]], 0, J.EMotionType_Kinematic, 0, () => {});
      plate.SetAngularVelocity(new J.Vec3(0, 0, system.disc_speed));
      const shape = half ? new J.BoxShape(new J.Vec3(half, half, half), 0) : new J.SphereShape(RADIUS);
      const body = bodyIn(made_, shape, [x, y, heightOf(system)], yaw, J.EMotionType_Dynamic, 1, (settings) => {
        settings.mAllowedDOFs =
          J.EAllowedDOFs_TranslationX | J.EAllowedDOFs_TranslationY | J.EAllowedDOFs_TranslationZ |
          (half ? J.EAllowedDOFs_RotationZ : 0);
        heavy(settings, system.mass, system.polar_inertia || system.mass);
      });
      body.SetLinearVelocity(new J.Vec3(vx, vy, 0));
      body.SetAngularVelocity(new J.Vec3(0, 0, spin));
      const state = () => {
        const [p, v] = [body.GetPosition(), body.GetLinearVelocity()];
        return [p.GetX(), p.GetY(), v.GetX(), v.GetY(), ...spinOf(body)];
      };
      return { state, step: step(made_, body), close: () => J.destroy(made_.world) };
    };
    const hinge = (joint, spin) => {
      const made_ = made(0);
      const shape = new J.SphereShape(RADIUS);
      const ground = bodyIn(made_, shape, [0, 0, 0], 0, J.EMotionType_Static, 0, () => {});
      const body = bodyIn(made_, shape, [0, 0, 0], 0, J.EMotionType_Dynamic, 0, (settings) => heavy(settings, joint.inertia, joint.inertia));
      body.SetAngularVelocity(new J.Vec3(0, 0, spin));
      const settings = new J.HingeConstraintSettings();
      settings.mHingeAxis1 = settings.mHingeAxis2 = new J.Vec3(0, 0, 1);
      settings.mNormalAxis1 = settings.mNormalAxis2 = new J.Vec3(1, 0, 0);
      settings.mMaxFrictionTorque = joint.friction_moment;
      made_.system.AddConstraint(settings.Create(ground, body));
      return { state: () => spinOf(body), step: step(made_, body), close: () => J.destroy(made_.world) };
    };
    return { plane, hinge, reach: PLATE[0], title: "Jolt", version: versionOf("jolt-physics") };
  },

  async physx() {
    const file = fileOf("physx-js-webidl");
    const { process: kept } = globalThis; /* the package is built for browsers and refuses Node by this name */
    Object.assign(globalThis, { window: globalThis, process: undefined });
    const wasmBinary = fs.readFileSync(file.replace(/mjs$/, "wasm"));
    const P = await (await import(pathToFileURL(file))).default({ wasmBinary });
    globalThis.process = kept;
    const foundation = P.CreateFoundation(P.PHYSICS_VERSION, new P.PxDefaultAllocator(), new P.PxDefaultErrorCallback());
    const scale = new P.PxTolerancesScale();
    const physics = P.CreatePhysics(P.PHYSICS_VERSION, foundation, scale);
    P.PxTopLevelFunctions.prototype.InitExtensions?.(physics);
    const material = physics.createMaterial(1, 1, 0);
    const [flags, filter] = [new P.PxShapeFlags(P.PxShapeFlagEnum.eSIMULATION_SHAPE), new P.PxFilterData(1, 1, 0, 0)];
    const vector = (values) => new P.PxVec3(...values);
    const pose = (at, yaw) => new P.PxTransform(vector(at), new P.PxQuat(...quaternion(yaw)));
    const made = (gravity) => {
      const desc = new P.PxSceneDesc(scale);
      desc.gravity = vector([0, 0, gravity]);
      desc.cpuDispatcher = P.DefaultCpuDispatcherCreate(0);
      desc.filterShader = P.DefaultFilterShader();
      if (!shipped) desc.solverType = P.PxSolverTypeEnum.eTGS; /* the other solver's friction is a box */
      return physics.createScene(desc);
    };
    const bodyIn = (scene, geometry, at, yaw, mass, inertia) => {
      const body = physics.createRigidDynamic(pose(at, yaw));
      if (geometry) {
        const shape = physics.createShape(geometry, material, true, flags);
        shape.setSimulationFilterData(filter);
        body.attachShape(shape);
      }
      body.setMass(mass);
      body.setMassSpaceInertiaTensor(vector([inertia, inertia, inertia]));
      if (!shipped) {
        body.setAngularDamping(0);
        body.setSleepThreshold(0);
      }
      scene.addActor(body);
      return body;
    };
    const run = (scene, h) => {
      scene.simulate(h);
      scene.fetchResults(true);
    };
    const spinOf = (body) => {
      const { z, w } = body.getGlobalPose().q;
      return [yawOf(z, w), body.getAngularVelocity().z];
    };
    const plane = (system, [x, y, vx, vy, yaw, spin]) => {
      const [half, scene] = [halfOf(system), made(-system.friction_force / system.mass)];
      const plate = bodyIn(scene, new P.PxBoxGeometry(...PLATE), [0, 0, -PLATE[2]], 0, 1, 1);
      plate.setRigidBodyFlag(P.PxRigidBodyFlagEnum.eKINEMATIC, true);
      const shape = half ? new P.PxBoxGeometry(half, half, half) : new P.PxSphereGeometry(RADIUS);
      const body = bodyIn(scene, shape, [x, y, heightOf(system)], yaw, system.mass, system.polar_inertia || system.mass);
      const lock = P.PxRigidDynamicLockFlagEnum;
      body.setRigidDynamicLockFlag(lock.eLOCK_ANGULAR_X, true);
      body.setRigidDynamicLockFlag(lock.eLOCK_ANGULAR_Y, true);
      body.setRigidDynamicLockFlag(lock.eLOCK_ANGULAR_Z, half === 0);
      body.setLinearVelocity(vector([vx, vy, 0]));
      body.setAngularVelocity(vector([0, 0, spin]));
      let turned = 0;
      const state = () => {
        const [{ p }, v] = [body.getGlobalPose(), body.getLinearVelocity()];
        return [p.x, p.y, v.x, v.y, ...spinOf(body)];
      };
      const step = (h, [x, y, torque]) => {
        turned += h * system.disc_speed;
        plate.setKinematicTarget(pose([0, 0, -PLATE[2]], turned));
        body.addForce(vector([x, y, 0]));
        body.addTorque(vector([0, 0, torque]));
        run(scene, h);
      };
      return { state, step, close: () => scene.release() };
    };
    const hinge = (joint, spin) => {
      const scene = made(0);
      const body = bodyIn(scene, null, [0, 0, 0], 0, joint.inertia, joint.inertia);
      body.setAngularVelocity(vector([0, 0, spin]));
      const along = new P.PxTransform(vector([0, 0, 0]), new P.PxQuat(0, -Math.SQRT1_2, 0, Math.SQRT1_2)); /* x to z */
      const axle = P.PxTopLevelFunctions.prototype.RevoluteJointCreate(physics, null, along, body, along);
      axle.setDriveVelocity(0);
      axle.setDriveForceLimit(joint.friction_moment);
      axle.setConstraintFlag(P.PxConstraintFlagEnum.eDRIVE_LIMITS_ARE_FORCES, true); /* otherwise impulses */
      axle.setRevoluteJointFlag(P.PxRevoluteJointFlagEnum.eDRIVE_ENABLED, true);
      const step = (h, [torque]) => {
        body.addTorque(vector([0, 0, torque]));
        run(scene, h);
      };
      return { state: () => spinOf(body), step, close: () => scene.release() };
    };
    return { plane, hinge, reach: PLATE[0], title: "PhysX", version: versionOf("physx-js-webidl") };
  },

  async havok() {
    const file = fileOf("@babylonjs/havok");
    const wasmBinary = fs.readFileSync(file.replace(/_umd\.js$/, ".wasm"));
    const H = await installed("@babylonjs/havok")({ wasmBinary });
    const made = (gravity) => {
      const world = H.HP_World_Create()[1];
      H.HP_World_SetGravity(world, [0, 0, gravity]);
      return world;
    };
    const bodyIn = (world, shape, at, yaw, mass, inertia, motion) => {
      const body = H.HP_Body_Create()[1];
      if (shape) {
        H.HP_Shape_SetMaterial(shape, [1, 1, 0, H.MaterialCombine.MULTIPLY, H.MaterialCombine.MULTIPLY]);
        H.HP_Body_SetShape(body, shape);
      }
      H.HP_Body_SetMotionType(body, motion);
      H.HP_Body_SetMassProperties(body, [[0, 0, 0], mass, inertia, [0, 0, 0, 1]]);
      H.HP_Body_SetQTransform(body, [at, quaternion(yaw)]);
      if (!shipped) {
        H.HP_Body_SetAngularDamping(body, 0);
        H.HP_Body_SetActivationControl(body, H.ActivationControl.ALWAYS_ACTIVE);
      }
      H.HP_World_AddBody(world, body, false);
      return body;
    };
    const box = (half) => H.HP_Shape_CreateBox([0, 0, 0], [0, 0, 0, 1], half.map((edge) => 2 * edge))[1];
    const run = (world, h) => {
      if (!shipped) H.HP_World_SetIdealStepTime(world, h);
      H.HP_World_Step(world, h);
    };
    const spinOf = (body) => {
      const [, , z, w] = H.HP_Body_GetOrientation(body)[1];
      return [yawOf(z, w), H.HP_Body_GetAngularVelocity(body)[1][2]];
    };
    const closed = (world, bodies) => () => {
      bodies.forEach((body) => H.HP_Body_Release(body));
      H.HP_World_Release(world);
    };
    const { KINEMATIC, DYNAMIC, STATIC } = H.MotionType;
    const plane = (system, [x, y, vx, vy, yaw, spin]) => {
      const [half, world] = [halfOf(system), made(-system.friction_force / system.mass)];
      const plate = bodyIn(world, box(PLATE), [0, 0, -PLATE[2]], 0, 1, [1, 1, 1], KINEMATIC);
      const shape = half ? box([half, half, half]) : H.HP_Shape_CreateSphere([0, 0, 0], RADIUS)[1];
      const inertia = [0, 0, half ? system.polar_inertia / system.mass : 0]; /* of 1 kg; 0 locks */
      const body = bodyIn(world, shape, [x, y, heightOf(system)], yaw, system.mass, inertia, DYNAMIC);
      H.HP_Body_SetAngularVelocity(plate, [0, 0, system.disc_speed]);
      H.HP_Body_SetLinearVelocity(body, [vx, vy, 0]);
      H.HP_Body_SetAngularVelocity(body, [0, 0, spin]);
      const state = () => {
        const [[, p], [, v]] = [H.HP_Body_GetPosition(body), H.HP_Body_GetLinearVelocity(body)];
        return [p[0], p[1], v[0], v[1], ...spinOf(body)];
      };
      const step = (h, [x, y, torque]) => {
        H.HP_Body_ApplyImpulse(body, H.HP_Body_GetPosition(body)[1], [x * h, y * h, 0]);
        if (half) H.HP_Body_ApplyAngularImpulse(body, [0, 0, torque * h]);
        run(world, h);
      };
      return { state, step, close: closed(world, [plate, body]) };
    };
    const hinge = (joint, spin) => {
      const world = made(0);
      const ground = bodyIn(world, null, [0, 0, 0], 0, 1, [1, 1, 1], STATIC);
      const body = bodyIn(world, null, [0, 0, 0], 0, joint.inertia, [1, 1, 1], DYNAMIC);
      H.HP_Body_SetAngularVelocity(body, [0, 0, spin]);
      const axle = H.HP_Constraint_Create()[1];
      H.HP_Constraint_SetParentBody(axle, ground);
      H.HP_Constraint_SetChildBody(axle, body);
      const axes = H.ConstraintAxis;
      for (const axis of [axes.LINEAR_X, axes.LINEAR_Y, axes.LINEAR_Z, axes.ANGULAR_X, axes.ANGULAR_Y])
        H.HP_Constraint_SetAxisMode(axle, axis, H.ConstraintAxisLimitMode.LOCKED);
      H.HP_Constraint_SetAxisFriction(axle, axes.ANGULAR_Z, joint.friction_moment);
      H.HP_Constraint_SetEnabled(axle, true);
      const step = (h, [torque]) => {
        H.HP_Body_ApplyAngularImpulse(body, [0, 0, torque * h]);
        run(world, h);
      };
      return { state: () => spinOf(body), step, close: closed(world, [ground, body]) };
    };
    return { plane, hinge, reach: PLATE[0], title: "Havok", version: versionOf("@babylonjs/havok") };
  },

  async cannon() {
    const C = installed("cannon-es");
    const plane = (system, [x, y, vx, vy, yaw, spin]) => {
      const half = halfOf(system);
      const gravity = new C.Vec3(0, 0, -system.friction_force / system.mass);
      const world = new C.World({ gravity, allowSleep: shipped });
      Object.assign(world.defaultContactMaterial, { friction: 1, restitution: 0 });
      const plate = new C.Body({ type: C.Body.KINEMATIC, shape: new C.Plane() });
      plate.angularVelocity.set(0, 0, system.disc_speed);
      const place = { position: new C.Vec3(x, y, heightOf(system)), velocity: new C.Vec3(vx, vy, 0) };
      const shape = half ? new C.Box(new C.Vec3(half, half, half)) : new C.Sphere(RADIUS);
      const body = new C.Body({ mass: system.mass, shape, fixedRotation: !half, ...place });
      body.quaternion.set(...quaternion(yaw));
      body.angularVelocity.set(0, 0, spin);
      if (half) {
        body.invInertia.set(0, 0, 1 / system.polar_inertia);
        body.updateInertiaWorld(true);
      }
      if (!shipped) Object.assign(body, { linearDamping: 0, angularDamping: 0 });
      world.addBody(plate);
      world.addBody(body);
      const state = () => {
        const { position: p, velocity: v, quaternion: q, angularVelocity } = body;
        return [p.x, p.y, v.x, v.y, yawOf(q.z, q.w), angularVelocity.z];
      };
      const step = (h, [x, y, torque]) => {
        body.applyForce(new C.Vec3(x, y, 0));
        body.applyTorque(new C.Vec3(0, 0, torque));
        /* The bound on friction is an impulse per step of mu*N*(1 s), so mu is h to correct it. */
        if (!shipped) world.defaultContactMaterial.friction = h;
        world.step(h);
      };
      return { state, step, close: () => {} };
    };
    return { plane, title: "cannon-es", version: versionOf("cannon-es"), precision: 0 };
  },

  async planck() {
    const P = installed("planck");
    const plane = (system, [x, y, vx, vy]) => {
      const world = new P.World({ gravity: { x: 0, y: 0 }, allowSleep: shipped });
      const plate = world.createKinematicBody();
      const at = { position: { x, y }, linearVelocity: { x: vx, y: vy } };
      const body = world.createDynamicBody({ ...at, fixedRotation: true });
      body.setMassData({ mass: system.mass, center: { x: 0, y: 0 }, I: 0 });
      world.createJoint(new P.FrictionJoint({ maxForce: system.friction_force, maxTorque: 0 }, plate, body, { x: 0, y: 0 }));
      const state = () => [body.getPosition().x, body.getPosition().y, body.getLinearVelocity().x, body.getLinearVelocity().y];
      const step = (h, [fx, fy]) => {
        const [x, y] = state();
        plate.setLinearVelocity({ x: -system.disc_speed * y, y: system.disc_speed * x });
        body.applyForceToCenter({ x: fx, y: fy }, true);
        world.step(h, 8, 3);
      };
      return { state, step, close: () => {} };
    };
    const hinge = (joint, spin) => {
      const world = new P.World({ gravity: { x: 0, y: 0 }, allowSleep: shipped });
      const [ground, body] = [world.createBody(), world.createDynamicBody({ angularVelocity: spin })];
      body.setMassData({ mass: 1, center: { x: 0, y: 0 }, I: joint.inertia });
      const motor = { enableMotor: true, motorSpeed: 0, maxMotorTorque: joint.friction_moment };
      world.createJoint(new P.RevoluteJoint(motor, ground, body, { x: 0, y: 0 }));
      const step = (h, [torque]) => {
        body.applyTorque(torque, true);
        world.step(h, 8, 3);
      };
      return { state: () => [body.getAngle(), body.getAngularVelocity()], step, close: () => {} };
    };
    return { plane, hinge, title: "planck", version: versionOf("planck"), precision: 0 };
  },
};

/* Returns the applied moment of a joint, linear between its points. */
function applied({ moment }, time) {
  const i = moment.findIndex(([t]) => t > time);
  if (i <= 0) return moment.length ? moment.at(i)[1] : 0;
  const [[t0, m0], [t1, m1]] = moment.slice(i - 1, i + 1);
  return m0 + ((m1 - m0) * (time - t0)) / (t1 - t0);
}

/* Returns the states of a body on the plate or of a joint; the angle counts whole turns. */
function simulate({ plane, hinge, reach = Infinity }, { system, state, times, step: longest }) {
  const joint = system.kind === "joint";
  if (joint && system.static_ratio > 1) return { unsupported: "a joint has one friction moment at rest and in motion" };
  if (system.kind === "points" && system.contact_points !== 4) return { unsupported: "a box has four corners" };
  const half = state.length / 2;
  let angle = joint ? state[0] : half > 2 ? state[2] : 0;
  const spin = joint ? state[1] : state[5] || 0;
  const body = joint ? hinge(system, spin) : plane(system, [...state.slice(0, 2), ...state.slice(half, half + 2), angle, spin]);
  let before = joint ? 0 : angle;
  const now = () => {
    const found = body.state();
    const [yaw, spin] = joint ? found : found.slice(4);
    if (yaw !== undefined) angle += Math.atan2(Math.sin(yaw - before), Math.cos(yaw - before));
    before = yaw;
    return joint ? [angle, spin] : [...found.slice(0, 4), angle, spin];
  };
  const outside = ([x, y]) => !joint && Math.hypot(x, y) > reach;
  let current = joint ? state : now();
  const states = [state];
  let left = outside(current);
  for (let i = 1; i < times.length; i++) {
    const steps = Math.ceil(((times[i] - times[i - 1]) / longest) * (1 - 1e-9));
    const h = (times[i] - times[i - 1]) / steps;
    for (let k = 0; k < steps; k++) {
      const spring = joint ? system.stiffness * (current[0] - system.offset) + system.damping * current[1] : 0;
      const forces = joint ? [applied(system, times[i - 1] + (k + 0.5) * h) - spring] : support(system, current);
      body.step(h, forces);
      current = now();
      left = left || outside(current);
    }
    const [x, y, vx, vy, turn, spin] = current;
    states.push(joint ? current : half > 2 ? [x, y, turn, vx, vy, spin] : [x, y, vx, vy]);
  }
  body.close();
  return left ? { unsupported: `the motion leaves the plate, which ends ${reach} m from the origin` } : { states };
}

engines[name]().then((engine) => {
  const { title, version, hinge, reach = Infinity, precision = 1e-6 } = engine;
  const ranges = reach < Infinity ? { coordinate: reach } : {};
  const kinds = boxes ? ["ring"] : ["pin", ...(hinge ? ["joint"] : [])]; /* points only if there are four */
  const who = { name: [title, ...words.map((word) => (word === "shipped" ? "as shipped" : word))].join(", "), version };
  process.stdout.write(JSON.stringify({ ...who, kinds, step: 2e-3, precision, ranges }) + "\n");
  require("readline")
    .createInterface({ input: process.stdin })
    .on("line", (line) => process.stdout.write(JSON.stringify(simulate(engine, JSON.parse(line))) + "\n"));
});
