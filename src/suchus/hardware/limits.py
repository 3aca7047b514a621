"""Whether servos can do what a gait asks: pulses, speed, and torque from a simulated walk."""

from collections.abc import Mapping
from math import isnan

import numpy as np

from suchus.core.errors import OutsideLimits
from suchus.hardware.commands import Commands
from suchus.hardware.loads import AT_LIMIT, ServoLoad
from suchus.hardware.servo_map import ServoMap
from suchus.robot.design import Robot, layout
from suchus.robot.motion import Gait

TRACKING = 0.35
"""How far a servo at its limit may be from its commanded angle for all but 2 % of a walk [rad], 20 degrees.

Chosen with the built-in gaits in view: the crawl and ``spine_only`` leave 14 and 16 degrees at the first yaw joint and
lose 1 and 3 % of their distance against servos that reach their angles. A joint farther off makes another gait.
"""


def check_commands(robot: Robot, gait: Gait, servo_map: ServoMap, samples: Commands) -> None:
    """Refuse commands that are faster than a servo, or pulses outside the map's limits.

    Raises:
        OutsideLimits: the message names the servo, the time and what is allowed.
    """
    for i, (name, line) in enumerate(zip(layout(robot).servos, servo_map.ordered(robot), strict=True)):
        limit = robot.servo(name).speed
        steps = np.diff(samples.angles[:, i]) / np.diff(samples.time)
        worst_sample = int(np.argmax(np.abs(steps)))
        if abs(steps[worst_sample]) > limit:
            radius = samples.pulleys.get(name)
            verb, factor, unit = ("turns", 1.0, "rad/s") if radius is None else ("moves", 1000.0 * radius, "mm/s")
            raise OutsideLimits(
                f"gait {gait.name!r} {verb} {name} of robot {robot.name!r} at "
                f"{factor * abs(steps[worst_sample]):.3g} {unit} "
                f"at {samples.time[worst_sample]:.2f} s; up to {factor * limit:g} {unit} is allowed: lengthen the "
                "period."
            )
        pulses = samples.pulses[:, i]
        worst_sample = int(np.argmax(np.maximum(line.pulse_min - pulses, pulses - line.pulse_max)))
        if not line.pulse_min <= pulses[worst_sample] <= line.pulse_max:
            raise OutsideLimits(
                f"gait {gait.name!r} needs a pulse of {pulses[worst_sample]:.0f} us for {name} at "
                f"{samples.time[worst_sample]:.2f} s, an angle of {samples.angles[worst_sample, i]:.3f} rad; "
                f"servo map {servo_map.name!r} allows {line.pulse_min:g} to {line.pulse_max:g} us: "
                "mount the horn with another offset."
            )


def _replacement_text(load: ServoLoad) -> str:
    """Return the name of a servo that is strong enough, or a text that there is none."""
    if not isnan(load.radius):
        return "a stronger linear actuator, of which suchus knows none by name,"
    return f"{load.other} ({load.other_torque:.3g} N m)" if load.other else "none of the servos that suchus knows"


def overloaded(servo_loads: Mapping[str, ServoLoad], at_limit: float = AT_LIMIT) -> list[str]:
    """Return a sentence for each servo that is at its limit for more than a fraction of the walk."""
    return [
        f"{name} is at its {_limit(load)} for {100 * load.at_limit:.0f} % of the walk, first at {load.first:.2f} s, "
        f"and up to {_tracking_error_text(load)}; {_replacement_text(load)} would do."
        for name, load in servo_loads.items()
        if load.at_limit > at_limit
    ]


def _limit(load: ServoLoad) -> str:
    """Return the limit of what a servo gives, a linear actuator's in newtons."""
    if isnan(load.radius):
        return f"torque limit of {load.limit:g} N m"
    return f"force limit of {load.limit / load.radius:g} N"


def _tracking_error_text(load: ServoLoad) -> str:
    """Return the greatest error against the command, in degrees or, of a linear actuator, in millimetres."""
    if isnan(load.radius):
        return f"{np.degrees(load.off):.1f} degrees from its commanded angle"
    return f"{1000 * load.off * load.radius:.1f} mm from its commanded place"


def check_loads(
    robot: Robot,
    gait: Gait,
    servo_loads: Mapping[str, ServoLoad],
    at_limit: float = AT_LIMIT,
    tracking: float = TRACKING,
) -> None:
    """Refuse a gait that a servo cannot follow because it is at its torque limit.

    Args:
        robot: robot that walks.
        gait: gait that is walked.
        servo_loads: loads of servos from ``loads``.
        at_limit: share of the walk from which on a servo counts as standing at its limit [-].
        tracking: how far such a servo may be from its commanded angle [rad].

    Raises:
        OutsideLimits: the message names the servos, how long they stand at their limits, and what would do.
    """
    weak = {name: load for name, load in servo_loads.items() if load.at_limit > at_limit and load.off > tracking}
    if weak:
        raise OutsideLimits(
            f"robot {robot.name!r} cannot follow gait {gait.name!r}: {' '.join(overloaded(weak, at_limit))} Up to "
            f"{np.degrees(tracking):.3g} degrees is allowed: choose such a servo or a gentler gait, or allow more."
        )
