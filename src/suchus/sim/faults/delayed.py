"""A servo whose commands arrive late."""

from dataclasses import dataclass

from suchus.robot.design import Robot
from suchus.sim.fault import Plant, ServoFault, refuse_number
from suchus.sim.persistence import PERMANENT, Persistence

_TIME_TOLERANCE = 1e-9  # [s]


@dataclass(frozen=True, slots=True, repr=False)
class Delayed(ServoFault):
    """A servo whose commands arrive late: a bus that is busy, or a computer that does something else.

    At first the servo keeps the command that it had when the fault began; then commands arrive late by ``delay``,
    rounded up to control periods. With spells these are spikes of delay.
    """

    joint: str
    """Name of the servo."""
    delay: float = 0.1
    """Time from a command to its arrival [s]; 0 to 10."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse a delay out of range, too."""
        ServoFault.refuse(self, robot)
        refuse_number(self, self.delay, 0.0, 10.0, "is late by", " s")

    def command(self, plant: Plant) -> None:
        """Keep the command of this control period, and pass on the newest that is old enough."""
        plant.memory[repr(plant.time)] = plant.targets[self.joint]
        times = sorted(map(float, plant.memory))
        arrived = [time for time in times if time <= plant.time - self.delay + _TIME_TOLERANCE]
        for earlier_time in arrived[:-1]:
            del plant.memory[repr(earlier_time)]
        plant.targets[self.joint] = plant.memory[repr(arrived[-1] if arrived else times[0])]


fault = Delayed
harmless = (Delayed("LF_yaw", 0.0),)
