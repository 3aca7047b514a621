"""Crawls side by side from above, what each part of the axis adds to the displacement, and on what it depends."""

from collections.abc import Mapping, Sequence
from math import degrees

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from suchus.article.paper import CLAIMS
from suchus.experiments.catalog._two_groups import of_robots, robots_built
from suchus.robot.design import Robot
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.visual.figures.data import carry
from suchus.visual.figures.posture import draw_strip
from suchus.visual.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled
from suchus.visual.figures.timeseries import draw_lines, mark_cycles, mark_printed

_REFERENCE_LENGTH = ROBOTS["caiman"].length
"""Length of the robot to which the distances between strips refer [m]."""
_REFERENCE_LABEL = "crawl of the other figures"


def draw_crawls(robot: Robot, record: xr.Dataset, arms: Sequence[str]) -> Figure:
    """Draw one robot per run from above at the beginning, between and at the end of its walk.

    Args:
        robot: robot whose record it is.
        record: record with one run per arm.
        arms: roles of ``style.LINES``.
    """
    end = float(record.time[-1])
    times = [START, (START + end) / 2, end]
    size = robot.length / _REFERENCE_LENGTH
    half_width = _width(record.sel(time=times, method="nearest"), size)
    spacing = 2 * half_width + 0.04 * size
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=10.5, height=5.2)
        ax = axes[0, 0]
        forward_position = record.centre_of_mass.sel(xyz="x")
        for i, role in enumerate(arms):
            run, lateral_offset = record.isel(run=i), -spacing * i
            draw_strip(ax, robot, run, times, role=role, lateral_offset=lateral_offset)
            start, stop = (float(forward_position.isel(run=i).sel(time=t, method="nearest")) for t in (START, end))
            dimension_y = lateral_offset - half_width - 0.02 * size
            ax.annotate(
                "",
                (start, dimension_y),
                (stop, dimension_y),
                arrowprops={"arrowstyle": "|-|", "color": COLOURS[role], "lw": 2},
            )
            ax.update_datalim([(start, dimension_y - 0.06 * size)])
            ax.text(
                max(stop, start + 0.02 * size) + 0.03 * size,
                dimension_y,
                f"{stop - start:.{2 if size > 0.5 else 4}f} m, {LINES[role]['label']}",
                color=COLOURS[role],
                va="center",
                fontsize=13,
            )
        ax.autoscale_view()
        ax.set_axis_off()
    return captioned(
        figure,
        f"Two crawls from above with identical leg commands, at {times[0]:g}, {times[1]:g} and {times[2]:g} s, with "
        "the track of the centre of mass: above spine and tail take part, below the legs work alone. Filled feet "
        "stand.",
    )


def _width(snapshots: xr.Dataset, size: float) -> float:
    """Return the half width of a strip [m]: to the outermost foot with its toes, or more for a narrow stance."""
    feet = np.abs(snapshots.foot_position.sel(xyz="y").values).max(initial=0.0)
    return max(0.19 * size, float(feet) + 0.06 * size)


def draw_parts(record: xr.Dataset, designed: xr.DataArray, printed_distances: Mapping[str, float]) -> Figure:
    """Draw how far each condition gets, of the robots as built and as designed.

    Args:
        record: record of the experiment.
        designed: displacement of each condition of the robot as designed [m].
        printed_distances: the article's displacements by condition [m]; empty for another robot or gait.
    """
    arms = [str(arm) for arm in record.condition.values]
    with styled():
        figure, axes = panels(1, 1, height=1.0 + 0.5 * len(arms))
        ax = axes[0, 0]
        for i, arm in enumerate(arms):
            (repeat_distances,), row = of_robots(record, "forward", arm), len(arms) - i
            median = float(repeat_distances.median())
            labels = [
                ("" if i == 0 else "_") + label for label in ("each robot as built", "their middle", "as designed")
            ]
            ax.plot(
                repeat_distances,
                [row] * repeat_distances.size,
                "|",
                color=COLOURS[arm],
                markersize=13,
                alpha=0.6,
                label=labels[0],
            )
            ax.plot(median, row, "o", color=COLOURS[arm], markersize=9, label=labels[1])
            ax.plot(float(designed[i]), row, "x", color=COLOURS["neutral"], markersize=7, label=labels[2])
            ax.annotate(f"{median:.3g} m", (median, row), (0, 10), ha="center", fontsize=11,
                        textcoords="offset points")  # fmt: skip
        for i, (arm, metres) in enumerate(printed_distances.items()):
            ax.plot(metres, len(arms) - arms.index(arm), "D", markersize=11, markerfacecolor="none",
                    markeredgecolor="black", label="_article" if i else "article")  # fmt: skip
        ax.set_yticks(range(len(arms), 0, -1), [str(LINES[arm]["label"]) for arm in arms])
        ax.set_ylim(0.4, len(arms) + 0.8)
        ax.set_xlim(left=min(0.0, float(record.repeated_forward.min())))
        ax.set_xlabel("displacement forward [m]")
        ax.legend(loc="lower right")
    return captioned(
        figure,
        f"What each part of spine and tail adds: {robots_built(record)}, whose servos' "
        "zeros, play, masses and friction differ from it within their tolerances, and the design itself. All "
        "conditions command the same legs.",
    )


def draw_course(record: xr.Dataset, arms: Sequence[str], printed_distances: Mapping[str, float]) -> Figure:
    """Draw the displacement over time with all of the axis and without, and where the robots as built end.

    Args:
        record: record of the experiment, the two conditions first.
        arms: names of the two conditions.
        printed_distances: the article's displacements by condition [m]; empty where they are not for this run.
    """
    with styled():
        figure, axes = panels(1, 1, height=4.2)
        ax = axes[0, 0]
        x = record.centre_of_mass.isel(run=[0, 1]).sel(xyz="x")
        x = x - x.sel(time=START, method="nearest")
        draw_lines(ax, x, arms)
        end = float(record.time[-1])
        for i, arm in enumerate(arms):
            (repeat_distances,), label = of_robots(record, "forward", arm), None if i else "each robot as built"
            ax.plot(
                [end] * repeat_distances.size,
                repeat_distances,
                "_",
                color=COLOURS[arm],
                markersize=11,
                clip_on=False,
                label=label,
            )
        cycles = (end - START) / float(record.period[0])
        mark_cycles(ax, list(np.arange(START, end + 0.01, float(record.period[0]))))
        if printed_distances:
            mark_printed(ax, printed_distances, end)
        ax.set_ylabel("displacement forward [m]")
        ax.legend(loc="upper left")
    diamonds = (
        " Diamonds: the article's {coordinated:g} and {limbs_only:g} m.".format(**printed_distances)
        if printed_distances
        else ""
    )
    return captioned(
        figure,
        f"Displacement of the centre of mass over {cycles:.3g} cycles with identical leg commands, as designed."
        f"{diamonds} Marks at the end: {record.sizes['repeat']} robots built of the design.",
    )


def draw_sensitivity(
    record: xr.Dataset, ratio: xr.DataArray, gait: Gait, half_stroke: float, *, is_article: bool
) -> Figure:
    """Draw how the displacement depends on stroke, bend, the tail's pitch and the trunk's phase lag.

    The left panel shows the ratio of displacements: a map over stroke and bend, or a curve if only one of them varies.

    Args:
        record: record of the experiment; ``pitched`` is the displacement over the tail's ``pitch``, and
            ``late_coordinated`` that over ``late``, the phase lag of the trunk.
        ratio: displacement with all of the axis over that without, shape (stroke, bend) [-].
        gait: the crawl of the other figures.
        half_stroke: half the distance that its front feet move back in stance; 0 where it has no foot paths [m].
        is_article: whether the article's numbers are for this robot and its gaits.
    """
    has_pitches = record.sizes["pitch"] > 0
    has_units = gait.has("foot paths") and gait.number("trunk_bend") > 0
    with styled(axes__grid=False):
        panel_widths = [1.35, 1, 1] if has_pitches else [1.35, 1]
        figure, axes = panels(1, len(panel_widths), width=12.5, height=4.3, width_ratios=panel_widths)
        reference = (1.0, 1.0)
        if has_units:
            reference = 1000 * half_stroke, degrees(gait.number("trunk_bend"))
            ratio = ratio.assign_coords(stroke=record.stroke * reference[0], bend=record.bend * reference[1])
            ratio.stroke.attrs.update(units="mm", long_name="half stroke of the legs")
            ratio.bend.attrs.update(units="deg", long_name="bend of the trunk")
        printed_ratio = CLAIMS["displacement_ratio"].value if is_article else None
        is_map = min(ratio.shape) > 1
        has_article_line = is_map and printed_ratio is not None and _is_within(ratio, printed_ratio)
        ax = axes[0, 0]
        if is_map:
            label = "ratio of displacements [-]"
            article_level = printed_ratio if has_article_line else None
            draw_map(ax, ratio.T, levels=(1, 1.5, 2, 3, 6, 12), label=label, emphasised=article_level)
            ax.plot(*reference, "*", markersize=15, color="white", markeredgecolor="black", label=_REFERENCE_LABEL)
        else:  # the body can vary only its strokes or only its bends
            dimension = "stroke" if ratio.sizes["stroke"] > 1 else "bend"
            ax.plot(ratio[dimension], ratio.squeeze("bend" if dimension == "stroke" else "stroke"), marker="o")
            ax.axvline(
                reference[dimension == "bend"],
                color=COLOURS["neutral"],
                linestyle=":",
                linewidth=1.2,
                label=_REFERENCE_LABEL,
            )
            ax.set_xlabel(f"{ratio[dimension].attrs['long_name']} [{ratio[dimension].attrs['units']}]")
            ax.set_ylabel("ratio of displacements [-]")
        ax.legend(loc="upper right", fontsize=10)
        ax.set_title("spine and tail over limbs only")
        if has_pitches:
            ax = axes[0, 1]
            for group in record.group.values:
                ax.plot(np.degrees(record.pitch), record.pitched.sel(group=group), marker="o", **LINES[str(group)])
            gait_pitch = degrees(gait.number("tail_pitch"))
            ax.axvline(gait_pitch, color=COLOURS["neutral"], linestyle=":", linewidth=1.2, label=_REFERENCE_LABEL)
            ax.set_xlabel("pitch of the tail, down [deg]")
            ax.set_ylabel("displacement forward [m]")
            ax.set_ylim(bottom=0.0)
            ax.legend(loc="center right")
            ax.set_title("pitch of the tail")
        ax = axes[0, -1]
        ax.axhline(0.0, color="#999999", linewidth=0.8)
        ax.plot(record.late, record.late_coordinated, marker="o", **(dict(LINES["coordinated"]) | {"label": None}))
        ax.set_xlabel("phase lag of the trunk [cycle]")
        ax.set_ylabel("displacement forward [m]")
        ax.set_title("phase lag of the trunk")
    article_text = ", the orange line the article's ratio" if has_article_line else ""
    marker_text = "star" if is_map else "dotted line"
    axes_text = "" if has_units else " over shares of the strokes and bends of the robot's gait"
    pitch_text = " Middle: the steady pitch of the tail, the dotted line that of the crawl." if has_pitches else ""
    return captioned(
        figure,
        "What the displacement depends on. Left: the ratio of the displacements with spine and tail and with limbs "
        f"only{axes_text}; the {marker_text} is the crawl of the other figures{article_text}.{pitch_text} Right: the "
        "phase lag of the trunk's bend behind the legs, with spine and tail.",
    )


def _is_within(values: xr.DataArray, level: float) -> bool:
    """Return whether a map of values has a contour line at a level."""
    return bool(values.min() < level < values.max())


def draw_map(
    ax: Axes,
    values: xr.DataArray,
    *,
    levels: Sequence[float],
    label: str,
    emphasised: float | None = None,
) -> None:
    """Draw filled contours of a positive quantity on a logarithmic scale, with labelled lines.

    Args:
        ax: axes to draw on; their labels come from the ``long_name`` and ``units`` of the coordinates.
        values: two-dimensional, the first dimension up, the second to the right.
        levels: levels of the lines, increasing; doubled on from the last until none of the values lies above them.
        label: label of the colour bar.
        emphasised: level to draw thick.
    """
    vertical, horizontal = (values[d] for d in values.dims)
    quantity = values.values.astype(float)
    max_value = float(np.max(quantity, where=np.isfinite(quantity), initial=levels[0]))
    while levels[-1] < max_value:
        levels = (*levels, 2 * levels[-1])
    lowest_level, highest_level = levels[0], levels[-1]
    data = np.ma.masked_invalid(np.clip(quantity, 0.5 * lowest_level, highest_level))
    contours = ax.contourf(
        horizontal,
        vertical,
        data,
        levels=np.geomspace(lowest_level, highest_level, 40),
        cmap=SEQUENTIAL,
        norm=LogNorm(lowest_level, highest_level),
        extend="min" if (quantity < lowest_level).any() else "neither",
    )
    carry(contours, values.values, horizontal.values, vertical.values)
    lines = ax.contour(horizontal, vertical, data, levels=list(levels[1:-1]), colors="white", linewidths=1.1)
    ax.clabel(lines, fmt="%.3g", fontsize=11)
    if emphasised is not None:
        emphasised_line = ax.contour(horizontal, vertical, data, levels=[emphasised], colors="#D55E00", linewidths=2.6)
        ax.clabel(emphasised_line, fmt="%.3g", fontsize=12)
    for axis, coordinate in ((ax.set_xlabel, horizontal), (ax.set_ylabel, vertical)):
        axis(f"{coordinate.attrs['long_name']} [{coordinate.attrs['units']}]")
    assert ax.figure is not None
    bar = ax.figure.colorbar(contours, ax=ax, ticks=list(levels), format="%.3g")
    bar.set_label(label)
    bar.minorticks_off()
