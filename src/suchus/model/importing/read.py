"""From a file to a draft."""

from pathlib import Path

from suchus.design.checks import require
from suchus.errors import UnreadableFile
from suchus.model.importing.draft import Draft, draft_of
from suchus.model.importing.loading import load
from suchus.model.importing.options import Words
from suchus.model.importing.plan import plan_of
from suchus.model.importing.straighten import straightened
from suchus.model.importing.tree import tree_of


def import_robot(path: Path, *, name: str, words: Words | None = None) -> Draft:
    """Read a robot from a URDF or an MJCF: axis, girdles and limbs by geometry, drives and contact by its size.

    Nothing in the file is executed, and no file outside its folder is read.

    Args:
        path: the file.
        name: of the robot.
        words: answers to what geometry cannot say.

    Raises:
        UnreadableFile: it cannot be read, or is no tree of hinges with a mirror plane.
        UnknownName: a body that the words name is not there.
    """
    words = words or Words()
    if words.foot_radius is not None:
        require("import", "foot_radius", words.foot_radius, 1e-5, 10.0, "m")
    if words.heading is not None:
        require("import", "heading", words.heading, -360.0, 360.0, "degree")
    loaded = load(path)
    try:
        return draft_of(straightened(plan_of(tree_of(loaded), words)), name, words)
    except UnreadableFile as error:
        raise UnreadableFile(f"{path.name} cannot be imported: {error}") from error
