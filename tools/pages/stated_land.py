"""Passages of the pages on standing and terrain, made from what their experiments measured; see ``stated``."""

from collections.abc import Callable, Mapping
from textwrap import fill

from suchus.experiments import EXPERIMENTS
from suchus.verdict import Reading

_KINDS = {"bumps": "bumps", "step": "steps", "stone": "stones"}


def explained(experiment: str) -> Callable[[Mapping[str, float]], str]:
    """Return what writes the sentences of an experiment's report."""
    return lambda measures: fill(EXPERIMENTS[experiment].explain(measures), 118) + "\n"


def _gaits(measures: Mapping[str, float]) -> str:
    """Return the table of the gaits, each at its own cycle time, and what a torque-speed line changes."""
    m = {name: Reading(value) for name, value in measures.items()}
    lines = [
        "| gait | speed | fastest, over all cycle times | cost of transport | roll | joint speed |",
        "|---|---|---|---|---|---|",
    ]
    for gait in EXPERIMENTS["speed_range"].gaits:
        name = gait.name
        cells = (
            f"{m[f'speed_{name}']:.2f} m/s",
            f"{m[f'speed_{name}_fastest']:.2f} m/s",
            f"{m[f'cost_{name}']:.2f}",
            f"{m[f'roll_{name}']:deg.1f} deg",
            f"{m[f'joint_speed_{name}']:.1f} rad/s",
        )
        lines.append(f"| `{name}` | {' | '.join(cells)} |")
    names = [gait.name for gait in EXPERIMENTS["speed_range"].gaits]
    changed = max(abs(measures[f"speed_{name}_speed_line"] / measures[f"speed_{name}"] - 1.0) for name in names)
    return "\n".join(lines) + f"\n\nA torque-speed line in the servos changes these speeds by at most {changed:.0%}.\n"


def _rough(measures: Mapping[str, float]) -> str:
    """Return what each posture keeps of its displacement, by kind of ground, and what decided."""
    m = {name: Reading(value) for name, value in measures.items()}
    arms = [arm for arm in EXPERIMENTS["terrain"].arms() if f"falls_{arm}" in measures]
    lines = [
        "| posture | even ground | cost of transport there | kept on bumps | on steps | on stones | falls |",
        "|---|---|---|---|---|---|---|",
    ]
    for arm in arms:
        kept = [f"{m[f'kept_{kind}_{arm}']:.0%} (met {m[f'met_{kind}_{arm}']:.0%})" for kind in _KINDS]
        flat = f"{m[f'flat_forward_{arm}']:.2f} m", f"{m[f'flat_cost_{arm}']:.2f}"
        lines.append(f"| `{arm}` | {' | '.join((*flat, *kept))} | {m[f'falls_{arm}']:.0f} |")
    share, least, most = (m[f"erect_ahead_share{end}"] for end in ("", "_low", "_high"))
    text = (
        "Erect legs on rough ground: with the IMU, which the article does not name, the high walk gets farther than "
        f"the low crawl on {share:.0%} of the {m['rough_grounds']:.0f} rough grounds ({least:.0%} to {most:.0%} over "
        f"the seeds), open loop on {m['erect_open_loop_ahead_share']:.0%}. The semi-erect walk gets farther than both "
        f"on {m['semi_erect_ahead_of_both_share']:.0%}. The switching robot gets at least "
        f"{m['switching_share_of_best_worst']:.0%} as far as the best single posture, and within 5 % of it on "
        f"{m['switching_grounds_within_5_percent']:.0f} of {m['grounds']:.0f} grounds. Of {m['transitions']:.0f} "
        f"transitions between two postures {m['transitions_upright']:.0%} stay upright, with tilts of up to "
        f"{m['transition_tilt']:deg.0f} degrees."
    )
    return "\n".join(lines) + "\n\n" + fill(text, 118) + "\n"


def _room(measures: Mapping[str, float]) -> str:
    """Return the table of the working space."""
    m = {name: Reading(value) for name, value in measures.items()}
    rows = (("volume [litre]", "volume", 1e3, ".3g"), ("area from the side [m2]", "area", 1.0, ".2g"))
    lines = ["| | on four feet | on hind feet and tail |", "|---|---|---|"]
    for what, name, factor, form in rows:
        cells = []
        for state in ("crawling", "standing"):
            middle, low, high = (format(factor * m[f"{name}_{state}{end}"], form) for end in ("", "_low", "_high"))
            cells.append(f"{middle} ({low} to {high})")
        lines.append(f"| {what} | {' | '.join(cells)} |")
    lines.append(f"| highest [m] | {m['highest_crawling']:.2f} | {m['highest_standing']:.2f} |")
    return "\n".join(lines) + "\n\n" + explained("working_space")(measures)


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, float]], str]]] = {
    "speed_range": {"gaits": _gaits},
    "terrain": {"rough": _rough},
    "turning": {"turning": explained("turning")},
    "bipedal_reach": {"stand": explained("bipedal_reach")},
    "working_space": {"room": _room},
}
"""What makes each passage, by experiment."""
