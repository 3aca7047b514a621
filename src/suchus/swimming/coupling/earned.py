"""Whether a correction of the section model is earned: fitted to one swim in a flow, held against other swims.

The factors on added mass and drag of each link come from one swim. They are offered for a link only if in every other
swim, none of which the fit saw, they leave less of the flow's force unexplained than the model as it is shipped, by
more than cycles differ: the lower end of a bootstrap over blocks of half a cycle is above nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.robot.design import LinkFactors, Robot, SectionCorrection
from suchus.sim.land.prescribed import link_bodies
from suchus.swimming.coupling.residual import BLOCKS, COVERED, DRAWS, drawn, fitted, r2, sections_beside


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceParts:
    """Force across a link in one swim, and the two parts of what sections say of it."""

    flow: Float[np.ndarray, " sample"]
    """Of the flow [N]."""
    added: Float[np.ndarray, " sample"]
    """Of sections, by the acceleration [N]."""
    drag: Float[np.ndarray, " sample"]
    """Of sections, by the speed [N]."""
    block: int
    """Samples in half a cycle [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkJudgement:
    """What became of the factors of one link."""

    added: float
    """Factor on added mass that was fitted [-]."""
    added_interval: tuple[float, float]
    """Its interval [-]."""
    drag: float
    """Factor on drag [-]."""
    drag_interval: tuple[float, float]
    """Its interval [-]."""
    shipped: tuple[float, ...]
    """R2 of the model as it is shipped in each swim that was held out [-]."""
    corrected: tuple[float, ...]
    """R2 with the factors in each of them [-]."""
    why_not: str
    """Why the factors are not offered; empty if they are."""


def judged(fit: ForceParts, held_out: Sequence[ForceParts]) -> LinkJudgement:
    """Return the factors that one swim gives a link, and whether they help in the others."""
    added, drag = fitted(fit.flow, fit.added, fit.drag).tolist()
    draws = drawn(fit.flow, fit.added, fit.drag, fit.block)
    low, high = np.quantile(draws, [(1 - COVERED) / 2, (1 + COVERED) / 2], axis=0)
    shipped = tuple(r2(one.flow, one.added + one.drag) for one in held_out)
    corrected = tuple(r2(one.flow, added * one.added + drag * one.drag) for one in held_out)
    why = ""
    if not held_out:
        why = "no other swim to hold them against"
    elif not np.isfinite([*low, *high]).all():
        why = "too few cycles for an interval"
    elif low[0] < 0.0 or low[1] < 0.0:
        why = "a factor may be negative"
    elif not all(_gain(one, added, drag) > 0.0 for one in held_out):
        why = "no gain in every other swim"
    return LinkJudgement(
        added=added, added_interval=(float(low[0]), float(high[0])), drag=drag,
        drag_interval=(float(low[1]), float(high[1])), shipped=shipped, corrected=corrected, why_not=why,
    )  # fmt: skip


def _gain(one: ForceParts, added: float, drag: float) -> float:
    """Return the lower end of the interval of how much less the factors leave unexplained in a swim [N2]."""
    before, after = one.flow - one.added - one.drag, one.flow - added * one.added - drag * one.drag
    count = len(one.flow) // one.block
    if count < BLOCKS:
        return float("-inf")
    gains = (before**2 - after**2)[: count * one.block].reshape(count, one.block).mean(axis=1)
    means = gains[np.random.default_rng(count).integers(count, size=(DRAWS, count))].mean(axis=1)
    return float(np.quantile(means, (1 - COVERED) / 2))


def earned_correction(
    robot: Robot, records: Sequence[xr.Dataset], *, period: float, first: float, viscosity: float, name: str
) -> tuple[SectionCorrection | None, dict[str, LinkJudgement]]:
    """Return the correction that swims in a flow have earned, if any link has, and the judgement of every link.

    Args:
        robot: that swam.
        records: of one run each, in a flow of one viscosity; the factors are fitted to the first and held against the
            others.
        period: of a cycle [s].
        first: time from which samples count [s].
        viscosity: kinematic, of the flow's water [m2/s].
        name: of the correction.
    """
    each = [sections_beside(robot, record, first=first, viscosity=viscosity) for record in records]
    links = link_bodies(robot, each[0].joints)
    found = {}
    for k, link in enumerate(each[0].names[: each[0].links]):
        parts = [
            ForceParts(
                flow=one.flow[one.keep, k], added=one.added[one.keep, k], drag=one.drag[one.keep, k],
                block=max(round(0.5 * period / one.step), 2),
            )
            for one in each
        ]  # fmt: skip
        found[link] = judged(parts[0], parts[1:])
    reynolds = robot.length**2 / (period * viscosity)
    factors = tuple(
        LinkFactors(
            bodies=bodies, added=one.added, drag=one.drag, added_interval=one.added_interval,
            drag_interval=one.drag_interval,
        )
        for bodies, one in zip(links, found.values(), strict=True)
        if not one.why_not
    )  # fmt: skip
    correction = SectionCorrection(name=name, reynolds=(reynolds, reynolds), links=factors) if factors else None
    return correction, found


def judgement_text(found: dict[str, LinkJudgement], swims: Sequence[str]) -> str:
    """Return the judgement of every link as Markdown, the other swims by their names."""
    head = "".join(f" R2 in {swim}, shipped | corrected |" for swim in swims)
    lines = [f"| link | added mass x | drag x |{head} offered |\n", f"|---|---:|---:|{'---:|---:|' * len(swims)}---|\n"]
    for link, one in found.items():
        factors = (
            f"{value:.2f} ({low:.2f} to {high:.2f})" if low <= high else f"{value:.2f}"
            for value, (low, high) in ((one.added, one.added_interval), (one.drag, one.drag_interval))
        )
        shares = "".join(
            f" {before:.2f} | {after:.2f} |" for before, after in zip(one.shipped, one.corrected, strict=True)
        )
        lines.append(f"| {link} | {' | '.join(factors)} |{shares} {one.why_not or 'yes'} |\n")
    return "".join(lines)
