"""The meshes that a robot's file names: found in its own folder and in those of packages, read by trimesh.

MuJoCo gets each as STL. A body of which nothing but a mesh says its shape, and whose mesh is not read, is refused.
"""

from collections.abc import Sequence
from pathlib import Path

from suchus.core.errors import UnreadableFile
from suchus.core.reading import NoMeshes, check_file, read_mesh

_MAX_TOTAL_SIZE = 64 * 2**20  # bytes of all meshes
_SCHEME = "package://"


class Meshes:
    """The meshes of a robot's file as assets for MuJoCo.

    Args:
        home: the folder of the file.
        packages: folders in which the packages lie that ``package://NAME/...`` names, or such packages themselves.
    """

    def __init__(self, home: Path, packages: Sequence[str | Path] = ()) -> None:
        """Resolve the folders; no file is opened yet."""
        self._home, self._packages = home.resolve(), [Path(folder).resolve() for folder in packages]
        self.assets: dict[str, bytes] = {}
        """STL files by the names under which MuJoCo finds them."""
        self.open: list[str] = []
        """Those of ``assets`` that are no closed surfaces."""
        self.read_errors: dict[str, str] = {}
        """Reason why a mesh was not read, by its name in the file."""
        self.shapeless_bodies: dict[str, str] = {}
        """The mesh that was lost, by the body that has no other shape."""
        self._size = 0

    def asset_name(self, name: str) -> str | None:
        """Return the name under which MuJoCo finds a mesh of the file; None where it is not read."""
        try:
            mesh_file = self._locate(name)
            stl, closed = _stl(mesh_file, self._bytes(mesh_file))
        except NoMeshes:
            raise
        except UnreadableFile as error:
            self.read_errors[name] = str(error).rstrip(".")
            return None
        stored_name = next((key for key, stored_data in self.assets.items() if stored_data == stl), None)
        asset = stored_name or f"mesh_{len(self.assets)}.stl"
        self.assets[asset] = stl
        if not closed and asset not in self.open:
            self.open.append(asset)
        return asset

    def check(self) -> None:
        """Refuse bodies that would have no shape since their mesh was not read.

        Raises:
            UnreadableFile: there are such; it names them, and what to do.
        """
        if not self.shapeless_bodies:
            return
        body, name = next(iter(self.shapeless_bodies.items()))
        others_text = f" and of {len(self.shapeless_bodies) - 1} more" if len(self.shapeless_bodies) > 1 else ""
        raise UnreadableFile(
            f"the shape of {body}{others_text} is a mesh that was not read: {self.read_errors[name]}. "
            "Say --packages FOLDER for the folder in which the package lies, "
            "or --without-meshes to have rods in the place of such shapes."
        )

    def _locate(self, name: str) -> Path:
        """Return the file of a mesh, inside the folder of the robot's file or of a package."""
        for root, relative_path in self._places(name):
            mesh_file = path_inside(root, relative_path)
            if mesh_file is not None and mesh_file.is_file():
                return mesh_file
        if name.startswith(_SCHEME):
            raise UnreadableFile(f"{name[:100]} is in none of the folders of packages")
        if path_inside(self._home, name) is None:
            raise UnreadableFile(f"{name[:100]} lies outside the folder of the file")
        raise UnreadableFile(f"there is no file {name[:100]}")

    def _places(self, name: str) -> list[tuple[Path, str]]:
        """Return folders and relative paths at which a mesh may lie, in the order in which they are tried."""
        if not name.startswith(_SCHEME):
            return [(self._home, name.removeprefix("file://"))]
        path = name.removeprefix(_SCHEME)
        package, _, relative_path = path.partition("/")
        return [
            location
            for root in self._packages
            for location in ((root, path), *([(root, relative_path)] * (root.name == package)))
        ]

    def _bytes(self, mesh_file: Path) -> bytes:
        """Return the content of a mesh file; refuse it where all meshes together would be too large."""
        check_file(mesh_file)
        self._size += mesh_file.stat().st_size
        if self._size > _MAX_TOTAL_SIZE:
            raise UnreadableFile(f"{mesh_file.name} makes the meshes larger than {_MAX_TOTAL_SIZE // 2**20} MiB")
        try:
            return mesh_file.read_bytes()
        except OSError as error:
            raise UnreadableFile(f"{mesh_file.name} cannot be read: {error.strerror}") from error


def path_inside(home: Path, name: str) -> Path | None:
    """Return the path of a file named in a robot's file; None where it would lie outside a folder."""
    try:
        path = (home / name).resolve()
    except (OSError, ValueError, RuntimeError):
        return None
    return path if name and path.is_relative_to(home) else None


def _stl(mesh_file: Path, data: bytes) -> tuple[bytes, bool]:
    """Return a mesh as STL, and whether its surface is closed; nothing that it names is opened."""
    mesh = read_mesh(mesh_file, data)
    try:
        return mesh.export(file_type="stl"), bool(mesh.is_watertight)
    except Exception as error:  # whatever trimesh raises for a mesh that is none
        raise UnreadableFile(f"{mesh_file.name} is no mesh: {' '.join(str(error).split())[:120]}") from error
