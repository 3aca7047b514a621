"""Vortices around a swimming body in space: a picture and a film of the surfaces around them and of the body."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_hex
from matplotlib.figure import Figure
from matplotlib.transforms import IdentityTransform
from scipy.ndimage import map_coordinates

from suchus.core.errors import IncompatibleRecord
from suchus.core.isosurface import IsoSurface, isosurface
from suchus.core.progress import Progress, silent
from suchus.visual.figures.fields import VORTICITY
from suchus.visual.figures.film import film
from suchus.visual.figures.style import captioned, panels, styled
from suchus.visual.skin.mesh import Mesh, join_meshes, loft, normals

_LIGHT = np.array([-0.35, 0.75, 0.56])  # to the right, up, towards the camera; of length 1
_CLEAR_FRACTION = 0.8  # of the light that comes from the clear surfaces
_SUPERSAMPLING = 2  # computed pixels along each side of a shown pixel


class Viewpoint(NamedTuple):
    """Where a picture is taken from."""

    azimuth: float
    """Direction of the camera as seen from its target, from x to y [rad]."""
    elevation: float
    """Angle of that direction above the plane of x and y [rad]."""
    distance: float
    """Distance of the camera [m]."""
    target: tuple[float, float, float]
    """Point in the middle of the picture [m]."""
    width: float
    """Width of what is seen at the target's distance [m]."""

    @property
    def axes(self) -> np.ndarray:
        """To the right, up, and towards the camera, as rows; shape (3, 3) [-]."""
        (c, s), (vertical, horizontal) = (
            (np.cos(self.azimuth), np.sin(self.azimuth)),
            (np.sin(self.elevation), np.cos(self.elevation)),
        )
        return np.array(
            [[-s, c, 0.0], [-c * vertical, -s * vertical, horizontal], [c * horizontal, s * horizontal, vertical]]
        )

    def project(self, points: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Return where points are in a picture, from its lower left corner (point, 2) [pixel], and how far off [m]."""
        right, upward, toward_camera = self.axes @ (points - np.array(self.target)).T
        scale = size[0] / self.width * self.distance / (self.distance - toward_camera)
        return np.stack(
            [0.5 * size[0] + scale * right, 0.5 * size[1] + scale * upward], axis=1
        ), self.distance - toward_camera


def picture(solid: Mesh, clear: Mesh, camera: Viewpoint, size: tuple[int, int]) -> np.ndarray:
    """Return a picture on white of a solid and of surfaces that it is seen through, (row, column, 3) uint8.

    Args:
        solid: surfaces that hide what is behind them.
        clear: surfaces of which the nearest lets through what is solid behind it.
        camera: where it is taken from.
        size: columns and rows [pixel].
    """
    solid_only, combined = (_render(meshes, camera, size) for meshes in ([solid], [solid, clear]))
    return np.round(_CLEAR_FRACTION * combined + (1.0 - _CLEAR_FRACTION) * solid_only).astype(np.uint8)


def _render(meshes: Sequence[Mesh], camera: Viewpoint, size: tuple[int, int]) -> np.ndarray:
    """Return the picture of surfaces that hide what is behind them, (row, column, 3) [0 to 255].

    Args:
        meshes: the surfaces.
        camera: where the picture is taken from.
        size: columns and rows [pixel].
    """
    mesh = join_meshes(meshes)
    fine = (_SUPERSAMPLING * size[0], _SUPERSAMPLING * size[1])
    positions, depth = camera.project(mesh.vertices, fine)
    corner = positions[mesh.faces]
    order = np.argsort(-depth[mesh.faces].mean(axis=1), kind="stable")
    colours = np.column_stack([_lit_colours(mesh, camera), np.ones(len(mesh.vertices))])
    renderer = RendererAgg(fine[0], fine[1], 72.0)  # type: ignore[no-untyped-call]
    gc = renderer.new_gc()
    gc.set_antialiased(False)
    if len(order):
        shades = colours[mesh.faces[order]]
        renderer.draw_gouraud_triangles(gc, corner[order], shades, IdentityTransform())
    pixels = np.asarray(renderer.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]  # white where nothing is
    first_rows, *other_samples = (
        pixels[i::_SUPERSAMPLING, j::_SUPERSAMPLING] for i in range(_SUPERSAMPLING) for j in range(_SUPERSAMPLING)
    )
    total = sum((sample.astype(np.float32) for sample in other_samples), first_rows.astype(np.float32))
    return total / _SUPERSAMPLING**2


def _lit_colours(mesh: Mesh, camera: Viewpoint) -> np.ndarray:
    """Return the colours of a mesh under a high light from behind the camera's left shoulder, (n, 3) [0 to 1]."""
    axes = camera.axes
    normal, light = normals(mesh), axes.T @ _LIGHT
    normal *= np.where(normal @ axes[2] < 0, -1.0, 1.0)[:, None]  # an open surface may show its inner side
    half = light + axes[2]
    half /= np.linalg.norm(half)
    straight = np.clip(normal @ light, 0.0, 1.0)[:, None]
    glint = np.clip(normal @ half, 0.0, 1.0)[:, None] ** 40
    facing = (normal @ axes[2])[:, None]
    vertex_colours = mesh.colours * (0.45 + 0.45 * straight + 0.2 * facing) + 0.2 * glint
    return np.clip(vertex_colours, 0.0, 1.0)


SKIN = (0.42, 0.44, 0.36)
"""Colour of the body."""
SECTION_POINTS = 32
"""Points around a section of the body [-]."""
LINES = tuple(f"film_{name}" for name in ("x", "y", "heading", "half_width"))
"""Variables of the body in a record, each (frame, station)."""
_FIELDS, _UNITS = ("vortices", "spin"), ("vortex_level", "vortex_unit", "spin_unit")
_DARKEST = 0.92  # share of the colour map that is used; its ends are nearly black
_SECONDS = 4.0  # [s]; duration of the cycle in the film


def check_vortex_record(record: xr.Dataset, subject: str = "the record") -> None:
    """Refuse a record without the vortices of a swim in three dimensions over a cycle.

    Args:
        record: record in question.
        subject: how a sentence begins.

    Raises:
        IncompatibleRecord: something is missing, or is no number, or the sizes do not go together.
    """
    missing = [name for name in (*_FIELDS, *_UNITS, "half_height", *LINES) if name not in record]
    if missing or record.sizes.get("frame", 0) < 1:
        raise IncompatibleRecord(
            f"{subject} has no {', '.join(missing) or 'frame'}: only swims in three dimensions whose vortices were "
            "kept can be shown so, as the record.nc of suchus run swim_3d."
        )
    expected_dims: dict[str, tuple[str, ...]] = {"half_height": ("station",)}
    expected_dims |= dict.fromkeys(_FIELDS, ("frame", "z", "y", "x"))
    expected_dims |= dict.fromkeys(_UNITS, ())
    expected_dims |= dict.fromkeys(LINES, ("frame", "station"))
    axes = [axis for axis in ("frame", "z", "y", "x") if axis in record.coords]
    variable_names = [*expected_dims, *axes]
    invalid_names = [
        name
        for name in variable_names
        if record[name].dims != expected_dims.get(name, (name,)) or not _numbers(record[name])
    ]
    invalid_names += [name for name in _UNITS if name not in invalid_names and not float(record[name]) > 0.0]
    if invalid_names or len(axes) < 4 or min(record.sizes[axis] for axis in ("z", "y", "x", "station")) < 2:
        raise IncompatibleRecord(
            f"{subject} holds {', '.join(invalid_names) or 'places or sizes'} in another form than swims in three "
            "dimensions do, as the record.nc of suchus run swim_3d."
        )


def _numbers(values: xr.DataArray) -> bool:
    return values.dtype.kind in "iuf" and bool(np.isfinite(values.values).all())


def surface(
    record: xr.Dataset, frame: int, *, coarse: int = 1, level: float | None = None
) -> tuple[IsoSurface, np.ndarray]:
    """Return the upper half of the surfaces around the vortices, and the vorticity about z at their points [1/s].

    Args:
        record: record of the experiment ``swim_3d``.
        frame: which.
        coarse: cells along each side of a block over which the fields are averaged [-].
        level: value of Q, the second invariant, on the surfaces, above 0 [1/s2]; the record's own if None.
    """
    q, spin = (_blocks(record[name].values[frame].astype(float), coarse) for name in ("vortices", "spin"))
    h = coarse * float(record.x[1] - record.x[0])
    start = [float(record[axis][0]) + 0.5 * (h - h / coarse) for axis in "xyz"]
    q, spin = (np.concatenate([values[:1], values]) for values in (q, spin))  # the image below the plane of symmetry
    threshold = float((record.vortex_level if level is None else level) / record.vortex_unit)
    iso_surface = isosurface(q, threshold, (start[0], start[1], start[2] - h), h)
    turning = map_coordinates(spin, iso_surface.places.T, order=1, mode="nearest") * float(record.spin_unit)
    return iso_surface, turning


def _blocks(values: np.ndarray, coarse: int) -> np.ndarray:
    nz, ny, nx = (n // coarse for n in values.shape)
    trimmed = values[: nz * coarse, : ny * coarse, : nx * coarse]
    means: np.ndarray = trimmed.reshape(nz, coarse, ny, coarse, nx, coarse).mean(axis=(1, 3, 5))
    return means


def body(record: xr.Dataset, frame: int) -> Mesh:
    """Return the body, elliptic sections along its midline."""
    x, y, heading, half_width = (record[f"film_{name}"].values[frame].astype(float)[:, None]
                           for name in ("x", "y", "heading", "half_width"))  # fmt: skip
    turn = 2 * np.pi * np.arange(SECTION_POINTS) / SECTION_POINTS
    lateral, vertical = half_width * np.cos(turn), record.half_height.values[:, None] * np.sin(turn)
    return loft(np.stack([x - lateral * np.sin(heading), y + lateral * np.cos(heading), vertical], axis=-1)).painted(
        np.array(SKIN)
    )


def vortex_surfaces(
    record: xr.Dataset, frame: int, *, coarse: int = 1, level: float | None = None, lower_half_only: bool = False
) -> Mesh:  # fmt: skip
    """Return the surfaces around the vortices, coloured by the vorticity about z.

    Args:
        record: see ``surface``, as frame, coarse and level are.
        frame: which.
        coarse: cells along each side of a block [-].
        level: second invariant on them [1/s2].
        lower_half_only: whether only the half below the plane of symmetry is returned.
    """
    iso_surface, spin = surface(record, frame, coarse=coarse, level=level)
    half = Mesh(iso_surface.points, iso_surface.faces, colours(spin, colour_limit(record)))
    lower_half = Mesh(iso_surface.points * np.array([1.0, 1.0, -1.0]), iso_surface.faces[:, ::-1], half.colours)
    return lower_half if lower_half_only else join_meshes([half, lower_half])


def colours(spin: np.ndarray, limit: float) -> np.ndarray:
    """Return the colours of a vorticity about z, (n, 3) [0 to 1]: red counter-clockwise as seen from above."""
    fraction = 0.5 + 0.5 * _DARKEST * np.clip(spin / limit, -1.0, 1.0)
    return np.asarray(colormaps[VORTICITY](fraction)[:, :3])


def colour_limit(record: xr.Dataset) -> float:
    """Return the vorticity at which the colours end: that of a round vortex whose middle is at twice the level."""
    return float(2.0 * (2.0 * record.vortex_level) ** 0.5)


def camera(record: xr.Dataset) -> Viewpoint:
    """Return where pictures of a record are taken from: obliquely from above, beside the body."""
    x, y = record.film_x.values, record.y.values
    length, center = float(np.ptp(x[0])), 0.5 * float(x.min() + x.max())
    target, width = (center + 0.26 * length, -0.14 * length, 0.0), 1.2 * length + 0.25 * float(np.ptp(y))
    return Viewpoint(azimuth=-1.05, elevation=0.62, distance=3.2 * length, target=target, width=width)


def hex_colour(relative_value: float) -> str:
    """Return the colour of a vorticity as #rrggbb, from its share of the one at which the colours end [-1 to 1]."""
    return to_hex(colours(np.array([relative_value]), 1.0)[0])


def still_picture(record: xr.Dataset, frame: int, size: tuple[int, int] = (720, 400)) -> np.ndarray:
    """Return a picture of a frame from a corner, (row, column, 3) uint8."""
    return picture(body(record, frame), vortex_surfaces(record, frame), camera(record), size)


def draw_vortices(record: xr.Dataset) -> Figure:
    """Draw the surfaces around the vortices and the body at the end, from a corner.

    Args:
        record: record of the experiment ``swim_3d``.
    """
    last_frame = record.sizes["frame"] - 1
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=9.0, height=5.6)
        ax = axes[0, 0]
        ax.imshow(still_picture(record, last_frame, (1440, 800)), interpolation="none")
        ax.set_axis_off()
        limit = colour_limit(record)
        ramp = colormaps[VORTICITY](np.linspace(0.5 - 0.5 * _DARKEST, 0.5 + 0.5 * _DARKEST, 256))
        mappable = ScalarMappable(Normalize(-limit, limit), cmap=LinearSegmentedColormap.from_list("spin", ramp))
        figure.colorbar(mappable, ax=ax, orientation="horizontal", shrink=0.45, pad=0.02, aspect=32, extend="both",
                        label="vorticity about the vertical [1/s]")  # fmt: skip
    return captioned(figure, _caption(record))


def film_vortices(record: xr.Dataset, progress: Progress = silent) -> bytes:
    """Return a film of the last cycle as a GIF.

    Args:
        record: record of the experiment ``swim_3d``.
        progress: told the share that is done.
    """
    count = record.sizes["frame"]
    with styled(axes__grid=False, figure__dpi=100):
        figure, axes = panels(1, 1, width=7.2, height=4.0)
        figure.set_layout_engine("none")
        axes[0, 0].set_position((0.0, 0.0, 1.0, 1.0))
        axes[0, 0].set_axis_off()
        image = axes[0, 0].imshow(still_picture(record, 0), interpolation="none", aspect="auto")

        def show(i: int) -> None:
            image.set_data(still_picture(record, i))
            progress("drawing", (i + 1) / count)

        return film(figure, show, count, seconds=_SECONDS, caption=_caption(record))


def _caption(record: xr.Dataset) -> str:
    """Return the caption of a picture or film of a record's vortices."""
    return (
        f"The robot's body swims to the left, on {int(record.cells[-1])} cells a length at f L² / ν = "
        f"{float(record.reynolds):.0f}. The surfaces lie where the second invariant of the velocity's gradient is Q = "
        f"{float(record.vortex_level):.3g} 1/s², around vortices; red ones turn counter-clockwise as seen from above, "
        "blue ones clockwise."
    )
