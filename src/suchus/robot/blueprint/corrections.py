"""Corrections of the section model, from the TOML files that a run in a flow writes."""

from pathlib import Path

from suchus.core.reading import read_toml
from suchus.robot.blueprint.read import parse_table
from suchus.robot.design import SectionCorrection


def read_correction(path: str | Path) -> SectionCorrection:
    """Read a correction of the section model from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
    """
    path = Path(path)
    return parse_table({"name": path.stem, **read_toml(path)}, SectionCorrection, path.name)
