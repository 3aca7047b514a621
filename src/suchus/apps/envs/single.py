"""One robot as a ``gymnasium.Env``: its spaces, the checks of what users give, and its picture, without OpenGL."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import gymnasium
import numpy as np
import xarray as xr
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle

from suchus.apps.envs.pack import Pack
from suchus.apps.envs.senses import senses
from suchus.apps.envs.shelf import resolve_task
from suchus.apps.envs.task import TERMS, AnyGoal, Landing, Task, Terms
from suchus.core.errors import OutsideLimits, UnknownName
from suchus.robot.control.observation import observation_layout
from suchus.robot.design import Robot, layout
from suchus.robot.robots import size_relative_to_article
from suchus.sim.land.lake import up_direction
from suchus.visual.figures import COLOURS, new, styled
from suchus.visual.figures.posture import draw_posture

RENDER_MODES = ("rgb_array",)


def action_space(robot: Robot) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's actions: one number of -1 to 1 for each servo."""
    return gymnasium.spaces.Box(-1.0, 1.0, (len(layout(robot).servos),), np.float32)


def observation_space(robot: Robot, *, goal: bool = False, readings: tuple[str, ...] | None = None) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's observations.

    Args:
        robot: the robot.
        goal: whether the task has a goal, see ``senses.senses``.
        readings: readings of the observation, as ``Task.observed``; None for those of a task with or without a goal.
    """
    columns = senses(robot, goal=goal) if readings is None else observation_layout(robot, readings)
    return gymnasium.spaces.Box(-1.0, 1.0, (columns[-1].columns.stop,), np.float32)


def checked(actions: Any, shape: tuple[int, ...]) -> Float[np.ndarray, "*b servo"]:
    """Return actions as numbers.

    Raises:
        OutsideLimits: they have another shape, or are not finite.
    """
    action_values = np.asarray(actions, dtype=float)
    if action_values.shape != shape:
        raise OutsideLimits(
            f"actions have the shape {action_values.shape}; {shape} is needed: one number for each servo."
        )
    if not np.isfinite(action_values).all():
        raise OutsideLimits("an action is not a finite number; -1 to 1 is allowed.")
    return action_values


def check_render_mode(mode: str | None) -> None:
    """Refuse an unknown render mode.

    Raises:
        UnknownName: the message lists those that are.
    """
    if mode is not None and mode not in RENDER_MODES:
        raise UnknownName("render mode", mode, RENDER_MODES)


class CrocodileEnv(gymnasium.Env):  # type: ignore[misc]  # gymnasium is not read by mypy
    """A robot at a task: a pack of one, see ``Pack``.

    Args:
        task: the task, or its name.
        render_mode: None or ``rgb_array``.
        **changes: fields of the task to change; ``robot`` and ``gait`` also by name.

    Raises:
        UnknownName: no such task, field or render mode.
        InvalidDesign: a value that makes no sense.
    """

    metadata: dict[str, Any] = {"render_modes": list(RENDER_MODES)}  # noqa: RUF012  gymnasium reads it off the class

    def __init__(self, task: Task | str = "Crawl", render_mode: str | None = None, **changes: Any) -> None:
        check_render_mode(render_mode)
        self.task = resolve_task(task, changes)
        self.pack = Pack(self.task, 1)
        self.action_space = action_space(self.task.robot)
        self.observation_space = observation_space(self.task.robot, readings=self.task.observed)
        self.render_mode = render_mode
        self.metadata = metadata(self.task)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode; equal seeds give equal episodes.

        Args:
            seed: seed of everything that is left to chance; None goes on with the last one.
            options: none are known.

        Returns:
            The observation, and ``time`` and ``fault``.
        """
        super().reset(seed=seed)
        del options
        self.pack.restart([0], [self.np_random])
        return self.pack.feel()[0], {"time": 0.0, "fault": self.pack.chances[0].fault}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Act once.

        Args:
            action: one number of -1 to 1 for each servo; what is beyond counts as -1 or 1.

        Returns:
            Observation; reward; whether it fell or reached its goal; False, since time limits are a wrapper's; and the
            terms of the reward, ``time``, ``fault`` and ``cause``, the sentence that says why the episode ended.

        Raises:
            OutsideLimits: an action of another shape, or not finite.
        """
        terms = self.pack.act(checked(action, self.action_space.shape)[None], np.ones(1, dtype=bool))
        info = {name: values.tolist()[0] for name, values in step_info(self.pack, terms).items()}
        return self.pack.feel()[0], float(terms.reward(self.task.rewards)[0]), bool(terms.is_over[0]), False, info

    def render(self) -> np.ndarray | None:
        """Return a picture of (480, 640, 3) for ``rgb_array``, else None."""
        return portrait(self.pack, 0) if self.render_mode == "rgb_array" else None


def step_info(pack: Pack, terms: Terms) -> dict[str, np.ndarray]:
    """Return the entries of ``info`` after a step, each with one value for each robot."""
    info = {name: getattr(terms, name) for name in TERMS if name != "fall"}
    return info | {"time": pack.time, "fault": pack.faults.copy(), "cause": pack.causes.copy()}


def portrait(pack: Pack, robot: int) -> np.ndarray:
    """Return a picture of one robot of a pack."""
    text = f"{pack.time[robot]:.2f} s  {pack.chances[robot].fault}"
    surroundings = Surroundings(
        upward=up_direction(pack.task.ground), goal=pack.task.goal, goal_position=pack.goals[robot]
    )
    return picture(pack.task.robot, pack.record(robot), text, surroundings)


def metadata(task: Task) -> dict[str, Any]:
    """Return render modes and frame rate, as gymnasium's ``metadata``."""
    return {"render_modes": list(RENDER_MODES), "render_fps": round(1.0 / task.decision)}


WIDTH, HEIGHT = 640, 480
"""Width and height of a picture [pixel]."""
_DPI = 100
_PLACES = ((0.12, 0.622, 0.8, 0.333), (0.12, 0.09, 0.8, 0.52))
"""Rectangles of the two views as fractions of the picture: left, bottom, width, height."""
_VIEW_LENGTH, _VIEW_WIDTH, _VIEW_HEIGHT = (
    1.6,
    0.5,
    0.75,
)  # [m]; what is seen of the article's robot: along the walk, across it, and up
_VIEW_DEPTH = 0.03  # [m]; what is seen below the ground
_TINT = 0.22  # opacity of the water and of the goal
_EDGE = 0.45  # [-]; of the picture's sides from its middle, where an arrow points to a goal beyond it
_ARROW = 0.06  # [-]; its length, of the picture's width


_SKY_FRACTION = 0.4
"""Share of the view from the side that is above a robot which floats high above the ground [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a picture shows beside the robot."""

    upward: Float[np.ndarray, "3"]
    """Unit vector against gravity."""
    goal: AnyGoal | None = None
    """The goal; None without a goal."""
    goal_position: Float[np.ndarray, "2"] | None = None
    """Position of the goal, forward and left in the world [m]."""


def picture(
    robot: Robot, record: xr.Dataset, text: str, surroundings: Surroundings
) -> UInt8[np.ndarray, "height width 3"]:
    """Return a robot from above and from its right side, with its centre of mass, as red, green and blue.

    Water is blue, its surface a line; the goal is a ring, or a line where it is land, and an arrow at the edge of the
    picture points to one that is beyond it. The view from the side rises with a robot that floats far above the ground.

    Args:
        robot: robot whose record it is.
        record: record of one run, one sample.
        text: what is written above.
        surroundings: gravity and the goal.
    """
    with styled(font__size=9, axes__titlesize=10, xtick__labelsize=8, ytick__labelsize=8, axes__labelsize=9):
        figure = new(width=WIDTH / _DPI, height=HEIGHT / _DPI)
        figure.set_dpi(_DPI)
        figure.set_layout_engine("none")  # finding a layout would take three quarters of the time
        top_axes, side_axes = (figure.add_axes(rectangle) for rectangle in _PLACES)
        top_axes.tick_params(labelbottom=False)
        draw_posture(top_axes, robot, record, 0.0)
        draw_posture(side_axes, robot, record, 0.0, view="side")
        x, y, z = record.centre_of_mass.values[0].tolist()
        view_length, view_width, view_depth, view_height = (
            size_relative_to_article(robot).length * length
            for length in (_VIEW_LENGTH, _VIEW_WIDTH, _VIEW_DEPTH, _VIEW_HEIGHT)
        )
        lower_bound = max(-view_depth, z - (1 - _SKY_FRACTION) * (view_height + view_depth))
        top_axes.set(
            xlim=(x - view_length / 2, x + view_length / 2),
            ylim=(y - view_width / 2, y + view_width / 2),
            ylabel="left [m]",
            title=text,
        )
        side_axes.set(
            xlim=(x - view_length / 2, x + view_length / 2),
            ylim=(lower_bound, lower_bound + view_height + view_depth),
            xlabel="forward [m]",
            ylabel="up [m]",
        )
        if "water_level" in record:
            draw_water(top_axes, side_axes, float(record.water_level[0]), surroundings.upward, y)
        if surroundings.goal is not None and surroundings.goal_position is not None:
            _draw_goal(top_axes, side_axes, surroundings.goal, surroundings.goal_position)
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()
    return np.array(canvas.buffer_rgba())[..., :3]


def draw_water(top_axes: Axes, side_axes: Axes, level: float, upward: Float[np.ndarray, "3"], section_y: float) -> None:
    """Draw the water of a lake as far as two views reach, its surface as a line.

    Args:
        top_axes: view from above; water is where there is some over the ground.
        side_axes: view from the side.
        level: level of the surface above the world's origin, against gravity [m].
        upward: unit vector against gravity.
        section_y: where the view from the side cuts the water [m].
    """
    x, y = np.array(top_axes.get_xlim()), np.array(top_axes.get_ylim())
    depth = level - upward[0] * x[None, :] - upward[1] * y[:, None]
    if (depth > 0.0).any():
        top_axes.contourf(x, y, depth, levels=[0.0, max(depth.max(), 1e-9)], colors=[COLOURS["water"]], alpha=_TINT)
    line = [(level - upward[1] * section_y) / upward[0]] if upward[0] else []  # where the surface meets the ground
    ends = np.sort([*x, *(shore for shore in line if x[0] < shore < x[1])])
    for pair in pairwise(ends):
        heights = (level - upward[0] * np.array(pair) - upward[1] * section_y) / upward[2]
        if heights.mean() > 0.0:
            side_axes.fill_between(pair, 0.0, heights, color=COLOURS["water"], alpha=_TINT, linewidth=0, zorder=0.1)
            side_axes.plot(pair, heights, color=COLOURS["water"], linewidth=1.2, zorder=0.2)


def _draw_goal(top_axes: Axes, side_axes: Axes, goal: AnyGoal, position: Float[np.ndarray, "2"]) -> None:
    """Draw the goal in both views, and an arrow towards it where it lies outside of the view from above."""
    (x_min, x_max), (y_min, y_max) = top_axes.get_xlim(), top_axes.get_ylim()
    colour = COLOURS["limbs_only"]
    if isinstance(goal, Landing):
        for ax in (top_axes, side_axes):
            ax.axvline(float(position[0]), color=colour, linestyle=(0, (4, 2)))
    else:
        top_axes.add_patch(
            Circle((float(position[0]), float(position[1])), goal.within, facecolor="none", edgecolor=colour)
        )
        side_axes.axvspan(
            float(position[0]) - goal.within, float(position[0]) + goal.within, color=colour, alpha=_TINT, linewidth=0
        )
    centre = np.array([x_min + x_max, y_min + y_max]) / 2
    direction = position - centre if not isinstance(goal, Landing) else np.array([position[0] - centre[0], 0.0])
    overshoot = float((np.abs(direction) / (_EDGE * np.array([x_max - x_min, y_max - y_min]))).max())
    if overshoot > 1.0:
        head = centre + direction / overshoot
        tail = head - _ARROW * (x_max - x_min) * direction / np.hypot(*direction)
        top_axes.annotate("", tuple(head), tuple(tail), arrowprops={"arrowstyle": "-|>", "color": colour}, zorder=9)
