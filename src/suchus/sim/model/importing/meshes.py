"""The meshes that a robot's file names: found in its own folder and in those of packages, read by trimesh.

MuJoCo gets each as STL. A body of which nothing but a mesh says its shape, and whose mesh is not read, is refused.
"""

import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from suchus.core.errors import UnreadableFile
from suchus.core.reading import NoMeshes, check_file, read_mesh, read_text

_MANIFEST, _MAX_MANIFEST_SIZE = "package.xml", 2**20  # bytes
_NAME_ELEMENT = re.compile(r"<name>([^<]*)</name>")
_MAX_PACKAGE_DEPTH, _MAX_FOLDERS = 4, 5000  # levels and folders that are searched for packages
_MAX_FACES = 200_000  # of a mesh as STL, by MuJoCo
_MAX_TOTAL_SIZE = 64 * 2**20  # bytes of all meshes
_SCHEMES = ("package://", "model://")


class Meshes:
    """The meshes of a robot's file as assets for MuJoCo.

    Args:
        home: the folder of the file.
        packages: folders in which the packages lie that ``package://NAME/...`` names, or such packages themselves.
    """

    def __init__(self, home: Path, packages: Sequence[str | Path] = ()) -> None:
        """Resolve the folders; no file is opened yet.

        Raises:
            UnreadableFile: one of ``packages`` is no folder.
        """
        for folder in packages:
            _check_folder(Path(folder))
        self._home, self._packages = home.resolve(), [Path(folder).resolve() for folder in packages]
        self._folders: list[tuple[Path, str | None]] | None = None  # searched ones, with the name of their package.xml
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
        is_found = " is no mesh" in self.read_errors[name]
        others_text = f" and of {len(self.shapeless_bodies) - 1} more" if len(self.shapeless_bodies) > 1 else ""
        raise UnreadableFile(
            f"the shape of {body}{others_text} is a mesh that was not read: {self.read_errors[name]}. "
            f"{'Convert or mend it' if is_found else self._advice(name)}, or say --without-meshes to have rods in "
            "the place of such shapes."
        )

    def _advice(self, name: str) -> str:
        """Return what to say so that a mesh is found: the folder of its package where that is known."""
        if name.startswith(_SCHEMES):
            package = _package_of(name)[0]
            home_package = next((folder for folder in self._home.parents if _package_name(folder) == package), None)
            if home_package is not None and home_package not in self._packages:
                return f"Say --packages {home_package}, which is {package} by its package.xml"
            if self._package_folders(package):
                return "Put the mesh where the file says it is"
            return f"Say --packages FOLDER for the folder of {package}, whose package.xml names it, or one above it"
        if "$(" in name:
            return "Expand the file first, as with xacro, which puts a path in the place of $(...)"
        if path_inside(self._home, name) is None:
            return "Say --packages FOLDER for a folder that holds both, or put the mesh beside the file"
        return "Put the mesh beside the file"

    def _locate(self, name: str) -> Path:
        """Return the file of a mesh, inside the folder of the robot's file or of a package.

        Links are followed inside the folders that ``--packages`` names, since workspaces are built of them; a path may
        not lead out of the package by itself.
        """
        if not name.startswith(_SCHEMES):
            relative_path = name.removeprefix("file://")
            roots = (self._home, *self._packages)
            mesh_files = (path_inside(root, str(self._home / relative_path)) for root in roots)
            mesh_file = next((file for file in mesh_files if file is not None), None) if relative_path else None
            if mesh_file is None:
                raise UnreadableFile(f"{name[:100]} lies outside the folder of the file and those of --packages")
            if not mesh_file.is_file():
                raise UnreadableFile(f"there is no file {name[:100]}")
            return mesh_file
        package, relative_path = _package_of(name)
        folders = self._package_folders(package)
        if _leads_out(relative_path):
            raise UnreadableFile(f"{name[:100]} is in none of the folders of packages, since .. leads out of them")
        for folder in folders:
            if relative_path and (folder / relative_path).is_file():
                return folder / relative_path
        if folders:
            raise UnreadableFile(f"{name[:100]} is not there: the package {package} in {folders[0]} has no such file")
        raise UnreadableFile(f"{name[:100]} is in none of the folders of packages: none of them is {package[:60]}")

    def _package_folders(self, package: str) -> list[Path]:
        """Return the folders of a package: those of its name, and those whose ``package.xml`` names it."""
        if self._folders is None:
            folders = dict.fromkeys(folder for root in self._packages for folder in _folders_below(root))
            self._folders = [(folder, _package_name(folder)) for folder in folders]
        named = [folder for folder, name in self._folders if name == package]
        exact = [folder for folder, _ in self._folders if folder.name == package]
        unpacked = [
            folder for folder, name in self._folders if name is None and folder.name.startswith(f"{package}-")
        ]  # archives unpack as NAME-main or NAME-1.2
        return list(dict.fromkeys([*named, *exact, *unpacked]))

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


def _check_folder(folder: Path) -> None:
    """Refuse what is no folder of packages, an archive with what to do.

    Raises:
        UnreadableFile: it is not there, or no folder.
    """
    if folder.suffix.lower() in (".zip", ".tar", ".gz", ".tgz"):
        raise UnreadableFile(f"--packages {folder} is an archive; unpack it and name the folder.")
    if not folder.is_dir():
        reason = "no folder" if folder.exists() else "not there"
        raise UnreadableFile(f"--packages {folder} is {reason}; a folder of packages, or a package, is needed.")


def _package_of(name: str) -> tuple[str, str]:
    """Return the package and the path in it of a name as ``package://NAME/meshes/a.stl``."""
    package, _, relative_path = name.partition("://")[2].partition("/")
    return package, relative_path


def _leads_out(relative_path: str) -> bool:
    return ".." in PurePosixPath(relative_path.replace("\\", "/")).parts or PurePosixPath(relative_path).is_absolute()


def _folders_below(root: Path) -> tuple[Path, ...]:
    """Return a folder and those below it, nearest first, down to a depth and up to a number.

    Links to folders are followed, each folder once.
    """
    folders, visited, level = [root], {root.resolve()}, [root]
    for _ in range(_MAX_PACKAGE_DEPTH):
        subfolders: list[Path] = []
        for folder in level:
            if folder != root and (folder / _MANIFEST).is_file():
                continue  # packages do not lie in packages
            try:
                children = sorted(child for child in folder.iterdir() if not child.name.startswith("."))
            except OSError:
                continue
            for child in children:
                if len(folders) >= _MAX_FOLDERS:
                    return tuple(folders)
                if child.is_dir() and child.resolve() not in visited:
                    visited.add(child.resolve())
                    subfolders.append(child)
                    folders.append(child)
        level = subfolders
    return tuple(folders)


def _package_name(folder: Path) -> str | None:
    """Return the name that a folder's ``package.xml`` gives it; None where it has none that can be read."""
    manifest = folder / _MANIFEST
    if not manifest.is_file():
        return None
    try:
        match = _NAME_ELEMENT.search(read_text(manifest, _MAX_MANIFEST_SIZE))
    except UnreadableFile:
        return None
    return match[1].strip() if match else None


def path_inside(home: Path, name: str) -> Path | None:
    """Return the path of a file named in a robot's file; None where it would lie outside a folder."""
    try:
        path = (home / name).resolve()
    except (OSError, ValueError, RuntimeError):
        return None
    return path if name and path.is_relative_to(home) else None


def _stl(mesh_file: Path, data: bytes) -> tuple[bytes, bool]:
    """Return a mesh as STL, and whether its surface is closed; nothing that it names is opened.

    Of a mesh with more faces than MuJoCo reads from STL it is the convex hull, which counts as not closed.
    """
    mesh = read_mesh(mesh_file, data)
    try:
        if len(mesh.faces) > _MAX_FACES:
            return mesh.convex_hull.export(file_type="stl"), False
        return mesh.export(file_type="stl"), bool(mesh.is_watertight)
    except Exception as error:  # whatever trimesh raises for a mesh that is none
        raise UnreadableFile(f"{mesh_file.name} is no mesh whose surface can be written as STL") from error
