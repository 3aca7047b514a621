"""The page: facts, engine and modules in one HTML file that opens from a disk and needs no network."""

import re
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import replace
from importlib.resources import files
from typing import Any, NamedTuple

import xarray as xr
from markupsafe import Markup

from suchus.apps.laboratory.description import facts, knob_facts
from suchus.apps.laboratory.engine import Engine, licence_text, read_engine
from suchus.apps.viewer.knobs import LEVEL, SLOPE, Knob, force_on, push_on
from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog.displacement.experiment import Displacement
from suchus.robot.control import OpenLoop, Swimming
from suchus.robot.design import Robot, layout
from suchus.robot.design.needs import lacking
from suchus.robot.design.scale import control_period, gravity_time
from suchus.robot.gaits import control_group
from suchus.robot.motion import Gait, check_limits
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.afloat import floats
from suchus.visual.pages import embed_json
from suchus.visual.replay.page import render_template
from suchus.visual.skin import skin
from suchus.visual.skin.ankles import ANKLES, FLAT_FOOT_HEIGHTS
from suchus.visual.skin.ankles import REACH as ANKLE_REACH

MAX_SIZE = 5_000_000
"""Size of a page at most [byte]."""


class Reference(NamedTuple):
    """What the second robot keeps, and how the page speaks of it."""

    label: str
    """What the second robot is called."""
    question: str
    """Question that the two robots answer."""
    caption: str
    """Sentence on both robots."""


OWN_LABEL = "your gait"
"""What the robot in the user's gait is called."""
REFERENCES: Mapping[str, Reference] = {
    "axis": Reference(
        "axis still",
        "Does bending the axis take it farther?",
        "Two robots from the same start: one moves as you say; the other, pale, keeps its axis still.",
    ),
    "first": Reference(
        "first numbers",
        "Do your numbers take it farther?",
        "Two robots from the same start: one moves as you say; the other, pale, keeps the first numbers.",
    ),
}
"""The second robot by name: the control group, and for a body whose axis cannot bend the gait at the beginning."""
FRICTION = Knob(
    label="ground friction", unit="× design", low=0.1, high=2.0, step=0.05,
    hint="Factor on the friction of all the robot's surfaces.",
)  # fmt: skip
_MODULES = ("movement", "gait", "measures", "water", "walk", "page")
_DEFAULT_DEPTH = 0.5  # of the water of a robot that swims by default [body length]
_PUSH_TIME = 0.3  # duration of a push of a robot as long as the article's [s]
_EXPORT = re.compile(r"^export (?=async |class |const |function )", re.M)
_IMPORT = re.compile(r"^import .*? from \"\./\w+\.js\";\n", re.M)


def swims_by_default(robot: Robot, gait: Gait) -> bool:
    """Return whether a robot and its gait are made for water: it floats, and its limbs neither step nor turn."""
    return not gait.has("foot paths") and not gait.has("strokes") and gait.has("wave") and floats(robot)


def laboratory_page(
    robot: Robot, gait: Gait, *, level: float | None = None, robot_word: str = "", engine: Engine | None = None
) -> str:
    """Return one HTML page in which a robot walks or swims, beside its control group.

    Args:
        robot: the robot.
        gait: the gait at the beginning.
        level: level of the water above the ground where the run begins [m]; by default there is water if the robot
            swims by default.
        robot_word: name or file by which commands find the robot; by default its name.
        engine: MuJoCo in WebAssembly; the pinned one if None.

    Raises:
        NoEngine: the engine is not on this machine.
        OutsideLimits: the robot cannot follow the gait.
        InvalidDesign: the level is out of range, or the page becomes too large.
    """
    check_limits(robot, gait)
    if level is not None:
        require("page", "water", level, 0.0, 10.0 * robot.length, "m")
    engine = read_engine() if engine is None else engine
    swims = swims_by_default(robot, gait)
    if swims and level is None:
        level = round(_DEFAULT_DEPTH * robot.length, 3)
    first = _first_records(robot, gait, level, swims=swims)
    reference = reference_of(robot)
    command, command_use = _next_command(robot, robot_word or robot.name)
    labels = (OWN_LABEL, REFERENCES[reference].label)
    page = render_template(
        "laboratory.html",
        first.isel(run=0),
        robot,
        ghost=first.isel(run=1),
        labels=labels,
        is_live=True,
        title=f"{robot.name}: the laboratory in one page",
        caption=REFERENCES[reference].caption,
        question=REFERENCES[reference].question,
        robot_labels=labels,
        facts=embed_json(
            _page_facts(robot, gait, level, swims=swims) | {"labels": list(labels), "reference": reference}
        ),
        engine_script=Markup(_inline_script(engine.script)),
        engine_binary=Markup(b64encode(engine.binary).decode("ascii")),
        program=Markup(program()),
        licence=licence_text(),
        command=command,
        command_use=command_use,
    )
    size = len(page.encode())
    if size > MAX_SIZE:
        raise InvalidDesign(
            f"the page of robot {robot.name!r} would have {size / 1e6:.1f} MB; {MAX_SIZE / 1e6:g} MB are allowed."
        )
    return page


def reference_of(robot: Robot) -> str:
    """Return what the second robot keeps, a name of ``REFERENCES``."""
    return "first" if lacking(robot, ("axis",)) else "axis"


def _next_command(robot: Robot, robot_word: str) -> tuple[str, str]:
    """Return the command that takes the saved gait of a robot, and what it does."""
    if lacking(robot, Displacement.needs):
        return f"suchus page {robot_word} my_gait.toml", "begins with it"
    return (
        f"suchus run displacement --robot {robot_word} --gait my_gait.toml",
        "judges it by twelve robots as they are built",
    )


def program() -> str:
    """Return the modules as one: without exports, and without the imports that their order makes needless."""
    return "\n".join(_EXPORT.sub("", _IMPORT.sub("", _source(f"{name}.js"))) for name in _MODULES)


def _source(name: str) -> str:
    return (files("suchus.apps.laboratory") / "modules" / name).read_text(encoding="utf-8")


def _inline_script(script: str) -> str:
    """Return the engine's interface as the beginning of a module: what it exports becomes a name in it."""
    return script.replace("export default loadMujoco;", "").replace("</script", "<\\/script").replace("<!--", "<\\!--")


def _first_records(robot: Robot, gait: Gait, level: float | None, *, swims: bool) -> xr.Dataset:
    """Return a record of the first control period of both robots, for the picture before the engine has started."""
    runs = [
        Run(
            robot=robot,
            gait=run_gait,
            lake=None if level is None else Lake(level=level),
            control=Swimming() if swims else OpenLoop(),
        )
        for run_gait in (gait, control_group(gait))
    ]
    return simulate(runs, duration=control_period(robot), effort=False)


def _page_facts(robot: Robot, gait: Gait, level: float | None, *, swims: bool) -> dict[str, Any]:
    """Return all that the page's program needs beside the player's scene."""
    force = force_on(robot)
    water = replace(LEVEL, high=round(1e3 * max(robot.length, level or 0.0)), step=max(1.0, round(5 * robot.length)))
    slope = replace(SLOPE, low=-15.0, high=15.0)
    others = {"friction": FRICTION, "uphill": slope, "level": water, "force": force}
    surface = skin(robot)
    limbs = layout(robot).limbs
    ankles = [] if surface.plain else [surface.bones.index(f"{name.removesuffix('_ankle')}_tibia") for name in ANKLES]
    return facts(robot, gait, swims=swims) | {
        "knobs": knob_facts(robot, gait, others),
        "settings": {"friction": 1.0, "uphill": 0.0, "level": level, "force": push_on(robot)},
        "wet_level": round(min(0.3 * robot.length, 0.001 * water.high), 3),
        "push_time": round(_PUSH_TIME * gravity_time(robot.length) / gravity_time(1.0), 3),
        "ankles": {
            "shanks": ankles,
            "sides": [limb.side for limb in limbs],
            "radii": [limb.girdle.limb.foot.radius for limb in limbs],
            "reach": ANKLE_REACH,
            "heights": list(FLAT_FOOT_HEIGHTS),
        },
    }
