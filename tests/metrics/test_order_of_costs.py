"""The order of gaits by their cost of transport is the same at three time steps of the physics."""

from itertools import combinations

import numpy as np
import pytest

from suchus.core.errors import SuchusError
from suchus.robot.design.scale import coarse_step, physics_step
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import cost_of_transport

TIE = 0.04
"""Difference of two costs, over the smaller one, that is no order: each may change by 2 % with the time step [-]."""
MAX_TIES = 0.2
"""Greatest fraction of the pairs of gaits that are ties, so that there is an order [-]."""
OTHERS = ("floating_caiman", "long_tail", "salamander")
"""Further robots of the catalog that have several gaits."""
OWN_GAITS = ("limbs_only", "belly_crawl", "tail_still", "low_crawl", "spine_only", "semi_erect", "high_walk")
"""Gaits of the article's robot, the cheapest first, whose order is the same even where it is a tie."""


def time_steps(robot):
    """Return the coarse step of a robot, its usual one and a quarter of this [s].

    They are 5, 2 and 0.5 ms, and 2.5, 1 and 0.25 ms for the small salamander, whose servos are commanded every 5 ms.
    """
    return coarse_step(robot), physics_step(robot), physics_step(robot) / 4


def walks(robot, timestep):
    """Return the record of one cycle in each gait of the shelf that suits a robot, by the name of the gait."""
    records = {}
    for name, gait in GAITS.items():
        try:
            runs = [Run(robot=robot, gait=gait)]
            records[name] = simulate(runs, duration=START + gait.period, timestep=timestep).isel(run=0)
        except SuchusError:
            continue
    return records


def costs(records):
    return {name: float(cost_of_transport(record)) for name, record in records.items()}


def sampled_costs(records):
    """Return the costs by the torque at the end of each control period, when the servos have settled."""
    power = {name: abs(record.servo_torque * record.servo_velocity) for name, record in records.items()}
    return costs({name: record.assign(servo_absolute_power=power[name]) for name, record in records.items()})


def ordered_pairs(reference):
    """Return all pairs of gaits, the cheaper first."""
    return [tuple(sorted(pair, key=lambda name: reference[name])) for pair in combinations(reference, 2)]


def is_tie(reference, cheap, dear):
    return reference[dear] <= (1.0 + TIE) * reference[cheap]


def exchanged(reference, others):
    """Return the pairs that are no tie by the reference, and of which others call the first one not cheaper."""
    return [
        (cheap, dear)
        for cheap, dear in ordered_pairs(reference)
        if not is_tie(reference, cheap, dear) and any(other[cheap] >= other[dear] for other in others)
    ]


def assert_same_order(reference, others):
    ties = [is_tie(reference, *pair) for pair in ordered_pairs(reference)]
    assert np.mean(ties) < MAX_TIES
    assert exchanged(reference, others) == []


def test_the_order_of_gaits_by_cost_does_not_depend_on_the_time_step(robot):
    """By the torque at the end of each control period other gaits would be the cheaper ones."""
    coarse, usual, fine = (walks(robot, step) for step in time_steps(robot))
    assert set(OWN_GAITS) < set(fine)
    assert_same_order(costs(fine), [costs(coarse), costs(usual)])
    for records in (coarse, usual, fine):
        found = costs(records)
        assert sorted(OWN_GAITS, key=lambda name: found[name]) == list(OWN_GAITS)
    assert exchanged(costs(fine), [sampled_costs(usual)])


def test_the_order_of_gaits_by_cost_is_that_of_a_foreign_body_too():
    robot = ROBOTS["pleurobot"]
    coarse, usual, fine = (costs(walks(robot, step)) for step in time_steps(robot))
    assert_same_order(fine, [coarse, usual])


@pytest.mark.slow("every body in every gait at a quarter of its time step: more than ten seconds")
@pytest.mark.parametrize("name", OTHERS)
def test_the_order_of_gaits_by_cost_of_every_body_does_not_depend_on_the_time_step(name):
    robot = ROBOTS[name]
    coarse, usual, fine = (costs(walks(robot, step)) for step in time_steps(robot))
    assert_same_order(fine, [coarse, usual])
