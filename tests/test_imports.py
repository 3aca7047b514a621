"""What walks loads no flow solver: what an import brings along, each in a process of its own."""

import subprocess
import sys

import pytest

RESOLVED = {"swimming", "swim_3d", "swim_sweep", "swim_free"}
"""Experiments that resolve the water, or measure against flows that were."""

LOADED = """
import importlib, sys
for name in sys.argv[1:]:
    importlib.import_module(name)
print([name for name in sys.modules if name.split(".")[:2] == ["suchus", "flow"]])
"""


def flow_modules_after(*names):
    """Return what is printed of the flow solver's modules after modules were imported in a new process."""
    done = subprocess.run([sys.executable, "-c", LOADED, *names], capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.fixture(scope="module")
def walking():
    from suchus.experiments import EXPERIMENTS  # noqa: PLC0415  its names only

    return [f"suchus.experiments.{name}.experiment" for name in EXPERIMENTS if name not in RESOLVED]


def test_what_walks_loads_no_flow_solver(walking):
    assert "suchus.experiments.displacement.experiment" in walking
    doors = ["suchus.replay", "suchus.study", "suchus.optimise", "suchus.envs", "suchus.cli.view", "suchus.viewer"]
    assert flow_modules_after(*walking, *doors) == "[]"


def test_a_swim_by_cfd_would_be_noticed():
    assert "suchus.flow" in flow_modules_after("suchus.experiments.swimming.experiment")


def test_to_save_a_record_loads_no_cluster(tmp_path):
    code = "import sys, xarray, suchus.record; suchus.record.save(xarray.Dataset({'a': 1.0}), sys.argv[1])"
    code += "; print('distributed' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "r.nc")], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"
    assert (tmp_path / "r.nc").is_file()
