"""Passages of the page on the limits of the flow solver, made from what single runs measured; see ``stated``."""

from collections.abc import Callable, Mapping
from textwrap import fill
from typing import Any


def _sphere(m: Mapping[str, Any]) -> str:
    """Return what a sphere at Re 300 sheds, beside what is published."""

    def three(key: str, digits: int = 3) -> str:
        return f"{m[key + '_16']:.{digits}f} and {m[key + '_24']:.{digits}f}, limit {m[key + '_limit']:.{digits}f}"

    text = (
        "- **A sphere at Re 300** sheds vortices to one side, as it should, in half a box of 9 x 4 x 4 diameters. On "
        "16 and 24 cells a diameter, over the last four periods of 110 diameters over the stream's speed, and in the "
        f"limit of small cells by h^2: Strouhal number {three('strouhal')}; mean side force {three('side', 4)}; drag "
        f"{three('drag')} (Johnson and Patel 1999: 0.137, 0.069, 0.656; Kim, Kim and Choi 2001: 0.134, 0.067, 0.657; "
        "Constantinescu and Squires 2003: 0.136, 0.065, 0.655; Tomboulides, Orszag and Karniadakis 1993: 0.136, drag "
        f"0.671). The periods are {m['period_least_16']:.2f} to {m['period_most_16']:.2f} long on 16 cells, "
        f"{m['period_least_24']:.2f} to {m['period_most_24']:.2f} on 24."
    )
    return fill(text, 120, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False) + "\n"


def _speed(m: Mapping[str, Any]) -> str:
    """Return how fast the flow solver was, beside what the issue asked for and what the memory gave."""

    def both(key: str) -> str:
        one, two = m[f"{key}_1"], m[f"{key}_2"]
        return f"{one:.0f} | {two:.0f} | {two / one:.2f}"

    rows = [
        "| single precision | M cells/s, one thread | two threads | two over one |",
        "|---|---|---|---|",
        f"| 512 x 256, moving eel | {both('eel_128')} |",
        f"| 1024 x 512, moving eel | {both('eel_256')} |",
        f"| 128 x 64 x 64, sphere at rest | {both('rest_128')} |",
        f"| 192 x 96 x 96, sphere at rest (asked: 22, 1.6 times that) | {both('rest_192')} |",
        f"| 128 x 64 x 64, swinging ellipsoid | {both('ellipsoid_128')} |",
        f"| 192 x 96 x 96, swinging ellipsoid (asked: 12) | {both('ellipsoid_192')} |",
        "",
        f"The memory gave {m['memory_1']:.0f} GB/s to one thread and {m['memory_2']:.0f} to two, far from the caches; "
        f"at arithmetic alone two threads were {m['arithmetic']:.2f} times as fast as one. A cell in space takes "
        f"{m['rest_192_bytes']:.0f} bytes (asked: 120 at most). A cycle of the robot's free swim takes "
        f"{m['swim_96_1']:.1f} s on one thread and {m['swim_96_2']:.1f} on two at 96 cells a length (asked: 6 on two), "
        f"{m['swim_96_steps']} steps; at 128 cells {m['swim_128_1']:.1f} and {m['swim_128_2']:.1f} s (asked: 12), "
        f"{m['swim_128_steps']} steps.",
    ]
    return "\n".join(rows) + "\n"


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, Any]], str]]] = {
    "sphere_300": {"sphere_300": _sphere},
    "bench_flow": {"flow_speed": _speed},
}
"""What makes each passage, by what was measured."""
