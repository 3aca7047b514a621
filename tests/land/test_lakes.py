"""Runs in water: dry bytes, threads, records, what may change, and what is refused."""

from dataclasses import replace
from math import inf, nan, radians

import mujoco
import numpy as np
import pytest
from numba import cfunc, types
from tests.swims import crocodile_swim

from suchus.core import rotation
from suchus.core.errors import InvalidDesign, OtherMuJoCo, OutsideLimits
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.control import Swimming
from suchus.robot.design import crocodile, with_values
from suchus.robot.design.pieces import volumes
from suchus.robot.design.water import Water
from suchus.robot.motion import LIMBS_UP, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.immersion import structs, wetting
from suchus.sim.land import VACUUM, Ground, Lake, Run, Wave, crawl, simulate
from suchus.sim.land.afloat import check_floats
from suchus.sim.record import WATER

WAVE = crocodile_swim(yaw=(0.1, 0.1, 0.1), yaw_lag=(0.2, 0.1, 0.0), tail=0.6, tail_lag=-0.1, limbs=LIMBS_UP)
REST = straight_gait(ROBOTS["caiman"], limbs=LIMBS_UP)


def runs(*lakes, **more):
    return [Run(robot="caiman", gait="belly_crawl", lake=lake, seed=i, **more) for i, lake in enumerate(lakes)]


def test_water_far_below_changes_no_byte():
    dry = crawl("caiman", "belly_crawl", duration=0.5)
    below = crawl("caiman", "belly_crawl", duration=0.5, lake=Lake(level=-5.0))
    for name in dry:
        assert np.array_equal(below[name], dry[name]), name
    assert float(below.share_under.max()) == 0.0


def test_threads_change_no_byte(monkeypatch):
    some = runs(*(Lake(level=level, wave=Wave(height=0.02, length=1.0)) for level in (0.04, 0.08, 0.2)), noise=0.01)
    found = []
    for count in ("1", "2"):
        monkeypatch.setenv("SUCHUS_THREADS", count)
        found.append(simulate(some, duration=0.4))
    assert found[0].identical(found[1])


def test_runs_that_go_alike_in_one_lake_give_what_each_gives_alone():
    lakes = [Lake(level=0.05), Lake(level=0.05), Lake(level=0.1)]
    together = simulate(runs(*lakes), duration=0.3)
    for i, lake in enumerate(lakes):
        alone = crawl("caiman", "belly_crawl", duration=0.3, lake=lake, seed=i)
        for name in ("position", "water_force", "share_under"):
            assert np.array_equal(together[name].isel(run=i), alone[name]), name


def test_a_record_tells_of_the_water_and_dry_runs_beside_say_that_there_is_none():
    record = simulate(runs(Lake(level=0.06), None), duration=0.2)
    wet, dry = record.isel(run=0), record.isel(run=1)
    assert set(WATER) <= set(record)
    assert float(wet.water_level[0]) == 0.06
    assert 0.0 < float(wet.share_under[-1]) < 1.0
    assert float(dry.share_under.max()) == 0.0
    assert np.isnan(dry.water_level).all()
    assert '"level": 0.06' in str(wet.swims_in.values)
    assert str(dry.swims_in.values) == ""
    assert "share_under" not in simulate(runs(None), duration=0.05)


def test_level_and_air_fraction_change_while_the_run_goes():
    robot = ROBOTS["floating_caiman"]
    rising = Lake(level=((0.0, 0.0), (0.2, 0.1)), air_fraction=((0.0, 1.0), (0.2, 0.5)))
    record = crawl(robot, "belly_crawl", duration=0.4, lake=rising)
    assert float(record.water_level.sel(time=0.1, method="nearest")) == pytest.approx(0.05, abs=0.006)
    assert float(record.water_level[-1]) == pytest.approx(0.1)
    assert float(record.air_fraction[-1]) == pytest.approx(0.5)
    # let out at once, half the air weighs as much less as its water
    still = [crawl(robot, "belly_crawl", duration=0.01, lake=Lake(level=9.0, air_fraction=b)) for b in (1.0, 0.5)]
    less = float(still[0].water_force[0, 2] - still[1].water_force[0, 2])
    assert less > 0.0


def test_air_let_out_weighs_as_much_as_its_water():
    bare = ROBOTS["floating_caiman"]
    heavy = replace(bare, hull=replace(bare.hull, density=500.0))  # sinks whichever: all of it stays under water
    force = [
        float(
            crawl(
                heavy, "belly_crawl", duration=0.01, lake=Lake(level=9.0, air_fraction=b, added_mass=0.0)
            ).water_force[0, 2]
        )
        for b in (1.0, 0.5)
    ]
    assert force[0] - force[1] == pytest.approx(0.5 * bare.hull.air * 1000 * 9.81, rel=1e-6)


def test_buoyancy_is_against_gravity_where_the_ground_slopes():
    slope = Ground(uphill=0.3)
    record = crawl("caiman", "belly_crawl", duration=0.01, ground=slope, lake=Lake(level=9.0, added_mass=0.0))
    force = record.water_force[0].values
    assert force / np.linalg.norm(force) == pytest.approx([np.sin(0.3), 0.0, np.cos(0.3)], abs=1e-9)


def test_a_robot_that_floats_begins_at_the_surface_and_one_that_sinks_stands():
    lake = Lake(level=1.0)
    light, heavy = (
        crawl(name, REST, duration=0.01, lake=lake, control=Swimming()) for name in ("floating_caiman", "caiman")
    )
    assert float(light.water_force[0, 2]) == pytest.approx(9.81 * float(light.mass), rel=1e-6)
    assert float(light.position[0, 2]) > 0.9
    assert float(heavy.position[0, 2]) < 0.2


def test_let_go_heeled_by_150_degrees_it_rights_itself_and_with_its_foam_no_higher_it_does_not():
    robot = ROBOTS["floating_caiman"]
    flat = replace(robot, hull=replace(robot.hull, foam=tuple(replace(foam, raised=0.0) for foam in robot.hull.foam)))
    some = [
        Run(robot=one, gait=REST, lake=Lake(level=3.0, heel=radians(150)), control=Swimming()) for one in (robot, flat)
    ]
    record = simulate(some, duration=9.0, timestep=0.01, sample_stride=10)
    heel = np.abs(rotation.heel(record.orientation.values))[:, -20:]
    assert heel[0].max() < 0.035
    assert heel[1].min() > radians(150)
    assert float(record.share_under[0, -20:].mean()) == pytest.approx(0.95, abs=0.005)


def test_the_steepest_wave_is_allowed():
    assert Wave(height=0.1419, length=1.0).frequency == pytest.approx(np.sqrt(9.81 / (2 * np.pi)), rel=1e-3)


def test_it_swims_forward_and_backward_with_the_wave():
    def distance(swim):
        lake = Lake(level=2.0)
        record = crawl("floating_caiman", swim, duration=4.0, lake=lake, control=Swimming())
        return float(record.position[-1, 0])

    assert distance(WAVE) > 0.1
    assert distance(WAVE.reversed()) < distance(WAVE) - 0.2


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Lake(level=nan), r"lake.level is nan m; -1000 to 1000 m is allowed"),
        (lambda: Lake(level=2e3), r"lake.level is 2000 m"),
        (lambda: Lake(level=((1.0, 0.0), (0.5, 0.1))), "the times rising"),
        (lambda: Lake(level=((0.0, 0.0), (0.5, 2e3))), "a number of -1000 to 1000 m, or pairs of a time"),
        (lambda: Lake(level=0.0, air_fraction=1.5), r"lake.air_fraction is 1.5; 0 to 1 is allowed"),
        (lambda: Lake(level=0.0, current=(inf, 0.0)), r"current\[0\] is inf m/s; -5 to 5 m/s is allowed"),
        (lambda: Lake(level=0.0, wave=Wave(height=0.5, length=1.0)), "steeper than 0.142, where waves break"),
        (lambda: Wave(height=0.1, length=0.0), "length is 0 m"),
        (lambda: Wave(height=0.143, length=1.0), "at this length at most 0.142 m are allowed"),
        (lambda: Lake(level=0.0, current=(0.0, nan)), r"current\[1\] is nan m/s"),
        (lambda: Water(density=0.0), "water.density is 0 kg/m3"),
        (lambda: Water(cross_drag=-1.0), "water.cross_drag is -1"),
        (lambda: Run(robot="caiman", gait="belly_crawl", lake=Lake(level=0.0), afloat=VACUUM), "not in both"),
        (
            lambda: crawl("caiman", "belly_crawl", duration=0.1, lake=Lake(level=0.0, air_fraction=0.5)),
            "no air that it could",
        ),
        (lambda: Swimming(ramp=-1.0), "swimming.ramp is -1 s"),
    ],
)
def test_bad_water_is_refused_in_a_sentence(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make()


def test_a_robot_that_sinks_is_told_by_how_much_and_one_that_floats_is_not():
    """Foam of 40 kg/m3: a litre of it carries 960 g."""
    caiman, floating = ROBOTS["caiman"], ROBOTS["floating_caiman"]
    lacking = caiman.mass - 1000.0 * sum(volumes(caiman).values())
    with pytest.raises(InvalidDesign, match="robot 'caiman' sinks") as refused:
        check_floats(caiman, Lake(level=1.0))
    assert f"{1e3 * lacking:.3g} g heavier" in str(refused.value)
    assert f"{lacking / 0.96:.3g} l of foam more" in str(refused.value)
    assert f"{lacking:.3g} l more air" in str(refused.value)
    check_floats(floating, Lake(level=1.0))
    with pytest.raises(InvalidDesign, match="robot 'floating_caiman' sinks"):
        check_floats(floating, Lake(level=1.0, air_fraction=0.0))
    check_floats(caiman, Lake(level=1.0, water=Water(density=2000.0)))
    leaden = with_values(floating, {"hull.density": 1000.0})
    with pytest.raises(InvalidDesign, match=r"displaces; lighter foam, as design\.flotation.float_hull makes"):
        check_floats(leaden, Lake(level=1.0))


@pytest.mark.parametrize("name", ["swim_free", "shore"])
def test_experiments_at_the_surface_refuse_a_robot_that_sinks(name):
    with pytest.raises(InvalidDesign, match="robot 'caiman' sinks"):
        replace(EXPERIMENTS[name].quick(), robot=ROBOTS["caiman"]).simulate()


def test_a_run_that_diverges_in_water_ends_with_its_time_and_the_others_go_on():
    robot = ROBOTS["caiman"]
    servo = replace(robot.hind_leg.servo, kp=9000.0, kd=0.0, armature=1e-4, damping=0.0, torque=900.0)
    wild = crocodile(replace(robot.tables, name="wild", hind_leg=replace(robot.tables.hind_leg, servo=servo)))
    lake = Lake(level=0.06)
    some = [Run(robot=one, gait="belly_crawl", lake=lake) for one in (wild, robot)]
    record = simulate(some, duration=1.0, timestep=0.005)
    assert str(record.cause[0].values)
    assert 0.0 <= float(record.ended[0]) < 1.0
    assert np.isnan(record.position[0, -1]).all()
    assert not str(record.cause[1].values)
    assert np.isfinite(record.water_force[1]).all()


def test_a_swim_beyond_the_joints_is_refused():
    most = ROBOTS["caiman"].tail.bend_limit - 0.6
    crawl("caiman", WAVE.with_numbers(tail_offset=most - 1e-6), duration=0.01, control=Swimming())
    with pytest.raises(OutsideLimits, match="the hinges of cable tail_cable of robot 'caiman'"):
        crawl("caiman", WAVE.with_numbers(tail_offset=most + 1e-6), duration=0.01, control=Swimming())


def test_the_offsets_are_where_mujocos_own_arrays_are():
    at = wetting.offsets()
    assert len(set(at)) == len(at)
    assert at.min() >= 0


@pytest.mark.parametrize("field", ["qvel", "xmat"])
def test_a_moved_field_is_found_and_named(field, monkeypatch):
    honest = structs.offset
    monkeypatch.setattr(structs, "offset", lambda struct, name: honest(struct, name) + 8 * (name == field))
    with pytest.raises(OtherMuJoCo, match=rf"mjData.{field} of MuJoCo {mujoco.__version__} is not where it should be"):
        wetting.offsets()


def test_a_missing_field_is_named():
    with pytest.raises(OtherMuJoCo, match=r"mjData\.nothing"):
        structs.offset("mjData", "nothing")
    with pytest.raises(OtherMuJoCo, match="mjNothing"):
        structs.offset("mjNothing", "nothing")


def test_a_plugin_that_does_nothing_is_found(monkeypatch):
    wetting.install()
    monkeypatch.setattr(wetting, "LEVEL", 3)  # the level stays at the ball's middle
    wetting._check_that_it_acts.cache_clear()
    with pytest.raises(OtherMuJoCo, match=r"mjpPlugin.compute .* a ball of 4 l under water displaces 2 l"):
        wetting.install()


def test_a_header_without_the_plugin_is_named(monkeypatch, tmp_path):
    structs.plugin_struct.cache_clear()
    monkeypatch.setattr(structs.mujoco, "__file__", str(tmp_path / "__init__.py"))
    with pytest.raises(OtherMuJoCo, match=r"mjpPlugin\.capabilityflags"):
        structs.plugin_struct()
    monkeypatch.undo()
    fields = [name for name, _ in structs.plugin_struct()._fields_]
    assert fields.index("compute") == fields.index("reset") + 1
    assert fields[0] == "name"


def test_water_acts_beside_somebody_elses_callback():
    alone = crawl("caiman", "belly_crawl", duration=0.05, lake=Lake(level=0.06))

    @cfunc(types.void(types.voidptr, types.voidptr), nopython=True)
    def theirs(model, data):
        return None

    mujoco.set_mjcb_passive(theirs.ctypes)
    try:
        beside = crawl("caiman", "belly_crawl", duration=0.05, lake=Lake(level=0.06))
    finally:
        mujoco.set_mjcb_passive(None)
    assert beside.identical(alone)
