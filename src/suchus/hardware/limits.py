"""Whether servos can do what a gait asks: pulses, speed, and torque from a simulated walk."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from suchus.design import Crocodile, servo_names
from suchus.errors import OutsideLimits
from suchus.hardware.commands import Commands
from suchus.hardware.servo_map import ServoMap
from suchus.land import Run, simulate
from suchus.metrics import between, whole
from suchus.model.build import servo_of
from suchus.motion import START, Gait

AT_LIMIT = 0.02
"""Share of a walk that a servo may spend at its torque limit [-]; chosen so that the peak of a footfall passes."""
_FULL = 0.999


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """What a servo bears in a walk."""

    torque: float
    """Greatest torque [N m]."""
    limit: float
    """Of its torque [N m]."""
    at_limit: float
    """Share of the walk that it spends at the limit [-]."""
    first: float
    """When it first gets there, from the beginning of the walk [s]; NaN if it does not."""


def check_commands(robot: Crocodile, gait: Gait, servo_map: ServoMap, told: Commands) -> None:
    """Refuse commands that are faster than a servo, or pulses outside the map's limits.

    Raises:
        OutsideLimits: the message names the servo, the time and what is allowed.
    """
    for i, (name, line) in enumerate(zip(servo_names(), servo_map.ordered(), strict=True)):
        limit = servo_of(robot, name).speed
        steps = np.diff(told.angles[:, i]) / np.diff(told.time)
        worst = int(np.argmax(np.abs(steps)))
        if abs(steps[worst]) > limit:
            raise OutsideLimits(
                f"gait {gait.name!r} turns {name} of robot {robot.name!r} at {abs(steps[worst]):.3g} rad/s at "
                f"{told.time[worst]:.2f} s; up to {limit:g} rad/s is allowed: lengthen the period."
            )
        pulses = told.pulses[:, i]
        worst = int(np.argmax(np.maximum(line.pulse_min - pulses, pulses - line.pulse_max)))
        if not line.pulse_min <= pulses[worst] <= line.pulse_max:
            raise OutsideLimits(
                f"gait {gait.name!r} needs a pulse of {pulses[worst]:.0f} us for {name} at {told.time[worst]:.2f} s, "
                f"an angle of {told.angles[worst, i]:.3f} rad; servo map {servo_map.name!r} allows "
                f"{line.pulse_min:g} to {line.pulse_max:g} us: mount the horn with another offset."
            )


def loads(
    robot: Crocodile, gait: Gait, *, cycles: int = 2, progress: Callable[[float], None] | None = None
) -> Mapping[str, Load]:
    """Return what each servo bears in a simulated walk on level ground.

    Args:
        robot: who walks.
        gait: how.
        cycles: how many.
        progress: called with the share that is done.

    Raises:
        Diverged: the physics came apart.
        OutsideLimits: the joints cannot follow the gait.
    """
    run = Run(robot=robot, gait=gait)
    record = whole(simulate([run], duration=START + cycles * gait.period, progress=progress)).isel(run=0)
    walk = between(record)
    borne = {}
    for name in servo_names():
        limit = servo_of(robot, name).torque
        torque = np.abs(walk.servo_torque.sel(servo=name).values)
        full = torque >= _FULL * limit
        borne[name] = Load(
            torque=float(torque.max()),
            limit=limit,
            at_limit=float(full.mean()),
            first=float(walk.time.values[np.argmax(full)]) - START if full.any() else float("nan"),
        )
    return borne


def check_loads(robot: Crocodile, gait: Gait, borne: Mapping[str, Load], at_limit: float = AT_LIMIT) -> None:
    """Refuse a gait that keeps a servo at its torque limit.

    A servo cannot give more than its limit, in the simulation as on the table: how long it stands there tells whether
    the gait asks too much.

    Args:
        robot: who walks.
        gait: how.
        borne: from ``loads``.
        at_limit: allowed share of the walk [-].

    Raises:
        OutsideLimits: the message names the servos and how long they stand at their limits.
    """
    over = {name: load for name, load in borne.items() if load.at_limit > at_limit}
    if over:
        said = ", ".join(
            f"{name} for {100 * load.at_limit:.0f} % of the walk ({load.limit:g} N m, first at {load.first:.2f} s)"
            for name, load in over.items()
        )
        raise OutsideLimits(
            f"gait {gait.name!r} holds servos of robot {robot.name!r} at their torque limit: {said}; "
            f"{100 * at_limit:.3g} % is allowed: choose stronger servos or a gentler gait, or allow a greater share."
        )
