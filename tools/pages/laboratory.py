"""The laboratory in one page as a part of the site: built into it where its engine is at hand, and never committed."""

import sys
from functools import cache

from suchus.apps.laboratory.engine import NoEngine
from suchus.apps.laboratory.page import laboratory_page
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS

PAGE = "laboratory.html"
"""Name of the page in the site."""
MARK = "<!-- laboratory -->"
"""Where a page of ``docs`` leads to it, on a line of its own; without a build nothing is shown there."""
LINK = f"**Try it now: [open the laboratory]({PAGE}). It plays in this browser, and works offline once it is saved.**"


@cache
def pages() -> dict[str, str]:
    """Return the page by its path in the site; nothing where the engine is not on this machine, which is then said."""
    robot = ROBOTS["caiman"]
    try:
        return {PAGE: laboratory_page(robot, default_gait(robot))}
    except NoEngine as error:
        print(f"The site has no laboratory: {error}", file=sys.stderr)
        return {}


def linked(markdown: str) -> str:
    """Return a page of ``docs`` with a link to the laboratory at its mark, or without the mark if there is none."""
    return markdown.replace(MARK, LINK if pages() else "")
