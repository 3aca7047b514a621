"""Passages of the pages on studies and searches, made from what they found; see ``stated``."""

from collections.abc import Callable, Mapping
from textwrap import fill
from typing import Any

_CALLED = {"coordinated": "with spine and tail", "limbs_only": "limbs only"}


def _time_steps(shares: Mapping[str, Any]) -> str:
    """Return how coarser time steps agreed with 2 ms, and which was taken."""
    lines = [
        "| time step | the same holds | displacement, median and 95th percentile of the difference "
        "| claim whose share moves most | by chance |",
        "|---|---|---|---|---|",
    ]
    for one in shares["agreement"]:
        lines.append(
            f"| {1e3 * one['timestep']:g} ms | {one['same']:.1%} | {1e3 * one['forward']:.1f} mm, "
            f"{1e3 * one['wide']:.0f} mm | {one['claim'].replace('_', ' ')}, {1e2 * one['shares']:.0f} points "
            f"| {one['chance']:.2g} |"
        )
    return "\n".join(lines) + f"\n\nSo it takes {1e3 * shares['timestep']:g} ms.\n"


def _became(shares: Mapping[str, Any]) -> str:
    """Return what became of the designs of the shipped table."""
    became = ", ".join(f"{count} {what}" for what, count in sorted(shares["became"].items(), key=lambda x: -x[1]))
    return fill(f"The table that suchus ships is of {shares['samples']} designs and gaits: {became}.", 118) + "\n"


def _best(outcome: Mapping[str, Any]) -> str:
    """Return the best crawls of both conditions beside where they began, and what they do otherwise."""
    lines = ["| | the article's legs | the best legs | under the other conditions |", "|---|---|---|---|"]
    reached, results = [], []
    for arm, one in outcome["arms"].items():
        best = next(iter(one["best"].values()))
        tried = [float(checks["aim_displacement"]) for name, checks in best["checks"].items()]
        reached.append(best["aims"]["displacement"])
        results.append((_CALLED[arm], one, best["sentence"]))
        lines.append(
            f"| {_CALLED[arm]} | {one['start']['displacement']:.2f} m | **{reached[-1]:.2f} m** "
            f"| {min(tried):.2f} to {max(tried):.2f} m |"
        )
    began = [one["start"]["displacement"] for one in outcome["arms"].values()]
    lines.append(f"| ratio | {began[0] / began[1]:.1f} | **{reached[0] / reached[1]:.1f}** | |")
    items = [
        fill(f"{name} ({one['tried']} candidates, {one['walked']} walked): {text}", 118, initial_indent="* ",
             subsequent_indent="  ") for name, one, text in results
    ]  # fmt: skip
    return "\n".join(lines) + "\n\n" + "\n".join(item[:2] + item[2].upper() + item[3:] for item in items) + "\n"


def _search(outcome: Mapping[str, Any]) -> str:
    """Return what another search found, in a line for each gait that it shows."""
    lines = []
    for one in outcome["arms"].values():
        began = ", ".join(_aim(outcome, name, value) for name, value in one["start"].items())
        for called, best in one["best"].items():
            got = ", ".join(_aim(outcome, name, value) for name, value in best["aims"].items())
            text = f"`{outcome['optimisation']}`, {one['tried']} candidates, {called}: {got}, from {began}. "
            lines.append(fill(text + best["sentence"], 118, initial_indent="* ", subsequent_indent="  "))
    return "\n".join(lines) + "\n"


def _aim(outcome: Mapping[str, Any], name: str, value: float | None) -> str:
    unit = outcome["aims"][name]["unit"]
    said = "none" if value is None else f"{value:.3g}" + ("" if unit in ("-", "1") else f" {unit}")
    return f"{name.replace('_', ' ')} {said}"


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, Any]], str]]] = {
    "claims": {"time_steps": _time_steps, "became": _became},
    "optimise_crawl": {"best_crawls": _best},
    "optimise_turn": {"best_turn": _search},
    "optimise_stand": {"best_stand": _search},
    "optimise_thrift": {"best_thrift": _search},
}
"""What makes each passage, by study."""
