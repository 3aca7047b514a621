"""What the experiments on lost joints and on the tail measure, on records whose answers are known exactly."""

import numpy as np
import pytest
import xarray as xr

from suchus.article.verdict import measure_with_interval
from suchus.experiments.claims import RULES
from suchus.sim.metrics import swing_height, swing_lift, swing_unloaded, tail_joint_spread

TIME = np.arange(0, 901) * 0.01
LEGS = ["LF", "RF", "LH", "RH"]


def crawl(height=0.08, load=5.0) -> xr.Dataset:
    """Return a record whose RH swings in the first half of each cycle of four seconds."""
    n = len(TIME)
    phase = np.stack([TIME / 4.0 - 0.25] * 4, axis=-1)
    place = np.zeros((n, 3))
    place[:, 2] = height
    force = np.zeros((n, 4, 3))
    force[..., 2] = np.broadcast_to(np.asarray(load), (4, n)).T
    return xr.Dataset(
        {
            "centre_of_mass": (("time", "xyz"), place),
            "foot_position": (("time", "leg", "xyz"), np.zeros((n, 4, 3))),
            "foot_force": (("time", "leg", "xyz"), force),
            "limb_phase": (("time", "leg"), phase),
            "mass": ((), 3.5),
            "period": ((), 4.0),
            "duty_factor": ((), 0.5),
        },
        coords={"time": TIME, "xyz": list("xyz"), "leg": LEGS},
    )


def swinging() -> np.ndarray:
    return np.mod(TIME / 4.0 - 0.25, 1.0) < 0.5


def test_height_counts_in_the_swing_only():
    record = crawl(height=np.where(swinging(), 0.09, 0.05))
    assert float(swing_height(record, "RH")) == pytest.approx(0.09)
    assert float(swing_height(crawl(height=0.07), "RH")) == pytest.approx(0.07)


def test_a_foot_is_free_where_it_bears_no_load_in_its_swing():
    assert float(swing_unloaded(crawl(load=5.0), "RH")) == 0.0
    freed = float(swing_unloaded(crawl(load=np.where(swinging(), 0.0, 5.0)), "RH"))
    assert freed == pytest.approx(1.0, abs=0.003)  # the last sample alone is no swing
    assert float(swing_unloaded(crawl(load=np.where(swinging(), 5.0, 0.0)), "RH")) == 0.0  # free in stance alone
    late = swinging() & (np.mod(TIME / 4.0 - 0.25, 1.0) >= 0.25)
    assert float(swing_unloaded(crawl(load=np.where(late, 0.0, 5.0)), "RH")) == pytest.approx(0.5, abs=0.01)
    assert float(swing_lift(crawl(), "RH")) == 0.0


def test_the_spread_of_the_tail_is_that_of_its_cable_joints_at_one_time():
    angles = xr.DataArray(
        [[0.1, 0.3, 9.0], [0.2, -0.2, 9.0], [0.5, 0.5, -9.0]],
        dims=("time", "joint"),
        coords={"joint": ["tail_yaw_1", "tail_yaw_2", "tail_pitch"], "time": [0.0, 1.0, 2.0]},
    )
    spread = tail_joint_spread(angles, ["tail_yaw_1", "tail_yaw_2"])
    assert spread.values == pytest.approx([0.2, 0.4, 0.0])
    assert spread.attrs["units"] == "rad"
    assert float(tail_joint_spread(angles, ["tail_yaw_1"]).max()) == 0.0


def test_a_sentence_is_true_within_the_bounds_of_its_rule():
    for claim in (claim for claim in RULES if claim.startswith("fault_") and claim not in OTHERS):
        (measure,) = {clause.measure for clause in RULES[claim].holds}
        assert measure == RULES[claim].measure  # a change of displacement alone decides
    rule = RULES["fault_hind_pitch_limbs_only"]
    assert [rule.held(measure_with_interval(rule.measure, x, x)) for x in (-0.39, -0.41, -0.69, -0.71)] == [
        False,
        True,
        True,
        False,
    ]


OTHERS = ("fault_support", "fault_tolerance")
