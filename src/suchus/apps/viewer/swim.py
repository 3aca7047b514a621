"""What a record of swimming shows over time, without a browser.

In the plane these are fields of the water and the outline of the body; in space, of its last cycle, the body and the
surfaces around its vortices.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import matplotlib as mpl
import numpy as np
import xarray as xr

from suchus.core.errors import IncompatibleRecord
from suchus.core.files import load
from suchus.visual.figures import vortices
from suchus.visual.skin.mesh import Mesh

_FIELDS = ("vorticity", "pressure")
_MAPS = {"vorticity": "RdBu_r", "pressure": "PuOr"}
_COLOUR_QUANTILE = 0.985  # fraction of the values within the colour range; a few at the tail's tip lie far outside
_TITLES = {
    "held": "held at the snout", "free": "free, from rest", "printed": "the wave as printed",
    "field": "on its own joints, from rest",
}  # fmt: skip


def colours(name: str, relative_values: np.ndarray) -> np.ndarray:
    """Return the colours of a field, (..., 3) uint8, for its values as shares of the limit, -1 to 1."""
    return np.asarray(mpl.colormaps[_MAPS[name]](np.clip(0.5 + 0.5 * relative_values, 0.0, 1.0), bytes=True)[..., :3])


@dataclass(frozen=True, slots=True)
class Film:
    """One swim of a record, frame by frame."""

    title: str
    """Title of the film."""
    phase: np.ndarray
    """Phase of each frame, (frame,) [cycle]."""
    x: np.ndarray
    """Coordinates of the points of the fields, along the body (x,) [m]."""
    y: np.ndarray
    """Across it, (y,) [m]."""
    fields: Mapping[str, np.ndarray]
    """Fields by name, (frame, y, x)."""
    units: Mapping[str, str]
    """Units of the fields."""
    sides: np.ndarray
    """Left and right side of the body, (frame, 2, station, 2) [m]."""

    def limit(self, name: str) -> float:
        """Return the value at which the colours of a field end; they are symmetric about zero."""
        return float(np.quantile(np.abs(self.fields[name]), _COLOUR_QUANTILE)) or 1.0

    def picture(self, name: str, frame: int) -> np.ndarray:
        """Return a field as colours, (y, x, 3) uint8, the first row at the least y."""
        limit = self.limit(name)
        return colours(name, self.fields[name][frame] / limit)


@dataclass(frozen=True, slots=True)
class PlottedCurve:
    """A measured course for a plot."""

    title: str
    """Title of the plot, with the unit."""
    x: np.ndarray
    """(n,)."""
    lines: Mapping[str, np.ndarray]
    """Lines by name, each (n,)."""


def films(path: Path) -> tuple[tuple[Film, ...], tuple[PlottedCurve, ...]]:
    """Return the swims and the measured curves of a record of swimming.

    Args:
        path: path of the file.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: it is no record of swimming by CFD.
    """
    record = load(path)
    prefixes = [str(name).removesuffix("midline_x") for name in record if str(name).endswith("midline_x")]
    swims = [film for prefix in prefixes if (film := _film(record, prefix)) is not None]
    if not swims:
        raise IncompatibleRecord(
            f"{path} holds no fields of water: only records of swimming by CFD do, as the record.nc of "
            "suchus run swimming, suchus run swim_3d or suchus run swim_free --water slice."
        )
    return tuple(swims), _curves(record)


def _film(record: xr.Dataset, prefix: str) -> Film | None:
    """Return the swim whose variables begin with a prefix; None if the record has no field of it."""
    names = [name for name in _FIELDS if f"{prefix}{name}" in record and record[f"{prefix}{name}"].ndim in (2, 3)]
    if not names:
        return None
    first_field = record[f"{prefix}{names[0]}"]
    if not _has_consistent_fields(record, prefix, names):
        raise IncompatibleRecord(f"{prefix or 'swim'} holds other fields or midlines than records of swimming do.")
    y_name, x_name = str(first_field.dims[-2]), str(first_field.dims[-1])
    common_names = [name for name in names if record[f"{prefix}{name}"].dims == first_field.dims]
    fields = {name: _stacked(record[f"{prefix}{name}"].values) for name in common_names}
    count = len(fields[names[0]])
    frame = str(first_field.dims[0]) if first_field.ndim == 3 else ""
    phase = record[frame].values if frame in record.coords else np.arange(1, count + 1) / count
    midline = {
        quantity: _lines(record[f"{prefix}midline_{quantity}"].values)
        for quantity in ("x", "y", "heading", "half_width")
    }
    half_width_vector = (
        np.stack([-np.sin(midline["heading"]), np.cos(midline["heading"])], axis=-1) * midline["half_width"][..., None]
    )
    midline_points = np.stack([midline["x"], midline["y"]], axis=-1)
    title = _TITLES.get(prefix.rstrip("_"), prefix.rstrip("_") or "swim")
    return Film(
        title=title,
        phase=np.asarray(phase, dtype=float),
        x=record[x_name].values,
        y=record[y_name].values,
        fields=fields,
        units={name: str(record[f"{prefix}{name}"].attrs.get("units", "")) for name in common_names},
        sides=np.stack([midline_points + half_width_vector, midline_points - half_width_vector], axis=1)[-count:],
    )


def _has_consistent_fields(record: xr.Dataset, prefix: str, names: Sequence[str]) -> bool:
    """Return whether fields and midlines are numbers of sizes that go together."""
    lines = [f"{prefix}midline_{quantity}" for quantity in ("x", "y", "heading", "half_width")]
    first_field = record[f"{prefix}{names[0]}"]
    axes = [str(dim) for dim in first_field.dims[-2:]]
    frames = first_field.shape[0] if first_field.ndim == 3 else 1
    if any(name not in record for name in lines) or any(axis not in record.coords for axis in axes):
        return False
    numeric = all(record[name].dtype.kind in "fiu" and record[name].size for name in (*lines, *axes))
    numeric &= all(record[f"{prefix}{name}"].dtype.kind in "fiu" for name in names) and first_field.size > 0
    shapes = {_lines(record[name].values).shape for name in lines}
    return numeric and len(shapes) == 1 and len(shape := shapes.pop()) == 2 and shape[0] >= frames


def _stacked(values: np.ndarray) -> np.ndarray:
    return values[None] if values.ndim == 2 else values


def _lines(values: np.ndarray) -> np.ndarray:
    return values[None] if values.ndim == 1 else values


def _curves(record: xr.Dataset) -> tuple[PlottedCurve, ...]:
    """Return the forces over the phase, the speed of each cycle and the joint angles that a record holds."""
    curves = []
    for prefix, title in _TITLES.items():
        components = {"forward": f"{prefix}_thrust", "to the side": f"{prefix}_aside"}
        if all(name in record for name in (*components.values(), f"{prefix}_phase")):
            phase = record[f"{prefix}_phase"].values
            curves.append(
                PlottedCurve(
                    f"force [N/m] over the phase, {title}", phase, {k: record[v].values for k, v in components.items()}
                )
            )
    if "arm_speed" in record and set(record.arm_speed.dims) == {"arm", "cycle"} and "arm" in record.coords:
        lines = {str(arm): record.arm_speed.sel(arm=arm).values for arm in record.arm.values[:3]}
        curves.append(PlottedCurve("speed [m/s] of each cycle", np.arange(1.0, record.sizes["cycle"] + 1), lines))
    return (*curves, *_joint_curves(record))


def _joint_curves(record: xr.Dataset) -> Iterator[PlottedCurve]:
    """Yield joint angles and coupling residual of a swim that was solved together with its flow."""
    if "flow_joint_angle" not in record or not {"flow_run", "flow_time", "joint"} <= {*record.coords}:
        return
    angles = record.flow_joint_angle.isel(flow_run=0)
    cable = [str(name) for name in record.attrs.get("cable", ()) if name in record.joint.values]
    joint_names = cable or [
        str(name) for name in record.joint.values if float(np.ptp(angles.sel(joint=name).values)) > 0
    ]
    if joint_names:
        plotted_names = dict.fromkeys(joint_names[k] for k in (0, len(joint_names) // 2, -1))
        lines = {name: np.degrees(angles.sel(joint=name).values) for name in plotted_names}
        joint_text = "joints of one cable" if cable else "joints"
        yield PlottedCurve(f"angle [degrees] of {joint_text}, from rest", record.flow_time.values, lines)
    if "coupling_residual" in record:
        residual = record.coupling_residual.isel(flow_run=0).values
        yield PlottedCurve(
            "force left over between robot and flow [-]", record.flow_time.values, {"left over": residual}
        )


MAX_POINTS = 60_000
"""Points of the upper half of the surfaces from which they are taken of blocks of cells [-]."""
_MAX_BLOCK = 4
_MIN_LEVEL, _MAX_LEVEL = 0.3, 4.0
"""Least and greatest second invariant that can be chosen, over the record's own; fields are kept from a quarter on."""


@dataclass(frozen=True, eq=False)
class VortexFilm:
    """The last cycle of a swim in three dimensions, frame by frame.

    Args:
        record: record of the experiment ``swim_3d``, or of ``water.resolved`` in space with frames; see
            ``figures.vortices``.
        subject: how a sentence about it begins.

    Raises:
        IncompatibleRecord: it is none of these.
    """

    record: xr.Dataset
    subject: str = "the record"

    def __post_init__(self) -> None:
        vortices.check_vortex_record(self.record, self.subject)

    @property
    def phase(self) -> np.ndarray:
        """Phase of each frame in the cycle, (frame,) [-]."""
        return np.asarray(self.record.frame.values, dtype=float)

    @property
    def level(self) -> float:
        """Second invariant Q on the surfaces of the experiment's own pictures [1/s2]."""
        return float(self.record.vortex_level)

    @property
    def levels(self) -> tuple[float, float]:
        """Least and greatest Q whose surface can be shown [1/s2]."""
        return _MIN_LEVEL * self.level, _MAX_LEVEL * self.level

    def clip_level(self, level: float) -> float:
        """Return the nearest Q whose surface can be shown [1/s2]; the record's own for what is no number."""
        lower_bound, upper_bound = self.levels
        return min(max(level, lower_bound), upper_bound) if np.isfinite(level) else self.level

    @cached_property
    def limit(self) -> float:
        """Vorticity about the vertical at which the colours end [1/s]."""
        return vortices.colour_limit(self.record)

    def body(self, frame: int) -> Mesh:
        """Return the body."""
        return vortices.body(self.record, frame)

    def blocks(self, level: float) -> int:
        """Return the cells along each side of the blocks of which surfaces are taken, so that they are small [-]."""
        last_frame = self.record.sizes["frame"] - 1
        for block in range(1, _MAX_BLOCK):
            surface, _ = vortices.surface(self.record, last_frame, coarse=block, level=level)
            if len(surface.points) <= MAX_POINTS:
                return block
        return _MAX_BLOCK

    def surfaces(self, frame: int, level: float, *, blocks: int = 1, lower_half_only: bool = False) -> Mesh:
        """Return the surfaces around the vortices, coloured by the vorticity about the vertical.

        Args:
            frame: which.
            level: second invariant on them [1/s2].
            blocks: see the method of that name [-].
            lower_half_only: whether the half above the plane of symmetry, which hides the body, is left out.
        """
        return vortices.vortex_surfaces(self.record, frame, coarse=blocks, level=level, lower_half_only=lower_half_only)

    def camera(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return where the camera is at first and where it looks, as in the experiment's pictures [m]."""
        view = vortices.camera(self.record)
        position = np.array(view.target) + 1.1 * view.width * view.axes[2]
        return (float(position[0]), float(position[1]), float(position[2])), view.target

    def description(self) -> str:
        """Return grid resolution and f L² / ν of the swim as text, as far as the record holds them."""
        sentences = []
        if "cells" in self.record.coords and self.record.cells.ndim == 1:
            sentences.append(f"{int(self.record.cells[-1])} cells a length")
        if "reynolds" in self.record:
            sentences.append(f"f L² / ν = {float(self.record.reynolds):.0f}")
        return ", ".join(sentences)

    def curves(self) -> tuple[PlottedCurve, ...]:
        """Return the measured curves; a record of a single swim has none."""
        return tuple(_space_curves(self.record))


def _space_curves(record: xr.Dataset) -> Iterator[PlottedCurve]:
    """Yield speed and power of each cycle by grid, the servos' torques, and the joint angles."""
    for name, unit in (("speed", "m/s"), ("power", "W")):
        if name in record and record[name].dims == ("grid", "cycle") and "cells" in record.coords:
            grids = {f"{int(n)} cells a length": record[name].values[i] for i, n in enumerate(record.cells.values)}
            yield PlottedCurve(f"{name} [{unit}] of each cycle", record.cycle.values, dict(list(grids.items())[-3:]))
    if "servo_torque" in record and set(record.servo_torque.dims) == {"moment", "servo"}:
        torque_fraction = (record.servo_torque / record.servo_limit).transpose("servo", "moment")
        lines = {str(name): torque_fraction.values[i] for i, name in enumerate(record.servo.values)}
        quantity = "torque" if record.attrs.get("joints") else "torque of the water"
        yield PlottedCurve(f"{quantity} over the servo's limit [-]", record.moment.values, lines)
    yield from _joint_curves(record)


def vortex_film(path: Path) -> VortexFilm | None:
    """Return the last cycle of a swim in three dimensions; None if the record knows nothing of vortices in space.

    Args:
        path: path of the file.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: the record holds vortices, and lacks or garbles what belongs to them.
    """
    record = load(path)
    return VortexFilm(record, str(path)) if "vortices" in record else None
