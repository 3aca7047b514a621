"""Servos on a stand and in the crawl: steps, loads, wind-up, and tracking errors."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, panels, styled

_DASHES = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))
_SHADES = ("#333333", COLOURS["coordinated"], COLOURS["limbs_only"], COLOURS["tail_drag"])
_TITLES = {"step": "a step", "load": "a load", "let_go": "released after a clamp"}
_KINDS = {
    "yaw": "leg yaw",
    "pitch": "leg pitch",
    "roll": "leg roll",
    "elbow": "elbow",
    "knee": "knee",
    "crank": "crank",
    "neck_yaw": "neck yaw",
    "spine_yaw": "spine yaw",
    "spine_pitch": "spine pitch",
    "tail_yaw": "tail yaw",
    "tail_pitch": "tail pitch",
    "tail_cable": "tail cable",
}
"""Kinds of servos, and their labels in the figure."""


def on_stand(record: xr.Dataset) -> Figure:
    """Draw the angle of the joint in each test with each integral gain [deg].

    Args:
        record: record with ``angle`` (test, ki, time) [rad], ``step`` and ``load`` in its attributes.
    """
    with styled():
        figure, axes = panels(1, record.sizes["test"], width=12.0, height=4.0)
        for ax, test in zip(axes[0], record.test.values, strict=True):
            for i, ki in enumerate(record.ki.values):
                style = {"color": _SHADES[i % len(_SHADES)], "linestyle": _DASHES[i % len(_DASHES)]}
                angle = np.degrees(record.angle.sel(test=test).isel(ki=i))
                ax.plot(record.time, angle, label=f"$k_i$ = {ki:g} N m/(rad s)", **style)
            target = 0.0 if test == "load" else np.degrees(record.attrs["step"])
            ax.axhline(target, color=COLOURS["neutral"], linewidth=0.9, linestyle=":")
            ax.set(title=_TITLES[test], xlabel="time [s]")
        clamp_duration = float(record.attrs["gripped"])  # a second for the article's robot
        axes[0, 0].set_xlim(0.0, 0.25 * clamp_duration)
        axes[0, 0].set_ylabel("angle [deg]")
        axes[0, 1].set_title(f"a load of {record.attrs['load']:.{2 if record.attrs['load'] > 0.05 else 7}f} N m")
        axes[0, 2].set_xlim(0.0, 1.0 * clamp_duration)
        axes[0, 0].legend(loc="lower right")
    return figure


def tracking(record: xr.Dataset) -> Figure:
    """Draw the tracking error of the tested joint over the crawl with its droop, and of all kinds of servos [deg].

    Args:
        record: record with ``crawl_error`` and ``crawl_droop`` (servo, crawl_time) [rad], ``error_ms`` (ki, servo)
            [rad2].
    """
    with styled():
        figure, axes = panels(2, 1, height=6.6)
        ax, joint = axes[0, 0], record.attrs["joint"]
        for name, colour, dashes, label in (
            ("crawl_error", "#333333", "-", "commanded less actual"),
            ("crawl_droop", COLOURS["coordinated"], (0, (5, 2)), "torque over $k_p$"),
        ):
            ax.plot(
                record.crawl_time,
                np.degrees(record[name].sel(servo=joint)),
                color=colour,
                linestyle=dashes,
                label=label,
            )
        ax.set(title=f"{joint} in the crawl", xlabel="time [s]", ylabel="angle [deg]")
        ax.margins(y=0.25)
        ax.legend(loc="upper right", ncols=2)
        ax, width = axes[1, 0], 0.8 / record.sizes["ki"]
        kinds = {kind: servos for kind in _KINDS if (servos := _servos_of_kind(record, kind))}
        for i, ki in enumerate(record.ki.values):
            squared = [float(record.error_ms.isel(ki=i).sel(servo=servos).mean()) for servos in kinds.values()]
            positions = np.arange(len(kinds)) + (i - 0.5 * (record.sizes["ki"] - 1)) * width
            label = f"$k_i$ = {ki:g} N m/(rad s)"
            ax.bar(positions, np.degrees(np.sqrt(squared)), 0.92 * width, color=_SHADES[i % len(_SHADES)], label=label)
        ax.set_xticks(range(len(kinds)), [_KINDS[kind].replace(" ", "\n") for kind in kinds])
        ax.grid(visible=False, axis="x")
        ax.set(title="all servos", ylabel="error, root mean square [deg]")
        ax.legend()
    return figure


def _servos_of_kind(record: xr.Dataset, kind: str) -> list[str]:
    """Return the servos of a kind: leg servos whose names end with it, or axis servos whose names begin with it."""
    legs = "_" not in kind
    names = [str(name) for name in record.servo.values]
    return [n for n in names if (n.endswith(f"_{kind}") and n[0] in "LR" if legs else n.startswith(kind))]
