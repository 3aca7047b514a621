"""How high a robot reaches that stands on hind legs and tail, what limits it, and what topples it."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from suchus.design import Robot
from suchus.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled
from suchus.paper import CLAIMS

_FEEDBACK = {"on": COLOURS["ours"], "off": COLOURS["limbs_only"]}


def draw_heights(record: xr.Dataset, hold: float) -> Figure:
    """Draw the height that the robot reaches over time, with the repeats and the article's two heights.

    Args:
        record: of the experiment.
        hold: how long it stands [s].
    """
    _, at, up, leave, _, end = record.attrs["stages"]
    with styled():
        figure, axes = panels(1, 3, width=12.5, height=4.6, width_ratios=[1, 1.35, 1])
        rising, whole, standing = axes[0]
        for ax, begin, stop in ((rising, at - 2.0, up + 2.0), (whole, 0.0, end)):
            _lay_heights(ax, record, begin, stop)
            for key in ("height_crawl", "height_standing"):
                ax.axhline(CLAIMS[key].value or 0.0, **LINES["printed"])
            ax.set_ylim(0.0, 1.1 * max(float(record.attrs["stretched"]), CLAIMS["height_standing"].value or 0.0))
        _lay_heights(standing, record, up + 0.02 * (leave - up), leave)  # on a scale of its own, to show the scatter
        for ax in axes[0]:
            ax.set_ylabel("height of the highest point [m]")
        whole.yaxis.label.set_visible(False)  # the same scale as beside it; its name is for the table of the figure
        for ax, title in zip(axes[0], ("standing up", "the whole run", "standing, magnified"), strict=True):
            ax.set_title(title)
            ax.set_xlabel("time [s]")
        handles, labels = whole.get_legend_handles_labels()
        shown = dict(zip(labels, handles, strict=True))  # both heights of the article are one entry
        figure.legend(shown.values(), shown.keys(), loc="outside lower center", ncols=4, fontsize=11)
    return captioned(
        figure,
        f"Height of the highest point of head and trunk. The robot crawls, stands for {hold:.0f} s, sits down and "
        "crawls on. Dashed: the article's two heights, "
        + " and ".join(f"{CLAIMS[key].value or 0.0:.2f} m" for key in ("height_crawl", "height_standing"))
        + ". Bands: the range of repeats with noise on the servos.",
    )


def _lay_heights(ax: Axes, record: xr.Dataset, begin: float, stop: float) -> None:
    """Draw the heights of the quiet run, and the range of the noisy ones, from one time to another."""
    shown = record.repeat_reach.sel(repeat_time=slice(begin, stop))
    for feedback, colour in _FEEDBACK.items():
        band = shown.sel(feedback=feedback)
        label = f"noisy servos, feedback {feedback}"
        ax.fill_between(
            band.repeat_time, band.min("repeat"), band.max("repeat"), color=colour, alpha=0.3, linewidth=0, label=label
        )
    part = record.reach.isel(run=0).sel(time=slice(begin, stop))
    ax.plot(part.time, part, color=COLOURS["ours"], label="no noise")
    ax.set_xlim(begin, stop)


def draw_limits(robot: Robot, record: xr.Dataset, up: float) -> Figure:
    """Draw which robots stand up, over the torque of the trunk's servos and the mass of the forebody.

    Args:
        robot: the robot of the other figures, marked by a star.
        record: of the experiment.
        up: reach from which a robot counts as standing [m].
    """
    found = record.map_reach
    masses, torques = found.forebody.values, found.torque.values
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=7.6, height=4.8)
        ax = axes[0, 0]
        mesh = ax.pcolormesh(masses, torques, found, cmap=SEQUENTIAL, vmin=0.0, vmax=0.7, shading="nearest")
        for j, torque in enumerate(torques):
            for i, mass in enumerate(masses):
                value = float(found[j, i])
                colour = "black" if value > 0.4 else "white"
                weight = "bold" if value > up else "normal"
                ax.text(mass, torque, f"{value:.2f}", ha="center", va="center", color=colour, fontweight=weight)
        fine = np.linspace(masses[0] - 0.1, masses[-1] + 0.1, 50)
        line = np.poly1d(np.polyfit(masses, record.map_cantilever, 1))(fine)
        ax.plot(fine, line, color=COLOURS["limbs_only"], linewidth=2.6, label="torque that lifts the level forebody")
        own = robot.thorax.mass + robot.head.mass
        ax.plot(
            own + 0.37 * np.diff(masses).min(),
            robot.spine.pitch_servo.torque,
            "*",
            color="white",
            markeredgecolor="black",
            markersize=15,
        )
        step = (np.diff(masses).min() / 2, np.diff(torques).min() / 2)
        ax.set_xlim(masses[0] - step[0], masses[-1] + step[0])
        ax.set_ylim(torques[0] - step[1], torques[-1] + step[1])
        ax.set_xlabel("mass of thorax and head [kg]")
        ax.set_ylabel("torque of the trunk's pitch servos [N m]")
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
        figure.colorbar(mesh, ax=ax, label="reach after standing up [m]")
    return captioned(
        figure,
        "Who stands up: the height that robots with other trunk servos and other forebodies reach; the pelvis makes up "
        "for the mass. Line: what it takes to lift the level forebody off the ground. Star: the robot of the other "
        "figures.",
    )


def draw_ceiling(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the lengths that make up the greatest reach, and what is left of it for a stand that is safe.

    Args:
        robot: whose lengths they are.
        record: of the experiment.
    """
    leg = robot.hind_leg
    lengths = (
        ("sole", leg.foot_radius, COLOURS["neutral"]),
        ("hind leg", leg.femur + leg.tibia, COLOURS["LH"]),
        ("spine", robot.spine.length, COLOURS["spine"]),
        ("head", robot.head.snout, COLOURS["RH"]),
    )
    printed = CLAIMS["height_standing"].value or 0.0
    with styled():
        figure, axes = panels(1, 2, width=10.0, height=4.6, width_ratios=[1, 1.6])
        ax = axes[0, 0]
        bottom = 0.0
        for name, length, colour in lengths:
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": "white", "alpha": 0.75, "label": name}
            ax.add_patch(Rectangle((-0.3, bottom), 0.6, length, **look))
            ax.text(0.36, max(bottom + length / 2, 0.02), f"{name}  {1000 * length:.1f} mm", va="center")
            bottom += length
        ax.axhline(printed, **(dict(LINES["printed"]) | {"label": None}))
        ax.text(1.55, printed - 0.012, f"as printed: {printed:.2f} m", ha="right", va="top")
        line = sum(length for name, length, _ in lengths if name != "sole")
        ax.text(-0.3, bottom + 0.012, f"{line:.3f} m, with the sole {bottom:.3f} m", fontsize=11)
        ax.set_xlim(-0.4, 1.6)
        ax.set_ylim(0.0, 1.1 * max(bottom, printed))
        ax.set_xticks([])
        ax.set_ylabel("height above the ground [m]")
        ax.set_title("lengths in one line")
        ax = axes[0, 1]
        ax.plot(1000 * record.behind, record.ceiling, color=COLOURS["neutral"], label="no posture reaches higher")
        ax.axhline(printed, **LINES["printed"])
        ax.plot(
            1000 * record.lead_found, record.lead_reach, "o", color=COLOURS["ours"], markersize=7, label="simulated"
        )
        ax.set_xlabel("centre of mass behind the feet [mm]")
        ax.set_ylabel("reach [m]")
        shown = [printed, *record.ceiling.values, *record.lead_reach.values[np.isfinite(record.lead_reach.values)]]
        ax.set_ylim(min(shown) - 0.01, max(shown) + 0.01)
        ax.set_title("what a safe stand costs")
        ax.legend(loc="lower left")
    chosen = (
        f"; the head, which the article does not give, was chosen so that they sum up to the printed {printed:g} m"
        if abs(line - printed) <= CLAIMS["height_standing"].rounding
        else f", {line:.3f} m without the sole; dashed, the printed {printed:g} m"
    )
    return captioned(
        figure,
        f"What the height is made of. Left: hind leg, spine and head in one line{chosen}; the bar stands on the sole, "
        f"which makes it {bottom:.3f} m. Right: the greatest height "
        "of the snout over the distance of the centre of mass behind the feet, torques aside, and what is simulated.",
    )


def draw_pushes(record: xr.Dataset, commanded: float) -> Figure:
    """Draw the smallest pushes that topple the standing robot, with feedback and without, and over its lead.

    Args:
        record: of the experiment.
        commanded: lead of the stand of the other figures [m].
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.3)
        ax = axes[0, 0]
        directions = [str(w) for w in record.direction.values]
        shown = record.push.isel(commanded=int(np.argmin(np.abs(record.commanded.values - commanded))))
        for shift, feedback in ((-0.2, "off"), (0.2, "on")):
            forces = shown.sel(feedback=feedback).values
            heights = np.where(np.isfinite(forces), forces, 0.0)
            colour = _FEEDBACK[feedback]
            bars = ax.bar(np.arange(len(directions)) + shift, heights, 0.36, color=colour, label=f"feedback {feedback}")
            ax.bar_label(bars, [f"{f:.1f}" if np.isfinite(f) else "none" for f in forces], padding=2)
        ax.set_xticks(range(len(directions)), directions)
        ax.grid(axis="x", visible=False)
        ax.set_ylabel("smallest push that topples [N]")
        ax.set_title("push of 0.2 s on the thorax")
        ax.margins(y=0.18)
        ax.legend(loc="upper left")
        ax = axes[0, 1]
        for direction, marker in zip(directions, "osD", strict=False):
            for feedback, colour in _FEEDBACK.items():
                pushes = record.push.sel(direction=direction, feedback=feedback)
                dashes = (0, (3, 1.5)) if feedback == "off" else "-"
                label = f"{direction}, feedback {feedback}"
                ax.plot(
                    1000 * record.lead_found,
                    pushes.where(np.isfinite(pushes)),
                    color=colour,
                    linestyle=dashes,
                    marker=marker,
                    markersize=6,
                    label=label,
                )
        ax.set_xlabel("centre of mass behind the feet [mm]")
        ax.set_ylabel("smallest push that topples [N]")
        ax.set_title("pushes over the distance behind the feet")
        ax.set_ylim(bottom=0.0)
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=10)
    return captioned(
        figure,
        "The smallest push of 0.2 s on the thorax that topples the standing robot, with feedback of pitch and tail "
        "load and without. Left: in the stand of the other figures. Right: over the distance of the centre of mass "
        "behind the feet, dashed without feedback.",
    )
