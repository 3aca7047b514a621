"""What the experiment ``joint_faults`` reads from its record: every number, what decides, a table."""

from collections.abc import Mapping
from itertools import combinations, product

import numpy as np
import xarray as xr
from scipy import stats

from suchus.experiment import Measure
from suchus.land import KINDS, LEGS_FAILED
from suchus.metrics import loss
from suchus.paper import CLAIMS

ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
_CELLS = ("joint", "kind", "legs", "arm")


def measures(record: xr.Dataset) -> Mapping[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened; its attributes ``judged_kind`` and ``judged_legs`` say which reading is steered,
            repeated, and run with the tail lifted.
    """
    reading = f"{record.attrs['judged_kind']}_{record.attrs['judged_legs']}"
    ours = record.intact_forward.sel(arm="coordinated", drop=True)
    found: dict[str, Measure] = {}
    for arm in ARMS:
        found[f"forward_{arm}"] = Measure(float(record.intact_forward.sel(arm=arm)[0]), "m")
    lifts, steers = "lifted_forward" in record, "steered_forward" in record
    if lifts:
        found["forward_limbs_tail_lifted"] = Measure(float(record.lifted_intact_forward[0]), "m")
    found |= _ranged("loss_intact_limbs_only", loss(record.intact_forward.sel(arm="limbs_only"), ours), "-")
    if lifts:
        found |= _ranged("loss_intact_limbs_tail_lifted", loss(record.lifted_intact_forward, ours), "-")
    found |= _readings(record)
    for joint in record.lost.values:
        name = f"loss_{joint}_{reading}"
        if steers:
            found |= _ranged(f"{name}_steered", loss(record.steered_forward, ours).sel(lost=joint), "-")
            turned = record.steered_turn.sel(lost=joint).median()
            found[f"turn_{joint}_{reading}_steered"] = Measure(float(turned), "rad")
        if lifts:
            found |= _ranged(f"{name}_limbs_tail_lifted", loss(record.lifted_forward, ours).sel(lost=joint), "-")
        for arm in ARMS:
            losses = loss(record.repeat_forward.sel(arm=arm), record.repeat_intact_forward.sel(arm="coordinated"))
            found |= _ends(f"{name}_{arm}_repeated", losses.sel(lost=joint), "-")
    return found | _effects(record) | tolerance(record) | _support(record)


def _readings(record: xr.Dataset) -> dict[str, Measure]:
    """Return what every reading of every failure costs in both conditions."""
    change = _changes(record)
    found: dict[str, Measure] = {}
    for cell in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        at, name = dict(zip(_CELLS, cell, strict=True)), "_".join(cell)
        found |= _ranged(f"loss_{name}", change["forward"].sel(at), "-")
        found[f"net_loss_{name}"] = Measure(float(change["net"].sel(at).median()), "-")
        found[f"path_loss_{name}"] = Measure(float(change["path"].sel(at).median()), "-")
        found[f"turn_{name}"] = Measure(float(record.turn.sel(at).median()), "rad")
    return found


def _effects(record: xr.Dataset) -> dict[str, Measure]:
    """Return by how much the change with spine and tail differs on average between two readings of one thing [-]."""
    change = _changes(record)["forward"].sel(arm="coordinated", joint=record.lost.values).median("variation")
    found = {}
    for name, dim in (("kind", "kind"), ("joint", "joint"), ("legs", "legs")):
        pairs = combinations(change[dim].values, 2)
        apart = [float(abs(change.sel({dim: a}) - change.sel({dim: b})).mean()) for a, b in pairs]
        found[f"effect_of_{name}"] = Measure(float(np.mean(apart)), "-")
    return found


def tolerance(record: xr.Dataset) -> dict[str, Measure]:
    """Return how much more of its own the robot keeps with spine and tail, and how probable that is by chance.

    The variations are independent of each other, the faults within one of them are not: the exact sign test counts
    variations, by the mean over all faults of the article's joints.
    """
    failed = record.lost.values if "lost" in record.coords else record.joint.values
    kept = _kept(record).sel(joint=failed)
    ours, bare = (kept.sel(arm=arm, drop=True) for arm in ARMS)
    better, gain = ours > bare, (ours - bare).mean(("joint", "kind", "legs"))
    won, decided = int((gain > 0).sum()), int((gain != 0).sum())
    chance = float(stats.binomtest(won, decided, 0.5, alternative="greater").pvalue) if decided else 1.0
    ahead = record.forward.sel(arm="coordinated") > record.forward.sel(arm="limbs_only")
    found = {
        "share_spine_and_tail_bear_better": Measure(float(better.mean()), "-"),
        "share_variations_bear_better": Measure(won / kept.sizes["variation"], "-"),
        "chance_spine_and_tail_bear_better": Measure(chance, "-"),
        "share_spine_and_tail_ahead": Measure(float(ahead.sel(joint=failed).mean()), "-"),
        "share_limbs_only_beyond_intact": Measure(float((bare > 1.0).mean()), "-"),
        "greatest_limbs_only_over_intact": Measure(float(bare.median("variation").max()), "-"),
    }
    for joint in failed:
        found[f"share_bear_better_{joint}"] = Measure(float(better.sel(joint=joint).mean()), "-")
    return found


def _support(record: xr.Dataset) -> dict[str, Measure]:
    """Return what carries the body while the right hind leg is meant to swing, and how high it is carried."""
    found: dict[str, Measure] = {}
    height, parts = record.swing_height, [str(part) for part in record.part.values]
    legs = [part for part in parts if part not in ("tail", "belly")]
    carriers = ["tail", *([legs[-3]] if len(legs) > 2 else []), legs[-2]]  # beside the last leg and ahead of it
    for state in (str(one) for one in record.state.values):
        load = record.support.sel(state=state)
        found |= {
            f"support_share_{state}": Measure(float(load.sel(part=carriers).sum() / load.sum()), "-"),
            f"tail_load_{state}": Measure(float(load.sel(part="tail")), "N"),
            f"foot_lift_{state}": Measure(float(record.lifted.sel(state=state)), "m"),
            f"foot_free_{state}": Measure(float(record.free.sel(state=state)), "-"),
            f"com_height_{state}": Measure(float(height.sel(state=state)), "m"),
            f"com_rise_{state}": Measure(float(height.sel(state=state) - height.sel(state="intact")), "m"),
        }
    return found


def table(record: xr.Dataset) -> str:
    """Return one row per fault and condition: medians over the variations, with ranges where a paper needs them."""
    change, own = _changes(record), loss(record.forward, record.intact_forward)
    head = "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
    rows = [head + "turn_deg,printed_change"]
    for cell in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        at = dict(zip(_CELLS, cell, strict=True))
        forward = change["forward"].sel(at)
        numbers = (
            record.forward.sel(at).median(),
            forward.median(),
            forward.min(),
            forward.max(),
            own.sel(at).median(),
            change["net"].sel(at).median(),
            change["path"].sel(at).median(),
        )
        medians = [f"{float(number):.3f}" for number in numbers]
        turned = f"{float(np.degrees(record.turn.sel(at).median())):.1f}"
        claim = CLAIMS.get(f"fault_{cell[0]}_{cell[3]}")  # of the knee the article says nothing
        printed = f"{claim.value:.2f}" if claim is not None else ""
        rows.append(",".join((*cell, *medians, turned, printed)))
    return "\n".join(rows) + "\n"


def _changes(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the changes against the intact run with spine and tail."""
    return {
        name: loss(record[name], record[f"intact_{name}"].sel(arm="coordinated", drop=True))
        for name in ("forward", "net", "path")
    }


def _kept(record: xr.Dataset) -> xr.DataArray:
    """Return the part of its own intact displacement that each condition keeps [-]; going backwards is 0."""
    return (record.forward / record.intact_forward).clip(min=0.0)


def _ranged(name: str, values: xr.DataArray, unit: str) -> dict[str, Measure]:
    return {name: Measure(float(values.median()), unit)} | _ends(name, values, unit)


def _ends(name: str, values: xr.DataArray, unit: str) -> dict[str, Measure]:
    return {f"{name}_low": Measure(float(values.min()), unit), f"{name}_high": Measure(float(values.max()), unit)}
