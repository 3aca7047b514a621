import numpy as np
import pytest
from tests.metres import limb_phase
from tests.start_batch import start_batch

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.control import Control, OpenLoop
from suchus.robot.gaits import default_gait
from suchus.robot.motion import as_table, cycle_targets, intended
from suchus.robot.robots import ROBOTS


def test_the_table_is_the_gait_at_every_tick(robot, crawl_gait, limbs_gait):
    gaits = [crawl_gait, limbs_gait, crawl_gait]
    controller = start_batch(OpenLoop(), [robot] * 3, gaits, [0, 0, 0], 501, 0.01)
    for tick in (0, 100, 333, 500):
        command = controller.command(tick, None)
        for i, gait in enumerate(gaits):
            phase = limb_phase(gait, np.array(tick * 0.01))
            assert command.phase[i] == pytest.approx(phase, abs=1e-12)
            assert command.targets[i] == pytest.approx(intended(robot, gait, np.array(tick * 0.01)).targets, abs=1e-12)
    assert (controller.rest() == controller.command(0, None).targets).all()


def test_open_loop_is_a_control_and_equal_to_itself():
    assert isinstance(OpenLoop(), Control)
    assert OpenLoop() == OpenLoop()
    assert not OpenLoop().feels


@pytest.mark.parametrize("name", ["caiman", "strider", "swimmer"])
def test_strokes_and_bends_grow_over_the_ramp_and_then_the_gait_is_as_it_was(name):
    robot = ROBOTS[name]
    gait = default_gait(robot)
    grows, full = (start_batch(OpenLoop(begin=0.5, ramp=ramp), [robot], [gait], [0], 1001, 0.01) for ramp in (2.0, 0.0))
    still = cycle_targets(robot, gait, np.zeros(1), np.zeros(1))
    assert (grows.command(20, None).targets == still).all()
    half = cycle_targets(robot, gait, np.array([1.0 / gait.period]), np.array([0.5]))
    assert grows.command(150, None).targets == pytest.approx(half, abs=1e-12)  # 3/4 - 2/8 = 1/2
    for tick in (250, 700):
        assert grows.command(tick, None).targets == pytest.approx(full.command(tick, None).targets, abs=1e-12)
        assert (grows.command(tick, None).phase == full.command(tick, None).phase).all()
    if name == "swimmer":  # nothing but bends: half the size is half of every angle
        assert 2 * grows.command(150, None).targets == pytest.approx(full.command(150, None).targets, abs=1e-12)
        assert np.abs(full.command(150, None).targets).max() > 0.1


def test_runs_with_other_ramps_share_a_batch(robot, crawl_gait):
    controls = [OpenLoop(), OpenLoop(begin=0.0, ramp=1.0)]
    both = start_batch(controls, [robot] * 2, [crawl_gait] * 2, [0, 0], 301, 0.01)
    for i, control in enumerate(controls):
        alone = start_batch(control, [robot], [crawl_gait], [0], 301, 0.01)
        for tick in (0, 60, 300):
            assert (both.command(tick, None).targets[i] == alone.command(tick, None).targets[0]).all()


def test_what_cannot_grow_and_impossible_times_are_refused(robot, crawl_gait):
    table = as_table(robot, crawl_gait)
    start_batch(OpenLoop(), [robot], [table], [0], 10, 0.01)
    with pytest.raises(OutsideLimits, match=r"a ramp over which strokes and bends grow needs a gait of foot paths"):
        start_batch(OpenLoop(ramp=1.0), [robot], [table], [0], 10, 0.01)
    with pytest.raises(InvalidDesign, match=r"open_loop.ramp is -1 s; 0 to 86400 s is allowed"):
        OpenLoop(ramp=-1.0)
