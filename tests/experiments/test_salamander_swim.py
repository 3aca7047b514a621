"""The animal's swim on its model: what is played, and what the measures mean."""

import inspect
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import evidence.league.cases
from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.salamander_swim import own_size
from suchus.experiments.catalog.salamander_swim.animal_swim import FREQUENCIES, STRIDE, animal_gait, envelope
from suchus.experiments.catalog.salamander_swim.rules import LADDER
from suchus.robot.design import WATER_DENSITY, layout
from suchus.robot.design.pieces import volumes
from suchus.robot.kinematics.tree import landmarks
from suchus.robot.motion import check_limits, cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.swimming.water import MODELS, Outline, Water, cruise

CATSHARK = Path(evidence.league.cases.__file__).parent / "data" / "catshark_midlines.csv"
ROBOT, SWIM = ROBOTS["salamander"], EXPERIMENTS["salamander_swim"]
RUNGS = [[[0.21, 0.21], [0.23, 0.23]], [[0.0, 0.0], [np.nan, np.nan]], [[0.2, 0.22], [0.28, 0.3]]]


def test_the_wave_runs_from_the_neck_to_the_tail_and_grows():
    gait = animal_gait(ROBOT, 2.6)
    check_limits(ROBOT, gait)
    place, clock = layout(ROBOT), np.arange(52) / 52
    angles = cycle_targets(ROBOT, gait, clock)[:, list(place.axial_yaw)] * np.array(place.axial_left)
    first = np.fft.rfft(angles, axis=0)[1]
    names = [place.servos[i] for i in place.axial_yaw]
    order = [
        names.index(name)
        for name in ("neck_yaw_1", "spine_yaw_2", "spine_yaw_1", *(f"tail_yaw_{i}" for i in range(1, 6)))
    ]
    late = -np.diff(np.unwrap(np.angle(first[order]))) / (2 * np.pi)
    assert (late > 0.0).all()
    assert late.sum() == pytest.approx(0.9, abs=0.15)  # about one wave on the body
    size = np.abs(first[order]) / 26
    assert size[-1] > 2.0 * size[0]


def test_its_limbs_lie_back_along_the_body():
    place, servos = layout(ROBOT), cycle_targets(ROBOT, animal_gait(ROBOT, 2.6), np.zeros(1))[0]
    angles = np.zeros(len(place.hinges))
    for i, name in enumerate(place.servos):
        angles[list(place.hinges).index(name)] = servos[i]
    straight, folded = landmarks(ROBOT, 0 * angles).feet, landmarks(ROBOT, angles).feet
    assert (folded[:, 0] < straight[:, 0] - 0.005).all()


def tracked(turn, ahead):
    """Return two cycles of 1 s of a stiff body that turns to and fro by an angle while it goes straight ahead."""
    time = np.linspace(0.0, 2.0, 201)
    yaw = turn * np.sin(2 * np.pi * time)
    way = np.stack([np.cos(0.3) * ahead * time, np.sin(0.3) * ahead * time, 0 * time], axis=1)
    half = (yaw + 0.3) / 2
    names = list(layout(ROBOT).hinges)
    return xr.Dataset(
        {
            "joint_angle": (("time", "joint"), np.zeros((201, len(names)))),
            "orientation": (("time", "wxyz"), np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)),
            "position": (("time", "xyz"), way),
            "centre_of_mass": (("time", "xyz"), way),
        },
        {"time": time, "joint": names},
    )


@pytest.mark.parametrize("turn", [0.0, 0.1])
def test_a_stiff_body_that_turns_about_its_root_swings_in_proportion_to_the_distance_from_it(turn):
    found = envelope(ROBOT, tracked(turn, 0.2), 0.0, 1.0)
    assert found.position[[0, -1]] == pytest.approx([0.0, 1.0])
    root = landmarks(ROBOT, np.zeros(len(layout(ROBOT).hinges))).snout[0] / ROBOT.length
    assert found.swing == pytest.approx(2 * np.sin(turn) * np.abs(found.position - root), abs=1e-3)


@pytest.fixture(scope="module")
def record():
    """Return hand-made swims at two frequencies."""
    return xr.Dataset(
        {
            "stride": ("swim", [0.2, 0.3]),
            "stride_other": ("water", [0.3, 0.22, 0.4]),
            "stride_rung": (("rung", "swim", "half"), RUNGS),
            "swing": (("swim", "point"), [[0.2, 0.1, 0.4], [0.2, 0.1, 0.6]]),
            "missed": ("swim", [0.01, 0.02]),
            "under": ("swim", [0.6, 0.7]),
            "heel": ("swim", [0.5, 0.2]),
            "unsettled": ("swim", [True, False]),
        },
        coords={"frequency": ("swim", [2.6, 3.0]), "rung": list(LADDER), "place": ("point", [0.0, 0.4, 1.0])},
    )


def test_a_rung_has_the_mean_of_its_swims_and_says_how_far_its_halves_are_apart(record):
    m = {name: one.value for name, one in SWIM.measure(record).items()}
    assert (m["stride_sections"], m["stride_sections_low"], m["stride_sections_high"]) == pytest.approx(
        (0.25, 0.24, 0.26)
    )
    assert m["stride_off_sections_low"] == pytest.approx(0.24 / STRIDE - 1)
    assert m["stride_sections_apart"] == m["stride_off_sections_apart"] == pytest.approx(0.02 / 0.25)
    assert (m["stride_resistive"], m["stride_resistive_apart"]) == pytest.approx((0.22, 0.0))
    assert np.isnan(m["stride_reactive"])  # a theory that knows no such body in one of the swims has no word


def test_theories_are_asked_of_the_swim_itself_and_sections_of_halves_of_its_cycles(quick_outcome):
    record = quick_outcome("salamander_swim").record
    outline, gait = Outline(ROBOT), animal_gait(ROBOT, FREQUENCIES[0])
    speed = cruise(outline, gait, MODELS["resistive"], Water()).speed
    stride = record.stride_rung.isel(swim=0)
    assert stride.sel(rung="resistive").values == pytest.approx([speed / FREQUENCIES[0] / ROBOT.length] * 2)
    assert (stride.sel(rung="reactive") == 0.0).all()  # its tail ends in a point
    halves = stride.sel(rung="sections")
    assert float(halves.mean()) == pytest.approx(float(record.stride[0]), rel=0.05, abs=1e-3)
    assert float(abs(halves[1] - halves[0])) > 0.0


def test_measures_are_read_from_strides_and_swings(record):
    m = {name: one.value for name, one in SWIM.measure(record).items()}
    assert m["stride_swim"] == pytest.approx(0.25)
    assert m["stride_off"] == pytest.approx(0.25 / STRIDE - 1)
    assert (m["stride_least"], m["stride_most"]) == (0.22, 0.4)
    assert (m["strouhal_2_6"], m["strouhal_3"]) == pytest.approx((2.0, 2.0))
    assert (m["swing_snout"], m["swing_tail"]) == pytest.approx((0.2, 0.5))
    assert (m["swing_least"], m["swing_least_at"]) == pytest.approx((0.1, 0.4))
    assert (m["heel"], m["angle_missed"], m["unsettled_swims"]) == (0.5, 0.02, 1.0)


def test_it_says_on_which_side_of_the_animal_it_is(record):
    for stride, side, within in ((0.3, "more than", "within"), (0.1, "less than", "within")):
        m = {name: one.value for name, one in SWIM.measure(record.assign(stride=("swim", [stride] * 2))).items()}
        assert side in SWIM.explain(m)
        assert f"which is {within}" in SWIM.explain(m)
        assert "which is outside" in SWIM.explain(m | {"stride_least": 0.3})


@pytest.mark.parametrize("name", [name for name in own_size.ANIMALS if name != "alligator_1"])  # another in size
def test_an_animal_has_its_own_length_mass_and_volume(name):
    one = own_size.ANIMALS[name]
    robot = one.body(one)
    assert one.source
    assert robot.length == pytest.approx(one.length)
    assert robot.mass == pytest.approx(one.mass)
    assert one.mass / sum(volumes(robot).values()) == pytest.approx(one.density, rel=1e-6)
    check_limits(robot, one.swim(one, robot))
    afloat = hydrostatics(robot, heel_count=3)
    assert afloat.is_floating == (one.density < WATER_DENSITY)
    assert afloat.metacentric_height > 0.0  # the centre of buoyancy is above that of mass


def test_the_wave_of_the_catshark_is_that_of_the_table_that_the_league_reads():
    rows = [row.split(",") for row in CATSHARK.read_text().splitlines() if not row.startswith("#")]
    two = next(dict(zip(rows[0], row, strict=True)) for row in rows[1:] if float(row[0]) == 2.0)
    one = own_size.ANIMALS["catshark"]
    wave = inspect.getclosurevars(one.swim).nonlocals
    assert wave["tail"] == pytest.approx(float(two["tailAmplitude_mean"]) / 2, rel=0.01)
    assert wave["head"] == pytest.approx(float(two["headAmplitude_mean"]) / 2, rel=0.01)
    assert wave["wavelength"] == pytest.approx(1.5 * float(two["wavelength_mean"]), rel=0.01)


def test_it_says_who_sinks_and_who_rolls_over(record):
    names = ["salamander", "eel"]
    rows = {key: [0.2, 0.2] for key in own_size._QUANTITY_UNITS} | {"surplus": [-0.02, 0.02], "heel": [2.0, 1.0]}
    animals = xr.Dataset({f"own_{key}": ("animal", row) for key, row in rows.items()}, coords={"animal": names})
    measures = SWIM.measure(record.merge(animals))
    m = {name: one.value for name, one in measures.items()}
    assert m["density_eel"] == pytest.approx(1.0)
    assert m["too_heavy_eel"] == pytest.approx(0.1)
    assert m["stride_eel"] == pytest.approx(0.2 / 0.2 / 0.2)
    assert m["strouhal_eel"] == pytest.approx(0.2)
    said = SWIM.explain(m)
    assert "the salamander with filled lungs comes 5.000 body lengths a cycle" in said
    assert "more than was filmed" in said
    assert "The eel is 10.0% heavier than its water, sinks" in said
    assert "The salamander with filled lungs rolls over." in said
    assert "No animal" not in said
    upright = SWIM.explain(m | {"heel_salamander": 1.0, "too_heavy_eel": -0.1})
    assert "No animal of its own size rolls over: the greatest heel is 57 degrees." in upright
    assert "sinks" not in upright
    assert own_size.draw(record.merge(animals), STRIDE).axes


def test_other_robots_and_settings_are_refused():
    with pytest.raises(InvalidDesign, match="own_size names unicorn; there is salamander"):
        replace(SWIM, own_size=("unicorn",))
    assert SWIM.frequencies == FREQUENCIES
    with pytest.raises(UnsuitedRobot, match="needs the joints of the robot 'salamander'"):
        replace(SWIM.quick(), robot=ROBOTS["strider"]).run()
    with pytest.raises(InvalidDesign, match="frequencies is"):
        replace(SWIM, frequencies=(3.0, 2.0))
    with pytest.raises(InvalidDesign, match="cycles is 0"):
        replace(SWIM, cycles=0)
