import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from suchus.design import value_at
from suchus.errors import InvalidDesign
from suchus.experiments import EXPERIMENTS, sensitivity
from suchus.gaits import GAITS
from suchus.land import LOST, lost, simulate
from suchus.metrics import displacement
from suchus.paper import CLAIMS
from suchus.robots import ROBOTS
from suchus.study.answers import quantities

FULL = EXPERIMENTS["sensitivity"]
# four samples, of which some cannot walk, in two parts, and one of them again
SMALL = replace(FULL.quick(), samples=4, chunk=2, halved=1)


@pytest.fixture(scope="module")
def outcome():
    return FULL.quick().run()


def test_the_full_sweep_is_as_large_as_asked_and_stays_out_of_reproduce():
    assert FULL.samples >= 512
    assert not FULL.in_reproduce
    assert 1.0 + FULL.cycles * FULL.gait.period == pytest.approx(9.0)
    assert FULL.quick().parts is None


def test_every_chosen_number_but_the_limits_is_free(outcome):
    free = set(outcome.record.parameter.values)
    for of, shelf, name in (("robot", ROBOTS, "caiman"), ("gait", GAITS, "belly_crawl")):
        for one in shelf.beside(name, "chosen", ()):
            assert (f"{of}.{one.field}" in free) == ("_range[" not in one.field)


def test_samples_fill_the_ranges_and_more_of_them_only_add():
    free = (*FULL._chosen()[0], *FULL._chosen()[1])
    few, many = (replace(FULL, samples=n)._points(free) for n in (64, 256))
    assert np.array_equal(many[:64], few)
    low, high = (np.array([getattr(one, end) for one in free]) for end in ("low", "high"))
    share = (many - low) / (high - low)
    assert share.min() >= 0.0
    assert share.max() <= 1.0
    assert np.allclose(share.mean(axis=0), 0.5, atol=0.01)
    assert np.allclose(np.quantile(share, 0.25, axis=0), 0.25, atol=0.02)
    assert not np.array_equal(replace(FULL, samples=64, seed=1)._points(free), few)


def test_a_sample_is_the_robot_and_the_gait_that_its_point_says():
    of_robot, of_gait = FULL._chosen()
    points = FULL._points((*of_robot, *of_gait))
    walking = next(runs for point in points if (runs := _runs(point)))
    point = next(point for point in points if _runs(point))
    run, limbs = walking[0], walking[len(LOST) + 1]
    assert all(value_at(run.robot, one.field) == value for one, value in zip(of_robot, point, strict=False))
    assert all(
        value_at(run.gait, one.field) == value for one, value in zip(of_gait, point[len(of_robot) :], strict=True)
    )
    assert limbs.gait.stroke == run.gait.stroke
    assert limbs.gait.trunk_bend == 0.0
    assert limbs.robot == run.robot
    assert [run.faults for run in walking[1:5]] == [lost(run.robot, run.gait, joint, "limp") for joint in LOST]


def _runs(point):
    try:
        return FULL._runs(point)
    except ValueError:
        return []


def test_a_batch_of_many_robots_measures_what_each_does_alone(outcome):
    quick, record = FULL.quick(), outcome.record
    points = quick._points((*quick._chosen()[0], *quick._chosen()[1]))
    i = int(np.flatnonzero(record.status == "walked")[0])
    runs = quick._runs(points[i])
    for state in (0, 2, 7):
        alone = simulate([runs[state]], duration=1.0 + quick.gait.period, timestep=quick.timestep)
        way = displacement(alone).sel(xyz="x").item()
        assert way == record.forward.isel(sample=i).values.ravel()[state]


def test_what_cannot_walk_is_counted(outcome):
    count = {name: m.value for name, m in outcome.measures.items() if name.startswith("samples_")}
    assert sum(count.values()) == FULL.quick().samples
    assert 0 < count["samples_walked"] < FULL.quick().samples
    walked = outcome.record.status == "walked"
    assert np.all(np.isfinite(outcome.record.forward.values[walked]))
    assert np.all(np.isnan(outcome.record.forward.values[outcome.record.status == "outside limits"]))


def test_a_sample_that_comes_apart_is_counted_and_the_rest_is_kept(monkeypatch):
    def falling_apart(runs, **options):
        record = simulate(runs, **options)
        record.cause[3] = "a speed of 2e3 was reached"
        record.centre_of_mass[3, 20:] = np.nan
        return record

    monkeypatch.setattr(sensitivity, "simulate", falling_apart)
    record = replace(SMALL, halved=0).run().record
    assert list(record.status.values).count("came apart") >= 1
    first = record.sel(sample=record.status == "came apart").isel(sample=0)
    assert int(np.isnan(first.forward).sum()) == 1


def test_an_interrupted_sweep_goes_on_where_it_stopped_and_ends_the_same(tmp_path, monkeypatch):
    calls = []

    def counting(runs, **options):
        if len(calls) == 1 and stops:
            raise KeyboardInterrupt
        calls.append(len(runs))
        return simulate(runs, **options)

    monkeypatch.setattr(sensitivity, "simulate", counting)
    stops = True
    with pytest.raises(KeyboardInterrupt):
        replace(SMALL, parts=tmp_path / "resumed").run()
    stops = False
    resumed = replace(SMALL, parts=tmp_path / "resumed").run()
    in_two = len(calls)
    calls.clear()
    whole = replace(SMALL, parts=tmp_path / "whole").run()
    assert in_two == len(calls)  # nothing was done twice
    calls.clear()
    again = replace(SMALL, parts=tmp_path / "whole").run()
    assert calls == []
    kept_nothing = SMALL.run()
    for other in (resumed, again, kept_nothing):
        assert _exact(other) == _exact(whole)
        assert other.tables == whole.tables


def _exact(outcome):
    values = {
        name: measure.value.hex() if isinstance(measure.value, float) else measure.value
        for name, measure in outcome.measures.items()
    }
    return (
        values,
        {
            str(name): values.values.tobytes()
            for name, values in outcome.record.variables.items()
            if values.dtype.kind != "U"
        },
        outcome.record.status.values.tolist(),
    )


def made_up(ways):
    """Return a record in which the ways forward are given per arm and state."""
    forward = xr.DataArray(
        np.array(ways, dtype=float)[None],
        dims=("sample", "arm", "state"),
        coords={"arm": ["coordinated", "limbs_only"], "state": ["intact", *LOST]},
    )
    return forward, forward * 0 + 0.001


def numbers(ways, least=0.05):
    found = quantities(*made_up(ways), least)
    return {key: (float(number[0]), bool(holds[0])) for key, (number, holds) in found.items()}


def test_the_articles_own_numbers_make_its_sentences_true():
    way = {arm: CLAIMS[f"displacement_{arm}"].value for arm in ("coordinated", "limbs_only")}
    whole = way["coordinated"]
    ways = [
        [way[arm], *(whole * (1 + CLAIMS[f"fault_{joint}_{arm}"].value) for joint in LOST)]
        for arm in ("coordinated", "limbs_only")
    ]
    found = numbers(ways)
    for key, (number, holds) in found.items():
        if key in ("com_fluctuation", "fault_tolerance"):
            continue
        assert holds, key
        assert number == pytest.approx(CLAIMS[key].value, abs=1e-9), key
    # against its own intact robot of limbs only, the article's spine bears one fault of four better: the front yaw's
    # loss is 22 against 9 %, the hind yaw's 17 % against a gain, the pitch joints' a draw and 0 against a gain
    assert found["fault_tolerance"] == (0.0, False)


def test_a_robot_that_hardly_moves_has_nothing_to_lose():
    found = numbers([[0.02, 0.0, 0.0, 0.0, 0.0], [0.005, 0.0, 0.0, 0.0, 0.0]])
    assert np.isnan(found["fault_front_yaw_coordinated"][0])
    assert np.isnan(found["displacement_ratio"][0])
    assert np.isnan(found["fault_tolerance"][0])
    assert found["displacement_coordinated"] == (0.02, True)


def test_backwards_is_not_forward_and_keeps_nothing():
    found = numbers([[-0.3, 0.1, 0.1, 0.1, 0.1], [0.2, 0.1, 0.1, 0.1, -0.1]])
    assert found["displacement_coordinated"][1] is False
    found = numbers([[0.7, 0.6, 0.6, -0.1, 0.5], [0.2, 0.1, 0.1, -0.1, 0.1]])
    assert found["fault_tolerance"] == (0.75, True)


def test_shares_in_the_table_are_those_of_the_measures(outcome):
    rows = {row["claim"]: row for row in csv.DictReader(io.StringIO(outcome.tables["sensitivity.csv"]))}
    assert list(rows) == list(outcome.record.claim.values)
    for key, row in rows.items():
        assert float(row["true_share"]) == pytest.approx(outcome.measures[f"share_{key}"].value, abs=6e-4)
        assert int(row["samples"]) == outcome.measures[f"told_{key}"].value


def test_there_is_a_picture_per_claim(outcome):
    assert set(FULL.draw(outcome)) == {f"sensitivity_{key}" for key in outcome.record.claim.values}


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("samples", 500, ["power of two", "512"]),
        ("samples", 0, ["samples", "2 to"]),
        ("chunk", 0, ["chunk"]),
        ("cycles", 0, ["cycles"]),
    ],
)
def test_bad_numbers_are_refused_in_a_sentence(field, value, words):
    with pytest.raises(InvalidDesign) as caught:
        replace(FULL, **{field: value})
    assert all(word in str(caught.value) for word in words)


def test_the_users_folder_is_understood(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    assert FULL.parts is not None
    assert Path(FULL.parts).expanduser().is_relative_to(tmp_path)
