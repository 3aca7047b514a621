"""Samples and record of the robot's body in space: free, or with a prescribed motion."""

from itertools import pairwise

import numpy as np
import xarray as xr

from suchus import flow
from suchus.robot.design import GRAVITY
from suchus.swimming.water.field_samples import VortexSampler, course, midline, sample_course, wake
from suchus.swimming.water.plane_record import QUARTERS, bend
from suchus.swimming.water.samples import Samples
from suchus.swimming.water.setting import DENSITY
from suchus.swimming.water.slender import cycle
from suchus.swimming.water.swim_setup import PHASES, SLACK, ResolvedSwim, cycle_means
from suchus.swimming.water.swimming import wave_speed

_PER_CYCLE = {"velocity_x": ("speed", "m/s"), "force_x": ("thrust", "N"), "power": ("power", "W")}


class FreeInSpace:
    """Speed, moments at the joints, wake and vortices of a free body."""

    def __init__(self, swim: ResolvedSwim) -> None:
        self._swim, self._end, self._period = swim, swim.end, swim.period
        self._film = VortexSampler(swim.motion.frequency, swim.end, swim.setting.frames)

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Sample what is due after a step."""
        self._film.sample(sim, samples)
        sample_course(sim, samples)
        if self._end - sim.time > self._period * (1.0 + SLACK):
            return
        spine, (position, _) = midline(sim), sim.frame
        samples.add("track", sim.time, heading=spine.heading[0], tail=spine.y[-1] + position[1])

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record of the samples at equal phases, with the means of every cycle."""
        period, cycles, series = self._swim.period, self._swim.setting.cycles, sim.record
        outline, motion, robot = self._swim.outline, self._swim.motion, self._swim.robot
        servos = [servo.name for servo in outline.servos]
        means = dict(zip(_PER_CYCLE, cycle_means(series, period, cycles, tuple(_PER_CYCLE)), strict=True))
        track, last_cycle = samples.series("track"), series.select_after((cycles - 1) * period * (1.0 + SLACK))
        sign = {"velocity_x": -1.0, "force_x": -1.0, "power": 1.0}  # the body swims towards -x
        data = xr.Dataset(
            {
                name: ("cycle", sign[column] * means[column], {"units": unit})
                for column, (name, unit) in _PER_CYCLE.items()
            }
        )
        data = data.assign(
            servo_limit=("servo", [robot.servo(name).torque for name in servos], {"units": "N m"}),
            swing=((), float(np.ptp(track["tail"])), {"units": "m", "long_name": "of the tail's tip, peak to peak"}),
            head_yaw=((), 0.5 * float(np.ptp(track["heading"])), {"units": "rad"}),
            wave_speed=((), wave_speed(outline, motion, cycle(outline, motion)), {"units": "m/s"}),
            thin=((), sim.thin_fractions[sim.setup.bodies[0].name], {"units": "1"}),
            steps=((), float(len(last_cycle.time)), {"units": "1", "long_name": "in the last cycle"}),
            million_cells=((), float(np.prod(sim.setup.grid.cells)) / 1e6, {"units": "1"}),
            joint_place=("joint", outline.joint_positions, {"units": "m"}),
        )
        data = data.assign_coords(servo=servos, cycle=np.arange(1, cycles + 1)).merge(self._loads(sim)).merge(wake(sim))
        return data.merge(self._film.record(samples)).merge(course(sim, samples, period, cycles))

    def _loads(self, sim: flow.Simulation) -> xr.Dataset:
        """Return the torques of the last cycle at joints and servos, and the weight."""
        outline, setting = self._swim.outline, self._swim.setting
        last_cycle = sim.record.select_after((setting.cycles - 1) * self._swim.period * (1.0 + SLACK))
        torques = last_cycle.part_series("torque_behind")[:, 1 + np.argsort(np.argsort(outline.joint_positions))]
        return xr.Dataset(
            {
                "moment": ("moment", last_cycle.time, {"units": "s"}),
                "joint_torque": (("moment", "joint"), torques, {"units": "N m"}),
                "servo_torque": (("moment", "servo"), outline.servo_torques(torques), {"units": "N m"}),
                "weight": ((), DENSITY * GRAVITY * sim.setup.bodies[0].shape.mass(sim.time).volume, {"units": "N"}),
            }
        )


class TetheredInSpace:
    """Forces on a body with a prescribed motion, from the record of the flow."""

    def __init__(self, swim: ResolvedSwim) -> None:
        self._swim = swim

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Sample nothing."""

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record at equal phases, with the means of every cycle."""
        del samples
        period, cycles, (sway, turn) = self._swim.period, self._swim.setting.cycles, self._swim.head
        axial_force, power = cycle_means(sim.record, period, cycles, ("force_x", "power"))
        phase = np.arange(1, PHASES + 1) / PHASES
        step_phase, force = (
            (sim.record.time - 0.5 * sim.record.step - self._swim.end + period) / period,
            sim.record.force(),
        )
        series = {
            "thrust": (-force[:, 0], "N"),
            "aside": (force[:, 1], "N"),
            "power": (sim.record.column("power"), "W"),
        }
        data = {
            name: ("phase", np.interp(phase, step_phase, values), {"units": unit})
            for name, (values, unit) in series.items()
        }
        data |= {
            "cycle_thrust": ("cycle", -axial_force, {"units": "N"}),
            "cycle_power": ("cycle", power, {"units": "W"}),
            "sway": ("part", [sway.real, -sway.imag], {"units": "m"}),
            "turn": ("part", [turn.real, -turn.imag], {"units": "rad"}),
        }
        dataset = xr.Dataset(
            data, coords={"part": ["cosine", "sine"], "phase": phase, "cycle": np.arange(1, cycles + 1)}
        )
        return dataset.merge(self._turns(sim))

    def _turns(self, sim: flow.Simulation) -> xr.Dataset:
        """Return the loads at the four quarters of every cycle but the first, as for a slice; see ``_push``."""
        swim, series = self._swim, sim.record
        first_cycle = min(1, swim.setting.cycles - 1)
        count = swim.setting.cycles - first_cycle
        turns = swim.period * (first_cycle + (np.arange(4 * count) + 1.0) / 4.0)
        step_times, force = series.time - 0.5 * series.step, series.force()
        quantities = {
            "thrust": (np.interp(turns, step_times, -force[:, 0]), "N"),
            "aside": (np.interp(turns, step_times, force[:, 1]), "N"),
        }
        if swim.outline.joint_positions.size:  # else it is not divided
            parts = np.stack([series.part_series("force_x"), series.part_series("force_y")])
            part_forces = np.array(
                [[np.interp(turns, step_times, part_force) for part_force in axis.T] for axis in parts]
            )
            pushes = [self._push(sim, float(time), part_forces[:, :, i]) for i, time in enumerate(turns)]
            quantities["difference"] = np.array(pushes), "Pa"
        data = {
            f"quarter_{name}": (("settled", "instant"), values.reshape(count, 4), {"units": unit})
            for name, (values, unit) in quantities.items()
        }
        coords = {"instant": list(QUARTERS), "settled": np.arange(first_cycle, swim.setting.cycles) + 1}
        return xr.Dataset(data, coords=coords)

    def _push(self, sim: flow.Simulation, time: float, force: np.ndarray) -> float:
        """Return the lateral force on the tail from convex to concave side, over the side area of the tail [Pa].

        It replaces the pressure difference, because no grid resolves the pressure along the skin of a round tail.

        Args:
            sim: simulation at its end.
            time: time [s].
            force: force on each part, shape (axis, part) [N].
        """
        outline = self._swim.outline
        spine = sim.setup.bodies[0].shape.spine(time)  # type: ignore[attr-defined]
        normals = np.stack([-np.sin(spine.heading), np.cos(spine.heading)])
        edges = np.array([0.0, *np.sort(outline.joint_positions), outline.robot.length])
        push = 0.0
        for part_index, (front, rear) in enumerate(pairwise(edges)):
            if 0.5 * (front + rear) > outline.tail_root:
                is_in_part = (outline.s >= front) & (outline.s <= rear)
                push += float(force[:, part_index] @ normals[:, is_in_part].mean(axis=1))
        tail = outline.s >= outline.tail_root
        side = float(np.trapezoid(2.0 * outline.silhouette.half_height[tail], outline.s[tail]))
        return push / side * float(np.sign(bend(outline, spine)))
