"""Files of results: records and tables on disk, and where a result comes from."""

from suchus.core.files.provenance import (
    code_digest,
    commit_of,
    digest,
    has_same_provenance,
    package_commit,
    package_digest,
    plain,
    provenance,
    versions,
)
from suchus.core.files.store import load, save
from suchus.core.files.tables import write_tables
from suchus.core.reading import check_file, path_exists, read_json, read_text, read_toml
from suchus.core.writing import (
    check_name,
    check_replaceable,
    check_writable,
    new_file,
    new_folder,
    remove_leftovers,
    write,
)

__all__ = [
    "check_file",
    "check_name",
    "check_replaceable",
    "check_writable",
    "code_digest",
    "commit_of",
    "digest",
    "has_same_provenance",
    "load",
    "new_file",
    "new_folder",
    "package_commit",
    "package_digest",
    "path_exists",
    "plain",
    "provenance",
    "read_json",
    "read_text",
    "read_toml",
    "remove_leftovers",
    "save",
    "versions",
    "write",
    "write_tables",
]
