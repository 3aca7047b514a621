"""Compute how near the joints of the article's robot come to the body wave (20), which the page on swimming states.

Usage: python tools/wave_fits.py: keeps what was found, and writes the pages that state it anew.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pages import stated as pages
from suchus.core.errors import OutsideLimits
from suchus.robot.design import layout
from suchus.robot.kinematics.tail import bend_of_servo
from suchus.robot.motion import cycle_targets, lateral_servos
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import fit, printed_wave

NAME = "wave_fits"
WAVES = {
    "I, one wave per body": ("I", 1.0),
    "I, wave 1.5 bodies long": ("I", 1.0 / 1.5),
    "I, wave 0.7 bodies long": ("I", 1.0 / 0.7),
    "A, letter by letter": ("A", 1.0),
    "C": ("C", 1.0),
    "B": ("B", 1.0),
    "G": ("G", 1.0),
    "J": ("J", 1.0),
}
"""Reading of (20) and waves per body of each row [-]."""


def stated() -> Mapping[str, Any]:
    """Return of each wave the misfit [-] and how far its joints and its cable bend to either side [rad]; or neither."""
    robot = ROBOTS["caiman"]
    place, clock = layout(robot), np.linspace(0.0, 1.0, 200, endpoint=False)
    rows: dict[str, Any] = {}
    for called, (reading, waves) in WAVES.items():
        try:
            found = fit(robot, printed_wave(robot, reading, waves_per_body=waves))
        except OutsideLimits:
            rows[called] = {"misfit": None, "bends": []}
            continue
        targets, bends = cycle_targets(robot, found.gait, clock), []
        for name in lateral_servos(robot):
            servo = place.servos.index(name)
            angle = targets[:, servo]
            angle = bend_of_servo(place.cable(servo), angle) if servo in place.cables else angle
            bends.append(float(np.ptp(angle)) / 2)
        rows[called] = {"misfit": found.misfit, "bends": bends}
    return {"rows": rows, "servos": list(lateral_servos(robot))}


if __name__ == "__main__":
    pages.keep(NAME, stated())
    pages.main()
