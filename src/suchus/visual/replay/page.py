"""The page: a run or a swim in space, packed into one HTML file with its player."""

import base64
import re
from collections.abc import Sequence
from io import BytesIO, StringIO
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from markupsafe import Markup
from PIL import Image

from suchus.core.errors import InvalidDesign
from suchus.core.files import write
from suchus.robot.design import Robot
from suchus.robot.design.ground import Ground
from suchus.sim.record import ground_of
from suchus.visual.figures import limb_colours, panels, styled, vortices
from suchus.visual.figures.posture import draw_posture
from suchus.visual.pages import embed_json, render
from suchus.visual.replay.frames import Frames, check_record, frames
from suchus.visual.replay.scene import ARROW, KEYS, PackedArrays, quantise, scene


def replay(
    record: xr.Dataset,
    robot: Robot,
    *,
    ghost: xr.Dataset | None = None,
    labels: Sequence[str] = ("this run", "the other run"),
    title: str = "",
    caption: str = "",
    overlaid: bool = False,
) -> str:
    """Return a run as an HTML page that plays offline and needs nothing else.

    The ground is the one that the record holds, level and even where it holds none.

    Args:
        record: record of one run on land.
        robot: robot of the record.
        ghost: another run of the same robot, half transparent, for comparison.
        labels: what the two runs are called.
        title: heading; by default robot and gait.
        caption: one or two sentences: what there is to see.
        overlaid: whether the two begin in the same place or side by side; on ground that is not even they always do.

    Raises:
        IncompatibleRecord: a record is no run on land, several runs, of another robot, or without a frame.
        InvalidDesign: there are more runs than labels.
    """
    return render_template("replay.html", record, robot, ghost=ghost, labels=labels, title=title, caption=caption,
                    overlaid=overlaid)  # fmt: skip


def render_template(
    template: str,
    record: xr.Dataset,
    robot: Robot,
    *,
    ghost: xr.Dataset | None = None,
    other_records: Sequence[xr.Dataset] = (),
    choice: str = "",
    labels: Sequence[str],
    title: str = "",
    caption: str = "",
    overlaid: bool = False,
    is_live: bool = False,
    **template_values: Any,
) -> str:
    """Return a template that extends ``replay.html``, filled with runs; see ``replay``.

    Args:
        template: its file name.
        record: record of one run on land.
        robot: robot of the record.
        ghost: another run of the same robot, half transparent.
        other_records: instead of a ghost, further runs of the robot on such ground, of which a slider chooses one.
        choice: the name of that slider.
        labels: what the runs are called.
        title: heading; by default robot and gait.
        caption: one or two sentences.
        overlaid: whether run and ghost begin in the same place.
        is_live: whether the page goes on from the records by itself; else it speaks of feet only where they stand.
        **template_values: further values that the template names.

    Raises:
        IncompatibleRecord: a record is no run on land, several runs, of another robot, or without a frame.
        InvalidDesign: there are more runs than labels.
    """
    records = [record, *other_records, *([] if ghost is None else [ghost])]
    if len(labels) < len(records):
        raise InvalidDesign(f"a replay of {len(records)} runs has {len(labels)} labels; give each run a name.")
    runs = [check_record(run_record, robot) for run_record in records]
    grounds = [ground_of(run_record) or Ground() for run_record in records]
    first_frames = frames(runs[0], robot)
    moving = [first_frames, *(frames(run, robot, first_frames.rate) for run in runs[1:])]
    overlaid = overlaid or grounds[0].relief is not None
    meta, data = scene(robot, moving, labels, grounds[0], overlaid=overlaid)
    still_picture, still_time = _still_picture(robot, runs[0])
    return render(
        template,
        title=title or f"{robot.name}: {_gait_text(record).replace('_', ' ')}",
        caption=" ".join(f"{caption} {_ground_text(grounds)}".split()),
        alt=_in_words(robot, moving, labels),
        still=Markup(still_picture),
        still_time=still_time,
        ghost=labels[1] if ghost is not None else "",
        choice=choice,
        choices=len(records),
        beside=grounds[0].relief is None,
        overlaid=overlaid,
        keys=KEYS | {"legs": limb_colours(robot)},
        stands=bool(limb_colours(robot)) and (is_live or any(run.forces.any() for run in moving)),
        arrow=f"{100 * ARROW * robot.length:.0f} cm",
        meta=embed_json(meta | {"chosen": bool(choice)}),
        data=data,
        **template_values,
    )  # fmt: skip


def save(page: str, path: str | Path) -> Path:
    """Write a page, which appears complete or not at all, and return its path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    return write(path, page)


def _ground_text(grounds: Sequence[Ground]) -> str:
    """Return a sentence on the slope of the ground, and on a second run's other ground."""
    slopes = [
        f"{'rises' if angle > 0 else 'falls'} by {abs(degrees(angle)):.3g}° {direction}"
        for angle, direction in ((grounds[0].uphill, "ahead"), (grounds[0].sideways, "to the left"))
        if angle
    ]
    text = f"The ground {' and '.join(slopes)}." if slopes else ""
    if not all(ground.looks_like(grounds[0]) for ground in grounds[1:]):
        text += " The half transparent one went on other ground, which is not shown."
    return text


def _in_words(robot: Robot, moving: Sequence[Frames], labels: Sequence[str]) -> str:
    """Return a text alternative to the replay."""
    paths = [
        f"{label}: {run.mass[-1, 0] - run.mass[0, 0]:.2f} m forward in {(len(run.mass) - 1) / run.rate:.1f} s"
        for run, label in zip(moving, labels, strict=False)
    ]
    medium = "on the ground" if moving[0].level is None else "in water"
    return f"Three-dimensional replay of the robot {robot.name} {medium}. {'; '.join(paths)}."


def _still_picture(robot: Robot, record: xr.Dataset) -> tuple[str, str]:
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


def _gait_text(record: xr.Dataset) -> str:
    return str(record.gait.values.ravel()[0]) if "gait" in record.coords else "a run on land"


MAX_ARRAY_BYTES = 3_500_000
"""Bytes of arrays from which the surfaces are taken of blocks of cells [-]; as text they take a third more."""
_MAX_BLOCK = 4


def wake_replay(record: xr.Dataset, *, title: str = "", caption: str = "") -> str:
    """Return a cycle of a swim as an HTML page that plays offline and needs nothing else.

    Args:
        record: record of ``water.resolved`` in space with frames, or of the experiment ``swim_3d``.
        title: heading.
        caption: one or two sentences: what there is to see.

    Raises:
        IncompatibleRecord: the record holds no vortices of a swim in three dimensions.
    """
    vortices.check_vortex_record(record)
    meta, data = _swim_scene(record)
    still_picture = vortices.still_picture(record, record.sizes["frame"] - 1)
    png = BytesIO()
    Image.fromarray(still_picture).save(png, format="PNG", optimize=True)
    picture = base64.b64encode(png.getvalue()).decode("ascii")
    return render(
        "wake.html",
        title=title or "A swim in three dimensions",
        caption=" ".join(caption.split()),
        alt=f"Three-dimensional replay of a swimming body and the vortices around it, {record.sizes['frame']} instants "
        "of one cycle.",
        still=picture,
        limit=f"{meta['limit']:.3g}",
        keys={"left": vortices.hex_colour(1.0), "right": vortices.hex_colour(-1.0)},
        meta=embed_json(meta),
        data=data,
    )  # fmt: skip


def _swim_scene(record: xr.Dataset) -> tuple[dict[str, Any], str]:
    """Return the player's metadata and arrays, on the finest blocks whose surfaces are small enough."""
    for coarse in range(1, _MAX_BLOCK + 1):
        pack = PackedArrays()
        meta = _packed_swim(record, pack, coarse)
        if pack.size <= MAX_ARRAY_BYTES or coarse == _MAX_BLOCK:
            break
    return meta, pack.text()


def _packed_swim(record: xr.Dataset, pack: PackedArrays, coarse: int) -> dict[str, Any]:
    """Pack the surfaces and the body of every frame and return the metadata that the player reads.

    Args:
        record: record of a swim in space with frames.
        pack: takes the arrays.
        coarse: cells along each side of a block of which surfaces are taken [-].
    """
    limit = vortices.colour_limit(record)
    surfaces = [vortices.surface(record, i, coarse=coarse) for i in range(record.sizes["frame"])]
    center = np.array([0.5 * float(record[axis].min() + record[axis].max()) for axis in "xy"] + [0.0])
    scale = max(float(np.abs(mesh.points - center).max(initial=0.0)) for mesh, _ in surfaces) or 1.0
    frames = []
    for mesh, spin in surfaces:
        points = np.round((mesh.points - center) / scale * np.iinfo(np.int16).max).astype(np.int16)
        shades = np.round(127.0 * np.clip(spin / limit, -1.0, 1.0)).astype(np.int8)
        small = len(points) <= np.iinfo(np.uint16).max
        faces = pack.add(mesh.faces.astype(np.uint16 if small else np.uint32))
        frames.append({"points": pack.add(points), "spin": pack.add(shades), "faces": faces})
    lines = {
        name.removeprefix("film_"): quantise(record[name].values, np.int16) for name in vortices.LINES
    }  # fmt: skip
    return {
        "frames": frames,
        "phase": np.round(record.frame.values.astype(float), 4).tolist(),
        "middle": np.round(center, 6).tolist(),
        "scale": scale,
        "limit": limit,
        "coarse": coarse,
        "stations": record.sizes["station"],
        "length": round(float(np.ptp(record.film_x.values[0])), 4),
        "lines": {name: {"array": pack.add(values), "scale": size} for name, (values, size) in lines.items()},
        "high": pack.add(record.half_height.values.astype(np.float32)),
        "skin": vortices.SKIN,
        "ramp": np.round(vortices.colours(np.linspace(-limit, limit, 9), limit), 4).tolist(),
    }
