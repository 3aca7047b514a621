"""Bodies in the water: a shape with a motion, and what several of them say together on the grid."""

from dataclasses import dataclass, field, fields

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD, Window
from suchus.flow.free import FreeBody
from suchus.flow.grid import Grid
from suchus.flow.immerse import REACH, THINNEST, THINNEST_SHEET
from suchus.flow.pose import Motion, Pose
from suchus.flow.shape import Field, Shape


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A shape that moves as it is told."""

    shape: Shape
    """What it looks like in its own frame."""
    motion: Pose | Motion = field(default_factory=Pose)
    """Where its frame is: a fixed pose, or a pose for every time [s]."""
    name: str = "body"
    """Its name in records and messages."""

    def pose(self, time: float) -> Pose:
        """Return the pose at a time [s]."""
        return self.motion if isinstance(self.motion, Pose) else self.motion(time)

    @property
    def still(self) -> bool:
        """Whether neither shape nor pose ever change."""
        moving = not isinstance(self.motion, Pose) or any(self.motion.velocity) or self.motion.spin
        return self.shape.rigid and not moving


AnyBody = Body | FreeBody


def window_of(body: AnyBody, pose: Pose, grid: Grid, time: float) -> Window:
    """Return the cells around a body that it acts on.

    Raises:
        InvalidDesign: the body touches a side of the domain or lies beyond it.
    """
    x0, x1, y0, y1 = body.shape.bounds(time, pose)
    margin = (REACH + 2) * grid.cell
    ox, oy = grid.origin
    wide, high = grid.size
    if not (x0 - margin > ox and y0 - margin > oy and x1 + margin < ox + wide and y1 + margin < oy + high):
        raise InvalidDesign(
            f"at t = {time:.4g} s, {body.name} reaches over x = {x0:.4g} to {x1:.4g} m, y = {y0:.4g} to {y1:.4g} m, "
            f"outside the domain x = {ox:.4g} to {ox + wide:.4g} m, y = {oy:.4g} to {oy + high:.4g} m "
            f"(less {margin:.2g} m on each side); enlarge the grid, or let the frame follow the body."
        )
    h, (nx, ny) = grid.cell, grid.cells
    return (
        int((y0 - margin - oy) / h) + PAD, min(int((y1 + margin - oy) / h) + 2, ny) + PAD,
        int((x0 - margin - ox) / h) + PAD, min(int((x1 + margin - ox) / h) + 2, nx) + PAD,
    )  # fmt: skip


def unite(windows: list[Window], axes: int) -> Window:
    """Return the smallest window around all; an empty one around none."""
    if not windows:
        return (PAD,) * (2 * axes)
    return tuple((max if k % 2 else min)(w[k] for w in windows) for k in range(2 * axes))


def measure_all(
    bodies: list[AnyBody], poses: list[Pose], points: list[np.ndarray], time: float, h: float
) -> tuple[Field, np.ndarray]:
    """Return the field of all bodies on a window, at every point that of the nearest body, and which one it is.

    ``points`` are the coordinates of the window along each axis [m].
    """
    x, y = points
    first = bodies[0].shape.measure(x, y, time, poses[0], (REACH + 1) * h)
    owner = np.zeros(first.distance.shape, np.int8)
    for k, (body, pose) in enumerate(zip(bodies[1:], poses[1:], strict=True), start=1):
        other = body.shape.measure(x, y, time, pose, (REACH + 1) * h)
        nearer = other.distance < first.distance
        first = Field(*(np.where(nearer, getattr(other, f.name), getattr(first, f.name)) for f in fields(Field)))
        owner[nearer] = k
    return first, owner


def thin_share(body: AnyBody, grid: Grid, time: float) -> float:
    """Return the share of the body's length that is thinner than ``THINNEST`` cells.

    Raises:
        InvalidDesign: the body is too thin everywhere.
    """
    station, thickness = body.shape.thickness(time)
    least, most = THINNEST * grid.cell, float(thickness.max())
    needed = THINNEST if body.shape.sheet(time, Pose()) is None else THINNEST_SHEET
    if most < needed * grid.cell:
        raise InvalidDesign(
            f"{body.name} is {most:.4g} m thick at most, {most / grid.cell:.2g} cells of {grid.cell:.4g} m; at least "
            f"{needed:.2f} cells are needed. Take cells of at most {most / needed:.3g} m."
        )
    if station.size == 1:
        return float(most < least)
    thin = 0.5 * ((thickness[1:] < least).astype(float) + (thickness[:-1] < least).astype(float))
    return float((thin * np.diff(station)).sum() / (station[-1] - station[0]))
