"""The browser of whoever sits in front of this machine, where there is one with windows."""

import webbrowser
from pathlib import Path

_TEXT = ("www-browser", "links", "elinks", "lynx", "w3m")
"""Browsers that draw letters only, and would take the terminal."""


def browser() -> webbrowser.BaseBrowser | None:
    """Return the browser that an address is opened with, or None where there is none that draws.

    It is the one that ``BROWSER`` names, or the system's; on Linux without a display there is none.
    """
    try:
        found = webbrowser.get()
    except webbrowser.Error:
        return None
    return None if called(found) in _TEXT else found


def called(found: webbrowser.BaseBrowser) -> str:
    """Return the name of a browser, as it is called on the command line."""
    return Path(str(getattr(found, "name", ""))).name or type(found).__name__
