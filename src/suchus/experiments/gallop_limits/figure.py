"""A bounding gait over the speed and torque of the servos, beside the fastest walk."""

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.figures.style import COLOURS, panels, styled


def draw_gallop_limits(bound: xr.Dataset, walk: xr.Dataset, own: float) -> Figure:
    """Draw speed [m/s] and share of flight of a bound over the servos' no-load speed [rad/s].

    Args:
        bound: the fastest bound, with ``speed`` and ``flight`` (torque, servo_speed).
        walk: the fastest trot or walk, the same.
        own: no-load speed of the robot's own servos [rad/s].
    """
    shades = matplotlib.colormaps["viridis"](np.linspace(0.8, 0.1, bound.sizes["torque"]))
    with styled():
        figure, axes = panels(1, 2, width=11.0, height=4.6)
        for shade, torque in zip(shades, bound.torque.values, strict=True):
            one, other = bound.sel(torque=torque), walk.sel(torque=torque)
            axes[0, 0].plot(one.servo_speed, one.speed, marker="o", color=shade, label=f"bound, {torque:g} N m")
            axes[0, 0].plot(one.servo_speed, other.speed, color=shade, linestyle=(0, (4, 2)))
            axes[0, 1].plot(one.servo_speed, 100 * one.flight, marker="o", color=shade)
        for ax in axes.flat:
            ax.set_xscale("log")
            ax.set_xticks(bound.servo_speed.values, [f"{speed:g}" for speed in bound.servo_speed.values])
            ax.minorticks_off()
            ax.axvline(own, color=COLOURS["neutral"], linewidth=1.0)
            ax.set_xlabel("no-load speed of the servos [rad/s]")
        axes[0, 0].plot([], [], color="#333333", linestyle=(0, (4, 2)), label="fastest trot or walk")
        axes[0, 0].set_ylabel("speed forward [m/s]")
        axes[0, 1].set_ylabel("in flight [% of the time]")
        figure.legend(loc="outside upper center", ncols=bound.sizes["torque"] + 1)
    return figure
