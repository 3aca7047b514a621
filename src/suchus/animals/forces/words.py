"""The results of forces from a film, as lines of text."""

import numpy as np
import xarray as xr

_STANDS_OUT = (
    ("speed", ""),
    ("peak_thrust", "thrust to "),
    ("peak_aside", "aside to "),
    ("mean_power", "on the water "),
)


def summary_lines(data: xr.Dataset) -> list[str]:
    """Return the main results of forces from a film, a line for each.

    Args:
        data: data as ``walked_forces``, ``played_forces`` or ``swum_forces`` return it.
    """
    return _on_land(data) if data.attrs["medium"] == "land" else _in_water(data)


def _interval(data: xr.Dataset, name: str) -> str:
    row = data.sel(quantity=name)
    unit = str(row.unit.values)
    return _interval_text(float(row.value), float(row.low), float(row.high), "" if unit == "-" else unit)


def _interval_text(value: float, lower_bound: float, upper_bound: float, unit: str) -> str:
    ends = f" ({lower_bound:.3g} to {upper_bound:.3g})" if upper_bound > lower_bound else ""
    return f"{value:.3g}{ends}{unit and ' '}{unit}"


SPEED_TOLERANCE = 0.05
"""Relative difference in speed from the film up to which the body walks as the animal does [-]."""


def _on_land(data: xr.Dataset) -> list[str]:
    """Return the lines for a walk: body, peak forces of the feet, loads of belly and tail, speed."""
    lines = [f"body: {data.attrs['body']}'s, {_interval(data, 'length')} long, {_interval(data, 'mass')}"]
    for pair in ("fore", "hind"):
        net_force = data.sel(quantity=f"foot_force_net_{pair}")
        net, sustained_force = (_interval(data, f"foot_force_{name}_{pair}") for name in ("net", "held"))
        lines.append(
            f"{pair} feet: at most {net} net, {sustained_force} without the strike of touching down; salamanders "
            f"{float(net_force.animals):.3f} ± {float(net_force.animals_spread):.3f}, mean and standard deviation of "
            "trials"
        )
    lines.append(f"belly and tail carry {_interval(data, 'carried_belly')} and {_interval(data, 'carried_tail')}")
    if "speed_to_filmed" in data.quantity.values:
        speed_ratio, remark = data.sel(quantity="speed_to_filmed"), ""
        if float(speed_ratio.low) > 1.0 + SPEED_TOLERANCE or float(speed_ratio.high) < 1.0 - SPEED_TOLERANCE:
            remark = ": it does not walk as the animal does, so that forces along the course are not the animal's"
        times = _interval(data, "speed_to_filmed")
        lines.append(f"the body comes {times} times as far in the same time as on the film{remark}")
    return lines


def _in_water(data: xr.Dataset) -> list[str]:
    """Return the lines for a swim: body, forces and speed by each model of the water."""
    length, displacement = _interval(data, "length"), _interval(data, "displaced")
    lines = [f"body: {data.attrs['body']}'s, {length} long, displaces {displacement} of water"]
    for rung in data.rung.values:
        row = data.sel(rung=rung)
        parts = []
        for name, word in _STANDS_OUT:
            value, lower_bound, upper_bound = (float(row[f"{name}{end}"]) for end in ("", "_low", "_high"))
            parts.append(f"{word}{_interval_text(value, lower_bound, upper_bound, str(row[name].units))}")
        lines.append(f"{rung}: {', '.join(parts)}")
    if "speed_filmed" not in data.quantity.values:
        return lines
    film = data.sel(quantity="speed_filmed")
    is_within = (data.speed_low.values <= float(film.high)) & (data.speed_high.values >= float(film.low))
    holds = [str(rung) for rung in data.rung.values[np.asarray(is_within)]]
    agreement = f"within the interval of {' and '.join(holds)}" if holds else "outside the interval of every model"
    lines.append(f"the film's own speed, {_interval(data, 'speed_filmed')}, is {agreement}")
    return lines
