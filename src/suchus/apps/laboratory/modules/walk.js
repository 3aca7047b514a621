// One robot that walks or swims in the engine, MuJoCo in WebAssembly. It follows suchus.sim.land: one control period
// after another, in which the servos are commanded anew and the physics takes some steps.
import { Movement, commandedAngles, hipHeight } from "./movement.js";
import { applyWater, submergedVolume } from "./water.js";

const MAX_SPEED = 1e3; // [rad/s] or [m/s]; nothing on a robot moves so fast: the physics has diverged
const LOOP_DAMPING = 6, PID_DAMPING = 2; // columns of actuator_gainprm and actuator_biasprm
const SURFACE_TOLERANCE = 1e-9; // [m]
const MODEL_ARRAYS = ["body_parentid", "body_rootid", "body_dofadr", "body_dofnum", "dof_bodyid", "M_rownnz", "M_rowadr", "M_colind",
  "actuator_actadr", "actuator_group", "actuator_forcerange", "actuator_gainprm", "actuator_biasprm", "actuator_dyntype", "geom_friction", "jnt_qposadr"];
const DATA_ARRAYS = ["qpos", "qvel", "act", "ctrl", "sensordata", "xpos", "xquat", "xmat", "xfrc_applied", "actuator_length", "site_xpos",
  "xanchor", "subtree_com", "cvel", "cdof", "cdof_dot", "qfrc_passive", "M"];

/** Write the files of a robot into the engine's memory and compile them; the error says what it cannot load. */
export function compile(mj, files) {
  for (const [name, text] of Object.entries(files)) mj.FS.writeFile(`/${name}`, text);
  return mj.MjModel.from_xml_path("/scene.xml");
}

/** A robot on its ground or in its water, with the record of its run. */
export class Walk {
  /**
   * @param {object} mj the engine.
   * @param {object} base the compiled model, of which this run keeps a copy.
   * @param {object} facts what suchus.apps.laboratory.description writes: robot, physics, pieces.
   */
  constructor(mj, base, facts) {
    this.mj = mj;
    this.facts = facts;
    this.model = new mj.MjModel(base);
    this.data = new mj.MjData(this.model);
    this.model.opt.disableflags |= mj.mjtDisableBit.mjDSBL_ISLAND.value;
    const id = (kind, name) => mj.mj_name2id(this.model, kind.value, name), kinds = mj.mjtObj, { robot } = facts;
    this.bodies = robot.bodies.map((name) => id(kinds.mjOBJ_BODY, name));
    this.joints = robot.hinges.map((name) => id(kinds.mjOBJ_JOINT, name));
    const sensors = Array.from(this.model.sensor_adr), sensor = (name) => sensors[id(kinds.mjOBJ_SENSOR, name)];
    this.columns = { speed: robot.servos.map((name) => sensor(`${name}_velocity`)), torque: robot.servos.map((name) => sensor(`${name}_torque`)),
      com: sensor("centre_of_mass"), foot: robot.limbs.map((limb) => sensor(`${limb.name}_force`)),
      limb: robot.limbs.map((limb) => sensor(`${limb.name}_limb_force`)), tail: robot.has_tail ? sensor("tail_force") : -1 };
    this.feet = robot.limbs.map((limb) => id(kinds.mjOBJ_SITE, `${limb.name}_foot`));
    this.tip = id(kinds.mjOBJ_SITE, "tail_tip");
    this.pieces = facts.pieces.map((piece) => ({ ...piece, body: id(kinds.mjOBJ_BODY, piece.body) }));
    this.view();
    this.built = Object.fromEntries(["geom_friction", "actuator_forcerange"].map((name) => [name, Float64Array.from(this.m[name])]));
    this.faults = new Map();
    this.steps = Math.round(facts.physics.period / facts.physics.timestep);
  }

  /** Take the engine's arrays; they move when its memory grows. */
  view() {
    this.m = Object.fromEntries(MODEL_ARRAYS.map((name) => [name, this.model[name]]));
    this.d = Object.fromEntries(DATA_ARRAYS.map((name) => [name, this.data[name]]));
  }

  /**
   * Put the robot into the first posture of a gait.
   * @param {object} gait the gait.
   * @param {object} settings friction [times that of the design], uphill [rad], level of the water [m] or null, control.
   */
  begin(gait, settings) {
    const { mj, model, data, facts: { robot } } = this;
    this.gait = gait;
    this.settings = settings;
    this.movement = new Movement(robot, gait);
    mj.mj_resetData(model, data);
    this.view();
    this.mend();
    this.lay(settings);
    const rest = commandedAngles(this.movement, settings.control, 0);
    this.stand(rest);
    if (this.water) this.surface();
    const posture = Float64Array.from(this.d.qpos);
    mj.mj_resetData(model, data);
    this.view();
    this.d.qpos.set(posture);
    this.m.actuator_actadr.forEach((address, servo) => { this.d.act[address] = rest[servo]; });
    this.d.ctrl.set(rest);
    mj.mj_forward(model, data);
    this.view();
    this.tick = 0;
    this.cause = "";
    this.push = null;
    this.record = { time: [], com: [], load: [], power: [] };
    this.forces = { foot: robot.limbs.map(() => [0, 0, 0]), tail: 0 };
    this.store(robot.limbs.map(() => 0), 0);
  }

  /** Change gait, ground and water of a run while it goes on; the phase of the gait stays. */
  adapt(gait, settings) {
    const { begin } = settings.control, since = this.time - begin;
    const control = since > 0 ? { ...settings.control, begin: this.time - since * gait.period / this.gait.period } : settings.control;
    this.gait = gait;
    this.settings = { ...settings, control };
    this.movement = new Movement(this.facts.robot, gait);
    this.lay(settings);
  }

  /** Lay the ground and fill in the water. */
  lay(settings) {
    const { gravity, water } = this.facts.physics;
    this.model.opt.gravity.set([-gravity * Math.sin(settings.uphill), 0, -gravity * Math.cos(settings.uphill)]);
    this.up = [Math.sin(settings.uphill), 0, Math.cos(settings.uphill)];
    this.built.geom_friction.forEach((value, i) => { this.m.geom_friction[i] = i >= 3 && i % 3 === 0 ? value * settings.friction : value; });
    this.water = settings.level === null ? null : { ...water, level: settings.level, up: this.up, gravity, length: this.facts.robot.length };
  }

  /** Let the robot stand on the ground with some servo angles, nothing below the surface. */
  stand(angles) {
    const { robot } = this.facts, { mj, model, data } = this, qpos = this.d.qpos;
    const turn = -robot.trunk_yaw.reduce((total, servo) => total + angles[servo], 0) / 2;
    qpos.fill(0);
    qpos[2] = hipHeight(robot, this.gait);
    qpos[3] = Math.cos(turn / 2);
    qpos[6] = Math.sin(turn / 2);
    const address = (hinge) => this.m.jnt_qposadr[this.joints[robot.hinges.indexOf(hinge)]], cables = new Set(robot.cables.map((cable) => cable.servo));
    robot.servos.forEach((name, servo) => { if (!cables.has(servo)) qpos[address(name)] = angles[servo]; });
    for (const cable of robot.cables)
      for (const hinge of cable.hinges) qpos[address(hinge)] = angles[cable.servo] / (cable.cord_spacing / 2 / cable.pulley) / cable.joints;
    mj.mj_forward(model, data);
    this.view();
    this.d.qpos[2] -= Math.min(this.deepest(), 0);
  }

  /** Return the least distance of two touching shapes, negative where they overlap [m]; 0 where nothing touches. */
  deepest() {
    const contacts = this.data.contact;
    let least = 0;
    for (let i = 0; i < this.data.ncon; i++) { const contact = contacts.get(i); least = Math.min(least, contact.dist); contact.delete?.(); }
    contacts.delete?.();
    return least;
  }

  /** Lift the robot to the surface, level with it, if it floats clear of the ground. */
  surface() {
    const { mj, model, data, up, water } = this, { robot } = this.facts, weight = robot.mass / water.density;
    if (this.pieces.reduce((total, piece) => total + piece.volume, 0) <= weight) return;
    const standing = Float64Array.from(this.d.qpos);
    const size = Math.hypot(1 + up[2], -up[1], up[0]), raise = [(1 + up[2]) / size, -up[1] / size, up[0] / size, 0]; // from z to up
    const [w, x, y, z] = raise, [a, b, c, e] = standing.subarray(3, 7);
    this.d.qpos.set([0, 0, 0, w * a - x * b - y * c - z * e, w * b + x * a + y * e - z * c, w * c - x * e + y * a + z * b, w * e + x * c - y * b + z * a]);
    mj.mj_kinematics(model, data);
    let [low, high] = [-robot.length, robot.length]; // height of the root above the surface
    while (high - low > SURFACE_TOLERANCE / 100) {
      const middle = (low + high) / 2;
      if (submergedVolume(this.pieces, this.d.xpos, this.d.xmat, up, -middle) > weight) low = middle; else high = middle;
    }
    const rise = water.level + (low + high) / 2 - (up[0] * standing[0] + up[1] * standing[1] + up[2] * standing[2]);
    this.d.qpos.set([0, 1, 2].map((i) => standing[i] + rise * up[i]));
    mj.mj_forward(model, data);
    this.view();
    if (this.deepest() < 0) this.d.qpos.set(standing);
  }

  /** Time since the run began [s]. */
  get time() { return this.tick * this.facts.physics.period; }

  /** Let one control period pass. */
  advance() {
    if (this.cause) return;
    if (this.d.qpos.length === 0) this.view();
    const targets = commandedAngles(this.movement, this.settings.control, this.time);
    for (const [servo, fault] of this.faults) if (fault.kind === "locked") targets[servo] = fault.angle;
    this.d.ctrl.set(targets);
    this.applyPush();
    const { mj, model, data, columns } = this, { robot, physics } = this.facts, count = robot.servos.length;
    const laws = this.servoLaws(), loads = robot.limbs.map(() => 0), foot = robot.limbs.map(() => [0, 0, 0]);
    let power = 0, tail = 0;
    let speeds = columns.speed.map((column) => this.d.sensordata[column]);
    for (let step = 0; step < this.steps; step++) {
      if (this.water && applyWater(this.pieces, this.water, this.m, this.d) > 0 && this.water.added_mass > 0) mj.mj_factorM(model, data);
      mj.mj_step2(model, data);
      const sensed = this.d.sensordata, torques = columns.torque.map((column) => sensed[column]);
      columns.limb.forEach((column, limb) => { loads[limb] -= sensed[column + 2] / this.steps; });
      columns.foot.forEach((column, limb) => { for (let k = 0; k < 3; k++) foot[limb][k] -= sensed[column + k] / this.steps; });
      if (columns.tail >= 0) tail -= sensed[columns.tail + 2] / this.steps;
      mj.mj_step1(model, data);
      const after = columns.speed.map((column) => sensed[column]);
      for (let servo = 0; servo < count; servo++) {
        const saturated = Math.abs(torques[servo]) >= laws.limit[servo];
        const applied = torques[servo] - (saturated ? 0 : (after[servo] - speeds[servo]) * laws.damping[servo]);
        power += Math.abs(applied * (speeds[servo] + after[servo]) / 2) / this.steps;
      }
      speeds = after;
    }
    this.tick += 1;
    this.forces = { foot, tail };
    if (!this.d.qvel.every((speed) => Math.abs(speed) < MAX_SPEED)) this.cause = `the simulation diverged at ${(physics.period * this.tick).toFixed(2)} s`;
    else this.store(loads, power);
  }

  /** Return limit and damping of each servo, as the model has them now. */
  servoLaws() {
    const { m } = this, motor = this.mj.mjtDyn.mjDYN_DCMOTOR.value, count = this.facts.robot.servos.length;
    const gains = m.actuator_gainprm.length / count, biases = m.actuator_biasprm.length / count;
    const limit = [], damping = [];
    for (let servo = 0; servo < count; servo++) {
      const loop = m.actuator_dyntype[servo] === motor ? m.actuator_gainprm[gains * servo + LOOP_DAMPING] : -m.actuator_biasprm[biases * servo + PID_DAMPING];
      limit.push(m.actuator_forcerange[2 * servo + 1]);
      damping.push(this.faults.get(servo)?.kind === "limp" ? 0 : loop);
    }
    return { limit, damping };
  }

  store(loads, power) {
    const { record, columns } = this;
    record.time.push(this.time);
    record.com.push(Array.from(this.d.sensordata.subarray(columns.com, columns.com + 3)));
    record.load.push(loads);
    record.power.push(power);
  }

  // ---- faults and pushes ---------------------------------------------------------------------------------------------

  /** Break a servo now: limp (no torque), weak (a part of it), or locked (at the angle that it has). */
  break(servo, kind, fraction = 0.5) {
    this.mend(servo);
    this.faults.set(servo, { kind, angle: this.d.actuator_length[servo] });
    if (kind === "limp") this.model.opt.disableactuator |= 1 << this.m.actuator_group[servo];
    if (kind === "weak") for (const i of [2 * servo, 2 * servo + 1]) this.m.actuator_forcerange[i] = fraction * this.built.actuator_forcerange[i];
  }

  /** Mend a servo, or all of them. */
  mend(servo = null) {
    for (const broken of servo === null ? [...this.faults.keys()] : [servo]) {
      this.model.opt.disableactuator &= ~(1 << this.m.actuator_group[broken]);
      for (const i of [2 * broken, 2 * broken + 1]) this.m.actuator_forcerange[i] = this.built.actuator_forcerange[i];
      this.faults.delete(broken);
    }
  }

  /** Push a body with a force in the world [N] for a duration [s], from the next control period on. */
  pushBody(name, force, duration) { this.push = { body: this.bodies[this.facts.robot.bodies.indexOf(name)], force, end: this.time + duration }; }

  applyPush() {
    if (!this.push) return;
    const fraction = Math.min(Math.max((this.push.end - this.time) / this.facts.physics.period, 0), 1);
    for (let k = 0; k < 3; k++) this.d.xfrc_applied[6 * this.push.body + k] = fraction * this.push.force[k];
    if (fraction === 0) this.push = null;
  }

  // ---- what the player draws -----------------------------------------------------------------------------------------

  /** Return one frame: places and turns of the bodies, centre of mass, feet, forces, tail. */
  frame() {
    const { d } = this, three = (values, i) => Array.from(values.subarray(3 * i, 3 * i + 3));
    return { places: this.bodies.flatMap((body) => three(d.xpos, body)), turns: this.bodies.flatMap((body) => Array.from(d.xquat.subarray(4 * body, 4 * body + 4))),
      mass: this.record.com[this.record.com.length - 1], feet: this.feet.flatMap((site) => three(d.site_xpos, site)),
      forces: this.forces.foot.flat(), tail: [...three(d.site_xpos, this.tip), this.forces.tail] };
  }

  /** Return where each hinge is in the world [m]. */
  hingePlaces() { return this.joints.map((joint) => Array.from(this.d.xanchor.subarray(3 * joint, 3 * joint + 3))); }
}
