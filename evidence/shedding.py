"""What the end of a long body sheds: flows around bodies that heave in a stream along them, and a kept table.

Slender-body theory gives a section with the added mass m the lateral force ``-U w dm/dx``, with the stream U along the
body and its lateral velocity w. A nose is held back by U m w. A tail gets the same again, forward, if the water follows
the body to its end, and nothing if the water leaves. The *share* that is shed is one minus what the tail gets again.

A body of constant section with a round nose heaves in a stream, in space, or lies in one at an angle. Nose, middle and
tail have forces of their own. In the middle m is constant, and what resists there is drag across the body; it is taken
off nose and tail by their lengths. What remains over rho pi b^2 U w, with the half-height b of the middle, is one at a
nose, which is a check, and minus what is got again at a tail. Of a heave the part in phase with the velocity counts.

Sources: Lighthill 1960, J. Fluid Mech. 9, 305; Jones 1946, NACA Report 835 (slender wings).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, isfinite, radians
from typing import Any

import numpy as np
from jaxtyping import Float

from suchus import flow

ENDS = ("square", "round", "pointed")
"""Shapes of the end: of full height to the end, half an ellipse of a half-height, and a straight taper to a point."""
ASPECTS = (1.0, 2.0)
"""Heights over width of the table [-]."""
KEULEGAN_CARPENTER = (1.0, 4.0, inf)
"""Greatest lateral velocity times period over height of the table [-]; without a bound at a constant angle."""
TAPER, NOSE, ROUND = 0.3, 0.2, 0.1
"""Lengths of the pointed taper, of the nose and of the round end [body length]."""
HALF_HEIGHT = 0.1
"""Half of the height of the body [body length]."""
CUTS = (0.3, 0.7)
"""Where nose, middle and tail meet [body length]."""
STRIDE, ANGLE = 2.0, radians(10.0)
"""Speed of the stream [body length a period], and the constant angle of incidence [rad]."""
THIN_ASPECT, THIN_CELLS = 4.0, 69
"""Height over width of one more pointed end at a constant angle, and cells per body length that carry it [-]."""
CELLS, FINE_CELLS, LAYER_CELLS = 40, 56, 0.85
"""Cells per body length, those of the check, and cells in a boundary layer of the greatest velocity [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Heave:
    """A body that heaves in a stream; length, density and period are 1."""

    end: str
    """Shape of its end, one of ``ENDS``."""
    aspect: float
    """Height over width [-]."""
    keulegan_carpenter: float
    """Greatest lateral velocity times period over height [-]; infinite for a constant angle of incidence."""
    cells: int = CELLS
    """Cells per body length [-]."""
    viscosity_factor: float = 1.0
    """Factor on the least viscosity that the standard cells carry [-]."""

    @property
    def is_steady(self) -> bool:
        """Whether it lies at a constant angle."""
        return not isfinite(self.keulegan_carpenter)

    @property
    def velocity(self) -> float:
        """Greatest lateral velocity against the water [body length a period]."""
        return STRIDE * np.tan(ANGLE) if self.is_steady else self.keulegan_carpenter * 2.0 * HALF_HEIGHT

    def half_heights(self, s: Float[np.ndarray, " station"]) -> Float[np.ndarray, " station"]:
        """Return the half-heights at arc lengths from the nose, both in body lengths."""
        nose = np.sqrt(np.maximum(1.0 - (1.0 - np.minimum(s / NOSE, 1.0)) ** 2, 0.0))
        if self.end == "pointed":
            tail = np.clip((1.0 - s) / TAPER, 0.02, 1.0)
        elif self.end == "round":
            tail = np.sqrt(np.maximum(1.0 - np.maximum((s - 1.0 + ROUND) / ROUND, 0.0) ** 2, 4e-4))
        else:
            tail = np.ones_like(s)
        return HALF_HEIGHT * np.minimum(np.maximum(nose, 0.05), tail)

    def pose(self, time: float) -> flow.Pose:
        """Return the pose at a time: a heave that grows over the first half period; at rest at a constant angle."""
        if self.is_steady:
            return flow.Pose(position=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0))
        turn, amplitude = 2.0 * np.pi, self.velocity / (2.0 * np.pi)
        part = min(2.0 * time, 1.0)
        grown, rate = part**2 * (3.0 - 2.0 * part), 12.0 * part * (1.0 - part)
        y = amplitude * grown * np.sin(turn * time)
        speed = amplitude * (grown * turn * np.cos(turn * time) + rate * np.sin(turn * time))
        return flow.Pose(position=(0.0, float(y), 0.0), velocity=(0.0, float(speed), 0.0))

    def setup(self) -> flow.Setup:
        """Return the flow around the body, of which the half above its plane of symmetry is computed."""
        s = np.linspace(0.0, 1.0, 2 * self.cells + 1)
        high, none = self.half_heights(s), np.zeros_like(s)
        state = flow.MidlineState(
            x=s, y=none, heading=none, half_width=high / self.aspect, x_rate=none, y_rate=none, heading_rate=none
        )
        trunk = flow.Trunk(spine=lambda _: state, half_height=high, cuts=CUTS, deforms=False)
        beside = (0.0 if self.is_steady else self.velocity / (2.0 * np.pi)) + 0.4
        sides = flow.Sides(low=flow.Mirror())
        grid = flow.Grid.covering(
            (-0.35, 1.65), (-beside, beside), (0.0, HALF_HEIGHT + 0.3), cell=1.0 / self.cells, sides=sides
        )
        fastest = float(np.hypot(STRIDE, self.velocity))
        return flow.Setup(
            grid=grid, viscosity=self.viscosity_factor * fastest * (LAYER_CELLS / CELLS) ** 2,
            stream=(STRIDE, self.velocity if self.is_steady else 0.0, 0.0),
            bodies=(flow.Body(shape=trunk, motion=self.pose),), sides=sides,
        )  # fmt: skip

    def resistances(self) -> Float[np.ndarray, "window part"]:
        """Return the force of each part that resists its lateral velocity, in two windows of the end of the flow.

        Of a heave they are its second and third period, of a constant angle the last quarters of its time.
        """
        record = flow.Simulation(self.setup()).run(3.0 if not self.is_steady else 3.0 / STRIDE, progress=False)
        series, middles = record.part_series("force_y"), record.time - 0.5 * record.step
        rows = []
        for start, end in ((1.0, 2.0), (2.0, 3.0)) if not self.is_steady else ((2.0, 2.5), (2.5, 3.0)):
            scale = 1.0 if not self.is_steady else 1.0 / STRIDE
            part = (middles > start * scale) & (middles <= end * scale)
            weight = record.step[part] / record.step[part].sum()
            if not self.is_steady:
                weight = -2.0 * np.cos(2.0 * np.pi * middles[part]) * weight
            rows.append(weight @ series[part])
        return np.array(rows)

    def ends(self) -> tuple[Float[np.ndarray, " window"], Float[np.ndarray, " window"]]:
        """Return what nose and tail resist over rho pi b^2 U w, without drag across the body, in two windows."""
        resisted = self.resistances() / (np.pi * HALF_HEIGHT**2 * STRIDE * self.velocity)
        lengths = np.diff([0.0, *CUTS, 1.0])
        clean = resisted - resisted[:, 1:2] * lengths / lengths[1]
        return clean[:, 0], clean[:, 2]


def table() -> dict[str, Any]:
    """Return the share of Lighthill's momentum that each end sheds, with its interval.

    Returns:
        ``rows``: for each end, height over width and KC (0 stands for a constant angle) the share, its interval and
        the nose's check, see ``with_interval``; ``error``: of the flows, the greatest change of a share between
        windows, with the fine cells and with twice the viscosity.
    """
    cases = [Heave(end=end, aspect=aspect, keulegan_carpenter=kc) for end in ENDS for aspect in ASPECTS
             for kc in KEULEGAN_CARPENTER]  # fmt: skip
    thin = Heave(end="pointed", aspect=THIN_ASPECT, keulegan_carpenter=inf, cells=THIN_CELLS)
    rows: list[dict[str, Any]] = []
    errors = [0.0]
    for case in [*cases, thin]:
        nose, tail = case.ends()
        errors.append(float(abs(tail[1] - tail[0])))
        rows.append(
            {"end": case.end, "aspect": case.aspect, "kc": 0.0 if case.is_steady else case.keulegan_carpenter,
             "share": float(1.0 + tail[1]), "nose": float(nose[1])}
        )  # fmt: skip
    for row in rows:
        if row["aspect"] == ASPECTS[-1] and row["kc"] == 0.0 and row["end"] != "round":
            standard = Heave(end=row["end"], aspect=row["aspect"], keulegan_carpenter=inf)
            for other in (replace(standard, cells=FINE_CELLS), replace(standard, viscosity_factor=2.0)):
                errors.append(float(abs(1.0 + other.ends()[1][1] - row["share"])))
    error = max(errors)
    return {"error": error, "rows": [with_interval(row, error) for row in rows]}


def with_interval(row: Mapping[str, Any], error: float) -> dict[str, Any]:
    """Return a row of the table with the interval of its share.

    A nose that gives more or less than one says by how much the unit is off on a body of this slenderness. The interval
    holds the share with the unit of theory and with that of the nose, and the error of the flows beyond both.

    Args:
        row: share and nose of one body.
        error: half-width of the error of the flows [-].
    """
    ends = (row["share"], 1.0 - (1.0 - row["share"]) / row["nose"])
    return {**row, "low": min(ends) - error, "high": max(ends) + error}


def shed_range(values: Mapping[str, Any], end: str) -> tuple[float, float, float]:
    """Return the share that an end sheds over all heights over width and KC of a table: mean, least and greatest.

    Args:
        values: the table.
        end: one of ``ENDS``.
    """
    rows = [row for row in values["rows"] if row["end"] == end]
    return (
        float(np.mean([row["share"] for row in rows])), max(min(row["low"] for row in rows), 0.0),
        max(row["high"] for row in rows),
    )  # fmt: skip
