import subprocess
import sys

import pytest

import suchus
from suchus.core.catalog import Catalog
from suchus.core.errors import InvalidDesign, UnknownName


@pytest.fixture
def shelf(tmp_path, monkeypatch):
    package = tmp_path / "shelf_under_test"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "good.py").write_text("thing = 7\n")
    (package / "empty.py").write_text("")
    (package / "wrong.py").write_text("thing = 'seven'\n")
    (package / "_hidden.py").write_text("raise RuntimeError('imported')\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield Catalog("thing", "shelf_under_test", "builtins:int")
    for name in [name for name in sys.modules if name.startswith("shelf_under_test")]:
        del sys.modules[name]


def test_listing_reads_names_and_imports_no_module(shelf):
    assert list(shelf) == ["empty", "good", "wrong"]
    assert ["good"] not in shelf
    assert "shelf_under_test.good" not in sys.modules


def test_a_module_is_its_declaration(shelf):
    assert shelf["good"] == 7


def test_unknown_name_lists_the_shelf_and_the_nearest(shelf):
    with pytest.raises(UnknownName, match=r"no thing named 'goood'; there is empty, good, wrong\. Did you mean 'good'"):
        shelf["goood"]
    with pytest.raises(KeyError):
        shelf["nothing"]


@pytest.mark.parametrize(("name", "found"), [("empty", "nothing"), ("wrong", "a str")])
def test_a_module_without_its_declaration_is_named(shelf, name, found):
    with pytest.raises(InvalidDesign, match=rf"{name}\.py must declare `thing`, a int, but declares {found}"):
        shelf[name]


def test_a_folder_declares_in_modules_of_their_names_and_each_is_read_alone(shelf, tmp_path):
    folder = tmp_path / "shelf_under_test" / "large"
    folder.mkdir()
    (folder / "__init__.py").write_text("SIZES = (9,)\n")
    (folder / "thing.py").write_text("thing = 8\n")
    (folder / "parts.py").write_text("PARTS = (1, 2)\n")
    assert shelf.beside("large", "PARTS", (), module="parts") == (1, 2)
    assert shelf.beside("large", "PARTS", ()) == ()
    assert shelf.beside("large", "SIZES", (), module="of_no_file") == (9,)
    assert shelf.beside("large", "SIZES", ()) == (9,)
    assert shelf.beside("large", "NOTHING", ()) == ()
    assert "shelf_under_test.large.thing" not in sys.modules
    assert shelf["large"] == 8
    (folder / "thing.py").write_text("thing = 'eight'\n")
    del sys.modules["shelf_under_test.large.thing"]
    with pytest.raises(InvalidDesign, match=r"large/thing\.py must declare `thing`, a int, but declares a str"):
        shelf["large"]


def test_a_shelf_of_classes_wants_classes_and_a_shelf_of_values_values(shelf, tmp_path):
    package = tmp_path / "shelf_under_test"
    (package / "a_class.py").write_text("thing = bool\n")
    classes = Catalog("thing", "shelf_under_test", "builtins:int", classes=True)
    assert classes["a_class"] is bool
    with pytest.raises(InvalidDesign, match=r"good\.py must declare `thing`, a subclass of int, but declares a int"):
        classes["good"]
    with pytest.raises(InvalidDesign, match=r"a_class\.py must declare `thing`, a int, but declares a type"):
        shelf["a_class"]


def test_every_public_name_can_be_had():
    for name in suchus.__all__:
        assert getattr(suchus, name) is not None
    with pytest.raises(AttributeError, match="has no 'crawll'"):
        suchus.crawll  # noqa: B018


def test_importing_suchus_imports_nothing_heavy():
    code = "import sys, suchus; print([m for m in ('numpy', 'mujoco', 'matplotlib', 'xarray') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
