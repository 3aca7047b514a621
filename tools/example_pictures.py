"""Draw the pictures of the documentation that no example draws by itself, into docs/pictures.

Usage: python tools/example_pictures.py [NAME ...]
"""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import suchus
from evidence import store
from lighter import lighten
from suchus.apps import envs
from suchus.experiments.catalog.bipedal_reach.figure import draw_side_views
from suchus.experiments.catalog.displacement.figure import draw_crawls
from suchus.experiments.optimise import READY
from suchus.experiments.optimise.pictures import draw_gaits
from suchus.robot.design import with_values
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement
from suchus.visual.figures import COLOURS, dimension_drawing, panels, styled

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
CAIMAN, CRAWL = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]


def broken_joints() -> Figure:
    """Draw the tracks of an intact robot and of one with a failed joint, from above."""
    limp = suchus.Limp("LF_yaw")
    return _tracks(
        {"intact": suchus.crawl(CAIMAN, CRAWL), "left front yaw limp": suchus.crawl(CAIMAN, CRAWL, faults=[limp])}
    )


def longer_tail() -> Figure:
    """Draw the robot of the third example with its dimensions."""
    return dimension_drawing(with_values(CAIMAN, {"name": "tailed", "tail.fin_length": 0.25}))


def workspace() -> Figure:
    """Draw the workspace of a leg."""
    question = suchus.EXPERIMENTS["leg_kinematics"].quick()
    return question.draw(question.run())["workspace"]


def heading() -> Figure:
    """Draw a limp leg with and without the heading loop, from above."""
    limp = (suchus.Limp("LF_yaw", at=5.0),)
    closed = suchus.Coordinated()
    steered = replace(closed, heading=suchus.HeadingRule())
    return _tracks(
        {
            name: suchus.crawl(CAIMAN, CRAWL, control=control, faults=limp, duration=33.0, timestep=0.005)
            for name, control in {"three rules": closed, "and the heading loop": steered}.items()
        }
    )


def gait() -> Figure:
    """Draw the gait diagram of the article's crawl, in the form that a captured walk has too."""
    question = suchus.EXPERIMENTS["gait_diagram"]
    return question.draw(question.run())["gait_diagram"]


def policies() -> Figure:
    """Draw how far each policy of the eleventh example gets in every episode."""
    task = envs.TASKS["Crawl"]
    centre = tuple(envs.CrocodileVectorEnv(1, task).pack.centre)
    players = {
        "holding still": envs.HoldStill(task),
        "random actions": envs.RandomActions(task, np.random.default_rng(0)),
        "the built-in crawl": envs.GaitFollower(task=task, centre=centre, gait=task.gait),
    }
    return _bars({name: envs.play(task, player, episodes=8).forward.tolist() for name, player in players.items()})


def crawling() -> Figure:
    """Draw the two crawls of the article from above."""
    arms = ("coordinated", "limbs_only")
    gaits = (CRAWL, suchus.GAITS["limbs_only"])
    return draw_crawls(CAIMAN, simulate([Run(robot=CAIMAN, gait=gait) for gait in gaits], duration=9.0), arms)


def optimised_crawl() -> Figure:
    """Draw the article's crawl and the best that the search ``crawl`` found, from what it kept."""
    kept = store.load("optimise_crawl").values
    spec = READY["crawl"]()
    runs = [replace(spec.run, label="start")]
    for arm in spec.arms:
        best = kept["arms"][arm.name]["best"][arm.name]["fields"]
        values = {**arm.values, **{field: value["best"] for field, value in best.items()}}
        runs.append(replace(with_values(spec.run, values), label=arm.name))
    record = simulate(runs, duration=spec.duration, timestep=kept["timestep"])
    texts = [f"{float(distance):.2f} m" for distance in displacement(record).sel(xyz="x")]
    return draw_gaits(runs, record, texts)


def standing() -> Figure:
    """Draw the robot standing up."""
    question = suchus.EXPERIMENTS["bipedal_reach"].quick()
    return draw_side_views(CAIMAN, question.run().record)


DRAWN: Mapping[str, Callable[[], Figure]] = {
    "crawling": crawling,
    "optimised_crawl": optimised_crawl,
    "standing": standing,
    "example_02": broken_joints,
    "example_03": longer_tail,
    "example_04": workspace,
    "example_07": heading,
    "example_08": gait,
    "example_11": policies,
}


def _bars(distances: Mapping[str, Sequence[float]]) -> Figure:
    """Draw how far each got: the mean as a bar, every episode as a dot."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=8.0, height=0.9 + 0.5 * len(distances))
        ax = axes[0, 0]
        for row, far in enumerate(distances.values()):
            ax.barh(row, np.mean(far), height=0.6, color=COLOURS["coordinated"], alpha=0.75)
            if len(far) > 1:
                ax.plot(far, [row] * len(far), "o", color=COLOURS["limbs_only"], markersize=4)
            right = max(0.0, *far)
            ax.annotate(f"{np.mean(far):+.2f} m", (right, row), (6, 0), textcoords="offset points", va="center")
        ax.axvline(0.0, color="black", linewidth=1.0)
        ax.set_yticks(range(len(distances)), list(distances))
        ax.invert_yaxis()
        ax.margins(x=0.12)
        ax.set_xlabel("displacement forward in an episode, mean [m]")
    return figure


def _tracks(records: Mapping[str, xr.Dataset]) -> Figure:
    colours = (COLOURS["coordinated"], COLOURS["limbs_only"])
    with styled():
        figure, axes = panels(1, 1, height=3.6)
        for (name, record), colour, dashes in zip(records.items(), colours, ("-", "--"), strict=True):
            centre = record.centre_of_mass
            x, y = centre.sel(xyz="x"), centre.sel(xyz="y")
            axes[0, 0].plot(x, y, dashes, color=colour, label=name)
            axes[0, 0].plot(x[-1], y[-1], "o", color=colour)
        axes[0, 0].set(xlabel="forward [m]", ylabel="to the left [m]", aspect="equal")
        axes[0, 0].margins(0.08)
        axes[0, 0].legend(loc="best")
    return figure


if __name__ == "__main__":
    for name in sys.argv[1:] or DRAWN:
        with styled():
            path = PICTURES / f"{name}.png"
            DRAWN[name]().savefig(path, dpi=130, metadata={"Software": None})
        print(lighten(path))
