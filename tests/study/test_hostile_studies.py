"""Studies that start together, whose parts are damaged, or whose files say what cannot be."""

import logging
import socket
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from suchus.apps.cli import main
from suchus.core.errors import IncompatibleRecord, InvalidDesign, SuchusError
from suchus.core.jobs import NoCluster, cluster, connected
from suchus.core.jobs.cluster import _check_versions, _reach
from suchus.core.jobs.store import Store
from suchus.experiments.optimise import Optimisation
from suchus.experiments.optimise.spec import Aim
from suchus.experiments.study import MEASURES, Plan, Study, Vary, conduct, read_study, run_chunk
from suchus.robot.control import PatternGenerator
from suchus.sim.land import Run, crawl

PATIENCE = 300.0
"""How long a busy machine may take until all have looked [s]."""
PAGE = """
name = "s"
duration = 1.1
measure = ["displacement"]
[[vary]]
field = "ground.friction_scale"
values = [1.0]
"""


@pytest.fixture
def asked(robot, crawl_gait):
    return Study(
        name="s",
        run=Run(robot=robot, gait=crawl_gait),
        vary=(Vary(field="ground.friction_scale", values=(0.9, 1.0, 1.1)),),
        measure=("displacement",),
        chunk=1,
        duration=1.1,
    )


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_a_flipped_bit_in_a_part_has_it_made_again_and_told(asked, tmp_path, caplog):
    conduct(asked, tmp_path / "s")
    before = contents(tmp_path / "s")
    part = tmp_path / "s" / "parts" / "000001.nc"
    whole, rng = part.read_bytes(), np.random.default_rng(0)
    store = Store(tmp_path / "s", asked)
    for at in rng.integers(0, len(whole), 24):
        part.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << int(at) % 8]) + whole[at + 1 :])
        assert not store.has(1)
    caplog.clear()
    with caplog.at_level(logging.WARNING):
        conduct(asked, tmp_path / "s")
    assert [r.getMessage() for r in caplog.records] == [f"{part} is damaged and is made again."]
    assert contents(tmp_path / "s") == before


def test_of_studies_that_start_together_one_runs_and_the_others_hear_why_not(asked, tmp_path):
    ready, refusals = threading.Barrier(8), threading.Semaphore(0)

    def start(_):
        ready.wait()
        try:
            with Store(tmp_path / "s", asked).opened():
                assert all(refusals.acquire(timeout=PATIENCE) for _ in range(7))  # until all others have looked
        except SuchusError as error:
            refusals.release()
            return str(error)
        return "ran"

    with ThreadPoolExecutor(8) as crowd:
        told = list(crowd.map(start, range(8)))
    assert told.count("ran") == 1
    assert sum("is being written by another process" in one for one in told) == 7


def test_a_store_is_held_from_the_first_look_at_it(asked, tmp_path):
    with Store(tmp_path / "s", asked).opened(), pytest.raises(SuchusError, match="another process"):
        Store(tmp_path / "s", asked)._alone().__enter__()


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "n" * 250])
@pytest.mark.parametrize("command", ["study", "optimise"])
def test_a_name_that_leads_elsewhere_is_refused(command, name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = PAGE if command == "study" else AIMED
    (tmp_path / "s.toml").write_text(page.replace('"s"', f'"{name}"', 1))
    assert main([command, "s.toml"]) == 2
    assert "which makes no folder" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["s.toml"]


AIMED = """
name = "s"
evaluations = 4
[[aims]]
name = "displacement"
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.5
"""


def test_every_measure_can_be_taken_of_the_shortest_run(asked):
    table = run_chunk(replace(asked, measure=tuple(MEASURES), chunk=1), 0)
    assert set(table.error.values) == {""}
    with pytest.raises(InvalidDesign, match=r"study\.duration is 1 s; 1\.1 to 86400 s is allowed"):
        replace(asked, duration=1.0)


def test_whole_numbers_of_a_range_are_whole_and_equally_frequent(asked):
    vary = Vary(field="robot.tail.joints", low=4.0, high=8.0)
    drawn = [p.values["robot.tail.joints"] for p in Plan(replace(asked, vary=(vary,), design="sobol", samples=256))]
    assert all(isinstance(value, int) for value in drawn)
    assert np.ptp(np.bincount(drawn, minlength=9)[4:]) <= 2
    plan = Plan(replace(asked, vary=(replace(vary, steps=5),)))
    assert [p.values["robot.tail.joints"] for p in plan] == [4, 5, 6, 7, 8]
    assert plan.run(4).robot.tail.joints == 8
    with pytest.raises(InvalidDesign, match="in 4 steps from 4 to 8, which are none"):
        replace(asked, vary=(replace(vary, steps=4),))
    with pytest.raises(InvalidDesign, match=r"from 4\.5 to 8; give whole ends"):
        replace(asked, vary=(replace(vary, low=4.5),), design="sobol", samples=4)
    with pytest.raises(InvalidDesign, match="takes whole numbers; a search moves in real ones"):
        Optimisation(name="x", run=asked.run, vary=(vary,), aims=(Aim(name="displacement"),))


def test_a_file_names_its_controller_and_the_fields_of_it(tmp_path):
    page = tmp_path / "s.toml"
    page.write_text('control = {kind = "pattern_generator", drive = 2.5}\n' + PAGE)
    assert read_study(page).run.control == PatternGenerator(drive=2.5)
    for table, words in (
        ('{kind = "patern_generator"}', "Did you mean 'pattern_generator'"),
        ("{drive = 2.5}", "a control needs a kind"),
        ('{kind = "walking", drive = 2.5}', "the controller walking has a mistake: drive is not known"),
        ('{kind = "walking", bend = "x"}', "bend"),
    ):
        page.write_text(f"control = {table}\n" + PAGE)
        with pytest.raises(SuchusError, match=words):
            read_study(page)


def test_names_do_wherever_a_robot_or_a_gait_is_asked_for(asked, tmp_path, robot, limbs_gait, crawl_gait):
    page = tmp_path / "s.toml"
    broken = "[{kind = 'limp', joint = 'LF_yaw'}]"
    arm = f'[[arms]]\nname = "limbs"\nvalues = {{gait = "limbs_only", robot = "caiman", faults = {broken}}}\n'
    page.write_text(PAGE + arm)
    run = Plan(read_study(page)).run(0)
    assert (run.gait, run.robot, run.faults[0].joint) == (limbs_gait, robot, "LF_yaw")
    assert Run(robot="caiman", gait="belly_crawl") == asked.run
    named, given = crawl("caiman", "belly_crawl", duration=0.1), crawl(robot, crawl_gait, duration=0.1)
    assert named.identical(given)
    for words in ({"gait": "trot"}, {"gait": 3}, {"robot": None}, {"noise": "x"}, {"faults": [1]}, {"control": 1}):
        with pytest.raises(SuchusError):
            replace(asked.run, **words)


@pytest.mark.parametrize(
    "values",
    ['{gait = "trot"}', "{gait = 3}", '{"ground.relief" = "x"}', "{faults = 3}", '{"gait.period" = "x"}', "3",
     '{control = "x"}', "{pushes = [{force = [1, 2]}]}", "{ground = {uphill = 3}}", '{"gait.limb_phases" = 3}',
     "{faults = [{kind = 'limp', joint = 3}]}", "{seed = 1.5}", "{label = []}", '{"robot.tail.joints" = 1979-05-27}'],
)  # fmt: skip
def test_values_of_the_wrong_kind_are_a_sentence(values, tmp_path, capsys):
    page = tmp_path / "s.toml"
    page.write_text(PAGE + f'[[arms]]\nname = "a"\nvalues = {values}\n')
    assert main(["study", str(page), "--out", str(tmp_path / "store")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "store").exists()


@pytest.mark.parametrize("address", ["foo", "", "http://", "tls://", "tcp://", "tcp://h:0", "tcp://h:99999", "h:8786"])
def test_an_address_that_is_none_is_told_at_once(address):
    with pytest.raises(NoCluster, match="is no address of a scheduler"):
        _reach(address, 10.0)


def test_where_nobody_listens_or_something_else_does_is_told_soon(caplog, monkeypatch):
    clock = [0.0]
    waiting = SimpleNamespace(monotonic=lambda: clock[0], sleep=lambda time: clock.append(clock.pop() + time))
    monkeypatch.setattr(cluster, "time", waiting)
    with pytest.raises(NoCluster, match="no scheduler answers"):
        _reach("tcp://127.0.0.1:9", 0.6)
    assert clock == [0.5]
    assert "trying for 0.6 s" in caplog.text  # not in silence
    for said in (b"", b"SSH-2.0-OpenSSH\r\n"):
        with socket.create_server(("127.0.0.1", 0)) as other:

            def answer(other=other, said=said):
                wire = other.accept()[0]
                with wire, suppress(OSError):
                    wire.sendall(said)
                    wire.recv(1)

            answering = threading.Thread(target=answer)
            answering.start()
            with pytest.raises(NoCluster, match="is no scheduler"):
                _reach(f"tcp://127.0.0.1:{other.getsockname()[1]}", 0.3)
            answering.join()


class Cluster:
    """What of a Dask client is asked for versions."""

    def __init__(self, told):
        self.get_versions = lambda: told


def test_versions_that_do_not_understand_each_other_are_named():
    ours = {"packages": {"python": "3.11.7.final.0", "dask": "2026.8.0", "distributed": "2026.8.0"}}
    theirs = {"packages": {**ours["packages"], "distributed": "2025.1.0"}}
    patch = {"packages": {**ours["packages"], "python": "3.11.9.final.0"}}
    _check_versions(Cluster({"client": ours, "scheduler": patch, "workers": {"w": ours}}))
    with pytest.raises(IncompatibleRecord, match=r"the worker w has distributed 2025\.1\.0 \(here 2026\.8\.0\)"):
        _check_versions(Cluster({"client": ours, "scheduler": ours, "workers": {"w": theirs}}))
    with pytest.raises(NoCluster, match="does not report its versions"):
        _check_versions(Cluster({}))


def test_an_address_is_checked_before_dask_looks_at_it():
    pytest.importorskip("distributed", reason="Dask is not installed: pip install suchus[cluster]")
    with pytest.raises(NoCluster, match="is no address"), connected("foo"):
        pass


def test_a_class_where_a_word_belongs_is_told_in_plain_words():
    for make in (
        lambda: Vary(field=object, values=(1.0,)),
        lambda: Vary(field=object, values=-(2**63)),
        lambda: Vary(field=object, values=()),
        lambda: Vary(field=object, low=1.0, high=0.1),
        lambda: Vary(field=object, low=-1.0, high=0.1, scale="log"),
        lambda: Vary(field=object, low=0.0, high=1.0, mean=0.5, spread=-1.0),
        lambda: Vary(field=object, low=0.0, high=1.0, each=True),
        lambda: Study(name="a", run=Run(robot="caiman", gait="belly_crawl"), vary=(), measure=(), design=object),
    ):
        with pytest.raises(InvalidDesign) as told:
            make()
        assert "<class" not in str(told.value)
