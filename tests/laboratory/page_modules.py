"""Runs the page's modules in node, for the tests that compare them with Python."""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from suchus.apps.laboratory.engine import NoEngine, engine_folders, read_engine

NODE = shutil.which("node")
MODULES = Path(__file__).parents[2] / "src" / "suchus" / "apps" / "laboratory" / "modules"
needs_node = pytest.mark.skipif(NODE is None, reason="node is not installed: the page's modules are not run")


def engine_folder() -> Path | None:
    """Return where the engine lies; None where it is not on this machine."""
    try:
        read_engine()
    except NoEngine:
        return None
    return next(folder for folder in engine_folders() if folder.is_dir())


needs_engine = pytest.mark.skipif(
    engine_folder() is None, reason="the engine of the page is not on this machine: make page fetches it"
)


def run(task: str, **given: Any) -> Any:
    """Return what a task of ``run_modules.mjs`` makes of some inputs."""
    assert NODE is not None
    words = [NODE, str(Path(__file__).with_name("run_modules.mjs")), str(MODULES), str(engine_folder() or "")]
    done = subprocess.run(words, input=json.dumps({"task": task, **given}), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)
