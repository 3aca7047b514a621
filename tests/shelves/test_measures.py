"""What holds for every measure on the shelf."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.core.sources import snake
from suchus.experiments.study.measures import MEASURES, _of_each_run, measured, unit_of
from suchus.sim.land import Run, simulate


@pytest.fixture(params=list(MEASURES))
def name(request):
    return request.param


@pytest.fixture(scope="module")
def record(robot, crawl_gait):
    runs = [Run(robot=robot, gait=replace(crawl_gait, period=4.0 - i), noise=0.01, seed=i) for i in range(3)]
    return simulate(runs, duration=2.0, timestep=0.01)


def test_it_is_called_as_its_function_and_says_its_unit(name):
    assert snake(MEASURES[name].__name__) == name
    assert unit_of(name)


def test_it_gives_each_run_its_numbers_in_columns_of_its_name(name, record):
    rows = measured(record, (name,))
    assert len(rows) == 3
    assert all(row and all(column.startswith(name) for column in row) for row in rows)
    assert all(isinstance(value, float) for row in rows for value in row.values())


def test_it_gives_a_run_the_same_bytes_in_company_as_alone(name, record):
    together = MEASURES[name](record)
    for i in range(3):
        assert together.isel(run=i).values.tobytes() == MEASURES[name](record.isel(run=i)).values.tobytes()


def test_it_leaves_the_record_as_it_was(name, record):
    before = record.copy(deep=True)
    MEASURES[name](record)
    assert before.identical(record)


@pytest.mark.parametrize(
    ("array", "words"),
    [
        (3.0, "returns 3.0;"),
        (xr.DataArray(np.zeros(2), dims="time"), "returns the dimensions time;"),
        (xr.DataArray(np.zeros((2, 2)), dims=("run", "time")), "returns the dimensions run, time;"),
    ],
)
def test_what_is_no_number_of_each_run_is_refused_in_a_sentence(array, words):
    with pytest.raises(InvalidDesign, match=rf"the measure mine {words} an xarray.DataArray with the dimension run"):
        _of_each_run("mine", array)
