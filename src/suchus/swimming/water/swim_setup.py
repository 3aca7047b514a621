"""Setup of a robot's swim in the flow solver, and the checks before it runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod

import numpy as np
from jaxtyping import Float

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.setup import MIN_LAYER_CELLS
from suchus.robot.design import Robot
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait, check_limits, check_speeds
from suchus.swimming.water.immersed import half_heights, immersed, trunk
from suchus.swimming.water.outline import Outline
from suchus.swimming.water.setting import DENSITY, GROWS, MAX_CELLS, SwimSetting
from suchus.swimming.water.slender import cycle, recoil
from suchus.swimming.water.undulation import Motion, straight_motion

SLACK = 1e-6
"""Rounding of the phase [cycle]."""
PHASES = 120
"""Phases of the measured cycle at which series are recorded [-]."""
STEPS, SECONDS = 1.1, 1.2e-7
"""In space: steps in a cycle over the cells per body length [-], and processor time of a step over the cells [s]: what
they were at 96 to 192 cells a length."""


@dataclass(frozen=True, kw_only=True)
class ResolvedSwim:
    """A robot, a motion and a setting, from which the flow is set up."""

    robot: Robot
    """The robot that swims."""
    motion: Motion
    """Its swimming motion."""
    setting: SwimSetting
    """Grid, water, time, and what moves the body."""
    sway: complex = 0j
    """Harmonic of the displacement of a tethered body's snout to the right [m]."""
    turn: complex = 0j
    """Harmonic of the direction of a tethered body's head [rad]."""

    @cached_property
    def outline(self) -> Outline:
        """Outline of the robot, a station at every cell."""
        return Outline(self.robot, self.setting.cells + 1)

    @property
    def period(self) -> float:
        """Period of one cycle [s]."""
        return 1.0 / self.motion.frequency

    @property
    def end(self) -> float:
        """Time at which the last cycle ends [s]."""
        return self.setting.cycles * self.period

    @property
    def key(self) -> str:
        """Text that identifies the swim."""
        motion = self.motion
        if hasattr(motion, "middles"):
            return repr((self.sway, self.turn, self.robot, motion.name, motion.middles.tobytes(), self.setting))
        return repr((self.sway, self.turn, self.robot, motion, self.setting))

    @cached_property
    def head(self) -> tuple[complex, complex]:
        """Harmonics of the snout's sway [m] and of the head's direction [rad]: given, or estimated."""
        if self.setting.tethered:
            return self.sway, self.turn
        return recoil(self.outline, self.motion, 0.0, Water())

    @cached_property
    def setup(self) -> flow.Setup:
        """Setup of the flow: the body, its snout at the origin, in its box of water."""
        length, name, free = self.robot.length, self.robot.name, not self.setting.tethered
        shape = body_shape(
            self.outline, self.motion, self.setting, sway=self.sway, turn=self.turn, grow=GROWS / self.motion.frequency
        )
        start = (0.5 * length, 0.0, 0.0) if self.setting.in_space else (0.5 * length, 0.0)
        fixed_body = flow.Body(shape=shape, name=name)
        body = flow.FreeBody(shape=shape, name=name, start=start, free=self.setting.free) if free else fixed_body
        swing = float(np.abs(cycle(self.outline, self.motion, *self.head).y).max()) if self.setting.in_space else 0.0
        return flow.Setup(
            grid=box_grid(self.outline, self.setting, swing), viscosity=self.setting.viscosity, density=DENSITY,
            bodies=(body,), follow=name if free else None, sides=box_sides(self.setting),
            tolerance=self.setting.largest_divergence(),
        )  # fmt: skip

    def check(self) -> None:
        """Refuse a swim beyond the limits of joints, servos, grid, box or machine, before anything runs.

        Raises:
            OutsideLimits: the joints or servos cannot follow the motion.
            InvalidDesign: the boundary layer is too thin for the grid, with the cells that would do; the body would
                reach out of the box, or is too thin for the grid; the machine has not the memory; a free body's head is
                given a motion.
        """
        if not self.setting.tethered and (self.sway or self.turn):
            raise InvalidDesign(
                f"sway and turn of the head are {self.sway:.3g} m and {self.turn:.3g} rad, and the body is free: it "
                "finds them itself. Leave them out, or tether the body with free=TETHERED."
            )
        if isinstance(self.motion, Gait):
            check_limits(self.robot, self.motion)
            check_speeds(self.robot, self.motion)
        self._check_layer()
        self.setting.check_margin()
        setup = self.setup
        self.setting.check_thickness(self.robot, setup.bodies[0].shape)
        setup.check_bodies()

    def _check_layer(self) -> None:
        """Refuse cells that are too coarse for the boundary layer of the motion."""
        length, setting = self.robot.length, self.setting
        moving = cycle(self.outline, self.motion, *self.head)
        speed = float(np.hypot(moving.x_rate, moving.y_rate).max())
        layer, cell = (length * setting.viscosity / max(speed, 1e-12)) ** 0.5, length / setting.cells
        if layer < MIN_LAYER_CELLS * cell:
            cells = int(np.ceil(MIN_LAYER_CELLS * length / layer))
            raise InvalidDesign(
                f"the boundary layer of {self.motion.name!r} is {layer:.2g} m thin and a cell {cell:.2g} m; take at "
                f"least {cells} cells per body length{self._cost(cells)}, or a viscosity of at least "
                f"{setting.viscosity * (MIN_LAYER_CELLS * cell / layer) ** 2:.2g} m2/s."
            )

    def _cost(self, cells: int) -> str:
        """Return a text on the cost of a swim in space with a number of cells per body length."""
        setting = self.setting
        if not setting.in_space:
            return ""
        if cells > MAX_CELLS[setting.axes]:
            return f", more than the {MAX_CELLS[setting.axes]} that are allowed"
        swing = float(np.abs(cycle(self.outline, self.motion, *self.head).y).max())
        count = prod(box_grid(self.outline, replace(setting, cells=cells), swing).cells)
        hours = count * STEPS * cells * setting.cycles * SECONDS / 3600.0
        return f", {count / 1e6:.3g} million cells that take some {hours:.2g} hours for {setting.cycles} cycles"


def body_shape(
    outline: Outline, motion: Motion, setting: SwimSetting, *, sway: complex, turn: complex, grow: float
) -> flow.Midline | flow.Trunk:
    """Return the robot as a body of the flow solver, a slice or itself; see ``immersed`` and ``trunk``."""
    if setting.in_space:
        return trunk(
            outline, motion, grow=grow, tail_height=setting.tail_height, limbs=setting.limbs, sway=sway, turn=turn
        )
    min_half_width = setting.min_half_width(outline.robot.length)
    return immersed(outline, motion, sway=sway, turn=turn, grow=grow, min_half_width=min_half_width)


def box_grid(outline: Outline, setting: SwimSetting, swing: float) -> flow.Grid:
    """Return the cells around a body that swings so far to a side [m]."""
    height = float(half_heights(outline, 0.0).max())
    return setting.grid(outline.robot.length, swing, max(height, 0.5 * setting.tail_height))


def box_sides(setting: SwimSetting) -> flow.Sides:
    """Return the sides of the box: an unbounded domain, in space with its image beyond a plane of symmetry."""
    return flow.Sides(low=flow.Mirror()) if setting.in_space else flow.Sides()


def straight_body(outline: Outline, setting: SwimSetting) -> flow.Body:
    """Return the straight body at rest, its limbs left out."""
    limbless_setting = replace(setting, limbs=False)
    shape = body_shape(outline, straight_motion(outline), limbless_setting, sway=0j, turn=0j, grow=0.0)
    return flow.Body(shape=replace(shape, deforms=False))


def cycle_means(
    series: flow.Record, period: float, cycles: int, names: Sequence[str]
) -> Float[np.ndarray, "name cycle"]:
    """Return the mean of each cycle, steps weighted with their length.

    Args:
        series: series of a swim from its start.
        period: period of one cycle [s].
        cycles: number of cycles [-].
        names: columns of the record.
    """
    means = np.empty((len(names), cycles))
    for i in range(cycles):
        is_in_cycle = (series.time > i * period * (1 + SLACK)) & (series.time <= (i + 1) * period * (1 + SLACK))
        for row, name in enumerate(names):
            means[row, i] = np.average(series.column(name)[is_in_cycle], weights=series.step[is_in_cycle])
    return means
