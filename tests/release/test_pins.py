"""What the make targets install is pinned to digests, which pip compares; every package's licence can be told."""

import hashlib
import re
import subprocess
import sys
import zipfile

import pytest

import licences
from needs import needs
from pins import PLACES
from release.environment import ROOT, pins

DIGEST = re.compile(r"[\w.-]+==[\w.]+( ; [^\n]+)?( \\\n {4}--hash=sha256:[0-9a-f]{64})+")


@pytest.mark.parametrize("place", PLACES, ids=["make", "release"])
def test_every_version_has_digests_and_nothing_has_an_address(place):
    asked = [line for line in (place / "constraints.txt").read_text("utf-8").splitlines() if "==" in line]
    text = (place / "pins.txt").read_text("utf-8")
    entries = pins(text)
    assert [entry for entry in entries.values() if not DIGEST.fullmatch(entry)] == []
    versions = {licences.plain(name): entry.split(" ")[0].partition("==")[2] for name, entry in entries.items()}
    assert versions == {licences.plain(n): v for n, _, v in (line.partition("==") for line in asked)}
    assert "://" not in text + "".join(asked)
    assert {"pip", "hatchling", "hatch-fancy-pypi-readme"} <= entries.keys()  # the back end and what installs it


def test_what_is_needed_is_what_the_project_says():
    project = {
        "dependencies": ["a>=1"],
        "optional-dependencies": {"b": ["b", "a>=1"], "c": ["suchus[b,d]", "c; python_version > '3'"], "d": ["d"]},
    }
    assert needs(project, []) == ["a>=1"]
    assert needs(project, ["c", "b"]) == ["a>=1", "b", "d", "c; python_version > '3'"]
    with pytest.raises(KeyError, match="e"):
        needs(project, ["e"])


@pytest.fixture
def offered(tmp_path):
    """A package that an index offers, and what pip says when it is asked to install it with the Makefile's options."""
    wheel = tmp_path / "thing-1.0-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as opened:
        opened.writestr("thing-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: thing\nVersion: 1.0\n")
        opened.writestr("thing-1.0.dist-info/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        opened.writestr("thing-1.0.dist-info/RECORD", "")
    options = re.search(r"^NEEDED := (.*)$", (ROOT / "Makefile").read_text("utf-8"), re.M)[1]

    def told(pinned):
        (tmp_path / "pins.txt").write_text(pinned)
        (tmp_path / ".venv").mkdir(exist_ok=True)
        (tmp_path / ".venv" / "needs.txt").write_text("thing>=1\n")
        words = ["-m", "pip", "install", "--dry-run", "--no-index", "--find-links", str(tmp_path), *options.split()]
        done = subprocess.run([sys.executable, *words], cwd=tmp_path, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return hashlib.sha256(wheel.read_bytes()).hexdigest(), told


def test_pip_takes_what_has_the_digest_and_nothing_else(offered):
    digest, told = offered
    assert told(f"thing==1.0 --hash=sha256:{digest}\n")[0] == 0
    other, unpinned = f"thing==1.0 --hash=sha256:{digest[::-1]}\n", ""
    for pinned, said in ((other, "DO NOT MATCH"), (unpinned, "must have their versions")):
        code, words = told(pinned)
        assert (code, said in words) == (1, True), words


@pytest.mark.parametrize(
    ("metadata", "said"),
    [
        ({"license_expression": "MIT", "license": "Expat"}, "MIT"),
        ({"classifier": ["License :: OSI Approved :: ISC License (ISCL)", "Topic :: X"]}, "ISC License (ISCL)"),
        ({"license": "BSD\n\nRedistribution and use ...", "classifier": []}, "BSD"),
        ({"license": "  "}, ""),
        ({}, ""),
    ],
)
def test_a_licence_is_read_where_packages_say_it(metadata, said):
    assert licences.licence(metadata) == said


def test_the_table_says_whose_each_package_is_and_which_says_nothing():
    found = [{"name": "B_b", "version": "2"}, {"name": "a", "version": "1", "license": "MIT"}]
    rows, silent = licences.table(found, {"all": {"a"}, "dev": {"b-b"}})
    assert rows[2:] == ["| a | 1 | MIT | all |", "| B_b | 2 | **none said** | dev |"]
    assert silent == ["B_b"]
