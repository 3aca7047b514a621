"""MJCF with every digit: MuJoCo writes the words, the model itself gives the numbers."""

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from suchus.robot.design import Robot
from suchus.robot.motion import Gait, hip_height, middle_stance
from suchus.sim.model.actuators import activations
from suchus.sim.model.build import TIMESTEP, build, standing

_DIGITS = 6  # what MuJoCo prints
_KINDS = ("body", "geom", "joint", "site", "light", "tendon", "actuator")
_SKY = {"type": "skybox", "builtin": "gradient", "rgb1": "0.93 0.95 0.97", "rgb2": "0.55 0.62 0.70"}


def mjcf(robot: Robot, gait: Gait, *, timestep: float = TIMESTEP) -> tuple[str, str]:
    """Return a robot as two MJCF texts: itself, with a keyframe ``home``, and a scene that includes it.

    The scene compiles to the same numbers as ``build(robot)``, to the last bit.

    Args:
        robot: the design.
        gait: gait whose mid-stance, trunk and tail straight, is the keyframe.
        timestep: time step of the physics [s].

    Returns:
        The texts of ``NAME.xml`` and ``scene.xml``.
    """
    spec = build(robot, timestep=timestep)
    model = spec.compile()
    root = ElementTree.fromstring(spec.to_xml())
    _restore(root, spec, model)
    world = _child(root, "worldbody")
    scene = ElementTree.Element("mujoco", model=f"{robot.name} on the ground")
    ElementTree.SubElement(scene, "include", file=f"{robot.name}.xml")
    ElementTree.SubElement(ElementTree.SubElement(scene, "asset"), "texture", {**_SKY, "width": "64", "height": "384"})
    ground = ElementTree.SubElement(scene, "worldbody")
    for element in [e for e in world if e.tag != "body"]:
        world.remove(element)
        ground.append(element)
    root.append(_home(model, robot, gait))
    return _text(root), _text(scene)


def home(model: Any, robot: Robot, gait: Gait) -> tuple[np.ndarray, np.ndarray]:
    """Return the generalised positions and the servo angles [rad] in which all feet stand in the middle of their path.

    Trunk and tail are straight.
    """
    servos = middle_stance(robot, gait)
    return standing(model, robot, hip_height(robot, gait), servos), servos


def numbers(values: Sequence[float] | np.ndarray) -> str:
    """Return numbers as XML holds them: the shortest text that reads back to the same bits."""
    return " ".join(repr(float(v) + 0.0).removesuffix(".0") for v in np.ravel(np.asarray(values)))


def _home(model: Any, robot: Robot, gait: Gait) -> ElementTree.Element:
    """Return the keyframe ``home``: positions, servo states and servo angles in mid-stance."""
    qpos, servos = home(model, robot, gait)
    keys = ElementTree.Element("keyframe")
    values = {"qpos": qpos, "act": activations(model, servos), "ctrl": servos}
    ElementTree.SubElement(keys, "key", {"name": "home", **{k: numbers(v) for k, v in values.items()}})
    return keys


def _restore(root: ElementTree.Element, spec: Any, model: Any) -> None:
    """Put every number that MuJoCo rounded back in full, wherever the model or the spec holds it."""
    option = root.find("option")
    if option is not None:
        _refine(option, (model.opt,))
    wraps = iter(model.wrap_prm)  # the joints of all tendons, in the order of the file
    for element in root.iter():
        if element.get("coef") is not None:
            element.set("coef", numbers([next(wraps)]))
        name, kind = element.get("name"), _kind(element)
        if name and kind:
            model_view = getattr(model, kind)(name)
            spec_view = getattr(spec, kind)(name) if hasattr(spec, kind) else None
            _refine(element, (model_view, spec_view))
            stated = element.find("inertial") if kind == "body" else None
            if stated is not None:
                values = {
                    "pos": model_view.ipos,
                    "quat": model_view.iquat,
                    "mass": model_view.mass,
                    "diaginertia": model_view.inertia,
                }
                stated.attrib.update({key: numbers(value) for key, value in values.items()})


def _kind(element: ElementTree.Element) -> str:
    tag = {"general": "actuator", "fixed": "tendon"}.get(element.tag, element.tag)
    return tag if tag in _KINDS else ""


def _refine(element: ElementTree.Element, owners: Sequence[Any]) -> None:
    """Replace the rounded numbers of an element by exact ones of the first owner that has the same digits."""
    for key, text in element.attrib.items():
        if key == "rgba":  # single precision: what is printed is the number that was meant
            continue
        printed_numbers = text.split()
        for owner in owners:
            exact = _numbers_of(owner, key)
            if exact is not None and [f"{v:.{_DIGITS}g}" for v in exact[: len(printed_numbers)]] == printed_numbers:
                element.set(key, numbers(exact[: len(printed_numbers)]))
                break


def _numbers_of(owner: Any, key: str) -> np.ndarray | None:
    try:
        return np.asarray(getattr(owner, key), dtype=float).ravel() + 0.0
    except (AttributeError, TypeError, ValueError, KeyError):
        return None


def _child(root: ElementTree.Element, tag: str) -> ElementTree.Element:
    child = root.find(tag)
    assert child is not None
    return child


def _text(root: ElementTree.Element) -> str:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"
