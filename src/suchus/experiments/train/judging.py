"""What a policy reaches in full physics: speed and turning rate for each command of a grid."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from jaxtyping import Float

from suchus.core.errors import Doubtful
from suchus.core.progress import Progress, silent
from suchus.experiments.train.tracking import TrackedMotion, motion
from suchus.robot.control import Control, Learned
from suchus.robot.control.policy import Policy
from suchus.robot.design import Robot
from suchus.robot.design.scale import control_period, physics_step
from suchus.robot.motion import START
from suchus.sim.land import Ground, Lake, Run, Tolerances, simulate

COMMANDS = ((1 / 3, 2 / 3, 1.0), (-1.0, 0.0, 1.0))
"""Fractions of the greatest speed and of the greatest turning rate that are commanded [-]."""
_SETTLING_PERIODS, _WINDOW_PERIODS = 2.0, 4.0
_FIRST_SEED = 7_000_000  # of robots as built, none of which is trained on


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """Commands and what was reached, one entry for each command."""

    speed: Float[np.ndarray, " command"]
    """Commanded speed [m/s]."""
    turn: Float[np.ndarray, " command"]
    """Commanded turning rate [rad/s]."""
    reached: TrackedMotion
    """What was reached."""
    max_speed: float = field(default=1.0)
    """Greatest commanded speed [m/s]."""
    max_turn: float = field(default=1.0)
    """Greatest commanded turning rate [rad/s]."""

    @property
    def speed_error(self) -> float:
        """Mean size of the error of the speed over the greatest command; a fall counts as standing still [-]."""
        return float(np.abs(self.reached.speed - self.speed).mean() / self.max_speed)

    @property
    def turn_error(self) -> float:
        """Mean size of the error of the turning rate over the greatest command [-]."""
        return float(np.abs(self.reached.turn - self.turn).mean() / self.max_turn)

    @property
    def falls(self) -> int:
        """Number of commands under which the robot fell [-]."""
        return int(self.reached.has_fallen.sum())

    @property
    def error(self) -> float:
        """Mean of the errors of speed and turning rate [-]."""
        return 0.5 * (self.speed_error + self.turn_error)


def grid(policy: Policy, fractions: tuple[Sequence[float], Sequence[float]] = COMMANDS) -> list[tuple[float, float]]:
    """Return the commands on which a policy is judged: speed [m/s] and turning rate [rad/s]."""
    return [(u * policy.max_speed, w * policy.max_turn) for u, w in product(*fractions)]


def judge(
    robot: Robot,
    policy: Policy,
    *,
    lake: Lake | None = None,
    ground: Ground | None = None,
    timestep: float | None = None,
    seed: int | None = 0,
    progress: Progress = silent,
) -> Judgement:
    """Return what a policy reaches on level ground, or in water, under each command of a grid.

    Each command gets a robot of its own, built with the errors of ``suchus.sim.land.Tolerances``.

    Args:
        robot: the robot.
        policy: the policy.
        lake: the water; None on dry land.
        ground: the ground; level if None.
        timestep: time step of the physics [s]; the robot's own if None.
        seed: seed of the errors of the robots as built; None for the design itself.
        progress: told the share that is done.
    """
    commands = grid(policy)
    controls: list[Control] = [Learned(policy=policy, forward=speed, turn=turn) for speed, turn in commands]
    runs = [Run(robot=robot, gait=policy.gait, control=c, lake=lake, ground=ground or Ground()) for c in controls]
    if seed is not None:
        runs = [Tolerances().draw_run(run, _FIRST_SEED + 1000 * seed + i) for i, run in enumerate(runs)]
    step = control_period(robot)
    start = round(round((START + _SETTLING_PERIODS * policy.gait.period) / step) * step, 12)
    end = round(start + round(_WINDOW_PERIODS * policy.gait.period / step) * step, 12)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Doubtful)
        record = simulate(runs, duration=end, timestep=timestep or physics_step(robot), effort=False, progress=progress)
    speeds, turns = np.array(commands).T
    return Judgement(
        speed=speeds,
        turn=turns,
        reached=motion(record, start, end),
        max_speed=policy.max_speed,
        max_turn=policy.max_turn,
    )
