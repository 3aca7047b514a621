"""Bars of the fraction of each servo's torque and heat limit that a movement uses."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, captioned, panels, styled


class ServoUse(NamedTuple):
    """Use of a servo in its hardest movement."""

    servo: str
    """Name of the servo in the robot."""
    servo_model: str
    """Name of the servo that is bought; empty for one of the design."""
    torque: float
    """Torque over what it can give at its speed, but for the worst 2 % of the time [-]."""
    heat: float
    """Root mean square of the torque over the torque that it can give continuously [-]."""


def draw_use(servo_uses: Sequence[ServoUse], title: str) -> Figure:
    """Draw two bars for each servo, torque at its speed and heat, the one that is used most at the top.

    Args:
        servo_uses: uses of servos in any order.
        title: title of the figure.
    """
    rows = sorted(servo_uses, key=lambda servo_use: max(servo_use.torque, servo_use.heat))
    with styled():
        figure, axes = panels(height=1.4 + 0.32 * len(rows))
        ax = axes[0, 0]
        positions = range(len(rows))
        for shift, label, values, style in (
            (0.2, "torque at its speed", [servo_use.torque for servo_use in rows], {"color": COLOURS["ours"]}),
            (
                -0.2,
                "heat",
                [servo_use.heat for servo_use in rows],
                {"color": COLOURS["limbs_tail_lifted"], "hatch": "///"},
            ),
        ):
            widths = [100 * value for value in values]
            ax.barh(
                [y + shift for y in positions],
                widths,
                height=0.38,
                label=label,
                edgecolor="white",
                linewidth=0,
                **style,
            )
        ax.axvline(100, color=COLOURS["alarm"], linestyle="--", linewidth=1.4, label="all there is")
        ax.set_yticks(
            list(positions), [f"{servo_use.servo}  {servo_use.servo_model}".strip() for servo_use in rows], fontsize=10
        )
        ax.set_xlabel("used of what the servo has [%]")
        ax.set_title(title)
        ax.grid(axis="y", visible=False)
        ax.legend(loc="lower right")
    max_use = rows[-1]
    return captioned(
        figure,
        "What each servo uses of its torque at its speed, but for the worst 2 % of the time, and of the torque that it "
        f"gives continuously, in the movement that asks most of it: {max_use.servo} uses most. The dashed line is all "
        "there is.",
    )
