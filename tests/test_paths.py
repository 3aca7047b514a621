"""Every public function that takes a path takes it as a text too, and does the same with both."""

import inspect
import pkgutil
from collections.abc import Iterable, Sequence
from dataclasses import is_dataclass
from importlib import import_module
from pathlib import Path
from types import UnionType
from typing import Union, get_args, get_origin, get_type_hints

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import suchus
from evidence import atlas
from evidence.league.page import standings_of
from suchus import GAITS, ROBOTS, hardware
from suchus.animals import capture as captures
from suchus.apps import report
from suchus.core import files as record
from suchus.core.errors import SuchusError
from suchus.core.jobs import Store, conduct_sweep
from suchus.core.reading import read_bytes, read_mesh
from suchus.core.samples import sample
from suchus.core.writing import keep
from suchus.experiments import optimise, study
from suchus.hardware.emulator import Server
from suchus.robot import blueprint
from suchus.robot.gaits import gait_of
from suchus.sim.model.export import export
from suchus.sim.model.importing import import_robot
from suchus.swimming.coupling import Swim
from suchus.visual.figures import places
from suchus.visual.figures import save as save_figure
from suchus.visual.replay import save as save_replay
from wires import wiring

ROOMS = (
    *(module.name for module in pkgutil.walk_packages(suchus.__path__, "suchus.") if module.ispkg),
    "suchus.core.catalog", "suchus.core.reading", "suchus.core.writing",
)  # fmt: skip
ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]
RECORD = xr.Dataset({"x": ("time", [0.0, 1.0])}, {"time": [0.0, 0.1]})


def public_functions():
    """Yield the names and the functions of all rooms, the methods of their classes among them."""
    for room in ROOMS:
        module = import_module(room)
        for name in getattr(module, "__all__", [name for name in vars(module) if not name.startswith("_")]):
            value = getattr(module, name)
            if inspect.isfunction(value):
                yield f"{room}.{name}", value
            elif inspect.isclass(value) and value.__module__.startswith("suchus."):
                for method, function in vars(value).items():
                    made = method == "__init__" and not is_dataclass(value)
                    if inspect.isfunction(function) and (made or not method.startswith("_")):
                        yield f"{room}.{name}.{method}", function


def alternatives(hint):
    """Return what a parameter may be, or the elements of its sequence."""
    origin, parts = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return [kind for part in parts for kind in alternatives(part)]
    return alternatives(parts[0]) if origin in (tuple, list, Sequence, Iterable) else [hint]


def path_functions():
    functions = {}
    for name, function in public_functions():
        if "Path" in str(inspect.signature(function)):
            hints = get_type_hints(inspect.unwrap(function))
            hints.pop("return", None)
            paths = [kinds for kinds in map(alternatives, hints.values()) if Path in kinds]
            if paths:
                functions[name] = all(str in kinds for kinds in paths)
    return functions


def test_whatever_takes_a_path_says_that_it_takes_a_text():
    """Mypy then refuses a function that asks a text for what only a path has."""
    functions = path_functions()
    assert len(functions) > 60
    assert not [name for name, honest in functions.items() if not honest]


@pytest.fixture(scope="module")
def walk():
    return captures.observe(captures.read_tracks(sample("lizard")))


def written(at):
    """Write a study, a search and tables of joint angles, as far as ``at`` names them, and return the folder."""
    files = {
        "study.toml": 'name = "s"\nvary = [{field = "gait.stroke", low = 0.1, high = 0.2}]\nmeasure = ["slip"]\n'
        "samples = 2\n",
        "search.toml": 'name = "s"\nvary = [{field = "gait.stroke", low = 0.1, high = 0.2}]\n'
        'aims = [{name = "displacement"}]\n',
        "angles.csv": "time,a\n" + "".join(f"{k / 40},{np.sin(k)}\n" for k in range(40)),
        "data.json": "[]",
        "text.toml": "a = 1",
        "gait.toml": "stroke = 0.1\nbase = 'belly_crawl'\n",
        "robot.toml": "base = 'caiman'\n",
    }
    for name, text in files.items():
        Path(at, name).write_text(text)


def drafted(new):
    with new as draft:
        (draft / "file" if draft.is_dir() else draft).touch()


WIRING = wiring()
CALLS = {
    "atlas.compute_all": lambda at, _: atlas.compute_all((), at("out"), jobs=1, quick=True),
    "atlas.load_outcome": lambda at, _: atlas.load_outcome(at("out"), "none"),
    "atlas.load_outcomes": lambda at, _: atlas.load_outcomes(at("out"), list(atlas.CASES.values())[:1]),
    "atlas.finished_outcome": lambda at, _: atlas.finished_outcome(
        next(iter(atlas.CASES.values())), at("out"), quick=True
    ),
    "atlas.save_outcome": lambda at, _: atlas.save_outcome(
        atlas.FlowOutcome(
            case="c", digest="", quick=True, cells=1.0, grid=1, failed="", seconds=0.0, curves={"a": np.ones(2)}
        ),
        at("out"),
    ),
    "blueprint.read_design": lambda at, _: blueprint.read_design(at("robot.toml"), type(ROBOT), ROBOTS),
    "blueprint.read_gait": lambda at, _: blueprint.read_gait(at("gait.toml"), ROBOT, GAITS),
    "blueprint.read_motors": lambda at, _: blueprint.read_motors(at("text.toml")),
    "blueprint.read_correction": lambda at, _: blueprint.read_correction(at("text.toml")),
    "blueprint.write": lambda at, _: blueprint.write(ROBOT, at("new.toml")),
    "capture.read_tracks": lambda at, _: captures.read_tracks(at("angles.csv")),
    "capture.read_angles": lambda at, _: captures.read_angles(at("angles.csv")),
    "capture.is_angle_table": lambda at, _: captures.is_angle_table(at("angles.csv")),
    "capture.write_table": lambda at, _: captures.write_table(captures.read_tracks(sample("lizard")), at("new.csv")),
    "capture.write_gait": lambda at, walk: captures.write_gait(
        captures.to_gait(walk, ROBOT, GAIT, name="new"), walk, at("new.toml")
    ),
    "catalog.Catalog.file": lambda at, _: ROBOTS.file("robot.toml", at("")),
    "catalog.Catalog.resolve": lambda at, _: ROBOTS.resolve("robot.toml", at("")),
    "coupling.Swim.go": lambda at, _: Swim.go(None, 0.1, checkpoint=at("text.toml")),
    "emulator.Server": lambda at, _: Server(type("None", (), {"lines": ()})(), (at("link"),)).ports,
    "figures.places": lambda at, _: places(at("new"), "figure"),
    "figures.save": lambda at, _: save_figure(Figure(), at("new"), "figure"),
    "gaits.gait_of": lambda at, _: gait_of(ROBOT, "gait.toml", at("")),
    "hardware.write_map": lambda at, _: hardware.write_map(hardware.straight(ROBOT), at("new.toml")),
    "hardware.read_map": lambda at, _: hardware.read_map(at("text.toml"), ROBOT),
    "hardware.write_wiring": lambda at, _: hardware.write_wiring(WIRING, at("new.toml")),
    "hardware.read_wiring": lambda at, _: (
        hardware.write_wiring(WIRING, Path(at("new.toml"))), hardware.read_wiring(at("new.toml"), ROBOT)
    ),
    "jobs.Store": lambda at, _: Store(at("new"), study.read_study(Path(at("study.toml")))).folder,
    "jobs.conduct_sweep": lambda at, _: conduct_sweep("s", print, (), at("new")),
    "league.standings_of": lambda at, _: standings_of(at("data.json")),
    "model.export": lambda at, _: export(ROBOT, GAIT, at("new"), "urdf"),
    "model.import_robot": lambda at, _: import_robot(at("text.toml"), name="new"),
    "optimise.read_optimisation": lambda at, _: optimise.read_optimisation(at("search.toml")),
    "optimise.optimise": lambda at, _: optimise.optimise(
        optimise.read_optimisation(Path(at("search.toml"))), at("text.toml/new")
    ),
    "record.load": lambda at, _: (record.save(RECORD, Path(at("new.nc"))), record.load(at("new.nc")).sizes),
    "record.save": lambda at, _: record.save(RECORD, at("new.nc")),
    "record.write_tables": lambda at, _: record.write_tables(RECORD, at("new")),
    "record.check_file": lambda at, _: record.check_file(at("none")),
    "record.read_json": lambda at, _: record.read_json(at("data.json")),
    "record.read_text": lambda at, _: record.read_text(at("text.toml")),
    "record.read_toml": lambda at, _: record.read_toml(at("text.toml")),
    "record.there": lambda at, _: record.path_exists(at("text.toml")),
    "reading.read_bytes": lambda at, _: read_bytes(at("text.toml")),
    "reading.read_mesh": lambda at, _: read_mesh(at("text.toml")),
    "replay.save": lambda at, _: save_replay("page", at("new.html")),
    "report.check_place": lambda at, _: report.check_place(at("new")),
    "report.load_result": lambda at, _: report.load_result(at("data.json")),
    "report.write_outcome_page": lambda at, _: report.write_outcome_page(at("new")),
    "report.write_page": lambda at, _: report.write_page((), (), at("new.html")),
    "report.render_page": lambda at, _: report.render_page((), (), at("new")),
    "study.read_study": lambda at, _: study.read_study(at("study.toml")),
    "study.conduct": lambda at, _: study.conduct(study.read_study(Path(at("study.toml"))), at("text.toml/new")),
    "study.answer_finished": lambda at, _: study.answer_finished(study.Claims(), at("new")),
    "writing.keep": lambda at, _: keep(at("new"), b"data"),
    "writing.check_writable": lambda at, _: record.check_writable(at("text.toml/new")),
    "writing.check_replaceable": lambda at, _: record.check_replaceable(at("text.toml")),
    "writing.new_file": lambda at, _: drafted(record.new_file(at("new"))),
    "writing.new_folder": lambda at, _: drafted(record.new_folder(at("new"))),
    "writing.remove_leftovers": lambda at, _: record.remove_leftovers(at("new")),
    "writing.write": lambda at, _: record.write(at("new"), "text"),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_a_text_does_what_a_path_does(name, tmp_path, walk, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def answer(kind):
        base = tmp_path / kind.__name__
        base.mkdir()
        written(base)
        try:
            value = CALLS[name](lambda file: kind(base / file), walk)
        except SuchusError as error:
            value = str(error)
        files = sorted(str(path.relative_to(base)) for path in base.rglob("*"))
        return repr(value).replace(str(base), "BASE"), files

    assert answer(str) == answer(Path)
