"""Ask the article's comparisons of the design that ``suchus optimise lifted`` found, whose control group walks.

Usage: python tools/lifted_design.py: reads the kept outcome of the search, asks ``crawl_stability`` and
``displacement`` of its robot and legs, keeps what they measured, and writes the pages that state it anew.
"""

from dataclasses import replace
from string import Formatter
from typing import Any

from pages import stated
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES
from suchus.robot.design import Robot, with_values
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

NAME, SEARCH = "lifted_design", "optimise_lifted"
ASKED = ("com_height_pp_change_tail_lifted", "com_height_pp_change", "forward_ratio_tail_lifted", "forward_ratio",
         "hind_duty_limbs_tail_lifted", "hind_clearance_limbs_tail_lifted")  # fmt: skip
"""Measures that the page of the search states."""
CONTROL = "limbs_tail_lifted"
"""The control group that walks there; claims that speak of it are judged there too."""


def design() -> tuple[Robot, Gait]:
    """Return the robot that the search found, and the article's crawl with the legs that it found."""
    (best,) = next(iter(stated.kept(SEARCH)["arms"].values()))["best"].values()
    values = {path: field["best"] for path, field in best["fields"].items()}
    robot = {path.removeprefix("robot."): value for path, value in values.items() if path.startswith("robot.")}
    legs = {path.removeprefix("gait."): value for path, value in values.items() if path.startswith("gait.")}
    return with_values(ROBOTS["caiman"], robot), with_values(GAITS["belly_crawl"], legs)


def judged() -> dict[str, float]:
    """Return what the two experiments measure of the design."""
    robot, gait = design()
    stability: Any = replace(EXPERIMENTS["crawl_stability"], robot=robot, gait=gait)  # type: ignore[type-var]
    one_point = {"strokes": (1.0,), "bends": (1.0,), "pitches": (0.2,), "phases": (0.0,)}  # its maps are not asked
    far: Any = replace(EXPERIMENTS["displacement"], robot=robot, gait=gait, **one_point)  # type: ignore[type-var]
    found = {**far.run().measures, **stability.run().measures}
    names = set(ASKED)
    for rule in RULES.values():
        if rule.control and rule.control.group == CONTROL:
            names |= rule.needs | {name for _, name, _, _ in Formatter().parse(rule.why) if name}
    wanted = {f"{name}{end}" for name in names for end in ("", "_low", "_high")}
    return {name: float(measure.value) for name, measure in sorted(found.items()) if name in wanted}


if __name__ == "__main__":
    stated.keep(NAME, judged())
    stated.main()
