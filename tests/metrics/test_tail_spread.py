import numpy as np
import pytest
import xarray as xr

from suchus.sim.metrics import tail_joint_spread_max


def test_the_spread_is_the_greatest_between_two_cable_joints_at_one_time():
    angles = np.zeros((5, 4))
    angles[1] = (9.0, 9.0, 0.0, 5.0)  # before the walk, and a joint that no cable turns
    angles[3] = (0.1, -0.3, 0.2, 5.0)
    angles[4] = (0.6, 0.6, 0.5, 5.0)  # bent far, but alike
    record = xr.Dataset(
        {"joint_angle": (("time", "joint"), angles)},
        coords={"time": [0.0, 0.5, 1.0, 1.5, 2.0], "joint": ["tail_yaw_1", "tail_yaw_2", "tail_yaw_3", "tail_pitch"]},
    )
    assert float(tail_joint_spread_max(record)) == pytest.approx(0.5)
    assert float(tail_joint_spread_max(record, start=2.0 - 0.5)) == pytest.approx(0.5)
    assert float(tail_joint_spread_max(record, start=0.0)) == pytest.approx(9.0)
