"""Where an episode begins: lying in a gait's mid-stance, standing on hind legs and tail, or floating."""

from dataclasses import replace
from functools import lru_cache
from math import ceil
from typing import Any

import numpy as np

from suchus.control import Standing
from suchus.design import ARTICLE_BODY, Robot, check_needs
from suchus.design.scale import control_period
from suchus.envs.task import Task, swimming
from suchus.errors import Diverged, InvalidDesign
from suchus.gaits import GAITS
from suchus.land import Ground, Run
from suchus.land.afloat import surfaced
from suchus.land.batch import Beginning
from suchus.land.lake import up
from suchus.land.loop import Loop
from suchus.model import activations, compile_model, standing
from suchus.model.export import home
from suchus.motion import check_swim, hip_height

STILL = 3.0
"""How long a robot has stood before an episode of standing begins [s]; it has settled after two."""
_SOON = 0.2  # [s]; when standing up begins, where no crawl is needed
_STRAIGHT = "limbs_only"  # the trunk is straight in its first posture


def begin(task: Task) -> Beginning:
    """Return how episodes of a task begin, before anything is left to chance.

    Raises:
        OutsideLimits: the robot cannot take the posture.
        Diverged: it does not stand up.
        InvalidDesign: it touches the ground where it should float.
        OutsideLimits: its joints cannot follow its swimming motion.
    """
    if task.start == "upright":
        return _upright(task.body, task.ground, task.timestep)
    model = compile_model(task.body, task.timestep)
    if task.start == "swimming":
        return _afloat(task, model)
    qpos, servos = home(model, task.body, task.gait)
    return Beginning(qpos, np.zeros(model.nv), activations(model, servos), servos)


def off_by(task: Task, at: Beginning, jitter: np.ndarray) -> Beginning:
    """Return a beginning with its its joints displaced by ``jitter``, shape (servo,) [rad]; the commanded angles stay.

    A lying robot is put on the ground again. One that stands keeps its tail, whose bend is no joint's alone.
    """
    model = compile_model(task.body, task.timestep)
    if task.start == "lying":
        return at._replace(qpos=standing(model, task.robot, hip_height(task.robot, task.gait), at.commanded + jitter))
    qpos = at.qpos.copy()
    qpos[model.jnt_qposadr[model.actuator_trnid[:-1, 0]]] += jitter[:-1]
    return at._replace(qpos=qpos)


def _afloat(task: Task, model: Any) -> Beginning:
    """Put a robot on the water in the mean posture of its swimming motion."""
    assert task.lake is not None  # see ``Task``
    motion, robot = swimming(task.robot, task.swim), check_needs(task.robot, ARTICLE_BODY, "a swim")
    check_swim(robot, motion.swim)
    servos = replace(motion, ramp=1.0).targets(robot, np.zeros(1))[0]  # amplitudes that grow are zero at first
    stands = standing(model, task.robot, hip_height(task.robot, task.gait), servos)
    qpos = surfaced(task.body, task.lake, up(task.ground), stands, task.timestep)
    if np.array_equal(qpos, stands):
        raise InvalidDesign(
            f"robot {task.robot.name!r} touches the ground where its episode begins, at the world's origin with the "
            f"level at {task.lake.at(0.0)[0]:g} m; a task that begins swimming needs deeper water: raise "
            "task.lake.level."
        )
    return Beginning(qpos, np.zeros(model.nv), activations(model, servos), servos)


@lru_cache(maxsize=16)
def _upright(robot: Robot, ground: Ground, timestep: float) -> Beginning:
    """Let a robot stand up once, as the shelf does it, and return the state in which it stands still."""
    gait, period = GAITS[_STRAIGHT], control_period(robot)
    control = Standing(at=_SOON, hold=STILL)
    run = Run(robot=robot, gait=gait, ground=ground, control=control)
    ticks = ceil((control.upright_from(robot) + STILL) / period)
    loop = Loop([run], timestep, ticks=ticks)
    for _ in range(ticks):
        loop.decide()
        loop.advance()
    batch = loop.batch
    if not batch.alive.all():
        raise Diverged(
            f"robot {robot.name!r} does not stand up: {batch.cause[0]}; an upright start needs one that does.",
            time=float(batch.ended[0]),
        )
    qpos, qvel, act = (np.array(part[0]) for part in (batch.qpos, batch.qvel, batch.activations))
    return Beginning(qpos, qvel, act, np.array(loop.command.targets[0]))
