"""The catalog of further commands: each file is one, of a project folder or of another package.

The commands that suchus comes with stand in ``suchus.apps.cli.entry``. A file of this folder, or of the folder
``commands`` of a project, declares ``command``, a class derived from ``suchus.apps.cli.command.UserCommand``. Its
command has the name of the file. Other packages name such classes by entry points of the group ``suchus.commands``.
Importing the catalog imports no command.
"""

from typing import TYPE_CHECKING

from suchus.core.catalog import Catalog

if TYPE_CHECKING:
    from suchus.apps.cli.command import UserCommand

COMMANDS: "Catalog[type[UserCommand]]" = Catalog(
    "command", "suchus.apps.commands", "suchus.apps.cli.command:UserCommand", classes=True
)

__all__ = ["COMMANDS"]
