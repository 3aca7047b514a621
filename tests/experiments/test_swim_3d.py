"""The robot's body in three dimensions: its geometry, its swim, and what the measures mean."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus import flow
from suchus.apps.cli import main
from suchus.core import large
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.progress import silent
from suchus.core.water_table import column
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog._taken import TAKEN, TakenMidline
from suchus.experiments.catalog.swim_3d.experiment import AS_COMMANDED, with_midlines
from suchus.experiments.catalog.swim_3d.figure import draw_tails
from suchus.robot.design import layout, with_values
from suchus.robot.design.pieces import pieces
from suchus.robot.robots import ROBOTS
from suchus.sim.land.afloat import floats
from suchus.swimming.coupling.on_joints import floating
from suchus.swimming.water import Outline, displaced_mass, fit, printed_wave, undulation
from suchus.swimming.water.immersed import folded_limbs, half_heights, trunk
from suchus.swimming.water.resolved import SwimSetting, check_resolved_swim, resolved_swim
from suchus.visual.figures import caption

ROBOT, ASKED = ROBOTS["caiman"], EXPERIMENTS["swim_3d"]
MOTION = fit(ROBOT, printed_wave(ROBOT, "I", sign=-1)).gait


def test_the_trunk_is_the_robots_own_body_divided_at_its_joints():
    outline = Outline(ROBOT, 129)
    body = trunk(outline, MOTION)
    assert 1000.0 * body.volume(0.3) == pytest.approx(displaced_mass(outline), rel=1e-3)
    assert body.bounds(0.0, flow.Pose())[5] == pytest.approx(float(outline.silhouette.half_height.max()))
    places = np.sort(outline.joint_positions)
    assert body.cuts == pytest.approx(places)
    assert body.parts == places.size + 1


def test_a_raised_tail_is_as_high_as_asked_and_nowhere_lower_than_the_robot():
    outline = Outline(ROBOT, 257)
    own, raised = outline.silhouette.half_height, half_heights(outline, 0.1)
    share = outline.s / ROBOT.length
    assert (half_heights(outline) == own).all()
    assert (raised >= own).all()
    assert (raised[share < 0.66] == own[share < 0.66]).all()
    middle = (share > 0.72) & (share < 0.95)
    assert raised[middle] == pytest.approx(0.05)
    assert raised[-1] == own[-1]
    assert trunk(outline, MOTION, tail_height=0.1).volume(0.0) > trunk(outline, MOTION).volume(0.0)


def test_folded_limbs_are_the_robots_links_and_feet_beside_the_body_at_their_hips():
    limbs, place = folded_limbs(ROBOT), layout(ROBOT)
    outline = Outline(ROBOT, 129)
    bare, body = trunk(outline, MOTION), trunk(outline, MOTION, limbs=True)
    assert len(limbs) == sum(len(limb.girdle.limb.links) + 1 for limb in place.limbs)
    lengths = sorted(float(np.hypot(*np.subtract(one.end, one.start))) for one in limbs if one.start != one.end)
    links = [link.length for limb in place.limbs for link in limb.girdle.limb.links]
    assert lengths == pytest.approx(sorted(links))
    assert sorted({one.arc_position for one in limbs}) == pytest.approx(
        [0.1625, 0.505]
    )  # as far behind the snout as the hips
    table = pieces(ROBOT)
    axis = {body.name for body in place.bodies} - {segment.name for segment in place.robot.axis}
    there = [place.bodies[int(row)].name in axis for row in table[:, 0]]
    volume = float(column(table, "volume")[there].sum())
    extra = body.mass(0.0).volume - bare.mass(0.0).volume
    hips = sum(2 / 3 * np.pi * limb.girdle.limb.links[0].radius ** 3 for limb in place.limbs)  # round ends, not there
    assert extra == pytest.approx(volume + hips, rel=0.01)
    assert sum(lump.volume * lump.centre[1] for lump in body.lumps) == pytest.approx(0.0, abs=1e-12)
    assert body.bounds(0.0, flow.Pose())[4:] == bare.bounds(0.0, flow.Pose())[4:]  # no limb is as high as the body


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"reading": "Z"}, "reading is 'Z'"),
        ({"jobs": 0}, "jobs is 0"),
        ({"frames": 0}, "frames is 0"),
        ({"cells": (96, 64)}, "increasing numbers"),
        ({"cells": ()}, "at least one"),
        ({"cycles": 1}, "cycles is 1"),
        ({"reynolds": 1e6}, r"reynolds is 1e\+06: real water.*leave it where its layer does"),
        ({"reynolds": 1.0}, "reynolds is 1; 10 to 20000"),
        ({"beside": -0.1}, "beside is"),
        ({"tail_heights": (0.1, 0.05)}, "increasing numbers"),
    ],
)
def test_impossible_settings_are_refused(fields, said):
    with pytest.raises(InvalidDesign, match=said):
        replace(ASKED, **fields)


REFUSED = {
    "--beside 0.0": ("the box leaves 0 body lengths of water beside the widest swing", "give at least 0.0"),
    "--cells 40 --reynolds 2e4": (
        "the boundary layer of",
        "cells per body length, ",
        "hours for 6 cycles, or a viscosity",
    ),
    "--reynolds 1e6": (
        "reynolds is 1e+06: real water",
        "where its layer does, and that is not built; at most 20000 is allowed",
    ),
    "--cells 32 --compared-cells 32 --reynolds 400": ("needs 3.41 cells across", "Take at least 54 cells, or a slice."),
    "--slice-cells 32 --reynolds 3000": ("the boundary layer of", "at least 39 cells per body length, or a viscosity"),
    "--cells 512": ("a grid of 768 x 384 x 128 cells takes some 3.", "GB of memory, and this machine has 1.5 GB"),
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_cannot_be_swum_is_one_sentence_before_anything_runs(words, capsys, tmp_path, monkeypatch):
    if "512" in words:
        monkeypatch.setattr(large, "memory", lambda: 1.5e9)
    assert (
        main(["run", "swim_3d", *words.split(), "--keep", str(tmp_path / "keep"), "--out", str(tmp_path / "out")]) == 2
    )
    out, err = capsys.readouterr()
    said = err.strip()
    assert not (tmp_path / "keep").exists()
    assert all(part in said for part in REFUSED[words][-2:]), said
    assert len(said) < 600
    assert "\n" not in said
    assert out == ""
    assert not (tmp_path / "out" / "swim_3d").exists()


def test_a_layer_says_the_cells_and_hours_that_it_takes():
    with pytest.raises(
        InvalidDesign, match=r"at least (\d+) cells per body length, ([\d.e+]+) million cells"
    ) as caught:
        resolved_swim(ROBOT, MOTION, SwimSetting(axes=3, cells=64, viscosity=1e-4 / 7, cycles=1))
    cells = int(re.search(r"least (\d+) cells", str(caught.value))[1])
    check_resolved_swim(ROBOT, MOTION, SwimSetting(axes=3, cells=cells, viscosity=1e-4 / 7, cycles=1))  # they do
    with pytest.raises(InvalidDesign, match="boundary layer"):
        check_resolved_swim(ROBOT, MOTION, SwimSetting(axes=3, cells=cells - 1, viscosity=1e-4 / 7, cycles=1))
    with pytest.raises(InvalidDesign, match="more than the 1024 that are allowed"):
        resolved_swim(ROBOT, MOTION, SwimSetting(axes=3, cells=64, viscosity=2e-7, cycles=1))


def test_the_narrowest_box_that_is_allowed_holds_the_body():
    setting = SwimSetting(axes=3, cells=56, viscosity=2e-3, cycles=1, beside=8 / 56 - 0.05)
    check_resolved_swim(ROBOT, MOTION, setting)
    resolved_swim(ROBOT, MOTION, setting, progress=silent)
    with pytest.raises(InvalidDesign, match="the body would leave it"):
        check_resolved_swim(ROBOT, MOTION, replace(setting, beside=setting.beside - 1e-3))


def test_a_motion_that_the_grid_or_the_joints_cannot_follow_is_refused():
    with pytest.raises(InvalidDesign, match="boundary layer"):
        resolved_swim(ROBOT, MOTION, SwimSetting(axes=3, cells=64, viscosity=1e-6, cycles=1))
    with pytest.raises(InvalidDesign, match=r"cells is 8"):
        SwimSetting(axes=3, cells=8, viscosity=1e-3, cycles=1)
    with pytest.raises(OutsideLimits, match="spine_yaw"):
        resolved_swim(
            ROBOT, MOTION.with_numbers(trunk_bend=3.0), SwimSetting(axes=3, cells=64, viscosity=1e-3, cycles=1)
        )


@pytest.mark.slow("a second run, which goes on from where an interrupt came")
def test_a_swim_that_was_interrupted_goes_on_to_the_same_numbers(tmp_path):
    setting, seen = SwimSetting(axes=3, cells=54, viscosity=2e-3, cycles=1, frames=4), []

    def stop(stage, share):
        if share > 0.6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        resolved_swim(ROBOT, MOTION, setting, checkpoint=tmp_path / "swim", progress=stop)
    found = resolved_swim(
        ROBOT, MOTION, setting, checkpoint=tmp_path / "swim", progress=lambda _, share: seen.append(share)
    )
    assert min(seen) > 0.5
    assert found.identical(resolved_swim(ROBOT, MOTION, setting, progress=silent))
    assert found.sizes["z"] * found.sizes["y"] * found.sizes["x"] == pytest.approx(1e6 * float(found.million_cells))
    assert float(found.power[-1]) > 0
    assert found.frame.values == pytest.approx([0.25, 0.5, 0.75, 1.0], abs=0.05)
    assert found.film_x.values[-1] == pytest.approx(found.midline_x.values, abs=1e-6)
    above = found.vortices.values[-1].max(axis=0) * float(found.vortex_unit)
    shown = above > 0.3 * float(found.vortex_level)
    capped = 30 * float(found.vortex_level)
    assert shown.sum() > 100
    assert np.minimum(above, capped)[shown] == pytest.approx(
        np.minimum(found.vortices_above.values, capped)[shown], rel=0.01
    )
    assert np.isfinite(found.joint_torque.values).all()


def test_a_motion_that_is_handed_over_joint_by_joint_swims_to_the_same_numbers():
    setting = SwimSetting(axes=3, cells=54, viscosity=2e-3, cycles=1)
    outline = Outline(ROBOT, setting.cells + 1)
    commanded = resolved_swim(ROBOT, MOTION, setting, progress=silent)
    handed = undulation(outline, MOTION)
    assert resolved_swim(ROBOT, handed, setting, progress=silent).identical(commanded)
    folded_end = handed.middles.copy()
    folded_end[1, -4:] += 0.3
    other = resolved_swim(ROBOT, replace(handed, middles=folded_end), setting, progress=silent)
    assert abs(float(other.speed[-1] / commanded.speed[-1]) - 1.0) > 1e-3
    with pytest.raises(InvalidDesign, match="has 55 stations along the midline, and 57 are asked for"):
        resolved_swim(ROBOT, handed, replace(setting, cells=56), progress=silent)


def bent():
    """Midlines that the joints take, by hand."""
    outline = Outline(ROBOT, ASKED.compared_cells + 1)
    return [TakenMidline(name, undulation(outline, MOTION), 0.4 + i) for i, name in enumerate(TAKEN)]


def test_midlines_as_taken_swim_beside_those_commanded(monkeypatch):
    without = [name for name, _ in ASKED._runs(MOTION, MOTION)]
    runs = dict(ASKED._runs(MOTION, MOTION, bent()))
    added = {name: item for name, item in runs.items() if name not in without}
    assert [*added] == list(TAKEN)
    for item in added.values():
        assert item.setting == runs["trunk only"].setting
        assert not item.joints
        check_resolved_swim(ROBOT, item.motion, item.setting)
    m = made(bent())
    assert m["speed_trunk_and_tail_as_taken"] == 0.03
    assert m["speed_tail_only_as_taken"] == -0.01
    assert (m["misfit_trunk_and_tail_as_taken"], m["misfit_tail_only_as_taken"]) == (0.4, 1.4)
    told = ASKED.explain(m)
    assert "40% off those commanded (tail alone: 140%), it swims 30.0 mm/s and the tail alone -10.0 mm/s" in told
    assert "0.1 m high" in told
    assert "taken" not in ASKED.explain(made()).replace("taken together", "")
    assert not any("taken" in name for name in made())


def test_the_robots_own_joints_move_it_unless_it_is_said():
    own = dict(ASKED._runs(MOTION, MOTION))
    assert {name for name, item in own.items() if not item.joints} == {"held", AS_COMMANDED}
    assert own[AS_COMMANDED].setting == own["trunk only"].setting
    commanded = dict(replace(ASKED, joints=False)._runs(MOTION, MOTION))
    assert [*commanded] == [name for name in own if name != AS_COMMANDED]
    assert not any(item.joints for item in commanded.values())
    assert own["96 cells"] == commanded["96 cells"]._replace(joints=True)


def test_a_robot_that_sinks_gets_the_foam_that_carries_it_and_others_stay_as_they_are():
    carried = floating(ROBOT)
    assert floats(carried)
    assert carried == with_values(ROBOT, {"hull": carried.hull})
    assert floating(carried) is carried
    heavy = with_values(carried, {"hull": replace(carried.hull, foam=carried.hull.foam[:1])})
    assert floating(heavy) == carried


def test_the_midlines_are_asked_for_only_if_they_are_to_swim(monkeypatch):
    monkeypatch.setattr(
        "suchus.experiments.catalog.swim_3d.experiment.midlines", lambda *given: pytest.fail("nobody asked")
    )
    monkeypatch.setattr("suchus.experiments.catalog.swim_3d.experiment.check_resolved_swim", _stopped)
    with pytest.raises(KeyboardInterrupt):
        ASKED.quick().run()
    with pytest.raises(pytest.fail.Exception, match="nobody asked"):
        replace(ASKED.quick(), taken=True).run()


def _stopped(*given):
    raise KeyboardInterrupt


def one(speed, *, power=2.0, weight=20.0):
    """A swim with these speeds in its cycles."""
    count = len(speed)
    return xr.Dataset(
        {
            "speed": ("cycle", speed, {"units": "m/s"}),
            "thrust": ("cycle", [0.3] * count, {"units": "N"}),
            "power": ("cycle", [power] * count, {"units": "W"}),
            "servo_power": ("cycle", [2 * power] * count, {"units": "W"}),
            "servo_torque": (("moment", "servo"), [[0.2, -0.1], [-0.5, 0.1]], {"units": "N m"}),
            "servo_limit": ("servo", [2.5, 1.0], {"units": "N m"}),
            **{name: ((), value) for name, value in {
                "swing": 0.2, "head_yaw": 0.1, "weight": weight, "wave_speed": 1.0, "thin": 0.5, "steps": 9.0,
                "million_cells": 0.1, "tail_spread": 1.5, "coupling_residual": 1e-4 * speed[-1], "energy_error": 2e-3,
                "power_error": 1e-3,
            }.items()},
        },
        coords={"cycle": np.arange(1, count + 1), "servo": ["a", "b"]},
    )  # fmt: skip


def swum(handed=(), *, joints=True):
    """The record of swims by hand."""
    asked = replace(ASKED, cells=(68, 96), cycles=2, compared_cycles=2, tail_heights=(0.1,), joints=joints)
    swims = {"68 cells": one([0.01, 0.02]), "96 cells": one([0.02, 0.04], power=1.0), "held": one([0.0, 0.0]),
             "trunk only": one([0.0, 0.01]), "tail only": one([0.0, 0.005]), "as printed": one([0.0, -0.01]),
             "as commanded": one([0.02, 0.03], power=1.5), "limbs folded": one([0.01, 0.015], weight=25.0),
             "tail 0.1 m": one([0.02, 0.06], weight=30.0)}  # fmt: skip
    models = ("model", [0.05, 0.04])
    beside = xr.Dataset(
        {"slice_speed": ("cycle", [0.1, 0.4]), "model_speed": models, "model_power": models, "model_thrust": models,
         "real_model_speed": models}, coords={"model": ["resistive", "reactive"]},
    )  # fmt: skip
    swims |= {one_.name: one(speeds) for one_, speeds in zip(handed, ([0.01, 0.03], [0.0, -0.01]), strict=False)}
    return asked.recorded(swims, with_midlines(beside, handed))


def made(handed=()):
    """The measures of swims by hand."""
    return {name: measure.value for name, measure in ASKED.measure(swum(handed)).items()}


def test_measures_are_of_the_finest_grid_and_its_last_cycle():
    m = made()
    assert m["speed"] == m["speed_96_cells"] == 0.04
    assert m["speed_gain"] == pytest.approx(1.0)
    assert m["speed_over_grids"] == pytest.approx(1.0)
    assert m["power_over_grids"] == pytest.approx(-0.5)
    assert m["water_cost_of_transport"] == pytest.approx(1.0 / (20.0 * 0.04))
    assert m["strouhal"] == pytest.approx(0.2 / 0.04)
    assert m["slip"] == pytest.approx(0.04)
    assert m["reynolds_of_speed"] == pytest.approx(7000 * 0.04 / ROBOT.length)
    assert m["thrust_held"] == 0.3
    assert m["slice_over_body"] == pytest.approx(10.0)
    assert m["servo_load_peak_a"] == pytest.approx(0.2)
    assert m["servo_load_peak_b"] == pytest.approx(0.1)


def test_what_the_joints_did_and_how_well_they_came_to_terms():
    m = made()
    assert (m["servo_power"], m["tail_spread"]) == (2.0, 1.5)
    assert m["coupling_residual"] == pytest.approx(6e-6)  # the greatest, that of the highest tail
    assert m["speed_as_commanded"] == 0.03
    told = ASKED.explain(m)
    assert "1.5 times as far as their mean" in told
    assert "it swims 30.0 mm/s with 1.50 W on the grid where its own joints make 20.0 mm/s with 2.00 W" in told
    commanded = {
        name: measure.value for name, measure in replace(ASKED, joints=False).measure(swum(joints=False)).items()
    }
    assert not {"servo_power", "tail_spread", "energy_error"} & {*commanded}
    assert "joints" not in ASKED.explain({name: value for name, value in commanded.items() if "commanded" not in name})


def test_motions_and_tails_are_compared_on_one_grid():
    m = made()
    assert (m["speed_trunk_and_tail"], m["speed_trunk_only"], m["speed_as_printed"]) == (0.02, 0.01, -0.01)
    assert m["speed_tail_0_1"] == 0.06
    assert m["water_cost_of_transport_tail_0_1"] == pytest.approx(2.0 / (30.0 * 0.06))
    assert m["water_cost_of_transport_as_printed"] > 0
    assert m["speed_limbs_folded"] == 0.015
    assert m["water_cost_of_transport_limbs_folded"] == pytest.approx(2.0 / (25.0 * 0.015))
    told = ASKED.explain(m)
    assert "40.0 mm/s in cycle 2 on 96 cells a length" in told
    assert "10 times as fast" in told
    assert "0.1 m high" in told
    assert "3.0 times as fast" in told
    assert "limbs folded straight back it swims 15.0 mm/s on the grid where it swims 20.0 mm/s" in told
    assert "limbs" not in ASKED.explain({name: value for name, value in m.items() if "limbs" not in name})


def test_the_figure_of_tails_and_motions_is_drawn_from_the_record_alone():
    figure = draw_tails(swum())
    left, right = (sorted(line.get_label() for line in ax.lines if line.get_label()[0] != "_") for ax in figure.axes)
    assert left == ["last third 0.1 m high", "the robot's tail"]
    assert right == ["as commanded", "as printed", "limbs folded", "tail only", "the robot's tail", "trunk only"]
    assert "on 68 cells a length at f L² / ν = 7000" in caption(figure)
