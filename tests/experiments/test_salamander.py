"""The animal's walk on its model: what the measures mean, and the prototype's numbers."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.salamander.animal_walk import ANIMAL, PARTS, step
from suchus.robot.robots import ROBOTS


def force(vertical, **others):
    rows = [np.asarray(others.get(name, np.zeros(len(vertical)))) if name != "vertical" else vertical for name in PARTS]
    return xr.DataArray(np.array(rows, dtype=float).T, dims=("phase", "part"), coords={"part": list(PARTS)})


def test_a_step_is_read_from_the_stance_around_its_peak():
    one = step(force([0.0, 0.2, 0.3, 0.6, 0.2, 0.0, 0.2, 0.0], foreaft=[0, 0, 0, 0.8, 0, 0, 0, 0]), 0.15)
    assert one.net == pytest.approx(1.0)
    assert one.parts == pytest.approx({"vertical": 0.6, "sideways": 0.0, "foreaft": 0.8})
    assert one.time == pytest.approx(2 / 4)
    assert one.stance == pytest.approx(4 / 8)


def test_a_stance_may_go_over_the_end_of_the_cycle():
    one = step(force([0.5, 0.3, 0.0, 0.0, 0.3]), 0.15)
    assert (one.time, one.stance) == pytest.approx((1 / 3, 3 / 5))


def test_a_foot_that_never_leaves_the_ground_stands_all_the_cycle():
    assert step(force([0.3, 0.4, 0.3]), 0.15).stance == 1.0


@pytest.mark.parametrize(("gap", "stance"), [(3, 0.5), (4, 0.2)])
@pytest.mark.parametrize("peak", [10, 36])
def test_only_a_gap_of_a_twenty_fifth_of_the_cycle_ends_a_stance(gap, stance, peak):
    vertical = np.zeros(100)
    vertical[:20] = vertical[20 + gap : 50] = 0.3  # before and after the gap the foot stands
    vertical[peak] = 0.6
    expected = stance if gap == 3 or peak == 10 else (30 - gap) / 100
    assert step(force(np.roll(vertical, 60)), 0.15).stance == pytest.approx(expected)


@pytest.fixture(scope="module")
def outcome():
    return replace(EXPERIMENTS["salamander"].quick(), settle=2).run()


def test_it_walks_as_the_prototype_did(outcome):
    """After the prototype of the same model: stride 0.250 L, 0.245 to 0.275 over its passive joints' range."""
    m = {name: one.value for name, one in outcome.measures.items()}
    assert m["standing_index_commanded"] == pytest.approx(ANIMAL["standing_index_walk"].value, abs=0.02)
    assert m["standing_index_commanded"] == pytest.approx(0.906, abs=0.002)
    assert 0.245 <= m["stride_walk"] <= 0.275
    assert m["stride_straight_axis"] < 0.5 * m["stride_walk"]
    assert m["angle_missed"] < np.radians(2.0)
    assert abs(m["turn_per_cycle"]) < np.radians(2.0)
    assert m["foot_force_peak_fore"] == pytest.approx(0.415, rel=0.1)


def test_the_forces_balance_the_weight(outcome):
    record = outcome.record.isel(run=0)
    up = record.foot_force.sum("leg") + record.belly_force.sum("segment") + record.tail_force
    part = up.sel(xyz="z", time=slice(outcome.record.attrs["measured_from"], None))
    assert float(part.mean()) == pytest.approx(9.81 * float(record.mass), rel=0.02)


def test_it_is_drawn_and_said_beside_the_animal(outcome):
    figures = EXPERIMENTS["salamander"].draw(outcome)
    assert sorted(figures) == ["foot_forces", "joint_angles"]
    assert sum(ax.get_visible() for ax in figures["joint_angles"].axes) == 24
    rows = outcome.tables["beside_the_animal.csv"].splitlines()
    assert len(rows) == 1 + len(ANIMAL)
    assert "0.46 ± 0.06" in outcome.decides


def test_other_robots_and_settings_are_refused():
    with pytest.raises(UnsuitedRobot, match="needs the joints of the robot 'salamander'; robot 'strider' lacks that"):
        replace(EXPERIMENTS["salamander"].quick(), robot=ROBOTS["strider"]).run()
    with pytest.raises(InvalidDesign, match="loaded is 0"):
        replace(EXPERIMENTS["salamander"], loaded=0.0)
