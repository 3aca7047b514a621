"""Outlines of parts for printers and cutters: STL by trimesh, DXF by ezdxf (extra ``parts``)."""

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from suchus.core.errors import SuchusError
from suchus.hardware.parts import BodyPart, Sheet, TailPlate
from suchus.robot.kinematics.tree import frames

CORD_HOLE = 0.002
"""Diameter of a hole for a cord [m]: a braided line of 1 mm runs freely."""
_MM = 1000.0
_GAP = 0.006  # between plates on the drawing [m]
_SIDES = 48


class NoOutlines(SuchusError, ImportError):
    """The libraries that write outlines are not installed."""


def libraries() -> tuple[Any, Any]:
    """Return trimesh and ezdxf.

    Raises:
        NoOutlines: one of them is not installed.
    """
    try:
        import ezdxf  # noqa: PLC0415  an optional extra
        import trimesh  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise NoOutlines(
            f"outlines as STL and DXF need {error.name}; install it with: pip install 'suchus[parts]'."
        ) from error
    return trimesh, ezdxf


def stl(body_part: BodyPart) -> bytes:
    """Return the outline of a rod, a shell or a foot as a binary STL, its middle at the origin [mm].

    A rod lies along z.

    Raises:
        NoOutlines: trimesh is not installed.
    """
    trimesh, _ = libraries()
    length, width, height = (_MM * side for side in body_part.size)
    if body_part.kind == "rod":
        mesh = trimesh.creation.capsule(height=length - width, radius=width / 2, count=[_SIDES, _SIDES])
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
    else:
        mesh = trimesh.creation.icosphere(subdivisions=4, radius=1.0)
        mesh.apply_scale([length / 2, width / 2, height / 2])
    data: bytes = mesh.export(file_type="stl")
    return data


def plates_dxf(plates: Sequence[TailPlate]) -> str:
    """Return all plates side by side as a DXF [mm]: layer CUT for their rims, DRILL for the holes, TEXT for names.

    Raises:
        NoOutlines: ezdxf is not installed.
    """
    _, ezdxf = libraries()
    drawing = _drawing(ezdxf, {"CUT": 1, "DRILL": 5, "TEXT": 7})
    space, x = drawing.modelspace(), 0.0
    for plate in plates:
        radius = _MM * plate.radius
        x += radius
        space.add_circle((x, 0.0), radius, dxfattribs={"layer": "CUT"})
        for lateral_offset, height in plate.holes:
            middle = (x + _MM * lateral_offset, _MM * height)
            space.add_circle(middle, _MM * CORD_HOLE / 2, dxfattribs={"layer": "DRILL"})
        label = f"{plate.name}, {_MM * plate.thickness:.1f} mm thick"
        space.add_text(label, height=2.0, dxfattribs={"layer": "TEXT"}).set_placement((x - radius, radius + 2.0))
        x += radius + _MM * _GAP
    return _text(drawing)


def top_dxf(sheet: Sheet) -> str:
    """Return the parts of a robot from above, all joints at zero, as a DXF [mm], a layer for each body.

    x is forward and y left, as in the simulation; a crosshair of the layer JOINTS marks each hinge.

    Raises:
        NoOutlines: ezdxf is not installed.
    """
    _, ezdxf = libraries()
    bodies = [body.name for body in sheet.bodies]
    drawing = _drawing(ezdxf, {**{name: i % 6 + 1 for i, name in enumerate(bodies)}, "JOINTS": 7})
    space = drawing.modelspace()
    origins = frames(sheet.robot, np.zeros(len(sheet.joints))).positions
    origin_by_body = dict(zip(bodies, origins, strict=True))
    for body_part in sheet.parts:
        if body_part.kind not in ("rod", "shell", "foot"):
            continue
        x, y, _ = _MM * (origin_by_body[body_part.body] + np.array(body_part.centre))
        length, width, _ = (_MM * side for side in body_part.size)
        layer = {"layer": body_part.body}
        if body_part.kind == "rod":
            space.add_lwpolyline(
                _stadium(x, y, length, width, azimuth=_rod_azimuth(sheet, body_part)), close=True, dxfattribs=layer
            )
        else:
            major, ratio = (
                ((length / 2, 0, 0), width / length) if length >= width else ((0, width / 2, 0), length / width)
            )
            space.add_ellipse((x, y), major_axis=major, ratio=ratio, dxfattribs=layer)
    for joint in sheet.joints:
        x, y = _MM * joint.at[0], _MM * joint.at[1]
        for dx, dy in ((3.0, 0.0), (0.0, 3.0)):
            space.add_line((x - dx, y - dy), (x + dx, y + dy), dxfattribs={"layer": "JOINTS"})
    return _text(drawing)


def _rod_azimuth(sheet: Sheet, body_part: BodyPart) -> float:
    """Return the direction of a rod seen from above [rad]: 0 along the body, sideways for the links of limbs."""
    robot = sheet.robot
    in_limb = any(body_part.name.startswith((f"L{girdle.name}_", f"R{girdle.name}_")) for girdle in robot.girdles)
    if not in_limb:
        return 0.0
    link = next(link for g in robot.girdles for link in g.limb.links if body_part.name[1:] == f"{g.name}_{link.name}")
    side = 1.0 if body_part.name.startswith("L") else -1.0
    return float(np.arctan2(side * link.end[1], link.end[0]))


def _stadium(x: float, y: float, length: float, width: float, azimuth: float) -> list[tuple[float, float]]:
    """Return the outline of a rod with round ends, seen from above [mm]."""
    reach, radius = max(length - width, 0.0) / 2, width / 2
    turns = np.linspace(-np.pi / 2, np.pi / 2, _SIDES // 2)
    half = np.column_stack([reach + radius * np.cos(turns), radius * np.sin(turns)])
    points = np.concatenate([half, -half])
    c, s = np.cos(azimuth), np.sin(azimuth)
    return [(float(x + c * u - s * v), float(y + s * u + c * v)) for u, v in points]


def _drawing(ezdxf: Any, layers: dict[str, int]) -> Any:
    drawing = ezdxf.new("R2010", units=4)  # millimetres
    for name, colour in layers.items():
        drawing.layers.add(name, color=colour)
    return drawing


def _text(drawing: Any) -> str:
    stream = io.StringIO()
    drawing.write(stream)
    return stream.getvalue()
