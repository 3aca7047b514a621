"""What holds for every fault on the shelf, in batches, live walks and environments alike."""

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from importlib import import_module

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, SuchusError, UnknownName
from suchus.robot.control import LAWS, Command, Coordinated
from suchus.robot.design import crocodile, servo_names
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault, check_faults
from suchus.sim.faults import FAULTS, Backlash, Limp, Locked, Offset, Slow, from_table, numbers
from suchus.sim.land import Live, Run, simulate
from suchus.sim.land.batch import SimulationBatch
from suchus.sim.land.injector import Injector

CAIMAN = ROBOTS["caiman"]
GAIT = replace(GAITS["belly_crawl"], period=1.0)
OPEN = Coordinated(limbs=LAWS["off"], spine=None, tail=None)
OTHER = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.25)))
USUAL = ("LF_pitch", "LF", "foot_pressure")
"""Parts of the caiman that break here, where the module of a fault has no ``examples`` of its own."""
HARMLESS = [fault for name in FAULTS for fault in FAULTS.beside(name, "harmless", ())]
STEP = 0.005


@pytest.fixture(params=list(FAULTS))
def shelved(request):
    return FAULTS[request.param]


def made(kind, at=0.0):
    """Return a fault of a kind so grave that a fifth of a second shows it."""
    examples = FAULTS.beside(kind.kind(), "examples", ())
    parts = kind.parts(CAIMAN)
    fault = examples[0] if examples else kind(next((part for part in USUAL if part in parts), parts[0]))
    return replace(fault, at=at)


def acts_on(kind):
    return FAULTS[kind].acts_on


@lru_cache
def walk(*faults, duration=1.2, beside=()):
    runs = [Run(robot=CAIMAN, gait=GAIT, control=OPEN, faults=faults), *beside]
    return simulate(runs, duration=duration, timestep=STEP).isel(run=0)


def same(one, other):
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.data_vars)


def test_it_is_called_by_its_file_name_and_is_a_frozen_value(shelved):
    fault = made(shelved)
    assert FAULTS[shelved.kind()] is shelved
    assert fault == made(shelved)
    assert len({fault, made(shelved), made(shelved, at=1.0)}) == 2
    assert fault.name == f"{shelved.kind()} {fault.part}"
    assert fault.part in shelved.parts(CAIMAN)
    with pytest.raises(AttributeError):
        fault.at = 1.0


def test_until_it_begins_nothing_differs_and_from_then_on_it_does(shelved):
    intact, broken = walk(), walk(made(shelved, at=1.0))
    assert same(intact.sel(time=slice(None, 0.999)), broken.sel(time=slice(None, 0.999)))
    if shelved.acts_on != "sensor":  # which nobody listens to here
        assert not np.array_equal(intact.joint_angle.sel(time=1.2), broken.joint_angle.sel(time=1.2))


def test_a_robot_in_company_of_others_breaks_as_alone(shelved):
    fault = made(shelved, at=0.3)
    company = (Run(robot=OTHER, gait=GAIT, control=OPEN, faults=(fault,)),)
    assert same(walk(fault, duration=0.6), walk(fault, duration=0.6, beside=company))


@pytest.mark.parametrize("fault", HARMLESS, ids=lambda fault: fault.kind())
def test_a_fault_of_no_severity_is_none(fault):
    assert same(walk(), walk(fault))


def test_a_live_walk_breaks_as_a_run_of_a_batch_does(shelved):
    fault = made(shelved, at=1.0)
    live = Live(Run(robot=CAIMAN, gait=GAIT, control=OPEN), timestep=STEP)
    planned = Live(Run(robot=CAIMAN, gait=GAIT, control=OPEN, faults=(fault,)), timestep=STEP)
    for tick in range(120):
        if tick == 100:
            live.begin(replace(fault, at=0.0))
        live.step()
        planned.step()
    record = walk(fault).sel(time=1.2)
    for name in ("position", "joint_angle", "servo_torque", "foot_force"):
        np.testing.assert_array_equal(live.current_sample[name], planned.current_sample[name])
        np.testing.assert_allclose(
            live.current_sample[name], record[name].values, atol=1e-6
        )  # of one cycle again and again


@dataclass(frozen=True)
class Played:
    """Angles of the servos, one row per control period; a run that begins where an episode does."""

    rows: tuple[tuple[float, ...], ...]
    feels = False

    @staticmethod
    def start(runs, period):
        rows, count = np.array(runs.controls[0].rows), len(runs.robots)

        class Machine:
            def rest(self):
                return np.tile(rows[0], (count, 1))

            def command(self, tick, sensed):
                row = rows[min(tick + 1, len(rows) - 1)]
                return Command(np.tile(row, (count, 1)), np.zeros((count, 4)))

        return Machine()


def test_an_episode_breaks_as_a_run_of_a_batch_does_to_the_byte(shelved):
    envs, pack = pytest.importorskip("suchus.apps.envs", exc_type=ImportError), import_module("suchus.apps.envs.pack")
    task = replace(
        envs.TASKS["Fault"],
        gait=GAIT,
        jitter=0.0,
        breaks=envs.Breaks(faults=(made(shelved),), earliest=0.13, latest=0.13),
    )
    pack = pack.Pack(task, 1)
    pack.restart([0], [np.random.default_rng(0)])
    assert pack.chances[0].fault == f"{made(shelved).part} {shelved.kind()} from 0.13 s"
    told, rows = pack.centre, [pack.centre]
    for number in range(8):
        action = 0.6 * np.sin(0.9 * number + np.arange(19))
        goal = np.clip(pack.centre + task.span * action, pack._lower_limits, pack._upper_limits)
        rows += [told + (k + 1) / 5 * (goal - told) for k in range(5)]
        told = goal
        pack.act(action[None], np.ones(1, dtype=bool))
    control = Played(tuple(tuple(row.tolist()) for row in rows))
    record = simulate(
        [Run(robot=CAIMAN, gait=GAIT, control=control, faults=(made(shelved, at=0.13),))], duration=0.4, timestep=STEP
    ).isel(run=0, time=-1)
    found = pack.record(0).isel(time=0)
    for name in ("position", "orientation", "joint_angle", "servo_velocity", "foot_force"):
        np.testing.assert_array_equal(found[name].values, record[name].values, err_msg=name)


def test_what_is_mended_at_once_was_never_broken(shelved):
    live, intact = (Live(Run(robot=CAIMAN, gait=GAIT, control=OPEN), timestep=STEP) for _ in range(2))
    for tick in range(60):
        if tick == 30:
            live.begin(made(shelved))
            live.mend(made(shelved).part)
        live.step()
        intact.step()
    for name, value in intact.current_sample.items():
        np.testing.assert_array_equal(live.current_sample[name], value, err_msg=name)


@pytest.mark.parametrize("robots", [[CAIMAN, CAIMAN], [CAIMAN, OTHER]], ids=["one robot", "several robots"])
def test_mending_leaves_the_model_as_it_was_built_and_the_neighbour_alone(shelved, robots):
    batch = SimulationBatch([Run(robot=robot, gait=GAIT) for robot in robots], STEP)
    names = ("actuator_forcerange", "actuator_dynprm", "geom_conaffinity")
    injector = Injector(batch, 0.01, robots[0])
    injector.begin(0, made(shelved))
    injector.command(0, np.zeros((2, len(servo_names()))))
    assert injector.broken(0) == (made(shelved),)
    assert injector.broken(1) == ()
    for name in names:
        assert np.array_equal(batch.field(name, 1), getattr(batch.model, name))
    injector.mend(0)
    assert injector.broken(0) == ()
    for name in names:
        assert np.array_equal(batch.field(name, 0), getattr(batch.model, name)), name
    own = batch._models[0].opt if robots[0] != robots[1] else None
    flags = own.disableactuator if own else batch.physics.expand("opt.disableactuator")[0]
    assert int(flags) == 0


@settings(max_examples=20)
@given(kinds=st.lists(st.sampled_from(list(FAULTS)), min_size=1, unique_by=acts_on), seed=st.integers(0, 99))
def test_faults_of_different_parts_end_in_any_order(kinds, seed):
    batch = SimulationBatch([Run(robot=CAIMAN, gait=GAIT)], STEP)
    injector, random = Injector(batch, 0.01, CAIMAN), np.random.default_rng(seed)
    faults = [made(FAULTS[kind]) for kind in kinds]
    for fault in faults:
        injector.begin(0, fault)
    for i in random.permutation(len(faults)):
        injector.mend(0, faults[i].part)
    assert injector.broken(0) == ()
    assert np.array_equal(batch.field("actuator_forcerange", 0), batch.model.actuator_forcerange)


def test_a_table_says_what_a_value_says(shelved):
    part, own = made(shelved).part, fields(shelved)[0].name
    table = {"kind": shelved.kind(), "joint": part, "at": 2.0, **numbers(shelved)}
    assert from_table(table) == shelved(part, at=2.0)
    assert from_table({"kind": shelved.kind(), own: part}) == shelved(part)


@pytest.mark.parametrize(
    ("table", "error", "words"),
    [
        ({"kind": "slwo", "joint": "LF_yaw"}, UnknownName, ["slwo", "Did you mean 'slow'", "lost_foot"]),
        ({"joint": "LF_yaw"}, InvalidDesign, ["needs a kind", "backlash"]),
        ({"kind": "slow", "speed": 1.0}, InvalidDesign, ["slow", "needs a joint"]),
        ({"kind": "slow", "joint": "LF_yaw", "sped": 1.0}, UnknownName, ["sped", "Did you mean 'speed'"]),
        ({"kind": "slow", "joint": "LF_yaw", "speed": "fast"}, InvalidDesign, ["'fast'", "a number is needed"]),
        ({"kind": "slow", "joint": "LF_yaw", "at": True}, InvalidDesign, ["True", "a number is needed"]),
        ({"kind": "limp", "joint": 3}, InvalidDesign, ["joint", "a text is needed"]),
        ({"kind": "limp", "joint": "LF_yaw", "x" * 9000: 1}, UnknownName, ["xxx"]),
        ({"kind": "y" * 9000, "joint": "LF_yaw"}, UnknownName, ["yyy"]),
        ({"kind": "lost_foot", "joint": "z" * 9000, "at": "w" * 9000}, InvalidDesign, ["www"]),
    ],
)
def test_a_table_that_says_no_fault_is_refused_in_one_short_sentence(table, error, words):
    with pytest.raises(error) as caught:
        from_table(table)
    text = str(caught.value)
    assert all(word in text for word in words)
    assert "\n" not in text
    assert len(text) < 400


@pytest.mark.parametrize(
    ("fault", "error", "words"),
    [
        (Slow("LF_yaw", 0.0), InvalidDesign, ["turns at 0 rad/s", "0.001 to 7.873 rad/s"]),
        (Slow("LF_yaw", 7.9), InvalidDesign, ["7.9 rad/s", "0.001 to 7.873"]),
        (Slow("LF_yaw", float("nan")), InvalidDesign, ["nan"]),
        (Slow("LF"), UnknownName, ["joint", "'LF'", "LF_yaw"]),
        (Backlash("LF_yaw", -0.1), InvalidDesign, ["gap of -0.1 rad", "0 to 1 rad"]),
        (Backlash("LF_yaw", 1.5), InvalidDesign, ["1.5"]),
        (Offset("LF_yaw", 4.0), InvalidDesign, ["off by 4 rad", "-3.14159 to 3.14159"]),
        (Offset("LF_yaw", float("inf")), InvalidDesign, ["inf"]),
        (FAULTS["lost_foot"]("L"), UnknownName, ["limb", "LF, RF, LH, RH"]),
        ("limp", InvalidDesign, ["'limp' is no fault"]),
        (Locked("LF_yaw", 0.0, 10**400), InvalidDesign, ["kind locked has angle", "a smaller number is needed"]),
        (Limp("LF_yaw", -(10**5000)), InvalidDesign, ["kind limp has at", "a smaller number is needed"]),
        (Limp("LF_yaw", None), InvalidDesign, ["at is None; a number is needed"]),
        (Limp(["LF_yaw"]), InvalidDesign, ["joint is ['LF_yaw']; a text is needed"]),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(fault, error, words):
    with pytest.raises(error) as caught:
        check_faults([fault], CAIMAN, 3.0)
    text = str(caught.value)
    assert all(word in text for word in words), text
    assert "\n" not in text


def test_numbers_at_the_ends_of_their_ranges_are_allowed():
    ends = [Slow("LF_yaw", 7.873), Slow("RF_yaw", 1e-3), Backlash("LH_yaw", 1.0), Backlash("RH_yaw", 0.0)]
    check_faults([*ends, Offset("LF_knee", np.pi), Offset("RF_knee", -np.pi)], CAIMAN, 3.0)


def test_several_faults_on_one_leg_add_up():
    faults = (Offset("LF_yaw", 0.2), FAULTS["lost_foot"]("LF"), Slow("LF_knee", 0.5), Locked("LF_pitch", angle=0.3))
    record, intact = walk(*faults, duration=0.5), walk(duration=0.5)
    off = record.servo_target - intact.servo_target
    np.testing.assert_allclose(off.sel(servo="LF_yaw"), 0.2, atol=1e-12)
    assert np.all(off.drop_sel(servo=["LF_yaw", "LF_pitch"]) == 0.0)
    assert np.all(record.servo_target.sel(servo="LF_pitch") == 0.3)
    assert np.all(record.foot_force.sel(leg="LF").isel(time=slice(1, None)) == 0.0)


@dataclass(frozen=True, slots=True)
class Own(Fault):
    """A fault that is on no shelf: two servos of a leg share a wire."""

    leg: str
    at: float = 0.0
    acts_on = "limb"

    @property
    def part(self):
        return self.leg

    @classmethod
    def parts(cls, robot):
        return ("LF", "RF")

    def apply(self, plant):
        for joint in ("yaw", "knee"):
            plant.unpower(f"{self.leg}_{joint}")
            plant.parameter("dof_damping", f"{self.leg}_{joint}")[:] *= 2.0

    def command(self, plant):
        plant.memory["heard"] = plant.memory.get("heard", 0.0) + 1.0
        assert plant.time == pytest.approx(0.01 * (plant.memory["heard"] - 1))
        assert set(plant.targets) == set(servo_names())
        assert len(plant.targets) == len(servo_names())


def test_a_fault_of_nobody_s_shelf_works():
    record = walk(Own("RF", at=0.2), duration=0.5)
    torque = record.servo_torque.sel(time=slice(0.211, None))
    assert np.all(torque.sel(servo=["RF_yaw", "RF_knee"]) == 0.0)
    assert np.all(torque.sel(servo="RF_pitch") != 0.0)
    with pytest.raises(UnknownName, match="no limb named 'LH'"):
        walk(Own("LH"))


def test_two_faults_of_one_part_are_refused_whatever_they_are():
    with pytest.raises(SuchusError, match="contradict"):
        walk(Limp("LF_yaw"), Slow("LF_yaw"))
