"""The tasks by name, how one is varied by naming its fields, and the environments that gymnasium knows by name."""

from collections.abc import Mapping
from dataclasses import fields, replace
from math import radians, sin
from pathlib import Path
from types import MappingProxyType
from typing import Any, get_args

from suchus.apps.envs.task import AnyGoal, Breaks, CommandRanges, Goal, Landing, Pushes, Rewards, Task
from suchus.core.errors import InvalidDesign, SuchusError, UnknownName
from suchus.robot.control.observation import FAILURE_READINGS, ROBOT_READINGS
from suchus.robot.design import Robot
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS, gait_of
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Lake, Tolerances
from suchus.sim.land.waters import Slice, Space


class NoGymnasium(SuchusError, ImportError):
    """The environments without the library that they are for."""


try:
    import gymnasium
except ImportError as _error:
    raise NoGymnasium("environments need gymnasium; install it with: pip install 'suchus[gym]'.") from _error

STANDING_SPAN = 0.3
"""Span of the actions in the task Stand [rad]: enough for a hop, too little for another posture."""
SWIM_SPAN = 1.4
"""Span of the actions in the task Swim [rad]: 0.75 for the wave on the tail's cable and 0.6 to steer."""
SHORE_SPAN = 2.5
"""Span of the actions in the task Shore [rad]: from limbs folded back to the forward end of a stride."""
VELOCITY_SLOPE = radians(3)
"""Greatest slope of the ground in the task Velocity, along and across the walk [rad]."""
_SLOPE, _OFFSHORE = radians(8), 1.6  # distance of the water line from the beginning [m], where the robot floats free
_CRAWL = Task()
_SWIM = replace(
    _CRAWL,
    robot=ROBOTS["floating_caiman"],
    start="swimming",
    lake=Lake(level=0.5),
    goal=Goal(),
    span=SWIM_SPAN,
    rewards=Rewards(
        forward=0.0, lateral_drift=0.0, upright=0.0, work=-0.01, action_rate=-0.002, fall=-5.0, approach=10.0, goal=5.0
    ),
)
TASKS: Mapping[str, Task] = MappingProxyType(
    {
        "Crawl": _CRAWL,
        "Stand": replace(
            _CRAWL,
            start="upright",
            span=STANDING_SPAN,
            jitter=0.01,
            least_level=-1.0,
            least_height=0.45,
            rewards=Rewards(forward=0.0, lateral_drift=0.0, upright=1.0, work=-0.01, action_rate=-0.002, fall=-5.0),
            pushes=Pushes(),
        ),
        "Fault": replace(_CRAWL, breaks=Breaks()),
        "Velocity": replace(
            _CRAWL,
            gait=GAITS["low_crawl"],
            commands=CommandRanges(),
            readings=tuple(name for name in ROBOT_READINGS if name not in FAILURE_READINGS),
            rewards=Rewards(
                forward=0.0,
                lateral_drift=0.0,
                upright=0.0,
                work=-0.01,
                action_rate=-0.002,
                fall=-5.0,
                speed_error=-10.0,
                turn_error=-4.0,
            ),
            delay=0.02,
            noise=0.01,
            tolerances=Tolerances(),
            slope=VELOCITY_SLOPE,
        ),
        "Swim": _SWIM,
        "Shore": replace(
            _SWIM,
            ground=Ground(uphill=_SLOPE),
            lake=Lake(level=_OFFSHORE * sin(_SLOPE)),
            gait=GAITS["semi_erect"],
            span=SHORE_SPAN,
            goal=Landing(),
        ),
    }
)
"""The tasks by name; vary one with ``dataclasses.replace``, or by naming its fields to ``gymnasium.make``."""


def resolve_task(task: Task | str, changes: Mapping[str, Any]) -> Task:
    """Return a task, given itself or by its name, with some fields changed.

    A robot or a gait may be given by its name in the catalog or the path of its file; a robot brings its gait and its
    size, see ``Task.for_robot``. With ``water`` a flow takes the place of the lake. With ``fast`` the time step becomes
    a control period, the longest that there is, unless ``timestep`` is named.

    Raises:
        UnknownName: there is no such task, field, robot, gait or servo; the message lists those that are.
        InvalidDesign: a value makes no sense.
        UnsuitedRobot: the robot lacks what the task needs.
    """
    if isinstance(task, str):
        if task not in TASKS:
            raise UnknownName("task", task, TASKS)
        task = TASKS[task]
    names = [f.name for f in fields(Task)]
    for name in changes:
        if name not in names:
            raise UnknownName("field of a task", name, names)
    values = dict(changes)
    if values.get("water", "sections") != "sections":
        values.setdefault("lake", None)
    if isinstance(values.get("robot"), (str, Path)):
        values["robot"] = ROBOTS.resolve(values["robot"])
    for name in ("gait", "swim"):
        if isinstance(values.get(name), (str, Path)):
            values[name] = gait_of(values.get("robot", task.robot), values[name])
    kinds: Mapping[str, tuple[type, ...]] = {
        "robot": (Robot,),
        "gait": (Gait,),
        "ground": (Ground,),
        "rewards": (Rewards,),
        "breaks": (Breaks, type(None)),
        "pushes": (Pushes, type(None)),
        "commands": (CommandRanges, type(None)),
        "lake": (Lake, type(None)),
        "tolerances": (Tolerances, type(None)),
        "water": (str, Slice, Space),
        "swim": (Gait, type(None)),
        "goal": (*get_args(AnyGoal), type(None)),
    }
    for name, value in values.items():
        if name in kinds and not isinstance(value, kinds[name]):
            allowed_types = " or ".join("None" if kind is type(None) else kind.__name__ for kind in kinds[name])
            raise InvalidDesign(f"task.{name} is {str(value)[:80]!r}; a {allowed_types} is needed.")
    if "robot" in values:
        task = task.for_robot(values.pop("robot"), values.pop("gait", None))
    if values.get("fast") is True:
        values.setdefault("timestep", control_period(task.robot))
    return replace(task, **values)


MAX_STEPS = 200
"""Greatest number of steps of an episode [-]: 10 s, two and a half cycles of the article's crawl."""
MAX_STEPS_BY_TASK: Mapping[str, int] = MappingProxyType({"Swim": 400, "Shore": 1000})
"""Steps of an episode of the tasks that take longer [-]: 20 s, three times what the steered swim to the goal
takes; 50 s, as in the experiment ``shore``."""
IDS = tuple(f"suchus/{name}-v0" for name in TASKS)
"""Names of the environments."""


def register() -> None:
    """Make the environments known to ``gymnasium.make`` and ``gymnasium.make_vec``; once is enough."""
    for name, identity in zip(TASKS, IDS, strict=True):
        if identity not in gymnasium.registry:
            gymnasium.register(
                identity,
                entry_point="suchus.apps.envs.single:CrocodileEnv",
                vector_entry_point="suchus.apps.envs.vector:CrocodileVectorEnv",
                max_episode_steps=MAX_STEPS_BY_TASK.get(name, MAX_STEPS),
                kwargs={"task": name},
            )
