"""What can be turned while the robot walks: numbers with a range, a unit and a step."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite, radians
from types import MappingProxyType
from typing import Any

from suchus.design import GRAVITY, Crocodile
from suchus.errors import OutsideLimits
from suchus.motion import Gait, check_limits

_HALVINGS = 14  # of the way to a value that the robot cannot reach: a ten-thousandth of it


@dataclass(frozen=True, slots=True, kw_only=True)
class Knob:
    """A number that people may turn, in the unit in which they see it."""

    label: str
    """Beside the slider."""
    unit: str
    """In which it is shown."""
    low: float
    """Least value, in that unit."""
    high: float
    """Greatest value, in that unit."""
    step: float
    """Of the slider, in that unit."""
    scale: float = 1.0
    """SI value of one unit."""
    hint: str = ""
    """What it does."""

    def __str__(self) -> str:
        return f"{self.label} [{self.unit}]" if self.unit else self.label

    def said(self, value: float) -> str:
        """Return a shown value with its unit."""
        return f"{value:.4g} {self.unit}".rstrip()

    def within(self, value: object, now: float) -> tuple[float, str]:
        """Return a value that is allowed and, where it is not the one asked for, a sentence that says so.

        Args:
            value: asked for, in the knob's unit; anything.
            now: which stands, and stays where what is asked for is no number.
        """
        try:
            asked = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            return now, f"{self.label}: {str(value)[:40]!r} is no number; it stays at {self.said(now)}."
        if not isfinite(asked):
            return now, f"{self.label}: {asked} is no finite number; it stays at {self.said(now)}."
        held = min(max(asked, self.low), self.high)
        if held != asked:
            allowed = f"{self.low:g} to {self.said(self.high)}"
            return held, f"{self.label}: {self.said(asked)} is outside {allowed}; it is {self.said(held)} now."
        return asked, ""


_DEGREE = radians(1.0)

GAIT_KNOBS: Mapping[str, Knob] = MappingProxyType(
    {
        "period": Knob(label="period", unit="s", low=0.5, high=8.0, step=0.05, hint="Of one cycle of the legs."),
        "duty_factor": Knob(
            label="duty factor", unit="", low=0.3, high=0.9, step=0.01,
            hint="Share of the cycle in which a foot stands.",
        ),
        "stroke": Knob(
            label="leg stroke", unit="mm", low=0.0, high=100.0, step=1.0, scale=1e-3,
            hint="Half of the way that a foot goes back in stance.",
        ),
        "lift": Knob(label="foot lift", unit="mm", low=0.0, high=80.0, step=1.0, scale=1e-3, hint="In swing."),
        "hip_height": Knob(
            label="hip height", unit="mm", low=40.0, high=170.0, step=1.0, scale=1e-3,
            hint="Of the hips above the ground.",
        ),
        "trunk_bend": Knob(
            label="trunk bend", unit="deg", low=0.0, high=100.0, step=1.0, scale=_DEGREE,
            hint="Amplitude of the sideways bend of the whole trunk.",
        ),
        "spine_phase": Knob(
            label="spine phase", unit="cycle", low=-0.5, high=0.5, step=0.01,
            hint="How late the trunk bends against the legs; half a cycle late it walks backwards.",
        ),
        "tail_bend": Knob(
            label="tail bend", unit="deg", low=0.0, high=90.0, step=1.0, scale=_DEGREE,
            hint="Amplitude of the sideways bend of the tail.",
        ),
        "tail_phase": Knob(
            label="tail phase", unit="cycle", low=-0.5, high=0.5, step=0.01,
            hint="How late the tail bends against the trunk.",
        ),
        "tail_pitch": Knob(
            label="tail pitch", unit="deg", low=-30.0, high=40.0, step=0.5, scale=_DEGREE,
            hint="Down positive: the ground carries the tail, or it is lifted.",
        ),
    }
)  # fmt: skip
"""Fields of a gait that can be turned; the ranges lie within those that ``Gait`` allows."""

SLOPE = Knob(label="uphill", unit="deg", low=-20.0, high=20.0, step=0.5, scale=_DEGREE, hint="Slope along the walk.")
SIDE_SLOPE = Knob(
    label="left side up", unit="deg", low=-20.0, high=20.0, step=0.5, scale=_DEGREE, hint="Slope across the walk."
)
BUMPS = Knob(
    label="bumps", unit="mm", low=0.0, high=60.0, step=5.0, scale=1e-3,
    hint="Height of a field of random bumps ahead; the walk begins anew on them.",
)  # fmt: skip
SPEED = Knob(label="playback speed", unit="x", low=0.05, high=4.0, step=0.05, hint="1 is real time.")
FORCE = Knob(label="force", unit="N", low=0.0, high=60.0, step=1.0)
LASTING = Knob(label="lasting", unit="s", low=0.02, high=2.0, step=0.02, hint="Duration of the push.")
DIRECTION = Knob(
    label="direction", unit="deg", low=-180.0, high=180.0, step=15.0, scale=_DEGREE,
    hint="0 pushes forward, 90 to the left, 180 backward.",
)  # fmt: skip

LEVEL = Knob(
    label="water level", unit="mm", low=0.0, high=1000.0, step=5.0, scale=1e-3,
    hint="Above the ground where the walk begins; the surface stays level where the ground slopes.",
)  # fmt: skip
BREATH = Knob(
    label="breath", unit="%", low=0.0, high=100.0, step=1.0, scale=1e-2,
    hint="Share of the hull's air that is kept; less of it sinks.",
)  # fmt: skip


def force_on(robot: Crocodile) -> Knob:
    """Return the knob of a push's force, with the weight of whom it pushes."""
    return replace(FORCE, hint=f"{robot.name} weighs {robot.mass * GRAVITY:.0f} N.")


def shown(gait: Gait, name: str) -> float:
    """Return a field of a gait in the unit of its knob, to four digits."""
    return float(f"{getattr(gait, name) / GAIT_KNOBS[name].scale:.4g}")


def tuned(robot: Crocodile, gait: Gait, name: str, value: object) -> tuple[Gait, str]:
    """Return a gait with one field turned as far as the robot's joints follow, and a sentence if that is not as asked.

    Args:
        robot: who walks.
        gait: which the robot can walk.
        name: of the knob.
        value: asked for, in the knob's unit; anything.
    """
    knob, now = GAIT_KNOBS[name], shown(gait, name)
    asked, notice = knob.within(value, now)
    if notice and asked == now:
        return gait, notice
    wanted = _with(gait, name, asked)
    why = _refused(robot, wanted)
    if not why:
        return wanted, notice
    fits, reached = gait, now
    for i in range(1, _HALVINGS + 1):
        between = reached + (asked - now) / 2**i
        trial = _with(gait, name, between)
        if not _refused(robot, trial):
            fits, reached = trial, between
    return fits, f"{knob.label}: the robot cannot follow {knob.said(asked)}; it is {knob.said(reached)} now. {why}"


def _with(gait: Gait, name: str, value: float) -> Gait:
    change: dict[str, Any] = {name: value * GAIT_KNOBS[name].scale}
    return replace(gait, **change)


def _refused(robot: Crocodile, gait: Gait) -> str:
    try:
        check_limits(robot, gait)
    except OutsideLimits as error:
        return str(error)
    return ""
