"""What makes the bytes of a result: versions of libraries, and the digest of our own source."""

from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version

from suchus.core.files import code_digest, versions
from suchus.core.sources import current

_DECIDING = ("suchus", "python", "mujoco", "numpy", "scipy", "xarray", "h5netcdf")
LAND_SOURCES = (
    "article/paper", "core/catalog.py", "core/checks.py", "core/files", "core/kinds.py", "core/physics.py",
    "core/plate_table.py", "core/reading.py", "core/rotation.py", "core/sources.py", "core/water_table.py",
    "robot", "sim",
    *(f"experiments/study/{module}.py" for module in ("arm", "chunk", "measures", "plan", "study")),
)  # fmt: skip
"""Paths whose code decides the numbers of a run on land."""
FLOW_SOURCES = (
    "article/paper", "core/catalog.py", "core/checks.py", "core/files", "core/fingerprint.py", "core/isosurface.py",
    "core/kinds.py", "core/physics.py", "core/plate_table.py", "core/reading.py", "core/rotation.py",
    "core/sources.py", "core/water_table.py", "flow", "robot/blueprint",
    "robot/design", "robot/kinematics", "robot/motion", "robot/motors", "robot/robots", "sim/hydro", "sim/metrics",
    "sim/record", "swimming/water",
)  # fmt: skip
"""Paths whose code decides the numbers of a swim by CFD."""


def source_versions(paths: Sequence[str] = LAND_SOURCES, libraries: Sequence[str] = ()) -> dict[str, str]:
    """Return the versions of what makes the bytes of a result, the files of the user's project among them.

    Args:
        paths: paths whose source decides, see ``record.code_digest``.
        libraries: further packages whose versions decide.
    """
    package_versions = versions()
    makers = {name: package_versions.get(name, "not installed") for name in _DECIDING}
    makers["source"] = code_digest(*paths)[:12]
    project = current()
    if project is not None:
        makers["project"] = project.digest()
    for name in libraries:
        try:
            makers[name] = version(name)
        except PackageNotFoundError:
            makers[name] = "not installed"
    return makers
