"""Whether servos can do what a gait asks: pulses, speed, and torque from a simulated walk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from suchus.design import Robot, Servo, layout, with_servos
from suchus.errors import OutsideLimits
from suchus.hardware.commands import Commands
from suchus.hardware.servo_map import ServoMap
from suchus.land import Run, simulate
from suchus.metrics import between, whole
from suchus.motion import START, Gait
from suchus.progress import Progress, silent

AT_LIMIT = 0.02
"""Share of a walk that a servo may spend at its torque limit [-]; chosen so that the peak of a footfall passes."""
TRACKING = 0.35
"""How far a servo at its limit may be from its commanded angle for all but 2 % of a walk [rad], 20 degrees.

Chosen with the shelf's gaits in view: the crawl and ``spine_only`` leave 14 and 16 degrees at the first yaw joint and
lose 1 and 3 % of their distance against servos that reach their angles. A joint farther off makes another gait.
"""
CLASSES: Mapping[str, float] = {
    f"{kg} kg cm": round(kg * 0.0980665, 3) for kg in (5, 10, 15, 20, 25, 30, 35, 40, 45, 60, 80, 100, 150)
}
"""Hobby servos as they are sold, by their stall torque [N m]; the first that does is named."""
_FULL = 0.999
_STRONG = 4.0  # times as strong are the servos whose torques show what a walk asks for


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoLoad:
    """Load of one servo over a walk."""

    torque: float
    """Greatest torque [N m]."""
    limit: float
    """Limit of its torque [N m]."""
    at_limit: float
    """Share of the walk that it spends at the limit [-]."""
    first: float
    """Time at which it first reaches its limit, from the beginning of the walk [s]; NaN if it does not."""
    off: float
    """Greatest error against its commanded angle, but for the worst 2 % of the walk [rad]."""
    needed: float
    """98th percentile of the torque of a servo four times as strong in the same walk [N m]."""
    tried: float = 0.0
    """Torque of the strongest class of servos that was tried and is at its limit for more than 2 % too [N m]."""

    @property
    def named(self) -> str | None:
        """The weakest class of hobby servos that would do, if one does."""
        least = max(self.limit, self.tried)
        return next((name for name, torque in CLASSES.items() if torque >= self.needed and torque > least), None)

    @property
    def stock(self) -> str:
        """Description of that class of servos."""
        most = max(CLASSES.values())
        return f"{self.named} ({CLASSES[self.named]:.3g} N m)" if self.named else f"none up to {most:.3g} N m"


def check_commands(robot: Robot, gait: Gait, servo_map: ServoMap, samples: Commands) -> None:
    """Refuse commands that are faster than a servo, or pulses outside the map's limits.

    Raises:
        OutsideLimits: the message names the servo, the time and what is allowed.
    """
    for i, (name, line) in enumerate(zip(layout(robot).servos, servo_map.ordered(robot), strict=True)):
        limit = robot.servo(name).speed
        steps = np.diff(samples.angles[:, i]) / np.diff(samples.time)
        worst = int(np.argmax(np.abs(steps)))
        if abs(steps[worst]) > limit:
            raise OutsideLimits(
                f"gait {gait.name!r} turns {name} of robot {robot.name!r} at {abs(steps[worst]):.3g} rad/s at "
                f"{samples.time[worst]:.2f} s; up to {limit:g} rad/s is allowed: lengthen the period."
            )
        pulses = samples.pulses[:, i]
        worst = int(np.argmax(np.maximum(line.pulse_min - pulses, pulses - line.pulse_max)))
        if not line.pulse_min <= pulses[worst] <= line.pulse_max:
            raise OutsideLimits(
                f"gait {gait.name!r} needs a pulse of {pulses[worst]:.0f} us for {name} at "
                f"{samples.time[worst]:.2f} s, an angle of {samples.angles[worst, i]:.3f} rad; "
                f"servo map {servo_map.name!r} allows {line.pulse_min:g} to {line.pulse_max:g} us: "
                "mount the horn with another offset."
            )


def loads(robot: Robot, gait: Gait, *, cycles: int = 2, progress: Progress = silent) -> Mapping[str, ServoLoad]:
    """Return what each servo bears in a simulated walk on level ground.

    Args:
        robot: who walks.
        gait: how.
        cycles: how many.
        progress: told the share that is done.

    Raises:
        Diverged: the simulation diverged.
        OutsideLimits: the joints cannot follow the gait.
    """
    (borne,) = loads_of_each(robot, (gait,), cycles=cycles, progress=progress)
    return borne


def loads_of_each(
    robot: Robot,
    gaits: Sequence[Gait],
    *,
    cycles: int = 2,
    timestep: float | None = None,
    progress: Progress = silent,
) -> list[Mapping[str, ServoLoad]]:
    """Return what each servo bears in each of several gaits, simulated in one batch on level ground.

    Args:
        robot: who walks.
        gaits: how.
        cycles: how many of each.
        timestep: of the physics [s]; that of the robot's size if None.
        progress: told the share that is done.

    Raises:
        Diverged: the simulation diverged.
        OutsideLimits: the joints cannot follow a gait.
    """
    strong = with_servos(robot, lambda servo: replace(servo, torque=_STRONG * servo.torque))
    runs = [Run(robot=one, gait=gait) for gait in gaits for one in (robot, strong)]
    ends = [START + cycles * gait.period for gait in gaits]
    record = whole(simulate(runs, duration=max(ends), timestep=timestep, progress=progress))
    every = [_borne(robot, between(record.isel(run=[2 * i, 2 * i + 1]), end=end)) for i, end in enumerate(ends)]
    unsure = [i for i, borne in enumerate(every) if _weak(borne)]
    while unsure:
        walks = [(gaits[i], ends[i], every[i]) for i in unsure]
        for i, borne in zip(unsure, _tried(robot, walks, timestep), strict=True):
            every[i] = borne
        unsure = [i for i, (_, _, before) in zip(unsure, walks, strict=True) if every[i] != before]
    return every


def _borne(robot: Robot, walk: xr.Dataset) -> Mapping[str, ServoLoad]:
    """Return what each servo bears in a walk of the robot, and of the same with strong servos."""
    shares, first = share_at_limit(robot, walk.isel(run=0)), walk.time.values - START
    torques, off = np.abs(walk.servo_torque), np.abs(walk.servo_target - walk.servo_angle).isel(run=0)
    borne = {}
    for name in layout(robot).servos:
        own, limit = torques.sel(servo=name).values, robot.servo(name).torque
        full = own[0] >= _FULL * limit
        borne[name] = ServoLoad(
            torque=float(own[0].max()),
            limit=limit,
            at_limit=float(shares.sel(servo=name)),
            first=float(first[np.argmax(full)]) if full.any() else float("nan"),
            off=float(np.quantile(off.sel(servo=name), 1.0 - AT_LIMIT)),
            needed=float(np.quantile(own[1], 1.0 - AT_LIMIT)),
        )
    return borne


def _weak(borne: Mapping[str, ServoLoad]) -> dict[str, ServoLoad]:
    """Return the servos at their limits for too long for which a class is named."""
    return {name: load for name, load in borne.items() if load.at_limit > AT_LIMIT and load.named}


def _tried(
    robot: Robot, walks: Sequence[tuple[Gait, float, Mapping[str, ServoLoad]]], timestep: float | None
) -> list[Mapping[str, ServoLoad]]:
    """Return loads that know which of the servos that they name were at their limits for too long in the same walk.

    Args:
        robot: who walks.
        walks: gaits, when each ends [s], and what servos bear.
        timestep: of the physics [s].
    """
    robots = [stronger(robot, borne) for _, _, borne in walks]
    runs = [Run(robot=one, gait=gait) for one, (gait, _, _) in zip(robots, walks, strict=True)]
    record = simulate(runs, duration=max(end for _, end, _ in walks), timestep=timestep)
    found: list[Mapping[str, ServoLoad]] = []
    for i, (one, (_, end, borne)) in enumerate(zip(robots, walks, strict=True)):
        walk = record.isel(run=i)
        shares = share_at_limit(one, between(walk, end=end))
        short = {
            name: replace(load, tried=CLASSES[str(load.named)])
            for name, load in _weak(borne).items()
            if walk.cause.item() or shares.sel(servo=name) > AT_LIMIT
        }
        found.append({**borne, **short})
    return found


def stronger(robot: Robot, borne: Mapping[str, ServoLoad]) -> Robot:
    """Return a robot whose servos are of the classes that are named, wherever it has the same servo as there."""
    numbers: dict[int, float] = {}

    def number(servo: Servo) -> float:
        return numbers.setdefault(id(servo), 1.0 + len(numbers))

    # several joints may share a servo of the design, which is not that of an equal robot: it is found by its number
    numbered = with_servos(robot, lambda servo: replace(servo, torque=number(servo)))
    torques: dict[float, float] = {}
    for name, load in _weak(borne).items():
        found = numbered.servo(name).torque
        torques[found] = max(torques.get(found, 0.0), CLASSES[str(load.named)])
    return with_servos(robot, lambda servo: replace(servo, torque=torques.get(number(servo), servo.torque)))


def share_at_limit(robot: Robot, record: xr.Dataset) -> xr.DataArray:
    """Return the share of the time that each servo spends at its torque limit [-], over whatever else a record has.

    Args:
        robot: whose record it is.
        record: of the time that counts, as ``metrics.between`` cuts it.
    """
    limits = xr.DataArray([robot.servo(str(name)).torque for name in record.servo.values], dims="servo")
    return (np.abs(record.servo_torque) >= _FULL * limits).mean("time")


def overloaded(borne: Mapping[str, ServoLoad], at_limit: float = AT_LIMIT) -> list[str]:
    """Return a sentence for each servo that stands at its torque limit for more than a share of the walk."""
    return [
        f"{name} is at its torque limit of {load.limit:g} N m for {100 * load.at_limit:.0f} % of the walk, first at "
        f"{load.first:.2f} s, and up to {np.degrees(load.off):.1f} degrees from its commanded angle; "
        f"{'a servo of ' if load.named else 'of the servos that are sold, '}{load.stock} would do."
        for name, load in borne.items()
        if load.at_limit > at_limit
    ]


def check_loads(
    robot: Robot,
    gait: Gait,
    borne: Mapping[str, ServoLoad],
    at_limit: float = AT_LIMIT,
    tracking: float = TRACKING,
) -> None:
    """Refuse a gait that a servo cannot follow since it stands at its torque limit.

    Args:
        robot: who walks.
        gait: how.
        borne: from ``loads``.
        at_limit: share of the walk from which on a servo counts as standing at its limit [-].
        tracking: how far such a servo may be from its commanded angle [rad].

    Raises:
        OutsideLimits: the message names the servos, how long they stand at their limits, and what would do.
    """
    weak = {name: load for name, load in borne.items() if load.at_limit > at_limit and load.off > tracking}
    if weak:
        raise OutsideLimits(
            f"robot {robot.name!r} cannot follow gait {gait.name!r}: {' '.join(overloaded(weak, at_limit))} Up to "
            f"{np.degrees(tracking):.3g} degrees is allowed: choose such a servo or a gentler gait, or allow more."
        )
