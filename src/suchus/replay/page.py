"""The page: skins, frames and ground packed into one HTML file with its player."""

import json
import re
from collections.abc import Sequence
from io import StringIO
from math import ceil, floor
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from suchus.design import LEGS, Crocodile
from suchus.design.relief import ASIDE, CELL, REACH, Bumps, Relief, Step, field
from suchus.figures import COLOURS, panels, styled
from suchus.figures.posture import draw_posture
from suchus.kinematics.mass import GRAVITY
from suchus.metrics.gait import LOADED
from suchus.record import new_file, versions
from suchus.replay.ankles import ankles, footed
from suchus.replay.frames import Frames, checked, frames
from suchus.replay.pack import Pack, quantised
from suchus.skin import Skin, skin

_ARROW = 0.35  # length of an arrow that stands for the whole weight, over the robot's length
_BESIDE = 0.62  # how far a second robot walks beside the first, over the robot's length
_FORCE, _MASS, _SUPPORT, _GHOST, _RELIEF = "#D98200", COLOURS["alarm"], "#B8860B", "#6F9DC4", "#B9AE98"


def replay(
    record: xr.Dataset,
    robot: Crocodile,
    *,
    ghost: xr.Dataset | None = None,
    labels: Sequence[str] = ("this run", "the other run"),
    title: str = "",
    caption: str = "",
    relief: Relief | None = None,
    overlaid: bool = False,
) -> str:
    """Return a run as an HTML page that plays offline and needs nothing else.

    Args:
        record: of one run on land.
        robot: whose it is.
        ghost: another run of the same robot, half transparent, for comparison.
        labels: what the two runs are called.
        title: heading; by default robot and gait.
        caption: one or two sentences: what there is to see.
        relief: what stood up from the ground.
        overlaid: whether the two begin in the same place, which suits relief, or side by side.

    Raises:
        IncompatibleRecord: a record is no run on land, several runs, of another robot, or without a frame.
    """
    runs = [checked(one, robot) for one in (record, ghost) if one is not None]
    first = frames(runs[0], robot)
    moving = [first, *(frames(run, robot, first.rate) for run in runs[1:])]
    pack, surface = Pack(), skin(robot)
    x = np.concatenate([one.mass[:, 0] for one in moving])
    meta = {
        "start": first.start,
        "rate": first.rate,
        "bones": len(surface.bones) + len(LEGS),
        "length": robot.length,
        "aside": _BESIDE * robot.length,
        "loaded": LOADED,
        "overlaid": overlaid,
        "floor": float(field(relief).min()) if isinstance(relief, Bumps) else 0.0,  # as deep as the field, as in model
        "metres_per_newton": _ARROW * robot.length / (robot.mass * GRAVITY),
        "marks": [max(floor(x.min()) - 1, -50), min(ceil(x.max()) + 1, 50)],
        "mark_side": -0.4 * robot.length,
        "colours": _colours(),
        "skins": [_packed_skin(robot, surface, pack)],
        "actors": [_packed(one, name, robot, pack) for one, name in zip(moving, labels, strict=False)],
        "relief": [] if relief is None else [_packed_relief(relief, pack)],
    }
    title = title or f"{robot.name}: {_text(record, 'gait', 'a run on land').replace('_', ' ')}"
    still = _still(robot, runs[0])
    return _environment().get_template("replay.html").render(
        title=title,
        caption=" ".join(caption.split()),
        alt=_told(robot, moving, labels),
        still=Markup(still[0]),
        still_time=still[1],
        ghost=labels[1] if ghost is not None else "",
        overlaid=overlaid,
        keys={"force": _FORCE, "support": _SUPPORT, "mass": _MASS, "legs": [(leg, COLOURS[leg]) for leg in LEGS]},
        arrow=f"{100 * _ARROW * robot.length:.0f} cm",
        version=versions()["suchus"],
        meta=Markup(json.dumps(meta, separators=(",", ":")).replace("</", "<\\/")),
        data=pack.text(),
    )  # fmt: skip


def save(page: str, path: Path) -> Path:
    """Write a page, which appears complete or not at all, and return its path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    with new_file(path) as draft:
        draft.write_text(page, encoding="utf-8")
    return path


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("suchus.replay"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    loader = environment.loader
    assert loader is not None
    for name, file in (("style", "player.css"), ("player", "player.js")):
        environment.globals[name] = Markup(loader.get_source(environment, file)[0])
    return environment


def _packed_skin(robot: Crocodile, surface: Skin, pack: Pack) -> dict[str, Any]:
    vertices, scale = quantised(surface.vertices, np.int16)
    indices, rest = footed(robot, surface)
    assert (surface.weights[:, 2:] == 0).all()  # joints are so far apart that no vertex hangs on three bones
    return {
        "scale": scale,
        "rest": np.round(rest, 7).tolist(),
        "vertices": pack.add(vertices),
        "normals": pack.add(np.round(127 * surface.normals).astype(np.int8)),
        "colours": pack.add(surface.colours),
        "bones": pack.add(indices.astype(np.uint8)),
        "weights": pack.add(np.round(255 * surface.weights[:, 0]).astype(np.uint8)),
        "faces": pack.add(surface.faces.astype(np.uint16)),
    }


def _packed(one: Frames, label: str, robot: Crocodile, pack: Pack) -> dict[str, Any]:
    bones = ankles(robot, skin(robot), one.bones, one.feet)
    places = bones.positions
    origin = (places.max(axis=(0, 1)) + places.min(axis=(0, 1))) / 2
    whole, reach = quantised(places - origin, np.int16)
    return {
        "label": label,
        "skin": 0,
        "frames": len(one.mass),
        "origin": np.round(origin, 6).tolist(),
        "reach": reach,
        "radii": [robot.leg(leg).foot_radius for leg in LEGS],
        "arrays": {
            "places": pack.add(whole),
            "turns": pack.add(np.round(32767 * bones.quaternions).astype(np.int16)),
            "mass": pack.add(one.mass.astype(np.float32)),
            "feet": pack.add(one.feet.astype(np.float32)),
            "forces": pack.add(one.forces.astype(np.float32)),
        },
    }


def _packed_relief(relief: Relief, pack: Pack) -> dict[str, Any]:
    if isinstance(relief, Bumps):
        heights = field(relief)
        whole, largest = quantised(heights, np.int16)
        return {
            "heights": pack.add(whole),
            "shape": list(heights.shape),
            "scale": largest / np.iinfo(np.int16).max,
            "x0": REACH[0],
            "y0": -ASIDE,
            "cell": CELL,
        }
    if isinstance(relief, Step):
        return {"block": [relief.at, REACH[1], -ASIDE, ASIDE, relief.height]}
    half, wide = relief.length / 2, relief.width / 2
    x, y = (relief.at - half, relief.at + half), (relief.aside - wide, relief.aside + wide)
    return {"block": [*x, *y, relief.height]}


def _colours() -> dict[str, Any]:
    parts = {"force": _FORCE, "mass": _MASS, "support": _SUPPORT, "ghost": _GHOST, "relief": _RELIEF}
    return {name: _rgb(text) for name, text in parts.items()} | {"legs": [_rgb(COLOURS[leg]) for leg in LEGS]}


def _rgb(text: str) -> list[float]:
    return [round(int(text[i : i + 2], 16) / 255, 4) for i in (1, 3, 5)]


def _told(robot: Crocodile, moving: Sequence[Frames], labels: Sequence[str]) -> str:
    """Return the replay in words, for those who cannot see it."""
    ways = [
        f"{label}: {one.mass[-1, 0] - one.mass[0, 0]:.2f} m forward in {(len(one.mass) - 1) / one.rate:.1f} s"
        for one, label in zip(moving, labels, strict=False)
    ]
    return f"Three-dimensional replay of the robot {robot.name} on the ground. {'; '.join(ways)}."


def _still(robot: Crocodile, record: xr.Dataset) -> tuple[str, str]:
    """Return a still picture as SVG, and its time."""
    time = float(record.time[record.sizes["time"] // 2])
    with styled(svg__hashsalt="replay"):
        figure, axes = panels(2, 1, width=8.0, height=6.0)
        draw_posture(axes[0, 0], robot, record, time, view="above")
        draw_posture(axes[1, 0], robot, record, time, view="side")
        axes[0, 0].set_ylabel("y [m]")
        axes[1, 0].set_ylabel("z [m]")
        axes[1, 0].set_xlabel("x [m]")
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    svg = re.sub(r"(\d\.\d\d)\d+", r"\1", text.getvalue())  # a hundredth of a point is fine enough
    label = f'<svg role="img" aria-label="The robot at {time:.1f} s, from above and from the side" '
    return label + svg[svg.index("<svg") + 5 :], f"{time:.1f} s"


def _text(record: xr.Dataset, name: str, otherwise: str) -> str:
    return str(record[name].values.ravel()[0]) if name in record.coords else otherwise
