"""What happened: the schema of a run, its place on disk and where it comes from."""

from suchus.reading import check_file, read_json, read_text, read_toml, there
from suchus.record.provenance import code_digest, digest, made_alike, package_digest, plain, provenance, versions
from suchus.record.schema import (
    COUPLED,
    DRIVEN,
    HEAT,
    PER_RUN,
    VARIABLES,
    WATER,
    check_land,
    dataset,
    ground_of,
    ground_text,
)
from suchus.record.store import load, save
from suchus.record.tables import write_tables
from suchus.writing import check_name, check_replaceable, check_writable, new_file, new_folder, sweep, write

__all__ = [
    "COUPLED",
    "DRIVEN",
    "HEAT",
    "PER_RUN",
    "VARIABLES",
    "WATER",
    "check_file",
    "check_land",
    "check_name",
    "check_replaceable",
    "check_writable",
    "code_digest",
    "dataset",
    "digest",
    "ground_of",
    "ground_text",
    "load",
    "made_alike",
    "new_file",
    "new_folder",
    "package_digest",
    "plain",
    "provenance",
    "read_json",
    "read_text",
    "read_toml",
    "save",
    "sweep",
    "there",
    "versions",
    "write",
    "write_tables",
]
