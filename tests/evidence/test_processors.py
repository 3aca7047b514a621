"""On other processors, imitated by the settings of the libraries, the quick forms measure what they mean here."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from evidence import tolerance
from evidence.processors import PROCESSORS, ROOT, can_imitate, quick_measures
from suchus.experiments.catalog import EXPERIMENTS

GOLDEN = Path(__file__).parents[1] / "golden"
SOON = ("displacement", "gait_diagram", "spine_kinematics", "tail_bending", "turning", "working_space")
"""Quick forms of a second or two that reach no compiled kernel of the flow."""
SHIPPED = tuple(name for name, source in EXPERIMENTS.sources().items() if source.shipped)

pytestmark = pytest.mark.skipif(not can_imitate(), reason="processors are imitated on x86-64 with the GNU C library")


def moved(processor, names):
    """Return the golden numbers that mean something else on an imitated processor, by experiment."""
    measures = quick_measures(processor, names)
    golden = {name: json.loads((GOLDEN / f"{name}.json").read_text(encoding="utf-8")) for name in names}
    found = {name: tolerance.moved(tolerance.read(golden[name]), measures[name]) for name in names}
    return {name: numbers for name, numbers in found.items() if numbers}


def test_walks_and_kinematics_mean_the_same_on_a_processor_of_2011():
    assert moved("Sandy Bridge", SOON) == {}


@pytest.mark.slow("the kernels are compiled anew for each processor, and every quick form runs once more")
@pytest.mark.parametrize("processor", PROCESSORS)
def test_every_quick_form_means_the_same_on_every_processor(processor):
    assert moved(processor, SHIPPED) == {}


def test_without_the_settings_the_program_refuses_to_imitate():
    words = [sys.executable, "-m", "evidence.processors", "Nehalem", "spine_kinematics"]
    clean = {name: value for name, value in os.environ.items() if name not in PROCESSORS["Nehalem"]}
    done = subprocess.run(words, env=clean, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "the environment does not imitate Nehalem: NPY_DISABLE_CPU_FEATURES, " in done.stderr
