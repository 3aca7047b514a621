"""Rows of the validation: each is kept as it comes, with the code and the test that made it."""

import json
import os
import re
from pathlib import Path

import numpy as np

from suchus.core.files import code_digest

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out" / "validation"

SOURCES = (
    "Stokes 1851 (Trans. Cambridge Phil. Soc. 9, 8-106) and Wang 1968 (J. Fluid Mech. 32, 55-68): the force on a "
    "cylinder that oscillates in water at rest by small amounts.",
    "The eels are those of the IBAMR examples eel2d and, in space, eel3d, which is that of Kern and Koumoutsakos 2006 "
    "(J. Exp. Biol. 209, 4841-4857); neither gives a speed: what is bounded is how much finer grids and further cycles "
    "change it.",
    "Pitter, Pruppacher and Hamielec 1973 (J. Atmos. Sci. 30, 125-134): thin oblate spheroids, by the fit of Clift, "
    "Grace and Weber 1978 (Bubbles, Drops, and Particles), from memory.",
    "Flows with published data stand in the [atlas](atlas.md).",
)


def note(case, quantity, ours, theirs, grid, domain, source, **curves):
    """Keep one row of the table (and curves for its figure) under out/validation."""
    OUT.mkdir(parents=True, exist_ok=True)
    row = {
        "case": case,
        "quantity": quantity,
        "ours": float(ours),
        "theirs": theirs,
        "grid": grid,
        "domain": domain,
        "source": source,
        "code": code_digest("flow")[:12],
        "test": os.environ["PYTEST_CURRENT_TEST"].rpartition(" ")[0],
        "curves": {key: np.asarray(value).tolist() for key, value in curves.items()},
    }
    (OUT / f"{case} {quantity}.json".replace("/", "-")).write_text(json.dumps(row))
    return abs(ours / theirs - 1) if isinstance(theirs, float) and theirs else float("nan")


def tests_there_are():
    """Return the names of the validation's tests."""
    files = Path(__file__).parent.glob("test_validate_*.py")
    return {name for file in files for name in re.findall(r"^def (test_\w+)", file.read_text("utf-8"), re.MULTILINE)}


def is_whole(config):
    """Return whether all of the validation is asked for, and not a part of its files or tests."""
    narrower = ("keyword", "lf", "failedfirst", "stepwise", "deselect", "ignore", "ignore_glob")  # some are of plugins
    chosen = any(getattr(config.option, name, None) for name in narrower)
    return not chosen and not any("::" in word or word.endswith(".py") for word in map(str, config.args))
