"""An outcome can be cited: BibTeX with version, commit and digests, and the article where it is the article's robot."""

import re
import subprocess

from suchus.apps.report import load_result, render_outcome_page, save_outcome
from suchus.apps.report.outcome_page import citation
from suchus.core.files import commit_of, provenance
from suchus.experiments.catalog import EXPERIMENTS
from suchus.visual.pages import tied

OUTCOME = {
    "experiment": "swim_free",
    "title": "Does 100% of it swim?",
    "settings": {"robot": {"name": "floating_caiman"}},
    "provenance": {
        "config_hash": "0123456789abcdef" * 4, "versions": {"suchus": "0.2.0"}, "code": "d5f0761b6197",
        "commit": "0123456789+",
    },
}  # fmt: skip


def other(robot):
    return OUTCOME | {"settings": {"robot": {"name": robot}}}


def test_the_entry_has_version_commit_code_and_settings():
    entry = citation(OUTCOME).partition("\n\n")[0]
    assert entry == (
        "@software{suchus_swim_free,\n"
        "  author = {{The suchus developers}},\n"
        "  title = {suchus: Does 100\\% of it swim?},\n"
        "  version = {0.2.0},\n"
        "  note = {Experiment swim\\_free, robot floating\\_caiman; commit 0123456789+; code d5f0761b6197; "
        "settings 0123456789abcdef}\n}"
    )


def test_the_article_is_cited_for_its_robot_alone():
    assert "author = {Jun Wang and Jingya Zheng and Yuhang Zhao and Kai Yang}" in citation(OUTCOME)
    assert "@article" in citation(OUTCOME | {"settings": {}})
    assert "@article" not in citation(other("strider"))


def test_what_an_older_outcome_lacks_is_left_out():
    old = citation(OUTCOME | {"provenance": {"config_hash": "a" * 64}})
    assert "version" not in old
    assert "commit" not in old
    assert "settings aaaaaaaaaaaaaaaa}" in old


def test_pages_of_other_robots_name_no_part_of_the_article(quick_outcome, tmp_path):
    experiment = EXPERIMENTS["leg_kinematics"].quick()
    folder = save_outcome(quick_outcome("leg_kinematics"), {}, experiment, tmp_path / "a", command="suchus run a")
    page = render_outcome_page(load_result(folder))
    assert tied(experiment.shows) in page.partition("<h1>")[0]
    assert f"commit {provenance({}, seconds=0.0)['commit']}" in page
    text = (folder / "outcome.json").read_text()
    (folder / "outcome.json").write_text(text.replace('"name": "caiman"', '"name": "strider"'))
    page = render_outcome_page(load_result(folder))
    assert tied(experiment.shows) not in page.partition("<h1>")[0]
    assert "@article" not in page


def test_the_commit_is_that_of_the_checkout_and_marks_changed_files(tmp_path):
    def git(*words):
        return subprocess.run(["git", "-C", tmp_path, *words], capture_output=True, text=True, check=True).stdout

    assert commit_of(tmp_path) == ""
    git("init", "--quiet")
    (tmp_path / "src").mkdir()
    (tmp_path / "src/a.py").write_text("")
    git("add", "src")
    git("-c", "user.name=a", "-c", "user.email=a@b", "commit", "--quiet", "-m", "a")
    assert commit_of(tmp_path, "src") == git("rev-parse", "--short=10", "HEAD").strip()
    (tmp_path / "b.py").write_text("")
    assert "+" not in commit_of(tmp_path, "src")
    (tmp_path / "src/a.py").write_text("c = 1\n")
    assert re.fullmatch(r"[0-9a-f]{10}\+", commit_of(tmp_path, "src"))


def test_without_git_there_is_no_commit(tmp_path, monkeypatch):
    (tmp_path / ".git").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path))
    assert commit_of(tmp_path) == ""
