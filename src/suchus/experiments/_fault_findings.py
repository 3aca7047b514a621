"""What the experiment ``joint_faults`` reads from its record: every number, a verdict on each claim, a table."""

from collections.abc import Mapping
from itertools import product

import numpy as np
import xarray as xr

from suchus.experiment import Measure, Verdict, judge
from suchus.land import KINDS, LEGS_LOST, LOST
from suchus.land.lost import Kind, Legs
from suchus.metrics import loss, says
from suchus.paper import CLAIMS

ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
_CELLS = ("joint", "kind", "legs", "arm")
_CARRIERS = ("tail", "RF", "LH")  # what the article says carries the body while the damaged RH swings


def measures(record: xr.Dataset, kind: Kind, legs: Legs) -> Mapping[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened.
        kind: the reading of 'lost' that is steered.
        legs: whether one leg or both of a girdle are steered.
    """
    change = _changes(record)
    found: dict[str, Measure] = {}
    for arm in ARMS:
        found[f"forward_{arm}"] = Measure(float(record.intact_forward.sel(arm=arm)[0]), "m")
    bare = loss(record.intact_forward.sel(arm="limbs_only"), record.intact_forward.sel(arm="coordinated"))
    found |= _ranged("loss_intact_limbs_only", bare, "-")
    for cell in product(LOST, KINDS, LEGS_LOST, ARMS):
        at, name = dict(zip(_CELLS, cell, strict=True)), "_".join(cell)
        found |= _ranged(f"loss_{name}", change["forward"].sel(at), "-")
        found[f"net_loss_{name}"] = Measure(float(change["net"].sel(at).median()), "-")
        found[f"path_loss_{name}"] = Measure(float(change["path"].sel(at).median()), "-")
        found[f"turn_{name}"] = Measure(float(record.turn.sel(at).median()), "rad")
    kept = loss(record.steered_forward, record.intact_forward.sel(arm="coordinated", drop=True))
    for joint in LOST:
        name = f"{joint}_{kind}_{legs}_steered"
        found |= _ranged(f"loss_{name}", kept.sel(joint=joint), "-")
        found[f"turn_{name}"] = Measure(float(record.steered_turn.sel(joint=joint).median()), "rad")
    better, beyond = _bears_better(record), _kept(record).sel(arm="limbs_only")
    found["share_spine_and_tail_bear_better"] = Measure(float(better.mean()), "-")
    found["share_limbs_only_beyond_intact"] = Measure(float((beyond > 1.0).mean()), "-")
    found["greatest_limbs_only_over_intact"] = Measure(float(beyond.median("variation").max()), "-")
    for state in record.state.values:
        found[f"support_share_{state}"] = Measure(_carried(record, str(state)), "-")
        found[f"foot_lift_{state}"] = Measure(float(record.lifted.sel(state=state)), "m")
    return found


def verdicts(record: xr.Dataset, kind: Kind, legs: Legs) -> tuple[Verdict, ...]:
    """Return what became of the article's claims.

    Args:
        record: what happened.
        kind: the reading of 'lost' that is judged.
        legs: whether one leg or both of a girdle are judged.
    """
    change = _changes(record)["forward"].median("variation")
    judged = []
    for joint, arm in product(LOST, ARMS):
        key, cells = f"fault_{joint}_{arm}", change.sel(joint=joint, arm=arm)
        value = float(cells.sel(kind=kind, legs=legs))
        why = _why(record, cells, arm, f"{kind}, {legs}")
        judged.append(judge(key, value, why, holds=bool(says(key, np.array(value)))))
    better = _bears_better(record)
    by_joint = ", ".join(f"{j.replace('_', ' ')} {100 * float(better.sel(joint=j).mean()):.0f} %" for j in LOST)
    ahead = (record.forward.sel(arm="coordinated") > record.forward.sel(arm="limbs_only")).mean()
    carried = {str(state): _carried(record, str(state)) for state in record.state.values}
    return (
        *judged,
        judge(
            "fault_support",
            carried[kind],
            f"While the damaged right hind leg is meant to swing, tail, right front and left hind foot carry "
            f"{100 * carried[kind]:.0f} % of the weight with its pitch joint {kind}, "
            f"{100 * carried['intact']:.0f} % intact; the tail's own part is {_tail(record, kind):.1f} N. The "
            f"foot rises {1000 * float(record.lifted.sel(state=kind)):.0f} mm "
            f"(intact {1000 * float(record.lifted.sel(state='intact')):.0f} mm).",
            holds=carried[kind] > 0.5 and float(record.lifted.sel(state=kind)) > 0.002,
        ),
        judge(
            "fault_tolerance",
            float(better.mean()),
            "Part of all faults and variations in which more of its own intact displacement is kept with spine "
            f"and tail than with limbs only: {by_joint}. In metres it is ahead in {100 * float(ahead):.0f} %.",
            holds=float(better.mean()) > 0.5,
        ),
    )


def table(record: xr.Dataset) -> str:
    """Return one row per fault and arm: medians over the variations, with ranges where a paper needs them."""
    change, own = _changes(record), loss(record.forward, record.intact_forward)
    head = "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
    rows = [head + "turn_deg,printed_change"]
    for cell in product(LOST, KINDS, LEGS_LOST, ARMS):
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
        told = [f"{float(number):.3f}" for number in numbers]
        turned = f"{float(np.degrees(record.turn.sel(at).median())):.1f}"
        printed = f"{CLAIMS[f'fault_{cell[0]}_{cell[3]}'].value:.2f}"
        rows.append(",".join((*cell, *told, turned, printed)))
    return "\n".join(rows) + "\n"


def _why(record: xr.Dataset, cells: xr.DataArray, arm: str, judged: str) -> str:
    """Return what each reading of the fault gives, and how far the intact robot of the arm is behind."""
    told = "; ".join(
        f"{kind}, {legs} {100 * float(cells.sel(kind=kind, legs=legs)):+.0f} %"
        for kind, legs in product(KINDS, LEGS_LOST)
    )
    text = f"Medians over {record.sizes['variation']} gaits and frictions: {told}; judged is {judged}."
    if arm == "coordinated":
        return text
    bare = loss(record.intact_forward.sel(arm="limbs_only"), record.intact_forward.sel(arm="coordinated"))
    key = str(cells.joint.values)
    printed = CLAIMS[f"fault_{key}_limbs_only"].value or 0.0
    ways = {a: CLAIMS[f"displacement_{a}"].value or 0.0 for a in ARMS}
    left = ways["coordinated"] * (1.0 + printed)
    text += f" The intact robot of limbs alone is already at {100 * float(bare.median()):+.0f} %."
    if left > ways["limbs_only"]:
        text += (
            f" The article's {100 * printed:+.0f} % leave {left:.2f} m, more than its own intact "
            f"{ways['limbs_only']:.2f} m."
        )
    return text


def _changes(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the changes against the intact run with spine and tail."""
    return {
        name: loss(record[name], record[f"intact_{name}"].sel(arm="coordinated", drop=True))
        for name in ("forward", "net", "path")
    }


def _kept(record: xr.Dataset) -> xr.DataArray:
    """Return the part of its own intact displacement that each arm keeps; going backwards is keeping nothing [-]."""
    return (record.forward / record.intact_forward).clip(min=0.0)


def _bears_better(record: xr.Dataset) -> xr.DataArray:
    """Tell where the robot keeps more of its own with spine and tail than with limbs only."""
    kept = _kept(record)
    return kept.sel(arm="coordinated") > kept.sel(arm="limbs_only")


def _ranged(name: str, values: xr.DataArray, unit: str) -> dict[str, Measure]:
    return {
        name: Measure(float(values.median()), unit),
        f"{name}_low": Measure(float(values.min()), unit),
        f"{name}_high": Measure(float(values.max()), unit),
    }


def _carried(record: xr.Dataset, state: str) -> float:
    load = record.support.sel(state=state)
    return float(load.sel(part=list(_CARRIERS)).sum() / load.sum())


def _tail(record: xr.Dataset, state: str) -> float:
    return float(record.support.sel(state=state, part="tail"))
