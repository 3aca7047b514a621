"""Faults that recover, come and go, and repeat by their seed: in runs, live walks, files and the emulator."""

from dataclasses import dataclass, replace
from itertools import islice, takewhile
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, SuchusError, UnknownName
from suchus.hardware.emulator import EmulatedBody
from suchus.robot.control import LAWS, Command, Coordinated
from suchus.robot.design import servo_names
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import FAULTS, Deaf, Delayed, Frozen, Limp, Locked, Weak, from_table, from_text
from suchus.sim.land import Live, Run, simulate
from suchus.sim.land.stepper import _change_ticks
from suchus.sim.persistence import PERMANENT, Persistence

CAIMAN = ROBOTS["caiman"]
GAIT = replace(GAITS["belly_crawl"], period=1.0)
OPEN = Coordinated(limbs=LAWS["off"], spine=None, tail=None)
STEP = 0.005
PITCH = servo_names().index("LF_pitch")


def walk(*faults, duration=0.6, control=OPEN):
    return simulate([Run(robot=CAIMAN, gait=GAIT, control=control, faults=faults)], duration=duration, timestep=STEP)


def torque(record, name="LF_pitch"):
    """Return the torque of a servo at each sample; the first one is that of its instant."""
    return record.servo_torque.isel(run=0).sel(servo=name).values


@pytest.mark.parametrize(
    ("persistence", "kind", "presence"),
    [
        (PERMANENT, "permanent", 1.0),
        (Persistence(duration=2.0), "transient", 1.0),
        (Persistence(rate=2.0, length=0.5), "intermittent", 0.5),
        (Persistence(duration=9.0, rate=1.0, length=0.25), "intermittent", 0.2),
    ],
)
def test_kinds_and_presence(persistence, kind, presence):
    assert persistence.kind == kind
    assert persistence.presence == pytest.approx(presence)


def test_spells_have_the_mean_length_and_rate_that_are_asked_for():
    persistence = Persistence(rate=2.0, length=0.3, seed=5)
    spells = np.array(list(islice(persistence.spells("LF_yaw"), 4000)))
    assert spells[0, 0] == 0.0
    lengths, gaps = spells[:, 1] - spells[:, 0], spells[1:, 0] - spells[:-1, 1]
    assert abs(lengths.mean() - 0.3) < 3 * 0.3 / np.sqrt(4000)
    assert abs(gaps.mean() - 0.5) < 3 * 0.5 / np.sqrt(4000)
    assert lengths.std() == pytest.approx(0.3, rel=0.1)  # exponential: the deviation is the mean
    assert lengths.sum() / spells[-1, 1] == pytest.approx(persistence.presence, rel=0.06)


def test_spells_repeat_and_those_of_two_parts_and_two_seeds_are_independent():
    persistence = Persistence(rate=2.0, length=0.3, seed=5)
    first, again, other_part, other_seed = (
        list(islice(process.spells(part), 50))
        for process, part in (
            (persistence, "LF_yaw"), (persistence, "LF_yaw"), (persistence, "RF_yaw"),
            (replace(persistence, seed=6), "LF_yaw"),
        )
    )  # fmt: skip
    assert first == again
    for other in (other_part, other_seed):
        correlation = np.corrcoef([b - a for a, b in first], [b - a for a, b in other])[0, 1]
        assert abs(correlation) < 0.4


@settings(max_examples=40, deadline=None)
@given(
    onset=st.floats(0.0, 2.0),
    rate=st.floats(0.5, 60.0),
    length=st.floats(0.002, 0.5),
    duration=st.one_of(st.just(inf), st.floats(0.01, 3.0)),
    seed=st.integers(0, 1000),
)
def test_a_control_period_is_in_a_spell_where_it_begins_within_one(onset, rate, length, duration, seed):
    persistence, period, count = Persistence(duration=duration, rate=rate, length=length, seed=seed), 0.01, 300
    present = np.zeros(count, dtype=bool)
    previous_end = -1
    for begin, end in takewhile(lambda spell: spell[0] < count, persistence.spell_ticks("LF", onset, period)):
        assert end is not None
        assert previous_end < begin < end  # none is empty, and they do not touch
        present[begin:end], previous_end = True, end
    times = period * np.arange(count)
    expected = np.zeros(count, dtype=bool)
    for start, stop in takewhile(lambda spell: onset + spell[0] < times[-1], persistence.spells("LF")):
        expected |= (times >= onset + start) & (times < onset + stop)
    near = np.zeros(count, dtype=bool)  # an end within the rounding of a time
    for start, stop in takewhile(lambda spell: onset + spell[0] < times[-1] + 1.0, persistence.spells("LF")):
        near |= (np.abs(times - onset - start) < 1e-7) | (np.abs(times - onset - stop) < 1e-7)
    assert np.array_equal(present[~near], expected[~near])


def test_a_servo_is_limp_during_its_fault_and_has_its_torque_afterwards():
    intact, broken = walk(), walk(Limp("LF_pitch", at=0.2, persistence=Persistence(duration=0.1)))
    assert broken.isel(time=slice(0, 21)).equals(intact.isel(time=slice(0, 21)))
    assert np.all(torque(broken)[21:31] == 0.0)
    assert np.all(torque(broken)[31:] != 0.0)


def test_two_spells_are_two_faults_and_a_locked_joint_holds_where_each_spell_found_it():
    persistence = Persistence(rate=10.0, length=0.08, seed=4)
    spells = list(takewhile(lambda spell: spell[0] < 60, persistence.spell_ticks("LF_pitch", 0.1, 0.01)))
    assert len(spells) >= 2
    record = walk(Locked("LF_pitch", at=0.1, persistence=persistence)).isel(run=0).sel(servo="LF_pitch")
    target, angle, intact = record.servo_target.values, record.servo_angle.values, walk().isel(run=0)
    commanded = intact.servo_target.sel(servo="LF_pitch").values
    is_present = np.zeros(len(target), dtype=bool)
    for begin, end in spells:
        is_present[begin:end] = True
        held = target[begin : min(end, len(target))]
        assert np.all(held == held[0])
        assert held[0] == pytest.approx(angle[begin], abs=1e-12)
    np.testing.assert_array_equal(target[~is_present], commanded[~is_present])
    assert np.all(target[is_present] != commanded[is_present])


def test_a_live_walk_recovers_and_relapses_as_a_planned_one():
    fault = Limp("LF_pitch", at=0.2, persistence=Persistence(rate=20.0, length=0.05, seed=1))
    live = Live(Run(robot=CAIMAN, gait=GAIT, control=OPEN), timestep=STEP)
    planned = Live(Run(robot=CAIMAN, gait=GAIT, control=OPEN, faults=(fault,)), timestep=STEP)
    seen = set()
    for tick in range(60):
        if tick == 20:
            live.begin(fault)
        live.step()
        planned.step()
        if tick < 20:
            continue
        assert live.broken == planned.broken
        seen.add(bool(live.broken))
        np.testing.assert_array_equal(live.current_sample["joint_angle"], planned.current_sample["joint_angle"])
    assert seen == {False, True}
    live.mend("LF_pitch")
    for _ in range(40):
        live.step()
        assert live.broken == ()  # its spells to come are gone, too


def test_late_commands_are_those_of_some_control_periods_ago():
    delay, onset = 4, 20
    fault = Delayed("LF_pitch", delay=0.04, at=0.2, persistence=Persistence(duration=0.2))
    commanded = walk().servo_target.isel(run=0).sel(servo="LF_pitch").values
    late = walk(fault).servo_target.isel(run=0).sel(servo="LF_pitch").values
    expected = commanded.copy()
    for tick in range(onset, 40):
        expected[tick] = commanded[max(tick - delay, onset)]
    np.testing.assert_array_equal(late, expected)


@dataclass(frozen=True)
class Listening:
    """Hold still, and note the positions and pressures that are sensed."""

    heard: tuple[list, ...]
    feels = True

    @staticmethod
    def start(runs, period):
        table = OPEN.start(runs._replace(controls=(OPEN,) * len(runs.robots)), period)
        heard = runs.controls[0].heard[0]

        class Machine:
            def rest(self):
                return table.rest()

            def command(self, tick, sensed):
                heard.append((sensed.servo_position[0].copy(), sensed.foot_pressure[0].copy()))
                return Command(*table.command(tick, sensed))

        return Machine()

    def __hash__(self):
        return 0


@pytest.mark.parametrize("kind", [Deaf, Frozen])
def test_a_dropout_of_one_reading_leaves_the_others_alone(kind):
    heard: list = []
    fault = kind("servo_position.LF_pitch", at=0.2, persistence=Persistence(duration=0.1))
    record = walk(fault, control=Listening((heard,)), duration=0.5).isel(run=0)
    positions, angles = np.array([row[0] for row in heard]), record.servo_angle.values
    dropout = slice(20, 30)
    expected = angles.copy()
    expected[dropout, PITCH] = 0.0 if kind is Deaf else angles[20, PITCH]
    np.testing.assert_array_equal(positions, expected)
    assert np.ptp(angles[dropout, PITCH]) > 1e-4


def test_a_dropout_of_a_group_repeats_all_of_it():
    heard: list = []
    fault = Frozen("foot_pressure", at=0.2, persistence=Persistence(duration=0.1))
    walk(fault, control=Listening((heard,)), duration=0.4)
    pressures = np.array([row[1] for row in heard])
    assert np.all(pressures[20:30] == pressures[20])
    assert np.any(pressures[30:] != pressures[20])


def test_an_emulated_servo_recovers_only_where_its_torque_is_on():
    fault = Limp("LF_pitch", at=0.1, persistence=Persistence(duration=0.1))
    body = EmulatedBody(CAIMAN, GAITS["belly_crawl"], faults=[fault], timestep=STEP)
    powers = {15: 0.0, 25: 1.0}  # switched off within the fault, and on after its end
    present = []
    for tick in range(30):
        if tick in powers:
            body.power(PITCH, powers[tick])
        body.step()
        present.append(bool(body._loop.disturbances.injector.broken(0)))
    assert present == [False] * 10 + [True] * 15 + [False] * 5
    body.power(PITCH, 0.5)
    assert body._loop.disturbances.injector.broken(0) == (Weak("LF_pitch", 0.5),)


def test_a_coupled_run_stops_its_intervals_where_a_spell_begins_or_ends():
    fault = Limp("LF_yaw", at=0.2, persistence=Persistence(duration=0.1))
    assert _change_ticks(fault, 0.01, 100) == [20, 30]
    assert _change_ticks(fault, 0.01, 25) == [20]
    assert _change_ticks(Limp("LF_yaw", at=0.2), 0.01, 100) == [20]


def test_files_and_command_lines_say_the_same():
    table = {"kind": "weak", "joint": "LF_yaw", "fraction": 0.2, "at": 4, "rate": 2.0, "length": 0.1, "seed": 3}
    fault = Weak("LF_yaw", 0.2, 4.0, Persistence(rate=2.0, length=0.1, seed=3))
    assert from_table(table) == fault
    assert from_text("weak:LF_yaw,fraction=0.2,at=4,rate=2,length=0.1,seed=3") == fault
    assert from_text("limp:LF_yaw", at=2.0) == Limp("LF_yaw", at=2.0)
    assert from_text("deaf:servo_position.LF_yaw, duration=0.5") == Deaf(
        "servo_position.LF_yaw", persistence=Persistence(duration=0.5)
    )


def test_a_fault_is_shown_as_it_is_written():
    assert repr(Limp("LF_yaw", at=1.0)) == "Limp(joint='LF_yaw', at=1.0)"
    shown = repr(Limp("LF_yaw", persistence=Persistence(duration=0.5)))
    assert eval(shown, {**FAULTS, "Limp": Limp, "Persistence": Persistence, "inf": inf}) == Limp(
        "LF_yaw", persistence=Persistence(duration=0.5)
    )


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: Persistence(duration=0.0), InvalidDesign, ["duration", "0"]),
        (lambda: Persistence(rate=2.0), InvalidDesign, ["rate is 2.0", "length 0.0"]),
        (lambda: Persistence(length=2.0), InvalidDesign, ["both above 0"]),
        (lambda: Persistence(rate=-1.0, length=1.0), InvalidDesign, ["rate"]),
        (lambda: Persistence(seed=-1), InvalidDesign, ["seed"]),
        (lambda: from_table({"kind": "limp", "joint": "LF_yaw", "seed": 1.5}), InvalidDesign, ["whole number"]),
        (lambda: from_table({"kind": "limp", "joint": "LF_yaw", "rate": "x"}), InvalidDesign, ["a number"]),
        (lambda: from_table({"kind": "limp", "joint": "LF_yaw", "often": 1.0}), UnknownName, ["often"]),
        (lambda: from_text("limp"), InvalidDesign, ["names no part"]),
        (lambda: from_text("limp:LF_yaw,at"), InvalidDesign, ["at=4.0"]),
        (lambda: from_text("floppy:LF_yaw"), UnknownName, ["floppy"]),
        (lambda: walk(Deaf("servo_position.nose")), UnknownName, ["reading of servo_position", "nose"]),
        (lambda: walk(Deaf("orientation.w")), UnknownName, ["orientation"]),
        (lambda: walk(Delayed("LF_yaw", delay=11.0)), InvalidDesign, ["late by 11 s"]),
        (lambda: walk(Limp("LF_yaw", persistence=2.0)), InvalidDesign, ["persistence is 2.0"]),
    ],
)
def test_what_cannot_be_is_refused(make, error, words):
    with pytest.raises(error) as caught:
        make()
    assert isinstance(caught.value, SuchusError)
    assert all(word in str(caught.value) for word in words), str(caught.value)
