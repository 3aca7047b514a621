"""The schema of a run on land: dimensions, variables and units of its ``xarray.Dataset``, and its ground as text."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.errors import IncompatibleRecord, SuchusError
from suchus.robot.design.ground import Bumps, Grains, Ground, Step, Stone
from suchus.robot.design.layout import LEGS

_MAX_NUMBER, _UNIT = 1e9, 1e-3  # numbers of a record in SI units; how far a unit quaternion's length may be off
_MAX_TIME, _MIN_SAMPLE_INTERVAL = 1e7, 1e-7  # [s]
_TIME_TOLERANCE = 1e-9  # [s]
_MAX_APPROACH = 3600.0  # [s]; time before zero in which a driven robot goes to its first posture
_MIN_STEPS = 4  # between samples; where there are fewer, none is longer than all the rest
_RUN_LIMITS = {
    "mass": (1e-9, 1e9),
    "period": (1e-9, 1e9),
    "duty_factor": (0.0, 1.0),
    "ended": (-_TIME_TOLERANCE, _MAX_TIME),
}
XYZ = ("x", "y", "z")
WXYZ = ("w", "x", "y", "z")

VARIABLES: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "position": (("time", "xyz"), "m", "pelvis in the world"),
    "orientation": (("time", "wxyz"), "1", "pelvis in the world, unit quaternion"),
    "centre_of_mass": (("time", "xyz"), "m", "of the whole robot in the world"),
    "angular_momentum": (("time", "xyz"), "kg m2/s", "of the whole robot about its centre of mass, in the world"),
    "snout": (("time", "xyz"), "m", "tip of the snout in the world"),
    "tail_tip": (("time", "xyz"), "m", "tip of the tail in the world"),
    "foot_position": (("time", "leg", "xyz"), "m", "centre of each foot in the world"),
    "foot_roll": (
        ("time", "leg", "xyz"),
        "m",
        "displacement of each foot's centre by the rolling of its ball since the first sample, in the world",
    ),
    "foot_force": (("time", "leg", "xyz"), "N", "of the ground on the ball of each foot, in the world"),
    "limb_force": (("time", "leg", "xyz"), "N", "of the ground on the links of each limb, foot aside, in the world"),
    "belly_force": (("time", "segment", "xyz"), "N", "of the ground on each body of the trunk, in the world"),
    "tail_force": (("time", "xyz"), "N", "of the ground on the tail, in the world"),
    "joint_angle": (("time", "joint"), "rad", "every hinge"),
    "servo_angle": (("time", "servo"), "rad", "at the servo's shaft"),
    "servo_velocity": (("time", "servo"), "rad/s", "at the servo's shaft"),
    "servo_torque": (("time", "servo"), "N m", "at the servo's shaft"),
    "servo_target": (("time", "servo"), "rad", "commanded angle"),
    "limb_phase": (("time", "leg"), "1", "phase of each limb, not wrapped [cycle]"),
    "angular_velocity": (("time", "xyz"), "rad/s", "of the pelvis, in its own frame"),
    "acceleration": (("time", "xyz"), "m/s2", "of the pelvis with gravity, in its own frame"),
}
"""Name of each variable: its dimensions after ``run``, its unit, what it is."""

WATER: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "water_level": (("time",), "m", "of the surface above the world's origin, against gravity"),
    "air_fraction": (("time",), "1", "share of the hull's air that is kept"),
    "air_fraction_front": (("time",), "1", "share of the air of the hull's front chambers that is kept"),
    "share_under": (("time",), "1", "volume under water over the whole volume, foam included"),
    "water_force": (("time", "xyz"), "N", "of the water on the robot, in the world"),
    "water_power": (("time",), "W", "of the water on the robot"),
    "feet_share": (("time",), "1", "of the weight that the feet carry"),
}
"""Further variables of runs in water, as in ``VARIABLES``.

Force and power are means over the time since the sample before. They hold what the added mass took by the accelerations
of the physics step before.
"""

EFFORT: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "servo_mean_torque": (("time", "servo"), "N m", "mean torque at the servo's shaft"),
    "servo_mean_square_torque": (("time", "servo"), "N2 m2", "mean of the torque squared at the servo's shaft"),
    "servo_power": (("time", "servo"), "W", "mean power of the servo on its joint, negative where it brakes"),
    "servo_absolute_power": (("time", "servo"), "W", "mean power of the servo, braking counted as much as driving"),
    "servo_peak_torque": (("time", "servo"), "N m", "greatest magnitude of the torque at the servo's shaft"),
    "servo_torque_use": (("time", "servo"), "1", "greatest torque over the torque that the servo has at its speed"),
}
"""What servos do between the sample before and each sample, as in ``VARIABLES``: over all physics steps between them.

``servo_torque`` of ``VARIABLES`` is the reading of a sensor at the instant of the sample, when the servo has answered
its last command. Work, heat and peaks are those of this table. The first sample has the values of its instant.
"""

HEAT: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "servo_temperature": (("time", "servo"), "degC", "of the winding; NaN where it does not warm up"),
}
"""Further variables of runs whose robots have servos that warm up, as in ``VARIABLES``."""

ELECTRICAL: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "servo_electrical_power": (
        ("time", "servo"),
        "W",
        "mean power that the servo draws from its supply: copper and idle losses, and driving; NaN without a winding",
    ),
}
"""Further variables of runs whose robots have servos with windings, as in ``EFFORT``."""

COUPLED: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "link_force": (
        ("time", "link", "xyz"),
        "N",
        "of the water on each link between two lateral joints, or each moving piece, in the world",
    ),
    "link_torque": (
        ("time", "link"),
        "N m",
        "of the water on each link about the vertical through its middle",
    ),
    "joint_water_torque": (("time", "joint"), "N m", "of the water on each joint that it feels, NaN for the others"),
    "coupling_residual": (("time",), "1", "force left over by the step, over the greatest so far"),
    "coupling_first": (("time",), "1", "the same before the step was corrected"),
    "coupling_iterations": (("time",), "1", "corrections of the step"),
    "energy_error": (("time",), "1", "what is missing in the robot's balance of energy so far, over its servos' work"),
    "power_error": (("time",), "1", "work of the water by force and way, less that by the flow's own account, over it"),
}
"""Further variables of runs whose water is a flow that is solved together with the robot, as in ``VARIABLES``.

Forces and torques are means over the control period before each sample; the rest is of the step that holds the sample.
"""

BUS_VARIABLES: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "tick_began": (("time",), "s", "delay of the tick against its plan"),
    "tick_took": (("time",), "s", "from the beginning of the tick until its goals were sent"),
    "servo_asked": (("time", "servo"), "rad", "angle that the controller asked for, before limits and steps"),
    "servo_heard": (
        ("time", "servo"),
        "1",
        "1 where the servo answered in the tick, 0 where its last reading stays",
    ),
    "reading_age": (("time", "servo"), "s", "age of the reading that was used"),
    "servo_current": (("time", "servo"), "A", "of the servo, in the sense of its torque"),
    "servo_voltage": (("time", "servo"), "V", "at the servo's plug"),
    "servo_error": (("time", "servo"), "1", "bits of the servo's alert; 0 for none"),
    **HEAT,
}
"""Further variables of runs of servos over a bus, as in ``VARIABLES``; what nobody measured is NaN there."""

PER_RUN: Mapping[str, tuple[str, str]] = {
    "mass": ("kg", "of the robot"),
    "period": ("s", "of the gait"),
    "duty_factor": ("1", "of the gait"),
    "ended": ("s", "time of the last valid sample"),
    "cause": ("1", "why the run ended early; empty if it did not"),
    "stands_on": ("1", "the ground as JSON, slopes [rad], lengths [m]; empty if the robot floats; see ``ground_of``"),
}

_INDEXED = ("run", "time", "leg", "segment", "joint", "servo")


def dataset(
    arrays: Mapping[str, np.ndarray],
    per_run: Mapping[str, np.ndarray],
    coordinates: Mapping[str, Sequence[object] | np.ndarray],
) -> xr.Dataset:
    """Put arrays into the schema.

    Args:
        arrays: one per name of ``VARIABLES``, each ``(run, *dimensions)``; further ones of ``EFFORT`` and ``HEAT``.
        per_run: one per name of ``PER_RUN``, each ``(run,)``.
        coordinates: labels of the dimensions ``run``, ``time``, ``leg``, ``segment``, ``joint``, ``servo``; further
            ones belong to ``run``.

    Raises:
        IncompatibleRecord: a variable is missing.
    """
    missing = [name for name in VARIABLES if name not in arrays] + [name for name in PER_RUN if name not in per_run]
    if missing:
        raise IncompatibleRecord(f"a record needs {', '.join(missing)} too.")
    label_dims = {name: name if name in _INDEXED else "run" for name in coordinates}
    data = xr.Dataset(
        coords={
            "xyz": list(XYZ),
            "wxyz": list(WXYZ),
            **{name: (label_dims[name], np.asarray(labels)) for name, labels in coordinates.items()},
        },
        attrs={"schema": "suchus land record 1"},
    )
    data.coords["time"].attrs["units"] = "s"
    sampled = {
        name: (("run", *dims), arrays[name], {"units": unit, "long_name": long_name})
        for name, (dims, unit, long_name) in {**VARIABLES, **EFFORT, **HEAT, **ELECTRICAL}.items()
        if name in arrays
    }
    of_runs = {
        name: ("run", per_run[name], {"units": u, "long_name": long_name}) for name, (u, long_name) in PER_RUN.items()
    }
    # all at once: one at a time each copies and aligns what is there, a twentieth of the time of a run alone
    return data.assign(sampled | of_runs)


def check_land(record: xr.Dataset, names: Sequence[str], source: str) -> None:
    """Refuse a dataset that is no record of runs on land.

    Args:
        record: any.
        names: names among ``VARIABLES`` that are needed.
        source: name of the record in messages.

    Raises:
        IncompatibleRecord: a variable is missing, or has other dimensions, labels or numbers than the schema says.
    """
    missing = [name for name in names if name not in record]
    if missing or "time" not in record.coords:
        raise IncompatibleRecord(f"{source} is no record of a run on land: it lacks {', '.join(missing) or 'time'}.")
    if not record.time.size:
        raise IncompatibleRecord(f"{source} has no frame; run for longer than one sample.")
    if meaning_errors := list(filter(None, (_other_meaning(record, name) for name in ("time", *names)))):
        raise IncompatibleRecord(
            f"{source} holds {'; '.join(meaning_errors)}: records are in SI units, as suchus writes them."
        )
    invalid_names = [name for name in names if not _fits_schema(record, name)]
    invalid_names += [
        name for name in ("label", "gait", "robot", *PER_RUN) if name in record and not _per_run(record[name])
    ]
    if invalid_names:
        raise IncompatibleRecord(
            f"{source} holds {', '.join(invalid_names)} otherwise than records of runs on land do."
        )
    time = record.time
    if time.dims != ("time",) or time.dtype.kind not in "fiu" or not _rising(time.values):
        raise IncompatibleRecord(f"{source} has times that do not rise.")
    _check_times(time.values.astype(float), source, max_approach=_MAX_APPROACH if "servo_heard" in record else 0.0)
    _check_runs(record, source)
    legs = [str(leg) for leg in record.leg.values.ravel()] if "leg" in record else []
    if not _in_pairs(legs):
        legs_text = ", ".join(legs[:8])
        raise IncompatibleRecord(
            f"{source} has the legs {legs_text}, not pairs of left and right, as {', '.join(LEGS)}."
        )


def _check_times(time: np.ndarray, source: str, *, max_approach: float) -> None:
    """Refuse times of samples that no run has: too long before zero, or with a gap longer than all the rest.

    Args:
        time: rising [s].
        source: name of the record in messages.
        max_approach: time before zero in which a driven robot may go to its first posture; 0 for simulated runs [s].
    """
    steps = np.diff(time)
    if time[0] < -max_approach - _TIME_TOLERANCE or time[-1] > _MAX_TIME:
        earliest = -max_approach or 0.0  # no minus before zero
        raise IncompatibleRecord(
            f"{source} has times from {time[0]:.4g} to {time[-1]:.4g} s; {earliest:g} to {_MAX_TIME:g} s is allowed: "
            "the unit or the beginning is another."
        )
    if len(steps) and np.median(steps) < _MIN_SAMPLE_INTERVAL:
        raise IncompatibleRecord(
            f"{source} has samples {np.median(steps):.3g} s apart; at least {_MIN_SAMPLE_INTERVAL:g} s is allowed: the "
            "unit of time is another."
        )
    longest = int(steps.argmax()) if len(steps) >= _MIN_STEPS else 0
    if len(steps) >= _MIN_STEPS and steps[longest] > np.delete(steps, longest).sum():
        raise IncompatibleRecord(
            f"{source} has no sample from {time[longest]:.4g} to {time[longest + 1]:.4g} s, longer than all the rest "
            "lasts: cut it there."
        )


def _check_runs(record: xr.Dataset, source: str) -> None:
    """Refuse numbers of runs that no run has; those that are not finite are unknown."""
    for name, (lower, upper) in _RUN_LIMITS.items():
        if name not in record:
            continue
        if meaning_error := _other_meaning(record, name):
            raise IncompatibleRecord(f"{source} holds {meaning_error}: records are in SI units, as suchus writes them.")
        values = np.asarray(record[name].values)
        if values.dtype.kind not in "fiub":
            raise IncompatibleRecord(f"{source} holds {name} that is no number.")
        values = values[np.isfinite(values)].astype(float)
        wrong = values[(values < lower) | (values > upper)]
        if len(wrong):
            raise IncompatibleRecord(
                f"{source} holds {name} {wrong[0]:.4g} {PER_RUN[name][0]}; {max(lower, 0.0):g} to {upper:.4g} is "
                "allowed: make the record again."
            )


def _other_meaning(record: xr.Dataset, name: str) -> str:
    """Return in words how a variable's attributes contradict the schema: another unit, or another variable's meaning.

    The text is empty where they agree or are missing.
    """
    variable = record[name]
    unit = VARIABLES[name][1] if name in VARIABLES else PER_RUN[name][0] if name in PER_RUN else "s"
    unit_attribute = variable.attrs.get("units", unit)
    if not isinstance(unit_attribute, str) or unit_attribute != unit:
        return f"{name} in {str(unit_attribute)[:20]!r} instead of {unit}"
    long_name = variable.attrs.get("long_name")
    other_name = next(
        (
            variable_name
            for variable_name, (_, _, meaning) in VARIABLES.items()
            if variable_name != name and meaning == long_name
        ),
        None,
    )
    return f"{other_name} under the name of {name}" if other_name else ""


def _fits_schema(record: xr.Dataset, name: str) -> bool:
    """Return whether a variable has dimensions, labels and numbers of the schema."""
    variable, dims = record[name], VARIABLES[name][0]
    if variable.dims not in (dims, ("run", *dims)) or variable.dtype.kind not in "fiu":
        return False
    if not all(_in_order(record, dim, order) for dim, order in (("xyz", XYZ), ("wxyz", WXYZ)) if dim in dims):
        return False
    if not all(size for dim, size in variable.sizes.items() if dim != "leg"):  # a swimmer may have no limbs
        return False
    labels = all(record[dim].dims == (dim,) for dim in dims if dim in record.coords)
    has_labels = all(dim in record.coords for dim in dims if dim in ("leg", "joint", "servo", "segment"))
    sizes = all(variable.sizes[dim] == size for dim, size in (("xyz", 3), ("wxyz", 4)) if dim in dims)
    numbers = np.asarray(variable.values, dtype=float)
    numbers = numbers[np.isfinite(numbers)]
    if not (labels and has_labels and sizes) or (numbers.size and np.abs(numbers).max() > _MAX_NUMBER):
        return False
    if name == "orientation":
        length = np.sqrt((np.asarray(variable, dtype=float) ** 2).sum(axis=variable.dims.index("wxyz")))
        return bool((np.abs(length[np.isfinite(length)] - 1.0) < _UNIT).all())
    return True


def _in_order(record: xr.Dataset, dim: str, order: Sequence[str]) -> bool:
    """Return whether axes are labelled as the schema has them, if they are."""
    return dim not in record.coords or tuple(map(str, record[dim].values.ravel())) == tuple(order)


def _per_run(variable: xr.DataArray) -> bool:
    return variable.dims in ((), ("run",)) and variable.size > 0


def _in_pairs(legs: Sequence[str]) -> bool:
    """Return whether each left limb is followed by the right one of its girdle, and none stands twice."""
    pairs = zip(legs[::2], legs[1::2], strict=False)
    paired = all(a[:1] == "L" and b[:1] == "R" and a[1:] == b[1:] for a, b in pairs)
    return len(legs) % 2 == 0 and len(set(legs)) == len(legs) and paired


def _rising(values: np.ndarray) -> bool:
    return bool(np.isfinite(values).all() and (np.diff(values) > 0).all())


GROUND = "stands_on"
"""Name of the variable along ``run`` that holds the ground, as JSON text, since every kind of relief has numbers of its
own; empty where a run floats."""
_GROUND_KEYS = {"friction_scale": "grip"}
"""Keys of records whose names are not those of the fields: files of earlier releases have them too."""
_RELIEFS = {"step": Step, "stone": Stone, "bumps": Bumps}


def ground_text(ground: Ground | None) -> str:
    """Return a ground as text; the empty one stands for none."""
    if ground is None:
        return ""
    text = {_GROUND_KEYS.get(name, name): value for name, value in asdict(ground).items()}
    if ground.grains is None:  # as it was written before grounds had grains
        del text["grains"]
    if ground.relief is not None:
        fields = asdict(ground.relief)
        if fields.get("scale") == 1.0:  # as it was written before bumps had a scale
            del fields["scale"]
        text["relief"] = {"kind": type(ground.relief).__name__.lower(), **fields}
    return json.dumps(text, sort_keys=True)


def ground_of(record: xr.Dataset) -> Ground | None:
    """Return what a run stood on; None where it floats, or where the record is of before grounds were kept.

    Args:
        record: record of one run, with or without the dimension ``run``.

    Raises:
        IncompatibleRecord: what the record says is no ground.
    """
    text = str(record[GROUND].values.ravel()[0]) if GROUND in record else ""
    if not text:
        return None
    try:
        names = {key: name for name, key in _GROUND_KEYS.items()}
        fields: dict[str, Any] = {names.get(key, key): value for key, value in json.loads(text).items()}
        relief, grains = fields.pop("relief"), fields.pop("grains", None)
        return Ground(
            **fields,
            relief=None if relief is None else _RELIEFS[relief.pop("kind")](**relief),
            grains=None if grains is None else Grains(**grains),
        )
    except (ValueError, KeyError, TypeError, AttributeError, SuchusError) as error:
        raise IncompatibleRecord(f"the record holds no ground that this suchus knows: {text[:120]!r}.") from error
