"""Joints have their names and places from the layout: none is spelled, and none is counted, outside the robots.

A name of a servo or hinge of a robot of the shelf may stand in ``design``, where the article's joints are named, in
``robots`` and in ``gaits``. Elsewhere it is allowed only where it means something else, and what it means is said here.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from suchus.robot.design import layout
from suchus.robot.robots import ROBOTS

SOURCES = Path(__file__).parents[2] / "src" / "suchus"
HOME = (
    "robot/design/",
    "robot/robots/",
    "robot/gaits/",
    "sim/faults/",
)  # a fault's examples name a joint of the caiman
COUNTS = {12, 14, 16, 17, 18, 19}
"""Of joints and servos of the article's robot, and places among them."""
NOT_JOINTS = {
    "tail_pitch": "a number of a gait, a need, and a group of servos in measures and legends",
    "tail_cable": "a group of servos in measures and legends",
    "LH_pitch": "the joint that joint_loops asks about unless another is named",
}
WHERE = {
    "tail_pitch": {
        "experiments/catalog/death_roll/experiment.py",
        "experiments/catalog/feedback/experiment.py",
        "experiments/catalog/displacement/figure.py",
        "experiments/catalog/death_roll/figure.py",
        "experiments/catalog/joint_loops/figure.py",
        "robot/control/tail.py",
        "robot/motion/forms.py",
        "robot/motion/gait.py",
        "experiments/optimise/ready.py",
        "experiments/study/claims.py",
        "apps/viewer/knobs.py",
    },
    "tail_cable": {
        "experiments/catalog/death_roll/figure.py",
        "experiments/catalog/joint_loops/figure.py",
    },
    "LH_pitch": {"experiments/catalog/joint_loops/experiment.py"},
}
COLUMNS = {
    "swimming/coupling/simulation.py": "letters of a digest",
    "experiments/catalog/swim_3d/experiment.py": "letters of a digest",
    "experiments/catalog/swimming/ladder.py": "letters of a digest",
    "core/kernel_cache.py": "letters of a digest",
    "core/machine.py": "letters of a digest",
    "article/verdict/rule.py": "letters of a digest",
    "sim/immersion/meshes.py": "the corners of a triangle",
    "sim/hydro/forces.py": "rows of the table of pieces and of inertia",
    "robot/design/pieces.py": "a row of the table of pieces",
    "hardware/bus/wiring.py": "letters of a digest",
    "core/files/provenance.py": "letters of a digest",
    "core/jobs/made_by.py": "letters of a digest",
    "core/sources.py": "letters of a digest",
    "robot/control/policy.py": "letters of a digest",
    "experiments/study/claims_table.py": "letters of a digest",
}
"""Files with such a number in brackets, and what it means there."""


def names() -> set[str]:
    """Return every servo and hinge of the shelf."""
    return {name for robot in ROBOTS.values() for name in (*layout(robot).servos, *layout(robot).hinges)}


def spelled(source: str, joints: set[str]) -> Iterator[tuple[int, str]]:
    """Yield the lines of a source, outside docstrings, in which a joint is named, or counted in brackets."""
    tree = ast.parse(source)
    docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            if node.value in joints:
                yield node.lineno, node.value
        elif isinstance(node, ast.Subscript):
            for part in ast.walk(node.slice):
                value = part.value if isinstance(part, ast.Constant) else None
                words = re.findall(r"\b\d+\b", value) if isinstance(value, str) else [value]
                if COUNTS & {int(word) for word in words if word is not None and str(word).isdigit()}:
                    yield node.lineno, "[]"


def test_no_joint_is_spelled_or_counted_outside_the_robots():
    joints, found = names(), []
    for file in sorted(SOURCES.rglob("*.py")):
        place = file.relative_to(SOURCES).as_posix()
        if place.startswith(HOME):
            continue
        for line, what in spelled(file.read_text(), joints):
            if place not in WHERE.get(what, ()) and not (what == "[]" and place in COLUMNS):
                found.append(f"{place}:{line}: {what}")
    assert found == []


def test_what_is_allowed_is_still_there():
    joints = names()
    for what, places in WHERE.items():
        assert NOT_JOINTS[what]
        for place in places:
            assert what in {name for _, name in spelled((SOURCES / place).read_text(), joints)}, (what, place)
    for place in COLUMNS:
        assert "[]" in {name for _, name in spelled((SOURCES / place).read_text(), joints)}, place


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ('x = servos.index("spine_yaw_1")', ["spine_yaw_1"]),
        ("x = angles[..., 12:17]", ["[]", "[]"]),
        ('def f(x: Float[np.ndarray, "run 19"]) -> None: ...', ["[]"]),
        ("x = angles[17]", ["[]"]),
        ('"""Of spine_yaw_1."""', []),
        ("x = angles[5]", []),
        ('x = "spine_yaw"', []),
    ],
)
def test_the_guard_sees_a_joint_that_is_spelled(source, found):
    assert [what for _, what in spelled(source, names())] == found
