"""Robot and flow together: momentum, energy and what is left over, repeats, and what is refused."""

import warnings
from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from scipy.linalg import eigh

import suchus
from body_files import eight, giant, hatchling, six
from suchus.core.errors import Diverged, Doubtful, InvalidDesign, UnknownName, UnreadableFile
from suchus.core.fingerprint import fingerprint
from suchus.core.progress import silent
from suchus.robot.control import Swimming
from suchus.robot.control.holding import HeadingHold
from suchus.robot.design.scale import rescale
from suchus.robot.motion import roll
from suchus.sim.land import Ground, Lake, Push, Run
from suchus.sim.land.stepper import CoordinateState, Stepper
from suchus.sim.land.waters import Sections, Slice, Space
from suchus.sim.record import COUPLED, WATER
from suchus.swimming.coupling import Swim, check_on_joints, simulate
from suchus.swimming.coupling import swim as coupled
from suchus.swimming.coupling.chain import MidlineChain
from suchus.swimming.coupling.on_joints import floating
from suchus.swimming.water import Outline, swim_of
from suchus.swimming.water.resolved import check_resolved_swim
from suchus.swimming.water.setting import SwimSetting

SLICE = Slice(cells=64, reynolds=1500.0)


def robot():
    return suchus.ROBOTS["swimmer"]


def swim_run(name="swimmer", water=SLICE, **changes):
    robot = suchus.ROBOTS[name]
    return Run(robot=robot, gait=swim_of(robot, frequency=1.0), water=water, control=Swimming(ramp=0.5), **changes)


@cache
def swum():
    """A short swim of the limbless swimmer in a slice, and its momentum after each step."""
    swim, momenta = Swim(swim_run(), 0.3), []
    swim.go(
        0.3, progress=silent,
        watch=lambda one: momenta.append((one.stepper.mass() @ one.stepper.coordinates.rate)[:2]),
    )  # fmt: skip
    return swim, swim.record().isel(run=0), np.array(momenta)


def test_the_robots_momentum_is_the_impulse_of_the_water():
    swim, record, momenta = swum()
    impulses = np.cumsum(np.diff([0.0, *swim.series.time])[:, None] * np.array(swim.series.force)[:, :2], axis=0)
    apart = np.abs(momenta - impulses).max(axis=1)
    most = np.maximum.accumulate(np.hypot(*momenta.T))
    assert (apart[3:] < 0.01 * most[3:]).all()  # 0.07 where what a step leaves over is forgotten
    dt = float(record.time[1] - record.time[0])
    speed = np.gradient(record.centre_of_mass.values[:, :2], dt, axis=0)
    summed = record.water_force.values[:, :2].cumsum(axis=0) * dt
    assert np.abs(float(record.mass) * speed - summed)[2:-2].max() < 0.05 * np.abs(momenta).max()


def test_the_flow_sees_positions_of_the_time_of_the_velocities():
    """MuJoCo's positions are half a physics step ahead of its velocities, in the plane and in space."""
    run = swim_run()
    swim = Swim(run, 0.1, timestep=0.002)
    state = swim.stepper.coordinates
    rate = 0.3 + 0.1 * np.arange(state.rate.size)
    seen = swim._flow_state(replace(state, rate=rate))
    exact = swim.chain.flow_state(state.position - 0.001 * rate, rate)
    assert seen.position == pytest.approx(exact.position, abs=1e-15)
    model = swim.stepper.model
    position = np.array(mujoco.MjData(model).qpos)
    position[3:7] = [0.5, 0.5, -0.5, 0.5]
    rate = 3.0 + 0.1 * np.arange(model.nv)
    earlier = coupled._earlier_position(CoordinateState(position=position.copy(), rate=rate), 0.01)
    mujoco.mj_integratePos(model, position, rate, -0.01)
    assert earlier == pytest.approx(position, abs=1e-12)


def test_a_swim_does_not_depend_on_the_physics_step():
    """After a second; it swam 2.3 % less far where positions and velocities were half a physics step apart."""
    ways = []
    for timestep in (0.002, None):
        swim = Swim(swim_run(), 1.0, timestep=timestep)
        start = swim.stepper.coordinates.position[0]
        swim.go(1.0, progress=silent)
        ways.append(swim.stepper.coordinates.position[0] - start)
    assert swim.timestep < 0.001
    assert ways[0] == pytest.approx(ways[1], rel=0.01)


def test_momentum_that_comes_from_no_force_is_told():
    """MuJoCo's steps gain some where joints turn fast; a force and a push are none of it."""
    stepper = Stepper(
        replace(disturbed(), noise=0.0, faults=()), MidlineChain(Outline(robot(), 33), 45).joints, 0.002, 50
    )
    force = 0.2 * np.cos(np.arange(len(stepper.dofs)))
    carried = stepper.set_added_mass(0.5 * stepper.mass())
    strayed, given, most = np.zeros(2), np.zeros(2), 0.0
    while stepper.time < 0.08:
        before = stepper.coordinates.rate
        stepper.begin()
        stepper.go(count := stepper.steps_until(0.08, 5), force)
        one = stepper.account()
        strayed += one.momentum_defect
        given += count * stepper.timestep * force[:2] - (carried @ (stepper.coordinates.rate - before))[:2]
        most = max(most, float(np.abs(one.momentum_defect).max()))
    pushed = np.array([0.0, 0.3 * 0.035])
    assert one.momentum == pytest.approx((stepper.mass() @ stepper.coordinates.rate)[:2], abs=1e-12)
    assert one.momentum - strayed == pytest.approx(given + pushed, abs=1e-9)
    assert most > 1e-5


def test_the_added_mass_learns_what_the_water_answers():
    """It is symmetric before and after, and what a push does not move, by inertia, answers as before."""
    rng = np.random.default_rng(2)
    added, mass = (square @ square.T for square in rng.normal(size=(2, 5, 5)))
    push = rng.normal(size=5)
    answered = added @ push + 0.2 * mass @ push
    after = coupled.update_added_mass(added, mass, push, answered)
    assert after @ push == pytest.approx(answered)
    assert after == pytest.approx(after.T, abs=1e-12)
    assert np.linalg.eigvalsh(mass + after).min() > 0.0
    other = rng.normal(size=5)
    other -= push * (other @ (mass + added) @ push) / (push @ (mass + added) @ push)
    seen = mass @ push + answered
    lost = (after - added) @ other
    assert lost == pytest.approx(seen * (seen @ other) / (seen @ push))
    assert coupled.update_added_mass(added, mass, push, added @ push) == pytest.approx(added)
    assert coupled.update_added_mass(added, mass, 0.0 * push, 0.0 * push) is added


@pytest.mark.parametrize(("share", "believed"), [(0.2, True), (0.05, False), (-1.0, False)])
def test_what_an_answer_would_take_from_the_mass_is_not_believed(share, believed):
    """Water that pushes on would leave the robot less than its own mass."""
    rng = np.random.default_rng(3)
    added, mass = (square @ square.T for square in rng.normal(size=(2, 5, 5)))
    push = rng.normal(size=5)
    answered = share * (mass + added) @ push - mass @ push
    after = coupled.update_added_mass(added, mass, push, answered)
    assert (after is not added) is believed
    assert np.linalg.eigvalsh(mass + after).min() > 0.0
    swim = Swim(swim_run(), 0.1)
    push, start = np.ones(swim.chain.size), swim._added_mass
    answered = share * (swim.stepper.mass() + start) @ push - swim.stepper.mass() @ push
    gained = swim._learn(push, answered)
    assert swim._added_mass == pytest.approx(start + gained)
    assert np.any(gained) == believed


def test_steps_before_an_end_are_about_equally_long():
    stepper = Stepper(replace(disturbed(), noise=0.0, faults=(), pushes=()), (), 0.002, 50)
    assert stepper.steps_until(0.1, 7) == 7
    assert stepper.steps_until(0.1, 7, landing=7) == 7
    assert stepper.steps_until(0.1, 7, landing=8) == 7  # 50 physics steps in eight
    assert stepper.steps_until(0.03, 7, landing=8) == 5  # 15 in three
    assert stepper.steps_until(0.03, 7) == 7


@pytest.mark.parametrize(("most", "period", "found"), [(16, 5, 13), (15, 5, 13), (13, 5, 13), (4, 5, 4), (1, 5, 1),
                                                       (12, 6, 11), (8, 4, 7), (10, 10, 9)])  # fmt: skip
def test_steps_of_the_flow_end_at_other_phases_of_the_servos_each_time(most, period, found):
    assert coupled.incommensurate_steps(most, period) == found
    assert len({k * found % period for k in range(period)}) == period


def test_a_light_robot_has_the_momentum_and_the_energy_that_the_water_leaves_it():
    """A fiftieth of its mass: what a step may leave over of the water's force is many times the robot's own."""
    light = rescale(suchus.ROBOTS["swimmer"], length_factor=1.0, mass_factor=0.02)
    run = Run(robot=light, gait=swim_of(light, frequency=1.0), water=SLICE, control=Swimming(ramp=0.5))
    swim, momenta = Swim(run, 0.55), []
    swim.go(
        0.55, progress=silent,
        watch=lambda one: momenta.append((one.stepper.mass() @ one.stepper.coordinates.rate)[:2]),
    )  # fmt: skip
    impulses = np.cumsum(np.diff([0.0, *swim.series.time])[:, None] * np.array(swim.series.force)[:, :2], axis=0)
    greatest = np.abs(momenta).max()
    assert np.abs(momenta - impulses).max() < 0.01 * greatest
    # nothing else is lost
    assert momenta[-1] - impulses[-1] == pytest.approx(-swim._residual_impulse[:2], abs=1e-6 * greatest)
    record = swim.record().isel(run=0)
    assert float(abs(record.energy_error[-1])) < 3e-4  # 1.3e-3 where the force on a step is taken for even
    assert float(abs(record.power_error[-1])) < 3e-3  # 5e-3 where cells belong to the part that their first face does


def test_what_servos_and_water_do_is_the_robots_kinetic_energy():
    """Without a flow: a constant force in the place of the water's, and an added mass beside it."""
    run = swim_run()
    joints = MidlineChain(Outline(run.robot, 33), 45).joints
    stepper = Stepper(run, joints, 0.002, 50)
    force = 0.02 * np.arange(3 + len(joints))
    added = stepper.set_added_mass(np.diag(0.5 * np.diag(stepper.mass())))
    done = given = most = 0.0
    for _ in range(40):
        stepper.begin()
        stepper.go(5, force)
        one = stepper.account()
        done += one.servo_work + one.passive_work
        given += float(force @ one.displacement)
        rate = stepper.coordinates.rate
        most = max(most, abs(done))
        assert one.energy + 0.5 * rate @ added @ rate == pytest.approx(done + given, abs=1e-3 * most)
    assert most > 0.01
    assert abs(given) > 0.05 * most


def test_energy_closes_and_little_is_left_over():
    _, record, _ = swum()
    assert float(abs(record.energy_error[-1])) < 1e-3
    assert float(abs(record.power_error[-1])) < 2e-3  # 0.0142 with what the parts do to each other
    assert float(record.coupling_residual[5:].max()) < 2e-2
    assert float(record.coupling_first[5:].max()) > 2 * float(record.coupling_residual[5:].max())
    assert {*WATER, *COUPLED} <= {*record.data_vars}
    assert np.isfinite(record.link_force.values).all()
    assert record.water_force.values == pytest.approx(record.link_force.values.sum(axis=1))


def test_the_recorded_power_of_the_servos_is_their_work():
    """What servos do counts over every physics step; samples of torque and speed miss a quarter of it."""
    swim, record, _ = swum()
    dt = float(record.time[1] - record.time[0])
    work = np.cumsum([row[0] for row in swim.series.work])
    summed = float(record.servo_power[1:].sum()) * dt
    assert summed == pytest.approx(work[-1], rel=1e-2)
    assert float(record.servo_absolute_power[1:].sum()) * dt == pytest.approx(swim.effort, rel=1e-9)
    sampled = float((record.servo_torque * record.servo_velocity)[1:].sum()) * dt
    assert abs(sampled - work[-1]) > 0.1 * work[-1]
    mean, square = record.servo_mean_torque.values, record.servo_mean_square_torque.values
    assert (square >= mean**2 - 1e-12).all()
    assert (record.servo_peak_torque.values[1:] >= np.sqrt(square[1:]) - 1e-12).all()


@cache
def above_floor(depth):
    """A robot in space so far above a floor [m]; None is no floor."""
    robot = suchus.ROBOTS["floating_caiman"]
    water = Space(cells=54, reynolds=1500.0, floor=depth)
    run = Run(robot=robot, gait=swim_of(robot, frequency=1.0), water=water, control=Swimming(ramp=0.2))
    return Swim(run, 0.1)


def test_a_floor_near_a_robot_raises_its_added_mass_and_a_far_one_hardly():
    free, far, near = (np.diag(above_floor(depth)._start_added)[1] for depth in (None, 0.6, 0.1))
    assert far == pytest.approx(free, rel=0.01)
    assert near > 1.05 * free


def test_the_floor_is_at_rest_in_the_world_below_a_grid_that_travels():
    swim = above_floor(0.1)
    for _ in range(3):
        swim.step(0.1)
    grid, side = swim.sim.setup.grid, swim.sim.setup.sides.low
    assert grid.origin[2] == pytest.approx(-0.1)
    drift = np.array(swim.sim.pose(swim.run.robot.name).velocity)
    assert np.hypot(*drift[:2]) > 1e-5
    assert side.wall_velocity(swim.time, 3) == pytest.approx(tuple(-drift[:2]))
    assert swim.series.residual[-1][1] < 0.02


def test_a_floor_that_cannot_be_is_refused():
    with pytest.raises(InvalidDesign, match=r"fewer than 2 cells of water .* Give a floor of at least 0\.0694 m"):
        above_floor(0.03)
    with pytest.raises(InvalidDesign, match=r"slice\.floor is for a body in space"):
        Slice(cells=64, floor=0.3)
    with pytest.raises(InvalidDesign, match=r"space\.floor is below a body that stays in its plane"):
        Space(cells=64, floor=0.3, linked=True)
    with pytest.raises(InvalidDesign, match=r"space\.floor is -1"):
        Space(cells=64, floor=-1.0)


@pytest.mark.parametrize(("cells", "said"), [(40, True), (128, False)])
def test_a_slice_that_is_much_thicker_than_the_body_is_said(cells, said):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", Doubtful)
        Swim(swim_run(water=Slice(cells=cells, reynolds=600.0)), 0.1)
    words = [str(one.message) for one in told if "thickened to 3.5 cells" in str(one.message)]
    assert bool(words) == said
    if said:
        enough = int(words[0].split("at least ")[1].split()[0])
        outline = Outline(robot(), 129)
        assert coupled.thickening(outline, 1.75, enough) <= coupled.MAX_THICKENING
        assert coupled.thickening(outline, 1.75, int(enough / 1.1)) > coupled.MAX_THICKENING


def test_a_run_in_a_flow_keeps_to_its_rung():
    run = swim_run(water="slice")
    assert run.solved_flow == Slice()
    assert swim_run(water="space").solved_flow == Space()
    assert swim_run("floating_caiman", water="sections").lake == Lake(level=2 * suchus.ROBOTS["floating_caiman"].length)
    with pytest.raises(UnknownName, match="sections, slice, space"):
        swim_run(water="tank")
    with pytest.raises(InvalidDesign, match=r"give the runs to suchus\.swimming\.coupling\.simulate"):
        suchus.simulate([run], duration=0.1)
    with pytest.raises(InvalidDesign, match="neither surface nor ground"):
        swim_run(ground=Ground(uphill=0.1))
    with pytest.raises(InvalidDesign, match="two different lakes"):
        swim_run(water=Sections(lake=Lake(level=1.0)), lake=Lake(level=2.0))
    with pytest.raises(InvalidDesign, match=r"slice.cells is 8; a whole number of 32 to 4096"):
        Slice(cells=8)


def test_a_joint_that_comes_to_its_stop_is_said_once():
    swim = Swim(disturbed(), 0.1)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", Doubtful)
        swim.step(0.1)
        assert not any("range" in str(one.message) for one in told)
        low, high = swim.stepper._ranges[0]
        assert low < -0.1 < 0.1 < high
        swim.stepper._ranges[0] = -1.0, -0.5
        swim.step(0.1)
        swim.step(0.1)
    said = [str(one.message) for one in told if "range" in str(one.message)]
    assert len(said) == 1
    assert "joint spine_yaw_1 of robot 'swimmer' is driven to the end of its range" in said[0]


def test_a_robot_that_sinks_is_refused():
    with pytest.raises(InvalidDesign, match=r"robot 'caiman' sinks: it is 999 g heavier .* l of foam more"):
        Swim(swim_run("caiman"), 0.1)


@pytest.mark.parametrize(("robot", "gait", "why"), [
    ("strider", "tripod", "gait 'tripod' strokes with a limb: servo LF_yaw"),
    ("floating_caiman", "belly_crawl", "strokes with a limb"),
])  # fmt: skip
def test_a_gait_that_the_flow_cannot_see_is_refused(robot, gait, why):
    with pytest.raises(InvalidDesign, match=why):
        Swim(Run(robot=robot, gait=gait, water="slice"), 0.1)


def test_what_joints_cannot_swim_is_refused_before_any_water_is_there():
    robot, setting = suchus.ROBOTS["caiman"], SwimSetting(axes=3, cells=64, viscosity=4e-4, cycles=2)
    check_on_joints(robot, swim_of(robot, frequency=1.0), setting)  # with foam that carries it
    with pytest.raises(InvalidDesign, match=r"bends the axis out of the plane: servo"):
        check_on_joints(robot, roll(robot, period=1.0, trunk=(0.3, 0.3), tail=(0.3, 0.3)), setting)


def disturbed():
    """A swim in which controller, noise, push and fault all have a say."""
    robot = suchus.ROBOTS["swimmer"]
    gait = swim_of(robot, frequency=1.0)
    push = Push(force=(0.0, 0.3, 0.0), at=0.02, duration=0.035, body=robot.axis[0].name)
    return Run(
        robot=robot, gait=gait, water=Slice(cells=40, reynolds=600.0), noise=0.01, pushes=(push,),
        control=Swimming(ramp=0.1, heading=HeadingHold()), faults=(suchus.Limp("tail_yaw_5", at=0.045),),
        label="disturbed",
    )  # fmt: skip


class Killed(BaseException):
    """A process that ends where it is."""


def killed(run, file):
    """A swim that is killed at 0.06 s of 0.1 s, each of whose steps was kept."""

    def look(swim):
        swim.samples.add("seen", swim.time, x=swim.stepper.coordinates.position[0])
        if swim.time > 0.06:
            raise Killed

    with pytest.raises(Killed):
        Swim(run, 0.1).go(0.1, watch=look, checkpoint=str(file), checkpoint_every=0.0, progress=silent)


def test_a_swim_that_was_killed_goes_on_to_the_same_bytes(tmp_path):
    run, shares = disturbed(), []
    file = tmp_path / f"{fingerprint(Swim(run, 0.1).setup)[:16]}.kept-swim"
    whole = simulate([run], duration=0.1)
    killed(run, file)
    rest = simulate([run], duration=0.1, keep=tmp_path, progress=lambda stage, share: shares.append(share))
    assert min(shares) > 0.5
    assert rest.identical(whole)
    assert [*tmp_path.iterdir()] == [file]
    ended = Swim(run, 0.1)
    ended.go(0.1, checkpoint=file, progress=silent)
    assert 0 < ended.samples.count("seen") < len(ended.series.time)
    with pytest.raises(UnreadableFile, match="written by another setup"):
        Swim(replace(run, seed=1), 0.1).go(0.1, checkpoint=file, progress=silent)


def test_who_commands_otherwise_than_before_does_not_go_on(tmp_path):
    run = disturbed()
    one, other = Swim(run, 0.1), Swim(replace(run, seed=1), 0.1)
    one.step(0.1)
    with pytest.raises(UnreadableFile, match=r"its controller commands otherwise at t = 0 s than it did"):
        other.resume(one.state())


def test_a_push_acts_in_each_go_through_a_stretch():
    run = replace(disturbed(), noise=0.0, faults=())
    swims = [Swim(one, 0.06) for one in (run, replace(run, pushes=()))]
    for swim in swims:
        swim.go(0.06, progress=silent)
    for swim, impulse in zip(swims, (0.3 * 0.035, 0.0), strict=True):
        steps = np.diff([0.0, *swim.series.time])
        from_water = steps @ np.array(swim.series.force)[:, 1]
        momentum = (swim.stepper.mass() @ swim.stepper.coordinates.rate)[1]
        assert momentum - from_water == pytest.approx(impulse, abs=1.5e-3)  # but for what steps left over
    ends = {round(time, 9) for time in swims[0].series.time}
    assert {0.02, 0.05, 0.06} <= ends  # the control periods in which it begins and ends


def test_a_step_that_does_not_come_to_terms_ends_with_its_numbers_and_the_record_so_far(monkeypatch):
    monkeypatch.setattr(coupled, "MAX_RESIDUAL", 1e-9)
    swim = Swim(swim_run(water=Slice(cells=40, reynolds=600.0)), 0.4)
    most = Slice().corrections
    with pytest.raises(
        Diverged, match=rf"a force of \S+ times the greatest so far is left over .* \(now {most}\)"
    ) as told:
        swim.go(0.4, progress=silent)
    record = told.value.record.isel(run=0)
    reached = np.isfinite(record.coupling_residual.values)
    assert len(swim.series.time) == coupled.MAX_UNCONVERGED_STEPS
    assert 2 < reached.sum() < record.sizes["time"] - 2
    assert told.value.time == pytest.approx(swim.time)
    assert f"at t = {swim.time:.4g} s robot and flow do not converge" in str(record.cause.values)
    assert float(record.ended) == pytest.approx(swim.time)


def test_what_ends_a_swim_in_its_first_step_leaves_an_empty_record(monkeypatch):
    """Whoever leaves the plane or the box, or is too fast, keeps what was until then, if it is nothing."""
    swim = Swim(swim_run(water=Slice(cells=40, reynolds=600.0)), 0.1)
    monkeypatch.setattr(Stepper, "off_plane", ("tail_pitch_1", 0.3))
    monkeypatch.setattr(swim.sim, "next_step", lambda: 1e-9)
    with pytest.raises(Diverged, match=r"the flow allows a step of 1e-09 s, less than") as told:
        swim.go(0.1, progress=silent)
    assert np.isnan(told.value.record.link_force.values).all()
    monkeypatch.undo()
    monkeypatch.setattr(Stepper, "off_plane", ("tail_pitch_1", 0.3))
    with pytest.raises(Diverged, match=r"joint tail_pitch_1 is bent by 0\.3 rad out of the plane") as told:
        swim.go(0.1, progress=silent)
    assert np.isfinite(told.value.record.coupling_residual.values).any()


def test_cells_too_coarse_for_a_body_are_told_in_cells():
    with pytest.raises(InvalidDesign, match=r"robot 'swimmer' is 0\.04 m thick .* with 40 cells .* least 90 cells"):
        Swim(swim_run(water=Space(cells=40, reynolds=600.0)), 0.1)
    robot = suchus.ROBOTS["swimmer"]
    setting = SwimSetting(axes=3, cells=48, viscosity=1e-2, cycles=2)
    with pytest.raises(InvalidDesign, match=r"robot 'swimmer' is 0\.04 m thick .* with 48 cells .* least 90 cells, or"):
        check_resolved_swim(robot, swim_of(robot, frequency=1.0), setting)
    check_resolved_swim(robot, swim_of(robot, frequency=1.0), replace(setting, cells=90))


def test_an_added_mass_that_is_less_than_none_is_none():
    rng = np.random.default_rng(5)
    mass, sound = (part @ part.T + 0.1 * np.eye(4) for part in rng.normal(size=(2, 4, 4)))
    assert coupled.never_negative(sound, mass) is sound
    bad = np.diag([2.0, 1.0, 0.5, -0.2])
    found = coupled.never_negative(bad, mass)
    assert np.linalg.eigvalsh(found).min() == pytest.approx(0.0, abs=1e-12)
    kept, shapes = eigh(bad, mass)
    again = shapes.T @ found @ shapes
    assert np.diag(again) == pytest.approx(np.maximum(kept, 0.0), abs=1e-12)
    assert again == pytest.approx(np.diag(np.diag(again)), abs=1e-12)


@pytest.mark.parametrize("body", [*suchus.ROBOTS, eight, giant, hatchling, six])
def test_any_chain_swims_in_a_slice(body):
    """The giant's tail is lighter than what coarse cells once took from its mass."""
    robot = floating(suchus.ROBOTS[body] if isinstance(body, str) else body())
    gait = swim_of(robot)
    run = Run(robot=robot, gait=gait, water=Slice(cells=40, reynolds=600.0), control=Swimming(ramp=gait.period))
    record = simulate([run], duration=round(0.5 * gait.period, 1), progress=silent).isel(run=0)
    assert np.isnan(float(record.ended)) or float(record.ended) >= float(record.time[-1]) - 1e-9
    # the residual is over the greatest force so far, which is small while the swing begins
    later = record.sel(time=slice(0.2 * gait.period, None))
    assert float(later.coupling_residual.max()) < 0.03
