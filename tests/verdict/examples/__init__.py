"""By claim: measures and the word that a rule must say of them, written by hand."""

from importlib import import_module
from pathlib import Path

ALL = {
    claim: rows
    for file in sorted(Path(__file__).parent.glob("[a-z]*.py"))
    for claim, rows in import_module(f"{__name__}.{file.stem}").EXAMPLES.items()
}
