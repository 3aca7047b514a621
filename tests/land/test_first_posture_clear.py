"""A robot that would begin inside a step, a stone or bumps is refused with a sentence."""

import pytest

from suchus.core.errors import InvalidDesign
from suchus.robot.design.ground import STONE, Bumps, Ground, Relief, Step, Stone
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

_BUMPS = Bumps(height=0.04, correlation=0.06, start=0.42, seed=0)
_STONE_BELOW = Stone(at=0.0, aside=0.0, height=0.1, length=0.2, width=0.1)


def _start(relief: Relief, robot: str = "caiman") -> None:
    body = ROBOTS[robot]
    run = Run(robot=body, gait=default_gait(body), ground=Ground(relief=relief))
    simulate([run], duration=0.02, timestep=0.005, effort=False)


@pytest.mark.parametrize("relief", [Step(at=0.6, height=0.05), STONE, _BUMPS])
def test_a_relief_ahead_of_the_robot_is_allowed(relief):
    _start(relief)


@pytest.mark.parametrize(
    ("relief", "pattern"),
    [
        (Step(at=0.1, height=0.05), r"inside the step: \w+ overlaps it by 28 mm; step.at is 0.1 m .* ahead of it\."),
        (_STONE_BELOW, r"inside the stone: \w+ overlaps it by 42 mm; stone.at is 0 m .* ahead of it, or behind it\."),
        (Bumps(height=0.04, correlation=0.06, start=-0.5, seed=0), r"inside the bumps: .*; bumps.start is -0.5 m"),
    ],
)
def test_a_relief_below_the_robot_is_refused(relief, pattern):
    with pytest.raises(InvalidDesign, match=pattern):
        _start(relief)


def test_a_foreign_body_is_refused_by_its_own_name():
    with pytest.raises(InvalidDesign, match="robot 'strider' begins inside the step"):
        _start(Step(at=0.0, height=0.05), robot="strider")


def test_the_position_that_the_sentence_names_is_allowed():
    with pytest.raises(InvalidDesign) as refusal:
        _start(Step(at=0.1, height=0.05))
    reach = float(str(refusal.value).partition("the robot reaches to ")[2].partition(" m")[0])
    _start(Step(at=reach + 1e-3, height=0.05))
