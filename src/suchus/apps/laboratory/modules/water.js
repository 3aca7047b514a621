// Still water on a robot, section by section: buoyancy, added mass, drag and what is shed at the tail. It follows
// suchus.sim.hydro.forces and .kernel. A piece is an object with the columns of suchus.robot.design.water_table;
// all spatial vectors are MuJoCo's: rotation first, about the centre of mass of the whole tree.

const DISC = 0, BALL = 1, TURBULENT_REYNOLDS = 5e5;
const SUMS = 27, COUPLING = 6, LINEAR = 15, COUPLE = 21, FORCE = 24; // rows: rotational inertia first

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const times = (k, a) => [k * a[0], k * a[1], k * a[2]];
const blend = (a, x, b, y, c, z) => [a * x[0] + b * y[0] + c * z[0], a * x[1] + b * y[1] + c * z[1], a * x[2] + b * y[2] + c * z[2]];
const three = (values, start) => [values[start], values[start + 1], values[start + 2]];
const toWorld = (xmat, body, v) => [0, 3, 6].map((row) => xmat[9 * body + row] * v[0] + xmat[9 * body + row + 1] * v[1] + xmat[9 * body + row + 2] * v[2]);

/** Return the share of a unit shape under a plane, and its first moment along the plane's normal. */
export function immersed(kind, depth) {
  const d = Math.min(Math.max(depth, -1), 1), squared = 1 - d * d, half = Math.sqrt(squared);
  if (kind === DISC) return [0.5 + (Math.asin(d) + d * half) / Math.PI, -2 / 3 / Math.PI * squared * half];
  if (kind === BALL) return [(2 + 3 * d - d * d * d) / 4, -3 / 16 * squared * squared];
  return [(1 + d) / 2, -squared / 4];
}

/** Return how the share of a unit shape under a plane changes with its depth. */
function emergedPerRise(kind, depth) {
  const d = Math.min(Math.max(depth, -1), 1), squared = 1 - d * d;
  if (kind === DISC) return 2 / Math.PI * Math.sqrt(squared);
  if (kind === BALL) return 0.75 * squared;
  return Math.abs(depth) < 1 ? 0.5 : 0;
}

/** Return the volume of a robot under a level surface [m3]. */
export function submergedVolume(pieces, xpos, xmat, up, level) {
  return pieces.reduce((total, piece) => {
    const axes = [piece.across, piece.upward, piece.forward].map((axis) => toWorld(xmat, piece.body, axis));
    const centre = plus(three(xpos, 3 * piece.body), toWorld(xmat, piece.body, piece.at));
    const extent = Math.hypot(...axes.map((axis, i) => piece.half[i] * dot(up, axis)));
    return total + piece.volume * immersed(piece.kind, (level - dot(up, centre)) / extent)[0];
  }, 0);
}

/**
 * Add the water's forces to the passive forces and its added mass to the mass matrix.
 * @param {object[]} pieces pieces of the robot, their bodies numbered as MuJoCo numbers them.
 * @param {object} water level, density, viscosity, cross_drag, thickening, added_mass, shedding, splash, length, gravity, up.
 * @param {object} model arrays of the model: body_parentid, body_rootid, body_dofadr, body_dofnum, dof_bodyid, M_rownnz, M_rowadr, M_colind.
 * @param {object} data arrays of the data: qvel, xpos, xmat, subtree_com, cvel, cdof, cdof_dot; qfrc_passive and M are written.
 * @returns {number} the volume under water [m3]; the mass matrix must be factored anew where it is not 0.
 */
export function applyWater(pieces, water, model, data) {
  const dry = (piece) => water.level - dot(water.up, three(data.xpos, 3 * piece.body)) <= -piece.reach;
  if (pieces.every(dry)) return 0;
  const bodyCount = model.body_parentid.length, bias = biasAccelerations(model, data, bodyCount);
  const sums = new Float64Array(SUMS * bodyCount);
  let wetVolume = 0;
  for (const piece of pieces) wetVolume += addPiece(piece, water, model, data, bias, sums);
  if (wetVolume === 0) return 0;
  for (let body = bodyCount - 1; body > 0; body--) {
    const parent = model.body_parentid[body];
    if (parent > 0) for (let k = 0; k < SUMS; k++) sums[SUMS * parent + k] += sums[SUMS * body + k];
  }
  for (let i = 0; i < data.qvel.length; i++) {
    const start = SUMS * model.dof_bodyid[i];
    for (let k = 0; k < 6; k++) data.qfrc_passive[i] += data.cdof[6 * i + k] * sums[start + COUPLE + k];
    if (water.added_mass <= 0) continue;
    const [couple, force] = answer(sums, start, three(data.cdof, 6 * i), three(data.cdof, 6 * i + 3));
    const first = model.M_rowadr[i];
    for (let n = first; n < first + model.M_rownnz[i]; n++) {
      const j = 6 * model.M_colind[n];
      data.M[n] += dot(three(data.cdof, j), couple) + dot(three(data.cdof, j + 3), force);
    }
  }
  return wetVolume;
}

/** Return the spatial acceleration of each body with all joint accelerations set to zero. */
function biasAccelerations(model, data, bodyCount) {
  const bias = new Float64Array(6 * bodyCount);
  for (let body = 1; body < bodyCount; body++) {
    const parent = 6 * model.body_parentid[body], first = model.body_dofadr[body];
    for (let k = 0; k < 6; k++) bias[6 * body + k] = bias[parent + k];
    for (let dof = first; dof < first + model.body_dofnum[body]; dof++)
      for (let k = 0; k < 6; k++) bias[6 * body + k] += data.qvel[dof] * data.cdof_dot[6 * dof + k];
  }
  return bias;
}

/** Add the load and the added inertia of one piece to the sums of its body; return its volume under water [m3]. */
function addPiece(piece, water, model, data, bias, sums) {
  const body = piece.body;
  const [a, b, t] = [piece.across, piece.upward, piece.forward].map((axis) => toWorld(data.xmat, body, axis));
  const centre = plus(three(data.xpos, 3 * body), toWorld(data.xmat, body, piece.at));
  const [ua, ub, ut] = [a, b, t].map((axis, i) => piece.half[i] * dot(water.up, axis));
  const extent = Math.sqrt(ua * ua + ub * ub + ut * ut);
  const depth = (water.level - dot(water.up, centre)) / extent, [fraction, moment] = immersed(piece.kind, depth);
  if (!(fraction > 0)) return 0;
  const arm = times(1 / extent, blend(piece.half[0] * ua, a, piece.half[1] * ub, b, piece.half[2] * ut, t));
  const r = plus(centre, times(-1, three(data.subtree_com, 3 * model.body_rootid[body])));
  const omega = three(data.cvel, 6 * body), v = plus(three(data.cvel, 6 * body + 3), cross(omega, r));
  const w = [dot(v, a), dot(v, b), dot(v, t)], volume = piece.volume * fraction, dense = water.density * fraction;
  // buoyancy, at the centre of what is under water
  let f = times(water.density * volume * water.gravity, water.up);
  let torque = cross(times(moment / fraction, arm), f);
  // drag across and along, and of a flat piece that rolls, over the share under water
  const perSpeed = water.length / water.viscosity, speed = Math.abs(w[2]), roll = dot(omega, t), reynolds = speed * perSpeed;
  const turbulent = reynolds > TURBULENT_REYNOLDS ? 0.074 * reynolds ** -0.2 : 0;
  const friction = water.thickening * Math.max(1.328 / Math.sqrt(Math.max(reynolds, 1)), turbulent);
  const across = -0.5 * dense * water.cross_drag * Math.sqrt(w[0] * w[0] + w[1] * w[1]);
  const along = -0.5 * dense * (piece.skin * friction + piece.end) * speed;
  f = plus(f, blend(across * piece.area[0] * w[0], a, across * piece.area[1] * w[1], b, along * w[2], t));
  torque = plus(torque, times(-dense * water.cross_drag * piece.roll * Math.abs(roll) * roll, t));
  // momentum that is shed, where the tail ends and the water passes towards it
  const end = times(piece.shed_at, t), endVelocity = plus(v, cross(omega, end));
  const u = dot(endVelocity, t), wa = dot(endVelocity, a), wb = dot(endVelocity, b), shed = dense * water.added_mass * water.shedding;
  const half = 0.5 * shed * (piece.shed[0] * wa * wa + piece.shed[1] * wb * wb), flux = shed * Math.max(u, 0);
  const shedForce = blend(-flux * piece.shed[0] * wa, a, -flux * piece.shed[1] * wb, b, u > 0 ? half : 0, t);
  torque = plus(plus(torque, cross(end, shedForce)), cross(r, plus(f, shedForce)));
  f = plus(f, shedForce);
  // added mass: a spatial inertia about the point of reference, and its bias force
  const [ma, mb, mt] = piece.added.map((added) => dense * water.added_mass * added);
  const tensor = [0, 1, 2].map((i) => blend(ma * a[i], a, mb * b[i], b, mt * t[i], t));
  const apply = (vector) => [dot(tensor[0], vector), dot(tensor[1], vector), dot(tensor[2], vector)];
  const momentum = apply(v), rate = plus(three(bias, 6 * body + 3), cross(three(bias, 6 * body), r));
  const added = plus(apply(rate), cross(omega, momentum));
  f = plus(f, times(-1, added));
  torque = plus(torque, times(-1, plus(cross(v, momentum), cross(r, added))));
  // the change of added mass at the surface, whose cut lies at the depth times the point highest up
  const lever = times(depth, arm), cut = emergedPerRise(piece.kind, depth) / extent;
  const sunk = piece.added.map((value, i) => water.density * water.added_mass * value * w[i]);
  const fractionRate = -cut * dot(water.up, plus(v, cross(omega, lever))), lost = fractionRate + 0.5 * water.splash * Math.abs(fractionRate);
  const push = times(-0.5 * cut * dot(sunk, w), water.up);
  const change = plus(push, times(-lost, blend(sunk[0], a, sunk[1], b, sunk[2], t)));
  torque = plus(torque, plus(cross(lever, push), cross(r, change)));
  f = plus(f, change);
  const [x, y, z] = tensor.map((row) => cross(r, row)); // rows: force by rotation
  const parts = [r[1] * z[0] - r[2] * y[0], r[2] * x[0] - r[0] * z[0], r[2] * x[1] - r[0] * z[1],
    r[0] * y[0] - r[1] * x[0], r[0] * y[1] - r[1] * x[1], r[0] * y[2] - r[1] * x[2], ...x, ...y, ...z,
    tensor[0][0], tensor[1][0], tensor[1][1], tensor[2][0], tensor[2][1], tensor[2][2], ...torque, ...f];
  for (let k = 0; k < SUMS; k++) sums[SUMS * body + k] += parts[k];
  return volume;
}

/** Return couple and force of an added inertia that is accelerated. */
function answer(sums, start, turns, moves) {
  const s = sums.subarray(start, start + 6), m = sums.subarray(start + LINEAR, start + LINEAR + 6);
  const [x, y, z] = [0, 3, 6].map((row) => three(sums, start + COUPLING + row));
  const force = [dot(x, turns) + dot([m[0], m[1], m[3]], moves), dot(y, turns) + dot([m[1], m[2], m[4]], moves),
    dot(z, turns) + dot([m[3], m[4], m[5]], moves)];
  const couple = [dot([s[0], s[1], s[3]], turns) + dot([x[0], y[0], z[0]], moves),
    dot([s[1], s[2], s[4]], turns) + dot([x[1], y[1], z[1]], moves), dot([s[3], s[4], s[5]], turns) + dot([x[2], y[2], z[2]], moves)];
  return [couple, force];
}
