from contextlib import nullcontext
from dataclasses import replace
from math import inf, nan
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.apps.viewer import Session
from suchus.apps.viewer.bodies import BodyPoses, pieces
from suchus.apps.viewer.history import columns
from suchus.apps.viewer.knobs import (
    BUMPS,
    FORCE,
    GAIT_KNOBS,
    bumps_under,
    displayed_value,
    force_on,
    knobs_of,
    tune_gait,
)
from suchus.apps.viewer.live_page import Controls, gait_file, robot_file, status
from suchus.apps.viewer.plots import gait_bars, plans
from suchus.apps.viewer.session import _PLAIN
from suchus.core.errors import OutsideLimits
from suchus.robot.blueprint import read_design
from suchus.robot.design import crocodile, layout
from suchus.robot.design.scale import control_period, rescale
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import Gait, check_limits, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import Limp, Locked
from suchus.sim.land import simulate

ROBOT, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]
GAIT = replace(CRAWL, period=1.0)


def walked(*, gait: Gait = GAIT, lost: str = "", seconds: float = 3.0) -> Session:
    session = Session(ROBOT, gait)
    if lost:
        assert session.break_part(lost, "limp") == ""
    session.advance(seconds)
    return session


@pytest.fixture(scope="module")
def sound() -> Session:
    return walked()


@pytest.fixture(scope="module")
def lame() -> Session:
    return walked(lost="LF_yaw")


LEGGED = [gait for gait in GAITS.values() if suits(ROBOT, gait)]


@pytest.mark.parametrize("gait", LEGGED, ids=lambda gait: gait.name)
def test_both_ends_of_every_slider_leave_a_gait_that_the_robot_can_walk(gait):
    knobs = knobs_of(ROBOT, gait)
    assert {"period", "duty_factor", "stroke", "lift", "height", "trunk_bend", "tail_bend", "axis_lag"} <= set(knobs)
    for name, knob in knobs.items():
        for end in (knob.low, knob.high):
            found, notice = tune_gait(ROBOT, gait, name, end)
            check_limits(ROBOT, found)
            assert notice or displayed_value(found, name) == pytest.approx(end, abs=1e-9)


def test_hips_too_high_for_the_legs_stop_where_they_end():
    found, notice = tune_gait(ROBOT, CRAWL, "height", 110.0)
    assert 52.0 < displayed_value(found, "height") < 110.0
    assert "cannot follow 110 % of reach" in notice
    further = replace(found, height=found.height + 1e-3)
    with pytest.raises(OutsideLimits):
        check_limits(ROBOT, further)


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(sorted(knobs_of(ROBOT, CRAWL))), st.one_of(st.floats(), st.text(), st.none(), st.integers()))
def test_whatever_is_typed_the_gait_stays_one_that_can_be_walked(name, value):
    found, notice = tune_gait(ROBOT, CRAWL, name, value)
    check_limits(ROBOT, found)
    knob = GAIT_KNOBS[name]
    assert knob.low - 1e-9 <= displayed_value(found, name) <= knob.high + 1e-9
    if notice:
        assert knob.label in notice


@pytest.mark.parametrize(("value", "left"), [(99.0, 4.0), (-3, 0.05), ("fast", 1.0), (nan, 1.0), (inf, 1.0)])
def test_a_wrong_speed_is_clamped_and_said(value, left):
    session = Session(ROBOT, GAIT)
    assert "playback speed" in session.set_number("speed", value)
    assert session.settings.speed == left


def test_every_plain_knob_is_a_field_of_the_settings():
    session = Session(ROBOT, GAIT)
    for name, knob in _PLAIN.items():
        assert session.set_number(name, knob.high) == ""
        assert getattr(session.settings, name) == pytest.approx(knob.high * knob.scale)
    session.advance(0.1)
    assert not session.instant().trouble


def test_a_watched_walk_is_the_walk_of_a_batch(sound):
    record = simulate([sound._live.run], duration=3.0, timestep=0.005).isel(run=0)
    way = record.centre_of_mass.sel(xyz="x")
    assert sound.instant().forward == pytest.approx(float(way[-1] - way.sel(time=1.0)), abs=1e-6)


def test_a_limp_joint_changes_the_displacement(sound, lame):
    assert abs(lame.instant().forward - sound.instant().forward) > 0.01


def test_mirrored_commands_give_a_mirrored_walk():
    left = walked(lost="LF_yaw", seconds=2.5).instant()
    right = walked(gait=GAIT.mirrored(), lost="RF_yaw", seconds=2.5).instant()
    assert left.forward == pytest.approx(right.forward, abs=1e-4)
    assert left.lateral_displacement == pytest.approx(-right.lateral_displacement, abs=1e-4)


def test_a_reset_keeps_what_is_broken(lame):
    session = walked(lost="LF_yaw", seconds=0.1)
    session.reset()
    session.advance(3.0)
    assert session.instant().forward == pytest.approx(lame.instant().forward, abs=2e-3)


def test_what_is_left_of_a_control_period_passes_next_time():
    session = Session(ROBOT, GAIT)
    for _ in range(5):
        session.advance(0.006)  # a control period is 0.01 s
    assert session.instant().time == pytest.approx(0.03)


def test_the_heading_loop_answers_a_turn(lame):
    session = Session(ROBOT, GAIT)
    assert session.switch("heading", True) == ""
    assert session.settings.control.heading is not None
    session.break_part("LF_yaw", "limp")
    session.advance(3.0)
    assert session.instant().lateral_displacement != pytest.approx(lame.instant().lateral_displacement, abs=1e-4)


def test_sessions_do_not_disturb_each_other(sound):
    one, other = Session(ROBOT, GAIT), Session(ROBOT, GAIT)
    for _ in range(30):
        one.advance(0.1)
        other.advance(0.1)
        other.tune("stroke", 5.0)
        other.break_part("RH_knee", "locked")
    assert one.instant().forward == sound.instant().forward
    assert other.instant().forward != one.instant().forward


def test_the_limbs_alone_walk_as_the_control_group_does():
    session = Session(ROBOT, CRAWL)
    session.switch("spine", False)
    session.switch("tail", False)
    assert replace(session.settings.walking_gait(ROBOT), name="limbs_only") == GAITS["limbs_only"]
    session.switch("tail", True)
    assert replace(session.settings.walking_gait(ROBOT), name="tail_drag") == GAITS["tail_drag"]


def test_rules_that_cannot_coordinate_a_gait_are_refused_with_a_sentence():
    session = Session(ROBOT, GAITS["high_walk"])
    assert "diagonal" in session.switch("coordination", True)
    assert not session.settings.coordination
    session.advance(0.1)
    assert not session.instant().trouble


@pytest.mark.parametrize(("name", "way"), [("uphill", "forward"), ("sideways", "lateral_displacement")])
def test_a_slope_takes_effect_at_once_and_is_slid_down(name, way, sound):
    session = Session(ROBOT, GAIT)
    assert session.set_number(name, 15.0) == ""
    session.advance(3.0)
    assert getattr(session.instant(), way) < getattr(sound.instant(), way) - 0.01


def test_repaired_joints_are_no_longer_listed():
    session = Session(ROBOT, GAIT)
    session.break_part("LF_yaw", "limp")
    session.break_part("LF_yaw", "locked")
    session.break_part("RH_pitch", "limp")
    assert session.settings.broken == (Locked("LF_yaw"), Limp("RH_pitch"))
    session.repair_part("LF_yaw")
    assert session.settings.broken == (Limp("RH_pitch"),)
    session.repair_part()
    assert session.settings.broken == ()
    assert "LF_wrist" in session.break_part("LF_wrist", "limp")
    assert "Did you mean 'slow'" in session.break_part("LF_yaw", "slo")
    assert "0.001 to 7.873 rad/s" in session.break_part("LF_yaw", "slow", speed=9.0)
    assert session.settings.broken == ()


def test_every_fault_of_the_shelf_can_be_let_happen_and_is_there_after_a_reset():
    session = Session(ROBOT, GAIT)
    assert session.break_part("LF_yaw", "slow", speed=0.5) == ""
    assert session.break_part("LF", "lost_foot") == ""
    assert session.break_part("foot_pressure", "deaf") == ""
    session.reset()
    session.advance(0.1)
    assert [fault.name for fault in session.settings.broken] == ["slow LF_yaw", "lost_foot LF", "deaf foot_pressure"]
    assert np.all(session.instant().state["foot_force"][0] == 0.0)
    assert "LF yaw slow, LF lost foot" in status(session.instant(), session.settings, rate=1.0, notice="", paused=False)


def test_the_force_of_a_push_is_told_beside_the_weight_of_whom_it_pushes():
    heavy = crocodile(
        replace(ROBOT.tables, name="heavy", pelvis=replace(ROBOT.tables.pelvis, mass=ROBOT.pelvis.mass + 10.0))
    )
    assert force_on(heavy).hint == f"heavy weighs {(ROBOT.mass + 10.0) * 9.81:.0f} N."
    assert replace(force_on(ROBOT), hint="") == FORCE
    assert force_on(heavy).high == pytest.approx(FORCE.high * heavy.mass / ROBOT.mass, rel=0.02)


def test_a_push_lasts_as_long_as_it_says():
    session = Session(ROBOT, GAIT)
    session.advance(0.5)
    session.push()
    session.advance(0.15)
    assert session.instant().push_force == pytest.approx((0.0, 15.0, 0.0), abs=1e-9)
    session.advance(0.1)
    assert session.instant().push_force is None
    assert session.instant().state["centre_of_mass"][1] > 0.005


def test_a_reset_begins_the_same_walk_anew(sound):
    session = walked(seconds=1.5)
    session.reset()
    assert session.instant().time == 0.0
    session.advance(3.0)
    assert session.instant().forward == sound.instant().forward


def test_a_walk_that_comes_apart_says_so_and_can_be_begun_anew(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its warnings
    session = walked(seconds=0.3)
    session._live._loop.batch.qvel[0, 3] = nan
    session.advance(0.5)
    assert "diverged at 0.3" in session.instant().trouble
    session.advance(0.5)
    session.reset()
    session.advance(0.2)
    assert not session.instant().trouble


def test_the_plots_reach_back_a_few_seconds(sound):
    table = sound.table()
    assert np.all(np.diff(table["time"]) > 0)
    weight = sum(table[name][-100:].mean() for name in ("LF", "RF", "LH", "RH", "belly", "tail"))
    assert weight == pytest.approx(ROBOT.mass * 9.81, rel=0.1)


def test_the_article_s_robot_has_the_sliders_that_others_are_scaled_from():
    assert set(GAIT_KNOBS) - set(knobs_of(ROBOT, CRAWL)) == {"crank", "waves", "axis_bend"}  # it has none of them
    assert bumps_under(ROBOT) == BUMPS
    assert Session(ROBOT, GAIT).settings.force == 15.0


@pytest.mark.parametrize("name", list(ROBOTS))
def test_every_robot_walks_live_and_is_drawn_pushed_and_broken(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    session, calm = Session(robot, gait), Session(robot, gait)
    period, weight, place = control_period(robot), 9.81 * robot.mass, layout(robot)
    assert session.settings.force == pytest.approx(0.434 * weight, rel=0.05)
    assert force_on(robot).high * force_on(robot).scale == pytest.approx(1.74 * weight, rel=0.05)
    assert str(round(weight)) in force_on(robot).hint or "mN" in force_on(robot).hint
    for one in (session, calm):
        one.advance(5 * period)
    session.push()
    for one in (session, calm):
        one.advance(15 * period)
    now = session.instant()
    assert now.push_force == pytest.approx((0.0, session.settings.force, 0.0), abs=1e-6)
    moved = now.state["centre_of_mass"][1] - calm.instant().state["centre_of_mass"][1]
    assert moved > (1e-3 * robot.length if place.limbs else 0.0)  # friction all but holds a body that lies on its belly
    part = place.servos[0]
    assert session.break_part(part, "limp") == ""
    session.advance(2 * period)
    assert not session.instant().trouble
    table = session.table()
    assert set(table) == set(columns(place.limb_names))
    posture = BodyPoses(robot)
    posture.set_state(session.instant().state)
    bones = posture.bones(None)
    for piece in pieces(robot, 2):
        assert set(piece.bones) <= set(bones)
    for servo in (*place.servos, *place.limb_names):
        assert np.linalg.norm(posture.part_position(servo) - session.instant().state["position"]) < robot.length
    assert gait_bars(robot, table).count('<text x="2"') == len(place.limbs)
    assert [line.column for line in plans(robot)[2].lines] == [*place.limb_names, "tail", "belly"]


@pytest.mark.parametrize("name", ["pleurobot", "salamander", "salamandra", "strider", "swimmer"])
def test_both_ends_of_the_sliders_of_another_body_leave_a_gait_that_it_can_walk(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    knobs = knobs_of(robot, gait)
    assert {"period", "trunk_offset", "axis_bend" if name == "swimmer" else "trunk_bend"} <= set(knobs)
    assert ("stroke" in knobs, "crank" in knobs) == (name not in ("salamandra", "swimmer"), name == "salamandra")
    for field, knob in knobs.items():
        assert knob.low - 1e-9 <= displayed_value(gait, field) <= knob.high + 1e-9
        for end in (knob.low, knob.high):
            found, notice = tune_gait(robot, gait, field, end)
            check_limits(robot, found)
            assert notice or displayed_value(found, field) == pytest.approx(end, rel=1e-3)
            assert notice == "" or knob.label in notice
    session = Session(robot, gait)
    assert session.tune("trunk_offset", 1.0) == ""
    assert session.settings.gait.number("trunk_offset") == pytest.approx(np.radians(1.0))
    assert session.switch("spine", False) == ""
    assert session.settings.walking_gait(robot).number("trunk_bend") == 0.0
    assert session.settings.walking_gait(robot).number("trunk_offset") == session.settings.gait.number("trunk_offset")


def test_a_smaller_crocodile_has_the_sliders_of_its_gait_and_lower_bumps():
    small = rescale(ROBOT, length_factor=0.5)
    half = knobs_of(small, CRAWL)
    assert half == knobs_of(ROBOT, CRAWL)  # shares of the limbs' reach, and angles
    assert bumps_under(small).high == pytest.approx(30.0)


def test_a_table_of_angles_has_nothing_to_turn_and_is_refused_in_a_sentence():
    robot, gait = ROBOTS["salamander"], GAITS["animal_walk"]
    assert knobs_of(robot, gait) == {}
    with pytest.raises(OutsideLimits, match="has measured curves: choose a gait"):
        Session(robot, gait)


def test_a_body_without_limbs_is_watched_but_has_no_heading_loop():
    session = Session(ROBOTS["swimmer"], default_gait(ROBOTS["swimmer"]))
    assert "needs limbs to walk on; robot 'swimmer' lacks that" in session.switch("heading", True)
    assert session.settings.heading is False
    session.advance(0.05)
    assert not session.instant().trouble


def test_a_saved_gait_reads_back_as_the_gait_that_is_walked(tmp_path):
    session = Session(ROBOT, CRAWL)
    assert session.tune("stroke", 25.0) == ""
    session.switch("spine", False)
    file = gait_file(ROBOT, session.settings)
    (tmp_path / file.name).write_bytes(file.content)
    read_back = read_design(tmp_path / file.name, Gait, GAITS)
    assert file.name == "belly_crawl_tuned.toml"
    assert read_back == replace(session.settings.walking_gait(ROBOT), name="belly_crawl_tuned")
    assert (read_back.number("stroke"), read_back.number("trunk_bend")) == (pytest.approx(0.25), 0.0)


def test_a_gait_as_on_the_shelf_keeps_its_name_and_the_robot_reads_back_equal(tmp_path):
    session = Session(ROBOT, CRAWL)
    assert gait_file(ROBOT, session.settings).name == "belly_crawl.toml"
    file = robot_file(ROBOT)
    (tmp_path / file.name).write_bytes(file.content)
    assert read_design(tmp_path / file.name, type(ROBOT), ROBOTS) == ROBOT


def test_the_buttons_give_the_browser_gait_and_robot():
    pressed, files = {}, []

    def button(label, **_):
        return SimpleNamespace(on_click=lambda act: pressed.setdefault(label, act), value=True)

    def other(*_, **__):
        return SimpleNamespace(on_update=lambda act: None, value="")

    gui = SimpleNamespace(add_button=button, add_folder=lambda *_, **__: nullcontext())
    for kind in ("checkbox", "slider", "number"):
        setattr(gui, f"add_{kind}", other)
    gui.add_dropdown = lambda *_, initial_value="", **__: SimpleNamespace(
        on_update=lambda act: None, value=initial_value, options=()
    )
    session = Session(ROBOT, CRAWL)
    Controls(gui, session, say=files.append, save=files.append)
    session.tune("stroke", 25.0)
    for label in ("save the gait", "save the robot"):
        pressed[label](SimpleNamespace(client=object()))
    assert [file.name for file in files] == ["belly_crawl_tuned.toml", "caiman.toml"]
