"""Fields for other programs, values at points, and coefficients."""

import struct
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import xarray as xr
from flow_cases import still_setup

from suchus import flow
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, UnreadableFile, Unwritable
from suchus.flow.compiled import PAD
from suchus.flow.record import COLUMNS


def sheared(**changes):
    """Water that moves with (0.5 + 2 x - 3 y, 0.25 + 4 x - 2 y) under a pressure 7 x - y, without bodies."""
    sim = flow.Simulation(still_setup(**{"bodies": (), "density": 2.0, **changes}))
    grid, n = sim.setup.grid, sim.water.u.shape
    (fx, fy), (cx, cy) = ([f(0, n[1 - k], k) for k in (0, 1)] for f in (grid.faces, grid.centres))
    sim.water.u[:] = 0.5 + 2 * fx - 3 * cy[:, None]
    sim.water.v[:] = 0.25 + 4 * cx - 2 * fy[:, None]
    sim.water.p[:] = 7 * cx - cy[:, None]
    return sim


def test_a_probe_is_exact_where_the_fields_are_linear():
    sim = sheared()
    points = np.array([[0.0, 0.0], [1.234, -0.7], [-2.0, 2.0], [1.999, 1.5]])
    got = sim.probe(points)
    x, y = points.T
    assert got.velocity == pytest.approx(np.stack([0.5 + 2 * x - 3 * y, 0.25 + 4 * x - 2 * y], axis=1), abs=1e-5)
    assert got.pressure == pytest.approx(2 * (7 * x - y), abs=1e-4)
    assert sim.probe((0.5, 0.5)).velocity.shape == (1, 2)


def test_a_probe_counts_from_the_world_and_not_from_a_grid_that_travels():
    sim = sheared()
    sim.frame[:] = (10.0, 1.0), (0.3, -0.1)
    got = sim.probe((10.5, 1.25))
    assert got.velocity[0] == pytest.approx((0.5 + 1.0 - 0.75 + 0.3, 0.25 + 2.0 - 0.5 - 0.1), abs=1e-5)


@pytest.mark.parametrize("points", [(2.01, 0.0), (float("nan"), 0.0), [[0.0, 0.0], [0.0, -9.0]]])
def test_points_outside_are_refused(points):
    with pytest.raises(InvalidDesign, match=r"the point \(.*\) m is outside the domain x = -2 to 2 m"):
        sheared().probe(points)


def test_points_of_another_shape_are_refused():
    with pytest.raises(InvalidDesign, match="the points have the shape"):
        sheared().probe(np.zeros((2, 3)))
    with pytest.raises(InvalidDesign, match="a line of 1 points; at least 2"):
        flow.line((0.0, 0.0), (1.0, 0.0), 1)


def test_a_rake_notes_the_water_in_a_run():
    rake = flow.Rake(points=flow.line((-1.0, 0.5), (1.0, 0.5), 5), interval=0.05)
    moving = flow.Rake(points=lambda time: np.array([[time, 0.0]]))
    sim = flow.Simulation(still_setup(bodies=(), stream=(0.5, 0.1), step=0.025))
    sim.run(0.2, watch=(rake, moving), progress=False)
    assert rake.time == pytest.approx([0.025, 0.05, 0.1, 0.15, 0.2])
    assert rake.velocity.shape == (5, 5, 2)
    assert rake.pressure.shape == (5, 5)
    assert rake.velocity == pytest.approx(np.broadcast_to((0.5, 0.1), (5, 5, 2)), abs=1e-6)
    assert moving.velocity.shape == (8, 1, 2)


def arrays_of(path):
    """An independent reader of VTK's ImageData with raw appended data."""
    head, tail = path.read_bytes().split(b'<AppendedData encoding="raw">\n_', 1)
    root = ET.fromstring(head + b"</VTKFile>")
    image = root.find("ImageData")
    found = {}
    for array in image.find("Piece/CellData"):
        start = int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", tail, start)
        flat = np.frombuffer(tail, "<f4", count=size // 4, offset=start + 8)
        found[array.get("Name")] = flat.reshape(-1, int(array.get("NumberOfComponents")))
    assert tail.endswith(b"\n</AppendedData></VTKFile>")
    time = float(image.find("FieldData/DataArray").text)
    return root, image, found, time


def test_a_vti_file_holds_the_fields_where_they_are(tmp_path):
    sim = sheared()
    sim.time = 1.25
    flow.save_vti(sim, tmp_path / "a b.vti")
    root, image, found, time = arrays_of(tmp_path / "a b.vti")
    assert (root.get("type"), root.get("byte_order"), root.get("header_type")) == (
        "ImageData",
        "LittleEndian",
        "UInt64",
    )
    assert image.get("WholeExtent") == image.find("Piece").get("Extent") == "0 64 0 64 0 0"
    assert [float(v) for v in image.get("Origin").split()] == [-2.0, -2.0, 0.0]
    assert [float(v) for v in image.get("Spacing").split()] == [1 / 16, 1 / 16, 1.0]
    assert time == 1.25
    x, y = np.meshgrid(sim.setup.grid.x, sim.setup.grid.y)  # cells run along x first
    expected = np.stack([0.5 + 2 * x - 3 * y, 0.25 + 4 * x - 2 * y, 0 * x], axis=-1).reshape(-1, 3)
    assert found["velocity"] == pytest.approx(expected, abs=1e-4)
    assert found["vorticity"] == pytest.approx(np.full((64 * 64, 1), 7.0), abs=1e-3)
    assert found["pressure"][:, 0] == pytest.approx((2 * (7 * x - y)).ravel(), abs=1e-3)
    assert (found["fluid_share"] == 1).all()
    assert [p.name for p in tmp_path.iterdir()] == ["a b.vti"]


def test_fields_have_units_and_the_world_s_coordinates():
    sim = sheared()
    sim.frame[:] = (10.0, 1.0), (0.3, -0.1)
    data = flow.snapshot(sim)
    assert data.velocity.dims == ("component", "y", "x")
    assert float(data.velocity.sel(component="x")[0, 0]) == pytest.approx(
        0.5 + 2 * -1.96875 + 3 * 1.96875 + 0.3, abs=1e-4
    )
    assert (data.x.to_numpy()[0], data.y.to_numpy()[0]) == pytest.approx((8.03125, -0.96875))
    assert {name: data[name].attrs["units"] for name in data} == {
        "velocity": "m s-1", "pressure": "Pa", "vorticity": "s-1", "fluid_share": "1",
    }  # fmt: skip


def streaming(until, *watchers, **options):
    sim = flow.Simulation(still_setup(bodies=(), stream=(0.5, 0.1), step=0.025))
    sim.run(until, watch=watchers, progress=False, **options)
    return sim


def test_chosen_times_go_to_netcdf_and_to_a_collection(tmp_path):
    times = (0.05, 0.12, 0.2)
    series = [flow.FieldSeries(tmp_path / name, times) for name in ("fields.nc", "fields.pvd")]
    streaming(0.2, *series)
    with xr.open_dataset(tmp_path / "fields.nc", engine="h5netcdf", decode_times=False) as data:
        assert data.time.to_numpy() == pytest.approx([0.05, 0.125, 0.2])
        assert data.velocity.dims == ("time", "component", "y", "x")
        assert (data.velocity.attrs["units"], data.time.attrs["units"]) == ("m s-1", "s")
        assert data.velocity.sel(component="y").to_numpy() == pytest.approx(0.1, abs=1e-6)
    sets = ET.parse(tmp_path / "fields.pvd").getroot().findall("Collection/DataSet")
    assert [float(s.get("timestep")) for s in sets] == pytest.approx([0.05, 0.125, 0.2])
    assert [arrays_of(tmp_path / s.get("file"))[3] for s in sets] == pytest.approx([0.05, 0.125, 0.2])


@pytest.mark.parametrize("name", ["fields.nc", "fields.pvd"])
def test_a_run_that_goes_on_adds_to_what_there_is(name, tmp_path):
    times, kept = (0.05, 0.1, 0.15), tmp_path / "state.npz"
    streaming(0.1, flow.FieldSeries(tmp_path / name, times), checkpoint=kept)
    streaming(0.2, flow.FieldSeries(tmp_path / name, times), checkpoint=kept)
    if name.endswith("nc"):
        with xr.open_dataset(tmp_path / name, engine="h5netcdf", decode_times=False) as data:
            assert data.time.to_numpy() == pytest.approx(times)
    else:
        assert len(ET.parse(tmp_path / name).getroot().findall("Collection/DataSet")) == 3
        assert len(list(tmp_path.glob("*.vti"))) == 3


def test_fields_that_cannot_be_written_say_so(tmp_path):
    with pytest.raises(InvalidDesign, match=r"fields.txt; give a name that ends with .nc or .pvd"):
        flow.FieldSeries("fields.txt", (1.0,))
    for times in ((), (2.0, 1.0), (float("nan"),)):
        with pytest.raises(InvalidDesign, match="the times of the fields are"):
            flow.FieldSeries("fields.nc", times)
    (tmp_path / "file").write_text("")
    with pytest.raises(Unwritable, match="cannot be written"):
        flow.save_vti(sheared(), tmp_path / "file" / "a.vti")
    (tmp_path / "other.nc").write_text("no fields")
    with pytest.raises(UnreadableFile, match="holds no fields of this run"):
        streaming(0.05, flow.FieldSeries(tmp_path / "other.nc", (0.05,)))
    assert (tmp_path / "other.nc").read_text() == "no fields"


def test_vorticity_at_the_centres_is_the_mean_of_that_at_the_corners():
    sim = sheared()
    sim.water.u[:] += np.random.default_rng(1).normal(size=sim.water.u.shape)
    w = sim.vorticity
    inner = 0.25 * (w[1:, 1:] + w[1:, :-1] + w[:-1, 1:] + w[:-1, :-1])
    assert sim.vorticity_at_centres[1:-1, 1:-1] == pytest.approx(inner, abs=1e-3)
    assert sim.vorticity_at_centres.shape == sim.pressure.shape == tuple(n - 2 * PAD for n in sim.water.p.shape)


def record_of(force, torque, power):
    bodies = np.zeros((1, 1, len(COLUMNS)))
    for name, value in zip(("force_x", "force_y", "torque", "power"), (*force, torque, power), strict=True):
        bodies[0, 0, COLUMNS.index(name)] = value
    return flow.Record(
        names=("foil",), time=np.array([2.0]), step=np.array([0.5]), cycles=np.zeros((1, 2), int),
        divergence=np.zeros(1), bodies=bodies,
    )  # fmt: skip


def test_coefficients_by_a_reference():
    got = record_of((3.0, 4.0), 6.0, 10.0).coefficients("foil", length=0.5, speed=2.0, density=1.5)
    pressure = 0.5 * 1.5 * 4.0
    assert (got.drag[0], got.lift[0]) == pytest.approx((3 / (pressure * 0.5), 4 / (pressure * 0.5)))
    assert (got.moment[0], got.power[0]) == pytest.approx((6 / (pressure * 0.25), 10 / (pressure * 2 * 0.5)))
    assert got.time[0] == 1.75
    turned = record_of((3.0, 4.0), 0.0, 0.0).coefficients(length=1.0, speed=1.0, stream_angle=np.arctan2(4, 3))
    assert (turned.drag[0], turned.lift[0]) == pytest.approx((10.0, 0.0))


@pytest.mark.parametrize("wrong", [{"length": 0.0}, {"speed": -1.0}, {"density": float("nan")}])
def test_a_reference_that_is_none_is_refused(wrong):
    with pytest.raises(OutsideLimits, match=r"of the reference is .*; give a positive number"):
        record_of((1.0, 1.0), 0.0, 0.0).coefficients(**{"length": 1.0, "speed": 1.0, **wrong})
    with pytest.raises(UnknownName):
        record_of((1.0, 1.0), 0.0, 0.0).coefficients("fin", length=1.0, speed=1.0)


def test_the_density_is_one_unless_it_is_given():
    """So that a cylinder of diameter 1 in a stream of speed 1 has forces of the order of 1."""
    assert flow.Setup(grid=flow.Grid(cells=(8, 8), cell=1.0), viscosity=1.0).density == 1.0
