"""The command line: ``suchus reproduce``, ``suchus run``, ``suchus list``."""

from suchus.apps.cli.entry import main

__all__ = ["main"]
