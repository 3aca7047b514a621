"""What all tests share: shapes that are checked, hypothesis without deadlines, the same examples every time."""

import fcntl
import gc
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr
from _pytest.pathlib import import_path
from hypothesis import settings
from jaxtyping import install_import_hook

import first_calls
import programs as programs_of_tests
from batteries import counted  # noqa: F401  a fixture
from busy_threads import busy_threads
from left_out import COLLECTED

CHECKED = (
    "suchus.robot.kinematics",
    "suchus.robot.motion.axis",
    "suchus.robot.motion.movement",
    "suchus.robot.motion.limits",
    "suchus.robot.control",
    "suchus.sim.metrics",
)
"""Rooms whose arrays' shapes are checked in the first calls of each test; production pays nothing."""
assert not {*CHECKED} & {*sys.modules}, "imported before their shapes can be checked"
install_import_hook(CHECKED, "first_calls.checked")  # jaxtyping's own option comes too late for us before its 0.3.6

from suchus.experiments.catalog import EXPERIMENTS  # noqa: E402
from suchus.experiments.experiment import Outcome  # noqa: E402
from suchus.robot import blueprint  # noqa: E402
from suchus.robot.design import Robot, crocodile  # noqa: E402
from suchus.robot.gaits import GAITS  # noqa: E402
from suchus.robot.motion import Gait  # noqa: E402
from suchus.robot.robots import ROBOTS  # noqa: E402

gc.disable()  # until all tests are collected: modules stay, and the search for garbage takes a fifth of their import
signal.signal(signal.SIGHUP, signal.SIG_DFL)
"""Processes that tests start get the default: under nohup they would inherit an ignored hang-up and not stop on it."""
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:  # as where a shell started the tests in the background
    signal.signal(signal.SIGINT, signal.default_int_handler)
if "PYTEST_XDIST_WORKER" in os.environ:  # there are as many workers as cores
    os.environ.setdefault("SUCHUS_THREADS", "1")
xr.set_options(use_numbagg=False, use_bottleneck=False)  # as on the command line; numbagg compiles for half a minute
EXAMPLES = int(os.environ.get("SUCHUS_EXAMPLES", "40"))
"""How many examples a property is tried with, unless it says otherwise; ``make test-all`` takes 100 [-]."""
settings.register_profile("suchus", deadline=None, derandomize=True, max_examples=EXAMPLES)
settings.load_profile("suchus")


def pytest_collection(session: pytest.Session) -> None:
    """Let each worker begin with other files where all are collected, so that two compile no file at a time."""
    worker = getattr(session.config, "workerinput", None)
    if worker and session.config.args_source is pytest.Config.ArgsSource.TESTPATHS:
        files = sorted(Path(__file__).parent.rglob("test_*.py"))
        begin = int(worker["workerid"].removeprefix("gw")) * len(files) // worker["workercount"]
        for file in files[begin:] + files[:begin]:
            with suppress(Exception, pytest.skip.Exception):  # told when it is collected
                import_path(file, root=session.config.rootpath, consider_namespace_packages=False)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    config.stash[COLLECTED] = tuple(items)  # before any are deselected


def pytest_collection_finish() -> None:
    gc.freeze()  # a million objects of modules and of tests stay: nothing looks through them again
    gc.enable()
    gc.set_threshold(100_000, 20, 50)  # looked for less often than in a program that has little memory


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup() -> None:
    first_calls.begin()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(nextitem: pytest.Item | None) -> Iterator[None]:
    """Fail the last test of a worker if a thread computes on: it did so beside many of the tests."""
    yield
    if nextitem is None and (names := busy_threads()):
        pytest.fail(f"a thread that some test began computes on: {', '.join(names)}")


@pytest.fixture(scope="session")
def robot() -> Robot:
    return ROBOTS["caiman"]


@pytest.fixture(scope="session")
def former() -> Robot:
    """Return the article's robot as it was before its servos were such as are sold."""
    return blueprint.read_design(Path(__file__).parents[1] / "examples" / "former_caiman.toml", Robot, ROBOTS)


@pytest.fixture(scope="session")
def crawl_gait() -> Gait:
    return GAITS["belly_crawl"]


@pytest.fixture(scope="session")
def limbs_gait() -> Gait:
    return GAITS["limbs_only"]


@pytest.fixture(scope="session")
def long_tail(robot: Robot) -> Robot:
    """A robot of another topology."""
    return crocodile(replace(robot.tables, name="long_tail", tail=replace(robot.tables.tail, joints=8, fin_segments=4)))


@pytest.fixture(scope="session")
def programs() -> Iterator[programs_of_tests.Programs]:
    """What runs programs of Python, each in a process of its own; the libraries are imported once for all."""
    with programs_of_tests.started() as running:
        yield running


@pytest.fixture(scope="session")
def quick_outcome(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Outcome]:
    """The outcome of an experiment's quick form, run once for all workers and files of tests."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "quick_outcomes"
    folder.mkdir(exist_ok=True)
    kept: dict[str, Outcome] = {}

    def outcome(name: str) -> Outcome:
        if name not in kept:
            kept[name] = _made_once(folder / f"{name}.pickle", lambda: EXPERIMENTS[name].quick().run())
        return kept[name]

    return outcome


def _made_once(file: Path, make: Callable[[], Outcome]) -> Outcome:
    """Return what a file holds, made by the first who asks while the others wait."""
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not file.exists():
            draft = file.with_suffix(".draft")
            draft.write_bytes(pickle.dumps(make()))
            draft.replace(file)
        made: Outcome = pickle.loads(file.read_bytes())
        return made
