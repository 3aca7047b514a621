"""The rows of the atlas and the flows that they are read from. The bounds follow from the sources: ``case.bound``."""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from evidence.atlas import aerofoil, cylinders, oscillated, snake, spheres, still, walls
from evidence.atlas.case import AtlasRow, Case
from suchus.core.errors import UnknownName

_ANGLE = "angle from the front, over the upper side [deg]"
_MISPRINT = (
    " The value at 0.9063 breaks the line of its neighbours and is taken for a misprint by many; it counts here."
)
_FIRST_DRAG = (
    "Most of the difference lies in the first points: the source's drag falls from 3.7 to 2.0 between times 0.1 and "
    "0.14, where the theory for short times (Bar-Lev and Yang 1975, the row at Re 40, by the root of the Reynolds "
    "number) has 1.7 to 1.4."
)
_WILLIAMSON = (
    "In a domain of 16 x 10 diameters the Strouhal number was the same to 0.4 %. Williamson's fit to "
    "measurements (1988, Phys. Fluids 31, 2742: -3.3265 / Re + 0.1816 + 0.00016 Re, up to Re 178) has 0.193 when it is "
    "carried on to here."
)
_SWITCHES = (
    "Between 1.0 and 1.1 times the natural frequency the wake goes over from one state to another; after a start on "
    "few cells, whose own frequency is lower, it comes back slowly ([limits](flow_limits.md#published-flows))."
)
_TIME = "time x speed / diameter [-]"
_FIRST = (0.1, 1e9)  # before, the drag of a body that starts at once has no bound and the first steps no meaning
_COMPUTED_40 = (("koumoutsakos1995_drag_re40", "t_star", "cd", 0.5), ("taira2007_drag_re40", "t", "cd", 1.0))
_DRAG_40 = (*_COMPUTED_40, ("barlev1975_drag_re40", "t", "cd", 1.0))  # the last is a theory, no measure of the others


def _started() -> tuple[AtlasRow, ...]:
    titles = {
        "koumoutsakos1995_drag_re40": ("koumoutsakos_re40", "drag, Koumoutsakos and Leonard 1995"),
        "taira2007_drag_re40": ("taira_re40", "drag, Taira and Colonius 2007"),
        "barlev1975_drag_re40": ("barlev_re40", "drag for short times, Bar-Lev and Yang 1975"),
    }
    drags = tuple(
        AtlasRow(
            name=titles[data][0], title=f"Started cylinder, Re 40: {titles[data][1]}", case="started_re40", data=data,
            x=x, y=y, scale=(factor, 1.0), window=_FIRST, computed_curve="drag", labels=(_TIME, "drag coefficient [-]"),
            other_sources=tuple(one for one in _COMPUTED_40 if one[0] != data),
        )
        for data, x, y, factor in _DRAG_40
    )  # fmt: skip
    faster = tuple(
        AtlasRow(
            name=f"koumoutsakos_re{reynolds}", case=f"started_re{reynolds}",
            title=f"Started cylinder, Re {reynolds}: drag, Koumoutsakos and Leonard 1995", x="t_star", y="cd",
            data=f"koumoutsakos1995_drag_re{reynolds}", scale=(0.5, 1.0), window=_FIRST, computed_curve="drag",
            labels=(_TIME, "drag coefficient [-]"),
        )
        for reynolds in (550, 3000)
    )  # fmt: skip
    length = AtlasRow(
        name="coutanceau_re40", title="Started cylinder, Re 40: recirculation, Coutanceau and Bouard 1977",
        case="started_re40", data="coutanceau1977_length_re40", x="t", y="length", computed_curve="length",
        labels=(_TIME, "length of the recirculation / diameter [-]"),
    )  # fmt: skip
    return (*drags, length, *faster, *_started_1000())


def _started_1000() -> tuple[AtlasRow, ...]:
    sources = (("koumoutsakos1995", "Koumoutsakos and Leonard 1995"), ("mohaghegh2017", "Mohaghegh and Udaykumar 2017"))
    rows = []
    for short, long in sources:
        (other,) = (one for one, _ in sources if one != short)
        author = short[:-4]
        rows.append(
            AtlasRow(
                name=f"{author}_re1000", title=f"Started cylinder, Re 1000: drag, {long}", case="started_re1000",
                data=f"{short}_drag_re1000", x="t_star", y="cd", scale=(0.5, 1.0), window=_FIRST, computed_curve="drag",
                labels=(_TIME, "drag coefficient [-]"), other_sources=((f"{other}_drag_re1000", "t_star", "cd", 0.5),),
            )
        )  # fmt: skip
        rows += [
            AtlasRow(
                name=f"{author}_vorticity_{key}", case="started_re1000", data=f"{short}_vorticity_{key}", x="angle",
                title=f"Started cylinder, Re 1000: vorticity on it after {time} diameters of travel, {long}",
                y="vorticity", scale=(-180.0, 1.0), shift=(180.0, 0.0), period=360.0, skin=True,
                computed_curve=f"vorticity {key}", labels=(_ANGLE, "vorticity x D / U [-]"),
                other_sources=((f"{other}_vorticity_{key}", "angle", "vorticity", -180.0),),
            )
            for key, time in (("0p5", 0.5), ("1p5", 1.5))
        ]  # fmt: skip
    parts = (("friction", "friction", "friction part"), ("pressure", "pressure part", "pressure part"))
    rows += [
        AtlasRow(
            name=f"koumoutsakos_{key}_re1000",
            case="started_re1000",
            data=f"koumoutsakos1995_{key}_re1000",
            title=f"Started cylinder, Re 1000: {words} of the drag, Koumoutsakos and Leonard 1995",
            x="t_star",
            y="cd",
            scale=(0.5, 1.0),
            window=_FIRST,
            computed_curve=ours,
            labels=(_TIME, f"{words} of the drag coefficient [-]"),
            skin=True,
        )
        for key, ours, words in parts
    ]
    rows.append(
        AtlasRow(
            name="chen_drag", title="Cylinder that starts to move and to turn, Re 200: drag, Chen et al. 1993",
            case="turning_re200", data="chen1993_drag_re200", x="t_star", y="cd", scale=(0.5, 1.0), window=_FIRST,
            computed_curve="drag", labels=(_TIME, "drag coefficient [-]"), note=_FIRST_DRAG,
        )
    )  # fmt: skip
    return tuple(rows)


def _oscillated() -> tuple[AtlasRow, ...]:
    rows = []
    for ratio in oscillated.RATIOS:
        key = f"{ratio:g}".replace(".", "p") if ratio != 1 else "1p0"
        case = f"shaken_{ratio:g}".replace(".", "p")
        pressure: AtlasRow | None = None
        for quantity, label in (("pressure", "pressure coefficient [-]"), ("vorticity", "vorticity x D / U [-]")):
            rows.append(
                AtlasRow(
                    any_cycle=True,
                    cycle_of=pressure,
                    name=f"guilmineau_{quantity}_{key}",
                    case=case,
                    x="angle",
                    period=360.0,
                    skin=True,
                    title=f"Cylinder oscillated transversely at {ratio:g} times its natural frequency, Re 185: "
                    f"{quantity}, Guilmineau and Queutey 2002",
                    data=f"guilmineau2002_{quantity}_{key}",
                    y="cp" if quantity == "pressure" else quantity,
                    computed_curve=f"uppermost {quantity}",
                    labels=(_ANGLE, label),
                    note=_SWITCHES if ratio == 1 else "",
                )
            )
            pressure = rows[-1]
    rows.append(
        AtlasRow(name="re185_numbers", title="Cylinder at rest, Re 185: Strouhal number", case="held_re185",
            data="re185_numbers", kind="numbers", note=_WILLIAMSON)
    )  # fmt: skip
    rows.append(
        AtlasRow(
            name="schneiders_drag",
            title="Cylinder oscillated transversely at 0.8 times its natural frequency, Re 185: drag, "
            "Schneiders 2013",
            case="shaken_0p8", data="schneiders2013_drag", x="y", y="cd", kind="loop", computed_curve="drag loop",
            labels=("displacement / diameter [-]", "drag coefficient [-]"),
            note="A point is compared with the nearer of the two branches.",
        )
    )  # fmt: skip
    rows.append(
        AtlasRow(
            name="schneiders_pressure", case="shaken_0p8", data="schneiders2013_pressure", x="angle", y="cp",
            title="Cylinder oscillated transversely at 0.8 times its natural frequency, Re 185: "
            "pressure going down, Schneiders 2013",
            period=360.0, skin=True, computed_curve="pressure going down", labels=(_ANGLE, "pressure coefficient [-]"),
        )
    )  # fmt: skip
    return tuple(rows)


def _resting() -> tuple[AtlasRow, ...]:
    pressures = tuple(
        AtlasRow(
            name=f"li_pressure_re{reynolds}",
            case=case,
            data=f"li2016_pressure_re{reynolds}",
            x="angle",
            y="cp",
            title=f"Cylinder, Re {reynolds}: {mean}pressure, Li et al. 2016",
            period=360.0,
            skin=True,
            computed_curve="pressure",
            labels=(_ANGLE, "pressure coefficient [-]"),
        )
        for reynolds, case, mean in ((40, "steady_re40", ""), (100, "shedding_re100", "mean "))
    )
    return (
        AtlasRow(name="re40_numbers", title="Cylinder, Re 40: drag and length of the wake", case="steady_re40",
            data="re40_numbers", kind="numbers"),
        AtlasRow(name="re100_numbers", title="Cylinder, Re 100: drag, lift and Strouhal number", case="shedding_re100",
            data="re100_numbers", kind="numbers"),
        *pressures,
    )  # fmt: skip


def _still() -> tuple[AtlasRow, ...]:
    strokes = tuple(
        AtlasRow(
            name=f"eldredge_{name}", title=f"Flapping ellipse, Re 75: {name}, Eldredge 2007", case="flapping",
            data=f"eldredge2007_flapping_{name}", x="t_over_period", y=name, computed_curve=name,
            labels=("time / period [-]", f"{name} over its largest quasi-steady value [-]"),
            other_sources=((f"li2015_flapping_{name}", "t_over_period", name, 1.0),), excluded_spacing=apart, note=note,
        )
        for name, apart, note in (
            ("drag", (0.5, 0.02), "Left out: a fiftieth of a period on each side of where the motion turns, and with "
             "it the sign of what is called drag."), ("lift", None, ""),
        )
    )  # fmt: skip
    return (
        AtlasRow(
            name="duetsch_force", title="Cylinder that oscillates in water at rest, Re 100, KC 5: force, Duetsch 1998",
            case="in_line", data="duetsch1998_force", x="t_over_period", y="force", computed_curve="force", period=1.0,
            labels=("time / period [-]", "force / (density x speed^2 x diameter) [-]"),
        ),
        *_two_states(), *strokes,
    )  # fmt: skip


def _two_states() -> tuple[AtlasRow, ...]:
    """Return force across the motion, which tells the state of the wake, and along it in the same cycle."""
    choice = (
        "The wake has states that are each other's mirror image and changes between them, and the source's start is "
    )
    choice += "not known"
    across, along = (
        AtlasRow(
            name=f"duetsch_{short}_kc10", case="two_states", data=f"duetsch1998_{short}_kc10", x="t_over_period",
            y="force", scale=(1.0, 0.25), period=1.0, computed_curve=ours, any_cycle=True, choice=choice,
            title=f"Cylinder that oscillates in water at rest, Re 200, KC 10: {ours} its motion, Duetsch 1998",
            labels=("time / period [-]", "force / (density x speed^2 x diameter) [-]"),
        )
        for short, ours in (("lift", "force across"), ("drag", "force along"))
    )  # fmt: skip
    return across, replace(along, cycle_of=across)


def _pitching() -> tuple[AtlasRow, ...]:
    return tuple(
        AtlasRow(
            name=f"schneiders_pitching_{name}", title=f"NACA 0015 that pitches up, Re 10 000: {name}, Schneiders 2013",
            case="pitching", data=f"schneiders2013_pitching_{name}", x="angle", y=column, computed_curve=name,
            labels=("angle of attack [deg]", f"{name} coefficient [-]"),
        )
        for name, column in (("drag", "cd"), ("lift", "cl"))
    )  # fmt: skip


def _spheres() -> tuple[AtlasRow, ...]:
    return (
        AtlasRow(
            name="sphere_re150",
            title="Sphere, Re 150: drag",
            case="sphere_re150",
            data="sphere_re150_numbers",
            kind="numbers",
        ),
        AtlasRow(
            name="schneiders_sphere",
            title="Sphere that oscillates in water at rest, Re 40: drag, Schneiders 2013",
            case="oscillating_sphere",
            data="schneiders2013_sphere_drag",
            x="t_over_period",
            y="cd",
            computed_curve="drag",
            period=1.0,
            labels=("time / period [-]", "drag coefficient [-]"),
        ),
    )


def _walls() -> tuple[AtlasRow, ...]:
    lines = tuple(
        AtlasRow(
            name=f"ghia_{line}_re{reynolds}", title=f"Lid-driven cavity, Re {reynolds}: {line}, Ghia et al. 1982",
            case=f"cavity_re{reynolds}", data="ghia1982_cavity", x=place, y=f"{line}_re{reynolds}", computed_curve=line,
            window=(0.01, 0.99), is_printed=True, labels=(f"{place} / width [-]", f"{line} / speed of the lid [-]"),
            note="The walls themselves, where both have the wall's speed, are left out."
            + (_MISPRINT if (reynolds, line) == (400, "v") else ""),
            other_sources=(("botella1998_cavity_re1000", place, line, 1.0),) if reynolds == 1000 else (),
        )
        for reynolds in (100, 400, 1000)
        for line, place in (("u", "y"), ("v", "x"))
    )  # fmt: skip
    marchi = tuple(
        AtlasRow(
            name=f"marchi_{line}_re100",
            title=f"Lid-driven cavity, Re 100: {line}, Marchi et al. 2009",
            case="cavity_re100",
            data="marchi2009_cavity_re100",
            x="place",
            y=line,
            error_column=f"{line}_error",
            computed_curve=line,
            labels=(f"{place} / width [-]", f"{line} / speed of the lid [-]"),
        )
        for line, place in (("u", "y"), ("v", "x"))
    )
    botella = tuple(
        AtlasRow(
            name=f"botella_{line}_re1000",
            title=f"Lid-driven cavity, Re 1000: {line}, Botella and Peyret 1998",
            case="cavity_re1000",
            data="botella1998_cavity_re1000",
            x=place,
            y=line,
            is_printed=True,
            computed_curve=line,
            labels=(f"{place} / width [-]", f"{line} / speed of the lid [-]"),
            other_sources=(("ghia1982_cavity", place, f"{line}_re1000", 1.0),),
        )
        for line, place in (("u", "y"), ("v", "x"))
    )
    return (
        *lines, *marchi, *botella,
        AtlasRow(name="dfg_2d1", title="Cylinder in a channel, DFG 2D-1", case="dfg_2d1", data="dfg_2d1_numbers",
            kind="numbers"),
        AtlasRow(name="dfg_2d2", title="Cylinder in a channel, DFG 2D-2", case="dfg_2d2", data="dfg_2d2_numbers",
            kind="numbers"),
        AtlasRow(name="wachs_numbers", title="Settling cylinder: terminal speed, Wachs 2009", case="settling",
            data="wachs2009_numbers", kind="numbers"),
        AtlasRow(
            name="wachs_path", title="Settling cylinder: path, Wachs 2009", case="settling", data="wachs2009_path",
            x="y", y="x", shift=(0.0, -2.0), window=(-20.0, 40.0), computed_curve="path",
            labels=("height / diameter [-]", "distance from the middle / diameter [-]"),
        ),
    )  # fmt: skip


def _snakes() -> tuple[AtlasRow, ...]:
    return tuple(
        AtlasRow(
            name=f"snake_{degrees}_re{reynolds}", case=f"snake_{degrees}_re{reynolds}", kind="numbers",
            title=f"Flying snake's cross-section at {degrees} degrees, Re {reynolds}, Krishnan et al. 2014",
            data=f"snake_{degrees}_re{reynolds}_numbers",
        )
        for reynolds in (1000, 2000)
        for degrees in (30, 35)
    )  # fmt: skip


GROUPS: Mapping[str, tuple[AtlasRow, ...]] = MappingProxyType(
    {
        "Boxes and channels": _walls(),
        "Started cylinders": _started(),
        "Cylinders at rest in a stream": _resting(),
        "Bodies that move in water at rest": _still(),
        "Cylinder oscillated across a stream": _oscillated(),
        "Aerofoil that pitches": _pitching(),
        "Flying snake": _snakes(),
        "Spheres": _spheres(),
    }
)
"""The rows by what they have in common, in the order of the page."""

ROWS: Mapping[str, AtlasRow] = MappingProxyType({row.name: row for rows in GROUPS.values() for row in rows})
"""The rows by their names."""

CASES: Mapping[str, Case] = MappingProxyType(
    {case.name: case for room in (walls, cylinders, still, oscillated, aerofoil, snake, spheres) for case in room.CASES}
)
"""The flows by their names."""


LONGEST = (
    *(f"snake_{degrees}_re{reynolds}" for reynolds in (2000, 1000) for degrees in (30, 35)),
    "two_states", *(case.name for case in oscillated.CASES), "flapping", "shedding_re100", "dfg_2d2", "settling",
    "pitching", "sphere_re150",
)  # fmt: skip
"""Flows that are begun first, so that no process idles in the end."""


def chosen(names: tuple[str, ...]) -> tuple[AtlasRow, ...]:
    """Return rows by their names, all if there are none.

    Raises:
        UnknownName: there is no such row.
    """
    for name in names:
        if name not in ROWS:
            raise UnknownName("row", name, ROWS)
    return tuple(ROWS[name] for name in dict.fromkeys(names)) if names else tuple(ROWS.values())
