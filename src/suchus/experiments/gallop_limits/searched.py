"""A gait that a search found, with a trunk that bends up and down."""

from dataclasses import dataclass, replace

from suchus.design.checks import Checks
from suchus.gaits.belly_crawl import LIMBS
from suchus.motion import Bend, Gait, GaitInMetres, as_table
from suchus.robots import ROBOTS

_SAMPLES = 32  # of a cycle, with which the gaits were searched


@dataclass(frozen=True, slots=True, kw_only=True)
class Searched:
    """A gait that a search found for one kind of servo."""

    servo_speed: float
    """No-load speed of the servos with which it was searched [rad/s]."""
    gait: Gait
    """The gait."""

    def __post_init__(self) -> None:
        with Checks("searched", self) as check:
            check.number("servo_speed", 0.1, 1e3, "rad/s")


def galloping(gait: GaitInMetres, *, mean: float, amplitude: float, down: float) -> Gait:
    """Return a gait whose trunk bends up and down besides, the other joints as smooth curves as in the search.

    Args:
        gait: in metres of the article's robot.
        mean: vertical bend of the trunk, down positive [rad].
        amplitude: of that bend [rad].
        down: when in the cycle the trunk is bent down most [cycle].
    """
    lag = down + 0.5 - (0.75 - gait.duty_factor / 2)  # the phase of the axis counts from before mid-stance
    vertical = Bend(part="trunk", turn="pitch", amplitude=(amplitude,), lag=(lag,), offset=mean)
    # in a bound the pulls of left and right cancel in the article's law, and the trunk follows the gait's own phases
    curves = as_table(ROBOTS["caiman"], gait.gait(LIMBS), _SAMPLES)
    return replace(curves, axis=(vertical,), coupling=() if amplitude else curves.coupling)
