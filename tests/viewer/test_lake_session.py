"""A live swim without a browser: it floats, its water and its air fraction can be turned, and it can walk again."""

import numpy as np
import pytest
from tests.swims import crocodile_swim

from suchus.apps.viewer import Session
from suchus.apps.viewer.live_page import status
from suchus.core.errors import InvalidDesign
from suchus.robot.control import DepthHold, Swimming
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Live, Run, simulate

ROBOT, CRAWL = ROBOTS["floating_caiman"], GAITS["belly_crawl"]
WAVE = crocodile_swim()


def afloat(seconds: float, **settings: float) -> Session:
    session = Session(ROBOT, CRAWL, swim=WAVE)
    for name, value in settings.items():
        assert session.set_number(name, value) == ""
    session.advance(seconds)
    assert not session.instant().trouble
    return session


def height(session: Session) -> float:
    return float(session.instant().state["centre_of_mass"][2])


def test_it_floats_at_the_surface_and_says_how_much_of_it_is_under():
    session = afloat(0.4)
    look = session.instant()
    assert look.level == 0.6
    assert height(session) == pytest.approx(0.6, abs=0.08)
    assert float(look.state["share_under"]) == pytest.approx(0.95, abs=0.03)
    page = status(look, session.settings, rate=1.0, notice="", paused=False)
    assert "under water" in page
    session.advance(1.0)
    assert "swimming" in status(session.instant(), session.settings, rate=1.0, notice="", paused=False)


def test_it_follows_the_level_and_sinks_without_its_air():
    kept, let_out = afloat(0.8), afloat(0.8, air_fraction=0.0)
    lower = afloat(0.8, level=550.0)
    assert height(let_out) < height(kept) - 0.01
    assert height(lower) < height(kept) - 0.02


def test_it_walks_where_it_is_told_to_and_swims_again():
    session, asked = afloat(0.1), []
    for swims in (False, True):
        assert session.switch("swims", swims) == ""
        session.advance(0.02)
        asked.append(session._live._loop.command.targets.copy())
    assert np.abs(asked[1] - asked[0]).max() > 0.5  # limbs on the ground, or back along the body
    session.reset()
    session.advance(0.05)
    assert session.instant().level == 0.6


def test_a_robot_without_air_keeps_its_air_and_is_told_why():
    session = Session(ROBOTS["caiman"], CRAWL, swim=WAVE)
    assert "no air that it could let out" in session.set_number("air_fraction", 50.0)
    assert session.settings.air_fraction == 1.0


def test_on_dry_land_there_is_no_water():
    session = Session(ROBOT, CRAWL)
    assert session.set_number("level", 300.0) == ""
    session.advance(0.05)
    assert session.instant().level is None
    assert "share_under" not in session.instant().state
    assert "under water" not in status(session.instant(), session.settings, rate=1.0, notice="", paused=False)


def test_a_live_swim_is_the_swim_of_a_batch():
    run = Run(robot=ROBOT, gait=WAVE, lake=Lake(level=0.6), control=Swimming())
    live = Live(run, timestep=0.005)
    for _ in range(30):
        live.step()
    record = simulate([run], duration=0.3, timestep=0.005)
    assert live.current_sample["position"] == pytest.approx(record.position[0, -1].values, abs=1e-9)
    assert float(live.current_sample["share_under"]) == pytest.approx(float(record.share_under[0, -1]), abs=1e-9)


def test_what_a_live_run_cannot_do_is_refused():
    hold = Swimming(depth=DepthHold(depth=0.3))
    with pytest.raises(InvalidDesign, match="a Swimming without heading and depth hold"):
        Live(Run(robot=ROBOT, gait=CRAWL, lake=Lake(level=0.6), control=hold))
    with pytest.raises(InvalidDesign, match="this run is on dry land"):
        Live(Run(robot=ROBOT, gait=WAVE, control=Swimming())).fill(Lake(level=0.1))
