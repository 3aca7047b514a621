"""Fast physics against full physics: how far robots get with either, and the processor time of both.

Run as ``python bench/fast_physics.py``. Fast is ``simulate(..., fast=True)``, with the coarse time step that a training
uses, and with the longest one, a control period, that an environment with ``fast=True`` uses. Full has the robot's own
step.
"""

import time

from suchus import ROBOTS, Run, simulate
from suchus.robot.design.scale import coarse_step, control_period, physics_step
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.sim.metrics import displacement, heading_change

WALKS = (("caiman", "belly_crawl"), ("caiman", "low_crawl"), ("caiman", "semi_erect"), ("strider", "tripod"))
CYCLES = 2.0


def main() -> None:
    """Print a line for each walk."""
    print("robot    gait         step [ms]  full [m]  fast [m]  difference  turned full, fast [rad]  time full/fast")
    for robot_name, gait_name in WALKS:
        robot, gait = ROBOTS[robot_name], GAITS[gait_name]
        run = Run(robot=robot, gait=gait)
        results = []
        for step, fast in ((physics_step(robot), False), (coarse_step(robot), True), (control_period(robot), True)):
            begin = time.process_time()
            record = simulate(
                [run], duration=START + CYCLES * gait.period, timestep=step, effort=False, fast=fast, sample_stride=5
            )
            forward = float(displacement(record).sel(xyz="x").values[0])
            turned = float(heading_change(record).values[0])
            results.append((step, forward, turned, time.process_time() - begin))
        _, full, full_turn, full_time = results[0]
        for step, quick, quick_turn, quick_time in results[1:]:
            print(
                f"{robot_name:<8} {gait_name:<12} {1e3 * step:9.1f} {full:9.3f}  "
                f"{quick:8.3f}  {quick / full - 1:+9.1%}  "
                f"{full_turn:+10.3f} {quick_turn:+10.3f}  {full_time / quick_time:10.1f}"
            )


if __name__ == "__main__":
    main()
