"""The measures of the experiment ``swimming``, and the sentences that say what decided its outcome."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from suchus.design import Robot
from suchus.experiment import Measure
from suchus.water import Quarters, Sway, Swum, convex_higher, efficiency, wave_form

ARMS = ("trunk and tail", "trunk only", "tail only", "as printed", "exact wave", "exact wave as printed")
"""Conditions: the motions that are compared while swimming freely."""
SETTLED = 4
"""Last cycles of the free swim over which its track is measured, fewer where it has fewer after the first [-]."""
_GAINS = {"tail": "trunk only", "spine": "tail only"}
"""The condition that lacks the swing of a part, by the name of the part."""


def measures(record: xr.Dataset, robot: Robot, frequency: float, reading: str) -> Mapping[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: the swims.
        robot: the robot that swam.
        frequency: of the wave [Hz].
        reading: of (20) that the joints were fitted to.
    """
    held, free = part(record, "held"), part(record, "free")
    return {
        "misfit": Measure(float(record.attrs["misfit"]), "-"),
        **dict(_thrusts(record, held, reading)),
        **dict(_tethered(held)),
        **dict(_free(record, free, robot, frequency)),
        **dict(_wave(free, robot)),
        **dict(_track(free, robot)),
        **dict(_compared(record)),
        **dict(_loads(held, robot)),
    }


def part(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return one swim of the record as ``water.resolved`` gave it."""
    start = f"{name}_"
    mine = record[[str(v) for v in record.data_vars if str(v).startswith(start)]]
    return mine.rename(
        {str(v): str(v).removeprefix(start) for v in {*mine.variables, *mine.dims} if str(v).startswith(start)}
    )


def _thrusts(record: xr.Dataset, held: xr.Dataset, reading: str) -> Iterator[tuple[str, Measure]]:
    settled = held.cycle_thrust[1:]
    yield f"thrust_mean_{reading}", Measure(float(settled.mean()), "N/m")
    yield "thrust_scatter", Measure(float(np.ptp(settled.values)), "N/m")
    yield "thrust_mean_as_printed", Measure(float(record.printed_cycle_thrust[1:].mean()), "N/m")
    for letter in record.reading.values:
        yield f"thrust_mean_{letter}", Measure(float(record.reading_thrust.sel(reading=letter)), "N/m")


def _tethered(held: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    each = Quarters.each(held)
    yield "convex_higher_share", Measure(convex_higher(held), "-")
    yield "power_held", Measure(float(held.cycle_power[1:].mean()), "W/m")
    yield "force_noise", Measure(float(held.noise), "-")
    yield "thin_share", Measure(float(held["thin"]), "-")
    for i in range(4):
        yield from _ranged(f"pressure_difference_{i + 1}_quarter", [one.difference[i] for one in each], "Pa")
    for i in (0, 2):
        yield from _ranged(f"thrust_{i + 1}_quarter", [one.thrust[i] for one in each], "N/m")
        yield from _ranged(f"aside_{i + 1}_quarter", [one.aside[i] for one in each], "N/m")
    yield from _ranged("force_angle_1_quarter", [one.angle for one in each], "rad")
    yield from _ranged("pressure_fall", [one.fall for one in each], "Pa")
    yield from _ranged("pressure_moves", [one.moves for one in each], "-")
    yield from _ranged("thrust_asymmetry", [one.asymmetry for one in each], "-")


def _free(record: xr.Dataset, free: xr.Dataset, robot: Robot, frequency: float) -> Iterator[tuple[str, Measure]]:
    swum = Swum.of(free, frequency)
    yield "speed_free", Measure(swum.speed, "m/s")
    yield "speed_free_lengths", Measure(swum.speed / robot.length, "1/s")
    yield "speed_free_gain_last_cycle", Measure(swum.gain, "-")
    yield "slip", Measure(swum.slip, "-")
    yield "strouhal", Measure(swum.strouhal, "-")
    yield "efficiency", Measure(efficiency(float(record.towed_drag), swum.speed, float(free.power[-1])), "-")
    yield "cost_of_transport", Measure(swum.cost_of_transport, "-")
    yield "head_yaw", Measure(swum.head_yaw, "rad")
    for model in record.model.values:
        yield f"speed_{model}", Measure(float(record.model_speed.sel(model=model)), "m/s")
        yield f"speed_as_printed_{model}", Measure(float(record.printed_model_speed.sel(model=model)), "m/s")


def _wave(free: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Return the share of a sine in the tail's swing, and the share of a wave of the form (20) in the midline's."""
    tip, swings, s = free.tip_share.values, free.swing.values, np.linspace(0.0, 1.0, free.swing.size)
    yield "tail_sine_share", Measure(float(free.sine_share[-1]), "-")
    yield "tail_sine_share_low", Measure(float(tip.min()), "-")
    yield "tail_sine_share_high", Measure(float(tip.max()), "-")
    least = int(swings.argmin())
    running = np.maximum.accumulate(np.maximum(swings[least:], np.finfo(float).tiny))
    dips = 1.0 - np.maximum(swings[least:], np.finfo(float).tiny) / running
    yield "envelope_growth", Measure(float(swings[-1] / running[0]), "-")
    yield "envelope_least_place", Measure(float(s[least]), "-")
    yield "envelope_dip", Measure(float(dips.max()), "-")
    linear, quadratic, waves, share = wave_form(s, swings, free.swing_late.values)
    sine = float(np.average(free.sine_share.values, weights=swings**2))
    yield "wave_share", Measure(sine * share, "-")
    yield "wave_waves_per_body", Measure(waves, "-")
    yield "wave_envelope_middle", Measure(abs(0.5 * linear + 0.25 * quadratic) / robot.length, "-")
    yield "wave_envelope_tip", Measure(abs(linear + quadratic) / robot.length, "-")


def _track(free: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Return how far the centre of mass sways to the side over the last cycles."""
    cycles = free.sizes["cycle"]
    count, each = max(min(SETTLED, cycles - 1), 1), (free.sizes["moment"] - 1) // cycles
    sway = Sway.of(free.centre_y.values[-(count * each + 1) :], count)
    yield "track_sway", Measure(sway.amplitude / robot.length, "-")
    yield "track_sway_low", Measure(sway.low / robot.length, "-")
    yield "track_sway_high", Measure(sway.high / robot.length, "-")
    yield "track_noise", Measure(sway.noise / robot.length, "-")
    yield "track_cycles", Measure(float(count), "-")
    yield "snout_sway", Measure(float(free.swing[0]) / robot.length, "-")


def _compared(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Return the speed of each condition in its last cycle, and the gain by tail and spine in the last two."""
    last = {str(arm): record.arm_speed.sel(arm=arm).values[-2:] for arm in record.arm.values}
    for arm, speeds in last.items():
        yield f"speed_{arm.replace(' ', '_')}", Measure(float(speeds[-1]), "m/s")
    if "taken_speed" in record:
        for arm in record.taken_arm.values:
            name, one = str(arm).replace(" ", "_"), record.sel(taken_arm=arm)
            yield f"speed_{name}", Measure(float(one.taken_speed[-1]), "m/s")
            yield f"misfit_{name}", Measure(float(one.taken_away), "-")
    both = last["trunk and tail"]
    for name, without in _GAINS.items():
        yield from _ranged(f"gain_{name}_swim", list(both - last[without]), "m/s")
    yield from _ranged("gain_tail_swim_share", list((both - last["trunk only"]) / both), "-")


def _loads(held: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    for joint in held.joint.values:
        yield f"joint_torque_peak_{joint}", Measure(float(abs(held.joint_torque.sel(joint=joint)).max()), "N m/m")
    for servo in held.servo.values:
        peak = float(abs(held.servo_torque.sel(servo=servo)).max())
        yield f"servo_load_peak_{servo}", Measure(peak / robot.servo(str(servo)).torque, "-")


def _ranged(name: str, values: list[float], unit: str) -> Iterator[tuple[str, Measure]]:
    """Return the value of the last cycle, with the least and the greatest of all cycles."""
    yield name, Measure(float(values[-1]), unit)
    yield f"{name}_low", Measure(float(min(values)), unit)
    yield f"{name}_high", Measure(float(max(values)), unit)
