"""Measures that the rules of the verdicts read of one design, by the names that the rules use."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from suchus.article.verdict import Rule, Word, ladder, word_of
from suchus.core.errors import IncompatibleRecord
from suchus.experiments.claims import RULES, design_sweep_of
from suchus.robot.design import LEGS
from suchus.robot.gaits import CONDITIONS
from suchus.sim.land import FAILED_JOINTS

FAULTY = ("coordinated", "limbs_only")
"""Conditions in which joints fail, too: the article's two groups."""
RUNS = (*CONDITIONS, *(f"{condition}_{joint}" for condition in FAULTY for joint in FAILED_JOINTS))
"""The runs of each sample: every condition intact, the two groups with each failed joint."""
_CONDITION_COLUMNS = {
    "forward": "displacement_x",
    "com_height_pp": "height_peak_to_peak",
    "com_height_std": "height_std",
    "roll_pp": "roll_peak_to_peak",
    "two_feet_share": "two_feet_share",
    "line_distance_max": "line_distance_max",
    "tail_load_share": "tail_load_share",
}
"""Measures of every condition, ``NAME_CONDITION``, and the column of the study that holds them."""
_CRAWL_COLUMNS = {
    "spine_sine_r2": "spine_sine_share",
    "diagonal_phase_error": "diagonal_phase_error",
    "spine_changes_per_cycle": "spine_swings",
    "tail_changes_per_cycle": "tail_swings",
    "spine_amplitude": "spine_amplitude",
    "tail_amplitude": "tail_amplitude",
    "tail_swing_least": "tail_swing_least",
    "tail_joint_spread": "tail_joint_spread_max",
}
"""Measures of the crawl with spine and tail, and their column."""
_GAINS = {
    "gain_spine_swing": ("coordinated", "tail_drag"),
    "gain_tail_swing": ("coordinated", "tail_still"),
    "gain_tail_contact": ("tail_still", "spine_only"),
}
"""Differences of displacement between two conditions."""
_CHANGES = {
    "com_height_pp_change": ("coordinated", "limbs_only"),
    "com_height_pp_change_tail_lifted": ("coordinated", "limbs_tail_lifted"),
    "wagging_pp_change": ("coordinated", "tail_still"),
    "tail_contact_pp_change": ("tail_still", "spine_only"),
    "tail_contact_pp_change_limbs_only": ("limbs_only", "limbs_tail_lifted"),
    "spine_swing_pp_change": ("coordinated", "tail_drag"),
}
"""Relative changes of the height's fluctuation from the second condition to the first."""
METRICS = (
    "displacement", "duty_factor", "foot_clearance", "height_peak_to_peak", "height_std", "roll_peak_to_peak",
    "two_feet_share", "line_distance_max", "tail_load_share", "diagonal_phase_error", "spine_sine_share",
    "spine_swings", "tail_swings", "spine_amplitude", "tail_amplitude", "tail_swing_least", "tail_joint_spread_max",
)  # fmt: skip
"""What a study of the claims measures of every run."""
_LEAST_RATIO = 0.02  # a displacement with limbs only below this part of that with spine and tail makes a ratio of 50
_STANDS = 0.01  # [m]; an intact robot that gets no farther has nothing to keep when a joint fails


def swept_rules() -> tuple[Rule, ...]:
    """Return the rules of the claims that the walks of a study of designs answer."""
    swept_claims = claims_varied()
    return tuple(rule for rule in RULES.values() if not rule.unswept and rule.claim not in swept_claims)


def claims_varied() -> frozenset[str]:
    """Return the claims that are answered by asking their experiment again, see ``verdict.Variation``."""
    sweeps = (design_sweep_of(name) for name in {rule.experiment for rule in RULES.values()})
    return frozenset(claim for sweep in sweeps if sweep is not None for claim in sweep.claims)


def measures_of(record: xr.Dataset, min_displacement: float) -> Mapping[str, np.ndarray]:
    """Return the measures that the rules read, each over all samples; NaN where there is nothing to measure.

    Args:
        record: the columns of ``METRICS`` over ``sample`` and ``run``, see ``RUNS``.
        min_displacement: least displacement of an intact robot with spine and tail for which a loss is measured [m].
    """

    def column_of(column: str, run: str) -> np.ndarray:
        missing = np.full(record.sizes["sample"], np.nan)
        return record[column].sel(run=run).values if column in record else missing

    measures = {f"{name}_{c}": column_of(column, c) for name, column in _CONDITION_COLUMNS.items() for c in CONDITIONS}
    measures |= {name: column_of(column, "coordinated") for name, column in _CRAWL_COLUMNS.items()}
    duty = [column_of(f"duty_factor_{leg}", "coordinated") for leg in LEGS]
    measures["duty_factor_greatest"] = np.max(duty, axis=0)
    for c in CONDITIONS:
        measures[f"hind_duty_{c}"] = np.maximum(*(column_of(f"duty_factor_{leg}", c) for leg in ("LH", "RH")))
        measures[f"hind_clearance_{c}"] = np.minimum(*(column_of(f"foot_clearance_{leg}", c) for leg in ("LH", "RH")))
    measures |= {
        name: measures[f"forward_{first_condition}"] - measures[f"forward_{second_condition}"]
        for name, (first_condition, second_condition) in _GAINS.items()
    }
    measures |= {
        name: measures[f"com_height_pp_{first_condition}"] / measures[f"com_height_pp_{second_condition}"] - 1
        for name, (first_condition, second_condition) in _CHANGES.items()
    }
    coordinated_distance = measures["forward_coordinated"]
    baseline = np.where(coordinated_distance > min_displacement, coordinated_distance, np.nan)
    for name, control in (("forward_ratio", "limbs_only"), ("forward_ratio_tail_lifted", "limbs_tail_lifted")):
        measures[name] = baseline / np.maximum(measures[f"forward_{control}"], _LEAST_RATIO * baseline)
    return measures | _faults({run: column_of("displacement_x", run) for run in RUNS}, baseline)


def _faults(forward: Mapping[str, np.ndarray], baseline: np.ndarray) -> dict[str, np.ndarray]:
    """Return the relative loss of displacement by failed joint, and the advantage of the robot with spine and tail."""
    measures: dict[str, np.ndarray] = {}
    for joint in FAILED_JOINTS:
        retained_fractions = []
        for condition in FAULTY:
            faulty, intact = forward[f"{condition}_{joint}"], forward[condition]
            measures[f"loss_{joint}_limp_one_{condition}"] = faulty / baseline - 1.0
            retained_fractions.append(np.maximum(faulty / np.where(intact > _STANDS, intact, np.nan), 0.0))
        measures[f"gain_{joint}_limp_one"] = retained_fractions[0] - retained_fractions[1]
    return measures


def select_measures(rule: Rule, measures: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the measures that a rule needs; a sample runs once, so that its value is also both ends of the interval.

    Args:
        rule: the claim's.
        measures: measures of all samples, see ``measures_of``.

    Raises:
        IncompatibleRecord: a measure is missing.
    """
    rule_measures = {}
    for name in sorted(rule.needs):
        plain = name if name in measures else name.removesuffix("_low").removesuffix("_high")
        if plain not in measures:
            raise IncompatibleRecord(
                f"the rule for {rule.claim} needs {name}, which the study of the claims does not measure; "
                "measure it there, or say in the rule's `unswept` why no share of designs is known."
            )
        rule_measures[name] = measures[plain]
    return rule_measures


def judge_samples(rule: Rule, measures: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the number of a claim in every sample, NaN where it is not judged, and whether its statement holds.

    A sample whose intervals leave the statement undecided is not judged, nor one whose control group does not do what
    the claim needs, nor one of which models disagree.

    Args:
        rule: the claim's.
        measures: measures of all samples, see ``measures_of``.
    """
    rule_measures, rows = select_measures(rule, measures), _rows(rule, measures)
    if rule.rungs:
        sample_voices = [ladder.voices(rule, row) for row in rows]
        number = np.array([ladder.value_and_interval(voices).median for voices in sample_voices], dtype=float)
        answers = [None if ladder.disagree(voices) else ladder.agreed(voices) for voices in sample_voices]
    else:
        number = np.asarray(rule_measures[rule.measure], dtype=float)
        answers = [rule.held(row) if rule.testable(row) else None for row in rows]
    number = np.where([answer is None for answer in answers], np.nan, number)
    return number, np.array([answer is True for answer in answers], dtype=bool) & np.isfinite(number)


def words(rule: Rule, measures: Mapping[str, np.ndarray]) -> list[Word]:
    """Return the word of a claim in every sample.

    Args:
        rule: the claim's.
        measures: measures of all samples, see ``measures_of``.
    """
    return [word_of(rule, row) for row in _rows(rule, measures)]


def _rows(rule: Rule, measures: Mapping[str, np.ndarray]) -> list[dict[str, float]]:
    """Return the measures that a rule needs, for each sample."""
    rule_measures = select_measures(rule, measures)
    return [
        dict(zip(rule_measures, row, strict=True))
        for row in zip(*(column.tolist() for column in rule_measures.values()), strict=True)
    ]
