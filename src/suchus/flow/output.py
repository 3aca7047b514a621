"""Fields for other programs: VTK ImageData for ParaView, and NetCDF.

Both hold velocity, pressure, vorticity and the fluid's share at the cell centres, the velocity in the world's frame.
Format: VTK file formats, XML ImageData with raw appended data (``https://docs.vtk.org``).
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape, unescape
from pathlib import Path
from re import findall
from typing import TYPE_CHECKING

import numpy as np

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.core.writing import new_file
from suchus.flow.fields import Fields

if TYPE_CHECKING:
    import xarray as xr

_UNITS = {"velocity": "m s-1", "pressure": "Pa", "vorticity": "s-1", "fluid_share": "1"}
_NAMES = {
    "velocity": "velocity of the water in the world's frame",
    "pressure": "pressure, zero on the average along the sides of the domain",
    "vorticity": "vorticity, positive counter-clockwise",
    "fluid_share": "share of the water, 0 inside the bodies",
}


def snapshot(sim: Fields) -> "xr.Dataset":
    """Return the fields at the cell centres at the present time, dimensions (``z``,) ``y`` and ``x`` [m].

    The velocity also has the dimension ``component``, and so has the vorticity in space. Coordinates and velocities are
    those of the world frame, also for a grid that follows a body.

    Args:
        sim: the simulation whose fields are read.
    """
    import xarray as xr  # noqa: PLC0415  a quarter of the time of an import of flow, and few flows need it

    grid, (position, drift) = sim.water.grid, sim.frame
    velocity = np.stack([w + d for w, d in zip(sim.velocity, drift, strict=True)])
    names = tuple("xyz"[: grid.ndim])
    cells = names[::-1]
    spin = cells if grid.ndim == 2 else ("component", *cells)
    values = {
        "velocity": (("component", *cells), velocity), "pressure": (cells, sim.pressure),
        "vorticity": (spin, sim.vorticity_at_centres), "fluid_share": (cells, sim.fluid_fraction),
    }  # fmt: skip
    coords: dict[str, object] = {
        name: (name, getattr(grid, name) + shift, {"units": "m"}) for name, shift in zip(names, position, strict=True)
    }
    return xr.Dataset(
        {
            name: (dims, np.asarray(value, np.float32), {"units": _UNITS[name], "long_name": _NAMES[name]})
            for name, (dims, value) in values.items()
        },
        coords={**coords, "component": list(names), "time": ((), sim.time, {"units": "s"})},
    )


def save_vti(sim: Fields, path: Path | str) -> None:
    """Write the present fields to a VTK ImageData file, which ParaView and VisIt open.

    Args:
        sim: the simulation whose fields are written.
        path: name of the file.

    Raises:
        Unwritable: naming the place.
    """
    _write(Path(path), _vti(sim))


def _vti(sim: Fields) -> bytes:
    """Return the content of a VTK ImageData file with all fields, the numbers as raw little-endian floats."""
    data, grid, frame = snapshot(sim), sim.water.grid, sim.frame[0]
    flat, h = grid.ndim == 2, float(grid.cell)
    x, y, z = (*(float(value) for value in np.array(grid.origin) + frame), 0)[:3]
    nx, ny, nz = (*grid.cells, 0)[:3]
    arrays, blocks, offset = [], [], 0
    for name in _UNITS:
        values = data[name].to_numpy()
        vector = "component" in data[name].dims
        if vector:  # VTK's vectors have three components, each point's side by side
            values = np.stack([*values, *[np.zeros_like(values[0])] * flat], axis=-1)
        block = values.astype("<f4").tobytes()
        parts = 3 if vector else 1
        arrays.append(
            f'<DataArray type="Float32" Name="{name}" NumberOfComponents="{parts}" format="appended" '
            f'offset="{offset}"/>'
        )
        blocks.append(struct.pack("<Q", len(block)) + block)
        offset += len(blocks[-1])
    extent = f"0 {nx} 0 {ny} 0 {nz}"
    lead = 'Scalars="vorticity" Vectors="velocity"' if flat else 'Scalars="pressure" Vectors="velocity"'
    head = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        f'<ImageData WholeExtent="{extent}" Origin="{x!r} {y!r} {z!r}" Spacing="{h!r} {h!r} {1 if flat else h!r}">\n'
        '<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">'
        f"{float(sim.time)!r}</DataArray></FieldData>\n"
        f'<Piece Extent="{extent}"><CellData {lead}>\n'
        + "\n".join(arrays)
        + '\n</CellData></Piece></ImageData>\n<AppendedData encoding="raw">\n_'
    )
    return head.encode() + b"".join(blocks) + b"\n</AppendedData></VTKFile>"


@dataclass(slots=True)
class FieldSeries:
    """Writes the fields at chosen times of a run to a file: ``simulation.run(..., watch=series)``.

    Each entry is written at the end of the first step from its time on. A run that is killed keeps its entries, and a
    run that continues from a checkpoint appends to them.

    Raises:
        InvalidDesign: on creation, for times that do not rise or a file that is neither .nc nor .pvd.
    """

    path: Path | str
    """``*.nc`` for NetCDF with all times, ``*.pvd`` for a series of .vti files beside it."""
    times: Sequence[float]
    """Times at which the fields are written: at the end of the first step from each on [s]."""
    _next_index: int = field(default=0, init=False)
    _last_time: float = field(default=-np.inf, init=False)

    def __post_init__(self) -> None:
        """Check the file name and the times."""
        self.path, self.times = Path(self.path), tuple(float(time) for time in self.times)
        if self.path.suffix not in (".nc", ".pvd"):
            raise InvalidDesign(f"fields are to be written to {self.path}; give a name that ends with .nc or .pvd.")
        if not self.times or not np.isfinite(self.times).all() or (np.diff(self.times) <= 0).any():
            raise InvalidDesign(f"the times of the fields are {self.times} s; give finite times that rise.")

    def __call__(self, sim: Fields) -> None:
        """Write the fields if a chosen time has been reached.

        Args:
            sim: the simulation after a step.

        Raises:
            Unwritable: naming the place.
            UnreadableFile: a file of that name holds something else.
        """
        if not np.isfinite(self._last_time):  # a continued run does not repeat earlier times
            started = sim.time - (sim.record.step[-1] if sim.record.step.size else 0.0)
            if started > 0:
                self._next_index = sum(time <= started * (1 + 1e-12) for time in self.times)
        self._last_time = sim.time
        due = self._next_index
        while self._next_index < len(self.times) and sim.time >= self.times[self._next_index] * (1 - 1e-12):
            self._next_index += 1
        if self._next_index > due:
            (_add_to_netcdf if Path(self.path).suffix == ".nc" else _add_to_collection)(sim, Path(self.path))


def _add_to_netcdf(sim: Fields, path: Path) -> None:
    """Append the present fields to a NetCDF file; entries at or after the present time are replaced.

    Raises:
        UnreadableFile: the file holds something else.
    """
    import xarray as xr  # noqa: PLC0415  as above

    new = snapshot(sim)
    if sim.setup.follow is not None:  # a grid that travels: places relative to it, and where it is
        travelled = dict(zip("xyz", sim.frame[0], strict=False))
        places: dict[str, object] = {name: new[name] - shift for name, shift in travelled.items()}
        places |= {f"grid_{name}": ((), shift, {"units": "m"}) for name, shift in travelled.items()}
        new = new.assign_coords(places)
    new = new.expand_dims("time")
    if path.exists():
        try:
            with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
                old = file.load()
            old = old.isel(time=old.time.to_numpy() < sim.time * (1 - 1e-12))
            new = xr.concat([old, new], dim="time", join="exact") if old.sizes["time"] else new
        except (OSError, ValueError, KeyError) as error:
            raise UnreadableFile(
                f"{path} holds no fields of this run, so none are added to it; give another name or delete it."
            ) from error
    for name in (*"xyz"[: sim.water.grid.ndim], "time"):
        new[name].attrs["units"] = "s" if name == "time" else "m"
    _write(path, bytes(new.to_netcdf(engine="h5netcdf")))


def _add_to_collection(sim: Fields, path: Path) -> None:
    """Write the present fields to a new .vti file and add it to a ParaView collection (.pvd).

    Entries at or after the present time are replaced.

    Raises:
        UnreadableFile: the collection cannot be read.
    """
    entries: list[tuple[float, str]] = []
    if path.exists():
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise UnreadableFile(f"{path} cannot be read: {error}; give another name.") from error
        entries = [
            (float(time), unescape(name)) for time, name in findall(r'timestep="([0-9.e+-]+)" file="([^"]+)"', text)
        ]
        entries = [entry for entry in entries if entry[0] < sim.time * (1 - 1e-12)]
    name = f"{path.stem}_{len(entries):04d}.vti"
    save_vti(sim, path.with_name(name))
    entries.append((float(sim.time), name))
    rows = "\n".join(f'<DataSet timestep="{time!r}" file="{escape(file)}"/>' for time, file in entries)
    _write(
        path,
        f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n<Collection>\n{rows}\n</Collection>\n'
        f"</VTKFile>\n".encode(),
    )


def _write(path: Path, content: bytes) -> None:
    with new_file(path) as draft:
        draft.write_bytes(content)
