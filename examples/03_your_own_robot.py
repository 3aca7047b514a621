"""Change the robot and the gait: frozen values, varied with design.with_values.

Here: how far does the crawl get with weaker trunk servos, and with a longer tail?

Usage: python examples/03_your_own_robot.py
"""

import suchus
from suchus.robot.design import with_values
from suchus.sim.metrics import displacement

caiman, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
weak = with_values(caiman, {"name": "weak", "spine.yaw_servo.torque": 1.0})
tailed = with_values(caiman, {"name": "tailed", "tail.fin_length": 0.25})
for robot in (caiman, weak, tailed):
    forward = float(displacement(suchus.crawl(robot, gait)).sel(xyz="x"))
    print(f"{robot.name:8s} {robot.length:.2f} m long, {robot.mass:.2f} kg: {forward:.2f} m")
try:
    with_values(caiman, {"hind_leg.tibia": -0.08})
except suchus.InvalidDesign as error:
    print("refused:", error)
