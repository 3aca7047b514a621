"""Files of results: records and tables on disk, and where a result comes from."""

from suchus.core.files.provenance import code_digest, digest, made_alike, package_digest, plain, provenance, versions
from suchus.core.files.store import load, save
from suchus.core.files.tables import write_tables
from suchus.core.reading import check_file, read_json, read_text, read_toml, there
from suchus.core.writing import check_name, check_replaceable, check_writable, new_file, new_folder, sweep, write

__all__ = [
    "check_file",
    "check_name",
    "check_replaceable",
    "check_writable",
    "code_digest",
    "digest",
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
