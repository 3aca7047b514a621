"""Passages of the page on the limits of the flow solver, made from what single runs measured; see ``stated``."""

from collections.abc import Callable, Mapping
from textwrap import fill
from typing import Any


def _sphere(m: Mapping[str, Any]) -> str:
    """Return what a sphere at Re 300 sheds, beside what is published."""
    text = (
        "- **A sphere at Re 300** sheds vortices to one side, as it should, in half a box of 9 x 4 x 4 diameters on 12 "
        f"cells a diameter, with 0.7 cells across its layer: Strouhal number {m['strouhal']:.3f} over the last four "
        f"periods of 100 diameters over the stream's speed, mean side force {m['side']:.3f}, drag {m['drag']:.3f} "
        "(Johnson and Patel 1999: 0.137, 0.069, 0.656; Kim, Kim and Choi 2001: 0.134, 0.067, 0.657; Constantinescu and "
        "Squires 2003: 0.136, 0.065, 0.655; Tomboulides, Orszag and Karniadakis 1993: 0.136, drag 0.671). The periods "
        f"are not alike yet, {m['period_least']:.1f} to {m['period_most']:.1f}, and the drag is too large as it is at "
        "Re 100 and 200 on so few cells. That took 74 s of processor time; 16 cells, which would take three times as "
        "long, and a limit in h^2 have not been run."
    )
    return fill(text, 120, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False) + "\n"


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, Any]], str]]] = {"sphere_300": {"sphere_300": _sphere}}
"""What makes each passage, by what was measured."""
