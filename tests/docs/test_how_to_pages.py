"""The how-to pages, followed literally in an empty folder: each in a process of its own."""

from pathlib import Path

import pytest

from pages.blocks import Block, WrongOutput, blocks, filled, follow

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    "page",
    ["index", "extending", "own_robot", "own_experiment", "own_flow"],
)
def test_following_the_page_gives_what_it_says(page, tmp_path, programs):
    code = (
        "import sys; from pathlib import Path; sys.path.insert(0, sys.argv[1])\n"
        "from pages.blocks import follow; follow(Path(sys.argv[2]).read_text())"
    )
    done = programs.run(["-c", code, ROOT / "tools", ROOT / "docs" / f"{page}.md"], cwd=tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]


def test_blocks_are_found_with_their_titles():
    page = 'a\n```toml title="x.toml"\nb = 1\n```\n```python\nprint(1)\n```\n'
    assert blocks(page) == [Block("toml", "x.toml", "b = 1\n"), Block("python", "", "print(1)\n")]


def test_a_session_goes_on_and_a_wrong_output_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = "```python\nx = 2\n```\n```python\nprint(x, 'a')\n```\n```text\n{}\n```\n"
    follow(page.format("2 a"))
    follow(page.format("2 ..."))
    with pytest.raises(WrongOutput, match="the page says"):
        follow(page.format("3 a"))
    assert "```text\n2 a\n```" in filled(page.format("?"))


def test_a_page_cannot_ask_for_any_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(WrongOutput, match="not a command"):
        follow("```sh\nrm -rf x\n```\n")
