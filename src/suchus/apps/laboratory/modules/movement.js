// From phase to posture: the servo angles of a gait on a robot. It follows suchus.robot.motion and .kinematics.
// A robot and a gait are the objects that suchus.apps.laboratory.description writes.

const TAU = 2 * Math.PI;
const MAX_NEWTON_STEPS = 60, MAX_STEP = 0.6, DAMPING = 0.01, CONVERGED_ERROR = 1e-10, REACHED_ERROR = 1e-7;
const COSINE_TOLERANCE = 1e-12, REACH_MARGIN = 1e-6;
const MIN_STANCE_ANGLE = 0.02, MAX_STANCE_ANGLE = TAU - 0.02;

/** A gait that a robot's joints cannot follow; the message says why. */
export class OutsideLimits extends Error {}

export const modulo = (value, divisor) => value - divisor * Math.floor(value / divisor);
export const clip = (value, low, high) => Math.min(Math.max(value, low), high);
const sum = (values) => values.reduce((total, value) => total + value, 0);

/** Return the facts of a robot with its open ranges, which JSON writes as null, as infinite ones. */
export function readRobot(robot) {
  const open = (ranges) => ranges.map(([low, high]) => [low ?? -Infinity, high ?? Infinity]);
  return { ...robot, ranges: open(robot.ranges), limbs: robot.limbs.map((limb) => ({ ...limb, ranges: open(limb.ranges) })) };
}

/** Return the nearest whole number, the even one where two are as near. */
export function roundHalfEven(value) {
  const lower = Math.floor(value), rest = value - lower;
  if (rest !== 0.5) return Math.round(value);
  return modulo(lower, 2) === 0 ? lower : lower + 1;
}

/** Return a length as a whole number of picometres [m]. */
const metres = (fraction, reach) => Math.round(fraction * reach * 1e12) / 1e12;

/** Return the nearest of a quarter turn back, none, and a quarter turn forward: -1, 0, 1. */
const quarterTurn = (swivel) => roundHalfEven(clip(swivel * 2 / Math.PI, -1, 1));

/** Return the height of the root's axis above the ground in a gait [m]; 0 if the gait has none. */
export function hipHeight(robot, gait) {
  if (!robot.girdles.length || !gait.limbs.length) return 0;
  const hind = robot.girdles[robot.girdles.length - 1];
  return metres(gait.height, hind.reach) - hind.above;
}

/** Return how far a foot is along its path, -1 to 1 forward, and how far it is lifted, 0 to 1. */
function footPath(phase, duty) {
  const cycle = modulo(phase, 1), swing = 1 - duty;
  if (cycle >= swing) return [1 - 2 * ((cycle - swing) / duty), 0];
  const s = clip(cycle / swing, 0, 1);
  return [-Math.cos(Math.PI * s), Math.sin(Math.PI * s) ** 2];
}

// ---- limbs ---------------------------------------------------------------------------------------------------------

/** Return yaw, pitch and knee of a leg that bring its foot to a point: outward, forward, down from the yaw axis [rad]. */
function solveLeg(leg, point, side = 1) {
  const [femur, tibia] = leg.lengths;
  const x = point[0] * side, y = point[1] * side, z = point[2];
  const rho = Math.sqrt(x * x + y * y);
  let cosine = (z * z + rho * rho - (femur * femur + tibia * tibia)) / (2 * femur * tibia);
  if (!(Math.abs(cosine) <= 1 + COSINE_TOLERANCE)) throw unreachable(leg, point);
  cosine = clip(cosine, -1, 1);
  const sine = Math.sqrt((1 - cosine) * (1 + cosine));
  const transverse = sine * tibia, axial = cosine * tibia + femur, radial = rho * side;
  return [Math.atan2(y, x), Math.atan2(z * axial - radial * transverse, radial * axial + z * transverse),
    Math.atan2(sine, cosine)];
}

/** Return yaw, pitch, roll and elbow of an arm; the point is forward, outward, up from the hip [m]. */
function solveArm(arm, [x, y, z], swivel) {
  const [upper, lower] = arm.lengths;
  const squared = x * x + y * y + z * z, distance = Math.sqrt(squared);
  const elbow = Math.acos(clip((squared - upper ** 2 - lower ** 2) / (2 * upper * lower), -1, 1));
  const level = Math.hypot(x, y), safe = Math.max(level, 1e-300);
  const axial = (upper ** 2 - lower ** 2 + squared) / (2 * distance);
  const radial = Math.sqrt(Math.max(upper ** 2 - axial ** 2, 0));
  const [ux, uy, uz] = [x / distance, y / distance, z / distance];
  const upward = radial * Math.cos(swivel), sideways = radial * Math.sin(swivel);
  const azimuth = level > 0 ? y / safe : 1;
  const ex = axial * ux - upward * uz * x / safe + sideways * azimuth;
  const ey = axial * uy - upward * uz * azimuth - sideways * x / safe;
  const ez = axial * uz + upward * level / distance;
  const yaw = Math.atan2(ex, ey), pitch = Math.atan2(-ez, Math.hypot(ex, ey));
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  const [lx, ly, lz] = [x - ex, y - ey, z - ez];
  return [yaw, pitch, Math.atan2(cy * lx - sy * ly, -(sy * sp * lx + cy * sp * ly + cp * lz)), elbow];
}

/** Return the foot's place from the hip and its Jacobian, one column for each hinge, of a limb of any hinges. */
function chain(limb, angles) {
  let turn = [1, 0, 0, 0, 1, 0, 0, 0, 1], place = [0, 0, 0], number = 0;
  const apply = (m, v) => [0, 3, 6].map((i) => m[i] * v[0] + m[i + 1] * v[1] + m[i + 2] * v[2]);
  const pivots = [], axes = [];
  for (const link of limb.links) {
    for (const axis of link.axes) {
      pivots.push(place);
      axes.push(apply(turn, axis));
      turn = product(turn, rotation(axis, angles[number++]));
    }
    const arm = apply(turn, link.end);
    place = [0, 1, 2].map((i) => place[i] + arm[i]);
  }
  const columns = axes.map(([a, b, c], k) => {
    const [x, y, z] = [0, 1, 2].map((i) => place[i] - pivots[k][i]);
    return [b * z - c * y, c * x - a * z, a * y - b * x];
  });
  return [place, columns];
}

/** Return the matrix, row by row, of a turn about a unit axis by an angle. */
function rotation([x, y, z], angle) {
  const c = Math.cos(angle), s = Math.sin(angle), v = 1 - c;
  return [c + x * x * v, x * y * v - z * s, x * z * v + y * s, y * x * v + z * s, c + y * y * v, y * z * v - x * s,
    z * x * v - y * s, z * y * v + x * s, c + z * z * v];
}

function product(a, b) {
  const out = new Array(9).fill(0);
  for (let i = 0; i < 3; i++) for (let j = 0; j < 3; j++) for (let k = 0; k < 3; k++)
    out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return out;
}

/** Solve a small symmetric positive definite system in place, after Cholesky. */
function solvePositive(matrix, right) {
  const n = right.length;
  for (let i = 0; i < n; i++) for (let j = 0; j <= i; j++) {
    let value = matrix[i][j];
    for (let k = 0; k < j; k++) value -= matrix[i][k] * matrix[j][k];
    matrix[i][j] = i === j ? Math.sqrt(value) : value / matrix[j][j];
  }
  for (let i = 0; i < n; i++) { for (let k = 0; k < i; k++) right[i] -= matrix[i][k] * right[k]; right[i] /= matrix[i][i]; }
  for (let i = n - 1; i >= 0; i--) {
    for (let k = i + 1; k < n; k++) right[i] -= matrix[k][i] * right[k];
    right[i] /= matrix[i][i];
  }
  return right;
}

/** Return angles and remaining error after damped Gauss-Newton steps from a start, within the joints' ranges. */
function descend(limb, point, start) {
  let angles = start.map((angle, i) => clip(angle, ...limb.ranges[i])), error = Infinity;
  for (let step = 0; step < MAX_NEWTON_STEPS; step++) {
    const [foot, columns] = chain(limb, angles);
    const miss = [0, 1, 2].map((i) => (point[i] - foot[i]) / limb.reach);
    error = Math.hypot(...miss);
    if (!(error > CONVERGED_ERROR)) break;
    const damping = Math.min(DAMPING, error ** 2) + 1e-12;
    const scaled = columns.map((column) => column.map((value) => value / limb.reach));
    const normal = scaled.map((a, i) => scaled.map((b, j) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + (i === j ? damping : 0)));
    const right = scaled.map((a) => a[0] * miss[0] + a[1] * miss[1] + a[2] * miss[2]);
    const change = solvePositive(normal, right);
    angles = angles.map((angle, i) => clip(angle + clip(change[i], -MAX_STEP, MAX_STEP), ...limb.ranges[i]));
  }
  return [angles, error];
}

/** Return the angles of a limb without a closed form; the point is forward, outward, up from the hip [m]. */
function solveChain(limb, point) {
  const center = limb.ranges.map(([low, high]) => Number.isFinite(low) ? (low + high) / 2 : 0);
  let [angles, error] = descend(limb, point, center);
  for (const start of limb.restarts) {
    if (!(error > REACHED_ERROR)) break;
    const [other, otherError] = descend(limb, point, start);
    if (otherError < error) [angles, error] = [other, otherError];
  }
  if (error > REACHED_ERROR) throw new OutsideLimits(`${limb.name}: a foot point is not reached within the joints' ranges.`);
  return angles;
}

function unreachable(limb, point) {
  const [nearest, farthest] = limb.reaches;
  return new OutsideLimits(`the foot path of ${limb.name} is out of reach: a point lies ${Math.hypot(...point).toFixed(3)} m ` +
    `from the hip, and ${nearest.toFixed(3)} to ${farthest.toFixed(3)} m can be reached.`);
}

function checkReach(limb, point) {
  const [nearest, farthest] = limb.reaches, distance = Math.hypot(...point);
  if (!(distance >= nearest * (1 - 1e-9) - 1e-12 * farthest && distance <= farthest * (1 + 1e-9))) throw unreachable(limb, point);
}

/** Return a foot point moved along the line to the hip into the reach of a limb [m]. */
function clipToReach(point, [nearest, farthest]) {
  const length = Math.hypot(...point);
  if (length >= nearest && length <= farthest) return point;
  return point.map((value) => value * clip(length, nearest, farthest) / Math.max(length, REACH_MARGIN));
}

/** Return the hinge angles that bring a foot to a place: forward, outward, down from its hip [m]. */
function footAngles(limb, path, forward, outward, down, draw) {
  const [nearest, farthest] = limb.reaches;
  if (limb.kind !== "leg") {
    let point = [forward, outward, -down];
    if (draw) point = clipToReach(point, [nearest + REACH_MARGIN * farthest, farthest - REACH_MARGIN * farthest]);
    checkReach(limb, point);
    return limb.kind === "arm" ? solveArm(limb, point, path.swivel) : solveChain(limb, point);
  }
  let point = [outward, forward, down];
  if (draw) point = clipToReach(point, [nearest + REACH_MARGIN, farthest - REACH_MARGIN]);
  const side = quarterTurn(path.swivel);
  if (side === 0) return solveLeg(limb, point);
  const inPlane = side * point[1], angles = solveLeg(limb, [inPlane, 0, point[2]], inPlane < 0 ? -1 : 1);
  angles[0] = side * Math.PI / 2;
  return angles;
}

/** Return the angle of a crank, which grows by a whole turn a cycle [rad]. */
function crankAngle(phase, duty, stance, down) {
  const swing = 1 - duty, turns = Math.floor(phase), cycle = modulo(phase, 1), half = stance / 2;
  const angle = cycle < swing ? half - TAU + (TAU - stance) * cycle / swing : -half + stance * (cycle - swing) / duty;
  return down - (TAU * turns + angle);
}

// ---- axis ----------------------------------------------------------------------------------------------------------

/** Return the value at one hinge of knots that are evenly spread over some hinges. */
function atKnot(row, place, count) {
  if (row.length === count) return row[place];
  if (row.length === 1) return row[0];
  const position = (count > 1 ? place / (count - 1) : 0.5) * (row.length - 1);
  const knot = Math.min(Math.floor(position), row.length - 2);
  return row[knot] + (row[knot + 1] - row[knot]) * (position - knot);
}

const indicesIn = (hinges, region) => hinges.parts.flatMap((part, i) => region === "axis" || region === part ? [i] : []);

/** What the bends of a gait demand of a row of hinges: the bend of a region is offset + Re(swing z). */
class Waves {
  constructor(hinges, turn, gait) {
    this.hinges = hinges;
    const bends = gait.axis.filter((bend) => bend.turn === turn && indicesIn(hinges, bend.part).length);
    this.rows = hinges.servos.map((servo, k) => {
      const own = bends.filter((bend) => indicesIn(hinges, bend.part).includes(k));
      const counts = new Set(own.map((bend) => indicesIn(hinges, bend.part).length));
      const row = { servo, sign: hinges.signs[k], count: counts.size === 1 ? [...counts][0] : 1, re: 0, im: 0, offset: 0 };
      for (const bend of own) {
        const indices = indicesIn(hinges, bend.part), scale = row.count / indices.length, place = indices.indexOf(k);
        const amplitude = atKnot(bend.amplitude, place, indices.length), lag = atKnot(bend.lag, place, indices.length);
        const half = roundHalfEven(2 * lag), remainder = TAU * (lag - half / 2);
        const signed = modulo(half, 2) ? amplitude : -amplitude;
        row.re += scale * signed * Math.cos(remainder);
        row.im -= scale * signed * Math.sin(remainder);
        row.offset += scale * bend.offset;
      }
      return row;
    });
    this.moves = this.rows.some((row) => row.re || row.im || row.offset);
  }

  /** Return the angle by which one hinge bends [rad]. */
  bend(row, [re, im], size) { return (size * (row.re * re - row.im * im) + row.offset) / row.count; }
}

/** The harmonics of a measured curve, from the mean on, by its trigonometric interpolation. */
function harmonics(angles) {
  const count = angles.length;
  return Array.from({ length: Math.floor(count / 2) + 1 }, (_, k) => {
    const scale = (k >= 1 && k < Math.floor((count + 1) / 2) ? 2 : 1) / count;
    const turn = (n) => TAU * ((k * n) % count) / count;
    return [scale * sum(angles.map((angle, n) => angle * Math.cos(turn(n)))),
      -scale * sum(angles.map((angle, n) => angle * Math.sin(turn(n))))];
  });
}

// ---- the whole movement --------------------------------------------------------------------------------------------

/** A gait worked out for a robot. */
export class Movement {
  constructor(robot, gait) {
    this.robot = robot;
    this.gait = gait;
    if (gait.limb_phases.length !== robot.limbs.length)
      throw new OutsideLimits(`gait ${gait.name} has phases for ${gait.limb_phases.length} limbs, robot ${robot.name} has ${robot.limbs.length}.`);
    this.yaw = new Waves(robot.yaw, "yaw", gait);
    this.pitch = new Waves(robot.pitch, "pitch", gait);
    this.touchDown = 0.75 - gait.duty_factor / 2; // a quarter of a cycle before mid-stance
    const pulls = gait.coupling.length ? gait.coupling : gait.limb_phases.map((phase) => phase - gait.limb_phases[0]);
    const halves = pulls.map((pull) => roundHalfEven(2 * pull));
    this.signs = halves.map((half) => 1 - 2 * modulo(half, 2));
    this.remainders = pulls.map((pull, i) => pull - halves[i] / 2);
    this.cables = new Set(robot.cables.map((cable) => cable.servo));
    this.curves = gait.curves.map((curve) => {
      const servo = robot.servos.indexOf(curve.servo);
      const limb = robot.limbs.findIndex(({ servos: [start, stop] }) => start <= servo && servo < stop);
      return { servo, limb, harmonics: harmonics(curve.angles) };
    });
  }

  /** Return the order parameter of the limbs, which the axis follows: [real, imaginary]. */
  axisPhase(limbs) {
    const angles = limbs.map((phase, i) => TAU * (phase - this.touchDown - this.remainders[i]));
    const mean = (part) => sum(angles.map((angle, i) => part(angle) * this.signs[i])) / angles.length;
    return [mean(Math.cos), mean(Math.sin)];
  }

  /** Return the order parameter at a time since the beginning [cycle]. */
  axisOfClock(clock) {
    if (this.signs.length) return this.axisPhase(this.gait.limb_phases.map((phase) => clock + phase));
    const angle = TAU * (clock - this.touchDown);
    return [Math.cos(angle), Math.sin(angle)];
  }

  /**
   * Return the servo angles [rad] at a time since the gait began.
   * @param {number} clock time since it began [cycle].
   * @param {number|null} size factor on strokes and bends; null for 1. With a number, feet are drawn into reach.
   */
  targets(clock, size = null) {
    const { robot, gait } = this, out = new Float64Array(robot.servos.length), draw = size !== null, factor = draw ? size : 1;
    const phases = gait.limb_phases.map((phase) => clock + phase), z = this.axisOfClock(clock);
    if (gait.limbs.length) robot.limbs.forEach((limb, i) => {
      const part = gait.limbs[limb.girdle];
      const angles = this.limbAngles(limb, part, phases[i], factor, draw);
      limb.driven.forEach((hinge, k) => { out[limb.servos[0] + k] = angles[hinge] ?? 0; });
    });
    if (this.yaw.moves) {
      for (const row of this.yaw.rows)
        if (!this.cables.has(row.servo)) out[row.servo] = row.sign * this.yaw.bend(row, z, factor);
      for (const cable of robot.cables) {
        const rows = this.yaw.rows.filter((row) => row.servo === cable.servo);
        let bend = rows[0].sign * sum(rows.map((row) => this.yaw.bend(row, z, factor)));
        if (draw) bend = clip(bend, -cable.bend_limit, cable.bend_limit);
        out[cable.servo] = cable.joints * cable.cord_spacing * Math.sin(bend / (2 * cable.joints)) / cable.pulley;
      }
    }
    if (this.pitch.moves) for (const row of this.pitch.rows) out[row.servo] = this.pitch.bend(row, z, factor);
    const axisClock = Math.atan2(z[1], z[0]) / TAU + this.touchDown - (gait.limb_phases[0] ?? 0);
    for (const curve of this.curves) {
      const turns = curve.limb < 0 ? axisClock : phases[curve.limb] - gait.limb_phases[curve.limb];
      out[curve.servo] = sum(curve.harmonics.map(([re, im], k) => re * Math.cos(TAU * k * turns) - im * Math.sin(TAU * k * turns)));
    }
    if (draw) robot.ranges.forEach(([low, high], i) => { out[i] = clip(out[i], low, high); });
    return out;
  }

  limbAngles(limb, part, phase, factor, draw) {
    const duty = this.gait.duty_factor;
    if (part.kind === "fixed") return part.angles;
    if (part.kind === "sweep") {
      const stance = draw ? clip(factor * part.stance, MIN_STANCE_ANGLE, MAX_STANCE_ANGLE) : part.stance;
      return [crankAngle(phase, duty, stance, part.down)];
    }
    const [along, lifted] = footPath(phase, duty);
    const down = hipHeight(this.robot, this.gait) + limb.above - limb.foot_radius;
    return footAngles(limb, part, metres(part.ahead, limb.reach) + factor * metres(part.stroke, limb.reach) * along,
      metres(part.outward, limb.reach), down - metres(part.lift, limb.reach) * lifted, draw);
  }
}

/**
 * Return the servo angles that a controller commands at a time [rad]; before the gait begins the phases stand still.
 * @param {Movement} movement the gait on the robot.
 * @param {{begin: number, ramp: number}} control time at which it begins, and duration over which it grows [s].
 * @param {number} time since the beginning of the run [s].
 */
export function commandedAngles(movement, { begin, ramp }, time) {
  const since = Math.max(time - begin, 0), growth = ramp > 0 ? Math.min(since / ramp, 1) : null;
  return movement.targets(since / movement.gait.period, growth === null ? null : growth ** 2 * (3 - 2 * growth));
}
