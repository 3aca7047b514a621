"""Results know when they are old: a comment makes none old, a change of behaviour makes the right ones old."""

import json
import os
import shutil
from dataclasses import replace

import pytest

from evidence import source, stale, store
from evidence.registry import RESULTS, Kept
from evidence.stale import Status, status, table, with_parts
from evidence.store import ROOT, Origin, StoredResult, save
from evidence.tolerance import bounded

KEPT = Kept(name="strokes", modules=("suchus.flow.output",), probe=lambda: {"speed": 0.1}, renew="make strokes")


@pytest.fixture
def package(tmp_path):
    """Return a copy of the package that a test may change."""
    return shutil.copytree(source.PACKAGE, tmp_path / "suchus", ignore=shutil.ignore_patterns("__pycache__"))


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Keep a result of today's code, and return how it is made."""
    monkeypatch.setattr(store, "RESULTS", tmp_path / "results")
    code = source.digest(source.reached(KEPT.modules))
    save(StoredResult(name="strokes", values={}, origin=Origin.here(90.0), source=code, probe=bounded({"speed": 0.1})))
    return KEPT


def edit(package, file, before, after):
    """Change a source of a copy of the package, once."""
    text = (package / file).read_text(encoding="utf-8")
    assert text.count(before) == 1, file
    (package / file).write_text(text.replace(before, after), encoding="utf-8")


def test_a_comment_makes_nothing_old(kept, package):
    text = (package / "flow/output.py").read_text(encoding="utf-8")
    (package / "flow/output.py").write_text(f"# A comment.\n{text}\n# Another.\n", encoding="utf-8")
    assert status(kept, package=package).reason == "the same code"


def test_other_code_that_does_the_same_is_current_and_without_a_probe_possibly_old(kept, package):
    (package / "flow/output.py").write_text("UNUSED = 1\n" + (package / "flow/output.py").read_text(encoding="utf-8"))
    assert status(kept, package=package).state == "current"
    assert status(kept, package=package).reason == "other code that does the same"
    assert status(kept, package=package, by_probe=False).state == "possibly old"
    assert status(replace(kept, probe=None), package=package).state == "possibly old"


def test_a_probe_that_gives_other_numbers_makes_it_old_and_says_which(kept, package):
    (package / "flow/output.py").write_text("UNUSED = 1\n" + (package / "flow/output.py").read_text(encoding="utf-8"))
    answer = status(replace(kept, probe=lambda: {"speed": 0.2}), package=package)
    assert (answer.state, answer.seconds) == ("old", 90.0)
    assert answer.reason == "its probe gives 1 other number, as speed 0.2 for 0.1"


def test_a_probe_that_cannot_run_is_not_checked_here(kept, package):
    def lacking():
        raise ModuleNotFoundError("No module named 'cma'")

    (package / "flow/output.py").write_text("UNUSED = 1\n" + (package / "flow/output.py").read_text(encoding="utf-8"))
    answer = status(replace(kept, probe=lacking), package=package)
    assert answer.state == "not checked here"
    assert "cannot run on this machine: ModuleNotFoundError: No module named 'cma'" in answer.reason


def test_a_damaged_file_is_not_checked_here(kept, package):
    store.path_of("strokes").write_text("{")
    assert status(kept, package=package).state == "not checked here"
    assert "is damaged" in status(kept, package=package).reason


def answer(name, state):
    return Status(name=name, state=state, reason="so", seconds=60.0, renew=f"make {name}")


def test_a_result_is_as_old_as_what_it_is_made_of():
    parts = [answer("claims", "current"), answer("verdicts", "current"), answer("turning", "old")]
    assert [one.state for one in with_parts(parts)] == ["current", "old", "old"]
    assert with_parts(parts)[1].reason == "turning, of which it is made, is"


def test_the_table_says_what_is_old_and_what_it_costs():
    text = table([answer("claims", "current"), answer("turning", "old"), answer("terrain", "possibly old")])
    assert "claims" not in text
    assert "1 of 3 results are not old. The others take 2 min of processor time." in text
    assert "make turning" in text


def test_a_wrong_name_is_refused(capsys):
    assert stale.main(["strokes"]) == 2
    assert "There is no result named 'strokes'" in capsys.readouterr().err


WALKS = ("gallop_limits", "salamander", "turning", "working_space")
"""Experiments whose quick form takes a second or two and reaches no compiled kernel."""


@pytest.fixture(scope="module")
def today(tmp_path_factory, quick_outcome):
    """Return a folder of results that the code of today made."""
    folder = tmp_path_factory.mktemp("results")
    for name in WALKS:
        code = source.digest(source.reached(RESULTS[name].modules))
        probe = bounded({key: float(measure.value) for key, measure in quick_outcome(name).measures.items()})
        save(StoredResult(name=name, values={}, origin=Origin.here(1.0), source=code, probe=probe), folder)
    return folder


def old_after(programs, package, results, names):
    """Return the results in a folder that are old by a changed copy of the package, in a process of its own."""
    words = "import json, pathlib, sys; from evidence import stale, store; store.RESULTS = pathlib.Path(sys.argv[1]); "
    words += "print(json.dumps([one.name for one in stale.check(sys.argv[2:]) if one.state != 'current']))"
    paths = os.pathsep.join([str(package.parent), str(ROOT)])
    environment = os.environ | {"PYTHONPATH": paths}
    done = programs.run(["-c", words, results, *names], cwd=package.parent, environment=environment)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_a_comment_in_every_module_makes_no_result_old(package):
    roots = sorted({kept.modules for kept in RESULTS.values() if kept.modules})
    before = [source.digest(source.reached(modules)) for modules in roots]
    for file in package.rglob("*.py"):
        file.write_text(f"# A comment.\n{file.read_text(encoding='utf-8')}", encoding="utf-8")
    assert [source.digest(source.reached(modules), package) for modules in roots] == before


@pytest.mark.parametrize(
    ("file", "before", "after", "old"),
    [
        ("robot/robots/caiman.py", "kp=40.0, ", "kp=28.0, ", ["gallop_limits", "turning"]),
        (
            "sim/metrics/progress.py",
            "return com.isel(time=-1) - com",
            "return com.isel(time=9) - com",
            ["gallop_limits", "salamander"],
        ),
    ],
    ids=["a servo's gain", "a metric"],
)
def test_a_change_of_behaviour_makes_old_what_it_moves_and_nothing_else(
    programs, package, today, file, before, after, old
):
    edit(package, file, before, after)
    assert old_after(programs, package, today, WALKS) == old


@pytest.mark.slow("the kernels of the flow are compiled anew, for a changed copy of the package")
def test_another_offset_of_the_wall_makes_flows_old_and_nothing_else(programs, package, today):
    for name in ("snakes", "walls"):
        code = source.digest(source.reached(RESULTS[name].modules))
        save(
            StoredResult(name=name, values={}, origin=Origin.here(1.0), source=code, probe=RESULTS[name].bounded()),
            today,
        )
    edit(package, "flow/immerse.py", "return float(0.66 * spread**0.4)", "return float(0.33 * spread**0.4)")
    assert old_after(programs, package, today, ("snakes", "walls", *WALKS)) == ["snakes", "walls"]
