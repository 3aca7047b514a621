"""Let the article's robot walk on servos as they were identified: what changes, and what gains without chatter give.

Three robots: as it is in the catalog; with inertia and friction of an STS3215 at 7.4 V and the gains of the catalog;
and with gains from inertia, delay and control period. Torque and speed stay those of the catalog. Each crawls, walks
high and stands up. The figure is identified_servos.png.

Usage: python examples/22_identified_servos.py
"""

from dataclasses import replace

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import suchus
from suchus.robot.control import OpenLoop, Standing
from suchus.robot.design import layout, with_named_servos
from suchus.robot.motors.identified import identified_servo
from suchus.robot.motors.servo_parameters import servo_parameters
from suchus.sim.metrics import chatter, cost_of_transport, displacement, electrical_cost_of_transport
from suchus.sim.model.inverse import held_inertias

robot = suchus.ROBOTS["caiman"]
identified = identified_servo("STS3215 7.4 V, m1")
hinged = [name for name in layout(robot).servos if name in held_inertias(robot)]
inertias = held_inertias(robot)


def identified_robot(*, new_gains: bool) -> suchus.Robot:
    """Return the robot with identified servos, with the gains of the catalog or with new ones."""
    servos = {}
    for name in hinged:
        servo = robot.servo(name)
        changed = servo_parameters(identified, servo, link_inertia=inertias[name])
        servos[name] = changed if new_gains else replace(changed, kp=servo.kp, kd=servo.kd)
    return with_named_servos(robot, servos)


robots = {
    "catalog": robot,
    "identified": identified_robot(new_gains=False),
    "new gains": identified_robot(new_gains=True),
}
tasks = {
    "belly_crawl": ("belly_crawl", OpenLoop(), 9.0),
    "high_walk": ("high_walk", OpenLoop(), 5.2),
    "stand": ("belly_crawl", Standing(at=1.0, hold=2.0), 8.0),
}
rows = {}
for task, (gait, control, duration) in tasks.items():
    runs = [suchus.Run(robot=each, gait=gait, control=control) for each in robots.values()]
    record = suchus.simulate(runs, duration=duration)
    for run, label in enumerate(robots):
        walk = record.isel(run=run)
        rows[task, label] = (
            100.0 * float(displacement(walk).sel(xyz="x")),
            float(walk.snout.sel(xyz="z").max()) * 100.0,
            float(cost_of_transport(walk)),
            float(electrical_cost_of_transport(walk)),
            float(chatter(walk)),
        )

print(f"{'':24s} forward [cm]  snout, highest [cm]  cost of transport  electrical  chatter")
for (task, label), (forward, snout, cost, electrical, share) in rows.items():
    costs = f"{cost:12.2f} {electrical:14.1f}" if task != "stand" else f"{'-':>12s} {'-':>14s}"
    print(f"{task:12s} {label:11s} {forward:10.1f} {snout:15.1f} {costs} {share:12.3f}")

figure, panels = plt.subplots(1, 3, figsize=(9.0, 3.0), layout="constrained")
quantities = ((0, "forward [cm]"), (2, "cost of transport [-]"), (4, "power above 10 f [-]"))
for panel, (column, label) in zip(panels, quantities, strict=True):
    shown = [task for task in tasks if column != 2 or task != "stand"]
    for k, name in enumerate(robots):
        heights = [rows[task, name][column] for task in shown]
        panel.bar(np.arange(len(shown)) + 0.27 * (k - 1), heights, 0.25, label=name)
    panel.set_xticks(range(len(shown)), [task.replace("_", "\n") for task in shown])
    panel.set_ylabel(label)
panels[0].legend()
figure.savefig("identified_servos.png", dpi=120)
