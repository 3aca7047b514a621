"""Recorded contact forces carry the weight, whatever part of the robot touches the ground."""

from dataclasses import replace

import numpy as np
import pytest

from evidence.replay_check import replay
from suchus.core.errors import Doubtful, InvalidDesign
from suchus.experiments.study.claims import Claims
from suchus.experiments.study.plan import Plan
from suchus.robot.design import crocodile, with_values
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, LostFoot, Push, Run, simulate
from suchus.sim.land.load_check import LOAD_TOLERANCE, check_loads, missing_load
from suchus.sim.metrics import duty_factor, ground_force, limb_load

CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]


def sampled_runs(count: int, samples: int = 2048) -> list[Run]:
    """Return the whole robot's runs of the first designs of the project's own Sobol sequence that can walk."""
    plan = Plan(Claims().study(samples, 0.005))
    arms = len(plan.study.arms)
    runs = []
    for sample in range(count):
        try:
            run = plan.run(sample * arms)
            simulate([run], duration=0.02, timestep=0.01)
        except ValueError:
            continue
        runs.append(run)
    return runs


def balance(runs, timestep, cycles=2):
    """Return the share of the weight that the record of each run lacks over its last cycle."""
    period = max(run.gait.period for run in runs)
    record = simulate(runs, duration=round(100 * (START + cycles * period)) / 100, timestep=timestep, effort=False)
    return missing_load(record, runs)


def with_radii(robot, foot, shank):
    """Return a robot of which all limbs have these radii [m]."""
    changes = {}
    for girdle, place in enumerate(robot.girdles):
        changes[f"girdles[{girdle}].limb.foot.radius"] = foot * place.limb.foot.radius
        last = len(place.limb.links) - 1
        changes[f"girdles[{girdle}].limb.links[{last}].radius"] = shank * place.limb.foot.radius
    return with_values(robot, changes)


FOREIGN = [
    *[("strider", "tripod", foot) for foot in (1.0, 1.5)],
    *[("salamander", "salamander_walk", foot) for foot in (1.0, 0.6)],
    *[("pleurobot", "pleurobot_walk", foot) for foot in (1.0, 1.3)],
]


def test_recorded_loads_of_sampled_designs_are_their_weights():
    lacking = balance(sampled_runs(32), 0.01, cycles=1)
    assert len(lacking) > 16
    assert np.abs(lacking).max() < LOAD_TOLERANCE


@pytest.mark.parametrize(("name", "gait", "foot"), FOREIGN)
def test_recorded_loads_of_foreign_bodies_are_their_weights(name, gait, foot):
    robot = with_radii(ROBOTS[name], foot, foot)  # shanks as thick as their feet
    assert np.abs(balance([Run(robot=robot, gait=GAITS[gait])], None)).max() < LOAD_TOLERANCE


def test_the_load_of_a_lost_foot_is_in_the_record():
    run = Run(robot=CAIMAN, gait=CRAWL, faults=(LostFoot("LH", 0.0),))
    record = simulate([run], duration=START + CRAWL.period)
    assert float(np.abs(record.foot_force.sel(leg="LH").isel(time=slice(1, None))).max()) == 0.0
    assert float(record.limb_force.sel(leg="LH", xyz="z").mean()) > 0.02 * CAIMAN.mass * 9.81
    assert abs(missing_load(record, [run])[0]) < LOAD_TOLERANCE
    assert abs(replay(record.isel(run=0), CAIMAN, faults=run.faults).load_error) < 1e-3
    assert float(duty_factor(record).sel(leg="LH").item()) > 0.3


def test_a_load_that_is_missing_is_warned_of():
    run = Run(robot=CAIMAN, gait=GAITS["high_walk"], ground=Ground(uphill=0.05))
    record = simulate([run], duration=START + 2 * run.gait.period)
    assert abs(missing_load(record, [run])[0]) < 0.3 * LOAD_TOLERANCE
    false_record = record.assign(belly_force=0.0 * record.belly_force, foot_force=0.97 * record.foot_force)
    with pytest.warns(Doubtful, match=r"carry 9[67]\.\d% of the weight"):
        check_loads(false_record, [run])


def test_a_run_that_cannot_be_judged_is_not():
    push = Run(robot=CAIMAN, gait=CRAWL, pushes=(Push(at=1.2, force=(0.0, 0.0, 9.0)),))
    short = simulate([Run(robot=CAIMAN, gait=CRAWL)], duration=1.5)
    assert np.isnan(missing_load(short, [Run(robot=CAIMAN, gait=CRAWL)])).all()
    assert np.isnan(missing_load(simulate([push], duration=START + CRAWL.period, timestep=0.01), [push])).all()


def test_the_force_of_the_ground_is_the_sum_of_disjoint_parts():
    run = Run(robot=CAIMAN, gait=CRAWL, faults=(LostFoot("LF", 0.5),))
    record = simulate([run], duration=1.2).isel(run=0)
    parts = record.foot_force.sum("leg") + record.limb_force.sum("leg") + record.belly_force.sum("segment")
    assert np.allclose(ground_force(record), parts + record.tail_force)
    assert float(limb_load(record).sel(leg="LF", xyz="z")[-1]) == float(record.limb_force.sel(leg="LF", xyz="z")[-1])
    older = record.drop_vars("limb_force")
    assert (limb_load(older) == record.foot_force).all()


def test_a_foot_thinner_than_its_shank_is_refused():
    leg = CAIMAN.tables.hind_leg
    with pytest.raises(InvalidDesign, match=r"foot_radius is 0\.0083 m, thinner than the shank's 0\.012 m"):
        crocodile(replace(CAIMAN.tables, hind_leg=replace(leg, radius=0.015, foot_radius=0.0083)))
    assert crocodile(replace(CAIMAN.tables, hind_leg=replace(leg, radius=0.015, foot_radius=0.012)))
    with pytest.raises(InvalidDesign, match=r"foot\.radius is .* m, thinner than the .* m of its link"):
        with_radii(ROBOTS["strider"], 1.0, 1.01)


def test_radii_of_foot_and_shank_are_drawn_together():
    plan = Plan(Claims().study(256, 0.005))
    arms = len(plan.study.arms)
    points = [plan[sample * arms].values for sample in range(256)]
    for leg in ("front_leg", "hind_leg"):
        feet, legs = (np.array([p[f"robot.{leg}.{name}"] for p in points]) for name in ("foot_radius", "radius"))
        assert (feet >= 0.8 * legs).all()
        assert (feet.min(), legs.min()) == pytest.approx((0.008, 0.008), abs=2e-4)
        assert feet.max() > 0.0198
        assert (feet < 0.0082).any()
        assert (feet < 0.012).mean() == pytest.approx(2 / 7 / 3 + 5 / 7 * (1 - 2 * np.log(1.5)), abs=0.03)
