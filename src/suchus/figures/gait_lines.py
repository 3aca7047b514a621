"""Colour, marker, dashes and label by which a gait is drawn in every picture that compares gaits."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from suchus.figures.style import COLOURS

GAIT_LINES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "belly_crawl": {"color": "#767676", "marker": "v", "linestyle": (0, (1, 1.2)), "label": "belly crawl"},
        "low_crawl": {"color": "#009E73", "marker": "s", "linestyle": (0, (5, 2)), "label": "low crawl"},
        "semi_erect": {"color": "#0072B2", "marker": "o", "linestyle": "-", "label": "semi-erect"},
        "high_walk": {"color": "#D55E00", "marker": "^", "linestyle": (0, (5, 1.5, 1, 1.5)), "label": "high walk"},
        "high_walk_level": {"color": "#E69F00", "marker": "D", "linestyle": "-", "label": "high walk, IMU"},
        "switching": {"color": "#B0558A", "marker": "*", "linestyle": (0, (3, 1)), "label": "switching"},
        "thrifty": {
            "color": "#56B4E9",
            "marker": "P",
            "linestyle": (0, (3, 1, 1, 1)),
            "label": "switching, from crawl",
        },
    }
)
"""Colour, marker, dashes and label of each gait or arm."""
_MORE = ("#56B4E9", "#F0E442", "#B0558A")


def gait_lines(names: Iterable[Any]) -> Mapping[str, Mapping[str, Any]]:
    """Return ``GAIT_LINES`` with lines for further gaits, which are called by their names."""
    others = [str(name) for name in names if str(name) not in GAIT_LINES]
    return {
        **GAIT_LINES,
        **{
            name: {
                "color": COLOURS["coordinated"] if i == 0 else _MORE[i % len(_MORE)],
                "marker": "o",
                "linestyle": "-",
                "label": name.replace("_", " "),
            }
            for i, name in enumerate(others)
        },
    }
