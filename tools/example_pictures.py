"""Draw the pictures of the example pages that no script draws by itself, into docs/pictures.

Usage: python tools/example_pictures.py [NUMBER ...]
"""

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

import suchus
from suchus.figures import COLOURS, dimension_drawing, panels, styled

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
CAIMAN, CRAWL = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]


def broken_joints() -> Figure:
    """Draw the ways of an intact and of a broken robot, from above."""
    limp = suchus.Limp("LF_yaw")
    return _ways(
        {"intact": suchus.crawl(CAIMAN, CRAWL), "left front yaw limp": suchus.crawl(CAIMAN, CRAWL, faults=[limp])}
    )


def longer_tail() -> Figure:
    """Draw the robot of the third example with its dimensions."""
    return dimension_drawing(replace(CAIMAN, name="tailed", tail=replace(CAIMAN.tail, fin_length=0.25)))


def workspace() -> Figure:
    """Draw what a leg can reach."""
    question = suchus.EXPERIMENTS["leg_kinematics"].quick()
    return question.draw(question.run())["workspace"]


def heading() -> Figure:
    """Draw a limp leg with and without the heading loop, from above."""
    limp = (suchus.Limp("LF_yaw", at=5.0),)
    closed = suchus.Coordinated()
    steered = replace(closed, heading=suchus.HeadingRule())
    return _ways(
        {
            name: suchus.crawl(CAIMAN, CRAWL, control=control, faults=limp, duration=33.0, timestep=0.005)
            for name, control in {"three rules": closed, "and the heading loop": steered}.items()
        }
    )


def gait() -> Figure:
    """Draw the gait diagram that a captured walk comes down to."""
    question = suchus.EXPERIMENTS["gait_diagram"]
    return question.draw(question.run())["gait_diagram"]


DRAWN: Mapping[str, Callable[[], Figure]] = {
    "02": broken_joints,
    "03": longer_tail,
    "04": workspace,
    "07": heading,
    "08": gait,
}


def _ways(records: Mapping[str, xr.Dataset]) -> Figure:
    colours = (COLOURS["coordinated"], COLOURS["limbs_only"])
    with styled():
        figure, axes = panels(1, 1, height=3.6)
        for (name, record), colour, dashes in zip(records.items(), colours, ("-", "--"), strict=True):
            way = record.centre_of_mass
            x, y = way.sel(xyz="x"), way.sel(xyz="y")
            axes[0, 0].plot(x, y, dashes, color=colour, label=name)
            axes[0, 0].plot(x[-1], y[-1], "o", color=colour)
        axes[0, 0].set(xlabel="forward [m]", ylabel="to the left [m]", aspect="equal")
        axes[0, 0].margins(0.08)
        axes[0, 0].legend(loc="best")
    return figure


if __name__ == "__main__":
    for number in sys.argv[1:] or DRAWN:
        with styled():
            path = PICTURES / f"example_{number}.png"
            DRAWN[number]().savefig(path, dpi=100, metadata={"Software": None})
        print(path)
