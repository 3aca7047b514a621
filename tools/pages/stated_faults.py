"""Passages of the page on faults, made from the measures of ``joint_faults``; see ``stated``."""

from collections.abc import Callable, Mapping
from itertools import product
from textwrap import fill

from suchus.land import FAILED_JOINTS, KINDS, KNEES, LEGS_FAILED
from suchus.paper import CLAIMS
from suchus.verdict import Reading, compared, listed

_ARMS = {"coordinated": "spine and tail", "limbs_only": "limbs only"}


def _percent(value: float) -> str:
    return f"{100 * value:.0f}".replace("-0", "0") if abs(value) < 0.005 else f"{100 * value:.0f}"


def _losses(measures: Mapping[str, float]) -> str:
    """Return the table of all losses: median and range in percent, beside what is printed."""
    lines = [
        "| failed joint | condition | limp, one | limp, both | locked, one | locked, both | printed |",
        "|---|---|---|---|---|---|---|",
    ]
    for joint, (arm, name) in product((*FAILED_JOINTS, *KNEES), _ARMS.items()):
        cells = []
        for kind, legs in product(KINDS, LEGS_FAILED):
            loss = f"loss_{joint}_{kind}_{legs}_{arm}"
            middle, low, high = (_percent(measures[f"{loss}{end}"]) for end in ("", "_low", "_high"))
            cells.append(f"{middle} [{low}, {high}]")
        claim = CLAIMS.get(f"fault_{joint}_{arm}")
        printed = "not said" if claim is None else _percent(claim.value or 0.0)
        lines.append(f"| {joint.replace('_', ' ')} | {name} | {' | '.join(cells)} | {printed} |")
    intact = [
        f"{name}: {_percent(measures[key])} [{_percent(measures[f'{key}_low'])}, {_percent(measures[f'{key}_high'])}] %"
        for name, key in (
            ("limbs only", "loss_intact_limbs_only"),
            ("limbs only with the tail in the air", "loss_intact_limbs_tail_lifted"),
        )
    ]
    return "\n".join(lines) + f"\n\nIntact, {'; '.join(intact)}.\n"


def _steered(measures: Mapping[str, float]) -> str:
    """Return what steering makes of each loss and turn."""
    lines = ["| failed joint, limp in one leg | loss, steered | turn, steered |", "|---|---|---|"]
    doubled = []
    for joint in FAILED_JOINTS:
        name = joint.replace("_", " ")
        loss, turn = (
            [measures[f"{what}_{joint}_limp_one_{arm}"] for arm in ("coordinated", "steered")]
            for what in ("loss", "turn")
        )
        word = compared(-loss[1], -loss[0], less="less", more="more", same="the same", within=0.05)
        lines.append(
            f"| {name} | {_percent(loss[0])} to {_percent(loss[1])} % ({word}) | "
            f"{Reading(turn[0]):deg.0f} to {Reading(turn[1]):deg.0f} degrees |"
        )
        if loss[0] < 0 and loss[1] / loss[0] >= 1.75:
            doubled.append(f"{name} by a factor of {loss[1] / loss[0]:.1f}")
    said = f"Where steering does not help it makes the loss much greater: {listed(doubled)}.\n" if doubled else ""
    return "\n".join(lines) + "\n\n" + said


def _borne(measures: Mapping[str, float]) -> str:
    """Return how faults are borne, and what carries the body, with a hind pitch joint limp."""
    m = {name: Reading(value) for name, value in measures.items()}
    joints = listed([f"{j.replace('_', ' ')} {m[f'share_bear_better_{j}']:.0%}" for j in FAILED_JOINTS])
    raised = compared(m["com_rise_limp"], 0.0, less="lower", more="higher", same="as high")
    items = (
        '"Spine and tail make the robot bear faults better" holds in metres in '
        f"{m['share_spine_and_tail_ahead']:.0%} of all faults and variations. Measured against each condition's own "
        f"intact displacement it holds in {m['share_spine_and_tail_bear_better']:.0%} of them "
        f"({joints}), and by the mean over the faults in "
        f"{m['share_variations_bear_better']:.0%} of the variations: chance alone gives as many with a probability of "
        f"{m['chance_spine_and_tail_bear_better']:.2g} (exact sign test).",
        f'"Tail, right front leg and left hind leg" carry {m["support_share_limp"]:.0%} of the load while the damaged '
        f"hind leg swings, {m['support_share_intact']:.0%} when nothing is broken; the tail itself "
        f"{m['tail_load_limp']:.1f} N. The centre of mass is then {Reading(abs(m['com_rise_limp'])):mm.1f} mm {raised} "
        f"than with the joint intact, and the damaged foot is off the ground for {m['foot_free_limp']:.0%} of its "
        f"swing (intact {m['foot_free_intact']:.0%}).",
    )
    return "".join(fill(item, 118, initial_indent="* ", subsequent_indent="  ") + "\n" for item in items)


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, float]], str]]] = {
    "joint_faults": {"losses": _losses, "steered": _steered, "borne": _borne}
}
"""What makes each passage, by what was measured."""
