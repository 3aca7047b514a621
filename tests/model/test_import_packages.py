"""Meshes of packages are found by the name in ``package.xml``, behind links and in unpacked archives."""

from pathlib import Path

import pytest
import trimesh

from suchus.core.errors import UnreadableFile
from suchus.sim.model.importing import Words, import_robot

FILES = Path(__file__).parent.parent / "data" / "imports"
MANIFEST = '<package format="3"><name>walker_description</name><version>0.1.0</version></package>'
TEXT = (
    (FILES / "walker.urdf")
    .read_text()
    .replace('<box size="0.34 0.12 0.05"/>', '<mesh filename="package://walker_description/meshes/trunk.stl"/>')
)


@pytest.fixture
def package(tmp_path):
    """A package that an archive was unpacked to, its folder not called by its name."""
    folder = tmp_path / "ws" / "walker_description-main"
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    trimesh.creation.box((0.34, 0.12, 0.05)).export(folder / "meshes" / "trunk.stl")
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "urdf" / "walker.urdf").write_text(TEXT)
    return folder


def trunk(file, *packages):
    draft = import_robot(file, name="walker", words=Words(packages=packages))
    return draft.robot.axis[0].shapes[0].half


def test_a_package_is_found_by_its_manifest_in_its_folder_or_one_above(package):
    file = package / "urdf" / "walker.urdf"
    for folder in (package, package.parent, package.parent.parent, str(package)):
        assert trunk(file, folder) == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)


def test_without_the_option_the_refusal_names_the_folder_that_does_it(package):
    file = package / "urdf" / "walker.urdf"
    with pytest.raises(UnreadableFile) as told:
        trunk(file)
    assert f"Say --packages {package}, which is walker_description by its package.xml" in str(told.value)
    elsewhere = package.parent / "walker.urdf"
    elsewhere.write_text(TEXT)
    with pytest.raises(UnreadableFile, match="Say --packages FOLDER for the folder of walker_description"):
        trunk(elsewhere)


def test_links_to_packages_and_links_in_packages_are_followed(package, tmp_path):
    file = package / "urdf" / "walker.urdf"
    workspace = tmp_path / "install"
    workspace.mkdir()
    (workspace / "walker_description").symlink_to(package)
    assert trunk(file, workspace) == trunk(file, package)
    linked = tmp_path / "install" / "share" / "other"
    (linked / "meshes").mkdir(parents=True)
    (linked / "package.xml").symlink_to(package / "package.xml")
    (linked / "meshes" / "trunk.stl").symlink_to(package / "meshes" / "trunk.stl")
    assert trunk(file, workspace / "share") == trunk(file, package)
    (workspace / "round").symlink_to(workspace)  # a loop of links ends
    assert trunk(file, workspace) == trunk(file, package)


@pytest.mark.parametrize("name", ["walker_description-main", "walker_description-1.2.0", "walker_description"])
def test_an_unpacked_archive_without_a_manifest_is_found_by_its_name(name, package):
    (package / "package.xml").unlink()
    folder = package.rename(package.with_name(name))
    assert trunk(folder / "urdf" / "walker.urdf", folder.parent) == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)


def test_a_manifest_that_names_another_package_is_not_taken(package):
    (package / "package.xml").write_text(MANIFEST.replace("walker_description", "dog_description"))
    with pytest.raises(UnreadableFile, match="none of them is walker_description"):
        trunk(package / "urdf" / "walker.urdf", package.parent)


def test_a_package_without_the_mesh_says_so(package):
    (package / "meshes" / "trunk.stl").unlink()
    with pytest.raises(UnreadableFile, match=r"has no such file. Put the mesh where the file says it is"):
        trunk(package / "urdf" / "walker.urdf", package)


def test_a_path_may_not_lead_out_of_its_package(package, tmp_path):
    file = package / "urdf" / "walker.urdf"
    trimesh.creation.box((1.0, 1.0, 1.0)).export(tmp_path / "ws" / "outside.stl")
    for path in ("../outside.stl", f"/{tmp_path / 'ws' / 'outside.stl'}"):
        file.write_text(TEXT.replace("meshes/trunk.stl", path))
        with pytest.raises(UnreadableFile, match=r"leads out of them|no such file"):
            trunk(file, package)


def test_what_is_no_folder_of_packages_is_refused_with_what_to_do(package, tmp_path):
    file = package / "urdf" / "walker.urdf"
    archive = tmp_path / "walker_description-main.zip"
    archive.write_bytes(b"PK")
    for folder, says in (
        (archive, "is an archive; unpack it"), (tmp_path / "nowhere", "is not there"), (file, "is no folder")
    ):  # fmt: skip
        with pytest.raises(UnreadableFile, match=says):
            trunk(file, folder)


def test_gazebo_names_and_relative_names_are_found(package):
    file = package / "urdf" / "walker.urdf"
    file.write_text(TEXT.replace("package://", "model://"))
    assert trunk(file, package) == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)
    above = package / "urdf" / "above.urdf"
    above.write_text(TEXT.replace("package://walker_description/", "../"))
    with pytest.raises(
        UnreadableFile, match=r"lies outside the folder .* Say --packages FOLDER for a folder that holds"
    ):
        trunk(above)
    assert trunk(above, package) == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)
    beside = package / "walker.urdf"
    beside.write_text(TEXT.replace("package://walker_description/", ""))
    assert trunk(beside) == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)
    (package / "meshes" / "trunk.stl").unlink()
    with pytest.raises(UnreadableFile, match=r"there is no file meshes/trunk\.stl. Put the mesh beside the file"):
        trunk(beside)
