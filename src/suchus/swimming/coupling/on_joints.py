"""A robot's swim in space on its own joints, recorded as ``water.resolved`` records one along a commanded midline."""

from itertools import pairwise
from math import ceil
from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.core.progress import Progress
from suchus.robot.control import Swimming
from suchus.robot.design import GRAVITY, Robot, with_values
from suchus.robot.design.flotation import float_hull
from suchus.robot.design.scale import control_period
from suchus.robot.motion import LIMBS_BACK, Gait, with_limbs
from suchus.sim.land.afloat import floats
from suchus.sim.land.run import Run
from suchus.sim.land.waters import Space
from suchus.swimming.coupling.swim import Swim, check_swim
from suchus.swimming.water.samples import Samples
from suchus.swimming.water.setting import GROWS, SwimSetting
from suchus.swimming.water.space_record import FreeInSpace
from suchus.swimming.water.swim_setup import ResolvedSwim


def floating(robot: Robot) -> Robot:
    """Return a robot that floats: the same robot if it does, otherwise with the foam that carries it."""
    if floats(robot):
        return robot
    hull_free_robot = with_values(robot, {"hull": None})
    return with_values(hull_free_robot, {"hull": float_hull(hull_free_robot)})


def _run(robot: Robot, gait: Gait, setting: SwimSetting) -> Run:
    """Return the run of the swim."""
    reynolds = robot.length**2 / (gait.period * setting.viscosity)
    water = Space(
        cells=setting.cells, reynolds=reynolds, tail_height=setting.tail_height, limbs=setting.limbs,
        beside=setting.beside,
    )  # fmt: skip
    return Run(
        robot=floating(robot), gait=with_limbs(robot, gait, LIMBS_BACK), water=water,
        control=Swimming(ramp=GROWS * gait.period),
    )  # fmt: skip


def check_on_joints(robot: Robot, gait: Gait, setting: SwimSetting) -> None:
    """Refuse a robot or a motion that ``swim_on_joints`` cannot simulate, before anything runs.

    Raises:
        InvalidDesign, OutsideLimits: see ``Swim``.
    """
    check_swim(_run(robot, gait, setting), setting.cycles * gait.period)


def swim_on_joints(
    robot: Robot,
    gait: Gait,
    setting: SwimSetting,
    *,
    checkpoint: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return a swim in space of a robot whose servos, springs and cables are solved together with the water.

    It begins at rest and its motion grows over the first half cycle. The robot has its own mass, with foam if it would
    sink without; a raised tail weighs nothing.

    Args:
        robot: robot that swims.
        gait: what its servos are commanded; limbs are held back.
        setting: grid, water and time, of a free body in space.
        checkpoint: file that robot and water are kept in; if it exists, the swim goes on from there.
        progress: told the share that is done; None shows a progress bar.

    Returns:
        What ``water.resolved`` records of a free body in space, but ``joint_torque`` and ``servo_torque`` are those of
        the record of the robot, and ``weight`` is the robot's; further ``servo_power`` per cycle, ``tail_spread``, the
        largest amplitude of a cable's joint over their mean (NaN without a cable), and over all but the first cycle the
        greatest ``coupling_residual``, at the end ``energy_error`` and ``power_error``; see ``record.COUPLED``.
        ``servo_torque`` has readings at instants, whose power is up to a third below ``servo_power``, the mean of all
        physics steps.

    Raises:
        InvalidDesign, OutsideLimits, Diverged, UnreadableFile, Unwritable: see ``Swim`` and ``Swim.go``.
    """
    run = _run(robot, gait, setting)
    tick = control_period(run.robot)
    swim = Swim(run, tick * ceil(setting.cycles * gait.period / tick - 1e-6))
    observer = _OnJoints(swim, ResolvedSwim(robot=robot, motion=gait, setting=setting))
    swim.go(
        swim.ticks * swim.stepper.period, progress=progress, checkpoint=checkpoint,
        watch=lambda swim: observer.sample(swim.sim, swim.samples),
    )  # fmt: skip
    return observer.record(swim.sim, swim.samples)


class _OnJoints(FreeInSpace):
    """The record of a body in space whose joints are those of a robot."""

    def __init__(self, swim: Swim, commanded: ResolvedSwim) -> None:
        super().__init__(commanded)
        self._coupled_swim, self._commanded = swim, commanded

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record of the flow, with the power of the servos and the errors of the coupling."""
        flow_record, robot = super().record(sim, samples), self._coupled_swim.run.robot
        record, period, cycles = (
            self._coupled_swim.record().isel(run=0),
            self._commanded.period,
            flow_record.sizes["cycle"],
        )
        bounds = [round(cycle * period / self._coupled_swim.stepper.period) for cycle in range(cycles + 1)]
        power = [float(record.servo_power[a + 1 : b + 1].sum("servo").mean()) for a, b in pairwise(bounds)]
        settled_record = record.isel(time=slice(bounds[1], None))
        cable = [name for robot_cable in robot.cables for name in robot_cable.hinges]
        half = np.ptp(record.joint_angle.isel(time=slice(bounds[-2], None)).sel(joint=cable).values, axis=0) / 2
        return flow_record.assign(
            servo_power=("cycle", power, {"units": "W"}),
            tail_spread=((), float(half.max() / half.mean()) if half.size else np.nan, {"units": "1"}),
            coupling_residual=((), float(settled_record.coupling_residual.max()), {"units": "1"}),
            energy_error=((), float(abs(record.energy_error[-1])), {"units": "1"}),
            power_error=((), float(abs(record.power_error[-1])), {"units": "1"}),
        )

    def _loads(self, sim: flow.Simulation) -> xr.Dataset:
        """Return the torques of the water at the joints, the servo torques, and the weight, in the last cycle."""
        del sim
        record, outline = self._coupled_swim.record().isel(run=0), self._commanded.outline
        samples = round(self._commanded.period / self._coupled_swim.stepper.period)
        last_cycle = record.isel(time=slice(-samples, None))
        servos = [servo.name for servo in outline.servos]
        return xr.Dataset(
            {
                "moment": ("moment", last_cycle.time.values, {"units": "s"}),
                "joint_torque": (
                    ("moment", "joint"),
                    last_cycle.joint_water_torque.sel(joint=list(outline.joints)).transpose("time", "joint").values,
                    {"units": "N m"},
                ),
                "servo_torque": (
                    ("moment", "servo"),
                    last_cycle.servo_torque.sel(servo=servos).transpose("time", "servo").values,
                    {"units": "N m"},
                ),
                "weight": ((), GRAVITY * self._coupled_swim.run.robot.mass, {"units": "N"}),
            }
        )
