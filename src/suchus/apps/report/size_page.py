"""What servos a robot needs, as a folder: a page, tables and the robot with the servos that are bought."""

import csv
import io
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from suchus.core.files import write
from suchus.hardware.loads import AT_LIMIT, FULL_WOUND, ServoLoad
from suchus.hardware.sizing import ServoFamily, Sizing, binding_limit, link_loads, use, with_motors
from suchus.robot import blueprint
from suchus.robot.design import Motor, layout
from suchus.visual import figures
from suchus.visual.figures.servos import ServoUse, draw_use
from suchus.visual.pages import embedded, number, render

PAGE, SERVOS, FAMILIES, ROBOT = "size.html", "servos.csv", "families.csv", "robot.toml"
_COLUMNS = (
    "family",
    "servo",
    "bought",
    "case",
    "period_s",
    "peak_torque_Nm",
    "rms_torque_Nm",
    "torque_limit_Nm",
    "continuous_torque_Nm",
    "speed_rad_s",
    "no_load_speed_rad_s",
    "power_W",
    "mean_current_A",
    "peak_current_A",
    "share_at_limit",
    "used_of_torque",
    "used_of_heat",
    "lag_rad",
    "steady_degC",
    "limit_degC",
    "warm_after_s",
    "cable_tension_N",
)


def write_size(sizing: Sizing, folder: Path, *, hours: float = 1.0) -> None:
    """Write page, tables and robot file into an existing folder.

    Args:
        sizing: what was found.
        folder: folder to write to.
        hours: for which the battery is asked [h].
    """
    write(folder / SERVOS, servos_csv(sizing))
    write(folder / FAMILIES, families_csv(sizing, hours))
    best = sizing.best
    pictures = []
    if best is not None:
        head = [f"{sizing.robot.name} with servos that are bought: {best.name} at {best.volts:g} V."]
        blueprint.write(with_motors(sizing.robot, best.chosen, best.volts), folder / ROBOT, head=head)
        figure = draw_use(uses(best), f"{sizing.robot.name}: {best.name}")
        svg, png = figures.save(figure, folder, "servos")
        pictures.append({"source": embedded(svg, png), "caption": figures.caption(figure)})
    text = render("size.html", folder, **_content(sizing, pictures, hours))
    write(folder / PAGE, text)


def uses(family: ServoFamily) -> list[ServoUse]:
    """Return the use of torque and heat of each servo of a family, in its hardest case."""
    servo_uses = []
    for name, case, _ in family.binding():
        load, motor = family.loads[case][name], family.chosen[name]
        servo_uses.append(ServoUse(name, motor.name, load.line / FULL_WOUND, load.rms / motor.continuous_torque))
    return servo_uses


def servos_csv(sizing: Sizing) -> str:
    """Return a CSV table with a row for each servo in each load case.

    The servos of the design come first. Then those of each family that was tried follow, in each case by falling use,
    with the period of the gait that the family needs.
    """
    rows = [
        _row("as designed", None, servo_name, case, load, sizing.cases[case_index].gait.period)
        for case_index, (case, loads) in enumerate(sizing.designed_loads.items())
        for servo_name, load in loads.items()
    ]
    for family in sizing.families:
        for case_index, (case, loads) in enumerate(family.loads.items()):
            gait = sizing.cases[case_index].gait
            period = gait.period * family.factors[gait.name]
            names_by_use = sorted(loads, key=lambda servo_name: -use(family.chosen[servo_name], loads[servo_name]))
            rows += [
                _row(family.name, family.chosen[servo_name], servo_name, case, loads[servo_name], period)
                for servo_name in names_by_use
            ]
    return _csv(_COLUMNS, rows)


def _row(family: str, motor: Motor | None, servo: str, case: str, load: ServoLoad, period: float) -> list[object]:
    """Return one row of the table of servos in the order of ``_COLUMNS``.

    Args:
        family: name of the family of servos.
        motor: the servo that is bought; None for the servo of the design.
        servo: name of the servo in the robot.
        case: name of the movement.
        load: what the servo bears in it.
        period: period of the gait [s].
    """
    heat = None if motor is None else load.rms / motor.continuous_torque
    limit = load.line if motor is None else load.line / FULL_WOUND
    return [
        family, servo, "" if motor is None else motor.name, case, period, load.torque, load.rms, load.limit,
        None if motor is None else motor.continuous_torque, load.speed,
        None if motor is None else motor.no_load_speed, load.power, load.current, load.peak_current, load.at_limit,
        limit, heat, load.off, load.steady, None if motor is None else motor.temperature_limit, load.warm_after,
        load.tension,
    ]  # fmt: skip


def families_csv(sizing: Sizing, hours: float) -> str:
    """Return a CSV table of the families: whether they are sufficient, with which periods, and at which price."""
    head = ["family", "volts", "does", "as_asked", *(f"period_s {gait}" for gait in _periods(sizing, None))]
    head += ["price_low_EUR", "price_high_EUR", "servos_kg", f"battery_Ah_for_{hours:g}_h", "servos", "lacking"]
    rows: list[list[object]] = []
    for family in sizing.families:
        row: list[object] = [family.name, family.volts, family.passes, family.as_asked]
        row += list(_periods(sizing, family).values())
        if family.passes:
            counts = "; ".join(f"{count} {name}" for name, count in motor_counts(family).items())
            row += [*family.price, family.mass, family.battery(hours), counts, ""]
        else:
            row += [None, None, None, None, "", family.lacking]
        rows.append(row)
    return _csv(head, rows)


def motor_counts(family: ServoFamily) -> dict[str, int]:
    """Return how many of each servo are bought, the cheapest first."""
    motors = sorted(family.chosen.values(), key=lambda motor: sum(motor.price))
    return {motor.name: motors.count(motor) for motor in dict.fromkeys(motors)}


def answer(sizing: Sizing, hours: float = 1.0) -> list[str]:
    """Return the answer in sentences."""
    best = sizing.best
    if best is None:
        reasons = "; ".join(f"{family.name}: {family.lacking}" for family in sizing.families)
        return [f"No family of servos does for {sizing.robot.name}. {reasons}.", *_overheating(sizing)]
    counts = " and ".join(f"{count} {name}" for name, count in motor_counts(best).items())
    min_price, max_price = best.price
    name, case, use_fraction = best.binding()[0]
    sentences = [
        f"{best.name} does for {sizing.robot.name}{_slower(sizing, best)}: {counts}, {min_price:.0f} to "
        f"{max_price:.0f} EUR, {1000 * best.mass:.0f} g.",
        f"The binding servo is {name} in {case}, which uses {100 * use_fraction:.0f} % of what "
        f"{best.chosen[name].name} has, by {binding_limit(best.chosen[name], best.loads[case][name])}.",
        f"A battery for {hours:g} h needs at most {best.battery(hours):.1f} Ah at {best.volts:g} V, by the hungriest "
        f"movement.",
        _mass_sentence(sizing, best),
    ]
    actuator_names = [cable.name for cable in sizing.robot.cables if cable.linear is not None]
    if actuator_names:
        sentences.append(f"The linear actuator of {' and '.join(actuator_names)} stays as it is: no family has one.")
    slower = sizing.slower
    if slower is not None:
        min_price, max_price = slower.price
        counts = " and ".join(f"{count} {name}" for name, count in motor_counts(slower).items())
        sentences.append(
            f"{slower.name} would do{_slower(sizing, slower)}: {counts}, {min_price:.0f} to {max_price:.0f} EUR.",
        )
    remembered = sorted(
        {field.replace("_", " ") for motor in best.chosen.values() for field in motor.unconfirmed_fields}
    )
    if remembered:
        sentences.append(
            f"No source confirms what suchus has for their {' and '.join(remembered)}: look before you buy."
        )
    return sentences + _overheating(sizing)


def _mass_sentence(sizing: Sizing, family: ServoFamily) -> str:
    """Return in a sentence what the servos weigh, and which body they fill the most."""
    fullest = link_loads(sizing.robot, family.chosen)[0]
    return (
        f"Its servos are {100 * family.mass / sizing.robot.mass:.0f} % of the robot's {sizing.robot.mass:.3g} kg; "
        f"{fullest.body} carries {1000 * fullest.servos:.0f} g of them and weighs {1000 * fullest.mass:.0f} g with all "
        "that is on it."
    )


def _overheating(sizing: Sizing) -> list[str]:
    """Return in a sentence which servo of the design would get too warm the soonest; nothing if none would."""
    overheated = [
        (load.warm_after, name, case, load)
        for case, loads in sizing.designed_loads.items()
        for name, load in loads.items()
        if isfinite(load.warm_after)
    ]
    if not overheated:
        return []
    time_to_limit, name, case, load = min(overheated, key=lambda entry: entry[:3])
    winding = sizing.robot.servo(name).winding
    assert winding is not None
    assert winding.heat is not None
    count = len({name for _, name, _, _ in overheated})
    servo_text = f"{name} gets too warm" if count == 1 else f"{count} servos get too warm, {name} first"
    limit = f"{winding.heat.limit:.0f}"
    steady = f"{load.steady:.0f}" if f"{load.steady:.0f}" != limit else f"{load.steady:.1f}"
    final_text = f"would reach {steady} °C" if isfinite(load.steady) else "would never stop warming"
    return [
        f"As it is designed, {servo_text}: in {case} it passes the {limit} °C that are allowed after "
        f"{time_to_limit / 60:.2g} min and {final_text} if the movement went on for ever."
    ]


def _slower(sizing: Sizing, family: ServoFamily) -> str:
    """Return the gaits' longer periods at which a family is strong enough; empty if none is longer."""
    longer_periods = {gait: period for gait, period in _periods(sizing, family).items() if family.factors[gait] != 1.0}
    design_periods = {case.gait.name: case.gait.period for case in sizing.cases}
    texts = [
        f"{gait} at a period of {period:.3g} s instead of {design_periods[gait]:.3g} s"
        for gait, period in longer_periods.items()
    ]
    return f" with {' and '.join(texts)}" if texts else ""


def _periods(sizing: Sizing, family: ServoFamily | None) -> dict[str, float]:
    design_periods = {case.gait.name: case.gait.period for case in sizing.cases}
    return {gait: period * (1.0 if family is None else family.factors[gait]) for gait, period in design_periods.items()}


def _content(sizing: Sizing, pictures: Sequence[Mapping[str, Any]], hours: float) -> dict[str, Any]:
    """Return the variables of the page's template."""
    best = sizing.best
    overloaded = [
        {"servo": name, "case": case, "load": load}
        for case, loads in sizing.designed_loads.items()
        for name, load in loads.items()
        if load.at_limit > AT_LIMIT
    ]
    binding = [] if best is None else best.binding()
    rows = [
        {
            "servo": name,
            "bought": best.chosen[name].name,
            "case": case,
            "load": best.loads[case][name],
            "use": use_fraction,
            "why": binding_limit(best.chosen[name], best.loads[case][name]),
            "rated": best.chosen[name].continuous_torque,
            "tension": _tension(best.loads[case][name]),
            "warm": _temperature_text(best.loads[case][name]),
        }
        for name, case, use_fraction in binding
        if best is not None
    ]
    return {
        "robot": sizing.robot,
        "count": len(layout(sizing.robot).servos),
        "cases": [case.name for case in sizing.cases],
        "answer": answer(sizing, hours),
        "families": [
            {
                "one": family,
                "servos": " and ".join(f"{count} {name}" for name, count in motor_counts(family).items()),
                "slower": _slower(sizing, family).removeprefix(" with "),
                "battery": family.battery(hours) if family.passes else None,
            }
            for family in sizing.families
        ],
        "hours": hours,
        "pictures": pictures,
        "rows": rows,
        "weak": overloaded,
        "best": best,
        "allowed": AT_LIMIT,
    }


def _tension(load: ServoLoad) -> str:
    return f"{number(load.tension, 2)} N" if isfinite(load.tension) else ""


def _temperature_text(load: ServoLoad) -> str:
    """Return how warm a servo gets, or when it is too warm."""
    if isfinite(load.warm_after):
        return f"too warm after {load.warm_after / 60:.0f} min"
    return f"{load.steady:.0f} °C"


def _csv(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table as CSV with five digits; empty cells for values that are not known."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    for row in rows:
        writer.writerow([_cell(value) for value in row])
    return text.getvalue()


def _cell(value: object) -> object:
    """Return a cell as CSV shows it: yes or no, five digits, or nothing."""
    if value is None or (isinstance(value, float) and value != value):
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.5g}" if isinstance(value, float) else value
