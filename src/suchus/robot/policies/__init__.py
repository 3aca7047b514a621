"""The catalog of policies: one ``.npz`` file, one policy, trained by ``suchus train``."""

from pathlib import Path

from suchus.core.catalog import Catalog
from suchus.robot.control.policy import SUFFIX, Policy, load_policy, save_policy
from suchus.robot.design import Robot

POLICIES: Catalog[Policy] = Catalog(
    "policy", "suchus.robot.policies", "suchus.robot.control.policy:Policy", read_file=load_policy, suffix=SUFFIX
)
"""Policies by name."""


def policy_of(robot: Robot, policy: Policy | str | Path, place: str | Path = Path()) -> Policy:
    """Return the policy that is meant for a robot: itself, by its name, or the path of its file.

    For a robot other than that of the policy of a name, ``NAME_ROBOT`` comes first: ``velocity`` of the strider is
    ``velocity_strider``.

    Args:
        robot: the robot.
        policy: the policy, its name, or the path of its file.
        place: the folder from which paths are read.

    Raises:
        UnknownName: a name that is not in the catalog.
        UnreadableFile: there is no such file, or it is no policy.
        UnsuitedRobot: the policy was trained for another robot.
    """
    if isinstance(policy, str) and f"{policy}_{robot.name}" in POLICIES:
        policy = f"{policy}_{robot.name}"
    resolved = POLICIES.resolve(policy, place)
    resolved.check_robot(robot)
    return resolved


__all__ = ["POLICIES", "SUFFIX", "Policy", "load_policy", "policy_of", "save_policy"]
