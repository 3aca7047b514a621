"""The ladder of models: when a rung is settled, what its numbers are, and that a mirrored swim has the same."""

import json
from dataclasses import replace
from math import isnan

import numpy as np
import pytest
import xarray as xr

from suchus.article.verdict import judge
from suchus.core.errors import IncompatibleRecord, InvalidDesign, OutsideLimits, UnreadableFile, Unwritable
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swimming import ladder
from suchus.experiments.catalog.swimming.ladder import (
    MIN_SETTLED_CYCLES,
    MOTIONS,
    SettledNumber,
    kept_grids,
    measures,
    motions,
    run_ladder,
    settle,
)
from suchus.experiments.catalog.swimming.rules import LADDER, MAX_SETTLED_SPREAD, RULES
from suchus.robot.robots import ROBOTS
from suchus.swimming.water.field_samples import COURSE, TICKS

CYCLES = 10
PHASE = np.arange(TICKS * CYCLES + 1) / TICKS
SWIMMING = EXPERIMENTS["swimming"]


def quarters(drift=0.0):
    """Return what is read at the quarters of every cycle, thrust, aside and difference, which drift apart or not."""
    cycle = np.arange(CYCLES)[:, None] * drift
    return {
        "ladder_thrust": np.array([3.0, -1.0, 3.0, -1.0]) + cycle * (1, 0, -1, 0),
        "ladder_aside": np.array([4.0, 1.0, -4.0, -1.0]) + cycle * (1, 0, 1, 0),
        "ladder_difference": np.array([100.0, -200.0, 100.0, -200.0]) + 40.0 * cycle * (1, 0, -1, 0),
    }


def rung(*, speeds=(0.2, 0.25, 0.03), sway=0.02, drift=0.0, side=1.0, grids=None):
    """Return the record of one rung of a body 1 m long; with ``side`` -1 that of its mirror image."""
    s = np.linspace(0.0, 1.0, COURSE)
    course = (0.02 * s + 0.08 * s**2) * np.cos(2 * np.pi * (PHASE[:, None] - 1.1 * s))
    given = {name: np.array(one) for name, one in quarters(drift).items()}
    if side < 0.0:  # what it did at T/4 the other does at 3T/4, to the other side
        given = {name: np.roll(one, 2, axis=1) for name, one in given.items()}
        given["ladder_aside"] = -given["ladder_aside"]
    data = {
        "ladder_speed": np.tile(np.array(speeds)[:, None], CYCLES) * (1.0 + 0.001 * np.arange(CYCLES)),
        "ladder_centre": side * (sway * np.sin(2 * np.pi * PHASE) + 0.05 * PHASE),
        "ladder_course": side * course,
        **given,
    }
    record = xr.Dataset({name: (("rung", *ladder._SHAPES[name][0]), one[None]) for name, one in data.items()})
    record["taken_away"] = "ladder_motion", [0.5, 0.7, 0.1]
    record.attrs |= {"unable": "{}", "grids": json.dumps(grids or {})}
    return record.assign_coords(rung=["space"], ladder_motion=list(MOTIONS))


def numbers(record):
    return {name: one.value for name, one in measures(record, 1.0)}


def test_a_rung_is_settled_over_the_most_cycles_whose_halves_agree():
    values = np.array([9.0, 9.0, 9.0, *[1.0] * 7])

    def half(first, last):
        return [float(values[first:last].mean())]

    assert settle(half, 10) == SettledNumber(1.0, 1.0, 1.0, 0.0)  # the last six; the last eight hold a 9
    values[-1] = 1.0 + 3.5 * MAX_SETTLED_SPREAD
    assert settle(half, 10).relative_spread > MAX_SETTLED_SPREAD
    assert settle(half, 10, scale=2.0).relative_spread < MAX_SETTLED_SPREAD  # of what is twice as large
    assert isnan(settle(half, MIN_SETTLED_CYCLES).relative_spread)  # the first cycle does not count


def test_a_number_is_not_of_cycles_before_all_swims_are_settled():
    values = np.array([9.0, 1.05, 1.05, *[1.0] * 8])
    number = settle(lambda first, last: [float(values[first:last].mean())], 11, min_start=3)
    assert number == SettledNumber(1.0, 1.0, 1.0, 0.0)  # the halves of the last ten agree too, with another mean


@pytest.mark.parametrize(("late_cycles", "min_start"), [(0, 1), (2, 2)])
def test_a_gain_counts_from_where_both_swims_are_settled_and_never_from_the_first_cycle(
    late_cycles, min_start, monkeypatch
):
    starts = []

    def settle_and_note(half, cycles, scale=1.0, min_start=1):
        starts.append(min_start)
        return settle(half, cycles, scale, min_start)

    monkeypatch.setattr(ladder, "settle", settle_and_note)
    record = rung()
    scatter = 1.0 + 0.001 * np.array([0.0, 3.0, 1.0, 4.0, 1.5, 0.5, 2.0, 2.5, 3.5, 0.7])
    record.ladder_speed[:] = record.ladder_speed.values[..., :1] * scatter
    record.ladder_speed[{"ladder_motion": 0, "ladder_cycle": slice(0, late_cycles)}] *= 0.8
    numbers(record)
    assert starts[:2] == [min_start] * 2


def test_both_starting_sides_count():
    found = settle(lambda a, b: [1.0, 1.0 + 1.1 * MAX_SETTLED_SPREAD], CYCLES)
    assert (found.low, found.high) == (1.0, 1.0 + 1.1 * MAX_SETTLED_SPREAD)
    assert found.relative_spread > MAX_SETTLED_SPREAD


@pytest.mark.parametrize("drift", [0.0, 0.03])
def test_a_mirrored_swim_has_the_same_table_to_the_last_bit(drift):
    ours, mirrored = numbers(rung(drift=drift)), numbers(rung(drift=drift, side=-1.0))
    assert ours == mirrored
    assert not any(map(isnan, ours.values()))


def test_what_tail_and_spine_give_is_what_is_missing_without_them():
    found = numbers(rung())
    assert found["gain_tail_share_space"] == pytest.approx(1.0 - 0.03 / 0.2)
    assert found["gain_spine_share_space"] == pytest.approx(-0.25)
    backward = numbers(rung(speeds=(-0.2, -0.1, 0.0)))  # the spine makes it swim backward faster
    assert backward["gain_spine_share_space"] == pytest.approx(-0.5)
    assert isnan(numbers(rung(speeds=(0.0, 0.1, 0.1)))["gain_spine_share_space"])


def test_a_track_and_a_wave_are_read_from_the_course():
    found = numbers(rung())
    assert found["track_sway_space"] == pytest.approx(0.02, rel=1e-3)
    assert found["track_noise_space"] < 1e-6
    assert found["wave_waves_per_body_space"] == pytest.approx(1.1, rel=1e-3)
    assert found["wave_share_space"] == pytest.approx(1.0, abs=1e-3)
    assert found["wave_envelope_tip_space"] == pytest.approx(0.1, rel=1e-3)
    assert found["wave_envelope_middle_space"] == pytest.approx(0.03, rel=1e-2)
    assert found["tail_sine_share_space"] == pytest.approx(1.0)


def test_pressures_and_forces_are_read_at_the_quarters():
    found = numbers(rung())
    assert found["pressure_convex_share_space"] == pytest.approx(100.0 / 150.0)
    assert found["pressure_fall_share_space"] == 0.0
    assert found["force_angle_1_quarter_space"] == pytest.approx(np.arctan2(4.0, 3.0))
    assert found["thrust_asymmetry_space"] == 0.0
    assert found["thrust_3_quarter_share_space"] == pytest.approx(3.0 / (0.5 * (5.0 + 2.0**0.5)))


def test_a_start_that_is_not_forgotten_is_no_fall_and_not_settled():
    found = numbers(rung(drift=0.5))
    assert found["pressure_fall_share_space"] == pytest.approx(0.0, abs=1e-12)
    assert found["pressure_fall_share_space_high"] > 0.1
    assert found["pressure_fall_share_space_apart"] > MAX_SETTLED_SPREAD


def test_the_grids_of_a_kept_study_widen_three_dimensions():
    study = {"cells": [68, 80], "measures": {"gain_tail_share": [0.4, 0.86]}}
    found = numbers(rung(grids=study))
    assert (found["gain_tail_share_space_low"], found["gain_tail_share_space_high"]) == (0.4, 0.86)
    assert found["space_grids"] == 2.0
    assert numbers(rung())["space_grids"] == 1.0


def test_the_study_of_grids_that_ships_is_of_todays_rules_body_and_water():
    study = kept_grids(SWIMMING.ladder_setting())
    assert study["cells"] == [68, 80, 96]
    assert {rule.measure for rule in RULES} <= set(study["measures"])
    assert kept_grids(replace(SWIMMING, reynolds=6000.0).ladder_setting()) == {}
    assert kept_grids(replace(SWIMMING, space_cells=80).ladder_setting()) == study


def test_a_study_older_than_the_rules_is_refused_with_what_renews_it(monkeypatch):
    monkeypatch.setattr(ladder, "RULES", (replace(RULES[0], settled=0.2), *RULES[1:]))
    with pytest.raises(IncompatibleRecord, match=r"older than the rules.*python tools/ladder_grids.py FOLDER"):
        kept_grids(SWIMMING.ladder_setting())


@pytest.fixture
def no_flow(monkeypatch):
    """Let no flow be computed: every rung that needs one says so."""

    def refused(*given, **named):
        raise InvalidDesign("the grid is too coarse.")

    monkeypatch.setattr(ladder, "resolved_swim", refused)


def slices(cycles):
    """Return free swims and a held one as a slice gives them."""
    ticks, quarter = TICKS * cycles + 1, ("settled", "instant")
    free = xr.Dataset(
        {
            "speed": ("cycle", np.full(cycles, 0.2)),
            "course_centre": ("tick", np.zeros(ticks)),
            "course": (("tick", "place"), np.zeros((ticks, COURSE))),
        }
    )
    held = xr.Dataset({f"quarter_{name}": (quarter, np.ones((cycles - 1, 4))) for name in ladder._QUARTERS})
    return dict.fromkeys(MOTIONS, free) | {"held": held}


def test_a_rung_that_cannot_run_says_so_and_the_others_speak(no_flow):
    record = run_ladder(
        replace(SWIMMING.quick(), cycles=4).ladder_setting(), lambda stage, share: None, slices=lambda _: slices(4)
    )
    unable = json.loads(record.attrs["unable"])
    assert set(unable) == {"slice_taken", "space"}
    assert unable["space"] == "Not run: the grid is too coarse."
    found = numbers(record)
    assert set(record.rung.values) == set(LADDER)
    assert isnan(found["gain_tail_share_space"])
    # by drag alone the tail alone stands still
    assert found["gain_spine_share_resistive"] == pytest.approx(1.0, abs=0.01)
    assert found["gain_spine_share_reactive"] == pytest.approx(-0.36, abs=0.02)
    assert found["speed_tail_only_sections"] != 0.0
    assert 0.0 < found["wave_envelope_tip_sections"] < 0.3
    verdict = judge(RULES[-1], found, unable=unable)
    assert [voice.why for voice in verdict.voices if voice.rung.name == "space"] == [unable["space"]]


@pytest.mark.parametrize("error", [Unwritable("no space left."), UnreadableFile("a bit is flipped.")])
def test_a_rung_whose_kept_swims_are_lost_is_no_rung_that_cannot_run(error):
    def lost():
        raise error

    unable = {}
    with pytest.raises(type(error), match=str(error)):
        ladder._attempt("space", unable, lost)
    assert not unable


def test_a_body_that_does_not_float_leaves_theories_and_the_slice(no_flow, monkeypatch):
    def sinks(*given):
        raise InvalidDesign("nothing lets it float.")

    monkeypatch.setattr(ladder, "swum_in_sections", sinks)
    climb = replace(SWIMMING.quick(), robot=ROBOTS["swimmer"]).ladder_setting()
    record = run_ladder(climb, lambda stage, share: None, slices=lambda _: slices(2))
    unable = json.loads(record.attrs["unable"])
    assert set(unable) == {"sections", "slice_taken", "space"}
    assert unable["slice_taken"] == unable["sections"]
    assert np.isfinite(numbers(record)["gain_tail_share_reactive"])
    text = ladder.table(numbers(record), unable)
    assert "Not run: nothing lets it float." in text
    assert all(rule.claim in text for rule in RULES)


def test_every_rung_is_asked_the_same_motions():
    gait = SWIMMING.ladder_setting().wave_fit.gait
    whole, tail, trunk = motions(gait).values()
    assert (whole, tail, trunk) == (gait, gait.straightened("trunk"), gait.straightened("tail"))


@pytest.fixture
def swum(monkeypatch):
    """Let theories swim alone, and note by the axes of the grid which swims are asked for."""
    asked, one = [], slices(8)
    names = {motion: name for name, motion in motions(SWIMMING.quick().ladder_setting().wave_fit.gait).items()}

    def noted(robot, motion, setting, **named):
        asked.append((setting.axes, "held" if setting.tethered else names[motion]))
        return one[asked[-1][1]]

    def sinks(*given):
        raise InvalidDesign("nothing lets it float.")

    monkeypatch.setattr(ladder, "resolved_swim", noted)
    monkeypatch.setattr(ladder, "swum_in_sections", sinks)
    return asked


def swum_of(**given):
    return run_ladder(replace(SWIMMING.quick(), cycles=8).ladder_setting(), lambda stage, share: None, **given)


def test_nothing_swims_for_a_claim_on_which_the_rungs_before_disagree(swum):
    whole = numbers(swum_of())
    assert swum == [(axes, name) for axes in (2, 3) for name in ladder.SWIMS]
    swum.clear()
    found = numbers(swum_of(claims=[rule.claim for rule in RULES]))
    # drag and momentum disagree on the tail, so that nobody asks what the trunk alone does; of the spine they do not
    assert swum == [(axes, name) for axes in (2, 3) for name in ("trunk and tail", "tail only", "held")]
    assert isnan(found["gain_tail_share_slice"])
    assert not isnan(whole["gain_tail_share_slice"])
    assert found["gain_spine_share_slice"] == whole["gain_spine_share_slice"]
    for rule in RULES:
        assert judge(rule, found).verdict == judge(rule, whole).verdict


def test_a_slice_that_is_swum_elsewhere_is_asked_for_what_the_claims_need(swum):
    asked = []

    def swim_slices(names):
        asked.append({*names})
        return slices(8)

    swum_of(slices=swim_slices)
    swum_of(slices=swim_slices, claims=[rule.claim for rule in RULES])
    assert asked == [{*ladder.SWIMS}, {"trunk and tail", "tail only", "held"}]
    assert (2, "held") not in swum


def test_only_what_the_claims_are_read_of_swims(swum):
    swum_of(claims=["swim_pressure_falls"])
    assert {name for _, name in swum} == {"held"}
    swum.clear()
    swum_of(claims=["swim_s_shape", "swim_tail_sine"])
    assert {name for _, name in swum} == {"trunk and tail"}
    read = {name for rule in RULES for name in (rule.measure, *(one.measure for one in rule.holds))}
    assert all(sum(name.startswith(start) for start in ladder._SWIMS_OF_MEASURE) == 1 for name in read)


def test_a_motion_that_the_servos_cannot_follow_is_no_swim_for_theories_to_judge(swum):
    with pytest.raises(OutsideLimits, match="tail_cable"):
        replace(SWIMMING.quick(), frequency=3.0).simulate_measures(RULES[-1].needs)
    assert swum == []
