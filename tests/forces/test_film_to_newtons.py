"""Forces of a film, through the animal's body: what is drawn, what is refused, and films whose forces are known."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from suchus.animals.capture import Camera, SyntheticAnimal, UnusableTracks, driven_fraction, film, film_animal, observe
from suchus.animals.forces import Unknown, summary_lines, walked_forces
from suchus.animals.forces.body import Quantities, errors, names_with_interval, sample_walk, widen_body
from suchus.animals.forces.water import THICK_WATER, _hinge_harmonics, _spread, _SwimCycle, swum_forces
from suchus.apps.cli import main
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.control import Swimming
from suchus.robot.design import GRAVITY
from suchus.robot.design.pieces import volumes
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, swimming_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, crawl, simulate
from suchus.sim.metrics import mean_cycle
from suchus.sim.metrics.foot_forces import PARTS, Window, stance_forces
from suchus.visual.figures.forces import ground_forces_figure, water_forces_figure

FEW = Unknown(draws=3)
ABOVE = Camera(rate=50.0, noise=0.0005, lost=0.0, heading=0.4, scale=None, heights=False, seed=1)


@pytest.fixture(scope="module")
def walk():
    animal = SyntheticAnimal(
        trunk=0.12,
        tail=0.20,
        period=0.8,
        duty_factor=0.7,
        limb_phases=(0.0, 0.5, 0.25, 0.75),
        stride=0.15,
        outward=0.06,
        lift=0.02,
        spine_bend=0.5,
        spine_rightmost=0.2,
        tail_bend=0.7,
        tail_lag=1 / 3,
        tail_wave=0.0,
    )
    return observe(film_animal(animal, ABOVE, cycles=4))


@pytest.fixture(scope="module")
def walked(walk):
    return walked_forces(walk, ROBOTS["caiman"], unknown=FEW)


def test_the_feet_carry_the_weight_and_newtons_are_body_weights_times_it(walked):
    carried = walked.vertical_bw.mean("phase").sum("leg") + walked.belly_bw.mean("phase") + walked.tail_bw.mean("phase")
    assert float(carried) == pytest.approx(1.0, abs=0.02)
    weight = float(walked.value.sel(quantity="mass")) * GRAVITY
    np.testing.assert_allclose(walked.vertical, weight * walked.vertical_bw)
    for name in (*PARTS, *(f"{part}_bw" for part in PARTS), "belly_bw", "tail_bw"):
        assert (walked[f"{name}_low"] <= walked[name]).all()
        assert (walked[name] <= walked[f"{name}_high"]).all()
    swings = walked.sel(leg="LF", phase=[0.15, 0.2])  # on the film it swings from 0 to 0.3
    assert float(abs(swings.vertical_bw).max()) < 0.02
    assert float(walked.vertical_bw.sel(leg="LF", phase=slice(0.7, 0.95)).min()) > 0.1


def test_the_body_has_the_animals_size_and_goes_as_fast(walked):
    film = walked.sel(quantity="speed_filmed")
    assert float(film.low) < 0.15 / 0.8 < float(film.high)
    assert float(walked.value.sel(quantity="speed_to_filmed")) == pytest.approx(1.0, abs=0.1)
    assert float(walked.value.sel(quantity="length")) == pytest.approx(0.12 / 0.3425 * 1.01, rel=0.01)
    assert "limbs are" in walked.attrs["notes"]  # the article's robot has shorter ones for its trunk


def test_what_is_said_of_the_speed_is_so(walked):
    assert not any("does not walk as the animal does" in line for line in summary_lines(walked))
    slow = walked.copy(deep=True)
    slow["high"] = slow.high.where(slow.quantity != "speed_to_filmed", 0.96)
    assert not any("does not walk as the animal does" in line for line in summary_lines(slow))
    slow["high"] = slow.high.where(slow.quantity != "speed_to_filmed", 0.94)
    assert any("does not walk as the animal does" in line for line in summary_lines(slow))
    assert sum("0.457 ± 0.063" in line for line in summary_lines(walked)) == 1
    assert len(ground_forces_figure(walked).axes) == 4


def test_the_middle_of_all_distributions_is_the_walk_itself_and_their_ends_are_those_of_intervals(walk):
    names = names_with_interval(walk)
    same = sample_walk(walk, dict.fromkeys(names, 0.5))
    assert {name: one.value for name, one in same.numbers.items()} == pytest.approx(
        {name: one.value for name, one in walk.numbers.items()}, nan_ok=True
    )
    high = sample_walk(walk, dict.fromkeys(names, 0.975))
    seen, other = walk.numbers["stride"], high.numbers["stride"]
    assert other.value == pytest.approx(seen.value + seen.error)
    assert errors(0.975) == pytest.approx(1.0)
    later = walk.numbers["spine_rightmost"].error  # rightmost later: the bend's phase goes back
    turned = np.angle(high.bends["spine_lateral"] / walk.bends["spine_lateral"]) / (2 * np.pi)
    assert turned == pytest.approx(-later, abs=1e-9)


def test_too_short_a_film_one_in_pixels_and_one_of_a_straight_body_are_refused(walk):
    body, numbers = ROBOTS["caiman"], dict(walk.numbers)
    short = replace(walk, numbers=numbers | {"duty_LH": numbers["duty_LH"]._replace(error=np.nan)})
    with pytest.raises(UnusableTracks, match=r"duty_LH has no interval.*film one more cycle"):
        walked_forces(short, body)
    pixels = replace(walk, numbers=numbers | {"trunk_length": numbers["trunk_length"]._replace(unit="px")})
    with pytest.raises(UnusableTracks, match=r"--trunk 0\.12"):
        walked_forces(pixels, body)
    with pytest.raises(UnusableTracks, match="lacks the keypoint LF"):
        walked_forces(replace(walk, lacks=("LF",)), body)
    with pytest.raises(UnusableTracks, match="at least three keypoints"):
        swum_forces(replace(walk, phases=walk.phases.drop_vars("bend")), body)
    few = walk.phases.isel(place=[3, 4])
    with pytest.raises(UnusableTracks, match="at least half of it"):
        swum_forces(replace(walk, phases=few), body)
    marks = walk.phases.copy()
    marks["curvature"].attrs["units"] = "1/px"
    with pytest.raises(UnusableTracks, match=r"--length 0\.4"):
        swum_forces(replace(walk, phases=marks), body)
    with pytest.raises(UnknownName, match="'tank'"):
        swum_forces(walk, body, rungs=("tank",))


@pytest.mark.parametrize("wrong", [{"mass": (2.0, 1.0)}, {"friction": (0.0, 1.0)}, {"draws": 1}, {"lift": (0.5,)}])
def test_ranges_that_cannot_be_are_refused(wrong):
    with pytest.raises(InvalidDesign, match=f"unknown.{next(iter(wrong))}"):
        Unknown(**wrong)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--mass", "2", "1"), "the lower one first"),
        (("--forces", "a", "--tables", "a"), "a folder of its own"),
        (("--models", "tank"), "tank"),
    ],
)
def test_bad_words_are_one_sentence(words, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tracks.csv").write_text("time [s],hip_x [m],hip_y [m]\n0,0,0\n")
    assert main(["capture", "tracks.csv", *words]) == 2
    assert told in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["tracks.csv"]


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=12),
    st.lists(st.floats(0.02, 0.98), min_size=1, max_size=12, unique=True),
)
def test_hinges_share_all_of_the_bend(bends, hinges):
    places = np.arange(1, len(bends) + 1) / (len(bends) + 1)
    each = _hinge_harmonics(np.array(bends, complex), places, sorted(hinges))
    assert sum(each) == pytest.approx(sum(bends), abs=1e-9)


def test_hinges_where_keypoints_are_bend_as_these_do():
    places, bends = np.array([0.25, 0.5, 0.75]), np.array([0.1 + 0.2j, -0.3, 0.05j])
    np.testing.assert_allclose(_hinge_harmonics(bends, places, (0.25, 0.5, 0.75)), bends)


def test_a_body_of_another_volume_has_its_length():
    eel = ROBOTS["swimmer"]
    wide = widen_body(eel, 1.7 * sum(volumes(eel).values()))
    assert sum(volumes(wide).values()) == pytest.approx(1.7 * sum(volumes(eel).values()))
    assert wide.length == pytest.approx(eel.length)


def test_a_flow_has_the_interval_of_the_sections_in_proportion_to_its_forces():
    sections = [_SwimCycle(size * np.ones((3, 4)), speed) for size, speed in ((1.0, 0.5), (0.8, 0.4), (1.3, 0.6))]
    spread = _spread([_SwimCycle(3.0 * np.ones((3, 4)), 0.1)], sections)
    np.testing.assert_allclose([one.force[0, 0] for one in spread], [3.0, 2.4, 3.9])
    np.testing.assert_allclose([one.speed for one in spread], [0.1, 0.08, 0.12])
    assert _spread(sections, sections) == sections


def test_a_table_keeps_what_nobody_published_empty():
    table = Quantities()
    table.add("mass", [2.0, 1.0, 3.0], "kg", "of the animal")
    table.add("speed", [np.nan], "m/s", "unknown")
    data = table.dataset()
    assert [float(data[end].sel(quantity="mass")) for end in ("low", "value", "high")] == [1.0, 2.0, 3.0]
    assert np.isnan(data.animals).all()
    assert np.isnan(data.value.sel(quantity="speed"))


@pytest.mark.slow("more than ten seconds: our crawl is filmed and walked again in every choice")
def test_the_forces_of_our_own_crawl_come_back():
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    record = crawl(robot, gait, cycles=3.4)
    camera = replace(ABOVE, noise=0.002, lost=0.02)
    walk = observe(film(robot, record, camera), tail_share=driven_fraction(robot))
    data = walked_forces(walk, robot, unknown=Unknown(draws=19))
    true = stance_forces(record, Window(START + gait.period, gait.period, 2))
    grid = np.arange(true.sizes["phase"]) / true.sizes["phase"]
    # the crawl's clock begins where its commanded duty factor says, the film's where that which was seen does
    seen = np.mean([walk.value(f"duty_{leg}") for leg in data.leg.values])
    clock = data.phase.values - (gait.duty_factor - seen) / 2
    held, off = [], []
    for leg in data.leg.values:
        for part in PARTS:
            known = np.interp(clock, grid, true.sel(leg=leg, part=part), period=1.0)
            one = data.sel(leg=leg)
            low, high = one[f"{part}_bw_low"] - 0.02, one[f"{part}_bw_high"] + 0.02
            held.append(float(((known >= low) & (known <= high)).mean()))
            off.append(float(np.abs(known - one[f"{part}_bw"]).mean()))
    assert min(held) > 0.9
    assert max(off) < 0.04
    speed = data.sel(quantity="speed_to_filmed")
    assert float(speed.low) < 1.0 < float(speed.high)


@pytest.fixture(scope="module")
def swim():
    """A swim of our own, as a record and as its film, with all that is known of the water."""
    robot = ROBOTS["swimmer"]
    gait = swimming_gait(
        robot, name="w", frequency=1.0, amplitude=[0.15 + 0.03 * i for i in range(10)],
        lag=[0.09 * i for i in range(10)],
    )  # fmt: skip
    lake = Lake(level=2.0, water=replace(Lake(level=1.0).water, cross_drag=1.3, thickening=2.0), shedding=0.75)
    run = Run(robot=robot, gait=gait, lake=lake, control=Swimming(ramp=0.5))
    record = simulate([run], duration=10.0).isel(run=0)
    walk = observe(film(robot, record, replace(ABOVE, noise=0.001), start=5.0))
    return record, walk


def test_power_and_force_of_the_water_come_back(swim, tmp_path):
    record, walk = swim
    data = swum_forces(walk, ROBOTS["swimmer"], rungs=("sections",), unknown=Unknown(draws=9)).isel(rung=0)
    power = -float(mean_cycle(record.water_power, 8.0, 1.0, 1).mean())
    assert float(data.mean_power_low) < power < float(data.mean_power_high)
    film = data.sel(quantity="speed_filmed")
    assert float(data.speed_low) < float(film.value) < float(data.speed_high)
    aside = mean_cycle(record.water_force.sel(xyz="y"), 8.0, 1.0, 1)
    assert float(data.aside.std()) == pytest.approx(float(aside.std()), rel=0.35)
    numbers = {name: float(data.value.sel(quantity=name)) for name in ("reynolds", "strouhal", "froude")}
    assert numbers["reynolds"] == pytest.approx(float(data.speed) * 1.045 / 1e-6, rel=0.02)
    assert 0.2 < numbers["strouhal"] < 1.0
    sizes = float(data.value.sel(quantity="swimming_number")) / numbers["strouhal"] / numbers["reynolds"]
    assert sizes == pytest.approx(2 * np.pi)


@pytest.mark.slow("more than ten seconds: a slice and a flow in space are computed")
def test_three_models_of_the_water_stand_side_by_side(swim):
    _, walk = swim
    data = swum_forces(walk, ROBOTS["swimmer"], unknown=FEW, cells={"slice": 48})
    assert list(data.rung.values) == ["sections", THICK_WATER, "slice", "space"]
    assert bool(np.isfinite(data.thrust).all())
    assert (data.mean_power > 0.0).all()
    # a body that nothing holds is pushed as much as it is braked
    for rung in data.rung.values:
        one = data.sel(rung=rung)
        assert abs(float(one.thrust.mean())) < 0.35 * float(one.peak_thrust)
    assert any("outside the interval" in line or "within the interval" in line for line in summary_lines(data))
    assert len(water_forces_figure(data).axes) == 3


def test_the_speed_of_the_film_is_held_against_every_model():
    rows = {name: ("rung", [1.0, 2.0]) for name in ("peak_thrust", "peak_aside", "mean_power", "speed")}
    ends = {f"{name}{end}": value for name, value in rows.items() for end in ("_low", "_high")}
    data = xr.Dataset(rows | ends, coords={"rung": ["sections", "slice"]}, attrs={"medium": "water", "body": "eel"})
    for name in rows:
        data[name].attrs["units"] = "N"
    table = Quantities()
    table.add("length", [1.0], "m", "")
    table.add("displaced", [1.0], "kg", "")
    for seen, told in ((2.0, "within the interval of slice"), (3.0, "outside the interval of every model")):
        table.add("speed_filmed", [seen], "m/s", "")
        assert summary_lines(data.merge(table.dataset().isel(quantity=[0, 1, -1])))[-1].endswith(told)
