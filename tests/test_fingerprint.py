"""Whose code a fingerprint reads: the user's own, and no library's, wherever that is installed."""

import importlib
import sys
import tomllib
from copy import deepcopy
from dataclasses import fields, is_dataclass
from importlib.metadata import packages_distributions
from pathlib import Path
from pkgutil import iter_modules

import numpy as np
import pytest
from packaging.requirements import Requirement

from suchus import flow
from suchus.core import fingerprint as prints
from suchus.core.fingerprint import fingerprint

LIBRARY = """
import numpy as np
NEVER = np.timedelta64("NaT", "Y")
def gain(x):
    return x if NEVER else {gain} * x
"""
FOLDERS = {
    "user site": "home/.local/lib/python3.11/site-packages",
    "Debian": "usr/lib/python3/dist-packages",
    "a folder of PYTHONPATH": "opt/libraries",
}


def motion(time):
    return np.linalg.norm(np.interp(time, [0.0, 1.0], np.array([0.0, 2.0])))


@pytest.fixture
def library(tmp_path, monkeypatch):
    """Return what writes and imports a library with a gain into a folder, and returns a function that calls it."""
    monkeypatch.setitem(sys.modules, "foreign_library", None)  # so that it is gone afterwards
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def make(folder, gain, metadata=None):
        place = tmp_path / f"gain_{gain}" / folder
        place.mkdir(parents=True)
        (place / "foreign_library.py").write_text(LIBRARY.format(gain=gain))
        if metadata:
            (place / metadata).parent.mkdir()
            (place / metadata).write_text("foreign_library.py,,\n")
        with monkeypatch.context() as patch:
            patch.syspath_prepend(place)
            del sys.modules["foreign_library"]
            module = importlib.import_module("foreign_library")
            known = {"foreign_library": module, "__name__": "own"}
            exec("def use(x): return foreign_library.gain(x)", known)
            return fingerprint(known["use"])

    return make


@pytest.mark.parametrize("place", FOLDERS)
def test_numpy_is_a_library_wherever_it_lies(place, tmp_path, monkeypatch):
    usual = [fingerprint(value) for value in (motion, np.linalg.norm, np.float64, np.random.default_rng)]
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] == "numpy" and getattr(module, "__file__", None):
            inside = Path(module.__file__).relative_to(Path(np.__path__[0]))
            monkeypatch.setattr(module, "__file__", str(tmp_path / FOLDERS[place] / "numpy" / inside))
    assert [fingerprint(value) for value in (motion, np.linalg.norm, np.float64, np.random.default_rng)] == usual


@pytest.mark.parametrize("place", ["user site", "Debian"])
def test_what_lies_among_installed_packages_is_a_library(library, place):
    assert library(FOLDERS[place], 2) == library(FOLDERS[place], 3)


def test_what_a_distribution_records_is_a_library(library):
    record = "foreign_library-1.0.dist-info/RECORD"
    assert library("opt/libraries", 2, record) == library("opt/libraries", 3, record)


@pytest.mark.parametrize("metadata", [None, "foreign_library.egg-info/SOURCES.txt"])
def test_a_package_that_is_edited_is_the_users_own(library, metadata):
    """So are sources on PYTHONPATH, and those of editable installations, whose metadata lie elsewhere or beside."""
    assert library("lab", 2, metadata) != library("lab", 3, metadata)


def test_required_libraries_are_those_of_the_project():
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    required = {Requirement(text).name for text in project["dependencies"]}
    names = {name for name, owners in packages_distributions().items() if {o.lower() for o in owners} & required}
    assert {name for name in names if not name.startswith("_")} - {"pylab", "mpl_toolkits"} == {*prints.REQUIRED}


@pytest.mark.parametrize(("value", "other"), [
    (np.timedelta64("NaT", "Y"), np.timedelta64(1, "Y")), (np.timedelta64(1, "D"), np.timedelta64(1, "s")),
    (np.datetime64("2020"), np.datetime64("2021")), (1j, 2j), (np.complex64(1j), np.complex64(1)),
    (np.array([[1.0], None], dtype=object), np.array([[2.0], None], dtype=object)),
])  # fmt: skip
def test_values_of_every_kind_count(value, other):
    assert fingerprint(value) != fingerprint(other)
    assert fingerprint(value) == fingerprint(deepcopy(value))


@pytest.mark.parametrize(
    ("part", "digest"),
    [
        (flow.Capsule(arc_position=0.4, start=(0.0, 0.1), end=(0.2, 0.1), radius=0.02),
         "ed3cb7765773c812f7a8af6bdb1d96d7605c055274987e5a2cd2ca37a41f403d"),
        (flow.LinkPiece(link=0, shape=flow.Spherocylinder(length=0.3, radius=0.05), position=(0.1, 0.0, 0.0)),
         "cb34cf59935167fce50e0ecdb777e0c6abc7218f3a81e200b9f28c340e2d7fd6"),
    ],
    ids=["Capsule", "LinkPiece"],
)  # fmt: skip
def test_a_renamed_field_does_not_change_the_fingerprint(part, digest):
    """The digests were computed before the fields ``at`` and ``turn`` were renamed."""
    assert fingerprint(part) == digest


def test_former_names_belong_to_fields_of_today():
    classes = {kind.__qualname__: kind for kind in _dataclasses_of("suchus.flow")}
    for name, former_names in prints.FORMER_NAMES.items():
        names = {field.name for field in fields(classes[name])}
        assert set(former_names) <= names, name
        assert not names.intersection(former_names.values()), name


def _dataclasses_of(package):
    """Yield the dataclasses of all modules of a package."""
    for module in iter_modules(importlib.import_module(package).__path__, f"{package}."):
        values = vars(importlib.import_module(module.name)).values()
        yield from (value for value in values if isinstance(value, type) and is_dataclass(value))
