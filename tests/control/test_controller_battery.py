"""What every controller does on eight bodies of the shelf and three foreign ones."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.bodies import hatchling
from tests.felt import felt

from body_files import imported_quadruped, rigid
from suchus.core import rotation
from suchus.core.errors import OutsideLimits
from suchus.robot.control import (
    LAWS,
    AttitudeRule,
    Coordinated,
    HeadingHold,
    HeadingRule,
    LoadRule,
    OpenLoop,
    PatternGenerator,
    Runs,
    Standing,
    Swimming,
    Walking,
    oscillate,
)
from suchus.robot.control.attitude import Attitude
from suchus.robot.control.facing import HeadingEstimator
from suchus.robot.control.heading import TRUNK_PER_STEERING
from suchus.robot.control.holding import HeadingHolds
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import coarse_step, control_period, rescale
from suchus.robot.gaits import GAITS, MIN_TRUNK_STEERING, default_gait, in_size, trunk_steering
from suchus.robot.motion import START, Gait, min_gait_period
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Live, Run, measure_trunk_steering, simulate
from suchus.sim.metrics import heading
from suchus.sim.metrics.reach import reach

CAIMAN = ROBOTS["caiman"]
FOREIGN = ("rigid", "hatchling", "quadruped")
BODIES = (*ROBOTS, *FOREIGN)
LIMBED = tuple(name for name in BODIES if name != "swimmer")
OFF = Coordinated(limbs=LAWS["off"], spine=None, tail=None)
STILL = HeadingRule(gain=0.0, integral_gain=0.0)
LEVEL = AttitudeRule(roll=0.0, roll_rate=0.0, pitch=0.0, pitch_rate=0.0)


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    """Return a body and its gait by name, made once."""
    cache: dict[str, tuple[Robot, Gait]] = {}

    def find(name: str) -> tuple[Robot, Gait]:
        if name not in cache:
            made = {"rigid": rigid, "hatchling": hatchling}
            if name == "quadruped":
                robot = imported_quadruped(tmp_path_factory.mktemp(name))
            else:
                robot = made[name]() if name in made else ROBOTS[name]
            cache[name] = robot, default_gait(robot)
        return cache[name]

    return find


def start(controls, robot, gait, period=None, ticks=3000):
    period = period or control_period(robot)
    many = len(controls)
    return controls[0].start(Runs(tuple(controls), (robot,) * many, (gait,) * many, (0,) * many, ticks), period)


def shaken(robot, rng, runs=1):
    """Return what robots feel that are shaken at random."""
    place = layout(robot)
    angles = 0.2 * rng.standard_normal((runs, 3))
    return felt(
        robot,
        runs,
        orientation=np.array([rotation.from_angles(*row) for row in angles]),
        angular_velocity=rng.standard_normal((runs, 3)),
        servo_position=0.2 * rng.standard_normal((runs, len(place.servos))),
        servo_torque=0.2 * rng.standard_normal((runs, len(place.servos))),
        foot_pressure=robot.mass * rng.uniform(0.0, 5.0, (runs, len(place.limbs))),
    )


def of_runs(sensed, runs):
    """Return the readings of some runs."""
    names = [name for name in sensed.__dataclass_fields__ if name != "time"]
    return replace(sensed, **{name: getattr(sensed, name)[runs] for name in names})


def answers(controls, robot, gait, *, ticks=20, runs=slice(None)):
    """Return the servo angles that shaken robots are commanded, shape (tick, run, servo).

    Args:
        controls: of the whole batch.
        robot: the body.
        gait: its gait.
        ticks: control periods after the walk has begun.
        runs: those of which the controller takes care.
    """
    rng, chosen = np.random.default_rng(0), controls[runs]
    controller, first = start(chosen, robot, gait), round(START / control_period(robot)) - 2
    found = []
    for tick in range(first, first + ticks):
        sensed = of_runs(shaken(robot, rng, len(controls)), runs)
        found.append(controller.command(tick, sensed if any(c.feels for c in chosen) else None).targets)
    return np.array(found)


# --- no gain ---


@pytest.mark.parametrize("name", BODIES)
def test_without_gain_a_controller_commands_the_open_loop_to_the_byte(body, name):
    robot, gait = body(name)
    pairs = [(Walking(attitude=LEVEL), Walking())]
    if layout(robot).limbs:
        pairs.append((replace(OFF, heading=STILL), OpenLoop()))
    swim = GAITS["undulation"] if name == "swimmer" else gait
    idle = HeadingHold(gain=0.0, integral_gain=0.0, trunk_turn=0.0)
    pairs.append((Swimming(ramp=0.0, heading=idle), Swimming(ramp=0.0)))
    if layout(robot).trunk_yaw or name == "swimmer":
        pairs.append((PatternGenerator(load=LoadRule(afloat=0.0)), PatternGenerator()))
    for idle_control, plain in pairs:
        one, other = (answers([control], robot, swim) for control in (idle_control, plain))
        assert one.tobytes() == other.tobytes(), type(plain).__name__


# --- mates of a batch ---


@pytest.mark.parametrize("name", BODIES)
def test_mates_of_a_batch_do_not_touch_each_other(body, name):
    robot, gait = body(name)
    groups = [[Walking(attitude=rule) for rule in (None, AttitudeRule(), AttitudeRule(roll=3.0, memory=0.0))]]
    if layout(robot).limbs:
        rules = (None, HeadingRule(direction=1.0), HeadingRule(gain=9.0, trunk=0.1, rate=1.0))
        groups.append([replace(OFF, heading=rule) for rule in rules])
    if layout(robot).trunk_yaw or name == "swimmer":
        bends = [0.0, 0.1, -0.1]
        groups.append([PatternGenerator(steering=1.0, steering_gain=b, drive=2.0 + 5 * abs(b)) for b in bends])
    for controls in groups:
        together = answers(controls, robot, gait)
        for i in range(len(controls)):
            alone = answers(controls, robot, gait, runs=slice(i, i + 1))
            # the vectors of another length may round otherwise in the last bit
            np.testing.assert_allclose(alone[:, 0], together[:, i], rtol=0.0, atol=1e-13)


# --- the attitude ---


def lowered(robot, rule, period, time, rate_of):
    """Return how far the feet go down after a time of rolling and pitching at a rate [m]."""
    attitude = Attitude([rule], [robot], period)
    attitude.foot_lowering(felt(robot))
    for tick in range(1, round(time / period) + 1):
        angle, rate = rate_of(tick * period)
        sensed = felt(
            robot, orientation=rotation.from_angles(0.0, 0.0, angle), angular_velocity=[rate, 0.5 * rate, 0.0]
        )
        found = attitude.foot_lowering(sensed)
    return found[0]


@pytest.mark.parametrize("name", ["caiman", "salamander", "hatchling", "rigid"])
def test_the_attitude_rule_means_the_same_at_half_the_control_period(body, name):
    robot, _ = body(name)
    size = (robot.length / CAIMAN.length) ** 0.5
    frequency, period = 2.0 / size, control_period(robot)

    def swaying(t):
        return 0.03 * np.sin(2 * pi * frequency * t), 0.03 * 2 * pi * frequency * np.cos(2 * pi * frequency * t)

    once, twice = (lowered(robot, AttitudeRule(), p, 0.6 * size, swaying) for p in (period, period / 2))
    assert np.abs(once).max() > 1e-3 * robot.length
    assert once == pytest.approx(twice, abs=0.2 * np.abs(once).max())


def test_a_small_body_is_levelled_as_the_large_one_is_in_the_time_of_its_size():
    quarter = rescale(CAIMAN, length_factor=0.25)
    large = lowered(CAIMAN, AttitudeRule(), 0.01, 0.5, lambda t: (0.05 * t, 0.05))
    small = lowered(quarter, AttitudeRule(), 0.005, 0.25, lambda t: (0.1 * t, 0.1))
    assert small == pytest.approx(0.25 * large, rel=1e-6)


def test_the_attitude_rule_does_not_shake_the_servos():
    gait = GAITS["semi_erect"]
    runs = [
        Run(robot=CAIMAN, gait=gait, control=Walking(attitude=rule))
        for rule in (AttitudeRule(), AttitudeRule(memory=0.0))
    ]
    record = simulate(runs, duration=START + 2 * gait.period, timestep=coarse_step(CAIMAN))
    change = np.diff(record.servo_target.sel(time=slice(START, None)).transpose("run", "time", "servo").values, axis=1)
    turns_back = (change[:, 1:] * change[:, :-1] < -1e-14).mean(axis=(1, 2))
    assert turns_back[0] < 0.12
    assert turns_back[1] > 0.15  # unfiltered every sixth command turns back


# --- the heading ---

WALKS = {
    "upright": "high_walk",
    "pleurobot": "pleurobot_walk",
    "salamandra": "salamandra_walk",
    "strider": "tripod",
    "rigid": "",
    "hatchling": "low_crawl",
}
CYCLES = {"upright": 19, "salamandra": 20}
SWAY = {"pleurobot": 0.08}  # its heading sways by as much from cycle to cycle [rad]
DEGREES = (30, 90, -90)


@pytest.mark.parametrize("name", list(WALKS))
def test_asked_headings_are_kept_left_and_right_alike(body, name):
    robot, gait = body("caiman" if name == "upright" else name)
    gait = GAITS[WALKS[name]] if WALKS[name] else gait
    if name == "hatchling":
        gait = in_size(gait, robot, CAIMAN)
    asked = np.radians(DEGREES)  # straight ahead is nothing to steer
    runs = [Run(robot=robot, gait=gait, control=replace(OFF, heading=HeadingRule(direction=a))) for a in asked]
    duration = START + CYCLES.get(name, 12) * gait.period
    record = simulate(runs, duration=duration, timestep=coarse_step(robot), sample_stride=4)
    facing = heading(record)
    late = facing.sel(time=slice(duration - 2 * gait.period, None)).mean("time")
    kept = (late - facing.isel(time=0)).values
    assert kept == pytest.approx(asked, abs=SWAY.get(name, 0.05))
    assert kept[1] == pytest.approx(-kept[2], abs=SWAY.get(name, 0.05))


@pytest.mark.parametrize("name", LIMBED)
def test_a_turn_that_is_asked_at_once_stays_within_the_servos_speed(body, name):
    robot, gait = body(name)
    period, speed = control_period(robot), np.array([robot.servo(s).speed for s in layout(robot).servos])
    control = replace(OFF, heading=HeadingRule(direction=pi / 2))
    controller, first = start([control], robot, gait), round(START / period)
    ticks = range(first, first + round(2 * gait.period / period))
    targets = np.array([controller.command(tick, felt(robot)).targets[0] for tick in ticks])
    most = (np.abs(np.diff(targets, axis=0)) / period / speed).max()
    assert most < 1.1 * max(1.0, min_gait_period(robot, gait)[0] / gait.period)


@pytest.mark.parametrize("moment", [0.0, 0.2, 0.45, 0.7])
def test_a_heading_that_is_switched_on_in_a_walk_is_the_mean_of_the_cycle(moment):
    facing, cycle = HeadingEstimator([CAIMAN], [100]), 100
    facing.begin_in_motion()

    def swaying(tick):
        yaw = 0.4 + 0.2 * np.sin(2 * pi * (tick / cycle + moment))
        return felt(CAIMAN, orientation=rotation.from_angles(yaw, 0.0, 0.0))

    found = np.array([facing.feel(swaying(tick))[0] for tick in range(3 * cycle)])
    assert found == pytest.approx(np.zeros(3 * cycle), abs=1e-9)
    assert facing.has_reference.all()


@pytest.mark.parametrize("moment", [1.0, 1.3])
def test_a_live_walk_keeps_the_heading_of_the_cycle_in_which_the_loop_is_switched_on(moment):
    gait, control = GAITS["low_crawl"], replace(OFF, heading=HeadingRule())
    walk, cycle = Live(Run(robot=CAIMAN, gait=gait, control=OFF), timestep=coarse_step(CAIMAN)), 200
    facing, yaws = [], list(layout(CAIMAN).trunk_yaw)
    first = round((START + moment * gait.period) / 0.01)
    for tick in range(first + 4 * cycle):
        if tick == first:
            walk.walk(control=control)
        walk.step()
        bend = walk.current_sample["servo_angle"][yaws].sum()
        facing.append(rotation.yaw(np.asarray(walk.current_sample["orientation"])) + bend / 2)
    kept = np.mean(facing[-cycle:])
    assert kept == pytest.approx(np.mean(facing[first : first + cycle]), abs=0.03)
    assert np.ptp(facing[first : first + cycle]) > 0.1  # a moment says less


def test_another_period_keeps_the_mean_heading():
    """The history of the last cycle goes on, so that the swing of a moment does not count as an error."""
    old, new = HeadingEstimator([CAIMAN], [100]), HeadingEstimator([CAIMAN], [50])

    def swaying(tick):
        return felt(CAIMAN, orientation=rotation.from_angles(0.2 * np.sin(2 * pi * tick / 100), 0.0, 0.0))

    for tick in range(225):
        mean = old.feel(swaying(tick))[0]
    same = HeadingEstimator([CAIMAN], [100])
    same.take_over(old)
    new.take_over(old)
    assert same.feel(swaying(225))[0] == pytest.approx(old.feel(swaying(225))[0], abs=1e-12)
    assert abs(mean) < 0.01
    half = np.mean([0.2 * np.sin(2 * pi * tick / 100) for tick in range(176, 226)])
    assert new.feel(swaying(225))[0] == pytest.approx(half, abs=1e-9)


def test_strokes_end_before_the_bend_of_the_trunk_does():
    """The high walk cannot stride longer, and turns by its trunk alone."""
    gait = GAITS["high_walk"]
    controller, first = start([replace(OFF, heading=HeadingRule(direction=pi))], CAIMAN, gait), round(START / 0.01)
    for tick in range(first, first + 140):
        controller.command(tick, felt(CAIMAN))
    steering = controller._steering
    assert np.abs(steering.stroke).max() < 0.15
    assert steering.trunk[0] == pytest.approx(2.0 * TRUNK_PER_STEERING)


# --- which way a bend turns ---


@pytest.mark.parametrize(
    ("robot", "gait"), [("pleurobot", "pleurobot_walk"), ("caiman", "semi_erect"), ("strider", "tripod")]
)
def test_the_side_to_which_a_bend_turns_is_that_which_the_gait_declares(robot, gait):
    declared = trunk_steering(ROBOTS[robot], GAITS[gait])
    measured = measure_trunk_steering(ROBOTS[robot], GAITS[gait], cycles=2)
    assert measured == pytest.approx(declared, abs=0.1)
    assert (abs(measured) < MIN_TRUNK_STEERING) == (robot == "strider")


def test_a_bend_whose_effect_is_unknown_or_too_small_is_refused_with_a_sentence(body):
    strider, unknown = ROBOTS["strider"], replace(GAITS["belly_crawl"], name="mine")
    with pytest.raises(OutsideLimits, match=r"turns robot 'strider' in gait 'tripod' by 0\.020 rad"):
        start([PatternGenerator(steering=1.0)], strider, GAITS["tripod"])
    with pytest.raises(OutsideLimits, match=r"was not measured: measure it with suchus\.sim\.land\.measure_trunk"):
        start([PatternGenerator(steering=((0.0, 0.0), (2.0, 1.0)))], CAIMAN, unknown)
    start([PatternGenerator(steering=1.0, steering_gain=0.1)], CAIMAN, unknown)  # whoever knows may say so
    with pytest.raises(OutsideLimits, match=r"the heading loop steers by a bend of the trunk"):
        start([replace(OFF, heading=HeadingRule())], CAIMAN, unknown.without("limbs"))
    assert trunk_steering(CAIMAN, unknown) is None
    assert trunk_steering(*body("hatchling")) == trunk_steering(CAIMAN, GAITS["belly_crawl"])
    assert trunk_steering(*body("quadruped")) is None


def test_the_generator_bends_to_the_side_that_turns_it_left():
    def bend(name, drive=2.0):
        robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
        place = layout(robot)
        straight, left = (start([PatternGenerator(steering=s, drive=drive)], robot, gait).rest()[0] for s in (0.0, 1.0))
        return ((left - straight)[list(place.axial_yaw)] * place.axial_left).sum()

    assert bend("salamander") > 0.1
    assert bend("pleurobot") < -0.1
    assert bend("pleurobot", drive=4.0) > 0.1  # as it swims


# --- the pattern generator ---


@pytest.mark.parametrize("name", [name for name in LIMBED if name not in ("rigid", "quadruped")])
def test_every_start_locks_to_the_gaits_frequency_and_phases(body, name):
    robot, gait = body(name)
    controls = [PatternGenerator(initial="random")] * 24
    states = oscillate(controls, robot, gait, duration=5 * gait.period, seeds=range(24), sample_interval=5)
    limbs = states.phase[:, :, -len(layout(robot).limbs) :]
    rate = (limbs[:, -1] - limbs[:, -20]) / (states.time[-1] - states.time[-20])
    assert rate * gait.period == pytest.approx(np.ones(rate.shape), abs=1e-4)
    lag = limbs[:, -1] - limbs[:, -1, :1] - np.array(gait.limb_phases) + gait.limb_phases[0]
    assert (lag + 0.5) % 1.0 - 0.5 == pytest.approx(np.zeros(lag.shape), abs=1e-3)


@pytest.mark.parametrize("name", ["salamander", "strider", "pleurobot", "hatchling"])
def test_limbs_fold_and_unfold_within_the_servos_speed(body, name):
    robot, gait = body(name)
    up, down = START + gait.period, START + 3 * gait.period
    drive = ((0.0, 2.0), (up, 2.0), (up + 1e-3, 4.0), (down, 4.0), (down + 1e-3, 2.0))
    period, speed = control_period(robot), np.array([robot.servo(s).speed for s in layout(robot).servos])
    controller = start([PatternGenerator(drive=drive)], robot, gait)
    ticks = range(round((START + 4 * gait.period) / period))
    targets = np.array([controller.command(tick, None).targets[0] for tick in ticks])
    assert (np.abs(np.diff(targets, axis=0)) / period / speed).max() < 1.0
    folded = targets[round((down - 0.01) / period)]
    assert folded[layout(robot).servos.index("LF_yaw")] == pytest.approx(np.radians(-85), abs=0.05)


# --- on its back ---


def test_a_swim_that_has_rolled_over_bends_to_its_other_side():
    def bent(roll):
        hold = HeadingHolds([HeadingHold(direction=-0.6)], [CAIMAN], [10], 0.01)
        for _ in range(20):
            tail, trunk = hold.bend(felt(CAIMAN, orientation=rotation.from_angles(0.0, 0.0, roll)))
        return float(tail[0]), float(trunk[0]), float(hold._offset[0])

    upright, over, aside = bent(0.0), bent(pi), bent(pi / 2)
    assert upright[0] < 0.0
    assert upright[1] < 0.0
    assert bent(1.0) == upright  # a swim that heels is steered in full
    assert over[:2] == pytest.approx([-upright[0], -upright[1]])
    assert np.abs(aside) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


# --- standing up, and live ---


def test_the_caiman_stands_up_on_smooth_and_on_rough_ground():
    soon = Standing(at=0.2, hold=2.0, blend=1.0)
    scales = [friction / CAIMAN.contact.foot_friction for friction in (0.4, 1.25)]
    runs = [Run(robot=CAIMAN, gait=GAITS["belly_crawl"], control=soon, ground=Ground(friction_scale=s)) for s in scales]
    record = simulate(runs, duration=soon.upright_until(CAIMAN), timestep=0.005, sample_stride=10)
    up = slice(soon.upright_from(CAIMAN), None)
    heights = [float(reach(CAIMAN, record).isel(run=i).sel(time=up).min()) for i in range(2)]
    assert min(heights) > 0.64


@pytest.mark.parametrize("name", ["strider", "salamandra", "hatchling"])
def test_a_live_walk_with_a_heading_goes_as_a_simulated_one(body, name):
    robot, gait = body(name)
    period = control_period(robot)
    gait = replace(gait, period=round(gait.period / period) * period)
    run = Run(robot=robot, gait=gait, control=replace(OFF, heading=HeadingRule(direction=0.5)))
    walk, duration = Live(run, timestep=coarse_step(robot)), START + round(1.4 * gait.period / period) * period
    while walk.time < duration - 1e-9:
        walk.step()
    record = simulate([run], duration=duration, timestep=coarse_step(robot)).isel(run=0, time=-1)
    np.testing.assert_allclose(walk.current_sample["position"], record.position.values, atol=1e-9)
    np.testing.assert_allclose(walk.current_sample["servo_target"], record.servo_target.values, atol=1e-9)
