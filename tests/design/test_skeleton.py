"""What decides how a gait moves a robot: alike in all that are built of a design, and other where the design is."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.robot.control import OpenLoop, Runs
from suchus.robot.design import with_named_servos
from suchus.robot.design.body import servos_of
from suchus.robot.design.scale import rescale
from suchus.robot.design.skeleton import skeleton
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import Batch, intended, movement
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, Tolerances

CAIMAN = ROBOTS["caiman"]
SIZED = [*(ROBOTS[name] for name in ROBOTS), *(rescale(CAIMAN, length_factor=factor) for factor in (0.05, 4.0))]


def other_girdle(**values):
    girdle = CAIMAN.girdles[0]
    limb = replace(girdle.limb, **{name: change(getattr(girdle.limb, name)) for name, change in values.items()})
    return replace(CAIMAN, girdles=(replace(girdle, limb=limb), *CAIMAN.girdles[1:]))


@pytest.mark.parametrize("robot", SIZED, ids=lambda robot: f"{robot.name} of {robot.length:.2g} m")
def test_robots_that_are_built_of_a_design_have_one_skeleton(robot):
    run = Run(robot=robot, gait=default_gait(robot))
    built = [one.robot for one in Tolerances().repeats([run], 2)]
    stronger = with_named_servos(robot, {name: replace(one, kp=2 * one.kp) for name, one in servos_of(robot).items()})
    assert len({robot, stronger, *built}) == 4
    assert all(skeleton(one) is skeleton(robot) for one in (stronger, *built))


@pytest.mark.parametrize(
    "other",
    [
        other_girdle(links=lambda links: (replace(links[0], end=(0.0, 0.08, 0.0)), *links[1:])),
        other_girdle(foot=lambda foot: replace(foot, radius=0.015)),
        other_girdle(
            links=lambda links: (
                replace(links[0], hinges=tuple(replace(one, range=(-1.0, 1.0)) for one in links[0].hinges)),
                *links[1:],
            )
        ),
        replace(CAIMAN, girdles=(replace(CAIMAN.girdles[0], above=0.001), *CAIMAN.girdles[1:])),
        replace(CAIMAN, cables=(replace(CAIMAN.cables[0], bend_limit=1.2),)),
        replace(CAIMAN, cables=(replace(CAIMAN.cables[0], pulley=0.03),)),
        replace(CAIMAN, axis=(replace(CAIMAN.axis[0], front=0.22), *CAIMAN.axis[1:])),
    ],
    ids=["femur", "foot", "ranges", "hip", "bend", "pulley", "snout"],
)
def test_what_changes_a_posture_a_range_or_a_reach_changes_the_skeleton(other):
    assert skeleton(other) != skeleton(CAIMAN)


def test_a_batch_of_robots_that_are_built_is_one_kind_and_each_moves_as_it_does_alone():
    gaits = [GAITS["belly_crawl"], GAITS["limbs_only"], GAITS["belly_crawl"].lagged(0.1)]
    runs = [run for gait in gaits for run in Tolerances().repeats([Run(robot=CAIMAN, gait=gait)], 4)]
    robots, gaits = tuple(run.robot for run in runs), tuple(run.gait for run in runs)
    assert len(set(robots)) == 4
    batch = Batch(robots, gaits)
    assert len(batch.groups) == 1
    phases = batch.phases + np.random.default_rng(0).uniform(-0.1, 0.1, batch.phases.shape)
    axis = batch.axis_phase(phases, np.zeros(len(runs)))
    targets = batch.targets(phases, axis)
    for i, (robot, gait) in enumerate(zip(robots, gaits, strict=True)):
        here = movement(robot, gait)
        assert axis[i] == here.axis_phase(phases[i : i + 1])[0]
        assert (targets[i] == here.targets(phases[i : i + 1], axis[i : i + 1])[0]).all()
        assert batch.bend_of("trunk", axis)[i] == here.bend_of("trunk", axis[i : i + 1])[0]
    table = OpenLoop.start(Runs((OpenLoop(),) * len(runs), robots, gaits, (0,) * len(runs), 3), 0.01)
    for i, (robot, gait) in enumerate(zip(robots, gaits, strict=True)):
        assert (table.command(2, None).targets[i] == intended(robot, gait, np.array([0.02])).targets[0]).all()
