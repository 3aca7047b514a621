"""What the servos of a robot bear in each gait of the catalog, and whether the servos that are named would do."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from suchus.core.errors import OutsideLimits
from suchus.hardware import ServoLoad, cases, check_loads, loads_of_cases, overloaded, with_better
from suchus.hardware.loads import AT_LIMIT, LoadCase, cold, measure_loads, records_of_each
from suchus.robot.design import Robot, Servo, with_named_servos
from suchus.robot.gaits import GAITS, suits
from suchus.robot.motion import Gait
from suchus.robot.motors import motor


def measured(
    robot: Robot, *, cycles: int, timestep: float | None = None, names: Sequence[str] = tuple(GAITS)
) -> dict[str, dict[str, Any]]:
    """Return for each gait whether it is exported, what is said, and for each servo at its limit how it is.

    ``then`` is the share of the walk at its limit of the servo that is named, which falls with its speed [-].
    """
    gaits = [GAITS[name] for name in names if suits(robot, GAITS[name])]
    asked = [replace(case, seconds=cycles * case.gait.period) for case in cases(robot, gaits)]
    found = {}
    for case, borne_there in zip(asked, loads_of_cases(robot, asked, timestep=timestep), strict=True):
        told = with_better(robot, case, borne_there)
        weak = {name: load for name, load in told.items() if load.at_limit > AT_LIMIT}
        then = _then(robot, case, weak)
        found[case.name] = {
            "exported": _exported(robot, case.gait, told),
            "said": overloaded(told),
            "most": max(load.at_limit for load in told.values()),
            "servos": {name: _servo(load, then.get(name, 1.0)) for name, load in weak.items()},
        }
    return found


def _servo(load: ServoLoad, then: float) -> dict[str, Any]:
    would_do = f"{load.other} ({load.other_torque:.3g} N m)" if load.other else "none"
    return {"at_limit": load.at_limit, "off": load.off, "would_do": would_do, "then": then}


def _then(robot: Robot, case: LoadCase, weak: Mapping[str, ServoLoad]) -> dict[str, float]:
    """Return the share at their limits of the servos that are named, all in their places."""
    named = {name: motor(load.other) for name, load in weak.items() if load.other}
    if not named:
        return {}
    body = with_named_servos(
        robot, {name: Servo.from_motor(one, template=robot.servo(name)) for name, one in named.items()}
    )
    (record,) = records_of_each([(cold(body), case)])
    return {name: measure_loads(body, record)[name].at_limit for name in named}


def _exported(robot: Robot, gait: Gait, borne_there: Mapping[str, ServoLoad]) -> bool:
    try:
        check_loads(robot, gait, borne_there)
    except OutsideLimits:
        return False
    return True
