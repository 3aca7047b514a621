"""A push: a force from outside, for a while."""

from collections.abc import Sequence
from dataclasses import dataclass

from suchus.design import AnyRobot
from suchus.design.checks import Checks
from suchus.errors import InvalidDesign, UnknownName
from suchus.model import compile_model

MOST = 1e4  # [N]; a slip of the keyboard, not a push


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
    """A constant force on the centre of mass of one body.

    It is applied at every physics step; a control period that it covers in part gets a part of the force, so that
    the impulse is force times duration whatever the times.
    """

    force: tuple[float, float, float]
    """Force in the world frame: forward, left, up [N]."""
    at: float
    """Time at which the push begins [s]."""
    duration: float = 0.2
    """Duration of the push [s]."""
    body: str = "thorax"
    """Name of the body that is pushed, as ``pelvis``, ``thorax``, ``LF_tibia`` or ``tail_root``."""

    def __post_init__(self) -> None:
        with Checks("push", self) as check:
            check.each("force", ("x", "y", "z"), -MOST, MOST, "N")
            check.number("at", 0.0, 86400.0, "s")
            check.number("duration", 1e-3, 86400.0, "s")

    def share(self, start: float, end: float) -> float:
        """Return how much of the time from ``start`` to ``end`` the push lasts, 0 to 1 [-]."""
        overlap = min(end, self.at + self.duration) - max(start, self.at)
        return max(overlap, 0.0) / (end - start)


def check_pushes(pushes: Sequence[Push], robot: AnyRobot, duration: float) -> None:
    """Refuse pushes that cannot happen.

    Raises:
        UnknownName: the robot has no such body.
        InvalidDesign: a push does not end within the run.
    """
    if not pushes:
        return
    model = compile_model(robot)
    bodies = [model.body(i).name for i in range(1, model.nbody)]
    for push in pushes:
        if push.body not in bodies:
            raise UnknownName("body", push.body, bodies)
        if push.at + push.duration > duration + 1e-9:
            raise InvalidDesign(
                f"a push from {push.at:g} to {push.at + push.duration:g} s does not fit into a run of {duration:g} s: "
                "push earlier or shorter, or run longer."
            )
