"""Whether a correction of the section model is valid: it is fitted to one swim in a flow and tested on other swims.

The factors on added mass and drag of each link come from one swim. A link gets factors only if they reduce the
unexplained force in every other swim. The reduction must be significant: the lower end of its interval, a bootstrap
over blocks of half a cycle, is above zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.robot.design import LinkFactors, Robot, SectionCorrection
from suchus.sim.land.prescribed import link_bodies
from suchus.swimming.coupling.residual import (
    BLOCKS,
    COVERAGE,
    DRAWS,
    bootstrap_factors,
    compare_sections,
    fit_factors,
    r2,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceParts:
    """Force across a link in one swim, and the two parts of the force that the section model predicts."""

    flow: Float[np.ndarray, " sample"]
    """Force across a link by the flow solver [N]."""
    added_mass: Float[np.ndarray, " sample"]
    """Force by the section model, the part by acceleration [N]."""
    drag: Float[np.ndarray, " sample"]
    """Force by the section model, the part by speed [N]."""
    block: int
    """Samples in half a cycle [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkJudgement:
    """The factors of one link, and whether they are valid."""

    added_mass_factor: float
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


def judge_link(fit: ForceParts, test_swims: Sequence[ForceParts]) -> LinkJudgement:
    """Return the factors of a link that one swim gives, and whether they reduce the error in other swims."""
    added_factor, drag_factor = fit_factors(fit.flow, fit.added_mass, fit.drag).tolist()
    draws = bootstrap_factors(fit.flow, fit.added_mass, fit.drag, fit.block)
    lower_bound, upper_bound = np.quantile(draws, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2], axis=0)
    shipped = tuple(r2(swim.flow, swim.added_mass + swim.drag) for swim in test_swims)
    corrected = tuple(r2(swim.flow, added_factor * swim.added_mass + drag_factor * swim.drag) for swim in test_swims)
    refusal = ""
    if not test_swims:
        refusal = "no other swim to hold them against"
    elif not np.isfinite([*lower_bound, *upper_bound]).all():
        refusal = "too few cycles for an interval"
    elif lower_bound[0] < 0.0 or lower_bound[1] < 0.0:
        refusal = "a factor may be negative"
    elif not all(_gain(swim, added_factor, drag_factor) > 0.0 for swim in test_swims):
        refusal = "no gain in every other swim"
    return LinkJudgement(
        added_mass_factor=added_factor, added_interval=(float(lower_bound[0]), float(upper_bound[0])), drag=drag_factor,
        drag_interval=(float(lower_bound[1]), float(upper_bound[1])), shipped=shipped, corrected=corrected,
        why_not=refusal,
    )  # fmt: skip


def _gain(swim: ForceParts, added_factor: float, drag_factor: float) -> float:
    """Return by how much the factors reduce the mean square residual: lower bound of its 95 % interval [N2]."""
    shipped_residual, corrected_residual = (
        swim.flow - swim.added_mass - swim.drag,
        swim.flow - added_factor * swim.added_mass - drag_factor * swim.drag,
    )
    count = len(swim.flow) // swim.block
    if count < BLOCKS:
        return float("-inf")
    gains = (shipped_residual**2 - corrected_residual**2)[: count * swim.block].reshape(count, swim.block).mean(axis=1)
    means = gains[np.random.default_rng(count).integers(count, size=(DRAWS, count))].mean(axis=1)
    return float(np.quantile(means, (1 - COVERAGE) / 2))


def earned_correction(
    robot: Robot, records: Sequence[xr.Dataset], *, period: float, start_time: float, viscosity: float, name: str
) -> tuple[SectionCorrection | None, dict[str, LinkJudgement]]:
    """Return the correction of all links with valid factors, None without one, and the judgement of every link.

    Args:
        robot: robot that swam.
        records: records of one run each, in a flow of one viscosity; the factors are fitted to the first and held
            against the others.
        period: period of a cycle [s].
        start_time: time from which samples count [s].
        viscosity: kinematic, of the flow's water [m2/s].
        name: name of the correction.
    """
    comparisons = [compare_sections(robot, record, start_time=start_time, viscosity=viscosity) for record in records]
    links = link_bodies(robot, comparisons[0].joints)
    judgements = {}
    for k, link in enumerate(comparisons[0].names[: comparisons[0].links]):
        parts = [
            ForceParts(
                flow=comparison.flow[comparison.keep, k],
                added_mass=comparison.added_mass[comparison.keep, k],
                drag=comparison.drag[comparison.keep, k],
                block=max(round(0.5 * period / comparison.step), 2),
            )
            for comparison in comparisons
        ]  # fmt: skip
        judgements[link] = judge_link(parts[0], parts[1:])
    reynolds = robot.length**2 / (period * viscosity)
    factors = tuple(
        LinkFactors(
            bodies=bodies, added=judgement.added_mass_factor, drag=judgement.drag,
            added_interval=judgement.added_interval, drag_interval=judgement.drag_interval,
        )
        for bodies, judgement in zip(links, judgements.values(), strict=True)
        if not judgement.why_not
    )  # fmt: skip
    correction = SectionCorrection(name=name, reynolds=(reynolds, reynolds), links=factors) if factors else None
    return correction, judgements


def judgement_text(judgements: dict[str, LinkJudgement], swims: Sequence[str]) -> str:
    """Return the judgement of every link as a Markdown table.

    Args:
        judgements: judgement of each link by its name.
        swims: names of the other swims.
    """
    head = "".join(f" R2 in {swim}, shipped | corrected |" for swim in swims)
    lines = [f"| link | added mass x | drag x |{head} offered |\n", f"|---|---:|---:|{'---:|---:|' * len(swims)}---|\n"]
    for link, judgement in judgements.items():
        factors = (
            f"{value:.2f} ({lower_bound:.2f} to {upper_bound:.2f})" if lower_bound <= upper_bound else f"{value:.2f}"
            for value, (lower_bound, upper_bound) in (
                (judgement.added_mass_factor, judgement.added_interval),
                (judgement.drag, judgement.drag_interval),
            )
        )
        shares = "".join(
            f" {shipped:.2f} | {corrected:.2f} |"
            for shipped, corrected in zip(judgement.shipped, judgement.corrected, strict=True)
        )
        lines.append(f"| {link} | {' | '.join(factors)} |{shares} {judgement.why_not or 'yes'} |\n")
    return "".join(lines)
