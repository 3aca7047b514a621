"""Leg, spine and tail in closed form: batches of points, no loop.

Usage: python examples/04_kinematics.py
"""

import numpy as np

import suchus
from suchus.robot.kinematics import leg, spine, tail

robot = suchus.ROBOTS["caiman"]
feet = np.array([0.156, 0.0, 0.089]) + np.random.default_rng(0).uniform(-0.02, 0.02, (100_000, 3))
angles = leg.inverse(robot.hind_leg, feet)
print(f"leg: {len(feet)} feet found again to {np.abs(leg.forward(robot.hind_leg, angles) - feet).max():.1e} m")
try:
    leg.inverse(robot.hind_leg, np.array([0.07, 0.0, 0.30]))
except suchus.Unreachable as error:
    print("leg:", error)
bent = spine.forward(robot.spine, np.radians([10.0, 0.0, 10.0, 0.0, 10.0]))
turned = np.degrees(np.arctan2(bent[1, 0], bent[0, 0]))
print(f"spine: joint 5 at {np.round(bent[:3, 3], 4)} m, head turned by {turned:.0f} degrees")
toward, away = tail.cable_changes(robot.tail, np.radians(90.0))
print(f"tail: 90 degrees of bend pull {-1000 * toward:.2f} mm of one cord and give {1000 * away:.2f} mm of the other")
