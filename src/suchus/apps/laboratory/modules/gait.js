// A gait's numbers, its control group, its limits and its file. It follows suchus.robot.motion.gait and .limits.
import { Movement, OutsideLimits } from "./movement.js";

const LIMIT_SAMPLES = 128, ANGLE_TOLERANCE = 1e-9, MAX_HALVINGS = 14;
const mean = (values) => values.reduce((total, value) => total + value, 0) / values.length;

// ---- numbers by name -------------------------------------------------------------------------------------------------

const lateral = (bend, parts) => bend.turn === "yaw" && parts.includes(bend.part);
const withAxis = (gait, change) => ({ ...gait, axis: gait.axis.map(change) });
const firstLag = (gait, ...parts) => gait.axis.find((bend) => lateral(bend, parts))?.lag[0] ?? 0;
const shiftLag = (gait, extra, ...parts) => extra === 0 ? gait : withAxis(gait, (bend) =>
  lateral(bend, parts) ? { ...bend, lag: bend.lag.map((lag) => lag + extra) } : bend);

const plain = (name) => ({ get: (gait) => gait[name], set: (gait, value) => ({ ...gait, [name]: value }) });

/** A number that all limbs of a kind have; it is that of the foremost, others keep their proportion to it. */
function ofLimbs(kind, name) {
  const get = (gait) => gait.limbs.find((limb) => limb.kind === kind)?.[name] ?? 0;
  const set = (gait, value) => {
    const current = get(gait);
    return { ...gait, limbs: gait.limbs.map((limb) => limb.kind !== kind || current === value ? limb :
      { ...limb, [name]: current ? limb[name] / current * value : value }) };
  };
  return { get, set };
}

/** The amplitude of a part's lateral bend: the mean of its knots, which keep their proportion. */
function bendOf(part) {
  const get = (gait) => gait.axis.filter((bend) => lateral(bend, [part])).reduce((total, bend) => total + mean(bend.amplitude), 0);
  const set = (gait, value) => {
    const current = get(gait);
    return withAxis(gait, (bend) => !lateral(bend, [part]) || current === value ? bend :
      { ...bend, amplitude: bend.amplitude.map((angle) => current ? angle / current * value : value) });
  };
  return { get, set };
}

/** A steady bend of a part, in its first bend or in an additional one. */
function steady(part, turn) {
  const isIt = (bend) => bend.turn === turn && bend.part === part;
  const get = (gait) => gait.axis.filter(isIt).reduce((total, bend) => total + bend.offset, 0);
  const set = (gait, value) => {
    const first = gait.axis.findIndex(isIt);
    const changed = withAxis(gait, (bend, i) => isIt(bend) ? { ...bend, offset: i === first ? value : 0 } : bend);
    if (first < 0) changed.axis.push({ part, turn, amplitude: [0], lag: [0], offset: value });
    return changed;
  };
  return { get, set };
}

const axisLag = (gait) => gait.axis.some((bend) => lateral(bend, ["trunk", "axis"])) ? firstLag(gait, "trunk", "axis") : firstLag(gait, "neck", "tail");
const tailLag = (gait) => firstLag(gait, "tail") - firstLag(gait, "trunk");
const wholeAxis = (gait) => gait.axis.find((bend) => lateral(bend, ["axis"]));

/** Numbers of a gait by name, each with a function that reads it and one that returns a changed gait. */
export const NUMBERS = {
  period: plain("period"), duty_factor: plain("duty_factor"), height: plain("height"),
  stroke: ofLimbs("path", "stroke"), lift: ofLimbs("path", "lift"), outward: ofLimbs("path", "outward"),
  ahead: ofLimbs("path", "ahead"), crank: ofLimbs("sweep", "stance"),
  trunk_bend: bendOf("trunk"), tail_bend: bendOf("tail"), axis_bend: bendOf("axis"),
  axis_lag: { get: axisLag, set: (gait, value) => shiftLag(gait, value - axisLag(gait), "neck", "trunk", "tail", "axis") },
  tail_lag: { get: tailLag, set: (gait, value) => shiftLag(gait, value - tailLag(gait), "tail") },
  waves: {
    get: (gait) => { const bend = wholeAxis(gait); return bend ? bend.lag[bend.lag.length - 1] - bend.lag[0] : 0; },
    set: (gait, value) => withAxis(gait, (bend) => lateral(bend, ["axis"]) ? { ...bend, lag: [bend.lag[0], bend.lag[0] + value] } : bend),
  },
  trunk_offset: steady("trunk", "yaw"), tail_offset: steady("tail", "yaw"), tail_pitch: steady("tail", "pitch"),
};

/** Return the control group of a gait: the same legs, its axis still. */
export const controlGroup = (gait) => ({ ...gait, name: "limbs_only", curves: gait.curves.filter((curve) => curve.part === "limb"),
  axis: gait.axis.map((bend) => ({ ...bend, amplitude: [0] })) });

// ---- limits ----------------------------------------------------------------------------------------------------------

/** Return why a robot's joints cannot follow a gait, in a sentence; empty where they can. */
export function limitText(robot, gait) {
  try {
    const movement = new Movement(robot, gait), postures = [];
    for (let i = 0; i < LIMIT_SAMPLES; i++) postures.push(movement.targets(i / LIMIT_SAMPLES));
    postures.push(...lateralEnds(movement, postures[0]));
    const tooMuch = cableText(movement);
    if (tooMuch) return tooMuch;
    const direct = robot.servos.length - robot.cables.length;
    for (let servo = 0; servo < direct; servo++) {
      const [low, high] = robot.ranges[servo], excess = (angle) => Math.max(low - angle, angle - high);
      const worst = postures.reduce((worst, row) => excess(row[servo]) > excess(worst) ? row[servo] : worst, postures[0][servo]);
      if (!(excess(worst) <= 0))
        return `${robot.servos[servo]} would have to turn to ${worst.toFixed(3)} rad; ${low.toFixed(3)} to ${high.toFixed(3)} rad is allowed.`;
    }
    return "";
  } catch (error) {
    if (error instanceof OutsideLimits) return error.message;
    throw error;
  }
}

const followed = (movement) => Math.hypot(...movement.axisOfClock(0));

/** Return a posture with the smallest and the greatest angles of the lateral wave [rad]. */
function lateralEnds(movement, posture) {
  const low = Float64Array.from(posture), high = Float64Array.from(posture), size = followed(movement);
  const measured = new Set(movement.curves.map((curve) => curve.servo));
  for (const row of movement.yaw.rows) {
    if (movement.cables.has(row.servo) || measured.has(row.servo)) continue;
    const swing = Math.max(size * Math.hypot(row.re, row.im) / row.count - ANGLE_TOLERANCE, 0), offset = row.sign * row.offset / row.count;
    low[row.servo] = offset - swing;
    high[row.servo] = offset + swing;
  }
  return [low, high];
}

/** Return which cable would have to bend its hinges beyond its limit; empty where none would. */
function cableText(movement) {
  for (const cable of movement.robot.cables) {
    const rows = movement.yaw.rows.filter((row) => row.servo === cable.servo);
    const total = (name) => rows.reduce((value, row) => value + row[name] / row.count, 0);
    const bend = followed(movement) * Math.hypot(total("re"), total("im")) + Math.abs(total("offset"));
    if (bend > cable.bend_limit + ANGLE_TOLERANCE)
      return `cable ${movement.robot.servos[cable.servo]} would have to bend its hinges by ${bend.toFixed(3)} rad together; up to ${cable.bend_limit.toFixed(3)} rad is allowed.`;
  }
  return "";
}

/**
 * Return a gait with one number changed as far as the joints allow, the value reached, and a sentence if it is another.
 * @param {object} robot the robot.
 * @param {object} gait a gait that it can follow.
 * @param {string} name name of the number.
 * @param {number} value what is asked for, in SI units.
 */
export function tuneGait(robot, gait, name, value) {
  const number = NUMBERS[name], changed = number.set(gait, value), text = limitText(robot, changed);
  if (!text) return { gait: changed, value, text: "" };
  let best = gait, reached = number.get(gait), width = value - reached;
  for (let i = 0; i < MAX_HALVINGS; i++) {
    width /= 2;
    const trial = number.set(gait, reached + width);
    if (!limitText(robot, trial)) { best = trial; reached += width; }
  }
  return { gait: best, value: reached, text };
}

// ---- its file --------------------------------------------------------------------------------------------------------

const real = (value) => Number.isInteger(value) ? `${value}.0` : `${value}`;
const inline = (value) => typeof value === "string" ? JSON.stringify(value) : typeof value === "number" ? real(value) : `[${value.map(inline).join(", ")}]`;

/** Return a gait as TOML that `suchus run displacement --gait FILE` reads. */
export function gaitToml(gait, name = gait.name) {
  const lines = [`name = ${inline(name)}`];
  const write = (table, skipped) => { for (const [key, value] of Object.entries(table)) if (!skipped.includes(key)) lines.push(`${key} = ${inline(value)}`); };
  write(gait, ["name", "limbs", "axis", "curves"]);
  for (const key of ["limbs", "axis", "curves"]) for (const table of gait[key]) { lines.push("", `[[${key}]]`); write(table, ["kind"]); }
  for (const key of ["limbs", "axis", "curves"]) if (!gait[key].length) lines.splice(1, 0, `${key} = []`);
  return lines.join("\n") + "\n";
}
