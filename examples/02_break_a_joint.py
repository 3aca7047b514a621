"""Break joints while the robot walks, and see what the spine is worth.

Faults are values on a run; a whole batch of runs is simulated at once.

Usage: python examples/02_break_a_joint.py
"""

from math import degrees

import suchus
from suchus.sim.metrics import displacement, heading_change

robot, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
faults = {
    "intact": (),
    "left front yaw limp": (suchus.Limp("LF_yaw"),),
    "left front yaw limp from 5 s on": (suchus.Limp("LF_yaw", at=5.0),),
    "both hind pitch joints locked": (suchus.Locked("LH_pitch"), suchus.Locked("RH_pitch")),
    "middle spine joint at half torque": (suchus.Weak("spine_yaw_2", 0.5),),
}
record = suchus.simulate([suchus.Run(robot=robot, gait=gait, faults=broken) for broken in faults.values()])
for name, forward, turned in zip(
    faults, displacement(record).sel(xyz="x").values, heading_change(record).values, strict=True
):
    print(f"{name:34s} {forward:+.2f} m forward, turned by {degrees(turned):+.0f} degrees")
