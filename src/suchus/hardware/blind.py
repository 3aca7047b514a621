"""A robot of hobby servos without feedback: it gets pulses, and returns no readings."""

from collections.abc import Sequence

import numpy as np

from suchus.hardware.bus import Bus, PulseBoards, ServoPlace
from suchus.hardware.rig import RigReading
from suchus.hardware.servo_map import ServoMap
from suchus.robot.control import Sensed
from suchus.robot.design import Robot, layout


class BlindRig:
    """The counterpart of ``Rig`` for servos without feedback: the same methods, and NaN for every reading.

    Args:
        robot: the robot.
        servo_map: which servo hangs on which channel, and what pulses it understands.
        pulses: the open boards.
    """

    senses: tuple[str, ...] = ()
    """Nothing."""
    buses: tuple[Bus, ...] = ()
    """None that answer."""
    servos: tuple[ServoPlace, ...] = ()
    """None that tell their heat."""

    def __init__(self, robot: Robot, servo_map: ServoMap, pulses: PulseBoards) -> None:
        """Take pulse widths, directions and angle limits of all servos from the servo map."""
        self.robot, self._pulses = robot, pulses
        self.names = layout(robot).servos
        self._lines = servo_map.ordered(robot)
        self._places = [(line.board, line.channel) for line in self._lines]
        self._sign = np.array([line.direction for line in self._lines])
        self._centre = np.array([line.pulse_centre for line in self._lines])
        self._slope = np.array([line.pulse_per_radian for line in self._lines])
        self._offset = np.array([line.offset for line in self._lines])
        ends = np.array([[line.pulse_min, line.pulse_max] for line in self._lines])
        angle_limits = self._sign[:, None] * (
            (ends - self._centre[:, None]) / self._slope[:, None] - self._offset[:, None]
        )
        self.low, self.high = angle_limits.min(axis=1), angle_limits.max(axis=1)
        self.speed = np.array([robot.servo(name).speed for name in self.names])
        self.period = 1.0 / servo_map.rate
        self.asked = np.zeros(len(self.names), dtype=bool)
        self.step = float((pulses.step / self._slope).max())
        self.text = f"servo map {servo_map.name}"
        count = len(self.names)
        unknown = np.full((6, count), np.nan)
        zero_counts = np.zeros((3, count), dtype=int)
        self.now = RigReading(
            angle=unknown[0], velocity=unknown[1], torque=unknown[2], current=unknown[3], voltage=unknown[4],
            temperature=unknown[5], error=zero_counts[0], heard=zero_counts[1], age=zero_counts[2],
        )  # fmt: skip
        self.jumps = np.zeros(count, dtype=int)

    @property
    def bounds(self) -> Sequence[tuple[str, float, float]]:
        """Name of each servo, and the least and greatest angle that it may be sent to [rad]."""
        return list(zip(self.names, self.low.tolist(), self.high.tolist(), strict=True))

    def check(self) -> list[str]:
        """Return a warning that nothing can be checked."""
        return [
            "These servos tell nothing: they go to the first posture at once, nobody sees one that is hot, stuck or "
            "unplugged, "
            "and they hold their last goal if this computer dies. Hold the robot off the ground, and put a switch "
            "into the "
            "supply."
        ]

    def read(self) -> RigReading:
        """Return a reading of NaN."""
        return self.now

    def sensed(self, time: float) -> Sensed:
        """Return a reading of NaN, for a controller that senses nothing."""
        unknown, place = np.full((1, len(self.names)), np.nan), layout(self.robot)
        return Sensed(
            time=time, servo_position=unknown, servo_velocity=unknown, servo_torque=unknown,
            foot_pressure=np.full((1, len(place.limbs)), np.nan),
            belly_pressure=np.full((1, len(place.trunk)), np.nan), tail_pressure=np.full(1, np.nan),
            orientation=np.full((1, 4), np.nan), angular_velocity=np.full((1, 3), np.nan),
            acceleration=np.full((1, 3), np.nan),
        )  # fmt: skip

    def aim(self, angles: np.ndarray) -> np.ndarray:
        """Send all servos to angles, and return the angles of the rounded pulses, shape (servo,) [rad]."""
        widths = self._centre + self._slope * (self._sign * angles + self._offset)
        step = self._pulses.step
        rounded_widths = np.rint(widths / step) * step
        self._pulses.send(dict(zip(self._places, rounded_widths.tolist(), strict=True)))
        sent_angles: np.ndarray = self._sign * ((rounded_widths - self._centre) / self._slope - self._offset)
        return sent_angles

    def ready(self, goals: np.ndarray) -> np.ndarray:
        """Send pulses to all servos, which gives them their torque."""
        return self.aim(goals)

    def torque(self, enable: bool) -> None:
        """Switch all pulses off; the next goals switch them on."""
        if not enable:
            self._pulses.off()

    def limit(self, share: float) -> None:
        """Do nothing: these servos have no such limit."""

    @property
    def patience(self) -> float:
        """No servo watches whether we are there [s]."""
        return float("inf")

    def watch(self, enable: bool) -> None:
        """Do nothing: these servos have no watchdog."""

    def close(self) -> None:
        """Let go of the boards."""
        self._pulses.close()
