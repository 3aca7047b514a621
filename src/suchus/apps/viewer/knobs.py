"""What can be turned while the robot walks: numbers with a range, a unit and a step."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite, radians
from types import MappingProxyType

from suchus.core.errors import InvalidDesign, NotConverged, OutsideLimits
from suchus.robot.control import Policy
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.motion import Gait, check_limits
from suchus.robot.robots import size_relative_to_article

_MAX_HALVINGS = 14  # of the distance to a value that the robot cannot reach; 14 leave a ten-thousandth


@dataclass(frozen=True, slots=True, kw_only=True)
class Knob:
    """A number that people may turn, in the unit in which they see it."""

    label: str
    """Label of the slider."""
    unit: str
    """Unit in which it is shown."""
    low: float
    """Least value, in that unit."""
    high: float
    """Greatest value, in that unit."""
    step: float
    """Step of the slider, in that unit."""
    scale: float = 1.0
    """SI value of one unit."""
    hint: str = ""
    """Explanation of its effect, for the page."""

    def __str__(self) -> str:
        return f"{self.label} [{self.unit}]" if self.unit else self.label

    def value_text(self, value: float) -> str:
        """Return a shown value with its unit."""
        return f"{value:.4g} {self.unit}".rstrip()

    def clip(self, value: object, current: float) -> tuple[float, str]:
        """Return the nearest allowed value, and a sentence if it differs from the requested value.

        Args:
            value: asked for, in the knob's unit; anything.
            current: which stands, and stays where what is asked for is no number.
        """
        try:
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            return current, f"{self.label}: {str(value)[:40]!r} is no number; it stays at {self.value_text(current)}."
        if not isfinite(number):
            return current, f"{self.label}: {number} is no finite number; it stays at {self.value_text(current)}."
        clipped = min(max(number, self.low), self.high)
        if clipped != number:
            allowed = f"{self.low:g} to {self.value_text(self.high)}"
            return (
                clipped,
                f"{self.label}: {self.value_text(number)} is outside {allowed}; it is {self.value_text(clipped)} now.",
            )
        return number, ""


_DEGREE = radians(1.0)

_SHARE = 0.01  # one per cent

GAIT_KNOBS: Mapping[str, Knob] = MappingProxyType(
    {
        "period": Knob(label="period", unit="s", low=0.5, high=8.0, step=0.05, hint="Of one cycle of the limbs."),
        "duty_factor": Knob(
            label="duty factor", unit="", low=0.3, high=0.9, step=0.01,
            hint="Share of the cycle in which a foot stands.",
        ),
        "stroke": Knob(
            label="limb stroke", unit="% of reach", low=0.0, high=60.0, step=0.5, scale=_SHARE,
            hint="Half of the distance that a foot moves back in stance, of the front limbs; others in proportion.",
        ),
        "lift": Knob(
            label="foot lift", unit="% of reach", low=0.0, high=60.0, step=0.5, scale=_SHARE,
            hint="In swing, of the front limbs; others in proportion.",
        ),
        "height": Knob(
            label="hip height", unit="% of reach", low=10.0, high=120.0, step=0.5, scale=_SHARE,
            hint="Of the hindmost hips above the ground.",
        ),
        "crank": Knob(
            label="crank in stance", unit="deg", low=10.0, high=340.0, step=5.0, scale=_DEGREE,
            hint="Angle that a crank turns through while its foot stands.",
        ),
        "trunk_bend": Knob(
            label="trunk bend", unit="deg", low=0.0, high=120.0, step=1.0, scale=_DEGREE,
            hint="Amplitude of the sideways bend of the whole trunk.",
        ),
        "axis_bend": Knob(
            label="axis bend", unit="deg", low=0.0, high=720.0, step=5.0, scale=_DEGREE,
            hint="Amplitude of the sideways bend of the whole axis, all its joints together.",
        ),
        "axis_lag": Knob(
            label="axis phase", unit="cycle", low=-0.5, high=0.5, step=0.01,
            hint="Phase lag of the trunk's bend behind the limbs; with half a cycle a crawl goes backwards.",
        ),
        "tail_bend": Knob(
            label="tail bend", unit="deg", low=0.0, high=120.0, step=1.0, scale=_DEGREE,
            hint="Amplitude of the sideways bend of the tail.",
        ),
        "tail_lag": Knob(
            label="tail phase", unit="cycle", low=0.0, high=1.0, step=0.01,
            hint="Phase lag of the tail's bend behind the trunk's; with half a cycle they swing to opposite sides.",
        ),
        "waves": Knob(
            label="waves along the body", unit="", low=-2.0, high=2.0, step=0.05,
            hint="0 is a standing wave; positive it runs from head to tail.",
        ),
        "trunk_offset": Knob(
            label="bend to the left", unit="deg", low=-60.0, high=60.0, step=1.0, scale=_DEGREE,
            hint="Of the trunk, steadily: it turns left.",
        ),
        "tail_pitch": Knob(
            label="tail pitch", unit="deg", low=-30.0, high=40.0, step=0.5, scale=_DEGREE,
            hint="Down positive: the ground carries the tail, or it is lifted.",
        ),
    }
)  # fmt: skip
"""Numbers of a gait that can be turned; the ranges lie within those that ``Gait`` allows."""

SLOPE = Knob(label="uphill", unit="deg", low=-20.0, high=20.0, step=0.5, scale=_DEGREE, hint="Slope along the walk.")
SIDE_SLOPE = Knob(
    label="left side up", unit="deg", low=-20.0, high=20.0, step=0.5, scale=_DEGREE, hint="Slope across the walk."
)
BUMPS = Knob(
    label="bumps", unit="mm", low=0.0, high=60.0, step=5.0, scale=1e-3,
    hint="Height of a field of random bumps ahead; the walk begins anew on them.",
)  # fmt: skip
"""Knob of the bumps for a robot as long as the article's; see ``bumps_under``."""
SPEED = Knob(label="playback speed", unit="x", low=0.05, high=4.0, step=0.05, hint="1 is real time.")
FORCE = Knob(label="force", unit="N", low=0.0, high=60.0, step=1.0)
"""Knob of the force for a robot as heavy as the article's; see ``force_on``."""
PUSH_DURATION = Knob(label="duration", unit="s", low=0.02, high=2.0, step=0.02, hint="Duration of the push.")
DIRECTION = Knob(
    label="direction", unit="deg", low=-180.0, high=180.0, step=15.0, scale=_DEGREE,
    hint="0 pushes forward, 90 to the left, 180 backward.",
)  # fmt: skip
_DEFAULT_PUSH = 15.0  # [N]; on the article's robot, at first
_MIN_NEWTON_WEIGHT = 1.0  # [N]; a lighter body is pushed in millinewtons

LEVEL = Knob(
    label="water level", unit="mm", low=0.0, high=1000.0, step=5.0, scale=1e-3,
    hint="Above the ground where the walk begins; the surface stays level where the ground slopes.",
)  # fmt: skip
AIR_FRACTION = Knob(
    label="air fraction", unit="%", low=0.0, high=100.0, step=1.0, scale=1e-2,
    hint="Share of the hull's air that is kept; less of it sinks.",
)  # fmt: skip


def command_knobs(policy: Policy) -> dict[str, Knob]:
    """Return the knobs of the commanded speed and turning rate: as far as a policy was trained."""
    max_speed, max_turn = (_rounded(float(value)) for value in (policy.max_speed, policy.max_turn))
    lower_speed = _rounded(policy.speeds[0])
    return {
        "forward": Knob(
            label="forward", unit="m/s", low=lower_speed, high=max_speed, step=_rounded((max_speed - lower_speed) / 50),
            hint="Commanded forward speed.",
        ),
        "turn": Knob(
            label="turn to the left", unit="rad/s", low=-max_turn, high=max_turn, step=_rounded(max_turn / 25),
            hint="Commanded turning rate; to the right where negative.",
        ),
    }  # fmt: skip


def force_on(robot: Robot) -> Knob:
    """Return the knob of a push's force, scaled by the robot's weight, in newtons or millinewtons."""
    weight = robot.mass * GRAVITY
    unit, scale = ("N", 1.0) if weight >= _MIN_NEWTON_WEIGHT else ("mN", 1e-3)
    weight_text = f"{weight / scale:.0f}" if weight / scale >= 10.0 else f"{weight / scale:.2g}"
    hint = f"{robot.name} weighs {weight_text} {unit}."
    upper_bound = _rounded(FORCE.high * size_relative_to_article(robot).weight / scale)
    return replace(FORCE, unit=unit, scale=scale, high=upper_bound, step=_rounded(upper_bound / 60.0), hint=hint)


def push_on(robot: Robot) -> float:
    """Return the force of a push as it is set at first [N]: 0.43 of the weight of a body of another size."""
    return _rounded(_DEFAULT_PUSH * size_relative_to_article(robot).weight)


def bumps_under(robot: Robot) -> Knob:
    """Return the knob of the bumps' height, scaled by the robot's length."""
    return _resized(BUMPS, size_relative_to_article(robot).length)


def knobs_of(robot: Robot, gait: Gait) -> Mapping[str, Knob]:
    """Return the knobs of a gait by name: the parameters of the gait that move a joint of the robot."""
    robot_layout = layout(robot)
    lacking = {
        *(() if robot_layout.limbs else ("duty_factor", "height")),
        *(() if gait.has("foot paths") else ("height",)),
        *(() if robot_layout.trunk_yaw else ("trunk_bend", "trunk_offset")),
        *(() if robot_layout.tail_yaw or robot_layout.cables else ("tail_bend", "tail_lag")),
        *(() if robot_layout.tail_pitch else ("tail_pitch",)),
    }
    parameters = gait.numbers() if gait.has("steering") else {}
    return {name: knob for name, knob in GAIT_KNOBS.items() if name in parameters and name not in lacking}


def _resized(knob: Knob, factor: float) -> Knob:
    lower_bound, upper_bound = (float(f"{factor * end:.2g}") for end in (knob.low, knob.high))
    return replace(knob, low=lower_bound, high=upper_bound, step=_rounded(factor * knob.step))


def _rounded(value: float) -> float:
    return float(f"{value:.2g}")


def displayed_value(gait: Gait, name: str) -> float:
    """Return a number of a gait in the unit of its knob, to four digits."""
    return float(f"{gait.number(name) / GAIT_KNOBS[name].scale:.4g}")


def tune_gait(robot: Robot, gait: Gait, name: str, value: object) -> tuple[Gait, str]:
    """Return a gait with one parameter changed as far as the joints allow, and a sentence if that is not as asked for.

    Args:
        robot: robot that walks.
        gait: which the robot can walk.
        name: name of the knob.
        value: asked for, in the knob's unit; anything.
    """
    knob, current = knobs_of(robot, gait)[name], displayed_value(gait, name)
    target, notice = knob.clip(value, current)
    if notice and target == current:
        return gait, notice
    target_gait, error = _gait_with(robot, gait, name, target * knob.scale)
    if not error:
        return target_gait, notice
    feasible_gait, feasible_value = gait, current
    for i in range(1, _MAX_HALVINGS + 1):
        trial_value = feasible_value + (target - current) / 2**i
        trial, trial_error = _gait_with(robot, gait, name, trial_value * knob.scale)
        if not trial_error:
            feasible_gait, feasible_value = trial, trial_value
    return (
        feasible_gait,
        f"{knob.label}: the robot cannot follow {knob.value_text(target)}; "
        f"it is {knob.value_text(feasible_value)} now. {error}",
    )


def _gait_with(robot: Robot, gait: Gait, name: str, value: float) -> tuple[Gait, str]:
    """Return a gait with one field changed, and why the robot cannot follow it; empty if it can.

    Args:
        robot: robot that walks.
        gait: the gait before the change.
        name: name of the field.
        value: value of the field, in SI units.
    """
    try:
        gait_variant = gait.with_numbers(**{name: value})
        check_limits(robot, gait_variant)
    except (InvalidDesign, NotConverged, OutsideLimits) as error:
        return gait, str(error)
    return gait_variant, ""
