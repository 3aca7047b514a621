"""What a run stood on stands in its record."""

import json

import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import IncompatibleRecord
from suchus.core.files import load, save
from suchus.robot.design.ground import CELL, HALF_WIDTH, REACH, Bumps, Ground, Step, Stone
from suchus.sim.land import VACUUM, Run, simulate
from suchus.sim.record import ground_of, ground_text

SLOPES, HEIGHTS, ALONG = st.floats(-1.0, 1.0), st.floats(0.001, 0.5), st.floats(*REACH)
RELIEFS = st.one_of(
    st.none(),
    st.builds(Step, at=ALONG, height=HEIGHTS),
    st.builds(
        Stone, at=ALONG, aside=st.floats(-HALF_WIDTH, HALF_WIDTH), height=HEIGHTS,
        length=st.floats(0.005, 1.0), width=st.floats(0.005, 1.0),
    ),
    st.builds(
        Bumps, height=HEIGHTS, correlation=st.floats(CELL, 1.0), start=ALONG, seed=st.integers(0, 2**32 - 1)
    ),
)  # fmt: skip
GROUNDS = st.builds(Ground, friction_scale=st.floats(0.01, 10.0), uphill=SLOPES, sideways=SLOPES, relief=RELIEFS)


@given(GROUNDS)
def test_every_ground_comes_back_to_the_last_bit(ground):
    assert ground_of(xr.Dataset({"stands_on": ((), ground_text(ground))})) == ground


def test_records_keep_the_key_of_the_friction_scale():
    assert '"grip": 0.5' in ground_text(Ground(friction_scale=0.5))


def test_each_run_tells_its_own_ground_and_a_floating_one_none(robot, crawl_gait, tmp_path):
    grounds = (Ground(uphill=0.1, friction_scale=0.7), Ground(relief=Step(at=0.66, height=0.02)))
    runs = [Run(robot=robot, gait=crawl_gait, ground=ground) for ground in grounds]
    runs.append(Run(robot=robot, gait=crawl_gait, afloat=VACUUM))
    record = load(save(simulate(runs, duration=0.02, timestep=0.01), tmp_path / "r.nc"))
    assert [ground_of(record.isel(run=i)) for i in range(3)] == [*grounds, None]


def test_records_of_before_have_none():
    assert ground_of(xr.Dataset()) is None


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        json.dumps({"grip": 1.0, "uphill": 9.0, "sideways": 0.0, "relief": None}),
        json.dumps({"grip": 1.0, "uphill": 0.0, "sideways": 0.0, "relief": {"kind": "sea"}}),
        json.dumps({"grip": 1.0, "uphill": 0.0, "sideways": 0.0, "relief": {"kind": "step", "at": "x", "height": 1}}),
        json.dumps({"grip": 1.0, "depth": 0.0, "relief": None}),
    ],
)
def test_a_ground_that_makes_no_sense_is_told_in_a_sentence(text):
    with pytest.raises(IncompatibleRecord, match="no ground that this suchus knows"):
        ground_of(xr.Dataset({"stands_on": ((), text)}))
