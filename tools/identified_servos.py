"""Walks of the article's robot on servos as they were identified, into docs/servos_evidence.md and docs/pictures.

Four robots: with the servos that the catalog used to have; as in the catalog, with the mean of the identified servos;
with inertia and friction of an STS3215 at 7.4 V and the gains of the catalog; and with gains from inertia, delay and
control period. Torque and speed stay those of the catalog.

Usage: python tools/identified_servos.py
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from suchus.robot.control import Control, OpenLoop, Standing
from suchus.robot.design import Robot, servo_names, with_named_servos
from suchus.robot.motors.identified import identified_servo
from suchus.robot.motors.servo_parameters import servo_parameters
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import (
    chatter,
    cost_of_transport,
    displacement,
    electrical_cost_of_transport,
    net_cost_of_transport,
    speed_chatter,
)
from suchus.sim.model.inverse import held_inertias

PAGE = Path(__file__).parents[1] / "docs" / "servos_evidence.md"
PICTURE = PAGE.parent / "pictures" / "identified_servos.png"
BLOCK = re.compile(r"(?<=<!-- walks: made by tools/identified_servos.py -->\n).*?(?=<!-- /walks -->)", re.DOTALL)
SERVO = "STS3215 7.4 V, m1"
FORMER = {"kd": 0.6, "armature": 0.005, "friction": 0.03, "damping": 0.05}
"""Gain, rotor inertia, dry friction and damping of the servos that the catalog used to have."""


@dataclass(frozen=True)
class Task:
    """What the robots do."""

    name: str
    gait: str
    control: Control
    duration: float


TASKS = (
    Task("belly crawl", "belly_crawl", OpenLoop(), 9.0),
    Task("high walk", "high_walk", OpenLoop(), 5.2),
    Task("stand", "belly_crawl", Standing(at=1.0, hold=2.0), 8.0),
)


def identified_robot(robot: Robot, *, has_new_gains: bool) -> Robot:
    """Return the robot with identified servos, with its own gains or with new ones."""
    identified, servos = identified_servo(SERVO), {}
    for name, inertia in held_inertias(robot).items():
        servo = robot.servo(name)
        changed = servo_parameters(identified, servo, link_inertia=inertia)
        servos[name] = changed if has_new_gains else replace(changed, kp=servo.kp, kd=servo.kd)
    return with_named_servos(robot, servos)


def robots() -> dict[str, Robot]:
    """Return the four robots by their names in the table."""
    caiman = ROBOTS["caiman"]
    former = {name: replace(caiman.servo(name), **FORMER) for name in servo_names(caiman)}
    return {
        "former": with_named_servos(caiman, former),
        "catalog": caiman,
        "STS3215": identified_robot(caiman, has_new_gains=False),
        "STS3215, new gains": identified_robot(caiman, has_new_gains=True),
    }


def measured(task: Task) -> dict[str, dict[str, float]]:
    """Return the numbers of a task by robot and quantity."""
    labels = robots()
    runs = [Run(robot=robot, gait=task.gait, control=task.control) for robot in labels.values()]
    record = simulate(runs, duration=task.duration)
    rows = {}
    for run, label in enumerate(labels):
        walk = record.isel(run=run)
        rows[label] = {
            "forward [m]": float(displacement(walk).sel(xyz="x")),
            "snout, highest [m]": float(walk.snout.sel(xyz="z").max()),
            "cost of transport": float(cost_of_transport(walk)),
            "net": float(net_cost_of_transport(walk)),
            "electrical": float(electrical_cost_of_transport(walk)),
            "chatter [%]": 100.0 * float(chatter(walk)),
            "speed chatter [%]": 100.0 * float(speed_chatter(walk)),
        }
    return rows


def table(rows: Mapping[str, Mapping[str, Mapping[str, float]]]) -> str:
    """Return the numbers as a table in Markdown."""
    quantities = list(next(iter(next(iter(rows.values())).values())))
    lines = [f"| task | servos | {' | '.join(quantities)} |", "|---|---|" + "---:|" * len(quantities)]
    for task, of_robots in rows.items():
        for label, values in of_robots.items():
            is_walk = task != "stand"
            cells = [
                "" if not is_walk and name in ("cost of transport", "net", "electrical") else f"{value:.3g}"
                for name, value in values.items()
            ]
            lines.append(f"| {task} | {label} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def draw(rows: Mapping[str, Mapping[str, Mapping[str, float]]]) -> None:
    """Draw displacement, cost and chatter of the tasks as bars."""
    figure, panels = plt.subplots(1, 3, figsize=(9.0, 3.0), layout="constrained")
    for panel, quantity in zip(panels, ("forward [m]", "cost of transport", "chatter [%]"), strict=True):
        tasks = [task for task in rows if quantity != "cost of transport" or task != "stand"]
        labels = list(rows[tasks[0]])
        for k, label in enumerate(labels):
            values = [rows[task][label][quantity] for task in tasks]
            panel.bar(np.arange(len(tasks)) + 0.21 * (k - 0.5 * (len(labels) - 1)), values, 0.19, label=label)
        panel.set_xticks(range(len(tasks)), [task.replace(" ", "\n") for task in tasks])
        panel.set_ylabel(quantity)
    panels[1].legend(fontsize=7)
    figure.savefig(PICTURE, dpi=120)


def main() -> None:
    """Simulate, draw, and write the table into the page."""
    rows = {task.name: measured(task) for task in TASKS}
    draw(rows)
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(BLOCK.sub(lambda _: table(rows), page), encoding="utf-8")
    print(table(rows))


if __name__ == "__main__":
    main()
