"""The robot in the resolved flow with its snout held, as the article's Fig. 17 shows it; and towed, bent not at all."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import Crocodile
from suchus.motion import Swim
from suchus.motion.swim import YAWS
from suchus.water.diary import Diary, Progress, run_on
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.tank import DENSITY, GROWS, Tether, check_motion
from suchus.water.undulation import Motion
from suchus.water.view import View, kept

SAMPLES = 120
"""Samples of the measured cycle [-]."""
QUARTERS = (0.25, 0.5, 0.75, 1.0)
"""Instants of the measured cycle at which the article shows the pressure [cycle]."""
_BOX = (2.75, 1.5)
"""Length and width of the box [body length]."""
_TAIL = 33
"""Places along the tail at which the pressures of its two sides are kept [-]."""
_SLACK = 1e-6
"""Rounding of the phase [cycle]."""


def tether(
    robot: Crocodile,
    motion: Motion,
    setting: Tether,
    *,
    turn: complex = 0j,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return the flow around a body whose snout is held: forces over the last cycle, fields at its four quarters.

    Args:
        robot: who waves.
        motion: how: with its joints, or as a wave that its midline follows exactly.
        setting: grid, water and time.
        turn: harmonic of the head's direction [rad]; an exact wave brings its own.
        checkpoint: file that the state is kept in at every quarter of a cycle; if it exists, the swim goes on from
            there. None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid, or the box too small.
        UnreadableFile: the checkpoint is broken or belongs to another swim.
        Diverged: the flow came apart.
    """
    length, period = robot.length, 1.0 / motion.frequency
    outline = Outline(robot, setting.cells + 1)
    check_motion(outline, motion, setting, 0j, turn)
    shape = immersed(outline, motion, turn=turn, grow=GROWS * period, least=setting.least(length))
    grid, body = setting.grid(length, _BOX), flow.Body(shape=shape)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=setting.viscosity, density=DENSITY, bodies=(body,)))
    seen = _Held(outline, View(grid, length, 1.9, 0.6), (setting.cycles - 1) * period, period)
    diary = run_on(
        sim,
        setting.cycles * period,
        period / 4,
        seen.look,
        about=repr(("held", robot, named(motion), setting, turn)),
        checkpoint=checkpoint,
        progress=progress,
    )
    return seen.record(sim, diary)


def named(motion: Motion) -> object:
    """Return what tells a motion from others, in full."""
    return motion if not hasattr(motion, "middles") else (motion.name, motion.frequency, motion.middles.tobytes())


class _Held:
    """What is seen of a held body."""

    def __init__(self, outline: Outline, view: View, start: float, period: float) -> None:
        self._outline, self._view = outline, view
        self._start, self._period = start, period

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        phase = (sim.time - self._start) / self._period
        if phase <= _SLACK:
            return
        surface = sim.surface()
        midline = sim.setup.bodies[0].shape.spine(sim.time)  # type: ignore[attr-defined]
        sides = tail_sides(self._outline, surface)
        diary.note(
            "steps",
            sim.time,
            difference=_difference(self._outline, surface, midline),
            bend=_bend(self._outline, midline),
            place=_place(sides),
            torque=_joint_torques(self._outline, surface, midline),
        )
        if phase > 0.25 * (diary.count("quarters") + 1) - _SLACK:
            fields = self._view.fields(sim)
            diary.note("quarters", sim.time, sides=sides, **fields, **kept(midline))

    def record(self, sim: flow.Simulation, diary: Diary) -> xr.Dataset:
        series, steps, quarters = sim.record.after(self._start), diary.page("steps"), diary.page("quarters")
        phase = np.arange(1, SAMPLES + 1) / SAMPLES
        seen = (steps["time"] - self._start) / self._period
        force, when = series.force(), (series.time - 0.5 * series.step - self._start) / self._period
        torques = np.column_stack([np.interp(phase, seen, column) for column in steps["torque"].T])
        shown = self._view.dataset(quarters, "instant")
        data = xr.Dataset(
            {
                "thrust": ("phase", np.interp(phase, when, -force[:, 0]), {"units": "N/m"}),
                "aside": ("phase", np.interp(phase, when, force[:, 1]), {"units": "N/m"}),
                "power": ("phase", np.interp(phase, when, series.column("power")), {"units": "W/m"}),
                "joint_torque": (("phase", "joint"), torques, {"units": "N m/m"}),
                "difference": ("phase", np.interp(phase, seen, steps["difference"]), {"units": "Pa"}),
                "bend": ("phase", np.interp(phase, seen, steps["bend"]), {"units": "rad"}),
                "place": ("phase", np.interp(phase, seen, steps["place"]), {"units": "1"}),
                "sides": (("instant", "side", "tail"), quarters["sides"], {"units": "Pa"}),
                "noise": ((), _noise(series, self._period), {"units": "1"}),
                "thin": ((), sim.thin["body"], {"units": "1"}),
            },
            coords={
                "phase": phase,
                "instant": list(QUARTERS),
                "side": ["left", "right"],
                "tail": ("tail", np.linspace(0.0, 1.0, _TAIL), {"units": "1"}),
                "joint": [*YAWS, "tail_yaw_1"],
            },
        )
        return data.merge(shown)


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


def _root(outline: Outline) -> float:
    """Return where the tail begins, from the snout [m]."""
    return outline.robot.length - outline.robot.tail.length + outline.robot.tail.offset


def tail_sides(outline: Outline, surface: flow.Surface) -> np.ndarray:
    """Return the pressure on the robot's left and right of its tail, from root to tip, shape (2, place) [Pa]."""
    m = surface.markers
    places = np.linspace(_root(outline), outline.robot.length, _TAIL)
    out = np.empty((2, _TAIL))
    for row, side in enumerate((-1.0, 1.0)):  # the midline runs to the tail: its left is the robot's right
        some = np.flatnonzero(m.side == side)
        order = some[np.argsort(m.station[some])]
        out[row] = np.interp(places, m.station[order], surface.pressure[order])
    return out


def _place(sides: np.ndarray) -> float:
    """Return where the pressure difference sits, root 0 to tip 1: the mean place, weighted with the difference [-]."""
    weight = np.abs(sides[1] - sides[0])
    total = float(weight.sum())
    return float(weight @ np.linspace(0.0, 1.0, _TAIL)) / total if total > 0 else 0.5


def _bend(outline: Outline, midline: flow.Spine) -> float:
    """Return how far the tail bends from its root to its tip, to the robot's right [rad]."""
    return float(midline.heading[-1] - np.interp(_root(outline), outline.s, midline.heading))


def _difference(outline: Outline, surface: flow.Surface, midline: flow.Spine) -> float:
    """Return the mean pressure along the convex side of the tail less that along the concave side [Pa]."""
    m, root = surface.markers, _root(outline)
    means = []
    for side in (1.0, -1.0):
        part = (m.side == side) & (m.station > root)
        means.append(float(np.average(surface.pressure[part], weights=m.length[part])))
    return (means[1] - means[0]) * float(
        np.sign(_bend(outline, midline))
    )  # what bends to the right is convex on the left


def towed(robot: Crocodile, speed: float, setting: Tether, *, lengths: float = 4.0) -> float:
    """Return the drag of the straight body in a stream, its mean over the last length of the way [N/m].

    Args:
        robot: whose body.
        speed: of the stream, which grows over the first half length [m/s].
        setting: grid and water; its cycles do not matter.
        lengths: way of the stream [body length].

    Raises:
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow came apart.
    """
    length = robot.length
    outline = Outline(robot, setting.cells + 1)
    still = Swim(name="still", frequency=1.0, yaw=(0, 0, 0), yaw_late=(0, 0, 0), tail=0.0, tail_late=0.0)
    over = 0.5 * length / abs(speed)

    def stream(time: float) -> tuple[float, float]:
        part = min(time / over, 1.0)
        return speed * part * part * (3 - 2 * part), 0.0

    body = flow.Body(shape=replace(immersed(outline, still, least=setting.least(length)), deforms=False))
    grid = setting.grid(length, _BOX)
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=setting.viscosity, density=DENSITY, bodies=(body,), stream=stream)
    )
    series = sim.run(lengths * length / abs(speed), progress=False).after((lengths - 1.0) * length / abs(speed))
    return float(np.average(series.force()[:, 0], weights=series.step))
