"""The control group of a gait follows from the gait: the same legs, whatever they are, and a still axis."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.apps.cli.options import choose
from suchus.core.errors import OutsideLimits
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS, control_group, default_gait
from suchus.robot.motion import as_table, cycle_targets, suits
from suchus.robot.robots import ROBOTS

TWO_GROUPS = ("crawl_stability", "displacement", "joint_faults")
CLOCK = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize("name", ["caiman", "strider", "salamander", "salamandra"])
def test_the_control_group_moves_its_limbs_alike_and_its_axis_not_at_all(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    for walked in (gait, gait.strode(0.7), as_table(robot, gait)):
        control = control_group(walked)
        ours, theirs = (cycle_targets(robot, some, CLOCK) for some in (walked, control))
        limbs = sorted({i for limb in layout(robot).limbs for i in range(limb.servos.start, limb.servos.stop)})
        axis = [i for i in range(ours.shape[1]) if i not in limbs]
        assert ours[:, limbs] == pytest.approx(theirs[:, limbs], abs=1e-9)
        assert np.ptp(theirs[:, axis], axis=0).max() < 1e-12 < 0.05 < np.ptp(ours[:, axis], axis=0).max()
        assert suits(robot, control)


def test_that_of_the_crawl_is_the_article_s():
    assert control_group(GAITS["belly_crawl"]) == GAITS["limbs_only"]


@pytest.mark.parametrize("name", TWO_GROUPS)
def test_a_gait_of_the_user_s_is_compared_with_its_own_legs(name, tmp_path):
    gait = replace(GAITS["belly_crawl"].strode(0.8), name="mine", period=3.0)
    question = replace(EXPERIMENTS[name], gait=gait)
    assert question.control_group == replace(gait.without("axis"), name="limbs_only")
    assert question.unjudged().startswith("Not judged: gait is mine")
    assert EXPERIMENTS[name].unjudged() == ""
    (tmp_path / "mine.toml").write_text('base = "belly_crawl"\nname = "mine"\nperiod = 3.0\n')
    told = choose(EXPERIMENTS[name], name, ["--gait", str(tmp_path / "mine.toml")]).experiment
    assert told.control_group.period == 3.0
    assert choose(EXPERIMENTS[name], name, ["--control", "limbs_only"]).experiment.unjudged() == ""


@pytest.mark.parametrize("name", TWO_GROUPS)
def test_a_control_group_with_other_legs_is_refused(name):
    other = replace(GAITS["limbs_only"], period=3.0)
    with pytest.raises(
        OutsideLimits, match=r"'limbs_only' has other legs than gait 'belly_crawl': they differ in period,"
    ):
        replace(EXPERIMENTS[name], control=other)
    tail_up = GAITS["limbs_tail_lifted"]
    assert replace(EXPERIMENTS[name], control=tail_up).control_group is tail_up
    measured = as_table(ROBOTS["caiman"], GAITS["belly_crawl"])
    with pytest.raises(OutsideLimits, match="measured curves of the limbs"):
        control_group(measured, measured.without("limbs"))
