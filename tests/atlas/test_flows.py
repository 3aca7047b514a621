"""The flows of the atlas: each can begin, and what they read off fields and motions is exact where it can be."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from evidence.atlas import CASES, RunEffort, marching, still
from evidence.atlas.aerofoil import pitching
from evidence.atlas.cylinders import turning, wake_length
from evidence.atlas.marching import formed, march, nudged, shedding
from evidence.atlas.oscillated import mean_skin
from evidence.atlas.skin import WallValues
from evidence.atlas.spheres import swung
from evidence.atlas.still import flapping, gust, quasi_steady_peaks
from suchus import flow
from suchus.flow.record import COLUMNS


class Begun(Exception):
    """Raised when a flow says for the first time how far it is."""


def begin(case, effort):
    def progress(stage, share):
        assert 0 < share <= 0.25
        raise Begun

    with pytest.raises(Begun):
        case.run(effort, progress)


BEGUN = [name for name in CASES if "snake" not in name or name == "snake_30_re1000"]  # 3 s for each snake to be placed


@pytest.mark.parametrize("name", BEGUN)
def test_a_trial_of_every_flow_begins(name):
    begin(CASES[name], CASES[name].quick_effort)


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.full.coarse and "snake" not in name])
@pytest.mark.parametrize("quick", [True, False])
def test_both_grids_of_a_flow_lie_at_the_same_place(name, quick, monkeypatch):
    case, module = CASES[name], import_module(getattr(CASES[name].run, "func", CASES[name].run).__module__)

    def go_on(coarse, setup):
        ours, theirs = (now.coarse_grid or now.grid for now in (setup, coarse.setup))
        assert (*ours.origin, *ours.size) == pytest.approx((*theirs.origin, *theirs.size))
        assert setup.grid.cell < coarse.setup.grid.cell
        raise Begun

    monkeypatch.setattr(marching, "_FORMED", {})
    monkeypatch.setattr(module, "march", lambda *words, **more: None)
    monkeypatch.setattr(module, "refined", go_on)
    with pytest.raises(Begun):
        case.run(case.quick_effort if quick else case.full, lambda share: None)


@pytest.mark.parametrize("name", ["cavity_re1000", "dfg_2d1", "settling"])
def test_flows_whose_grids_are_given_by_walls_begin_in_full(name):
    begin(CASES[name], CASES[name].full)


@pytest.mark.parametrize("time", [0.0, 0.3, 1.0, 2.7, 3.9])
def test_the_flapping_ellipse_moves_as_its_rates_say(time):
    step = 1e-6
    before, now, after = (flapping(t) for t in (time - step, time, time + step))
    for k in range(2):
        rate = (after.position[k] - before.position[k]) / (2 * step)
        assert now.velocity[k] == pytest.approx(rate, abs=1e-7)
    assert now.spin == pytest.approx((after.angle - before.angle) / (2 * step), abs=1e-7)
    assert flapping(0.0).position == (1.4, 0.0)


@pytest.mark.parametrize("motion", [pitching, swung, turning])
@pytest.mark.parametrize("time", [0.3, 1.0, 2.2, 3.1])
def test_a_motion_goes_as_its_rates_say(motion, time):
    step = 1e-6
    before, now, after = (motion(t) for t in (time - step, time, time + step))
    rates = (np.array(after.position) - before.position) / (2 * step)
    assert np.array(now.velocity) == pytest.approx(rates, abs=1e-7)
    assert now.spin == pytest.approx((after.angle - before.angle) / (2 * step), abs=1e-7)


def test_the_aerofoil_pitches_as_its_source_says_about_its_quarter_chord():
    """Schneiders et al. 2013: a rate of 0.6 (1 - exp(-4.6 t)) from the start of the pitch, nose up."""
    for time in (0.0, 2.0, 2.5, 3.85):
        pose, since = pitching(time), max(time - 2.0, 0.0)
        assert pose.spin == pytest.approx(-0.6 * (1 - np.exp(-4.6 * since)))
        turn = np.array([np.cos(pose.angle), np.sin(pose.angle)])
        assert np.array(pose.position) + 0.25 * turn == pytest.approx(0, abs=1e-12)
    assert -np.degrees(pitching(3.85).angle) > 55  # as far as the published curves go


def test_a_gust_is_across_small_and_gone():
    assert gust(2.4, 2.5) == gust(4.6, 2.5) == (0.0, 0.0)
    assert gust(3.5, 2.5) == pytest.approx((0.0, 0.1))


def test_the_ensemble_of_two_states_holds_each_run_and_its_mirror_image(monkeypatch):
    """A run whose force across is 3 in the first gust and 5 in the second, along it the phase of its cycle."""
    forces = iter((3.0, 5.0))

    class Told:
        time, step = np.linspace(0.05, 12.0, 240) * 10, np.full(240, 1e-9)

        def force(self):
            return np.stack([self.time / 10 % 1.0, np.full(240, across)], axis=1)

    def march(sim, until, progress):
        nonlocal across
        assert until == (60.0 if sim.setup.grid.cell == 1 / 4 else 50.0)
        across = next(forces) if sim.setup.grid.cell == 1 / 8 else 0.0
        return Told()

    across = 0.0
    monkeypatch.setattr(still, "march", march)
    monkeypatch.setattr(marching, "_FORMED", {})
    effort = RunEffort(cells=8, until=5.0, coarse=4, initial_duration=6.0)
    found = CASES["two_states"].run(effort, lambda *words: None)
    assert len(found) == 2 * 2 * 2 * 4
    assert [float(found[f"force across {k}"][1, 9]) for k in (1, 2, 3, 9, 10)] == [3, -3, 3, 5, -5]
    assert np.array_equal(found["force along 1"], found["force along 2"])
    assert found["force along 1"][1, 125] == pytest.approx(0.5, abs=0.02)


def test_friction_is_the_shear_of_the_vorticity_along_the_stream():
    """Vorticity -k sin around the cylinder, clockwise above: 2 F / (rho U^2 D) = viscosity k pi."""
    angle = np.random.default_rng(0).permutation(np.arange(0.0, 360.0, 3.0))
    skin = WallValues(angle=angle, pressure=np.zeros(120), vorticity=-7.0 * np.sin(np.radians(angle)))
    assert skin.friction(0.01) == pytest.approx(0.07 * np.pi, rel=1e-3)
    assert replace(skin, vorticity=7 * np.cos(np.radians(angle))).friction(0.01) == pytest.approx(0, abs=1e-12)


def test_the_flapping_ellipse_s_sources_divide_by_forces_of_the_size_of_its_speed():
    """The largest values over half a stroke, by another route: the speed goes with the sine of the phase."""
    speed = flapping(1.0).velocity[0]

    def less(phase, share):  # the angle of attack is 90 degrees at both ends of the stroke and 45 in its middle
        attack = np.pi / 2 - np.pi / 4 * np.sin(phase)
        return -(np.sin(phase) ** 2) * share(attack)

    drag, lift = (
        -minimize_scalar(less, bounds=(0.5, np.pi / 2), args=(share,), method="bounded").fun
        for share in (lambda a: 1.4 - np.cos(2 * a), lambda a: 1.2 * np.sin(2 * a))
    )
    assert quasi_steady_peaks() == pytest.approx((0.5 * speed**2 * drag, 0.5 * speed**2 * lift), rel=1e-5)


def test_the_recirculation_ends_where_the_velocity_on_the_axis_is_zero():
    grid = flow.Grid.covering((-1.0, 4.0), (-1.0, 1.0), cell=1 / 16)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.1, stream=(1.0, 0.0), bodies=(body,)))
    assert wake_length(sim) == 0.0
    sim.water.u[:] = grid.faces(0, sim.water.u.shape[1], 0)[None, :] - 1.8
    assert wake_length(sim) == pytest.approx(1.3, abs=1e-5)
    sim.water.u[:] = -1.0  # it has no end in the domain
    assert wake_length(sim) == 0.0


def test_the_gust_ends_and_leaves_no_trace():
    assert nudged(0.4) == nudged(2.6) == (1.0, 0.0)
    assert nudged(1.5) == pytest.approx((1.0, 0.3))
    assert nudged(0.5 + 1e-4)[1] < 1e-6


def test_the_shedding_of_a_sine_is_exact():
    step = 0.01
    time = np.arange(step, 40.0, step)
    middle = time - step / 2
    bodies = np.zeros((time.size, 1, len(COLUMNS)))
    bodies[:, 0, COLUMNS.index("force_x")] = 0.5 * (1.3 + 0.02 * np.cos(2 * np.pi * 0.4 * middle))
    bodies[:, 0, COLUMNS.index("force_y")] = 0.5 * (0.1 + 0.4 * np.sin(2 * np.pi * 0.2 * middle))
    record = flow.Record(
        names=("body",), time=time, step=np.full(time.size, step), cycles=np.zeros((time.size, 2)),
        divergence=np.zeros(time.size), bodies=bodies,
    )  # fmt: skip
    found = shedding(record, 5)
    assert found["mean drag"] == pytest.approx(1.3, abs=1e-3)
    assert found["mean lift"] == pytest.approx(0.1, abs=2e-3)
    assert found["lift amplitude"] == pytest.approx(0.4, rel=2e-3)
    assert found["Strouhal"] == pytest.approx(0.2, rel=5e-3)


def test_a_march_tells_shares_that_rise_to_one():
    sim = flow.Simulation(flow.Setup(grid=flow.Grid(cells=(16, 16), cell=1 / 16), viscosity=0.1))
    said, seen = [], []
    tell = lambda _, share: said.append(share)  # noqa: E731
    march(sim, 0.5, tell, end=2.0, watch=(lambda now: seen.append(now.time),), every=0.25)
    march(sim, 2.0, tell, end=2.0)
    assert said == sorted(said)
    assert said[0] < 0.26
    assert said[-1] == 1.0
    assert seen[-1] == 0.5


def test_the_grids_of_a_flow_share_the_run_in_which_its_wake_forms():
    made = []

    def form():
        made.append(len(made))
        return flow.Simulation(flow.Setup(grid=flow.Grid(cells=(16, 16), cell=1 / 16), viscosity=0.1))

    first = formed(("a test", 1), form)
    assert formed(("a test", 1), form) is first
    assert formed(("a test", 2), form) is not first
    assert formed(("a test", 1), form) is not first  # one is kept
    assert made == [0, 1, 2]


def test_the_mean_of_readings_is_taken_marker_by_marker():
    one, two = (
        WallValues(angle=np.arange(3.0), pressure=np.full(3, p), vorticity=np.arange(3.0) * p) for p in (1.0, 3.0)
    )
    mean = mean_skin([one, two])
    assert mean.pressure.tolist() == [2.0, 2.0, 2.0]
    assert mean.vorticity.tolist() == [0.0, 2.0, 4.0]
