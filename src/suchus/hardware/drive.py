"""Drive a robot of servos by any controller: soft start, ticks, limits, a safe end whatever happens, and a log."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from time import monotonic, sleep
from typing import Any, Literal, Protocol

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.errors import BusFailure, OutsideLimits, SuchusError, UnsuitedRobot
from suchus.core.files import digest, versions
from suchus.core.progress import Progress, silent
from suchus.core.stopping import deferred_signals
from suchus.hardware.blind import BlindRig
from suchus.hardware.guard import DriveLimits, Guard
from suchus.hardware.log import DriveLog
from suchus.hardware.rig import Rig
from suchus.robot.control import Control, Controller, OpenLoop, needs
from suchus.robot.design import layout
from suchus.robot.motion import Gait, check_limits, cycle_targets
from suchus.sim.land import Run
from suchus.sim.land.loop import start

Stop = Literal["sag", "hold", "off"]
_START_TOLERANCE = 0.005  # [rad]; distance from the first posture without an approach
_SAG_TORQUE = 0.2  # fraction of the torque with which a robot sinks
_HOLDS, _SINKS = 0.2, 0.6  # [s]; hold before the robot sinks, and duration of sinking
_WATCHDOG_FRACTION = 0.8  # fraction of the watchdog's time after which a servo may have stopped
_BY_IMU = ("orientation", "angular_velocity", "acceleration")
_PHASES = 64  # phases of a cycle at which a gait is checked


class TickClock(Protocol):
    """Clock that gives the ticks of a drive."""

    def begin(self) -> None:
        """Let tick 0 be now."""

    def wait(self, tick: int) -> int:
        """Return after a tick has begun, with its number, or that of a later tick if time was lost."""

    def late(self, tick: int) -> float:
        """Return the delay of a tick [s]."""


class WallClock:
    """Ticks by the time of this computer.

    Args:
        period: period of a tick [s].
    """

    def __init__(self, period: float) -> None:
        self._period, self._start_time = period, monotonic()

    def begin(self) -> None:
        """Let tick 0 be now."""
        self._start_time = monotonic()

    def wait(self, tick: int) -> int:
        """Sleep until a tick begins, and return the number of the present tick."""
        due = self._start_time + tick * self._period
        remaining_time = due - monotonic()
        if remaining_time > 0.0:
            sleep(remaining_time)
            return tick
        return tick + int(-remaining_time / self._period)

    def late(self, tick: int) -> float:
        """Return the delay of a tick [s]."""
        return monotonic() - self._start_time - tick * self._period


class BusClock:
    """Clock of an emulator that the host steps: no tick is late.

    Args:
        rig: rig of emulated servos.
    """

    def __init__(self, rig: Rig) -> None:
        self._bus, self._base = rig.buses[0], 0

    def begin(self) -> None:
        """Let tick 0 be now."""
        self._base = self._bus.clock() or 0

    def wait(self, tick: int) -> int:
        """Let the emulated robot move until a tick."""
        self._bus.pass_until(self._base + tick)
        return tick

    def late(self, tick: int) -> float:
        """Return 0."""
        del tick
        return 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveSettings:
    """How a robot is driven."""

    duration: float = 30.0
    """How long the controller acts, its first second of standing included [s]."""
    stop: Stop = "sag"
    """How it ends: ``sag`` lets it down with a fifth of the torque and switches it off, ``off`` switches off at once,
    ``hold`` leaves it standing with its torque on."""
    approach: float = 0.5
    """Speed at which servos go to the first posture [rad/s]."""
    limits: DriveLimits = field(default_factory=DriveLimits)
    """When the robot is stopped."""

    def __post_init__(self) -> None:
        with Checks("drive", self) as check:
            check.number("duration", 0.01, 86400.0, "s")
            check.number("approach", 0.01, 10.0, "rad/s")


def check_drive(rig: Rig | BlindRig, gait: Gait, control: Control) -> None:
    """Refuse a gait or a control that the wired robot cannot follow, before anything moves.

    Raises:
        UnsuitedRobot: the control must sense what the robot has no sensor for, or moves air.
        OutsideLimits: the gait goes beyond a joint, or beyond where a servo may be sent, or turns one too fast.
    """
    robot = rig.robot
    lacking = [name for name in needs(control) if name not in rig.senses]
    if lacking:
        words = " and ".join(name.replace("_", " ") for name in lacking)
        raise UnsuitedRobot(
            f"control {type(control).__name__} must sense {words}, and the hardware has no board for that: add the "
            "board to "
            "the file, or leave out the rules that need it."
        )
    check_limits(robot, gait)
    clock = np.arange(_PHASES) / _PHASES
    angles = cycle_targets(robot, gait, clock)
    rates = np.abs(np.roll(angles, -1, axis=0) - angles) * _PHASES / gait.period
    for i, (name, min_angle, max_angle) in enumerate(rig.bounds):
        gait_min, gait_max = angles[:, i].min(), angles[:, i].max()
        if gait_min < min_angle - 1e-9 or gait_max > max_angle + 1e-9:
            raise OutsideLimits(
                f"gait {gait.name!r} turns {name} from {gait_min:.2f} to {gait_max:.2f} rad, and the hardware allows "
                f"{min_angle:g} "
                f"to {max_angle:g} rad: mount its horn with another zero, or take another gait."
            )
        if rates[:, i].max() > rig.speed[i]:
            slower = gait.period * rates[:, i].max() / rig.speed[i]
            raise OutsideLimits(
                f"gait {gait.name!r} turns {name} at {rates[:, i].max():.3g} rad/s, and up to {rig.speed[i]:g} "
                "rad/s is "
                f"allowed: lengthen its period to {slower:.2g} s."
            )


class _Halted(Exception):
    """The robot must be stopped; the message gives the reason."""


def drive(
    rig: Rig | BlindRig,
    gait: Gait,
    control: Control | None = None,
    settings: DriveSettings | None = None,
    *,
    clock: TickClock | None = None,
    stop_request: Callable[[], str] = lambda: "",
    say: Callable[[str], None] = lambda _: None,
    progress: Progress = silent,
    save_log: Callable[[xr.Dataset], None] = lambda _: None,
) -> xr.Dataset:
    """Drive a robot, and stop it safely in any case.

    Time in the log is that of the controller: the approach to the first posture has negative times. A tick that is too
    late is skipped in the gait, which is a function of time; the controller takes all its steps.

    Args:
        rig: the open robot.
        gait: gait in which it moves.
        control: what decides; open loop if None.
        settings: how; as by default if None.
        clock: that of this computer if None.
        stop_request: returns why to stop, where somebody asked for it.
        say: is given sentences that people should read while it moves.
        progress: told the share that is done.
        save_log: is given the log when the robot has been stopped, however the drive ended; signals wait until it
            returns.

    Returns:
        The log, a record of one run, see ``record.VARIABLES`` and ``record.BUS_VARIABLES``; ``cause`` says why it
        ended early.

    Raises:
        UnsuitedRobot: the control must sense what the robot cannot.
        OutsideLimits: the gait asks more than the servos may do.
        BusFailure: servos cannot be reached, or the robot had to be stopped; the error carries the log.
    """
    control, settings = control or OpenLoop(), settings or DriveSettings()
    check_drive(rig, gait, control)
    ticks = round(settings.duration / rig.period)
    run = Run(robot=rig.robot, gait=gait, control=control)
    controller = start([run], ticks + 1, rig.period)
    for sentence in rig.check():
        say(sentence)
    session = _Drive(
        rig, gait, controller, settings, clock or WallClock(rig.period), stop_request, say, progress, save_log
    )
    return session.run(ticks)


class _Drive:
    """One drive of a robot."""

    def __init__(
        self,
        rig: Rig | BlindRig,
        gait: Gait,
        controller: Controller,
        settings: DriveSettings,
        clock: TickClock,
        stop_request: Callable[[], str],
        say: Callable[[str], None],
        progress: Progress,
        save_log: Callable[[xr.Dataset], None],
    ) -> None:
        """Take rig, gait, controller and settings; nothing moves yet."""
        self._rig, self._gait, self._controller = rig, gait, controller
        self._settings, self._clock, self._stop_request, self._say = settings, clock, stop_request, say
        self._progress, self._save_log = progress, save_log
        self._log, self._guard = DriveLog(rig.robot, gait), Guard(rig, settings.limits)
        self._warning_count = 0
        self._tick = self._offset = 0
        self._goal = np.zeros(len(rig.names))
        self._missed_ticks = self._clamped = 0
        self._last_goal_time = 0.0  # when servos heard from us, since the first tick [s]
        self._limb = np.full(len(layout(rig.robot).limbs), np.nan)

    def run(self, ticks: int) -> xr.Dataset:
        """Approach the first posture, drive for some ticks, stop the robot safely, save the log and return it."""
        stop_mode, cause, is_complete = self._settings.stop, "", False
        failure: BaseException | None = None
        try:
            self._approach()
            self._go(ticks)
            is_complete = True
        except _Halted as stop:
            cause = str(stop)
        except BusFailure as error:
            cause, failure = str(error), error
        except KeyboardInterrupt as stop:
            cause, failure = _SIGNAL_CAUSE, stop
        except BaseException as error:
            stop_mode, cause, failure = "off", f"{type(error).__name__}: {error}", error
        try:
            self._end(stop_mode)
        except KeyboardInterrupt as stop:  # asked while it is let down: its torque is off by then
            cause, failure = cause or _SIGNAL_CAUSE, failure or stop
        except BaseException as error:
            cause, failure = cause or f"{type(error).__name__}: {error}", failure or error
        with deferred_signals():
            record = self._record(cause)
            self._save_log(record)
        if failure is not None and not isinstance(failure, BusFailure):
            if isinstance(failure, KeyboardInterrupt):
                failure.record = record  # type: ignore[attr-defined]
            raise failure
        if failure is not None or (cause and not is_complete and not cause.startswith(STOP_PREFIX)):
            raise BusFailure(f"{cause.rstrip('.')}; the robot was stopped.", record=record) from failure
        return record

    def _approach(self) -> None:
        """Move the robot slowly from its present posture to the first posture of the gait."""
        rig = self._rig
        rig.torque(False)
        for _ in range(5):  # each may have holes
            rig.read()
            if np.isfinite(rig.now.angle[rig.asked]).all():
                break
        unheard = [name for name, angle, is_asked in zip(rig.names, rig.now.angle, rig.asked, strict=True)
                   if is_asked and not np.isfinite(angle)]  # fmt: skip
        if unheard:
            raise BusFailure(f"{' and '.join(unheard[:4])} does not say where it is: the robot cannot be started.")
        goal_angles = np.clip(self._controller.rest()[0], rig.low, rig.high)
        start_angles = np.where(rig.asked, rig.now.angle, goal_angles)
        self._goal = rig.ready(np.clip(start_angles, rig.low, rig.high))
        rig.watch(True)
        max_offset = float(np.abs(goal_angles - start_angles)[rig.asked].max(initial=0.0))
        count = int(max(max_offset - _START_TOLERANCE, 0.0) / self._settings.approach / rig.period)
        self._clock.begin()
        self._offset, first_tick = count, -count
        self._tick = tick = first_tick
        while tick < 0:
            share = (tick - first_tick + 1) / count
            rig.read()
            self._send(tick, start_angles + (goal_angles - start_angles) * share)
            tick = max(self._clock.wait(tick + 1 - first_tick) + first_tick, tick + 1)

    def _go(self, ticks: int) -> None:
        """Drive the gait from tick 0 to the last tick; ticks that the computer missed are skipped."""
        tick, stepped = 0, -1
        while tick <= ticks:
            command = None
            self._rig.read()
            while stepped < tick:  # ticks that were missed too, so that what it remembers is right
                stepped += 1
                command = self._controller.command(stepped, self._rig.sensed(stepped * self._rig.period))
            assert command is not None
            if command.air_fraction is not None and np.isfinite(command.air_fraction).any():
                raise UnsuitedRobot("the control lets air out of the hull, and no servo of this robot moves air.")
            self._limb = command.phase[0]
            self._send(tick, command.targets[0])
            if tick % 16 == 0:
                self._progress("driving", tick / max(ticks, 1))
            if tick == ticks:
                break
            next_tick = max(self._clock.wait(tick + 1 + self._offset) - self._offset, tick + 1)
            self._missed_ticks += min(next_tick, ticks) - tick - 1
            tick = min(next_tick, ticks)
        self._progress("driving", 1.0)

    def _send(self, tick: int, targets: np.ndarray) -> None:
        """Check the robot, send targets within the limits of the servos, and log the tick."""
        rig, reading = self._rig, self._rig.now
        lateness = self._clock.late(tick + self._offset)
        self._wake(lateness + (tick + self._offset) * rig.period)
        stop_reason = self._guard.look(reading)
        for sentence in self._guard.warnings[self._warning_count :]:
            self._say(sentence)
        self._warning_count = len(self._guard.warnings)
        step = rig.speed * rig.period * 1.0001
        allowed_targets = np.clip(targets, rig.low, rig.high)
        slewed = np.clip(allowed_targets, self._goal - step, self._goal + step)
        self._clamped += int((np.abs(slewed - targets) > rig.step)[rig.asked].any())
        if not stop_reason:
            self._goal = np.where(np.abs(slewed - allowed_targets) > 0.0, slewed, allowed_targets)
            sent_angles = rig.aim(self._goal)
        else:
            sent_angles = np.full(len(rig.names), np.nan)
        self._tick = tick
        sensor_values: dict[str, np.ndarray] = {name: reading.felt[name] for name in _BY_IMU if name in reading.felt}
        if "foot_pressure" in reading.felt:
            feet = reading.felt["foot_pressure"]
            sensor_values["foot_force"] = np.column_stack([np.full((len(feet), 2), np.nan), feet])
        self._log.keep(
            tick * rig.period,
            sensor_values
            | {
                "servo_angle": reading.angle, "servo_velocity": reading.velocity, "servo_torque": reading.torque,
                "servo_target": sent_angles, "limb_phase": self._limb, "servo_asked": targets,
                "servo_heard": reading.heard,
                "reading_age": reading.age * rig.period, "servo_current": reading.current,
                "servo_voltage": reading.voltage,
                "servo_temperature": reading.temperature, "servo_error": np.maximum(reading.error, 0),
                "tick_began": lateness,
                "tick_took": self._clock.late(tick + self._offset) - lateness,
            },
        )  # fmt: skip
        if stop_reason:
            raise _Halted(stop_reason)
        if request := self._stop_request():
            raise _Halted(f"{STOP_PREFIX}{request}")

    def _wake(self, time: float) -> None:
        """Reset the watchdogs of the servos if they heard nothing for too long.

        Args:
            time: time since the first tick [s].
        """
        silence, self._last_goal_time = time - self._last_goal_time, time
        if silence > _WATCHDOG_FRACTION * self._rig.patience:
            self._rig.watch(False)
            self._rig.watch(True)
            self._guard.tell(
                "away",
                f"this computer was busy with other things for {silence:.2g} s, in which the servos stood still: end "
                "what else it does.",
            )

    def _end(self, stop_mode: Stop) -> None:
        """Stop the robot safely; whatever fails, the torque is switched off three times."""
        rig = self._rig
        try:
            if stop_mode == "hold":
                rig.watch(False)
                return
            if stop_mode == "sag":
                self._pass(_HOLDS)
                rig.limit(_SAG_TORQUE)
                self._pass(_SINKS)
        except BusFailure:  # what can be said no longer; why it ended is known by then
            pass
        except BaseException:
            self._switch_off()
            raise
        self._switch_off()
        with suppress(SuchusError):
            rig.watch(False)
            rig.limit(1.0)

    def _switch_off(self) -> None:
        for _ in range(3):
            with suppress(BusFailure, OSError):
                self._rig.torque(False)

    def _pass(self, seconds: float) -> None:
        """Hold the posture for some time, with goals in every tick."""
        rig = self._rig
        end_tick = self._tick + round(seconds / rig.period)
        while self._tick < end_tick:
            rig.read()
            rig.aim(self._goal)
            self._tick = max(self._clock.wait(self._tick + 1 + self._offset) - self._offset, self._tick + 1)

    def _record(self, cause: str) -> xr.Dataset:
        """Return the log as a record, with counts of the bus, warnings and digests of gait and robot."""
        rig = self._rig
        return self._log.record(
            cause,
            {
                "control_period": rig.period,
                "missed": self._missed_ticks,
                "clamped": self._clamped,
                "broken": [bus.broken for bus in rig.buses],
                "missing": [bus.counts.missing for bus in rig.buses],
                "stale": [bus.counts.stale for bus in rig.buses],
                "hardware": rig.text,
                "warnings": list(self._guard.warnings),
                "gait_digest": digest({"gait": self._gait}),
                "robot_digest": digest({"robot": rig.robot}),
                "versions": versions(),
            },
        )


STOP_PREFIX = "asked to stop: "
"""How the cause of a drive begins that somebody ended: that is no failure."""
_SIGNAL_CAUSE = f"{STOP_PREFIX}a signal."


def wire_statistics(record: xr.Dataset) -> dict[str, Any]:
    """Return statistics of the bus from a log: delays, missing replies, missed ticks, temperature.

    Returns:
        ``late_median``, ``late_p99``, ``late_most`` [s]; ``missed``, ``ticks``; ``holes`` and ``worst_holes`` [-], of
        all readings and of the servo with most, ``worst_servo``; ``hottest`` [degC]; ``clamped`` [-].
    """
    took, has_answered = record.tick_began.values + record.tick_took.values, record.servo_heard.values
    hole_fraction = 1.0 - has_answered.mean(axis=0)
    worst_servo = int(np.argmax(hole_fraction))
    heat = record.servo_temperature.values
    return {
        "late_median": float(np.median(took)),
        "late_p99": float(np.quantile(took, 0.99)),
        "late_most": float(took.max()),
        "missed": int(record.attrs.get("missed", 0)),
        "clamped": int(record.attrs.get("clamped", 0)),
        "ticks": int(record.sizes["time"]),
        "holes": float(hole_fraction.mean()),
        "worst_holes": float(hole_fraction[worst_servo]),
        "worst_servo": str(record.servo.values[worst_servo]),
        "hottest": float(np.nanmax(heat)) if np.isfinite(heat).any() else float("nan"),
    }
