"""The lines of the page on water in MuJoCo run, and each of the eight threads has one."""

import re
from pathlib import Path

PAGE = (Path(__file__).parents[2] / "docs" / "water_in_mujoco.md").read_text(encoding="utf-8")
THREADS = (
    "mujoco/issues/1676", "mujoco/issues/1691", "mujoco/issues/1984", "mujoco/issues/2655", "mujoco/issues/3066",
    "mujoco/issues/3452", "gazebo-classic/issues/2066", "SPlisHSPlasH/issues/378",
)  # fmt: skip


def test_each_thread_has_a_line_that_runs():
    parts = PAGE.partition("## What each thread asks")[2].partition("## What the water does")[0].split("**[")[1:]
    assert len(parts) == len(THREADS)
    for thread, part in zip(THREADS, parts, strict=True):
        assert thread in part
        assert "```python" in part


def test_the_lines_of_the_page_run_one_after_the_other():
    names: dict[str, object] = {}
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    assert len(blocks) >= len(THREADS)
    for block in blocks:
        exec(compile(block, "water_in_mujoco.md", "exec"), names)
    data = names["data"]
    assert data.time > 0.0
