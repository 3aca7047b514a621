"""The robot in the resolved flow: held, or swimming on its own."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import Crocodile
from suchus.design.checks import Checks
from suchus.errors import InvalidDesign
from suchus.flow.setup import LAYER_CELLS
from suchus.kinematics.mass import GRAVITY
from suchus.motion import Swim, check_swim
from suchus.motion.swim import YAWS
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.slender import Water, cycle, recoil
from suchus.water.swimming import wave_speed

_GROWS = 0.5
"""Part of the first cycle in which the motion grows from nothing [cycle]."""
_SAMPLES = 120
"""Samples of the measured cycle [-]."""
_SLACK = 1e-6
"""Rounding of the phase [cycle]."""
_DENSITY = 1000.0
"""Of the water [kg/m3]."""

Progress = Callable[[float], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tether:
    """How finely and how long a swim is resolved."""

    cells: int
    """Cells per body length [-]."""
    viscosity: float
    """Kinematic viscosity of the water [m2/s]."""
    cycles: int
    """How many cycles are simulated; the last is measured [-]."""

    def __post_init__(self) -> None:
        with Checks("tether", self) as check:
            check.whole("cells", 24, 4096)
            check.whole("cycles", 1, 1000)
            check.number("viscosity", 1e-7, 10.0, "m2/s")


def _check(outline: Outline, motion: Swim, setting: Tether, sway: complex, turn: complex) -> None:
    """Refuse what joints, servos or grid cannot follow."""
    check_swim(outline.robot, motion)
    length, moving = outline.robot.length, cycle(outline, motion, sway, turn)
    speed = float(np.hypot(moving.x_rate, moving.y_rate).max())
    layer, cell = (length * setting.viscosity / max(speed, 1e-12)) ** 0.5, length / setting.cells
    if layer < LAYER_CELLS * cell:
        raise InvalidDesign(
            f"the boundary layer of {motion.name!r} is {layer:.2g} m thin and a cell {cell:.2g} m; take at least "
            f"{int(np.ceil(LAYER_CELLS * length / layer))} cells per body length, or a viscosity of at least "
            f"{setting.viscosity * (LAYER_CELLS * cell / layer) ** 2:.2g} m2/s."
        )


def tether(
    robot: Crocodile, motion: Swim, setting: Tether, *, turn: complex = 0j, progress: Progress = lambda _: None
) -> xr.Dataset:
    """Return the flow around a body whose snout is held: forces over the last cycle, pressure at its four quarters.

    Args:
        robot: who waves.
        motion: how.
        setting: grid, water and time.
        turn: harmonic of the head's direction [rad].
        progress: called with the share that is done.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow came apart.
    """
    length, period = robot.length, 1.0 / motion.frequency
    outline = Outline(robot, setting.cells + 1)
    _check(outline, motion, setting, 0j, turn)
    shape = immersed(outline, motion, turn=turn, grow=_GROWS * period)
    grid = flow.Grid.covering(
        (-0.75 * length, 2.0 * length), (-0.75 * length, 0.75 * length), cell=length / setting.cells
    )
    body = flow.Body(shape=shape)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=setting.viscosity, density=_DENSITY, bodies=(body,)))
    end, seen = setting.cycles * period, _Held(outline, (setting.cycles - 1) * period, period)

    def watch(sim: flow.Simulation) -> None:
        seen.look(sim)
        progress(sim.time / end)

    sim.run(end, watch=watch, progress=False)
    return seen.record(sim)


class _Held:
    """What is seen of a held body."""

    def __init__(self, outline: Outline, start: float, period: float) -> None:
        self._outline = outline
        self._start, self._period = start, period
        self._times: list[float] = []
        self._differences: list[float] = []
        self._torque: list[np.ndarray] = []
        self._quarters: list[tuple[float, np.ndarray, flow.Spine]] = []

    def look(self, sim: flow.Simulation) -> None:
        phase = (sim.time - self._start) / self._period
        if phase <= 0.0:
            return
        surface = sim.surface()
        midline = sim.setup.bodies[0].shape.spine(sim.time)  # type: ignore[attr-defined]
        self._times.append(phase)
        self._differences.append(_difference(self._outline, surface, midline))
        self._torque.append(_joint_torques(self._outline, surface, midline))
        if phase > 0.25 * (len(self._quarters) + 1) - _SLACK:
            self._quarters.append((self._differences[-1], sim.pressure.copy(), midline))

    def record(self, sim: flow.Simulation) -> xr.Dataset:
        series = sim.record.after(self._start)
        phase = np.arange(1, _SAMPLES + 1) / _SAMPLES
        force, when = series.force(), (series.time - 0.5 * series.step - self._start) / self._period
        torque = np.array(self._torque)
        torques = np.column_stack([np.interp(phase, self._times, torque[:, i]) for i in range(torque.shape[1])])

        def sampled(values: np.ndarray) -> np.ndarray:
            return np.interp(phase, when, values)

        data = xr.Dataset(
            {
                "thrust": ("phase", sampled(-force[:, 0]), {"units": "N/m"}),
                "aside": ("phase", sampled(force[:, 1]), {"units": "N/m"}),
                "power": ("phase", sampled(series.column("power")), {"units": "W/m"}),
                "joint_torque": (("phase", "joint"), torques, {"units": "N m/m"}),
                "difference": ("instant", [q[0] for q in self._quarters], {"units": "Pa"}),
                "difference_over_cycle": (
                    "phase",
                    np.interp(phase, self._times, self._differences),
                    {"units": "Pa"},
                ),
                "pressure": (("instant", "y", "x"), np.array([q[1] for q in self._quarters]), {"units": "Pa"}),
                "noise": ((), _noise(series, self._period), {"units": "1"}),
                "thin": ((), sim.thin["body"], {"units": "1"}),
            },
            coords={
                "phase": phase,
                "x": sim.setup.grid.x,
                "y": sim.setup.grid.y,
                "instant": [0.25, 0.5, 0.75, 1.0],
                "joint": [*YAWS, "tail_yaw_1"],
            },
        )
        for name, unit in (("x", "m"), ("y", "m"), ("heading", "rad"), ("half_width", "m")):
            values = np.array([getattr(midline, name) for _, _, midline in self._quarters])
            data[f"midline_{name}"] = (("instant", "station"), values, {"units": unit})
        return data


def _noise(series: flow.Record, period: float) -> float:
    """Return the noise of the force along the body; not a number where the series is too short or constant [-]."""
    force = series.force()[:, 0]
    window = max(period / 12, 10 * float(series.step.mean()))  # enough steps for a cubic
    if series.time[-1] - series.time[0] < 2 * window or np.ptp(force) == 0.0:
        return float("nan")
    return flow.noise(series.time, force, window=window)


def _joint_torques(outline: Outline, surface: flow.Surface, midline: flow.Spine) -> np.ndarray:
    """Return the moment of the water about each yaw joint and the first cable joint, of what lies beyond it [N m/m]."""
    m = surface.markers
    fx, fy = surface.traction * m.length
    found = []
    for i, place in enumerate(outline.places[:4]):
        x, y = np.interp(place, outline.s, midline.x), np.interp(place, outline.s, midline.y)
        beyond = m.station < place if i < 3 else m.station > place
        found.append(float(np.sum(((m.x - x) * fy - (m.y - y) * fx)[beyond])))
    return np.array(found)


def _difference(outline: Outline, surface: flow.Surface, midline: flow.Spine) -> float:
    """Return the mean pressure along the convex side of the tail less that along the concave side [Pa]."""
    m, root = surface.markers, outline.robot.length - outline.robot.tail.length + outline.robot.tail.offset
    bend = float(midline.heading[-1] - np.interp(root, outline.s, midline.heading))
    means = []
    for side in (1.0, -1.0):
        part = (m.side == side) & (m.station > root)
        means.append(float(np.average(surface.pressure[part], weights=m.length[part])))
    return (means[1] - means[0]) * float(np.sign(bend))  # a bend to the left is convex on the right


def free_swim(robot: Crocodile, motion: Swim, setting: Tether, *, progress: Progress = lambda _: None) -> xr.Dataset:
    """Return a swim from rest in three degrees of freedom, the body as heavy as the water it displaces.

    Args:
        robot: who swims.
        motion: how.
        setting: grid, water and time.
        progress: called with the share that is done.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow came apart.
    """
    length, period = robot.length, 1.0 / motion.frequency
    outline = Outline(robot, setting.cells + 1)
    _check(outline, motion, setting, *recoil(outline, motion, 0.0, Water()))
    shape = immersed(outline, motion, grow=_GROWS * period)
    grid = flow.Grid.covering((-1.0 * length, 2.5 * length), (-length, length), cell=length / setting.cells)
    body = flow.FreeBody(shape=shape, start=(0.5 * length, 0.0))
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=setting.viscosity, density=_DENSITY, bodies=(body,), follow="body")
    )
    end, track, times = setting.cycles * period, [], []

    def watch(sim: flow.Simulation) -> None:
        if sim.time >= end - 2 * period:
            track.append(_ends(sim))
            times.append(sim.time)
        progress(sim.time / end)

    sim.run(end, watch=watch, progress=False)
    even = end + period * (np.arange(2 * _SAMPLES + 1) / _SAMPLES - 2.0)
    sampled = np.column_stack([np.interp(even, times, column) for column in np.array(track).T])
    return _free_record(outline, motion, sim, sampled, setting.cycles)


def _ends(sim: flow.Simulation) -> tuple[float, float, float, float]:
    """Return the snout's place, the head's direction and the tail tip's way to the side, in the world."""
    pose = sim.pose("body")
    midline = sim.setup.bodies[0].shape.spine(sim.time).placed(pose)  # type: ignore[attr-defined]
    return float(midline.x[0]), float(midline.y[0]), float(midline.heading[0]), float(midline.y[-1])


def _free_record(outline: Outline, motion: Swim, sim: flow.Simulation, track: np.ndarray, cycles: int) -> xr.Dataset:
    series, period = sim.record, 1.0 / motion.frequency
    means = np.empty((2, cycles))
    for i in range(cycles):
        part = (series.time > i * period) & (series.time <= (i + 1) * period)
        for row, values in enumerate((-series.column("velocity_x"), series.column("power"))):
            means[row, i] = np.average(values[part], weights=series.step[part])
    grid, shape = sim.setup.grid, sim.setup.bodies[0].shape
    midline = shape.spine(sim.time).placed(sim.pose("body"))  # type: ignore[attr-defined]
    data = xr.Dataset(
        {
            "speed": ("cycle", means[0], {"units": "m/s"}),
            "power": ("cycle", means[1], {"units": "W/m"}),
            "snout_x": ("sample", track[:, 0], {"units": "m"}),
            "snout_y": ("sample", track[:, 1], {"units": "m"}),
            "heading": ("sample", track[:, 2], {"units": "rad"}),
            "tail_y": ("sample", track[:, 3], {"units": "m"}),
            "vorticity": (("corner_y", "corner_x"), sim.vorticity, {"units": "1/s"}),
            "weight": ((), _DENSITY * GRAVITY * shape.mass(sim.time).area, {"units": "N/m"}),
            "wave_speed": ((), wave_speed(outline, motion, cycle(outline, motion)), {"units": "m/s"}),
        },
        coords={"corner_x": grid.x[:-1] + 0.5 * grid.cell, "corner_y": grid.y[:-1] + 0.5 * grid.cell},
    )
    for name, unit in (("x", "m"), ("y", "m"), ("heading", "rad"), ("half_width", "m")):
        values = getattr(midline, name) - (sim.frame[0, "xy".index(name)] if name in "xy" else 0.0)
        data[f"midline_{name}"] = ("station", values, {"units": unit})
    return data
