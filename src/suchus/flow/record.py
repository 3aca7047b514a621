"""The record of a simulation: one row for each time step."""

from dataclasses import dataclass, field
from math import isfinite
from warnings import warn

import numpy as np

from suchus.core import rotation
from suchus.core.errors import Doubtful, OutsideLimits, UnknownName
from suchus.flow.pose import angle_text

COLUMNS = (
    "pressure_x", "pressure_y", "shear_x", "shear_y", "torque", "power", "x", "y", "angle", "velocity_x", "velocity_y",
    "spin", "force_x", "force_y", "layer_error",
)  # fmt: skip
"""Quantities of each body at each step, in the order of the last axis of ``Record.bodies``. ``layer_error`` is the
estimated relative error of the force, see ``resolution``; the thin layer of a sudden start counts as it is then."""

SPACE_COLUMNS = (
    "torque_x", "torque_y", "torque", "power", "x", "y", "z", "angle", "pitch", "roll", "velocity_x", "velocity_y",
    "velocity_z", "spin_x", "spin_y", "spin", "force_x", "force_y", "force_z", "layer_error",
)  # fmt: skip
"""The same in space, where no pressure and friction are read along the skin.

``torque`` and ``spin`` are those about z, ``angle`` is the yaw; see ``Pose``. The angle of a body that turns about z
alone counts whole turns, else it lies between -pi and pi.
"""

PART_COLUMNS = ("force_x", "force_y", "torque", "power", "torque_behind")
"""Values kept of each part of a divided body, in the order of the last axis of ``Record.parts``.

Force along x and y [N]; torque about z through the point that the torque of the whole body is about [N m]; power that
the part gives to the water [W]; and the torque, about the body's z through the midline at the part's front end, of
all that lies behind it [N m]: what the water asks of a joint at that place. The pressure inside the body acts across a
cut on both of its parts. It cancels in their sum, and since it acts along the midline a joint does not feel it.
"""

_UNITS = {
    "power": "W", **dict.fromkeys(("x", "y", "z"), "m"), **dict.fromkeys(("angle", "pitch", "roll"), "rad"),
    **dict.fromkeys(("spin", "spin_x", "spin_y"), "rad s-1"), "layer_error": "1",
}  # fmt: skip

ROW_HEADER_SIZE = 5
"""Numbers at the start of a row: time, step, two counts of cycles, divergence [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Coefficients:
    """Force, torque and power of a body over those of a reference, mean over each step, each of shape (step,) [-]."""

    time: np.ndarray
    """Times in the middle of the steps, to which the means belong, shape (step,) [s]."""
    drag: np.ndarray
    """Force along the stream over ``density speed^2 length / 2``, in space with the area for the length."""
    lift: np.ndarray
    """Force across the stream, a quarter turn counter-clockwise from the drag, over the same reference."""
    moment: np.ndarray
    """Torque, counter-clockwise, over ``density speed^2 length^2 / 2``."""
    power: np.ndarray
    """Power that the body gives to the water over ``density speed^3 length / 2``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """Time series of a simulation: in the plane per metre of depth, in space of whole bodies."""

    names: tuple[str, ...]
    """Names of the bodies."""
    time: np.ndarray
    """Time at the end of each step, shape (step,) [s]."""
    step: np.ndarray
    """Length of each step, shape (step,) [s]."""
    cycles: np.ndarray
    """Multigrid cycles of the first and the last pressure solve of each step, shape (step, 2) [-]."""
    divergence: np.ndarray
    """Largest remaining divergence, over the fastest speed per cell, shape (step,) [-]."""
    bodies: np.ndarray
    """The ``columns`` of each body, shape (step, body, column); see ``units``."""
    columns: tuple[str, ...] = COLUMNS
    """Names of the columns that ``column`` knows: ``COLUMNS`` in the plane, ``SPACE_COLUMNS`` in space."""
    parts: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, len(PART_COLUMNS))))
    """``PART_COLUMNS`` of the parts of all divided bodies, shape (step, part, column)."""
    divided: tuple[int, ...] = ()
    """Parts of each body, 0 for one that is not divided [-]."""

    @property
    def ndim(self) -> int:
        """Number of dimensions: 2 in the plane, 3 in space [-]."""
        return 3 if "force_z" in self.columns else 2

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column, as CF conventions write it; forces in the plane are per metre of depth."""
        force, torque = ("N", "N m") if self.ndim == 3 else ("N m-1", "N")
        unit_by_column = {**_UNITS, **dict.fromkeys(("torque", "torque_x", "torque_y"), torque)}
        unit_by_column["power"] = "W" if self.ndim == 3 else "W m-1"
        return {n: unit_by_column.get(n, "m s-1" if n.startswith("velocity") else force) for n in self.columns}

    def column(self, name: str, body: str | int = 0) -> np.ndarray:
        """Return a time series of one body, shape (step,); see ``units``.

        Args:
            name: one of ``columns``.
            body: its name or number.

        Raises:
            UnknownName: there is no such column or body; the message lists those that there are.
        """
        if name not in self.columns:
            raise UnknownName("column", str(name), self.columns)
        return self.bodies[:, self._number(body), self.columns.index(name)]

    def part_series(self, name: str, body: str | int = 0) -> np.ndarray:
        """Return a time series of each part of a divided body, front to back, shape (step, part).

        Args:
            name: one of ``PART_COLUMNS``.
            body: its name or number.

        Raises:
            UnknownName: there is no such column or body; the message lists those that there are.
            OutsideLimits: the body is not divided.
        """
        if name not in PART_COLUMNS:
            raise UnknownName("column", str(name), PART_COLUMNS)
        number = self._number(body)
        if not any(self.divided[number:][:1]):
            raise OutsideLimits(f"body {self.names[number]!r} is not divided; give its Midline or Trunk some cuts.")
        start = sum(self.divided[:number])
        return self.parts[:, start : start + self.divided[number], PART_COLUMNS.index(name)]

    def _number(self, body: str | int) -> int:
        """Return the index of a body by its name or number.

        Raises:
            UnknownName: there is no such body.
        """
        if isinstance(body, str) and body in self.names:
            return self.names.index(body)
        if isinstance(body, str) or not -len(self.names) <= body < len(self.names):
            raise UnknownName("body", str(body), self.names or ("none",))
        return body

    def force(self, body: str | int = 0) -> np.ndarray:
        """Return the force of the water on a body, mean over each step, shape (step, axis).

        The unit is N/m in the plane and N in space. The force is the momentum that body and water exchange.

        Args:
            body: its name or number.
        """
        return np.stack([self.column(f"force_{a}", body) for a in "xyz"[: self.ndim]], axis=1)

    def torque(self, body: str | int = 0) -> np.ndarray:
        """Return the torque of the water on a body, mean over each step.

        The reference point is the centre of mass of a free body and the origin of another one. In space the torque is
        about x, y and z, shape (step, 3) [N m]; in the plane about z, shape (step, 1) [N].

        Args:
            body: its name or number.
        """
        names = ("torque_x", "torque_y", "torque") if self.ndim == 3 else ("torque",)
        return np.stack([self.column(name, body) for name in names], axis=1)

    def attitude(self, body: str | int = 0) -> np.ndarray:
        """Return the attitude of a body in space at the end of each step, unit quaternions wxyz, shape (step, 4) [-].

        Args:
            body: its name or number.

        Raises:
            OutsideLimits: in the plane.
        """
        if self.ndim == 2:
            raise OutsideLimits("a body in the plane has no attitude but its angle; take column('angle').")
        angles = [self.column(name, body) for name in ("angle", "pitch", "roll")]
        quaternions = [rotation.from_angles(*step_angles) for step_angles in zip(*angles, strict=True)]
        return np.array(quaternions).reshape(-1, 4)

    def coefficients(
        self,
        body: str | int = 0,
        *,
        length: float,
        speed: float,
        density: float = 1.0,
        stream_angle: float = 0.0,
        area: float | None = None,
    ) -> Coefficients:
        """Return the coefficients of a body's force, torque and power by a reference.

        Args:
            body: its name or number.
            length: length of the reference, say the diameter or chord [m].
            speed: speed of the reference, say that of the stream [m/s].
            density: density of the water; ``Setup`` has the same default [kg/m^3].
            stream_angle: direction of the stream, counter-clockwise from x in the plane of x and y [rad].
            area: area of the reference, in space and only there, say the frontal area [m^2].

        Raises:
            UnknownName: there is no such body.
            OutsideLimits: a reference that is not a positive number, an area in the plane or none in space.
        """
        if (area is None) != (self.ndim == 2):
            message = "a body in the plane has no area; leave it out" if area else "in space an area is needed; give it"
            raise OutsideLimits(f"the area of the reference is {area}: {message}.")
        size = length if area is None else area
        for name, value, unit in (
            ("length", length, "m"), ("speed", speed, "m/s"), ("density", density, "kg/m3"), ("area", size, "m2"),
        ):  # fmt: skip
            if not (isfinite(value) and value > 0):
                raise OutsideLimits(f"the {name} of the reference is {value} {unit}; give a positive number.")
        text = angle_text("stream_angle", stream_angle)
        if text is not None:
            warn(text, Doubtful, stacklevel=2)
        pressure = 0.5 * density * speed**2
        fx, fy = self.force(body).T[:2] / (pressure * size)
        c, s = np.cos(stream_angle), np.sin(stream_angle)
        return Coefficients(
            time=self.time - self.step / 2, drag=c * fx + s * fy, lift=c * fy - s * fx,
            moment=self.column("torque", body) / (pressure * (length**2 if area is None else area * length)),
            power=self.column("power", body) / (pressure * speed * size),
        )  # fmt: skip

    def surface_force(self, body: str | int = 0) -> np.ndarray:
        """Return the integral of pressure and friction over the outline of a body, shape (step, 2) [N/m].

        It belongs to the end of each step. ``resolution.ALONG_THE_SKIN`` states the error.

        Args:
            body: its name or number.
        """
        return np.stack(
            [self.column(f"pressure_{a}", body) + self.column(f"shear_{a}", body) for a in ("x", "y")], axis=1
        )

    def select_after(self, time: float) -> "Record":
        """Return the record of the steps that end after a time [s]."""
        k = self.time > time
        return Record(
            names=self.names, time=self.time[k], step=self.step[k], cycles=self.cycles[k],
            divergence=self.divergence[k], bodies=self.bodies[k], columns=self.columns,
            parts=self.parts[k] if len(self.parts) == len(k) else self.parts, divided=self.divided,
        )  # fmt: skip
