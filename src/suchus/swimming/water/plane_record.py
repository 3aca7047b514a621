"""Samples and record of a slice through the robot: tethered at its snout, as in Fig. 17, or free.

The record of a tethered slice also has the loads along the skin: pressures on both sides of the tail, and moments about
the joints.
"""

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus import flow
from suchus.robot.design import GRAVITY
from suchus.swimming.water.field_samples import FieldWindow, course, midline, midline_values, sample_course
from suchus.swimming.water.measures import swing
from suchus.swimming.water.outline import Outline
from suchus.swimming.water.samples import Samples
from suchus.swimming.water.setting import DENSITY
from suchus.swimming.water.slender import cycle
from suchus.swimming.water.swim_setup import PHASES, SLACK, ResolvedSwim, cycle_means
from suchus.swimming.water.swimming import wave_speed

QUARTERS = (0.25, 0.5, 0.75, 1.0)
"""Instants of the measured cycle at which the article shows the pressure [cycle]."""
PLACES = 33
"""Places along the tail at which the pressures of its two sides are kept [-]."""


class TetheredSlice:
    """Forces, loads along the skin and fields of a slice with a prescribed motion."""

    def __init__(self, swim: ResolvedSwim) -> None:
        self._outline, self._view = swim.outline, FieldWindow(swim.setup.grid, swim.robot.length, 1.9, 0.6)
        self._start, self._period, self._cycles = swim.end - swim.period, swim.period, swim.setting.cycles
        self._first_cycle = min(1, self._cycles - 1)

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Store the samples that are due after a step."""
        phase = (sim.time - self._start) / self._period
        turn = sim.time / self._period > self._first_cycle + 0.25 * (samples.count("turns") + 1) - SLACK
        if phase <= SLACK and not turn:
            return
        surface = sim.surface()
        midline = sim.setup.bodies[0].shape.spine(sim.time)  # type: ignore[attr-defined]
        sides = tail_sides(self._outline, surface)
        readings = {
            "difference": convex_less_concave(self._outline, surface, midline),
            "place": place_of_difference(sides),
        }
        if turn:
            samples.add("turns", sim.time, **readings)
        if phase <= SLACK:
            return
        samples.add(
            "steps",
            sim.time,
            **readings,
            bend=bend(self._outline, midline),
            torque=joint_torques(self._outline, surface, midline),
            servo=servo_torques(self._outline, surface, midline),
        )
        if phase > 0.25 * (samples.count("quarters") + 1) - SLACK:
            fields = self._view.fields(sim)
            samples.add("quarters", sim.time, sides=sides, **fields, **midline_values(midline))

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record of the samples at equal phases, with the means of every cycle."""
        lateral = self._outline.servos
        series, steps, quarters = (
            sim.record.select_after(self._start),
            samples.series("steps"),
            samples.series("quarters"),
        )
        phase = np.arange(1, PHASES + 1) / PHASES
        sample_phase = (steps["time"] - self._start) / self._period
        force, step_phase = series.force(), (series.time - 0.5 * series.step - self._start) / self._period
        torques, servos = (
            np.column_stack([np.interp(phase, sample_phase, column) for column in steps[name].T])
            for name in ("torque", "servo")
        )
        fields_record = self._view.dataset(quarters, "instant")
        axial_force, power = cycle_means(sim.record, self._period, self._cycles, ("force_x", "power"))
        data = xr.Dataset(
            {
                "cycle_thrust": ("cycle", -axial_force, {"units": "N/m"}),
                "cycle_power": ("cycle", power, {"units": "W/m"}),
                "thrust": ("phase", np.interp(phase, step_phase, -force[:, 0]), {"units": "N/m"}),
                "aside": ("phase", np.interp(phase, step_phase, force[:, 1]), {"units": "N/m"}),
                "power": ("phase", np.interp(phase, step_phase, series.column("power")), {"units": "W/m"}),
                "joint_torque": (("phase", "joint"), torques, {"units": "N m/m"}),
                "servo_torque": (("phase", "servo"), servos, {"units": "N m"}),
                "difference": ("phase", np.interp(phase, sample_phase, steps["difference"]), {"units": "Pa"}),
                "bend": ("phase", np.interp(phase, sample_phase, steps["bend"]), {"units": "rad"}),
                "place": ("phase", np.interp(phase, sample_phase, steps["place"]), {"units": "1"}),
                "sides": (("instant", "side", "tail"), quarters["sides"], {"units": "Pa"}),
                "noise": ((), _noise(series, self._period), {"units": "1"}),
                "thin": ((), sim.thin_fractions[sim.setup.bodies[0].name], {"units": "1"}),
            },
            coords={
                "phase": phase,
                "instant": list(QUARTERS),
                "side": ["left", "right"],
                "tail": ("tail", np.linspace(0.0, 1.0, PLACES), {"units": "1"}),
                "joint": [self._outline.joints[servo.joints[0]] for servo in lateral],
                "servo": [servo.name for servo in lateral],
            },
        )
        return data.merge(fields_record).merge(self._turns(sim.record, samples))

    def _turns(self, series: flow.Record, samples: Samples) -> xr.Dataset:
        """Return the loads at the four quarters of every cycle but the first, see ``measures.Quarters``."""
        turn_samples, shape = samples.series("turns"), (self._cycles - self._first_cycle, len(QUARTERS))
        step_times, force = series.time - 0.5 * series.step, series.force()
        quantities = {
            "difference": (turn_samples["difference"], "Pa"),
            "place": (turn_samples["place"], "1"),
            "thrust": (np.interp(turn_samples["time"], step_times, -force[:, 0]), "N/m"),
            "aside": (np.interp(turn_samples["time"], step_times, force[:, 1]), "N/m"),
        }
        dims = ("settled", "instant")
        data = {
            f"quarter_{name}": (dims, values.reshape(shape), {"units": unit})
            for name, (values, unit) in quantities.items()
        }
        return xr.Dataset(data, coords={"settled": np.arange(self._first_cycle, self._cycles) + 1})


def _noise(series: flow.Record, period: float) -> float:
    """Return the noise of the force along the body; not a number where the series is too short or constant [-]."""
    force = series.force()[:, 0]
    window = max(period / 12, 10 * float(series.step.mean()))  # enough steps for a cubic
    if series.time[-1] - series.time[0] < 2 * window or np.ptp(force) == 0.0:
        return float("nan")
    return flow.noise(series.time, force, window=window)


class FreeSlice:
    """Track, speed and fields of a free slice."""

    def __init__(self, swim: ResolvedSwim) -> None:
        self._swim, self._view = swim, FieldWindow(swim.setup.grid, swim.robot.length, 2.25, 0.6)
        self._end, self._period, self._frames = swim.end, swim.period, swim.setting.frames

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Store the samples that are due after a step."""
        sample_course(sim, samples)
        remaining_cycles = (self._end - sim.time) / self._period
        if remaining_cycles > 2.0 + SLACK:
            return
        spine, (position, _) = midline(sim), sim.frame
        snout = np.array([spine.x[0] + position[0], spine.heading[0]])
        samples.add("track", sim.time, snout=snout, across=spine.y + position[1])
        count = samples.count("frames")
        if count < self._frames and remaining_cycles < 1.0 - (count + 1) / self._frames + SLACK:
            fields = self._view.fields(sim)
            samples.add(
                "frames", sim.time, **{n: fields[n] for n in ("vorticity", "pressure")}, **midline_values(spine)
            )

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record of the samples at equal phases, with the means of every cycle."""
        period, outline, motion = self._period, self._swim.outline, self._swim.motion
        speed, power = cycle_means(sim.record, period, self._swim.setting.cycles, ("velocity_x", "power"))
        track = samples.series("track")
        times = self._end + period * (np.arange(2 * PHASES + 1) / PHASES - 2.0)
        snout, lateral = (
            np.column_stack([np.interp(times, track["time"], column) for column in track[name].T])
            for name in ("snout", "across")
        )
        data = xr.Dataset(
            {
                "speed": ("cycle", -speed, {"units": "m/s"}),
                "power": ("cycle", power, {"units": "W/m"}),
                "snout_x": ("sample", snout[:, 0], {"units": "m"}),
                "snout_y": ("sample", lateral[:, 0], {"units": "m"}),
                "heading": ("sample", snout[:, 1], {"units": "rad"}),
                "tail_y": ("sample", lateral[:, -1], {"units": "m"}),
                "swing": ("station", swing(lateral).amplitude, {"units": "m"}),
                "weight": ((), DENSITY * GRAVITY * sim.setup.bodies[0].shape.mass(sim.time).volume, {"units": "N/m"}),
                "wave_speed": ((), wave_speed(outline, motion, cycle(outline, motion)), {"units": "m/s"}),
                "thin": ((), sim.thin_fractions[sim.setup.bodies[0].name], {"units": "1"}),
            }
        )
        data = data.merge(course(sim, samples, period, self._swim.setting.cycles))
        if self._frames == 0:
            return data
        frames = samples.series("frames")
        frames_record = self._view.dataset(frames, "frame")
        phase = (frames["time"] - self._end) / period + 1.0
        return data.merge(frames_record.assign_coords(frame=("frame", phase, {"units": "1"})))


def joint_torques(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> Float[np.ndarray, " servo"]:
    """Return the water's moment about the first joint of each lateral servo, of the load beyond it [N m/m].

    Beyond means towards the snout for a joint ahead of the root, towards the tip for one behind it.

    Args:
        outline: outline of the robot.
        surface: pressure and friction along the skin.
        midline: where the joints are now.
    """
    first_joints = [servo.joints[0] for servo in outline.servos]
    return _moments(outline, surface, midline, np.ones(surface.markers.station.size))[first_joints]


def servo_torques(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> Float[np.ndarray, " servo"]:
    """Return the torque of the water at the shaft of each lateral servo; see ``Outline.servo_torques`` [N m].

    Every section has the height of the robot and the pressure of the flow in the plane. Real water also flows over and
    under the body, and requires less torque.

    Args:
        outline: outline of the robot.
        surface: pressure and friction along the skin.
        midline: where the joints are now.
    """
    height = 2.0 * np.interp(surface.markers.station, outline.s, outline.silhouette.half_height)
    return outline.servo_torques(_moments(outline, surface, midline, height))


def _moments(
    outline: Outline, surface: flow.Surface, midline: flow.MidlineState, height: np.ndarray
) -> Float[np.ndarray, " joint"]:
    """Return the moment about each joint of the water's load beyond it."""
    m = surface.markers
    fx, fy = surface.traction * m.weight * height
    moments = []
    for i, place in enumerate(outline.joint_positions):
        x, y = np.interp(place, outline.s, midline.x), np.interp(place, outline.s, midline.y)
        is_beyond = m.station < place if i < outline.joint_count_ahead else m.station > place
        moments.append(float(np.sum(((m.x - x) * fy - (m.y - y) * fx)[is_beyond])))
    return np.array(moments)


def tail_sides(outline: Outline, surface: flow.Surface) -> Float[np.ndarray, "2 place"]:
    """Return the pressure on the robot's left and right of its tail, from root to tip [Pa]."""
    m = surface.markers
    places = np.linspace(outline.tail_root, outline.robot.length, PLACES)
    pressures = np.empty((2, PLACES))
    for row, side in enumerate((-1.0, 1.0)):  # the midline runs to the tail: its left is the robot's right
        side_markers = np.flatnonzero(m.side == side)
        order = side_markers[np.argsort(m.station[side_markers])]
        pressures[row] = np.interp(places, m.station[order], surface.pressure[order])
    return pressures


def convex_less_concave(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> float:
    """Return the mean pressure on the convex side of the tail minus that on the concave side [Pa]."""
    m, start = surface.markers, outline.tail_root
    means = []
    for side in (1.0, -1.0):
        is_on_side = (m.side == side) & (m.station > start)
        means.append(float(np.average(surface.pressure[is_on_side], weights=m.weight[is_on_side])))
    # what bends to the right is convex on the left
    return (means[1] - means[0]) * float(np.sign(bend(outline, midline)))


def place_of_difference(sides: Float[np.ndarray, "2 place"]) -> float:
    """Return the mean position of the pressure difference, weighted by it; root 0, tip 1 [-]."""
    weight = np.abs(sides[1] - sides[0])
    total = float(weight.sum())
    return float(weight @ np.linspace(0.0, 1.0, sides.shape[1])) / total if total > 0 else 0.5


def bend(outline: Outline, midline: flow.MidlineState) -> float:
    """Return the bend of the tail from root to tip, positive to the robot's right [rad]."""
    return float(midline.heading[-1] - np.interp(outline.tail_root, outline.s, midline.heading))
