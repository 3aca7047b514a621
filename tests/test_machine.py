"""The last bits: told by computing, refused where they differ, the same on imitated processors where asked for."""

import hashlib
import json
import os
import platform
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
import xarray as xr

from suchus.core import machine
from suchus.core.errors import IncompatibleRecord, OutsideLimits
from suchus.core.files import provenance
from suchus.core.files.provenance import has_same_provenance
from suchus.core.jobs.store import MARK, Store

LINUX = pytest.mark.skipif(
    (platform.machine(), platform.libc_ver()[0]) != ("x86_64", "glibc"), reason="portable arithmetic is for x86-64"
)
WITHOUT_FMA = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "SandyBridge",
}
"""Environment in which the libraries compute as on a processor of 2011."""
TOLD = "import json; from suchus.core import machine; print(json.dumps(machine.arithmetic()))"


@dataclass(frozen=True)
class Asked:
    """What the parts of a store are of."""

    name: str = "strokes"


PARTS = [xr.Dataset({"far": ("sample", [float(n)]), "error": ("sample", [""])}, {"sample": [n]}) for n in range(2)]


def conduct(folder, missing=(0, 1)):
    """Finish a store as a study does, and return its results."""
    with Store(folder, Asked()).opened() as store:
        for number in missing:
            store.put(number, PARTS[number])
        return store.gather(2)


@pytest.fixture
def elsewhere(monkeypatch):
    """Make this process believe that it computes as another machine does."""

    def become():
        monkeypatch.setattr(machine, "arithmetic", lambda: other)

    other = machine.arithmetic() | {"linear algebra": "0" * 12}
    return become


def in_a_process(code, *, before=(), **environment):
    clean = {
        name: value for name, value in os.environ.items() if name not in (*machine.PORTABLE, machine.PORTABLE_VARIABLE)
    }
    done = subprocess.run(
        [*before, sys.executable, "-c", code], env=clean | environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_a_machine_computes_as_itself():
    assert machine.differences(machine.arithmetic()) == []
    assert json.loads(in_a_process(TOLD, **{k: os.environ[k] for k in machine.PORTABLE if k in os.environ})) == (
        machine.arithmetic()
    )


@LINUX
def test_each_library_that_takes_other_routines_is_seen():
    """A part changes with the library that makes it, and what MuJoCo and Python call changes with the C library."""
    here = json.loads(in_a_process(TOLD))
    there = json.loads(in_a_process(TOLD, **WITHOUT_FMA))
    if "fma" not in Path("/proc/cpuinfo").read_text(encoding="utf-8").split():
        pytest.skip("this processor has no fused multiply-add to do without")
    assert [part for part in here if here[part] != there[part]] == list(here)
    blas = json.loads(in_a_process(TOLD, OPENBLAS_CORETYPE="SandyBridge"))
    assert [part for part in here if here[part] != blas[part]] == ["linear algebra"]


@LINUX
@pytest.mark.skipif(shutil.which("qemu-x86_64") is None, reason="qemu-user is not installed")
@pytest.mark.battery("imitated processors")
@pytest.mark.slow("emulated processors")
def test_portable_arithmetic_is_the_same_on_emulated_processors(counted):
    """Whole processors, not settings of libraries: without the settings they differ, with them they do not."""
    of = [("qemu-x86_64", "-cpu", cpu) for cpu in ("SandyBridge", "Haswell")]
    plain = [in_a_process(TOLD, before=one) for one in of]
    portable = [in_a_process(TOLD, before=one, **machine.PORTABLE) for one in (*of, ())]
    assert plain[0] != plain[1]
    assert len(set(portable)) == 1
    counted(len(of))


@LINUX
@pytest.mark.battery("imitated processors")
@pytest.mark.slow("imitated processors: four studies, in processes of their own")
def test_a_portable_study_has_the_same_bytes_on_two_imitated_processors(tmp_path, counted):
    file = tmp_path / "s.toml"
    file.write_text(
        'name = "s"\nrobot = "caiman"\ngait = "belly_crawl"\nduration = 2.0\ntimestep = 0.01\n'
        'measure = ["displacement"]\n[[vary]]\nfield = "gait.stroke"\nlow = 0.1\nhigh = 0.3\nsteps = 2\n'
    )

    def digest(name, **environment):
        words = ["study", str(file), "--out", name]
        in_a_process(f"from suchus.apps.cli.entry import main; assert main({words!r}) == 0", **environment)
        return hashlib.sha256((tmp_path / name / "results.nc").read_bytes()).hexdigest()

    names = [str(tmp_path / name) for name in "abcd"]
    assert digest(names[0]) != digest(names[1], **WITHOUT_FMA)
    assert digest(names[2], **machine.PORTABLE) == digest(names[3], **(WITHOUT_FMA | machine.PORTABLE))
    counted(2)


def test_a_store_of_another_arithmetic_is_refused_and_its_parts_are_named(tmp_path, elsewhere):
    conduct(tmp_path / "s")
    before = (tmp_path / "s" / MARK).read_bytes()
    elsewhere()
    with pytest.raises(IncompatibleRecord, match=r"whose linear algebra give other last bits .*--mixed"):
        conduct(tmp_path / "s")
    assert (tmp_path / "s" / MARK).read_bytes() == before


def test_a_store_that_may_be_mixed_is_continued_and_says_so(tmp_path, elsewhere):
    conduct(tmp_path / "s")
    own = machine.arithmetic()
    elsewhere()
    with machine.mixing():
        results = conduct(tmp_path / "s", missing=[1])
    machines = json.loads(results.attrs["machines"])
    assert [one["arithmetic"]["linear algebra"] for one in machines] == [own["linear algebra"], "0" * 12]
    assert Store(tmp_path / "s", Asked()).machines() == machines
    conduct(tmp_path / "s")  # both are known now


def test_results_of_one_machine_name_none(tmp_path):
    assert "machines" not in conduct(tmp_path / "s").attrs


def test_a_store_of_before_is_of_an_unnamed_machine(tmp_path):
    conduct(tmp_path / "s")
    mark = tmp_path / "s" / MARK
    said = json.loads(mark.read_text())
    del said["machines"]
    mark.write_text(json.dumps(said))
    with pytest.raises(IncompatibleRecord, match="a machine that is not named"):
        conduct(tmp_path / "s")


def test_an_outcome_of_another_arithmetic_is_computed_anew(elsewhere):
    stored = provenance({"seed": 1}, seconds=2.0)
    assert has_same_provenance(stored, {"seed": 1})
    assert not has_same_provenance({name: value for name, value in stored.items() if name != "machine"}, {"seed": 1})
    elsewhere()
    assert not has_same_provenance(stored, {"seed": 1})


@LINUX
def test_a_process_is_begun_anew_once_and_only_where_it_is_asked_for():
    anew = machine.portable_environment({"HOME": "/x", machine.PORTABLE_VARIABLE: "1"})
    assert anew == {"HOME": "/x", machine.PORTABLE_VARIABLE: "1", **machine.PORTABLE}
    assert machine.portable_environment(anew) is None
    assert machine.portable_environment({"HOME": "/x"}) is None
    assert machine.portable_environment({machine.PORTABLE_VARIABLE: "0"}) is None
    with pytest.raises(OutsideLimits, match="SUCHUS_PORTABLE is 'yes'; 1 asks"):
        machine.portable_environment({machine.PORTABLE_VARIABLE: "yes"})


def test_another_kind_of_machine_says_that_it_cannot(monkeypatch):
    monkeypatch.setattr(platform, "machine", lambda: "arm64")
    with pytest.raises(OutsideLimits, match="this is arm64"):
        machine.portable_environment({machine.PORTABLE_VARIABLE: "1"})


@LINUX
def test_the_command_begins_itself_anew():
    clean = {name: value for name, value in os.environ.items() if name not in machine.PORTABLE}
    done = subprocess.run(
        [sys.executable, "-m", "suchus", "doctor", "--help"],
        env=clean | {machine.PORTABLE_VARIABLE: "sometimes"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "SUCHUS_PORTABLE is 'sometimes'" in done.stderr
