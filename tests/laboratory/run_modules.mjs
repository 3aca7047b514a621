// Runs the page's modules on inputs from standard input, and prints what they return; see tests/laboratory/node.py.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
import { pathToFileURL } from "node:url";

const [modules, engine] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(`${modules}/${name}.js`));
const { task, ...given } = JSON.parse(readFileSync(0, "utf8"));
const { Movement, commandedAngles, readRobot } = await load("movement");

async function walks() {
  const { Walk, compile } = await load("walk");
  const { default: loadMujoco } = await import(pathToFileURL(`${engine}/mujoco.mjs`));
  const mj = await loadMujoco({ wasmBinary: gunzipSync(readFileSync(`${engine}/mujoco.wasm.gz`)) });
  return (facts) => new Walk(mj, compile(mj, facts.files), { ...facts, robot: readRobot(facts.robot) });
}

const tasks = {
  async posture() {
    return given.cases.map(({ robot, gait, clocks, size }) => {
      const movement = new Movement(readRobot(robot), gait);
      return clocks.map((clock) => Array.from(movement.targets(clock, size)));
    });
  },
  async numbers() {
    const { NUMBERS } = await load("gait");
    return given.cases.map(({ gait, name, value }) => ({ before: NUMBERS[name].get(gait), gait: NUMBERS[name].set(gait, value) }));
  },
  async control() {
    const { controlGroup } = await load("gait");
    return given.gaits.map(controlGroup);
  },
  async limits() {
    const { limitText } = await load("gait");
    return given.cases.map(({ robot, gait }) => limitText(readRobot(robot), gait));
  },
  async toml() {
    const { gaitToml } = await load("gait");
    return given.gaits.map((gait) => gaitToml(gait));
  },
  async measures() {
    const { displacement, heightRange, costOfTransport, dutyFactors } = await load("measures");
    return given.cases.map(({ record, start, end, weight, period, loads }) => ({
      displacement: displacement(record, start, end), height: heightRange(record, start, end),
      cost: costOfTransport(record, start, end, weight), duty: dutyFactors(record, start, end, { period, weight, loads }) }));
  },
  async water() {
    const { applyWater } = await load("water");
    return given.states.map((data) => {
      const volume = applyWater(given.pieces, { ...given.water, up: data.up, level: data.level }, given.model, data);
      return { volume, passive: data.qfrc_passive, mass: data.M };
    });
  },
  async sentence() {
    const { verdictSentence } = await load("page");
    return given.cases.map((words) => verdictSentence(...words));
  },
  async walk() {
    const build = await walks();
    return given.cases.map(({ facts, settings, ticks, faults = [], push = null }) => {
      const walk = build(facts);
      walk.begin(facts.gait, { friction: 1, uphill: 0, level: null, control: facts.physics.control, ...settings });
      const first = Array.from(walk.d.qpos), started = performance.now();
      for (let tick = 0; tick < ticks; tick++) {
        for (const { at, servo, kind, fraction } of faults) if (at === tick) walk.break(servo, kind, fraction);
        if (push && push.at === tick) walk.pushBody(push.body, push.force, push.duration);
        walk.advance();
      }
      return { first, record: walk.record, cause: walk.cause, seconds: (performance.now() - started) / 1000 };
    });
  },
};
process.stdout.write(JSON.stringify(await tasks[task](), (_, value) => ArrayBuffer.isView(value) ? Array.from(value) : value));
