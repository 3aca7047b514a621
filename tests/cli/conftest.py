import sys
from pathlib import Path

import pytest

import suchus.experiments.catalog
from suchus.experiments.claims import RULES

FAKES = Path(__file__).parent / "fake_shelf"
BROKEN = '''"""Does it break?"""
from dataclasses import dataclass
import suchus.experiments.catalog.wave as wave

@dataclass(frozen=True, slots=True, kw_only=True)
class Broken(wave.Wave):
    title = "Does it break?"

    def run(self, progress=None):
        raise RuntimeError("it broke, as it should")

experiment = Broken()
'''


@pytest.fixture
def fakes(monkeypatch):
    """Only the fake experiment stands on the shelf; rules that were read from it meanwhile are forgotten."""
    path = suchus.experiments.catalog.__path__  # the import system holds the same list, so it is changed in place
    real = list(path)
    path[:] = [str(FAKES)]
    yield
    path[:] = real
    vars(RULES).pop("_by_claim", None)
    for name in [
        n for n in sys.modules if n in ("suchus.experiments.catalog.wave", "suchus.experiments.catalog.broken")
    ]:
        monkeypatch.delitem(sys.modules, name)


@pytest.fixture
def broken(fakes, tmp_path):
    """A second fake that breaks stands beside the first, and comes before it."""
    shelf = tmp_path / "broken_shelf"
    shelf.mkdir()
    (shelf / "broken.py").write_text(BROKEN)
    suchus.experiments.catalog.__path__.append(str(shelf))
