// The page: two robots, sliders, faults, pushes, the verdict after each cycle, and what is kept.
import { readRobot } from "./movement.js";
import { NUMBERS, controlGroup, gaitToml, limitText, tuneGait } from "./gait.js";
import { costOfTransport, displacement, dutyFactors, heightRange } from "./measures.js";
import { Walk, compile } from "./walk.js";

const MIN_BUDGET = 24, MAX_BUDGET = 150, BUDGET_SHARE = 0.5; // [ms] of simulation in a picture, and share of the time since the last one
const MAX_TAP_MOVE = 8, MAX_TAP_TIME = 500, TAP_REACH = 44; // [px], [ms], [px]
const MIN_ADVANCE = 0.01; // in each cycle [body length]; less is no walk
const EQUAL_RATIO = 0.05; // ratios nearer to 1 are called equal
const MIN_ASIDE = 0.62; // distance of the robots to the side [size: length, or reach to both sides]
const RESTING = "–";
const WEAK_FRACTION = 0.3;

/** Sentences on what the second robot keeps: its axis still, or where the axis cannot bend the first numbers. */
const REFERENCES = {
  axis: { other: "the one with its axis still", same: "Your gait does not bend the axis, so that both robots move alike.", costs: "Here bending the axis costs the way.",
    makes: "Here the way comes from bending.", equal: "Bending makes no difference of more than 5 %.", takes: "Bending takes it" },
  first: { other: "the one with the first numbers", same: "Both have the same numbers: change one, and the pale robot keeps the first ones.", costs: "Here your numbers cost the way.",
    makes: "Here the way comes from your numbers.", equal: "Your numbers make no difference of more than 5 %.", takes: "Your numbers take it" },
};

const element = (id) => document.getElementById(id);
const minus = (text) => text.replace("-", "−");
const percent = (value) => `${(100 * value).toFixed(0)} %`;
const KINDS = { limp: "limp (no torque)", weak: `weak (${percent(WEAK_FRACTION)} of the torque)`, locked: "locked (holds its angle)" };

/** Unpack bytes that a script element holds as base64. */
const bytesOf = (id) => Uint8Array.from(atob(element(id).textContent.trim()), (c) => c.charCodeAt(0));

/** Uncompress bytes that gzip has compressed. */
async function gunzip(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Say in a sentence that the page cannot run, and why. */
function refuse(text) {
  element("verdict-text").textContent = text;
  element("verdict-text").classList.add("refused");
}

/** Return a length with its unit; a length that is shown as zero has no sign. */
function metresText(value, places) {
  const text = value.toFixed(places);
  return minus(`${Number(text) === 0 ? text.replace("-", "") : text} m`);
}

/**
 * Return sentences on what two robots have done after some cycles.
 * @param {number} cycles number of cycles.
 * @param {number[]} forward displacement of the robot in the user's gait and of the one beside it [m].
 * @param {number} length length of the robot [m].
 * @param {boolean} differs whether the two move in different gaits.
 * @param {string} reference what the one beside it keeps: `axis` or `first`, see REFERENCES.
 */
export function verdictSentence(cycles, [mine, still], length, differs, reference = "axis") {
  const texts = REFERENCES[reference];
  const least = MIN_ADVANCE * length * cycles, places = length < 0.5 ? 3 : 2;
  const after = `After ${cycles} cycle${cycles > 1 ? "s" : ""}`;
  const way = (value) => Math.abs(value) < least ? "has hardly moved" : `is ${metresText(Math.abs(value), places)} ${value > 0 ? "ahead of" : "behind"} its start`;
  if (!differs) return `${after} the robot in your gait ${way(mine)}. ${texts.same}`;
  if (Math.abs(mine) < least && Math.abs(still) < least) return `${after} neither robot has moved by more than 1 % of its length in each cycle.`;
  const both = `${after} the robot in your gait ${way(mine)}; ${texts.other} ${way(still)}.`;
  if (mine < least) return `${both} ${texts.costs}`;
  if (still < least) return `${both} ${texts.makes}`;
  const ratio = mine / still;
  if (Math.abs(ratio - 1) < EQUAL_RATIO) return `${both} ${texts.equal}`;
  const factor = ratio.toFixed(ratio < 10 ? (ratio < 2 ? 2 : 1) : 0);
  return `${both} ${texts.takes} ${factor} times as far${ratio < 1 ? ": here it costs way" : ""}.`;
}

/** Return the measures of a run from the start of the first cycle on. */
export function measuresOf(record, start, end, { period, weight, loads }) {
  return { forward: displacement(record, start, end)[0], sideways: displacement(record, start, end)[1],
    height: heightRange(record, start, end), cost: costOfTransport(record, start, end, weight),
    duty: dutyFactors(record, start, end, { period, weight, loads }) };
}

class Laboratory {
  constructor(facts, player, mj) {
    this.facts = { ...facts, robot: readRobot(facts.robot) };
    this.player = player;
    this.mj = mj;
    const model = compile(mj, facts.files);
    this.walks = [0, 1].map(() => new Walk(mj, model, this.facts));
    this.gait = facts.gait;
    this.settings = { ...facts.settings };
    this.broken = new Map();
    player.meta.aside = Math.max(player.meta.aside, MIN_ASIDE * player.meta.size);
    this.stride = Math.max(1, Math.round(1 / (player.meta.rate * facts.physics.period)));
    this.pace = 1;
    this.changed = false;
    this.outputs = {};
    this.buildSliders();
    this.buildFaults();
    this.buildRest();
    this.readLink();
    this.begin();
    player.attach((time) => this.advance(time));
  }

  get robot() { return this.facts.robot; }
  get physics() { return this.facts.physics; }
  get weight() { return this.robot.mass * this.physics.gravity; }

  /** Return the gaits of both robots: the user's, and the one that it is compared with. */
  gaits() { return [this.gait, this.facts.reference === "axis" ? controlGroup(this.gait) : this.facts.gait]; }

  /** Return whether both robots move in different gaits. */
  differs() {
    if (this.facts.reference !== "axis") return JSON.stringify(this.gait) !== JSON.stringify(this.facts.gait);
    return this.gait.axis.some((bend) => bend.amplitude.some(Boolean)) || this.gait.curves.some((curve) => curve.part !== "limb");
  }

  // ---- time ------------------------------------------------------------------------------------------------------------

  /** Put both robots at the start, with the present gait, ground, water and faults. */
  begin() {
    const { player, settings } = this;
    const gaits = this.gaits();
    this.walks.forEach((walk, i) => {
      walk.begin(gaits[i], { friction: settings.friction, uphill: settings.uphill, level: settings.level, control: this.physics.control });
      for (const [servo, kind] of this.broken) walk.break(servo, kind, WEAK_FRACTION);
    });
    player.meta.slope = [Math.cos(settings.uphill / 2), 0, -Math.sin(settings.uphill / 2), 0];
    player.flood(settings.level, this.walks[0].up);
    player.restart();
    this.cycles = 0;
    this.changed = false;
    this.verdicts = [];
    this.keepFrame();
    this.say("");
    this.showVerdict();
    this.writeLink();
    player.redraw();
  }

  keepFrame() {
    this.walks.forEach((walk, i) => this.player.append(this.player.actors[i], this.withAnkles(walk.frame())));
  }

  /** Simulate both robots until a time, or as long as a picture may take; return the time that was reached [s]. */
  advance(target) {
    const { player, walks, physics } = this, reached = () => (player.actors[0].frames - 1) / player.meta.rate;
    const began = performance.now(), before = reached();
    const budget = Math.min(Math.max(BUDGET_SHARE * (began - (this.drawn ?? began)), MIN_BUDGET), MAX_BUDGET);
    this.drawn = began;
    while (reached() < target && performance.now() - began < budget && !walks.some((walk) => walk.cause)) {
      for (let i = 0; i < this.stride && !walks.some((walk) => walk.cause); i++) {
        for (const walk of walks) walk.advance();
        this.judge();
      }
      if (!walks.some((walk) => walk.cause)) this.keepFrame();
    }
    const failed = walks.findIndex((walk) => walk.cause);
    if (failed >= 0 && player.state.playing && target > reached()) {
      player.play(false);
      this.say(`${this.facts.labels[failed]}: ${walks[failed].cause}. Press "Start again"; smaller numbers may help.`);
    }
    if (target > before + 1e-9) this.pace = 0.9 * this.pace + 0.1 * Math.min(1, (reached() - before) / (target - before));
    this.showPace();
    return Math.min(target, reached());
  }

  /** Measure both robots where a cycle ends. */
  judge() {
    const { physics, gait } = this, next = physics.start + (this.cycles + 1) * gait.period;
    if (this.changed || this.walks[0].tick !== Math.round(next / physics.period) || this.walks.some((walk) => walk.cause)) return;
    this.cycles += 1;
    const settings = { period: gait.period, weight: this.weight, loads: physics.loads };
    this.verdicts = this.walks.map((walk) => measuresOf(walk.record, physics.start, walk.time, settings));
    this.showVerdict();
  }

  // ---- what is said ----------------------------------------------------------------------------------------------------

  say(text) { element("notice").textContent = text; }

  showPace() {
    const slow = this.pace < 0.9 && this.player.state.playing;
    element("pace").textContent = slow ? `This device computes ${percent(this.pace)} of the speed asked for.` : "";
  }

  showVerdict() {
    const { verdicts, cycles } = this, places = this.robot.length < 0.5 ? 3 : 2;
    element("verdict-text").textContent = this.changed ? "Numbers changed on the way: a verdict needs both from the same start. Press “Start again”."
      : cycles ? verdictSentence(cycles, verdicts.map((verdict) => verdict.forward), this.robot.length, this.differs(), this.facts.reference)
        : "The verdict comes with the end of the first cycle.";
    element("verdict-table").hidden = !cycles || this.changed;
    if (!cycles) return;
    const least = MIN_ADVANCE * this.robot.length * cycles, metre = (value) => metresText(value, places);
    const rows = { forward: (v) => metre(v.forward), sideways: (v) => metre(v.sideways), height: (v) => `${(1000 * v.height).toFixed(places === 2 ? 0 : 1)} mm`,
      cost: (v) => Math.hypot(v.forward, v.sideways) < least ? RESTING : v.cost.toPrecision(2) };
    if (this.robot.limbs.length) rows.duty = (v) => this.robot.limbs.map((limb, i) => `${limb.name} ${v.duty[i].toFixed(2)}`).join(" ");
    for (const [name, text] of Object.entries(rows))
      verdicts.forEach((verdict, i) => { element(`${name}-${i}`).textContent = text(verdict); });
  }

  // ---- sliders ---------------------------------------------------------------------------------------------------------

  buildSliders() {
    const { knobs } = this.facts;
    for (const [name, knob] of Object.entries(knobs)) {
      const row = document.createElement("label"), box = document.createElement("input"), output = document.createElement("output");
      const text = document.createElement("span");
      row.className = "slider";
      row.title = knob.hint;
      text.textContent = knob.label;
      Object.assign(box, { type: "range", id: `slide-${name}`, min: knob.low, max: knob.high, step: knob.step });
      box.value = this.shownValue(name);
      output.id = `value-${name}`;
      row.append(text, box, output);
      element(name in NUMBERS ? "gait-sliders" : name === "force" ? "push-sliders" : "ground-sliders").append(row);
      box.addEventListener("input", () => this.showValue(name, +box.value));
      box.addEventListener("change", () => this.change(name, +box.value));
      this.outputs[name] = { box, output };
      this.showValue(name, this.shownValue(name));
    }
    element("gait-none").hidden = Object.keys(knobs).some((name) => name in NUMBERS);
    element("water").addEventListener("change", (event) => this.fill(event.target.checked));
    this.showWater();
  }

  /** Return a number of the gait or of the world in the unit of its slider. */
  shownValue(name) {
    const { scale } = this.facts.knobs[name];
    return (name in NUMBERS ? NUMBERS[name].get(this.gait) : this.settings[name] ?? this.facts.wet_level) / scale;
  }

  showValue(name, value) {
    const { knobs } = this.facts, { box, output } = this.outputs[name], knob = knobs[name];
    const text = minus(`${+value.toPrecision(4)} ${knob.unit}`.trim());
    box.value = value;
    box.setAttribute("aria-valuetext", text);
    output.textContent = text;
  }

  /** Take a number from a slider or a link as far as the joints allow, and show what became of it. */
  change(name, shown) {
    const knob = this.facts.knobs[name];
    let notice = "";
    if (name in NUMBERS) {
      const tuned = tuneGait(this.robot, this.gait, name, shown * knob.scale);
      this.gait = tuned.gait;
      if (tuned.text) notice = `${knob.label}: the joints cannot follow ${+shown.toPrecision(4)} ${knob.unit}; it is ${+(tuned.value / knob.scale).toPrecision(4)} ${knob.unit} now. ${tuned.text}`;
    } else this.settings[name] = shown * knob.scale;
    this.showValue(name, this.shownValue(name));
    if (name !== "force") this.apply();
    if (notice) this.say(notice);
  }

  /** Start again after a change, or change the robots where they are. */
  apply() {
    if (element("restarts").checked || this.walks.some((walk) => walk.cause)) {
      this.begin();
      if (!this.calm) this.player.play(true);
      return;
    }
    const gaits = this.gaits();
    this.walks.forEach((walk, i) => walk.adapt(gaits[i], { ...walk.settings, friction: this.settings.friction, uphill: this.settings.uphill, level: this.settings.level }));
    this.player.meta.slope = [Math.cos(this.settings.uphill / 2), 0, -Math.sin(this.settings.uphill / 2), 0];
    this.player.flood(this.settings.level, this.walks[0].up);
    this.changed = true;
    this.say("");
    this.showVerdict();
    this.writeLink();
    this.player.redraw();
  }

  fill(hasWater) {
    this.settings.level = hasWater ? this.facts.wet_level : null;
    this.showWater();
    this.showValue("level", this.shownValue("level"));
    this.apply();
  }

  showWater() {
    const wet = this.settings.level !== null;
    element("water").checked = wet;
    this.outputs.level.box.disabled = !wet;
  }

  // ---- faults and pushes -------------------------------------------------------------------------------------------------

  buildFaults() {
    const select = element("joint");
    for (const name of this.robot.servos) select.append(new Option(name.replaceAll("_", " "), name));
    for (const kind of [...Object.keys(KINDS), "mend"])
      for (const place of ["fault-buttons", "menu"]) {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = kind;
        button.title = KINDS[kind] ?? "as it was built";
        button.addEventListener("click", () => { this.fault(select.value, kind); element("menu").hidden = true; });
        element(place).append(button);
      }
    element("mend-all").addEventListener("click", () => { for (const servo of [...this.broken.keys()]) this.fault(this.robot.servos[servo], "mend"); });
    const canvas = element("scene");
    let down = null;
    canvas.addEventListener("pointerdown", (event) => { down = { x: event.clientX, y: event.clientY, time: performance.now() }; element("menu").hidden = true; });
    canvas.addEventListener("pointerup", (event) => {
      const moved = down && Math.hypot(event.clientX - down.x, event.clientY - down.y);
      if (down && moved < MAX_TAP_MOVE && performance.now() - down.time < MAX_TAP_TIME) this.tap(event.clientX, event.clientY);
      down = null;
    });
  }

  /** Return the joint of either robot that is nearest to a place on the picture; null where none is near. */
  jointAt(x, y) {
    let best = null, least = TAP_REACH;
    this.walks.forEach((walk, i) => {
      if (i && this.player.state.compare === "hidden") return;
      const side = i && this.player.state.compare === "beside" ? this.player.meta.aside : 0;
      walk.hingePlaces().forEach((place, hinge) => {
        const seen = this.player.project(place, side), name = this.robot.hinges[hinge];
        const servo = this.robot.servos.includes(name) ? name : this.robot.servos[this.robot.cables.find((cable) => cable.hinges.includes(name))?.servo];
        const distance = seen && servo ? Math.hypot(seen[0] - x, seen[1] - y) : Infinity;
        if (distance < least) { least = distance; best = servo; }
      });
    });
    return best;
  }

  tap(clientX, clientY) {
    const box = element("scene").getBoundingClientRect(), [x, y] = [clientX - box.left, clientY - box.top], joint = this.jointAt(x, y);
    if (!joint) return;
    const menu = element("menu");
    element("joint").value = joint;
    element("menu-name").textContent = joint.replaceAll("_", " ");
    menu.hidden = false;
    menu.style.left = `${Math.max(4, Math.min(x, box.width - menu.offsetWidth - 4))}px`;
    menu.style.top = `${Math.max(4, Math.min(y + 12, box.height - menu.offsetHeight - 4))}px`;
  }

  /** Break or mend a servo of both robots now; the verdict goes on counting only from a start that both share. */
  fault(name, kind) {
    const servo = this.robot.servos.indexOf(name);
    if (kind === "mend" && !this.broken.has(servo)) return;
    if (kind === "mend") this.broken.delete(servo); else this.broken.set(servo, kind);
    for (const walk of this.walks) if (kind === "mend") walk.mend(servo); else walk.break(servo, kind, WEAK_FRACTION);
    this.showFaults();
    if (element("restarts").checked) this.apply(); else { this.changed = true; this.showVerdict(); this.writeLink(); }
  }

  showFaults() {
    const list = [...this.broken].map(([servo, kind]) => `${this.robot.servos[servo].replaceAll("_", " ")} ${kind}`);
    element("broken").textContent = list.length ? `Broken in both: ${list.join(", ")}.` : "Nothing is broken.";
    element("mend-all").hidden = !list.length;
  }

  buildRest() {
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.showFaults();
    element("again").addEventListener("click", () => { this.begin(); this.player.play(true); });
    element("defaults").addEventListener("click", () => {
      this.gait = this.facts.gait;
      this.settings = { ...this.facts.settings };
      this.broken.clear();
      for (const walk of this.walks) walk.mend();
      for (const name of Object.keys(this.outputs)) this.showValue(name, this.shownValue(name));
      this.showWater();
      this.showFaults();
      this.begin();
    });
    element("push").addEventListener("click", () => {
      const direction = { forward: [1, 0], back: [-1, 0], left: [0, 1], right: [0, -1] }[element("direction").value];
      for (const walk of this.walks) walk.pushBody(this.robot.root, [...direction.map((part) => part * this.settings.force), 0], this.facts.push_time);
      this.changed = true;
      this.showVerdict();
      this.say("Both were pushed at the same moment: watch who stays on course.");
    });
    element("save").addEventListener("click", () => {
      const name = element("name").value.trim() || "my_gait", file = document.createElement("a");
      file.download = `${name}.toml`;
      file.href = URL.createObjectURL(new Blob([this.toml(name)], { type: "application/toml" }));
      file.click();
      setTimeout(() => URL.revokeObjectURL(file.href), 10000);
    });
    element("link").addEventListener("focus", (event) => event.target.select());
    element("copy").addEventListener("click", async () => {
      try { await navigator.clipboard.writeText(element("link").value); this.say("The link is copied."); }
      catch { element("link").select(); this.say("This browser does not copy from a file: the link is marked, copy it by hand."); }
    });
  }

  /** Return the present gait as a file for `suchus run displacement --gait`. */
  toml(name) { return gaitToml(this.gait, name); }

  // ---- the link ------------------------------------------------------------------------------------------------------------

  /** Write all that differs from the beginning into the page's address. */
  writeLink() {
    const words = new URLSearchParams();
    for (const name of Object.keys(this.outputs)) {
      const knob = this.facts.knobs[name];
      const value = name in NUMBERS ? NUMBERS[name].get(this.gait) : this.settings[name];
      const first = name in NUMBERS ? NUMBERS[name].get(this.facts.gait) : this.facts.settings[name];
      if (value !== first) words.set(name, value === null ? "none" : `${+(value / knob.scale).toPrecision(12)}`);
    }
    if (this.broken.size) words.set("faults", [...this.broken].map(([servo, kind]) => `${this.robot.servos[servo]}:${kind}`).join(","));
    const hash = `${words}`;
    history.replaceState(null, "", hash ? `#${hash}` : location.href.split("#")[0]);
    element("link").value = location.href;
  }

  /** Take the numbers of the page's address; what is wrong there is said. */
  readLink() {
    const words = new URLSearchParams(location.hash.slice(1)), complaints = [];
    for (const [name, text] of words) {
      const knob = this.facts.knobs[name], number = Number(text);
      if (name === "faults") for (const part of text.split(",")) this.readFault(part, complaints);
      else if (name === "level" && text === "none") this.settings.level = null;
      else if (!knob) { if (name !== "t" && name !== "view") complaints.push(`${name} is no number of this page`); }
      else if (text === "" || !Number.isFinite(number)) complaints.push(`${name}=${text} is no number`);
      else {
        const value = Math.min(Math.max(number, knob.low), knob.high);
        if (value !== number) complaints.push(`${knob.label} ${text} is outside ${knob.low} to ${knob.high} ${knob.unit}`);
        if (name in NUMBERS) {
          const tuned = tuneGait(this.robot, this.gait, name, value * knob.scale);
          this.gait = tuned.gait;
          if (tuned.text) complaints.push(`${knob.label}: ${tuned.text}`);
        } else this.settings[name] = value * knob.scale;
      }
    }
    for (const name of Object.keys(this.outputs)) this.showValue(name, this.shownValue(name));
    this.showWater();
    this.showFaults();
    this.complaint = complaints.length ? `The link says what cannot be: ${complaints.join("; ")}.` : "";
  }

  readFault(part, complaints) {
    const [name, kind] = part.split(":"), servo = this.robot.servos.indexOf(name);
    if (servo < 0 || !(kind in KINDS)) complaints.push(`fault ${part} is not one of this robot`);
    else this.broken.set(servo, kind);
  }

  // ---- for the eye only ------------------------------------------------------------------------------------------------------

  /** Return a frame with the bones of ankles, which turn the soles down near the ground. */
  withAnkles(frame) {
    const { shanks, sides, radii, reach, heights: [flatAt, freeAt] } = this.facts.ankles;
    if (!shanks.length) return frame;
    const turns = [...frame.turns];
    shanks.forEach((bone, limb) => {
      const [w, x, y, z] = frame.turns.slice(4 * bone, 4 * bone + 4), side = sides[limb];
      const axis = [side * 2 * (x * y - w * z), side * (1 - 2 * (x * x + z * z)), side * 2 * (y * z + w * x)]; // the shank's
      const near = Math.min(Math.max((freeAt - (frame.feet[3 * limb + 2] - radii[limb])) / (freeAt - flatAt), 0), 1);
      const sine = Math.hypot(axis[0], axis[1]) || 1, angle = Math.min(Math.atan2(sine, -axis[2]), reach) * near * near * (3 - 2 * near);
      const [c, s] = [Math.cos(angle / 2), Math.sin(angle / 2)], [a, b] = [-axis[1] / sine * s, axis[0] / sine * s]; // turn about the level axis
      turns.push(c * w - a * x - b * y, c * x + a * w + b * z, c * y + b * w - a * z, c * z + a * y - b * x);
    });
    return { ...frame, turns, places: [...frame.places, ...frame.feet] };
  }
}

/** Start the page, or say why it cannot start. */
export async function start(loadEngine) {
  const facts = JSON.parse(element("facts").textContent);
  if (!window.laboratory) return refuse("This browser shows no WebGL 2, so that the robots cannot be drawn: try a current Firefox, Chrome, Edge or Safari.");
  if (typeof WebAssembly !== "object") return refuse("This browser has no WebAssembly, in which the physics runs: try a current Firefox, Chrome, Edge or Safari.");
  if (typeof DecompressionStream !== "function") return refuse("This browser cannot unpack the engine (it has no DecompressionStream): a version of 2023 or later can.");
  try {
    const mj = await loadEngine({ wasmBinary: await gunzip(bytesOf("engine-binary")), print: () => {}, printErr: () => {} });
    const laboratory = new Laboratory(facts, window.laboratory, mj);
    window.laboratory.page = laboratory;
    if (laboratory.complaint) laboratory.say(laboratory.complaint);
    const unable = limitText(laboratory.robot, laboratory.gait);
    if (unable) laboratory.say(unable);
    document.body.dataset.live = "ready";
  } catch (error) {
    refuse(`The engine cannot run the robot ${facts.robot.name}: ${error.message ?? error}`);
    console.error(error);
  }
}
