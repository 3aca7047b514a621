// Measures of a run, by the formulas of suchus.sim.metrics. A record is samples, one for each control period:
// {time: [s], com: [[x, y, z]], load: [[vertical load of each limb, N]], power: [absolute power of all servos, W]}.

const last = (values) => values[values.length - 1];
const TIME_TOLERANCE = 1e-9;

/** Return the first and the last sample of a window of time, both included. */
export function timeWindow(record, start, end = last(record.time)) {
  let first = 0, final = record.time.length - 1;
  while (record.time[first] < start - TIME_TOLERANCE) first++;
  while (record.time[final] > end + TIME_TOLERANCE) final--;
  return [first, final];
}

/** Return the displacement of the centre of mass in a window [m]. */
export function displacement(record, start, end) {
  const [first, final] = timeWindow(record, start, end);
  return [0, 1, 2].map((axis) => record.com[final][axis] - record.com[first][axis]);
}

/** Return the highest less the lowest height of the centre of mass in a window [m]. */
export function heightRange(record, start, end) {
  const [first, final] = timeWindow(record, start, end), heights = record.com.slice(first, final + 1).map((com) => com[2]);
  return heights.reduce((high, height) => Math.max(high, height)) - heights.reduce((low, height) => Math.min(low, height));
}

/** Return the work of all servos in a window, braking counted as much as driving [J]. */
export function work(record, start, end) {
  const [first, final] = timeWindow(record, start, end), powers = record.power.slice(first + 1, final + 1);
  return (record.time[final] - record.time[first]) * powers.reduce((total, power) => total + power, 0) / powers.length;
}

/** Return the work per weight and displacement along the ground [-]. */
export function costOfTransport(record, start, end, weight) {
  const [x, y] = displacement(record, start, end);
  return work(record, start, end) / (weight * Math.hypot(x, y));
}

/** Return the share of the time in which each limb stands [-], the last sample left out, which begins the next cycle. */
export function dutyFactors(record, start, end, { period, weight, loads }) {
  const [first, final] = timeWindow(record, start, end), interval = record.time[1] - record.time[0];
  return record.load[0].map((_, limb) => {
    const stands = stance(record.load.map((row) => row[limb] / weight), period, interval, loads).slice(first, final);
    return stands.filter(Boolean).length / stands.length;
  });
}

/** Return whether one limb is in stance at each sample, by its vertical load over the robot's weight. */
export function stance(load, period, interval, { begin, end, shortest }) {
  const count = load.length, windowSamples = shortest * period / interval;
  const half = Math.min(roundEven(windowSamples / 2), count - 1), width = 2 * half + 1;
  const padded = (i) => load[Math.min(Math.max(i, 0), count - 1)];
  const held = new Array(count);
  let state = false;
  for (let i = 0; i < count; i++) {
    let mean = 0;
    for (let k = -half; k <= half; k++) mean += padded(i + k) / width;
    if (i === 0 || mean > begin || mean < end) state = mean > begin;
    held[i] = state;
  }
  return trim(withoutShort(held, roundEven(windowSamples)), load, begin, end);
}

function roundEven(value) {
  const lower = Math.floor(value);
  return value - lower === 0.5 ? lower + lower % 2 : Math.round(value);
}

/** Return intervals of equal state: [state, first sample, sample after the last]. */
function intervals(state) {
  const out = [];
  state.forEach((value, i) => { if (!out.length || last(out)[0] !== value) out.push([value, i, i + 1]); else last(out)[2] = i + 1; });
  return out;
}

/** Return a state without intervals shorter than some samples: false ones first, then true ones; the ends stay. */
function withoutShort(state, samples) {
  for (const value of [false, true]) {
    const parts = intervals(state);
    state = parts.flatMap(([own, start, stop], i) => {
      const isShort = own === value && stop - start < samples && i > 0 && i < parts.length - 1;
      return new Array(stop - start).fill(isShort ? !own : own);
    });
  }
  return state;
}

/** Return stances that last from their first load to their last one. */
function trim(state, load, begin, end) {
  const parts = intervals(state);
  return parts.flatMap(([own, start, stop], i) => {
    let first = stop, final = start - 1;
    for (let k = start; k < stop; k++) { if (load[k] > begin) first = Math.min(first, k); if (load[k] > end) final = k; }
    if (i === 0) first = 0;
    if (i === parts.length - 1) final = load.length;
    return Array.from({ length: stop - start }, (_, k) => own && start + k >= first && start + k <= final);
  });
}
