"""Every example runs as it stands, and README's Python too."""

import ast
import json
import os
import re
import runpy
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
BENCHES = sorted((ROOT / "bench").glob("bench_*.py"))
LONG = ("05", "06", "07", "19")
"""Those of more than ten seconds of processor time: two of flows, and two of walks and swims."""


@pytest.mark.parametrize(
    "example",
    [
        pytest.param(
            e,
            id=e.stem,
            marks=[pytest.mark.slow("more than ten seconds: a whole flow, walk or swim")] * (e.name[:2] in LONG),
        )
        for e in EXAMPLES
    ],
)
def test_example_runs(example, tmp_path, programs):
    done = programs.run([example], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


def test_examples_are_numbered_without_gaps():
    assert [path.name[:2] for path in EXAMPLES] == [f"{i + 1:02d}" for i in range(len(EXAMPLES))]


@pytest.mark.parametrize("bench", BENCHES, ids=lambda bench: bench.stem)
def test_bench_finds_what_it_times(bench):
    found = runpy.run_path(str(bench), run_name=bench.stem)
    assert callable(found["main"])
    for place, names in found.get("PIECES", ()):
        assert [name for name in names.split() if not hasattr(place, name)] == [], place


def test_bench_of_the_flow_times_the_swim_of_the_robot():
    found = runpy.run_path(str(ROOT / "bench" / "bench_flow.py"), run_name="bench_flow")["tell_swim"](60, {1: 10.0})
    assert found["swim_60_1"] > 0.0
    assert found["swim_60_steps"] > 10


@pytest.mark.slow("imitated processors: threads of a card, simulated one by one")
def test_bench_of_a_card_gives_what_the_processor_gives(tmp_path):
    bench, out = ROOT / "bench" / "bench_gpu.py", tmp_path / "found.json"
    command = [sys.executable, str(bench), "--cells", "8", "--times", "1", "--out", str(out)]
    done = subprocess.run(
        command, env=os.environ | {"NUMBA_ENABLE_CUDASIM": "1"}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(out.read_text(encoding="utf-8"))
    assert 0 < found["advance_8_apart"] < 1e-6
    assert 0 < found["cycle_8_apart"] < 1e-5


def readme() -> list[str]:
    """Return the Python of the README."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    assert blocks
    return blocks


def test_what_the_readme_takes_from_suchus_is_there():
    taken = set()
    for node in (node for code in readme() for node in ast.walk(ast.parse(code))):
        if isinstance(node, ast.ImportFrom):
            taken |= {(node.module, name.name) for name in node.names}
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "suchus":
            taken.add(("suchus", node.attr))
    assert ("suchus", "crawl") in taken
    assert [f"{module}.{name}" for module, name in taken if not hasattr(import_module(module), name)] == []


def test_the_python_of_the_readme_prints_what_it_says(tmp_path, programs):
    page = "\n".join(re.findall(r"^```(?:python|text)\n.*?^```$", (ROOT / "README.md").read_text(), re.S | re.M))
    assert page.count("```text") == 1
    (tmp_path / "page.md").write_text(page)
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from pages import blocks; blocks.follow(open('page.md').read())"
    )
    done = programs.run(["-c", code, ROOT / "tools"], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
