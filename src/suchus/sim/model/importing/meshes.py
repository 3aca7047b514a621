"""The meshes that a robot's file names: found in its own folder and in those of packages, read by trimesh.

MuJoCo gets each as STL. A body of which nothing but a mesh says its shape, and whose mesh is not read, is refused.
"""

from collections.abc import Sequence
from pathlib import Path

from suchus.core.errors import UnreadableFile
from suchus.core.reading import NoMeshes, check_file, read_mesh

_MOST = 64 * 2**20  # bytes of all meshes
_SCHEME = "package://"


class Meshes:
    """What MuJoCo is given of the meshes of a robot's file.

    Args:
        home: the folder of the file.
        packages: folders in which the packages lie that ``package://NAME/...`` names, or such packages themselves.
    """

    def __init__(self, home: Path, packages: Sequence[str | Path] = ()) -> None:
        self._home, self._packages = home.resolve(), [Path(folder).resolve() for folder in packages]
        self.assets: dict[str, bytes] = {}
        """STL files by the names under which MuJoCo finds them."""
        self.open: list[str] = []
        """Those of ``assets`` that are no closed surfaces."""
        self.lost: dict[str, str] = {}
        """Why a mesh was not read, by what the file calls it."""
        self.bare: dict[str, str] = {}
        """The mesh that was lost, by the body that has no other shape."""
        self._size = 0

    def given(self, name: str) -> str | None:
        """Return the name under which MuJoCo finds a mesh of the file; None where it is not read."""
        try:
            where = self._found(name)
            stl, closed = _stl(where, self._bytes(where))
        except NoMeshes:
            raise
        except UnreadableFile as error:
            self.lost[name] = str(error).rstrip(".")
            return None
        known = next((key for key, held in self.assets.items() if held == stl), None)
        given = known or f"mesh_{len(self.assets)}.stl"
        self.assets[given] = stl
        if not closed and given not in self.open:
            self.open.append(given)
        return given

    def check(self) -> None:
        """Refuse bodies that would have no shape since their mesh was not read.

        Raises:
            UnreadableFile: there are such; it names them, and what to do.
        """
        if not self.bare:
            return
        body, name = next(iter(self.bare.items()))
        more = f" and of {len(self.bare) - 1} more" if len(self.bare) > 1 else ""
        raise UnreadableFile(
            f"the shape of {body}{more} is a mesh that was not read: {self.lost[name]}. Say --packages FOLDER for the "
            "folder in which the package lies, or --without-meshes to have rods in the place of such shapes."
        )

    def _found(self, name: str) -> Path:
        """Return the file of a mesh, inside the folder of the robot's file or of a package."""
        for root, rest in self._places(name):
            where = inside(root, rest)
            if where is not None and where.is_file():
                return where
        if name.startswith(_SCHEME):
            raise UnreadableFile(f"{name[:100]} is in none of the folders of packages")
        if inside(self._home, name) is None:
            raise UnreadableFile(f"{name[:100]} lies outside the folder of the file")
        raise UnreadableFile(f"there is no file {name[:100]}")

    def _places(self, name: str) -> list[tuple[Path, str]]:
        if not name.startswith(_SCHEME):
            return [(self._home, name.removeprefix("file://"))]
        path = name.removeprefix(_SCHEME)
        package, _, rest = path.partition("/")
        return [one for root in self._packages for one in ((root, path), *([(root, rest)] * (root.name == package)))]

    def _bytes(self, where: Path) -> bytes:
        check_file(where)
        self._size += where.stat().st_size
        if self._size > _MOST:
            raise UnreadableFile(f"{where.name} makes the meshes larger than {_MOST // 2**20} MiB")
        try:
            return where.read_bytes()
        except OSError as error:
            raise UnreadableFile(f"{where.name} cannot be read: {error.strerror}") from error


def inside(home: Path, name: str) -> Path | None:
    """Return the path of a file named in a robot's file; None where it would lie outside a folder."""
    try:
        where = (home / name).resolve()
    except (OSError, ValueError, RuntimeError):
        return None
    return where if name and where.is_relative_to(home) else None


def _stl(where: Path, data: bytes) -> tuple[bytes, bool]:
    """Return a mesh as STL, and whether its surface is closed; nothing that it names is opened."""
    mesh = read_mesh(where, data)
    try:
        return mesh.export(file_type="stl"), bool(mesh.is_watertight)
    except Exception as error:  # whatever trimesh raises for a mesh that is none
        raise UnreadableFile(f"{where.name} is no mesh: {' '.join(str(error).split())[:120]}") from error
