"""A search ends with the same bytes, whatever happens on the way, and its files do what they say."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.apps.cli import main
from suchus.core.errors import IncompatibleRecord, NotConverged, Unwritable
from suchus.core.files import load
from suchus.core.jobs.store import unpacked
from suchus.experiments.optimise import Limit, evaluate, optimise, read_optimisation
from suchus.experiments.optimise.aims import LIMITS
from suchus.experiments.optimise.conduct import CONDITIONS, _run_under_condition
from suchus.experiments.study import Arm, Vary
from suchus.robot import blueprint
from suchus.robot.control import Walking
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement, slip

PAGE = """
name = "small"
population = 4
evaluations = 12
duration = 1.3
timestep = 0.01
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.75
[[vary]]
field = "gait.trunk_bend"
low = 0.0
high = 2.3
[[aims]]
name = "displacement"
[[limits]]
name = "clearance"
value = 0.005
[[arms]]
name = "free"
[[arms]]
name = "straight"
values = {"gait.trunk_bend" = 0.0}
"""
ALONE = "import sys; from pathlib import Path; from suchus.experiments.optimise import optimise, read_optimisation; "
ALONE += "optimise(read_optimisation(Path(sys.argv[1])), Path(sys.argv[2]))"


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture
def page(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(PAGE)
    return path


@pytest.mark.battery("kills")
@pytest.mark.slow("a process is killed, and the search run twice")
def test_a_killed_search_loses_at_most_a_generation_and_ends_with_the_same_bytes(page, tmp_path, counted):
    store = tmp_path / "killed"
    with subprocess.Popen([sys.executable, "-c", ALONE, str(page), str(store)]) as process:
        while len(list((store / "free" / "parts").glob("*.nc"))) < 3 and process.poll() is None:
            time.sleep(0.002)
        os.kill(process.pid, signal.SIGKILL)
    counted()
    kept = {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in store.rglob("*.nc") if not p.parent.name.startswith(".")}
    assert len(kept) >= 3
    optimise(read_optimisation(page), store)
    for path, (held, when) in kept.items():
        assert path.read_bytes() == held
        assert path.stat().st_mtime_ns == when  # not run again
    optimise(read_optimisation(page), tmp_path / "whole")
    assert contents(store) == contents(tmp_path / "whole")


@pytest.mark.slow("a search is interrupted, and run on twice")
def test_an_interrupt_keeps_the_best_so_far_and_a_greater_budget_goes_on(small, tmp_path):
    spec, told = replace(small, limits=()), []

    def stop(stage, share):
        told.append(stage)
        if share >= 8 / 12 and len(told) > 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        optimise(spec, tmp_path / "s", progress=stop)
    best = blueprint.read_design(tmp_path / "s" / "best.toml", Gait, GAITS)
    record = simulate([replace(spec.run, gait=best)], duration=spec.duration, timestep=spec.timestep, sample_stride=2)
    parts = [unpacked(load(part)) for part in (tmp_path / "s" / "best" / "parts").glob("*.nc")]
    farthest = max(float(part.aim_displacement.max()) for part in parts)
    assert float(displacement(record).sel(xyz="x")[0]) == pytest.approx(farthest, abs=1e-12)
    assert re.fullmatch(rf"best: 8 of 12 tried, [\d.]+/s, \d+ s left, best {farthest:.3g} m", told[-1])
    (first,) = optimise(spec, tmp_path / "s")
    (longer,) = optimise(replace(spec, evaluations=16), tmp_path / "s")
    assert longer.history.sizes["candidate"] == 17
    np.testing.assert_array_equal(longer.history.share[:13], first.history.share)


def test_the_count_is_of_whole_generations(small, tmp_path):
    """The generation in which the candidates run out is finished: it was counted as 16 of 4."""
    told = []
    optimise(replace(small, evaluations=5, limits=()), tmp_path / "s", progress=lambda stage, share: told.append(stage))
    counts = [match.groups() for stage in told if (match := re.match(r"best: (\d+) of (\d+) tried", stage))]
    assert {total for _, total in counts} == {"8"}
    assert [int(count) for count, _ in counts][-1] == 8


def test_another_search_is_named_and_left_alone(small, tmp_path):
    spec = replace(small, limits=(), evaluations=4)
    optimise(spec, tmp_path / "s")
    before = contents(tmp_path / "s")
    with pytest.raises(IncompatibleRecord, match=r"holds optimisation 'small', which differs from 'small' in seed"):
        optimise(replace(spec, seed=5), tmp_path / "s")
    mark = tmp_path / "s" / "best" / "optimisation.json"
    origin = json.loads(mark.read_text())
    origin["versions"]["cma"] = "1.0"
    mark.write_text(json.dumps(origin))
    with pytest.raises(IncompatibleRecord, match=r"written by cma 1\.0 \(here [\d.]+\)"):
        optimise(spec, tmp_path / "s")
    assert {k: v for k, v in contents(tmp_path / "s").items() if "json" not in k} == {
        k: v for k, v in before.items() if "json" not in k
    }
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "best").mkdir()
    (tmp_path / "mine" / "best" / "thesis.txt").write_text("x")
    with pytest.raises(Unwritable, match="holds no optimisation"):
        optimise(spec, tmp_path / "mine")


def test_limits_that_nothing_keeps_are_a_sentence(small, tmp_path):
    with pytest.raises(NotConverged, match="nothing of 5 candidates of best keeps all limits"):
        optimise(replace(small, limits=(Limit(name="displacement", value=5.0),), evaluations=4), tmp_path / "s")


def test_a_generation_says_what_each_candidate_does_alone(small):
    spec = replace(
        small, limits=(Limit(name="slip", value=0.5), Limit(name="torque", value=0.6)), friction_scales=(0.7, 1.0)
    )
    shares = np.array([spec.start, [0.9, 1.0], [0.2, 0.9]])
    told = evaluate.evaluate(spec, shares)
    assert told.status.values.tolist() == ["walked", "refused", "walked"] or told.beyond.values[1] == 0.0
    runs = [replace(spec.run, ground=replace(spec.run.ground, friction_scale=grip)) for grip in spec.friction_scales]
    record = simulate(runs, duration=spec.duration, timestep=spec.timestep, sample_stride=2)
    assert told.aim_displacement.values[0] == pytest.approx(displacement(record).sel(xyz="x").values.mean(), abs=1e-12)
    assert told.limit_slip.values[0] == pytest.approx(slip(record).values.max(), abs=1e-12)


def test_one_that_comes_apart_or_cannot_be_does_not_spoil_the_rest(small, monkeypatch):
    def apart(runs, **options):
        record = simulate(runs, **options)
        record.cause[1] = "a speed of 2e3 was reached"
        return record

    monkeypatch.setattr(evaluate, "simulate", apart)
    told = evaluate.evaluate(small, np.array([small.start, small.start, small.start]))
    assert told.status.values.tolist() == ["walked", "diverged", "walked"]
    assert np.isfinite(told.aim_displacement.values).tolist() == [True, False, True]


def test_one_whose_control_cannot_steer_does_not_spoil_the_rest(small):
    """The gait's bends and the steering's together are more than the trunk allows; each alone is not."""
    spec = replace(
        small,
        run=replace(small.run, control=Walking(bend=0.4)),
        vary=(Vary(field="control.bend", low=0.0, high=2.0), Vary(field="gait.trunk_bend", low=0.0, high=2.0)),
    )
    table = evaluate.evaluate(spec, np.array([[0.2, 0.5], [0.9, 0.9]]))
    assert list(table.status.values) == ["walked", "refused"]
    assert list(np.isfinite(table.beyond.values)) == [True, False]


def test_torque_is_that_of_the_servo_that_works_hardest_over_its_own_limit(robot, crawl_gait):
    record = simulate([Run(robot=robot, gait=crawl_gait)], duration=1.3, timestep=0.01)
    record["servo_mean_square_torque"] = xr.zeros_like(record.servo_torque)
    record.servo_mean_square_torque.loc[{"servo": "LF_yaw"}] = (0.5 * robot.servo("LF_yaw").torque) ** 2
    record.servo_mean_square_torque.loc[{"servo": "spine_yaw_2"}] = (0.6 * robot.servo("spine_yaw_2").torque) ** 2
    assert LIMITS["torque"].measure([Run(robot=robot, gait=crawl_gait)], record)[0] == pytest.approx(0.6)


def test_the_command_leaves_gaits_numbers_and_a_page(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["optimise", "small.toml", "--evaluations", "4"]) == 0
    out, _ = capsys.readouterr()
    result = tmp_path / "out" / "optimise" / "small" / "result"
    assert "free: displacement" in out
    assert str(result.relative_to(tmp_path) / "index.html") in out
    told = json.loads((result / "outcome.json").read_text())
    assert list(told["arms"]) == ["free", "straight"]
    for name, arm in told["arms"].items():
        gait = blueprint.read_design(result / f"{name}.toml", Gait, GAITS)
        assert gait.name == f"small_{name}"
        assert gait.number("stroke") == arm["best"][name]["fields"]["gait.stroke"]["best"]
        assert set(arm["best"][name]["limits"]) == {"clearance"}
        record = simulate([Run(robot=read_optimisation(page).run.robot, gait=gait)], duration=1.3)
        fine = arm["best"][name]["checks"]["2 ms"]["aim_displacement"]
        assert fine == pytest.approx(float(displacement(record).sel(xyz="x")[0]), rel=1e-6)
    text = (result / "index.html").read_text()
    for word in ("Is it an optimum?", "free_replay.html", "under other conditions", "data:image/svg+xml"):
        assert word in text


@pytest.mark.slow("a second run of a search")
def test_the_command_leaves_the_same_files_when_it_is_given_again(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result, before = tmp_path / "out" / "optimise" / "small" / "result", {}
    for _ in range(2):
        assert main(["optimise", "small.toml", "--evaluations", "4"]) == 0
        before = before or contents(result)
    assert contents(result) == before


def test_arms_of_one_have_no_comparison(small):
    assert [arm.name for arm in small.arms] == ["best"]
    assert small.for_arm(small.arms[0]) is small
    assert small.for_arm(Arm(name="other")).arms == (Arm(name="other"),)


@pytest.mark.parametrize("name", ["salamander", "swimmer"])
def test_a_body_of_its_own_is_searched_with_its_own_time_step(name, tmp_path):
    """A small one, whose results need a finer step than the caiman's, and one without limbs to replay."""
    own = default_gait(ROBOTS[name])
    gait = next(key for key in GAITS if GAITS[key] == own)
    page = tmp_path / "own.toml"
    page.write_text(f"""
name = "own"
robot = "{name}"
gait = "{gait}"
population = 4
evaluations = 4
duration = {max(1.15 * own.period, 1.15)}
timestep = {coarse_step(ROBOTS[name])}
[[vary]]
field = "gait.period"
low = {0.9 * own.period}
high = {1.1 * own.period}
[[aims]]
name = "displacement"
""")
    assert main(["optimise", str(page), "--out", str(tmp_path / "found")]) == 0
    assert len(list((tmp_path / "found").rglob("*_replay.html"))) == 1


def test_a_check_shakes_no_servo_and_builds_robots_of_the_design():
    """White noise shakes a robot forward, so that it would flatter what was found."""
    run = Run(robot="caiman", gait="belly_crawl")
    tried = {condition.tells: _run_under_condition(run, condition) for condition in CONDITIONS}
    built = {one.zero_error for one in tried.values() if one.zero_error}
    assert {one.noise for one in tried.values()} == {0.0}
    assert len(built) == sum(condition.tolerance_seed is not None for condition in CONDITIONS) == 2
    assert tried["2 ms"] == run
    assert tried["foot friction 1.0"].ground.friction_scale == 1.25
    assert tried["a robot as built, seed 1"].robot != run.robot
    assert tried["begun a quarter of a cycle later"].gait != run.gait
