"""What goes wrong on a bus, one after the other: nothing half-driven, servos safe, the log kept."""

from dataclasses import replace

import numpy as np
import pytest
from tests.wires import Obedient, wiring

from suchus.core.errors import BusFailure, InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.hardware import (
    BusClock,
    DriveLimits,
    DriveSettings,
    Rig,
    drive,
    read_wiring,
    senses,
    wire_statistics,
    write_wiring,
)
from suchus.hardware.bus import BusGone, BusPlace, straight
from suchus.hardware.drive import STOP_PREFIX, check_drive
from suchus.hardware.emulator import Emulator, MemoryPort, Trouble
from suchus.robot.control import Coordinated, HeadingRule, OpenLoop
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS
from suchus.robot.motion import intended
from suchus.robot.robots import ROBOTS

ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]
NAMES = layout(ROBOT).servos
REST = intended(ROBOT, GAIT, np.zeros(1)).targets[0]
PROTOCOLS = pytest.mark.parametrize("protocol", ["dynamixel", "feetech", "line"])


class Drive:
    """A robot on an emulated bus, and what became of it."""

    def __init__(self, protocol="dynamixel", trouble=None, *, built=None, start=0.0, without=(), **settings):
        self.wiring = wiring(protocol)
        self.body = Obedient()
        self.body.angles[:] = self.body.goals[:] = REST + start
        self.emulator = Emulator(built or self.wiring, self.body, trouble or Trouble(), has_clock=True)
        self.port = MemoryPort(self.emulator)
        self.rig = Rig(ROBOT, self.wiring, [self.port], has_clock=True, limp_servos=without)
        self.settings = DriveSettings(**{"duration": 0.3} | settings)
        self.said = []

    def go(self, gait=GAIT, control=None, asked=lambda: ""):
        return drive(
            self.rig, gait, control, self.settings, clock=BusClock(self.rig), stop_request=asked, say=self.said.append
        )

    @property
    def limp(self):
        return not self.body.powered.any()


@PROTOCOLS
def test_goals_are_those_of_the_gait_to_half_a_step_and_the_robot_ends_limp(protocol):
    one = Drive(protocol)
    log = one.go()
    wanted = intended(ROBOT, GAIT, log.time.values).targets
    driven = log.sel(time=slice(0.0, None))
    assert np.abs(driven.servo_target.values - wanted[log.time.values >= 0.0]).max() <= np.pi / 4096 + 1e-12
    assert log.cause.item() == ""
    assert one.limp
    assert wire_statistics(log)["holes"] == 0.0


@PROTOCOLS
def test_the_way_to_the_first_posture_is_slow_and_stands_before_time_zero(protocol):
    one = Drive(protocol, start=0.3)
    log = one.go()
    assert log.time.values[0] < -0.5
    steps = np.abs(np.diff(log.servo_target.sel(time=slice(None, 0.0)).values, axis=0)) / 0.01
    assert steps.max() <= 0.5 + 2 * np.pi / 4096 / 0.01
    assert np.abs(log.servo_target.values[0] - REST - 0.3).max() < 0.02  # it did not jump when its torque came


def test_torque_comes_only_when_goals_are_where_the_servos_are():
    one = Drive(start=0.1)
    one.body.goals[:] = 0.0
    jumps, power = [], one.body.power

    def watched(place, share):
        if share > one.body.powered[place]:
            jumps.append(abs(one.body.goals[place] - one.body.angles[place]))
        power(place, share)

    one.body.powered[:] = 0.0
    one.body.power = watched
    one.go()
    assert len(jumps) >= len(NAMES)
    assert max(jumps) < 2 * np.pi / 4096


def test_a_silent_servo_is_refused_by_name_and_nothing_moved():
    one = Drive(trouble=Trouble(mute=(3,)))
    with pytest.raises(BusFailure, match=r"number 3 \(LF_knee\).*does not answer; there answer 1, 2, 4.*--without"):
        one.go()
    assert one.body.tick == 0
    assert one.limp


def test_one_goes_on_without_it_if_that_is_said():
    one = Drive(trouble=Trouble(mute=(3,)), without=("LF_knee",))
    log = one.go()
    assert log.cause.item() == ""
    assert np.isnan(log.servo_angle.sel(servo="LF_knee")).all()
    with pytest.raises(InvalidDesign, match="is no servo"):
        Drive(without=("LF_elbow",))


def test_nobody_answers():
    with pytest.raises(BusFailure, match=r"nobody answers.*power"):
        Drive(trouble=Trouble(mute=tuple(range(1, 20)))).go()


def test_two_servos_with_one_number_are_told_from_a_silent_one():
    with pytest.raises(BusFailure, match=r"number 7 \(LH_yaw\).*two servos have that number"):
        Drive(trouble=Trouble(twin=(7,))).go()


def test_another_model_or_mode_than_the_file_says_is_refused():
    built = wiring()
    built = replace(built, servo=(replace(built.servo[0], model="XL430-W250"), *built.servo[1:]))
    with pytest.raises(BusFailure, match=r"LF_yaw.*model 1060; XM430-W350 is 1020"):
        Drive(built=built).go()
    one = Drive()
    one.emulator.servos[4].put("operating_mode", 1)
    with pytest.raises(BusFailure, match=r"RF_pitch.*mode for positions"):
        one.go()


def test_too_slow_a_bus_is_refused_with_the_arithmetic_and_what_would_do():
    slow = straight(ROBOT, [BusPlace(port="x", baud=57600)], "XM430-W350")
    with pytest.raises(InvalidDesign, match=r"bytes a tick, \d+\.\d ms at 57600 baud.*--rate \d+"):
        Rig(ROBOT, slow, [MemoryPort(Emulator(slow, Obedient()))])
    two = straight(ROBOT, [BusPlace(port="x", baud=1_000_000), BusPlace(port="y")], "XM430-W350")
    assert Rig(ROBOT, two, 2 * [MemoryPort(Emulator(two, Obedient()))]).bytes_per_tick(0)[0] < 400


def test_servos_that_wait_before_they_answer_are_refused():
    one = Drive()
    for servo in one.emulator.servos:
        servo.put("return_delay", 250)
    one.rig.clocked = False  # as on a real wire
    with pytest.raises(BusFailure, match=r"wait 500 us each.*return_delay to 0 .address 9"):
        one.rig._settings(0, one.rig.buses[0])


def test_servos_without_a_watchdog_are_told_of():
    one = Drive("feetech")
    one.go()
    assert "would hold the last goal with full torque" in one.said[0]
    dynamixel = Drive()
    dynamixel.go()
    assert dynamixel.said == []


def test_a_servo_with_too_old_a_firmware_has_no_watchdog_and_is_not_asked_for_one():
    for version, told in ((38, False), (37, True)):
        one = Drive()
        one.emulator.servos[2].put("firmware", version)
        one.go()
        assert ("1 servos" in str(one.said) or "LF_knee on" in str(one.said)) == told
        one.rig.watch(True)
        one.emulator.pass_until(one.body.tick + 15)
        tripped = [servo.get("bus_watchdog") == -1 for servo in one.emulator.servos]
        assert tripped.count(False) == int(told)
        assert tripped[2] != told


@pytest.mark.parametrize(("keeps", "refused"), [("16", True), ("2", True), ("1", False), (None, False)])
def test_an_adapter_that_keeps_bytes_back_is_refused_with_what_would_mend_it(keeps, refused, tmp_path, monkeypatch):
    monkeypatch.setattr("suchus.hardware.bus.ports.ADAPTERS", tmp_path)
    (tmp_path / "ttyUSB7").mkdir()
    if keeps is not None:
        (tmp_path / "ttyUSB7" / "latency_timer").write_text(f"{keeps}\n")
    (tmp_path / "robot").symlink_to(tmp_path / "ttyUSB7")  # as /dev/serial/by-id has it
    one = Drive()
    one.port.name = str(tmp_path / "robot")
    if refused:
        with pytest.raises(BusFailure, match=rf'keeps bytes back for {keeps} ms.*udev.*ATTR{{latency_timer}}="1"'):
            one.go()
        assert one.body.tick == 0
    else:
        one.go()


@pytest.mark.parametrize("protocol", ["dynamixel", "feetech", "line"])
def test_a_servo_whose_own_limits_are_narrower_than_the_file_is_refused_by_name(protocol):
    one = Drive(protocol)
    one.emulator.servos[3].put("position_low", 2000)
    with pytest.raises(BusFailure, match=r"RF_yaw, number 4, takes goals from 2000 to 4095 steps, and the file sends"):
        one.go()
    assert one.body.tick == 0
    free = Drive(protocol)
    for name in ("position_low", "position_high"):
        free.emulator.servos[3].put(name, 0)
    if protocol == "feetech":
        free.emulator.servos[3].put("position_high", 4095)  # our emulated one knows no other way to have none
        free.go()


def test_lost_replies_are_counted_and_the_last_reading_stays():
    one = Drive(trouble=Trouble(lost=0.05, seed=2), duration=0.5)
    log = one.go()
    holes = 1.0 - log.servo_heard.values.mean()
    assert 0.02 < holes < 0.2
    assert np.isfinite(log.servo_angle.values).all()
    assert log.reading_age.values.max() >= 0.01
    assert log.attrs["missing"][0] > 0


@pytest.mark.parametrize("kind", ["corrupt", "dropped"])
@PROTOCOLS
def test_spoilt_replies_are_dropped_and_nothing_jumps(protocol, kind):
    one = Drive(protocol, trouble=Trouble(**{kind: 0.05}, seed=1), duration=0.5)
    log = one.go()
    assert (1.0 - log.servo_heard.values).sum() > 0
    assert np.abs(np.diff(log.servo_angle.values, axis=0)).max() < 0.2


@PROTOCOLS
def test_a_servo_that_falls_silent_stops_the_robot_and_the_log_is_kept(protocol):
    one = Drive(protocol, trouble=Trouble(mute=(5,), at=0.2), duration=1.0)
    with pytest.raises(BusFailure, match="RF_pitch has not answered for 10 ticks; the robot was stopped") as caught:
        one.go()
    assert one.limp or one.body.powered.sum() == 1.0  # it cannot be told
    assert 0.25 < caught.value.record.time[-1] < 0.4
    assert "RF_pitch" in caught.value.record.cause.item()


def test_many_holes_at_once_stop_the_robot():
    one = Drive(trouble=Trouble(mute=(1, 2, 3, 4), at=0.1), duration=1.0, limits=DriveLimits(silent=1000))
    with pytest.raises(BusFailure, match="the bus is failing"):
        one.go()


@pytest.mark.parametrize("what", ["gone", "deaf"])
def test_a_bus_that_ends_in_the_middle_keeps_the_log(what):
    one = Drive(duration=1.0)

    def asked():
        if one.body.time > 0.1:
            setattr(one.port, what, True)
        return ""

    with pytest.raises(BusFailure) as caught:
        one.go(asked=asked)
    assert isinstance(caught.value.__cause__, BusGone)
    assert caught.value.record.sizes["time"] > 5


def test_a_dynamixel_whose_host_is_gone_stops_by_itself_and_a_feetech_holds():
    for protocol, stops in (("dynamixel", True), ("feetech", False)):
        one = Drive(protocol)
        one.rig.torque(True)
        one.rig.watch(True)
        servo = one.emulator.servos[0]
        one.emulator.pass_until(8)
        trips = "bus_watchdog" in servo.table and servo.get("bus_watchdog") == -1
        assert not trips
        one.emulator.pass_until(15)
        assert ("bus_watchdog" in servo.table and servo.get("bus_watchdog") == -1) == stops
        assert servo.get("torque_enable") == 1


class Distracted(BusClock):
    """Time of a computer that is busy with other things from one tick to another."""

    def __init__(self, rig, ticks):
        super().__init__(rig)
        self.ticks = ticks

    def wait(self, tick):
        return super().wait(tick + self.ticks if tick == 20 else tick)


@pytest.mark.parametrize(("ticks", "away"), [(5, False), (15, True)])
def test_servos_that_stood_still_since_the_computer_was_busy_take_goals_again(ticks, away):
    one = Drive(duration=0.6, stop="hold")
    log = drive(one.rig, GAIT, None, one.settings, clock=Distracted(one.rig, ticks), say=one.said.append)
    assert log.attrs["missed"] == ticks
    assert any("the servos stood still" in sentence for sentence in one.said) == away
    assert all(servo.get("bus_watchdog") >= 0 for servo in one.emulator.servos)
    last = log.servo_target.values[-2]  # what was sent last but one is where servos are at the end
    assert np.abs(log.servo_angle.values[-1] - last).max() <= 2 * np.pi / 4096


def boarded(needed):
    """Return a rig with a board of each kind, and the numbers that are asked in each of some ticks."""
    made = wiring(boards=True)
    emulator = Emulator(made, Obedient(), has_clock=True)
    port, asked = MemoryPort(emulator), []
    rig = Rig(ROBOT, made, [port], has_clock=True, required_senses=needed)
    hear = emulator._listening
    emulator._listening = lambda line, servo: (asked[-1].append(servo), hear(line, servo))[1]
    for _ in range(100):
        asked.append([])
        rig.read()
    return rig, asked, {board.kind: board.id for board in made.board}


def test_boards_that_nobody_needs_at_every_tick_are_asked_by_turns():
    rig, asked, boards = boarded(("foot_pressure",))
    assert all(boards["feet"] in tick for tick in asked)
    assert all(len(tick) == len(NAMES) + 2 for tick in asked)  # the feet, and one more
    for kind in ("imu", "belly", "tail"):
        ticks = [i for i, tick in enumerate(asked) if boards[kind] in tick]
        assert max(np.diff(ticks)) <= 4
    assert set(rig.now.felt) >= {"foot_pressure", "orientation", "belly_pressure", "tail_pressure"}
    assert np.isfinite(rig.now.temperature).all()  # each servo was asked how it is
    everything, always, _ = boarded(None)
    assert all(set(boards.values()) <= set(tick) for tick in always)
    assert rig.bytes_per_tick(0)[0] < everything.bytes_per_tick(0)[0]


@PROTOCOLS
def test_a_hot_servo_is_warned_of_and_then_stops_the_robot(protocol):
    one = Drive(protocol, trouble=Trouble(hot=(9,), heating=20.0), duration=2.0)
    one.emulator.servos[8].temperature = one.emulator.servos[8].get("temperature_limit") - 14.0
    with pytest.raises(BusFailure, match=r"LH_knee is at \d+ degrees Celsius; it switches off at") as caught:
        one.go()
    assert any("LH_knee is at" in sentence for sentence in one.said)
    assert one.limp
    assert caught.value.record.servo_error.max() == 0  # it was stopped before it switched itself off
    assert caught.value.record.servo_temperature.sel(servo="LH_knee").max() > 60.0


def test_an_alert_stops_the_robot_and_is_named():
    one = Drive(trouble=Trouble(wet=(12,), at=0.1), duration=1.0)
    with pytest.raises(BusFailure, match="RH_knee has switched itself off: electrical shock"):
        one.go()
    assert one.limp


@pytest.mark.parametrize(("share", "told"), [(0.9, False), (1.1, True)])
def test_a_servo_that_gives_more_than_it_can_for_long_is_told_of(share, told):
    one = Drive(limits=DriveLimits(memory=0.1), duration=1.0)
    one.body.torques[7] = -share * one.wiring.servo[7].table.motor.continuous_torque
    one.go()
    assert any("LH_pitch gives" in sentence and "continuously" in sentence for sentence in one.said) == told
    assert len(one.said) == int(told)


def test_a_battery_that_sags_stops_the_robot():
    one = Drive(trouble=Trouble(sag=8.0), duration=1.0, limits=DriveLimits(volts=10.5))
    with pytest.raises(BusFailure, match=r"gets 10\.\d V; 10\.5 V is the least"):
        one.go()


def test_a_place_that_cannot_be_reached_so_fast_is_refused_thrice_and_then_stops_the_robot():
    one = Drive(duration=1.0)
    angles, seen = one.body.sensed, []

    def sensed():
        felt = angles()
        if one.body.time > 0.3:
            felt.servo_position[0, 2] += 1.5  # the horn slipped
        seen.append(felt.servo_position[0, 2])
        return felt

    one.body.sensed = sensed
    with pytest.raises(BusFailure, match="LF_knee says that it is where it cannot have come to"):
        one.go()


def test_a_key_ends_it_without_an_error():
    one = Drive(duration=5.0)
    log = one.go(asked=lambda: "a key." if one.body.time > 0.2 else "")
    assert log.cause.item() == f"{STOP_PREFIX}a key."
    assert log.time[-1] < 0.3
    assert one.limp


@pytest.mark.parametrize("times", [1, 2])
def test_ctrl_c_and_an_error_of_a_controller_end_in_the_same_safe_state(times):
    one, count = Drive(duration=5.0), []
    step = one.body.step

    def stopping():
        step()
        if one.body.time > 0.2 and len(count) < times:
            count.append(1)
            raise KeyboardInterrupt

    one.body.step = stopping
    with pytest.raises(KeyboardInterrupt) as caught:
        one.go()
    assert one.limp
    assert caught.value.record.sizes["time"] > 10

    class Broken:
        feels = False
        needs = ()

        @staticmethod
        def start(runs, period):
            class Controller:
                def rest(self):
                    return np.zeros((1, 19))

                def command(self, tick, sensed):
                    raise ZeroDivisionError

            return Controller()

    other = Drive()
    with pytest.raises(ZeroDivisionError):
        other.go(control=Broken())
    assert other.limp


@pytest.mark.parametrize(("stop", "limp"), [("sag", True), ("off", True), ("hold", False)])
def test_how_it_ends_is_as_it_was_asked_for(stop, limp):
    one = Drive(stop=stop)
    shares = []
    power = one.body.power
    one.body.power = lambda place, share: (shares.append(share), power(place, share))
    one.go()
    assert one.limp == limp
    assert (0.0 < min(s for s in shares if s > 0.0) < 0.25) == (stop == "sag")


def test_a_control_that_must_sense_what_the_robot_cannot_is_refused():
    rig = Drive().rig
    with pytest.raises(UnsuitedRobot, match="Coordinated must sense foot pressure"):
        check_drive(rig, GAIT, Coordinated())
    with pytest.raises(UnsuitedRobot, match="orientation"):
        check_drive(rig, GAIT, Coordinated(heading=HeadingRule()))
    boards = wiring(boards=True)
    full = Rig(ROBOT, boards, [MemoryPort(Emulator(boards, Obedient(), has_clock=True))], has_clock=True)
    check_drive(full, GAIT, Coordinated(heading=HeadingRule()))
    assert "foot_pressure" in senses(ROBOT, boards.board)
    assert "foot_pressure" not in senses(ROBOT, ())


def test_a_gait_beyond_the_hardware_is_refused_with_what_would_do():
    rig = Drive().rig
    rig.servos = (replace(rig.servos[0], low=-0.05, high=0.05), *rig.servos[1:])
    with pytest.raises(OutsideLimits, match=r"turns LF_yaw from .* and the hardware allows -0.05 to 0.05 rad"):
        check_drive(rig, GAIT, OpenLoop())
    fast = replace(GAIT, period=0.3)
    with pytest.raises(OutsideLimits, match=r"rad/s.*lengthen its period to \d"):
        check_drive(Drive().rig, fast, OpenLoop())


def test_hardware_is_written_and_read_and_its_mistakes_are_named(tmp_path):
    path = write_wiring(wiring(boards=True), tmp_path / "hardware.toml")
    assert replace(read_wiring(path, ROBOT), bus=wiring().bus) == wiring(boards=True)
    text = path.read_text()
    for old, new, says in (
        ("id = 2,", "id = 1,", "LF_yaw and LF_pitch are all number 1 on bus 0"),
        ('name = "LF_yaw"', 'name = "LF_elbow"', "lacks LF_yaw"),
        ('fingerprint = "', 'fingerprint = "0', "other servo ranges"),
        ('model = "XM430-W350"', 'model = "STS3250"', "speaks feetech, on a bus that speaks dynamixel"),
        ("sign = 1", "sign = 2", "sign"),
    ):
        other = tmp_path / "other.toml"
        other.write_text(text.replace(old, new, 1))
        with pytest.raises(InvalidDesign, match=says):
            read_wiring(other, ROBOT)
    with pytest.raises(InvalidDesign, match=r"lacks|servo ranges"):
        read_wiring(path, ROBOTS["salamander"])
