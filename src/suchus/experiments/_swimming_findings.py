"""What the experiment ``swimming`` reads from its record: every number, and a verdict on each claim."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from suchus.design import Crocodile
from suchus.experiment import Measure, Verdict, judge
from suchus.water import Quarters, Swum, convex_higher, crossings, efficiency, level

SINE = 0.95
"""Share of its variance that a swing has in the sine of one cycle to be called one [-]; a zigzag has 0.986, a square
wave 0.81."""
ARMS = ("trunk and tail", "trunk only", "tail only", "as printed", "exact wave", "exact wave as printed")
"""Motions that are compared swimming freely."""


def measures(record: xr.Dataset, robot: Crocodile, frequency: float, reading: str) -> Mapping[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened.
        robot: who swam.
        frequency: of the wave [Hz].
        reading: of (20) that the joints were fitted to.
    """
    held, free = part(record, "held"), part(record, "free")
    return {
        "misfit": Measure(float(record.attrs["misfit"]), "-"),
        **dict(_thrusts(record, held, reading)),
        **dict(_held(held)),
        **dict(_free(record, free, robot, frequency)),
        **dict(_loads(held, robot)),
    }


def part(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return one swim of the record as ``tether`` or ``free_swim`` gave it."""
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


def _held(held: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    quarters = Quarters.of(held)
    yield "convex_higher_share", Measure(convex_higher(held), "-")
    yield "pressure_moves", Measure(quarters.moves, "-")
    yield "thrust_asymmetry", Measure(quarters.asymmetry, "-")
    yield "power_held", Measure(float(held.cycle_power[1:].mean()), "W/m")
    yield "force_noise", Measure(float(held.noise), "-")
    yield "thin_share", Measure(float(held["thin"]), "-")
    for i in range(4):
        yield f"pressure_difference_{i + 1}_quarter", Measure(quarters.difference[i], "Pa")


def _free(record: xr.Dataset, free: xr.Dataset, robot: Crocodile, frequency: float) -> Iterator[tuple[str, Measure]]:
    swum = Swum.of(free, frequency)
    yield "speed_free", Measure(swum.speed, "m/s")
    yield "speed_free_lengths", Measure(swum.speed / robot.length, "1/s")
    yield "speed_free_gain_last_cycle", Measure(swum.gain, "-")
    yield "slip", Measure(swum.slip, "-")
    yield "strouhal", Measure(swum.strouhal, "-")
    yield "efficiency", Measure(efficiency(float(record.towed_drag), swum.speed, float(free.power[-1])), "-")
    yield "cost_of_transport", Measure(swum.cost_of_transport, "-")
    yield "tail_sine_share", Measure(float(free.sine_share[-1]), "-")
    yield "envelope_growth", Measure(float(free.swing[-1] / free.swing.min()), "-")
    yield "head_yaw", Measure(swum.head_yaw, "rad")
    for arm, speed in _compared(record).items():
        yield f"speed_{_name(arm)}", Measure(speed, "m/s")
    for model in record.model.values:
        yield f"speed_{model}", Measure(float(record.model_speed.sel(model=model)), "m/s")


def _loads(held: xr.Dataset, robot: Crocodile) -> Iterator[tuple[str, Measure]]:
    for joint in held.joint.values:
        yield f"joint_torque_peak_{joint}", Measure(float(abs(held.joint_torque.sel(joint=joint)).max()), "N m/m")
    for servo in held.servo.values:
        peak = float(abs(held.servo_torque.sel(servo=servo)).max())
        yield f"servo_load_peak_{servo}", Measure(peak / robot.servo(str(servo)).torque, "-")


def verdicts(record: xr.Dataset) -> tuple[Verdict, ...]:
    """Return what becomes of each claim.

    Args:
        record: what happened.
    """
    free = part(record, "free")
    return (*_wave(free), *_fig_17(part(record, "held")), _track(free), _main_thrust(record))


def _wave(free: xr.Dataset) -> Iterator[Verdict]:
    share, swings, s = free.sine_share.values, free.swing.values, np.linspace(0.0, 1.0, free.swing.size)
    yield judge(
        "swim_tail_sine",
        float(share[-1]),
        f"Swimming freely, {100 * share[-1]:.1f} % of the variance of the tip's way to the side is the sine of one "
        f"cycle; {100 * SINE:.0f} % would do.",
        holds=bool(share[-1] >= SINE),
    )
    least, whole = int(swings.argmin()), float(np.average(share, weights=swings**2))
    dips = 1.0 - swings[least:] / np.maximum.accumulate(swings[least:])
    way = f"dipping by up to {100 * dips.max():.0f} % on the way" if dips.max() > 0 else "growing all the way"
    yield judge(
        "swim_body_wave",
        float(swings[-1] / swings[least]),
        f"Swimming freely, the midline swings least at {s[least]:.2f} of its length from the snout, "
        f"{1000 * swings[least]:.0f} mm, and {1000 * swings[-1]:.0f} mm at the tip, {way}; {100 * whole:.1f} % of it "
        "is the sine of one cycle. The least swing must lie in the front half, and from there on it may never fall.",
        holds=dips.max() == 0.0 and s[least] < 0.5 and whole >= SINE,
    )


def _fig_17(held: xr.Dataset) -> Iterator[Verdict]:
    said = Quarters.of(held)
    yield judge(
        "swim_pressure_convex",
        said.difference[0],
        "Mean pressure along the convex side of the tail less that along the concave side, at T/4 of (20); the "
        f"convex side has the higher one in {100 * convex_higher(held):.0f} % of the cycle.",
        holds=said.convex,
    )
    yield judge(
        "swim_diagonal_force",
        said.thrust[0],
        f"At T/4 the force is {said.thrust[0]:.1f} N/m forward and {said.aside[0]:.1f} N/m to the side; diagonal is "
        "where neither is below a tenth of the other.",
        holds=said.diagonal,
    )
    yield judge(
        "swim_pressure_falls",
        said.difference[1] - said.difference[0],
        f"Size of the pressure difference at T/2 against that at T/4: {abs(said.difference[1]):.0f} against "
        f"{abs(said.difference[0]):.0f} Pa. Its place moves by {said.moves:+.2f} tail lengths to the tip.",
        holds=said.falls,
    )
    yield judge(
        "swim_thrust_symmetric",
        said.thrust[2],
        f"Half a cycle apart the forces forward are {said.thrust[0]:.1f} and {said.thrust[2]:.1f} N/m, to the side "
        f"{said.aside[0]:.1f} and {said.aside[2]:.1f} N/m.",
        holds=said.mirrored,
    )


def _track(free: xr.Dataset) -> Verdict:
    crossed = crossings(free)
    return judge(
        "swim_s_shape",
        float(np.ptp(level(free.snout_y.values))),
        f"In the last two cycles the snout crosses its own mean line {crossed} times.",
        holds=crossed >= 3,
    )


def _main_thrust(record: xr.Dataset) -> Verdict:
    both, trunk, tail = list(_compared(record).values())[:3]
    return judge(
        "swim_tail_thrust",
        tail / both,
        f"With the limbs folded, trunk and tail together reach {both:.2f} m/s in {record.sizes['cycle']} cycles, the "
        f"trunk alone {trunk:.2f} and the tail alone {tail:.2f} m/s.",
        holds=both > 0 and tail > trunk,
    )


def _compared(record: xr.Dataset) -> dict[str, float]:
    """Return the speed of each arm in its last cycle [m/s]."""
    return {str(arm): float(record.arm_speed.sel(arm=arm)[-1]) for arm in record.arm.values}


def _name(arm: object) -> str:
    return str(arm).replace(" ", "_")
