import numpy as np
import pytest
from tests.metres import limb_phase
from tests.start_batch import start_batch

from suchus.control import Control, OpenLoop
from suchus.motion import intended


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
