"""The page: a run packed into one HTML file with its player."""

import json
import re
from collections.abc import Sequence
from io import StringIO
from math import degrees
from pathlib import Path

import xarray as xr
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from suchus.design import Robot
from suchus.design.ground import Ground
from suchus.figures import limb_colours, panels, styled
from suchus.figures.posture import draw_posture
from suchus.record import ground_of, new_file, versions
from suchus.replay.frames import Frames, checked, frames
from suchus.replay.scene import ARROW, KEYS, scene


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
        record: of one run on land.
        robot: whose it is.
        ghost: another run of the same robot, half transparent, for comparison.
        labels: what the two runs are called.
        title: heading; by default robot and gait.
        caption: one or two sentences: what there is to see.
        overlaid: whether the two begin in the same place or side by side; on ground that is not even they always do.

    Raises:
        IncompatibleRecord: a record is no run on land, several runs, of another robot, or without a frame.
    """
    runs = [checked(one, robot) for one in (record, ghost) if one is not None]
    grounds = [ground_of(one) or Ground() for one in (record, ghost) if one is not None]
    first = frames(runs[0], robot)
    moving = [first, *(frames(run, robot, first.rate) for run in runs[1:])]
    overlaid = overlaid or grounds[0].relief is not None
    meta, data = scene(robot, moving, labels, grounds[0], overlaid=overlaid)
    still, still_time = _still(robot, runs[0])
    return environment().get_template("replay.html").render(
        title=title or f"{robot.name}: {_text(record, 'gait', 'a run on land').replace('_', ' ')}",
        caption=" ".join(f"{caption} {_on(grounds)}".split()),
        alt=_in_words(robot, moving, labels),
        still=Markup(still),
        still_time=still_time,
        ghost=labels[1] if ghost is not None else "",
        beside=grounds[0].relief is None,
        overlaid=overlaid,
        keys=KEYS | {"legs": limb_colours(robot)},
        arrow=f"{100 * ARROW * robot.length:.0f} cm",
        version=versions()["suchus"],
        meta=Markup(json.dumps(meta, separators=(",", ":")).replace("<", "\\u003c")),  # begins no tag, no comment
        data=data,
    )  # fmt: skip


def save(page: str, path: Path) -> Path:
    """Write a page, which appears complete or not at all, and return its path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    with new_file(path) as draft:
        draft.write_text(page, encoding="utf-8")
    return path


def environment() -> Environment:
    """Return the templates of the pages, which hold styles and players as globals."""
    found = Environment(
        loader=PackageLoader("suchus.replay"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    loader = found.loader
    assert loader is not None
    files = {"style": "player.css", "shared": "shared.js", "player": "player.js", "wake_player": "wake.js"}
    for name, file in files.items():
        found.globals[name] = Markup(loader.get_source(found, file)[0])
    return found


def _on(grounds: Sequence[Ground]) -> str:
    """Return in words how the ground slopes, and whether the second run's is another one."""
    said = [
        f"{'rises' if angle > 0 else 'falls'} by {abs(degrees(angle)):.3g}° {direction}"
        for angle, direction in ((grounds[0].uphill, "ahead"), (grounds[0].sideways, "to the left"))
        if angle
    ]
    text = f"The ground {' and '.join(said)}." if said else ""
    if not all(other.looks_like(grounds[0]) for other in grounds[1:]):
        text += " The half transparent one went on other ground, which is not shown."
    return text


def _in_words(robot: Robot, moving: Sequence[Frames], labels: Sequence[str]) -> str:
    """Return the replay in words, for those who cannot see it."""
    paths = [
        f"{label}: {one.mass[-1, 0] - one.mass[0, 0]:.2f} m forward in {(len(one.mass) - 1) / one.rate:.1f} s"
        for one, label in zip(moving, labels, strict=False)
    ]
    where = "on the ground" if moving[0].level is None else "in water"
    return f"Three-dimensional replay of the robot {robot.name} {where}. {'; '.join(paths)}."


def _still(robot: Robot, record: xr.Dataset) -> tuple[str, str]:
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
