"""Passages of the page on water and land that state what its experiments measured; see ``stated``."""

from collections.abc import Callable, Mapping
from math import degrees, radians
from typing import Any


def _checks(m: Mapping[str, float]) -> str:
    """Return the table of checks against exact answers."""
    rows = (
        ("draft of sphere, cylinder and box at three densities", f"{m['draft_error']:.0e} m off", "below 1e-6 m"),
        ("period of heave, with and without added mass", f"{m['heave_period_error']:.0e} off", "below 1e-3"),
        ("energy gained by a box that rocks for 60 s, implicitfast", f"{m['energy_gain']:.2%}", "below 2 %"),
        ("the same, Runge-Kutta", f"{m['energy_gain_rk4']:.0e}" if m["energy_gain_rk4"] else "none", "below 1e-4"),
        ("momentum of a spheroid in ideal water over 2 s, Runge-Kutta", f"{m['impulse_drift']:.0e} lost", "below 1e-5"),
        ("volume under water beside counted points, of the whole", f"{m['volume_error']:.0e} off", "below 1e-3"),
        ("acceleration of a neutrally buoyant body", f"{m['acceleration_neutral']:.0e} m/s2", "0"),
        ("net force of 3 kg of ballast on a trimmed float", f"{m['force_of_ballast']:.2f} N", "-29.43 N"),
        (
            "angular acceleration of a keeled hull at 45 degrees",
            f"{m['acceleration_of_keel']:.4f} rad/s2",
            "1.1187 rad/s2",
        ),
    )
    return "| check | here | wanted |\n|---|---|---|\n" + "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _hull(m: Mapping[str, float]) -> str:
    """Return how the bare and the floating robot lie in the water."""
    rows = [
        ("mass", "{:.2f} kg", 1.0, "mass"),
        ("volume", "{:.2f} l", 1e3, "volume"),
        ("too heavy by", "{:.0f} g", 1e3, "surplus"),
        (
            "metacentric height (under water: centre of buoyancy over that of mass)",
            "{:.1f} mm",
            1e3,
            "metacentric_height",
        ),
        ("righting lever vanishes at", "{:.0f} deg", degrees(1.0), "vanishing"),
    ]
    lines = ["| | bare `caiman` | `floating_caiman` |", "|---|---|---|"]
    for what, form, factor, name in rows:
        bare, ours = (form.format(factor * m[f"{name}_{kind}"] + 0.0) for kind in ("bare", "floating"))
        lines.append(f"| {what} | {bare} | {ours} |")
    return "\n".join(lines) + (
        f"\n\nLet go heeled by 150 degrees it is upright to 2 degrees after {m['righting_time']:.1f} s and comes to "
        f"rest at {degrees(m['roll_at_rest']):.2f} degrees, with {m['share_above']:.1%} of its volume above the "
        f"surface, {1e3 * m['draft_floating']:.0f} mm deep, nose up by {degrees(m['trim_floating']):.1f} degrees.\n"
    )


def _swims(m: Mapping[str, float]) -> str:
    """Return the table of speeds."""
    lines = ["| m/s | six degrees of freedom | stiffer joints | resistive | reactive |", "|---|---|---|---|---|"]
    for name, called in (("whole", "whole wave"), ("tail_only", "tail only"), ("trunk_only", "trunk only"),
                         ("reversed", "reversed")):  # fmt: skip
        cells = [f"{m[f'speed_{name}{end}']:.2f}" for end in ("", "_stiff", "_resistive", "_reactive")]
        lines.append(f"| {called} | {' | '.join(cells)} |")
    return "\n".join(lines) + (
        f"\n\nThe whole wave: {m['speed_low']:.3f} to {m['speed_high']:.3f} m/s over the plausible coefficients of the "
        f"water (oscillating sections have {m['cross_drag_by_table']:.2f} and {m['added_mass_by_table']:.2f} times the "
        f"drag and added mass of the swims), {m['step_change']:.1%} at half the time step; Strouhal number "
        f"{m['strouhal']:.2f}, slip {m['slip']:.2f}, roll {degrees(m['roll_amplitude']):.1f} degrees at most. The "
        f"servos take {m['servo_power']:.2f} W, of which the water gets {m['water_power']:.2f}: cost of transport "
        f"{m['cost_of_transport']:.2f} and {m['cost_of_transport_water']:.2f}. Steered, it turns on a radius of "
        f"{abs(m['turn_radius']):.2f} m. The largest amplitude of a joint of the cable is {m['tail_spread']:.1f} times "
        f"their mean, {m['tail_spread_stiff']:.1f} times with stiffer joints.\n"
    )


def _taken(m: Mapping[str, float]) -> str:
    """Return the speeds of the slice by the commanded midline and by the one that the joints take."""
    lines = [
        "| slice, 1 Hz | midline as commanded | as the joints take it | their angles differ by |",
        "|---|---|---|---|",
    ]
    for name, called in (("trunk_and_tail", "trunk and tail"), ("tail_only", "tail only")):
        speeds = [f"{m[f'speed_{name}{ending}']:.2f} m/s" for ending in ("", "_as_taken")]
        lines.append(f"| {called} | {' | '.join(speeds)} | {m[f'misfit_{name}_as_taken']:.0%} |")
    return "\n".join(lines) + "\n"


def _below(m: Mapping[str, float]) -> str:
    """Return the table of the swims below the surface, by where the air is and by what holds the pitch."""
    lines = ["| below the surface | hovers at rest | swims | speed | greatest error of the depth | dives in |",
             "|---|---|---|---|---|---|"]  # fmt: skip
    for ending, called in (
        ("_in_foam", "air where the foam is"), ("", "chambers as designed"), ("_held", "the same, pitch held"),
        ("_pitched", "the same, dives by pitch"),
    ):  # fmt: skip
        pitch, speed, off, dives = (
            m[f"{name}_deep{ending}"] for name in ("pitch", "speed", "depth_error", "dive_time")
        )
        trim = m.get(f"trim_deep{ending}", m["trim_deep"])
        cells = _pitched(trim), _pitched(pitch), f"{speed:.2f} m/s", f"{1e3 * off:.0f} mm", f"{dives:.0f} s"
        lines.append(f"| {called} | {' | '.join(cells)} |")
    return "\n".join(lines) + f"\n\nThe front chamber has {m['front_air']:.0%} of the air.\n"


def _pitched(pitch: float) -> str:
    """Return a pitch in words."""
    if abs(pitch) < radians(0.5):
        return "level"
    return f"nose {'down' if pitch > 0 else 'up'} by {degrees(abs(pitch)):.0f} deg"


def _ashore(m: Mapping[str, float]) -> str:
    """Return how often it comes ashore, beside what was wanted, and what a metre costs."""
    rows = (
        ("came 1 m ashore, of all runs", f"{m['ashore_share']:.0%}", "90 % at least"),
        ("the same on the steepest slope", f"{m['ashore_share_steepest']:.0%}", "-"),
        ("the same with the least friction", f"{m['ashore_share_least_grip']:.0%}", "-"),
        ("falls", f"{m['falls']:.0f}", "0"),
        ("changes between swimming and walking, at most", f"{m['switches']:.0f}", "2"),
        ("time to come ashore, median", f"{m['time_ashore']:.1f} s", "-"),
        ("back from land into the water", f"{m['into_water_share']:.0%}", "90 % at least"),
        ("error of the depth that is held", f"{1e3 * m['depth_error']:.0f} mm", "-"),
    )
    costs = ", ".join(
        f"{called} {m[f'work_per_metre_{where}']:.0f}"
        for where, called in (
            ("land", "level land"), ("ashore", "up the shore"), ("wading", "wading"), ("surface", "at the surface"),
            ("deep", "at depth"),
        )
    )  # fmt: skip
    table = "| in `suchus run shore` | here | wanted |\n|---|---|---|\n" + "".join(
        f"| {' | '.join(row)} |\n" for row in rows
    )
    return f"{table}\nWork of the servos over distance [J/m]: {costs}.\n"


def _animal(m: Mapping[str, float]) -> str:
    """Return the stride of the animal's swim on its model, beside the animal."""
    names = [name.removeprefix("stride_swim_") for name in m if name.startswith("stride_swim_")]
    lines = ["| frequency | stride [body lengths a cycle] | Strouhal number |", "|---|---|---|"]
    lines += [f"| {n.replace('_', '.')} Hz | {m[f'stride_swim_{n}']:.3f} | {m[f'strouhal_{n}']:.2f} |" for n in names]
    return "\n".join(lines) + (
        f"\n\nThe mean stride is {m['stride_swim']:.3f}, {abs(m['stride_off']):.0%} "
        f"{'more' if m['stride_off'] > 0 else 'less'} than the animal's 0.225; over halved and doubled coefficients of "
        f"the water it is {m['stride_low']:.3f} to {m['stride_high']:.3f} at the highest frequency. The model floats "
        f"with {m['share_under']:.0%} of it under water and heels by {degrees(m['heel']):.0f} degrees at most. From "
        f"end to end the snout swings by {m['swing_snout']:.2f}, the tail's tip by {m['swing_tail']:.2f} body lengths, "
        f"and least, by {m['swing_least']:.2f}, the body {m['swing_least_at']:.2f} behind the snout; the joints miss "
        f"their angles by {degrees(m['angle_missed']):.1f} degrees.\n"
    )


def _space(m: Mapping[str, float]) -> str:
    """Return the table of speeds in three dimensions beside the slice and the models, and the motions beside them."""
    grids = sorted(int(name.split("_")[1]) for name in m if name.startswith("speed_") and name.endswith("_cells"))
    millimetres = {name: f"{1e3 * value:.1f} mm/s" for name, value in m.items() if name.startswith("speed_")}
    rows = [
        (f"body in three dimensions, {cells} cells a length", millimetres[f"speed_{cells}_cells"],
         f"{m[f'power_{cells}_cells']:.2f} W") for cells in grids
    ]  # fmt: skip
    rows += [(f"{model} model", millimetres[f"speed_{model}"], f"{m[f'power_{model}']:.2g} W")
             for model in ("resistive", "reactive")]  # fmt: skip
    rows += [("slice of unlimited depth", millimetres["speed_slice"], "")]
    number = f"f L^2 / nu = {m['reynolds']:.0f}"
    lines = [f"| (20), reading I, 1 Hz, {number} | speed, cycle {m['cycles']:.0f} | power |", "|---|---|---|"]
    lines += [f"| {' | '.join(row)} |" for row in rows]
    lines += ["", f"| on one grid, {number} | speed | on the cycle before | energy over weight and distance |",
              "|---|---|---|---|"]  # fmt: skip
    motions = {"trunk_and_tail": "trunk and tail", "trunk_only": "trunk only", "tail_only": "tail only",
               "as_printed": "as printed", "limbs_folded": "limbs folded"}  # fmt: skip
    high = {
        name.removeprefix("speed_"): f"last third {_height(name):g} m high" for name in sorted(_raised(m), key=_height)
    }
    for name, called in (motions | high).items():
        if f"speed_{name}" not in m:  # kept measures from before these swims
            continue
        cells = millimetres[f"speed_{name}"], f"{m[f'speed_gain_{name}']:+.0%}", f"{m[f'cost_of_transport_{name}']:.2g}"
        lines.append(f"| {called} | {' | '.join(cells)} |")
    most = max(value for name, value in m.items() if name.startswith("servo_load_peak"))
    return "\n".join(lines) + (
        f"\n\nOn the finest grid the last cycle is {m['speed_gain']:+.1%} on the one before, and "
        f"{m['speed_over_grids']:+.1%} on the next coarser grid in speed, {m['power_over_grids']:+.1%} in power; the "
        f"Reynolds number of speed and length is {m['reynolds_of_speed']:.0f}, the Strouhal number "
        f"{m['strouhal']:.1f}, the slip {m['slip']:.3f}, the cost of transport {m['cost_of_transport']:.2f}. Kept from "
        f"moving on, the body pushes with {m['thrust_held']:.3f} N (resistive {m['thrust_held_resistive']:.3f} N, "
        f"reactive {m['thrust_held_reactive']:.3f} N). The water alone asks a servo for {most:.0%} of its limit at "
        f"most. In real water the models say {m['speed_resistive_real_water']:.2f} and "
        f"{m['speed_reactive_real_water']:.2f} m/s.\n"
    )


def _space_in_short(m: Mapping[str, float]) -> str:
    """Return the speeds of body and slice beside each other."""
    high = max(_raised(m), key=_height)
    return (
        f"Swimming at f L²/ν = {m['reynolds']:.0f}, the robot's body makes {m['speed']:.3f} m/s in three dimensions "
        f"({m['cells_per_length']:.0f} cells a length), and its two-dimensional slice {m['speed_slice']:.2f} m/s. With "
        f"the last third of the tail {_height(high):g} m high the body swims, on one grid, "
        f"{m[high] / m['speed_trunk_and_tail']:.1f} times as fast. See [swimming](docs/water.md) and "
        "`suchus run swim_3d`.\n"
    )


def _raised(m: Mapping[str, float]) -> list[str]:
    """Return the names of the speeds with raised tails, which say how high."""
    return [name for name in m if name.startswith("speed_tail_") and name[len("speed_tail_")].isdigit()]


def _height(name: str) -> float:
    """Return the height of the tail that the name of a speed says [m]."""
    return float(name.removeprefix("speed_tail_").replace("_", "."))


def _drive(m: Mapping[str, float]) -> str:
    """Return how one drive goes from the water onto the land."""
    return (
        f"By the drive for walking alone the floating caiman swims at {m['drive_swim_speed']:.2f} m/s as long as it "
        f"feels no ground, {m['drive_afloat_share']:.0%} of the time, and walks at {m['drive_walk_speed']:.2f} m/s "
        f"from then on, in the end with {m['drive_feet_walking']:.0%} of its weight on its feet. The limbs change "
        f"between silent and walking {m['drive_changes']:.0f} time(s). It ends {m['drive_ashore']:+.2f} m "
        "up the shore from the water "
        f"line; without the load felt, at the same drive, {m['drive_ashore_unfelt']:+.2f} m.\n"
    )


_KEULEGANS, _ASPECTS = ("1", "2.2", "5", "10", "20"), ("0.25", "0.5", "1", "2", "4")


def _sections(m: Mapping[str, Any]) -> str:
    """Return the table of sections, and how sure it is."""
    head = [f"| height over thickness | {' | '.join(f'KC {k}' for k in _KEULEGANS)} |", "|---|---|---|---|---|---|"]
    rows = [
        f"| {aspect} | {' | '.join(f'{d:.2f}, {a:.2f}' for d, a in zip(drag, added, strict=True))} |"
        for aspect, drag, added in zip(_ASPECTS, m["drag"], m["added"], strict=True)
    ]
    rows.append(f"| 1, attached flow | {' | '.join(f'{one:.2f}' for one in m['attached'])} |")
    return "\n".join([*head, *rows]) + (
        f"\n\nCd by height and Ca. Between the nodes the interpolation is off by {m['held_out']:.1%} at most, at eight "
        f"points that were held out. Drag and added mass leave up to {m['left']:.0%} of the rms force unexplained. On "
        f"a grid half as fine again the round section at KC 5 has {m['fine_round'][0]:.2f}, {m['fine_round'][1]:.2f} "
        f"(fitted to the force that Dütsch et al. 1998 published: {m['published_round'][0]:.2f}, "
        f"{m['published_round'][1]:.2f}) and the one four times as high as thick "
        f"{m['fine_high'][0]:.2f}, {m['fine_high'][1]:.2f}. Where the flow is attached the round section has the exact "
        f"Ca {m['attached_added']:.2f} of Stokes and Wang at this beta; at the robot's, 3600, it is "
        f"{m['attached_robot']:.2f}.\n"
    )


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, Any]], str]]] = {
    "floating": {"checks": _checks, "hull": _hull},
    "swim_free": {"swims": _swims, "below": _below},
    "swimming_taken": {"taken": _taken},
    "salamander_swim": {"animal_swim": _animal},
    "swim_3d": {"space": _space, "space_in_short": _space_in_short},
    "shore": {"ashore": _ashore},
    "pattern_generator": {"drive": _drive},
    "sections": {"sections": _sections},
}
"""What makes each passage, by experiment."""
