"""A record as CSV says the same as the record; and without suchus, xarray and pandas read both."""

import csv
import warnings

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import Unwritable
from suchus.core.files import save, write_tables
from suchus.core.files.tables import COLUMNS
from suchus.core.writing import MANIFEST
from suchus.sim.land import Run, simulate


@pytest.fixture(scope="module")
def walk(robot, crawl_gait):
    return simulate([Run(robot=robot, gait=crawl_gait), Run(robot=robot, gait=crawl_gait, label="b")], duration=0.05)


def read(file):
    with file.open(newline="") as lines:
        return list(csv.DictReader(lines))


def test_there_is_one_file_for_each_set_of_dimensions_with_units_in_its_header(walk, tmp_path):
    folder = write_tables(walk, tmp_path / "csv")
    sets = {"_".join(map(str, v.dims)) for name, v in walk.variables.items() if name not in walk.dims}
    assert {file.stem for file in folder.glob("*.csv")} == sets | {"columns"}
    header = (folder / "run_time_leg_xyz.csv").read_text().splitlines()[0]
    assert header == "run,time [s],leg,xyz,foot_position [m],foot_roll [m],foot_force [N],limb_force [N]"
    about = {(row["file"], row["column"]): row for row in read(folder / COLUMNS)}
    meaning = about["run_time_leg_xyz.csv", "foot_force [N]"]["meaning"]
    assert meaning == "of the ground on the ball of each foot, in the world"
    assert about["run.csv", "label"]["unit"] == ""


def test_every_number_reads_back_to_the_same_bits(walk, tmp_path):
    rows = read(write_tables(walk, tmp_path / "csv") / "run_time_servo.csv")
    assert len(rows) == 2 * 6 * 19
    for row in rows:
        where = {"run": int(row["run"]), "time": float(row["time [s]"]), "servo": row["servo"]}
        assert float(row["servo_torque [N m]"]) == walk.servo_torque.sel(where).item()


def test_what_is_missing_is_empty_and_orders_of_dimensions_do_not_split_a_file(tmp_path):
    record = xr.Dataset(
        {
            "a": (("x", "y"), [[1.5, np.nan], [2.5, 3.5]], {"units": "m"}),
            "b": (("y", "x"), [["p", "r"], ['q, "r"', "s"]]),
            "one": ((), 0.1 + 0.2, {"units": "s"}),
            "yes": ("x", [True, False]),
        },
        coords={"y": ["left", "right"]},
    )
    folder = write_tables(record, tmp_path / "csv")
    lines = ["x,y,a [m],b", "0,left,1.5,p", '0,right,,"q, ""r"""', "1,left,2.5,r", "1,right,3.5,s"]
    assert (folder / "x_y.csv").read_text().splitlines() == lines
    assert (folder / "single.csv").read_text() == "one [s]\n0.30000000000000004\n"
    assert (folder / "x.csv").read_text() == "x,yes\n0,True\n1,False\n"


def test_more_rows_than_are_written_at_a_time(tmp_path, monkeypatch):
    monkeypatch.setattr("suchus.core.files.tables._ROWS", 7)
    record = xr.Dataset({"a": ("x", np.arange(100.0))}, coords={"x": np.arange(100) * 2})
    rows = read(write_tables(record, tmp_path / "csv") / "x.csv")
    assert [(int(row["x"]), float(row["a"])) for row in rows] == [(2 * i, float(i)) for i in range(100)]


def test_tables_replace_tables_and_nothing_else(walk, tmp_path):
    folder = write_tables(walk, tmp_path / "csv")
    (folder / "notes").touch()
    assert (write_tables(walk, folder) / "notes").exists()
    (folder / MANIFEST).unlink()
    with pytest.raises(Unwritable, match="nothing says that suchus wrote it"):
        write_tables(walk, folder)


def plainly_opened(file):
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "numpy.ndarray size changed")  # netCDF4's own, where it is installed
        return xr.open_dataset(file)


def test_plain_xarray_opens_a_record(walk, tmp_path):
    with plainly_opened(save(walk, tmp_path / "walk.nc")) as record:
        for name, variable in walk.variables.items():
            np.testing.assert_array_equal(record[name].values, variable.values, err_msg=str(name))
            assert record[name].attrs == variable.attrs
        assert record.foot_force.sel(leg="LF", xyz="z").units == "N"


def test_plain_pandas_reads_a_record_and_its_tables(walk, tmp_path):
    pandas = pytest.importorskip("pandas")
    with plainly_opened(save(walk, tmp_path / "walk.nc")) as record:
        frame = record["servo_torque"].to_dataframe()
    table = pandas.read_csv(write_tables(walk, tmp_path / "csv") / "run_time_servo.csv")
    assert table.columns[:3].tolist() == ["run", "time [s]", "servo"]
    again = table.set_index(["run", "time [s]", "servo"])["servo_torque [N m]"]
    np.testing.assert_allclose(again.values, frame["servo_torque"].values, rtol=1e-15)
