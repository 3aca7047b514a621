"""Every example runs as it stands, and README's Python too."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
LONG = ("05", "06", "07", "08", "09", "10", "11", "12", "13", "14", "15", "16", "17", "18")
"""Flows, searches, studies and replays of 4 s and more of processor time."""


@pytest.mark.parametrize(
    "example",
    [
        pytest.param(
            e, id=e.stem, marks=[pytest.mark.slow("a whole flow, search, study or replay")] * (e.name[:2] in LONG)
        )
        for e in EXAMPLES
    ],
)
def test_example_runs(example, tmp_path):
    done = subprocess.run([sys.executable, str(example)], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


def test_examples_are_numbered_without_gaps():
    assert [path.name[:2] for path in EXAMPLES] == [f"{i + 1:02d}" for i in range(len(EXAMPLES))]


def test_the_python_of_the_readme_runs(tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    assert blocks
    for code in blocks:
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
