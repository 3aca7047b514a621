"""Does a salamander's own walk, played joint by joint on its model, walk as the animal does?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper.walking_salamanders import ANIMAL
from suchus.core.checks import Checks
from suchus.core.errors import UnsuitedRobot
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.salamander.animal_walk import PAIRS, axis_wave_measures, comparison_table, steps
from suchus.experiments.catalog.salamander.animal_walk import window as measured_window
from suchus.experiments.catalog.salamander.figure import draw_angles, draw_feet
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    ends,
    silent,
    staged,
)
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate
from suchus.sim.metrics import displacement, heading_change
from suchus.sim.metrics.foot_forces import Window, displacement_per_cycle, stance_forces, weight

_WALK, _STRAIGHT = "the animal's angles", "axis held straight"


@dataclass(frozen=True, slots=True, kw_only=True)
class Salamander(Experiment):
    """The mean walking cycle of Pleurodeles waltl, played on the robot built after it; nothing is fitted.

    For comparison the same robot walks with its axis held straight, and on ground of other friction. Forces are
    measured at the instant of the greatest net force on a foot in the mean cycle, as in the animals' data.
    """

    title = "Does a salamander's own walk, played on its model, walk as the animal does?"
    shows = "Beyond the article: kinematics and foot forces of salamanders"
    answers = (
        "standing_index_walk",
        "stride_walk",
        "stride_straight_axis",
        "foot_force_peak_fore",
        "foot_force_peak_hind",
        "belly_share",
    )
    needs = ("salamander_joints",)
    judged_settings = ("robot", "gait", "loaded")
    judged_minima: ClassVar[Mapping[str, float]] = {"settle": 3, "cycles": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["salamander"])
    """The robot that walks; two pairs of limbs at least and a table of angles made for it are needed."""
    gait: Gait = field(default_factory=lambda: GAITS["animal_walk"])
    """The table of joint angles that is played."""
    settle: int = 3
    """Cycles that are walked before anything is measured [-]."""
    cycles: int = 8
    """Cycles that are measured [-]."""
    friction_scales: tuple[float, ...] = (0.7, 1.4)
    """Factors on the friction of the ground in further runs, for comparison [-]."""
    loaded: float = 0.15
    """Vertical force from which a foot stands [body weight]; hind feet trail with a tenth of the weight in swing."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        with Checks(self.name(), self) as check:
            check.whole("settle", 0, 1000)
            check.whole("cycles", 1, 1000)
            if self.friction_scales:
                check.rising("friction_scales", 0.05, 10.0, "")
            check.number("loaded", 0.001, 1.0, "body weight")

    def for_verdicts(self) -> "Salamander":
        """Return the same question without ground of other friction."""
        return replace(self, friction_scales=())

    def quick(self) -> "Salamander":
        """Return two cycles after the first one, on one further ground."""
        return replace(self, settle=1, cycles=2, friction_scales=(0.7,))

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Walk with the animal's angles, with a straight axis, and on other ground."""
        robot_layout = layout(self.robot)
        if len(robot_layout.robot.girdles) < 2:
            raise UnsuitedRobot(
                f"the animal's walk needs a robot with two pairs of limbs; robot {self.robot.name!r} has "
                f"{len(robot_layout.robot.girdles)}: choose another robot."
            )
        straight = self.gait.without("axis", name=f"{self.gait.name}, straight")
        runs = [
            Run(robot=self.robot, gait=self.gait, label=_WALK),
            Run(robot=self.robot, gait=straight, label=_STRAIGHT),
            *(
                Run(
                    robot=self.robot, gait=self.gait, ground=Ground(friction_scale=scale), label=f"friction x {scale:g}"
                )
                for scale in self.friction_scales
            ),
        ]
        duration = START + (self.settle + self.cycles) * self.gait.period
        record = simulate(runs, duration=duration, progress=staged(progress, "walks", 0.0, 1.0))
        last_girdle = robot_layout.limbs[-1].number
        record = record.assign_attrs(
            measured_from=START + self.settle * self.gait.period,
            cycles=self.cycles,
            length=float(self.robot.length),
            loaded=self.loaded,
            axis=[robot_layout.servos[i] for i in robot_layout.axial_yaw],
            fore=[limb.name for limb in robot_layout.limbs if limb.number == 0],
            hind=[limb.name for limb in robot_layout.limbs if limb.number == last_girdle],
        )
        tables = {"beside_the_animal.csv": comparison_table(self.measure(record))}
        return SimulationResult(record=record, tables=tables, replays=self._replays(record))

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the animal's walk, with the walk of the straight axis half transparent, by file name."""
        return replayed(
            "animal_walk_replay.html",
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=1),
            labels=(_WALK, _STRAIGHT),
            title="The walk of a salamander, played joint by joint",
            caption="Joint angles of a walking salamander on its model; half transparent, with the axis held straight.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return wave, stride, foot forces and slip of the walk, and what axis and friction change."""
        cycle_window, length = measured_window(record), float(record.attrs["length"])
        walk = record.isel(run=0)
        stride = [
            float(np.hypot(*displacement_per_cycle(record.isel(run=i), cycle_window))) / length
            for i in range(record.sizes["run"])
        ]
        turn_per_cycle = float(heading_change(walk, cycle_window.start, cycle_window.end)) / cycle_window.cycles
        body = _under_load(walk, cycle_window)
        return Measures(
            axis_wave_measures(walk, cycle_window),
            {
                "stride_walk": Measure(stride[0], "body length"),
                "stride_straight_axis": Measure(stride[1], "body length"),
                **(ends("stride", [stride[0], *stride[2:]], "body length") if len(stride) > 2 else {}),
                "turn_per_cycle": Measure(turn_per_cycle, "rad"),
                "way_forward": Measure(
                    float(displacement(walk, cycle_window.start, cycle_window.end).sel(xyz="x")), "m"
                ),
            },
            steps(walk, cycle_window, float(record.attrs["loaded"])),
            body,
        )

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return a comparison of wave and forces with the animal's, and the effect of the axis, in words."""
        return self.render_explanation(measures, animal=ANIMAL)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the joint angles over the cycle, and the foot forces beside the animal's."""
        record = outcome.record
        cycle_window, walk = measured_window(record), record.isel(run=0)
        force, stance_threshold = stance_forces(walk, cycle_window), float(record.attrs["loaded"])
        return {
            "joint_angles": draw_angles(walk, cycle_window),
            "foot_forces": draw_feet(
                force, {pair: list(record.attrs[pair]) for pair in PAIRS}, stance_threshold, ANIMAL
            ),
        }


def _under_load(record: xr.Dataset, cycle_window: Window) -> Measures:
    """Return the mean load on belly and tail over the weight, and the fraction of time with belly contact [-]."""
    excerpt = record.sel(time=slice(cycle_window.start - 1e-9, cycle_window.end + 1e-9))
    belly = excerpt.belly_force.sel(xyz="z").sum("segment")
    return Measures(
        {
            "belly_load": Measure(float(belly.mean()) / weight(record), "-"),
            "belly_share": Measure(float((belly > 0.0).mean()), "-"),
            "tail_load": Measure(float(excerpt.tail_force.sel(xyz="z").mean()) / weight(record), "-"),
        }
    )


experiment = Salamander()
