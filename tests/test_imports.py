"""What walks loads no flow solver: what an import brings along, each in a process of its own."""

import subprocess
import sys

RESOLVED = {"swimming", "swim_3d", "swim_sweep", "swim_free"}
"""Experiments that resolve the water, or measure against flows that were."""

LOADED = """
import importlib, sys
for names in sys.argv[1:]:
    for name in names.split(","):
        importlib.import_module(name)
    print([name for name in sys.modules if name.split(".")[:2] == ["suchus", "flow"]])
"""


def flow_modules_after(*steps):
    """Return what is printed of the flow solver's modules after each step of imports in a new process."""
    command = [sys.executable, "-c", LOADED, *map(",".join, steps)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_what_walks_loads_no_flow_solver_and_a_swim_by_cfd_would_be_noticed():
    from suchus.experiments.catalog import EXPERIMENTS  # noqa: PLC0415  its names only

    walking = [f"suchus.experiments.catalog.{name}.experiment" for name in EXPERIMENTS if name not in RESOLVED]
    assert "suchus.experiments.catalog.displacement.experiment" in walking
    doors = [
        "suchus.visual.replay",
        "suchus.experiments.study",
        "suchus.experiments.optimise",
        "suchus.apps.envs",
        "suchus.apps.cli.view",
        "suchus.apps.viewer",
    ]
    walks, swims = flow_modules_after([*walking, *doors], ["suchus.experiments.catalog.swimming.experiment"])
    assert walks == "[]"
    assert "suchus.flow" in swims


def test_to_save_a_record_loads_no_cluster(tmp_path):
    code = "import sys, xarray, suchus.core.files; suchus.core.files.save(xarray.Dataset({'a': 1.0}), sys.argv[1])"
    code += "; print('distributed' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "r.nc")], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"
    assert (tmp_path / "r.nc").is_file()
