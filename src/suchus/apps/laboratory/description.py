"""The facts of a robot, a gait and their limits as JSON, from which the modules in JavaScript compute."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from math import isinf
from typing import Any

import numpy as np

from suchus.apps.viewer.knobs import Knob, knobs_of
from suchus.core.water_table import COLUMNS, pack_table, unpack_table
from suchus.robot.control import OpenLoop, Swimming
from suchus.robot.design import GRAVITY, Robot, layout, servo_ranges
from suchus.robot.design.layout import LIMB_AXES
from suchus.robot.design.limb import Girdle
from suchus.robot.design.pieces import pieces
from suchus.robot.design.scale import control_period, physics_step
from suchus.robot.design.water import Water
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion import START, FixedLimbs, FootPath, Gait, Sweep
from suchus.robot.motion.axis import Hinges, pitch_hinges, yaw_hinges
from suchus.sim.land import Lake
from suchus.sim.metrics.gait import MIN_STANCE_FRACTION, STANCE_BEGIN_LOAD, STANCE_END_LOAD
from suchus.sim.model.export import mjcf

_LIMB_KINDS: Mapping[type, str] = {FootPath: "path", Sweep: "sweep", FixedLimbs: "fixed"}


def robot_facts(robot: Robot) -> dict[str, Any]:
    """Return what the posture of a gait and the physics need of a robot, in SI units; unbounded ranges are None."""
    robot_layout = layout(robot)
    return {
        "name": robot.name,
        "mass": robot.mass,
        "length": robot.length,
        "root": robot.root,
        "servos": list(robot_layout.servos),
        "hinges": list(robot_layout.hinges),
        "bodies": [body.name for body in robot_layout.bodies],
        "ranges": [_finite(row) for row in servo_ranges(robot)],
        "trunk_yaw": list(robot_layout.trunk_yaw),
        "has_tail": bool(robot_layout.tail),
        "girdles": [{"reach": girdle.limb.reach, "above": girdle.above} for girdle in robot.girdles],
        "limbs": [
            {
                "name": limb.name,
                "girdle": limb.number,
                "side": limb.side,
                "servos": [limb.servos.start, limb.servos.stop],
                "driven": [i for i, hinge in enumerate(limb.girdle.limb.hinges) if hinge.servo is not None],
                **_limb_facts(limb.girdle),
            }
            for limb in robot_layout.limbs
        ],
        "yaw": _hinge_facts(yaw_hinges(robot)),
        "pitch": _hinge_facts(pitch_hinges(robot)),
        "cables": [
            {
                "servo": servo,
                "hinges": list(robot_layout.cable(servo).hinges),
                **{
                    name: getattr(robot_layout.cable(servo), name)
                    for name in ("joints", "cord_spacing", "pulley", "bend_limit")
                },
            }
            for servo in robot_layout.cables
        ],
    }


def _limb_facts(girdle: Girdle) -> dict[str, Any]:
    """Return lengths, method and ranges of a limb, and where its search begins anew."""
    limb = girdle.limb
    kind = limb_kinematics.kind(limb)
    ranges = [hinge.range or (-np.inf, np.inf) for hinge in limb.hinges]
    return {
        "kind": kind,
        "above": girdle.above,
        "reach": limb.reach,
        "reaches": list(limb_kinematics.plain(girdle).reach if kind == "leg" else limb_kinematics.reach(limb)),
        "foot_radius": limb.foot.radius,
        "lengths": [link.length for link in limb.links],
        "links": [
            {"end": list(link.end), "axes": [list(LIMB_AXES[hinge.turn]) for hinge in link.hinges]}
            for link in limb.links
        ],
        "ranges": [_finite(row) for row in ranges],
        "restarts": _restarts(ranges) if kind == "other" else [],
    }


def _restarts(ranges: Sequence[tuple[float, float]]) -> list[list[float]]:
    """Return the angles at which ``kinematics.limb.inverse`` begins anew for a point that is stuck [rad]."""
    bounds = np.array([[low, high] if np.isfinite(low) else [-np.pi, np.pi] for low, high in ranges])
    rng = np.random.default_rng(0)
    return [rng.uniform(bounds[:, 0], bounds[:, 1], (1, len(ranges)))[0].tolist() for _ in range(limb_kinematics.SEEDS)]


def _finite(row: Sequence[float] | np.ndarray) -> list[float | None]:
    return [None if isinf(value) else float(value) for value in row]


def _hinge_facts(hinges: Hinges) -> dict[str, Any]:
    return {
        "names": list(hinges.names),
        "servos": list(hinges.servos),
        "signs": list(hinges.signs),
        "parts": list(hinges.parts),
    }


def gait_facts(gait: Gait) -> dict[str, Any]:
    """Return a gait as JSON: its fields, and with each movement of limbs its kind."""
    limbs = [{"kind": _LIMB_KINDS[type(limb)], **asdict(limb)} for limb in gait.limbs]
    return {**{field.name: getattr(gait, field.name) for field in fields(gait)}, "limbs": limbs} | {
        name: [asdict(part) for part in getattr(gait, name)] for name in ("axis", "curves")
    }


def knob_facts(robot: Robot, gait: Gait, others: Mapping[str, Knob]) -> dict[str, dict[str, Any]]:
    """Return the sliders of a gait, and others, by name: label, unit, range, step, SI value of a unit, hint."""
    return {name: asdict(knob) for name, knob in (*knobs_of(robot, gait).items(), *others.items())}


def piece_facts(robot: Robot) -> list[dict[str, Any]]:
    """Return the pieces on which water acts, with the name of the body that carries each."""
    bodies = [body.name for body in layout(robot).bodies]
    table = unpack_table(pack_table(np.array(pieces(robot)), robot.length))
    rows = []
    for row in table:
        columns = {
            name: float(row[start]) if stop - start == 1 else row[start:stop].tolist()
            for name, (start, stop) in COLUMNS.items()
        }
        rows.append(columns | {"body": bodies[int(row[0])]})
    return rows


def physics_facts(robot: Robot, gait: Gait, *, swims: bool) -> dict[str, Any]:
    """Return periods, constants and control with which a robot is simulated, as ``sim.land.simulate`` takes them.

    Args:
        robot: the design.
        gait: the gait.
        swims: whether the gait is played as a swim, from the first moment on, growing from rest.
    """
    water, lake = Water(), Lake(level=0.0)
    control = OpenLoop(begin=0.0, ramp=Swimming().ramp) if swims else OpenLoop()
    return {
        "period": control_period(robot),
        "timestep": physics_step(robot),
        "gravity": GRAVITY,
        "start": START,
        "control": {"begin": control.begin, "ramp": control.ramp},
        "loads": {"begin": STANCE_BEGIN_LOAD, "end": STANCE_END_LOAD, "shortest": MIN_STANCE_FRACTION},
        "water": asdict(water) | {"added_mass": lake.added_mass, "shedding": lake.shedding, "splash": lake.splash},
        "gait_period": gait.period,
    }


def facts(robot: Robot, gait: Gait, *, swims: bool = False) -> dict[str, Any]:
    """Return all that one run in the engine needs: files of the model, robot, gait, physics, pieces."""
    model, scene = mjcf(robot, gait, timestep=physics_step(robot))
    return {
        "files": {f"{robot.name}.xml": model, "scene.xml": scene},
        "robot": robot_facts(robot),
        "gait": gait_facts(gait),
        "physics": physics_facts(robot, gait, swims=swims),
        "pieces": piece_facts(robot),
    }
