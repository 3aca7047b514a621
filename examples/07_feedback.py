"""Let the robot feel: limbs that find their gait, and a limp leg that no longer makes it walk in circles.

A controller is a value on a run, like a fault. ``Coordinated`` is the closed loop: limbs, spine and tail each follow
a rule of their own and share phases, bends and directions. The heading loop on the IMU is added by name.

Usage: python examples/07_feedback.py
"""

from dataclasses import replace
from math import degrees

import suchus
from suchus.robot.control import LAWS
from suchus.sim.metrics import displacement, heading_change

robot, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
closed = suchus.Coordinated()
steered = replace(closed, heading=suchus.HeadingRule())
nothing = suchus.Coordinated(limbs=LAWS["off"], spine=None, tail=None)

for name, control in {"open loop": nothing, "closed loop": closed}.items():
    crawl = suchus.crawl(robot, gait, control=replace(control, random_start=True), duration=13.0, timestep=0.005)
    print(f"random limb phases, {name:13s} {float(displacement(crawl).sel(xyz='x')):+.2f} m in three cycles")

limp = (suchus.Limp("LF_yaw", at=5.0),)
for name, control in {"open loop": nothing, "closed loop": closed, "heading loop": steered}.items():
    crawl = suchus.crawl(robot, gait, control=control, faults=limp, duration=33.0, timestep=0.005)
    forward, turned = float(displacement(crawl, start=5.0).sel(xyz="x")), float(heading_change(crawl, start=5.0))
    print(f"left front yaw limp, {name:13s} {forward:+.2f} m in seven cycles, turned by {degrees(turned):+.0f} degrees")
