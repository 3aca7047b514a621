"""Where compiled kernels are kept: with their sources, in a place that can be written."""

import ast
import importlib.util
import math
import random
import sys
from pathlib import Path

import numba
import pytest
from numba.core.caching import _CacheLocator

from suchus.core import kernel_cache
from suchus.flow import compiled
from suchus.sim.hydro import vectors

ROOM = Path(compiled.__file__).parent
MAKERS = {"compiled", "threaded", "kernel_part", "threaded_part"}


def decorated(file):
    """Whether a file makes kernels, as its syntax says."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    calls = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
    marks = [mark for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) for mark in node.decorator_list]
    return any(isinstance(one, ast.Name) and one.id in MAKERS for one in [*calls, *marks])


def test_every_file_with_kernels_counts():
    counted = set(compiled.kernel_files())
    assert {file for file in ROOM.glob("*.py") if decorated(file)} <= counted
    assert ROOM / "record.py" not in counted


@pytest.fixture
def room(tmp_path, monkeypatch):
    """A room with two kernel files, of which one calls the other, and one without."""
    here = tmp_path / "a room"
    here.mkdir()
    (here / "a.py").write_text(
        "from suchus.flow.compiled import (\n    PAD,\n    kernel_part,\n)\n\n@kernel_part\ndef f(x):\n    return x\n"
    )
    (here / "b.py").write_text("from suchus.flow.compiled import compiled\nfrom a import f\n")
    (here / "c.py").write_text("from suchus.flow.compiled import PAD\n")
    monkeypatch.setattr(compiled, "_SOURCE_FOLDER", here)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "the user's"))
    return here


def test_an_edit_of_a_kernel_that_others_call_is_another_folder(room):
    before = compiled.folder()
    assert before.parent == room / "__pycache__"
    (room / "c.py").write_text("from suchus.flow.compiled import PAD, UNIT\n")
    assert compiled.folder() == before
    (room / "a.py").write_text((room / "a.py").read_text().replace("return x", "return 2 * x"))
    assert compiled.folder() != before
    assert before.is_dir()


def test_the_forces_of_water_have_such_a_folder_too(tmp_path, monkeypatch):
    (tmp_path / "table.py").write_text("AIR_FRACTION = 6\n")
    monkeypatch.setattr(vectors, "_SOURCES", tmp_path)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    before = vectors.folder()
    assert before.parent == tmp_path / "__pycache__"
    assert vectors.folder() == before
    (tmp_path / "table.py").write_text("AIR_FRACTION = 7\n")  # no kernel stands in this file
    assert vectors.folder() != before


def test_where_the_package_cannot_be_written_the_users_folder_is_taken(room, tmp_path):
    (room / "__pycache__").write_text("no folder")  # root may write everywhere, so that permissions would not do
    assert compiled.folder().parent == tmp_path / "the user's" / "suchus"


def test_where_nothing_can_be_written_there_is_none_and_it_is_said_once(room, monkeypatch, capsys):
    kernel_cache._say_unkept.cache_clear()
    (room / "__pycache__").write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null")
    assert compiled.folder() is compiled.folder() is None
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "compiled code is not kept" in told
    assert "NUMBA_CACHE_DIR" in told


def test_numbas_own_setting_comes_first_and_alone(room, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "asked"))
    assert compiled.folder().parent == tmp_path / "asked"
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/dev/null")
    assert compiled.folder() is None


def test_the_latest_few_states_are_kept_and_nothing_else_is_touched(room):
    (room / "__pycache__").mkdir()
    (room / "__pycache__" / "a.pyc").write_text("x")
    made = []
    for n in range(7):
        (room / "a.py").write_text(f"from suchus.flow.compiled import kernel_part\nN = {n}\n")
        made.append(compiled.folder())
    kept = [one for one in made if one.is_dir()]
    assert len(kept) == kernel_cache.MAX_SOURCE_STATES
    assert made[-1] in kept
    assert (room / "__pycache__" / "a.pyc").exists()


def test_without_a_home_there_is_still_an_answer(monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.delenv("HOME", raising=False)
    assert kernel_cache.user_cache().name == "suchus"


# --- damaged and foreign code ---------------------------------------------------------------------------------------


def test_code_of_a_module_that_is_gone_is_compiled_anew(tmp_path):
    files = kernel_cache.SealedFiles(str(tmp_path), "k", ("stamp",))
    for content, held in (
        (b"cmath\nsqrt\n.", math.sqrt),
        (b"cno_such_module\nf\n.", None),
        (b"cmath\nno_such_function\n.", None),
    ):
        (tmp_path / "k.nbi").write_bytes(files.sealed("k.nbi", content))
        assert files._read("k.nbi") is held


def test_a_number_that_means_another_signature_by_now_is_not_taken(tmp_path):
    """Two processes find no index, and both take the first number; or one is killed before it wrote the code."""
    one, other = (kernel_cache.SealedFiles(str(tmp_path), "k", "stamp") for _ in range(2))
    one.save("floats", "code for floats")
    (tmp_path / "k.nbi").write_bytes(b"damaged")
    other._save_index({"halves": other._data_name(1)})  # and here it is killed
    assert other.load("halves") is None
    other.save("halves", "code for halves")
    assert other.load("halves") == "code for halves"
    one._save_data(one._data_name(1), ("floats", "code for floats"))  # by who read the index before that
    assert other.load("halves") is None


def test_code_of_another_numba_is_not_unpickled(tmp_path, monkeypatch):
    files = kernel_cache.SealedFiles(str(tmp_path), "k", "stamp")
    files.save("floats", "code")
    monkeypatch.setattr(files, "_version", "0.1")
    assert files._read(files._data_name(1)) is None


@pytest.fixture
def kernel(tmp_path, monkeypatch):
    """Return a function that makes a kernel anew, as another process does, and calls it."""
    file = tmp_path / "a_kernel.py"
    file.write_text("def f(x):\n    return 3 * x + 1\n\n\ndef g(x):\n    return 5 * x\n")

    def call(name="f"):
        spec = importlib.util.spec_from_file_location("a_kernel", file)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "a_kernel", module)  # code that is kept names the module that it is of
        spec.loader.exec_module(module)
        made = numba.njit(getattr(module, name))
        kernel_cache.keep(made, tmp_path / "kept")
        return made(2), bool(made.stats.cache_hits)

    return call


def kept_files(tmp_path, end=""):
    return sorted(path for path in (tmp_path / "kept").rglob("*") if path.is_file() and path.suffix.endswith(end))


def test_code_is_kept_and_found(kernel, tmp_path):
    assert kernel() == (7, False)
    assert kernel() == (7, True)
    assert {path.suffix for path in kept_files(tmp_path)} == {".nbi", ".nbc"}


FLIPPED = [12, pytest.param(200, marks=pytest.mark.slow("200 kernels are compiled anew"))]


@pytest.mark.battery("flipped caches")
@pytest.mark.parametrize("count", FLIPPED)
def test_flipped_and_cut_caches_give_right_results_and_are_mended(kernel, tmp_path, count, counted):
    draw = random.Random(count)
    kernel()
    for i in range(count):
        path = draw.choice(kept_files(tmp_path))
        data = bytearray(path.read_bytes())
        if i % 4 == 3:
            data = data[: draw.randrange(len(data))]
        else:
            for bit in draw.sample(range(8 * len(data)), draw.choice((1, 2, 50))):  # twice the same would be none
                data[bit // 8] ^= 1 << bit % 8
        path.write_bytes(data)
        assert kernel() == (7, False), path
        assert kernel() == (7, True), "it was not mended"
        counted()


def test_what_another_wrote_is_never_unpickled(kernel, tmp_path):
    kernel()
    kernel("g")
    (first, second) = kept_files(tmp_path, ".nbc")
    second.write_bytes(first.read_bytes())  # whole, and of another kernel
    assert (kernel(), kernel("g")) == ((7, True), (10, False))
    assert kernel("g") == (10, True)
    for path in kept_files(tmp_path):
        path.write_bytes(b"cbuiltins\nexit\n(I1\ntR.")
    assert kernel() == (7, False)


def test_a_place_that_becomes_full_before_the_code_is_kept_is_a_sentence(kernel, monkeypatch, capsys):
    kernel_cache._say_unkept.cache_clear()
    made, looked = _CacheLocator.ensure_cache_path, []

    def full_the_second_time(self):
        looked.append(self)
        if len(looked) > 1:
            raise OSError(28, "No space left on device")
        made(self)

    monkeypatch.setattr(_CacheLocator, "ensure_cache_path", full_the_second_time)
    assert kernel() == (7, False)
    assert "compiled code is not kept" in capsys.readouterr().err


def test_a_place_that_takes_nothing_is_one_sentence(kernel, tmp_path, monkeypatch, capsys):
    def full(self, data):
        raise OSError(28, "No space left on device")

    kernel_cache._say_unkept.cache_clear()
    with monkeypatch.context() as disk:
        disk.setattr(Path, "write_bytes", full)
        assert kernel() == kernel() == (7, False)
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "compiled code is not kept" in told
    assert "no space left on device" in told
    assert not kept_files(tmp_path)
    assert (kernel(), kernel()) == ((7, False), (7, True))
