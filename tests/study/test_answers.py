"""Which parameters decide, on quantities whose answer is known; measures in company and alone."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import Unwritable
from suchus.experiments.study import Arm, Claims, Plan, Study, Vary, conduct
from suchus.experiments.study.answers import agreement, first_order, share_interval
from suchus.sim.land import Run


@pytest.fixture(scope="module")
def points():
    return np.random.default_rng(0).random((2000, 4))


def test_one_that_decides_everything_has_all_of_the_variance(points):
    index = first_order(points, np.exp(5 * points[:, 1]))
    assert index.variance_fraction[1] == pytest.approx(
        1 - 1 / 64, abs=0.01
    )  # eight bins leave an eighth of an eighth within
    assert abs(index.variance_fraction[[0, 2, 3]]).max() < 0.02
    assert (index.low[[0, 2, 3]] <= 0.005).all()
    assert index.low[1] > 0.9


def test_a_sum_is_shared_and_a_valley_is_seen(points):
    both = first_order(points, points[:, 0] + points[:, 2])
    assert both.variance_fraction[[0, 2]] == pytest.approx([0.5, 0.5], abs=0.06)
    valley = first_order(points, abs(points[:, 3] - 0.5))
    assert valley.variance_fraction[3] > 0.9  # where a rank correlation is about zero
    assert both.low[0] < both.variance_fraction[0] < both.high[0]


def test_nothing_decides_what_never_changes_or_was_seen_too_rarely(points):
    assert first_order(points, np.ones(2000)).variance_fraction.tolist() == [0.0] * 4
    assert first_order(points[:20], points[:20, 0]).variance_fraction.tolist() == [0.0] * 4


def test_intervals_of_shares_are_wilsons():
    assert share_interval(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)
    assert share_interval(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)
    assert np.isnan(share_interval(0, 0)).all()


def test_answers_that_differ_in_one_of_four_agree_in_three():
    one = xr.Dataset(
        {
            "number": (("claim", "sample"), [[1.0, 2.0], [3.0, np.nan]]),
            "holds": (("claim", "sample"), [[True, True], [True, False]]),
            "displacement_x": ("sample", [0.5, 0.6]),
        },
        coords={"claim": ["near", "far"]},
    )
    other = one.assign(
        holds=(("claim", "sample"), [[True, False], [True, True]]), displacement_x=("sample", [0.5, 0.7])
    )
    told = agreement(one, other)
    assert told.same == pytest.approx(2 / 3)  # the one that cannot be told does not count
    assert told.forward == pytest.approx(0.05)
    assert (told.shares, told.claim) == (pytest.approx(0.5), "near")
    assert told.chance == 1.0


def test_a_claim_that_always_turns_the_same_way_is_no_chance():
    number, never = np.ones((2, 12)), np.zeros((2, 12), dtype=bool)
    one = xr.Dataset(
        {"number": (("claim", "sample"), number), "holds": (("claim", "sample"), never)}, coords={"claim": ["a", "b"]}
    ).assign(displacement_x=("sample", np.zeros(12)))
    often = never.copy()
    often[1, :7] = True
    told = agreement(one.assign(holds=(("claim", "sample"), often)), one)
    assert told.chance == pytest.approx(2 * 2 / 2**7)  # seven of seven, either way, two claims
    assert told.claim == "b"


def test_an_arm_wins_over_what_varies_and_every_point_has_each(robot, crawl_gait):
    asked = Study(
        name="arms",
        run=Run(robot=robot, gait=crawl_gait),
        vary=(Vary(field="gait.trunk_bend", values=(0.5, 1.0)), Vary(field="gait.stroke", values=(0.01, 0.02))),
        measure=("displacement",),
        arms=(Arm(name="free"), Arm(name="straight", values={"gait.trunk_bend": 0.0})),
    )
    plan = Plan(asked)
    assert len(plan) == 8
    bends = [(p.arm.name, plan.run(i).gait.number("trunk_bend")) for i, p in enumerate(plan)]
    assert {b for name, b in bends if name == "straight"} == {0.0}
    assert sorted(b for name, b in bends if name == "free") == [0.5, 0.5, 1.0, 1.0]


def test_the_claims_are_asked_of_every_number_but_the_joint_limits():
    study = Claims().study(2048, 0.01)
    assert len(Plan(study)) == 2048 * 14
    assert len(study.vary) == 109
    assert not any("range[" in v.field for v in study.vary)
    few, many = Plan(Claims().study(4, 0.01)), Plan(study)
    assert [dict(p.values) for p in few] == [dict(p.values) for p in many[:56]]


def test_a_full_disk_is_a_sentence_and_what_was_finished_is_kept(robot, crawl_gait, tmp_path, monkeypatch):
    asked = Study(
        name="full",
        run=Run(robot=robot, gait=crawl_gait),
        vary=(Vary(field="gait.stroke", values=(0.01, 0.02)),),
        measure=("displacement",),
        chunk=1,
        duration=1.1,
        timestep=0.01,
    )
    write = Path.write_bytes

    def full(path, data):
        if path.name == "000001.nc":
            raise OSError(28, "No space left on device")
        return write(path, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(Unwritable, match="no space left on device"):
        conduct(asked, tmp_path / "s")
    monkeypatch.undo()
    assert [p.name for p in (tmp_path / "s" / "parts").iterdir()] == ["000000.nc"]
    assert conduct(asked, tmp_path / "s").sizes["sample"] == 2


def test_what_hardly_ever_changes_is_resampled_without_a_warning(points, recwarn):
    index = first_order(points[:100], np.r_[1.0, np.zeros(99)])
    assert np.isfinite([index.variance_fraction, index.low, index.high]).all()
    assert not recwarn.list
