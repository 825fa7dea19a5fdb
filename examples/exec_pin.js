/* A pin on a turning disc, in JavaScript, as an engine for friction-discs: one line of JSON in, one out.
 *
 *     friction-discs report trajectories --engine "exec:node exec_pin.js"
 *
 * Solves eq. 1 with the Runge-Kutta method and a fixed step. The greeting declares that it cannot stick, so it gets only
 * sliding motions. The greeting also gives the step in s for a tolerance of 1e-9; each request contains its own step. */
"use strict";

/* Returns the time derivative of a state. */
function rates(pin, [x, y, vx, vy]) {
  const [sx, sy] = [vx + pin.disc_speed * y, vy - pin.disc_speed * x];
  const hold = pin.friction_force / Math.hypot(sx, sy);
  const w = Math.hypot(x - pin.offset, y);
  const stop = w > pin.stop_gap ? pin.stop_stiffness * (1 - pin.stop_gap / w) : 0;
  const spring = pin.stiffness + pin.hardening * w * w + stop;
  return [
    vx,
    vy,
    (-hold * sx - spring * (x - pin.offset) - pin.damping * vx) / pin.mass,
    (-hold * sy - spring * y - pin.damping * vy) / pin.mass,
  ];
}

function step(pin, state, h) {
  const moved = (by, share) => state.map((value, i) => value + share * h * by[i]);
  const a = rates(pin, state);
  const b = rates(pin, moved(a, 1 / 2));
  const c = rates(pin, moved(b, 1 / 2));
  const d = rates(pin, moved(c, 1));
  return moved(a.map((_, i) => a[i] + 2 * b[i] + 2 * c[i] + d[i]), 1 / 6);
}

function simulate({ system, state, times, step: longest }) {
  const states = [state];
  for (let i = 1; i < times.length; i++) {
    const steps = Math.ceil((times[i] - times[i - 1]) / longest);
    for (let k = 0; k < steps; k++) state = step(system, state, (times[i] - times[i - 1]) / steps);
    states.push(state);
  }
  return { states };
}

const greeting = { name: "exec_pin.js", version: "1", kinds: ["pin"], sticks: false, step: 2e-3 };
process.stdout.write(JSON.stringify(greeting) + "\n");
require("readline")
  .createInterface({ input: process.stdin })
  .on("line", (line) => process.stdout.write(JSON.stringify(simulate(JSON.parse(line))) + "\n"));
