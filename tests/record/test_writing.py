"""Files belong to someone, and are there whole or not at all, whatever write, rename or fsync fails."""

import subprocess

import pytest
from tests.failing import KINDS, each_failing

from suchus.core import writing
from suchus.core.errors import Unwritable
from suchus.core.writing import MANIFEST, check_replaceable, keep, new_folder, replacing, write


def contents(folder):
    """What is in a folder, drafts and backups too, but for what suchus notes of it."""
    files = (file for file in folder.rglob("*") if file.is_file() and file.name != MANIFEST)
    return {str(file.relative_to(folder)): file.read_text() for file in files}


def result(place, **files):
    with new_folder(place) as draft:
        for name, text in files.items():
            write(draft / name, text)


def test_what_suchus_wrote_and_nobody_changed_is_replaced(tmp_path):
    for text in ("one", "two"):
        write(tmp_path / "page.html", text)
        result(tmp_path / "out", a=text, **{text: "x"})
    assert contents(tmp_path) == {"page.html": "two", "out/a": "two", "out/two": "x"}


@pytest.mark.parametrize("ours_before", [True, False])
def test_a_file_of_the_users_is_replaced_on_demand_only_and_then_kept(tmp_path, ours_before, caplog):
    file = tmp_path / "robot.toml"
    if ours_before:
        write(file, "as imported")
    file.write_text("mended by hand")
    with pytest.raises(Unwritable, match="was changed since" if ours_before else "nothing says"):
        write(file, "anew")
    assert contents(tmp_path) == {"robot.toml": "mended by hand"}
    write(file, "mended by hand")  # the same may be written anew: nothing is lost
    file.write_text("mended again")
    with replacing():
        write(file, "anew")
    assert contents(tmp_path) == {"robot.toml": "anew", "robot.toml.backup1": "mended again"}
    assert "robot.toml.backup1" in caplog.text
    write(file, "once more")  # which is ours again
    file.write_text("mended a third time")
    with replacing():
        write(file, "at last")
    assert contents(tmp_path)["robot.toml.backup1"] == "mended again"
    assert contents(tmp_path)["robot.toml.backup2"] == "mended a third time"


def test_a_folder_that_changes_between_the_look_and_the_move_is_left_alone(tmp_path, monkeypatch):
    place = tmp_path / "out"
    result(place, a="ours")
    monkeypatch.setattr(writing, "check_replaceable", lambda path: None)  # it was as we wrote it when we looked
    (place / "a").write_text("another's")
    with pytest.raises(Unwritable, match="was changed while it was to be replaced"):
        result(place, a="anew")
    assert contents(tmp_path) == {"out/a": "another's"}
    with replacing():
        result(place, a="anew")
    assert contents(tmp_path) == {"out/a": "anew", "out.backup1/a": "another's"}


def test_an_empty_file_is_free(tmp_path):
    (tmp_path / "a").touch()
    assert write(tmp_path / "a", "x").read_text() == "x"


def test_own_files_in_a_folder_of_results_stay_where_they_are(tmp_path):
    place = tmp_path / "out"
    result(place, figure="one", old="x")
    (place / "notes.md").write_text("mine")
    (place / "drawn").mkdir()
    (place / "drawn" / "figure").write_text("mine too")
    (place / "link").symlink_to("notes.md")
    result(place, figure="two")
    result(place, figure="three")
    assert contents(place) == {"figure": "three", "notes.md": "mine", "drawn/figure": "mine too", "link": "mine"}
    assert (place / "link").is_symlink()


@pytest.mark.parametrize(
    ("name", "text", "said"), [("figure", "touched up", "was changed"), ("new", "my own", "where a file")]
)
def test_a_changed_result_and_a_file_in_the_way_stop_a_folder_and_a_backup_has_them(tmp_path, name, text, said):
    place = tmp_path / "out"
    result(place, figure="one")
    (place / name).write_text(text)
    before = contents(tmp_path)
    with pytest.raises(Unwritable, match=said):
        result(place, figure="two", new="x")
    assert contents(tmp_path) == before
    with replacing():
        result(place, figure="two", new="x")
    assert contents(tmp_path / "out") == {"figure": "two", "new": "x"}
    assert contents(tmp_path / "out.backup1") == {"figure": "one"} | {name: text}


def test_a_place_is_refused_before_the_work(tmp_path):
    result(tmp_path / "out", a="one")
    check_replaceable(tmp_path / "out")
    (tmp_path / "out" / "a").write_text("two")
    with pytest.raises(Unwritable, match=r"out/a was changed since suchus wrote it; .* --replace"):
        check_replaceable(tmp_path / "out")
    with replacing():
        check_replaceable(tmp_path / "out")


def test_the_list_of_digests_is_what_sha256sum_checks_and_takes_odd_names(tmp_path):
    names = ["a b", "100%", "c\nd", "ä"]
    for name in names:
        write(tmp_path / name, "one")
        write(tmp_path / name, "two")
    assert all((tmp_path / name).read_text() == "two" for name in names)
    result(tmp_path / "plain", a="one", b="two")
    checked = subprocess.run(["sha256sum", "-c", MANIFEST], cwd=tmp_path / "plain", capture_output=True, check=False)
    assert checked.returncode == 0


def test_a_damaged_list_protects_more_and_not_less(tmp_path):
    write(tmp_path / "a", "one")
    (tmp_path / MANIFEST).write_bytes((tmp_path / MANIFEST).read_bytes()[:40] + b"\xff\n")
    with pytest.raises(Unwritable, match="nothing says"):
        write(tmp_path / "a", "two")


# --- failing writes -------------------------------------------------------------------------------------------------


def test_whatever_fails_a_file_and_a_folder_are_as_before_or_new(tmp_path, monkeypatch):
    seen = set()

    def work():
        keep(tmp_path / "kept", f"{len(seen)}".encode())
        write(tmp_path / "page", f"page {len(seen)}")
        with new_folder(tmp_path / "out", lasting=True) as draft:
            write(draft / "a", f"a {len(seen)}")
            write(draft / "b", f"a {len(seen)}")

    work()
    (tmp_path / "out" / "notes").write_text("mine")
    for kind, which, error in each_failing(tmp_path, work, monkeypatch):
        seen.add((kind, which))
        assert error is not None or kind in ("link", "mkdir")  # else files are copied; the folder was there
        assert error is None or str(error).endswith("cannot be written: no space left on device.")
        there = contents(tmp_path)
        assert set(there) == {"kept", "page", "out/a", "out/b", "out/notes"}, (kind, which)
        assert there["out/a"] == there["out/b"]
        assert there["out/notes"] == "mine"
        assert int(there["kept"]) >= 0
        assert there["page"].startswith("page ")
    assert {kind for kind, _ in seen} == set(KINDS)
    work()
    assert contents(tmp_path)["out/a"] == f"a {len(seen)}"
