"""The building sheet of a robot, as a folder: a page, tables, outlines, and what ROS 2 needs."""

import csv
import io
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from suchus.core.files import write
from suchus.hardware.commands import Commands, trajectory_text
from suchus.hardware.outlines import plates_dxf, stl, top_dxf
from suchus.hardware.parts import BodyPart, Sheet
from suchus.hardware.ros import controllers, note, ros_urdf, unfit_reason
from suchus.robot.design import Robot
from suchus.robot.motion import Gait
from suchus.visual import figures
from suchus.visual.pages import embedded, render

PAGE = "index.html"


def write_parts(sheet: Sheet, folder: Path, *, gait: Gait, samples: Commands, outlines: bool = True) -> None:
    """Write the sheet into a folder that is there.

    Args:
        sheet: what the robot is built of.
        folder: folder to write to.
        gait: gait whose trajectory is written.
        samples: its commands.
        outlines: whether STL and DXF are written, which need the extra ``parts``.

    Raises:
        NoOutlines: the extra is not installed.
    """
    for name, text in tables(sheet).items():
        write(folder / name, text)
    if outlines:
        (folder / "outlines").mkdir()
        for body_part in printed_parts(sheet):
            write(folder / "outlines" / f"{body_part.name}.stl", stl(body_part))
        write(folder / "outlines" / "top.dxf", top_dxf(sheet))
        if sheet.plates:
            write(folder / "outlines" / "plates.dxf", plates_dxf(sheet.plates))
    if not unfit_reason(sheet.robot):
        _write_ros(sheet.robot, samples, folder / "ros2")
    svg, png = figures.save(figures.dimension_drawing(sheet.robot), folder, "dimensions")
    picture = {"source": embedded(svg, png), "caption": f"{sheet.robot.name}, its lengths in millimetres."}
    write(folder / PAGE, render("building_sheet.html", folder, **_content(sheet, gait, picture, outlines)))


def _write_ros(robot: Robot, samples: Commands, folder: Path) -> None:
    """Write a robot, its controllers and a trajectory for ROS 2."""
    folder.mkdir()
    write(folder / f"{robot.name}.urdf", ros_urdf(robot))
    write(folder / "controllers.yaml", controllers(robot))
    write(folder / "trajectory.yaml", trajectory_text(robot, samples, virtual=True))
    if note_text := note(robot):
        write(folder / "README.txt", note_text + "\n")


def printed_parts(sheet: Sheet) -> list[BodyPart]:
    """Return the parts that are printed: of those that mirror each other the left one."""
    rights = {f"R{girdle.name}_" for girdle in sheet.robot.girdles}
    return [
        body_part
        for body_part in sheet.parts
        if body_part.kind in ("rod", "shell", "foot") and not body_part.name.startswith(tuple(rights) or ("\0",))
    ]


def tables(sheet: Sheet) -> dict[str, str]:
    """Return the tables of a sheet by the names of their files."""
    texts = {
        "parts.csv": _csv(
            ("body", "part", "kind", "what", "length_m", "width_m", "height_m", "mass_kg", "x_m", "y_m", "z_m"),
            [(p.body, p.name, p.kind, p.description, *p.size, p.mass, *p.centre) for p in sheet.parts],
        ),
        "bodies.csv": _csv(
            ("body", "simulated_kg", "servos_kg", "printed_and_foam_kg", "rest_kg"),
            [(b.name, b.simulated, b.servos, b.printed, b.rest) for b in sheet.bodies],
        ),
        "frames.csv": _csv(
            (
                "hinge",
                "body",
                "parent",
                "x_m",
                "y_m",
                "z_m",
                "axis_x",
                "axis_y",
                "axis_z",
                "low_rad",
                "high_rad",
                "driven_by",
            ),
            [(j.name, j.body, j.parent, *j.at, *j.axis, *(j.range or (None, None)), j.driven_by) for j in sheet.joints],
        ),
        "wiring.csv": _csv(
            ("bus", "id", "servo", "after", "wire_m", "bought"),
            [
                (
                    w.bus,
                    w.number,
                    w.servo,
                    w.after,
                    w.length,
                    sheet.bought[w.servo].name if w.servo in sheet.bought else "",
                )
                for w in sheet.wires
            ],
        ),
        "floating.csv": _csv(
            ("body", "foam_m3", "raised_m"),
            [
                *sheet.floating.foam,
                *(
                    (f"air of {body}", sheet.floating.air * volume_fraction, None)
                    for body, volume_fraction in sheet.floating.chambers
                ),
            ],
        ),
    }
    if sheet.links:
        texts["denavit_hartenberg.csv"] = _csv(
            ("chain", "joint", "a_m", "alpha_rad", "d_m", "turned_by"),
            [(k.chain, k.number, k.a, k.alpha, k.d, k.turned_by) for k in sheet.links],
        )
    if sheet.plates:
        columns = ("plate", "radius_m", "thickness_m", "hole_1_aside_m", "hole_1_up_m", "hole_2_aside_m", "hole_2_up_m")
        rows = [(p.name, p.radius, p.thickness, *p.holes[0], *p.holes[1]) for p in sheet.plates]
        texts["plates.csv"] = _csv(columns, rows)
    for cord in sheet.cords:
        drive = "actuator_m" if cord.linear else "pulley_rad"
        cord_columns = ("bend_rad", drive, "cord_towards_the_bend_m", "cord_away_from_it_m")
        texts[f"{cord.name}.csv"] = _csv(cord_columns, cord.table)
    return texts


def mass_sentences(sheet: Sheet) -> list[str]:
    """Return sentences on total mass, its parts, and the shift of the centre of mass."""
    total = sum(body.simulated for body in sheet.bodies)
    servos, walls = sum(body.servos for body in sheet.bodies), sum(body.printed for body in sheet.bodies)
    if not isfinite(servos):
        return [
            f"The robot weighs {total:.2f} kg in the simulation; printed walls and foam are {walls:.2f} kg of that. "
            "Its servos are numbers and not yet bought, so that their mass is not known: suchus size chooses some, and "
            "suchus parts takes the robot.toml that it writes."
        ]
    remaining_mass = total - servos - walls
    x, _, z = (1000 * (a - b) for a, b in zip(sheet.built, sheet.centre, strict=True))
    sentences = [
        f"The robot weighs {total:.2f} kg in the simulation: {servos:.2f} kg are servos, {walls:.2f} kg printed walls "
        f"and foam, and {remaining_mass:.2f} kg are left for battery, electronics, brackets and screws.",
        f"Without what is left, its centre of mass lies {abs(x):.0f} mm {'ahead of' if x >= 0 else 'behind'} and "
        f"{abs(z):.0f} mm {'above' if z >= 0 else 'below'} the simulated one; battery and electronics should mend it.",
    ]
    heavy = [body for body in sheet.bodies if body.rest < 0.0]
    if heavy:
        names = ", ".join(f"{body.name} by {-1000 * body.rest:.0f} g" for body in heavy)
        sentences.append(
            f"Heavier than in the simulation are {names}: give the robot these masses and walk it once more."
        )
    return sentences


def floating_sentence(sheet: Sheet) -> str:
    """Return a sentence that says whether the robot floats, with the volumes of foam and air."""
    floating = sheet.floating
    foam = sum(volume for _, volume, _ in floating.foam)
    if floating.lacking > 0.0:
        return (
            f"It sinks: {1e6 * floating.lacking:.0f} cm³ of foam are lacking, in proportion to the weight of each "
            "body; suchus.robot.design.flotation.float_hull says how much goes where."
        )
    air = f", and {1e6 * floating.air:.0f} cm³ of air can be let out" if floating.air else ""
    return f"It floats with {-1e6 * floating.lacking:.0f} cm³ above the surface, by {1e6 * foam:.0f} cm³ of foam{air}."


def _content(sheet: Sheet, gait: Gait, picture: dict[str, str], outlines: bool) -> dict[str, object]:
    """Return the variables of the page's template."""
    counts: dict[str, int] = {}
    for motor in sheet.bought.values():
        counts[motor.name] = counts.get(motor.name, 0) + 1
    return {
        "sheet": sheet,
        "gait": gait,
        "picture": picture,
        "counts": counts,
        "printed": printed_parts(sheet),
        "masses": mass_sentences(sheet),
        "floats": floating_sentence(sheet),
        "note": "" if unfit_reason(sheet.robot) else note(sheet.robot),
        "unfit": unfit_reason(sheet.robot),
        "wire": sum(wire.length for wire in sheet.wires),
        "files": sorted(tables(sheet)),
        "outlines": outlines,
        "known": len(sheet.bought) == len(sheet.wires),
    }


def _csv(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table as CSV with six digits; empty cells for values that are not known."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([_cell(value) for value in row] for row in rows)
    return text.getvalue()


def _cell(value: object) -> object:
    if value is None or (isinstance(value, float) and value != value):
        return ""
    return f"{value:.6g}" if isinstance(value, float) else value
