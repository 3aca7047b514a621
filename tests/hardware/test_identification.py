"""Hidden numbers of servos are found again in the log of an emulated robot whose trunk is held in the air."""

import json
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
import xarray as xr

from suchus.apps.cli.calibrate import calibrate
from suchus.apps.cli.entry import BadCommand
from suchus.core.errors import IncompatibleRecord
from suchus.core.files import save
from suchus.hardware.emulator import EmulatedBody
from suchus.hardware.identification import (
    QUANTITIES,
    bam_parameters,
    identification_table,
    identify_servos,
    identify_walking,
    waving_gait,
)
from suchus.hardware.protocols import servo_table
from suchus.robot.design import layout, servo_ranges, with_named_servos
from suchus.robot.gaits import GAITS
from suchus.robot.motion import cycle_targets, intended
from suchus.robot.motors.identified import identified_servo
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import Backlash
from suchus.sim.model.inverse import held_torques

ROBOT = ROBOTS["caiman"]
NAMES = layout(ROBOT).servos
TABLE = servo_table("XM430-W350")
PLAYS = {"LF_pitch": 0.02, "RF_pitch": 0.04, "LH_pitch": 0.06, "LF_yaw": 0.03}
DELAY = 0.02


def hidden(seed):
    """Return the robot with servos whose numbers are around those of an STS3215, the commonest that was identified.

    Inertia, friction and damping of each are drawn anew, up to twice as great or half as great.
    """
    random = np.random.default_rng(seed)
    common = identified_servo("STS3215 7.4 V, m1")
    servos = {}
    for name in NAMES:
        armature, friction, damping = np.exp(random.uniform(-np.log(2.0), np.log(2.0), 3))
        servos[name] = replace(
            ROBOT.servo(name), armature=armature * common.armature, friction=friction * common.friction,
            damping=damping * common.damping,
        )  # fmt: skip
    return with_named_servos(ROBOT, servos)


def step(values, unit):
    """Return values in whole steps of a register."""
    return np.round(values / unit) * unit


@lru_cache
def waving_log(seed, *, seconds=20.0, amplitude=1.0, plays=(), held=True):
    """Return the log of servos that wave with two frequencies each, in the steps of their registers, and the robot."""
    robot = hidden(seed)
    faults = [Backlash(name, gap=gap) for name, gap in plays]
    body = EmulatedBody(
        robot, GAITS["belly_crawl"], held=held, latency=DELAY if held else 0.0, faults=faults, timestep=0.0025
    )
    random, (low, high) = np.random.default_rng(seed + 100), servo_ranges(robot).T
    rest = body.now["servo_target"].copy()
    middle = np.clip(rest, low + 0.3, high - 0.3)
    frequency, phase = random.uniform(0.5, 0.9, (2, len(NAMES))), random.uniform(0, 6.28, (2, len(NAMES)))
    frequency[1] *= 2.3
    time = body.period * np.arange(round(seconds / body.period))[:, None]
    swing = 0.25 * np.sin(2 * np.pi * frequency[0] * time + phase[0])
    swing += 0.08 * np.sin(2 * np.pi * frequency[1] * time + phase[1])
    goals = np.clip(rest + np.minimum(time, 1.0) * (middle - rest + amplitude * swing), low, high)
    return driven_log(body, goals), robot


def driven_log(body, goals):
    """Return the log of an emulated robot whose servos get goals, in the steps of their registers."""
    rows = {name: [] for name in ("servo_target", "servo_angle", "servo_velocity", "servo_current")}
    for goal in step(goals, TABLE.step):
        sensed = body.sensed()
        rows["servo_target"].append(goal)
        rows["servo_angle"].append(step(sensed.servo_position[0], TABLE.step))
        rows["servo_velocity"].append(step(sensed.servo_velocity[0], TABLE["present_velocity"].unit))
        current = sensed.servo_torque[0] / TABLE.torque_per_ampere
        rows["servo_current"].append(step(current, TABLE["present_current"].unit))
        body.aim(dict(enumerate(goal.tolist())))
        body.step()
    variables = {name: (("time", "servo"), np.array(values)) for name, values in rows.items()}
    return xr.Dataset(variables, coords={"time": body.period * np.arange(len(goals)), "servo": list(NAMES)})


@lru_cache
def walking_log(gait, seed, *, seconds=20.0, plays=()):
    """Return the log of a robot with hidden servos that walks on its feet, and the robot."""
    robot = hidden(seed)
    faults = [Backlash(name, gap=gap) for name, gap in plays]
    body = EmulatedBody(robot, GAITS[gait], latency=DELAY, faults=faults, timestep=0.0025)
    times = body.period * np.arange(round(seconds / body.period))
    return driven_log(body, intended(ROBOT, GAITS[gait], times).targets), robot


def truths(robot, name, plays):
    servo = robot.servo(name)
    return {
        "torque_constant": TABLE.torque_per_ampere, "armature": servo.armature, "friction": servo.friction,
        "damping": servo.damping, "delay": DELAY, "play": dict(plays).get(name, 0.0),
    }  # fmt: skip


def compared(seed, plays=()):
    """Return of each number that is found: servo, quantity, error over the truth, and whether the interval holds it."""
    log, robot = waving_log(seed, plays=plays)
    identified, _ = identify_servos(log, ROBOT)
    rows = []
    for name, servo in identified.items():
        for quantity, truth in truths(robot, name, plays).items():
            estimate = getattr(servo, quantity)
            if np.isfinite(estimate.value):
                error = estimate.value - truth
                rows.append((name, quantity, error / truth if truth else np.nan, abs(error) <= estimate.half))
    return rows


def test_intervals_hold_the_hidden_numbers_and_are_narrow():
    rows = [row for seed in (0, 1, 2) for row in compared(seed)] + compared(0, tuple(PLAYS.items()))
    assert len(rows) > 300
    assert np.mean([is_inside for *_, is_inside in rows]) >= 0.95
    errors = {quantity: np.array([abs(e) for _, q, e, _ in rows if q == quantity]) for quantity in QUANTITIES}
    for quantity in ("torque_constant", "armature", "friction", "damping"):
        assert np.mean(errors[quantity] < 0.1) >= 0.95, quantity
        assert np.median(errors[quantity]) < 0.05, quantity
    assert np.median(errors["delay"]) < 0.1
    plays = errors["play"][np.isfinite(errors["play"])]
    assert len(plays) == len(PLAYS)
    assert np.all(plays < 0.1)


def test_most_servos_that_wave_are_identified_and_the_others_are_said():
    log, _ = waving_log(0)
    identified, refusals = identify_servos(log, ROBOT)
    assert len(identified) >= 13
    assert set(identified) | set(refusals) == set(NAMES)
    assert "no hinge of its own" in refusals["tail_cable"]
    assert all("the motion is too calm" in text for name, text in refusals.items() if name != "tail_cable")


def test_the_wave_of_the_guide_identifies_servos():
    robot = hidden(0)
    body = EmulatedBody(robot, GAITS["belly_crawl"], held=True, latency=DELAY, timestep=0.0025)
    times = body.period * np.arange(round(20.0 / body.period))
    log = driven_log(body, intended(ROBOT, waving_gait(ROBOT), times).targets)
    identified, _ = identify_servos(log, ROBOT)
    assert len(identified) >= 16
    errors = [abs(servo.armature.value / robot.servo(name).armature - 1.0) for name, servo in identified.items()]
    assert max(errors) < 0.1


@pytest.mark.parametrize("name", ["caiman", "strider", "swimmer", "salamandra"])
def test_a_wave_stays_within_ranges_and_speeds_of_any_body(name):
    robot = ROBOTS[name]
    weak = with_named_servos(robot, {servo: replace(robot.servo(servo), speed=1.0) for servo in layout(robot).servos})
    for body, max_speed in ((robot, np.inf), (weak, 0.5)):
        clock = np.linspace(0.0, 1.0, 2001)
        angles = cycle_targets(body, waving_gait(body, period=10.0), clock)
        low, high = servo_ranges(body).T
        assert np.all((low - 1e-6 <= angles) & (angles <= high + 1e-6))
        assert np.all(np.ptp(angles, axis=0) > 0.1)
        assert np.abs(np.diff(angles, axis=0)).max() / (10.0 / 2000) <= max_speed + 1e-3


def test_a_current_that_is_told_too_great_gives_a_torque_constant_too_small():
    log, _ = waving_log(0)
    found, _ = identify_servos(log.assign(servo_current=1.25 * log.servo_current), ROBOT)
    for servo in found.values():
        assert servo.torque_constant.value == pytest.approx(TABLE.torque_per_ampere / 1.25, rel=0.02)


def test_a_log_that_shows_nothing_is_refused_with_the_motion_that_would():
    log, _ = waving_log(0)
    with pytest.raises(IncompatibleRecord, match=r"lasts 3.99 s; 8 s .* Hold caiman by its trunk in the air"):
        identify_servos(log.isel(time=slice(400)), ROBOT)
    with pytest.raises(IncompatibleRecord, match="holds no servo_current"):
        identify_servos(log.drop_vars("servo_current"), ROBOT)
    with pytest.raises(IncompatibleRecord, match="other servos"):
        identify_servos(log, ROBOTS["salamandra"])
    calm, _ = waving_log(0, amplitude=0.02)
    with pytest.raises(IncompatibleRecord, match=r"identifies no servo.* swing by 0.3 rad"):
        identify_servos(calm, ROBOT)


def test_a_robot_on_the_ground_is_not_taken_for_one_in_the_air():
    log, _ = waving_log(0, held=False)
    with pytest.raises(IncompatibleRecord, match="Hold caiman by its trunk in the air"):
        identify_servos(log, ROBOT)


@pytest.mark.parametrize("gait", ["high_walk", "semi_erect"])
def test_a_quick_walk_shows_the_inertia_and_the_delay_of_the_servos_of_limbs(gait):
    inertia_errors, delay_errors = [], []
    for seed in (0, 1):
        log, robot = walking_log(gait, seed)
        identified, refusals = identify_walking(log, ROBOT, dict.fromkeys(NAMES, "XM430-W350"))
        assert len(identified) >= 8
        assert set(identified) | set(refusals) == set(NAMES)
        assert all("is never free of the ground" in text for name, text in refusals.items() if name.startswith("spine"))
        for name, servo in identified.items():
            inertia_errors.append((servo.armature.value / robot.servo(name).armature - 1.0, servo.armature.half))
            assert abs(servo.armature.value - robot.servo(name).armature) <= servo.armature.half, name
            delay_errors.append(abs(servo.delay.value - DELAY) <= servo.delay.half)
            assert not np.isfinite([servo.torque_constant.value, servo.friction.value, servo.damping.value]).any()
    assert np.abs(np.array(inertia_errors)[:, 0]).max() < 0.1
    assert np.mean(delay_errors) >= 0.95


def test_the_way_to_the_first_posture_is_no_swing():
    """A drive begins with servos that go to the first posture, in which feet may be higher than in any swing."""
    log, _ = walking_log("high_walk", 0)
    models = dict.fromkeys(NAMES, "XM430-W350")
    count = 300
    way = log.isel(time=slice(0, count)).assign_coords(time=log.time.values[:count] - count * 0.01)
    fraction = np.linspace(0.0, 1.0, count)[:, None]
    way = way.assign(servo_angle=way.servo_angle.copy(data=fraction * way.servo_angle.values[:1]))
    identified, _ = identify_walking(xr.concat([way, log], "time"), ROBOT, models)
    alone, _ = identify_walking(log, ROBOT, models)
    assert {name: servo.armature for name, servo in identified.items()} == {
        name: servo.armature for name, servo in alone.items()
    }


def test_inertia_from_a_walk_is_as_great_as_the_torque_constant_is_said():
    """The current alone shows the inertia over the torque constant: a model of another constant scales it."""
    log, robot = walking_log("high_walk", 0)
    log = log.assign(servo_current=0.5 * log.servo_current)
    models = dict.fromkeys(NAMES, "XM430-W350")
    halved, _ = identify_walking(log, ROBOT, models)
    for name, servo in halved.items():
        assert servo.armature.value == pytest.approx(0.5 * robot.servo(name).armature, rel=0.15)


def test_a_walk_that_is_too_slow_or_too_short_is_refused_with_the_motion_that_would_do():
    models = dict.fromkeys(NAMES, "XM430-W350")
    log, _ = walking_log("low_crawl", 0)
    with pytest.raises(IncompatibleRecord, match=r"identifies no servo.* swing within half a second, as high_walk"):
        identify_walking(log, ROBOT, models)
    quick, _ = walking_log("high_walk", 0)
    with pytest.raises(IncompatibleRecord, match=r"lasts 2.99 s; 8 s"):
        identify_walking(quick.isel(time=slice(400)), ROBOT, models)


def test_servos_that_never_move_are_left_out():
    log, _ = waving_log(0)
    still = log.copy(deep=True)
    for name in ("servo_target", "servo_angle", "servo_velocity"):
        still[name][:, 0] = 0.1 if name != "servo_velocity" else 0.0
    _, refusals = identify_servos(still, ROBOT)
    assert refusals[NAMES[0]] == "it turned faster than 0.05 rad/s for 0 s only"


def test_the_command_says_what_a_walk_does_not_show(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save(walking_log("high_walk", 0)[0], "record.nc")
    assert calibrate(["log", "record.nc", "--walked"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "torque constant and friction show in the air" in said
    assert "spine_yaw_1 is left out: it turns no joint of a limb" in said
    rows = (tmp_path / "servos_identified.csv").read_text().splitlines()
    assert rows[1].startswith("LF_pitch,nan,inf,0.0")
    with pytest.raises(BadCommand, match="--held and --walked contradict each other"):
        calibrate(["log", "record.nc", "--walked", "--held"])
    with pytest.raises(BadCommand, match="--json needs what only a robot in the air shows"):
        calibrate(["log", "record.nc", "--walked", "--json", "bam"])


def test_the_load_of_a_held_limb_is_its_weight_over_its_lever():
    """A tail that sticks out level: torque of its pitch hinge is weight times the distance of its centre of mass."""
    robot_layout = layout(ROBOT)
    level = np.zeros((1, len(robot_layout.hinges)))
    torque = held_torques(ROBOT, level, level, level)[0, NAMES.index("tail_pitch")]
    still = EmulatedBody(ROBOT, GAITS["belly_crawl"], held=True, timestep=0.0025)
    still.aim(dict.fromkeys(range(len(NAMES)), 0.0))
    for _ in range(150):
        still.step()
    friction = ROBOT.servo("tail_pitch").friction
    held = still.now["servo_torque"][NAMES.index("tail_pitch")]
    assert abs(held - torque) < 1.5 * friction + 0.02 * abs(torque)
    assert abs(torque) > 5 * friction


def test_tables_and_json_hold_what_was_found(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    log, _ = waving_log(0)
    save(log, "record.nc")
    assert calibrate(["log", "record.nc", "--held", "--json", "bam"]) == 0
    identified, _ = identify_servos(log, ROBOT)
    assert (tmp_path / "servos_identified.csv").read_text() == identification_table(identified)
    files = {path.stem: json.loads(path.read_text()) for path in (tmp_path / "bam").glob("*.json")}
    assert set(files) == set(identified)
    for name, values in files.items():
        assert values["armature"] == pytest.approx(identified[name].armature.value)
        assert values["kt"] == pytest.approx(identified[name].torque_constant.value)
        assert values["model"] == "m1"
    assert "tail_cable is left out" in capsys.readouterr().out
    known = json.loads(bam_parameters(identified["LF_yaw"], "XM430-W350"))
    assert known["R"] == pytest.approx(12.0 / 2.3, rel=0.1)
    assert known["actuator"] == "xm430-w350"
