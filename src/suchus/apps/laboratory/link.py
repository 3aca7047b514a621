"""Links into the page: the part of its address after ``#`` that sets sliders and faults as a run has them."""

from collections.abc import Mapping
from math import floor
from urllib.parse import urlencode

from suchus.apps.viewer.knobs import GAIT_KNOBS, LEVEL, SLOPE, Knob, knobs_of
from suchus.robot.motion import Gait
from suchus.sim.faults import Limp
from suchus.sim.land import Run

_WORLD_KNOBS: Mapping[str, Knob] = {"uphill": SLOPE, "level": LEVEL}
_DIGITS = 12


def page_settings(run: Run, start_gait: Gait, *, start_level: float | None = None) -> str:
    """Return the settings with which a page shows a run, as ``trunk_bend=30&faults=LF_yaw%3Alimp``.

    Only settings that differ from those of the page are named. A fault begins with the run. The page has no sliders for
    the rest of a run, such as pushes or uneven ground, and the link leaves it out.

    Args:
        run: the run.
        start_gait: gait in which the page begins.
        start_level: level of the water with which the page begins [m]; None if it begins without water.
    """
    settings = {}
    for name in knobs_of(run.robot, start_gait):
        value, start = (_in_range(GAIT_KNOBS[name], gait.number(name)) for gait in (run.gait, start_gait))
        if value != start:
            settings[name] = _shown(value)
    world: dict[str, tuple[float | None, float | None]] = {
        "friction": (run.ground.friction_scale, 1.0),
        "uphill": (run.ground.uphill, 0.0),
        "level": (constant_level(run), start_level),
    }
    for name, (number, start_number) in world.items():
        if number != start_number:
            scale = _WORLD_KNOBS[name].scale if name in _WORLD_KNOBS else 1.0
            settings[name] = "none" if number is None else _shown(number / scale)
    if limp := [fault.joint for fault in run.faults if isinstance(fault, Limp)]:
        settings["faults"] = ",".join(f"{joint}:limp" for joint in limp)
    return urlencode(settings)


def constant_level(run: Run) -> float | None:
    """Return the level of the water of a run [m]; None if the run has no water, or its level changes."""
    level = None if run.lake is None else run.lake.level
    return None if isinstance(level, tuple) else level


def _in_range(knob: Knob, value: float) -> float:
    """Return a value in the unit of its knob; a phase is shifted by whole cycles into the knob's range."""
    shown = value / knob.scale
    return shown - floor(shown - knob.low) if knob.unit == "cycle" and not knob.low <= shown <= knob.high else shown


def _shown(value: float) -> str:
    return f"{value:.{_DIGITS}g}"
