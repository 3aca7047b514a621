import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign
from suchus.robot.design.ground import CELL, HALF_WIDTH, REACH, Bumps, Step, Stone, field, heights, profile
from suchus.sim.model import compile_model

STEP = Step(at=0.7, height=0.03)
STONE = Stone(at=0.75, aside=0.0, height=0.05, length=0.06, width=0.05)
BUMPS = Bumps(height=0.04, correlation=0.06, start=0.42, seed=3)


def heights_in_mujoco(robot, relief, xs, ys):
    """What a ray from above meets."""
    model = compile_model(robot, 0.002, relief)
    data = mujoco.MjData(model)
    data.qpos[2] = 50.0  # out of the way
    mujoco.mj_kinematics(model, data)
    down, geom = np.array([0.0, 0.0, -1.0]), np.zeros(1, dtype=np.int32)
    return np.array(
        [
            5.0 - mujoco.mj_ray(model, data, np.array([x, y, 5.0]), down, None, 1, -1, geom)
            for x, y in zip(xs, ys, strict=True)
        ]
    )


@pytest.mark.parametrize("relief", [None, STEP, STONE, BUMPS])
def test_the_ground_of_the_model_is_the_ground_of_the_design(robot, relief):
    """A little aside of the points of a height field: a ray along one of its edges slips through."""
    xs = REACH[0] + CELL * np.arange(1, 160) + 1e-4
    assert heights_in_mujoco(robot, relief, xs, np.full(159, 2e-4)) == pytest.approx(profile(relief, xs), abs=3e-4)
    ys = CELL * np.random.default_rng(0).integers(-60, 60, 159) + 2e-4  # beyond the relief too
    assert heights_in_mujoco(robot, relief, xs, ys) == pytest.approx(heights(relief, xs, ys), abs=3e-4)


@settings(max_examples=10)
@given(height=st.floats(0.01, 0.08), seed=st.integers(0, 1000))
def test_bumps_are_as_high_as_they_say_and_begin_where_they_say(height, seed):
    grown = field(Bumps(height=height, correlation=0.06, start=0.42, seed=seed))
    along = REACH[0] + CELL * np.arange(grown.shape[1])
    assert (grown[:, along <= 0.42] == 0).all()
    far = grown[:, along > 0.6]
    low, high = np.quantile(far, [0.02, 0.98])
    assert high - low == pytest.approx(height, rel=0.05)
    assert low == pytest.approx(-high, rel=0.1)


@pytest.mark.parametrize("correlation", [0.06, 0.1, 0.2])
def test_bumps_lose_their_correlation_over_the_length_they_say(correlation):
    """The mean over seeds, where the field has grown; the length is a whole number of cells or between two."""
    shift = correlation / CELL
    found = []
    for seed in range(12):
        grown = field(Bumps(height=0.04, correlation=correlation, start=-1.0, seed=seed))[:, 10:]
        for lag in (int(np.floor(shift)), int(np.ceil(shift))):
            found.append((lag, float((grown[:, lag:] * grown[:, : -lag or None]).mean() / grown.var())))
    lags = sorted({lag for lag, _ in found})
    means = [np.mean([value for lag, value in found if lag == wanted]) for wanted in lags]
    assert float(np.interp(shift, lags, means)) == pytest.approx(np.exp(-1), abs=0.06)


def test_the_same_seed_gives_the_same_bumps_and_another_gives_others():
    again = Bumps(height=0.04, correlation=0.06, start=0.42, seed=3)
    field.cache_clear()
    first = field(BUMPS).copy()
    field.cache_clear()
    assert (field(again) == first).all()
    assert (field(Bumps(height=0.04, correlation=0.06, start=0.42, seed=4)) != first).any()


def test_bumps_span_the_ground_to_both_sides():
    assert field(BUMPS).shape == (round(2 * HALF_WIDTH / CELL) + 1, round((REACH[1] - REACH[0]) / CELL) + 1)


def test_reliefs_of_one_type_share_a_topology(robot):
    for one, other in (
        (STEP, Step(at=0.5, height=0.01)),
        (BUMPS, Bumps(height=0.01, correlation=0.1, start=0, seed=0)),
    ):
        a, b = compile_model(robot, 0.002, one), compile_model(robot, 0.002, other)
        assert (a.ngeom, a.nhfielddata, a.nq, a.nsensordata) == (b.ngeom, b.nhfielddata, b.nq, b.nsensordata)


def test_impossible_reliefs_are_refused():
    with pytest.raises(InvalidDesign, match=r"step\.height is 0 m; 1e-05 to 0\.5 m"):
        Step(at=0.7, height=0.0)
    with pytest.raises(InvalidDesign, match=r"bumps\.seed"):
        Bumps(height=0.04, correlation=0.06, start=0.42, seed=-1)
    with pytest.raises(InvalidDesign, match=r"stone\.width"):
        Stone(at=0.7, aside=0.0, height=0.05, length=0.1, width=float("nan"))
