"""From the article's bend angles to joints, the reverse of ``suchus.article.paper.to_bend_angles``."""

from suchus.article.paper import BendAngles, JointSums


def to_joint_sums(bends: BendAngles) -> JointSums:
    """Return the sums of joint angles [rad] for bend angles in the article's signs [rad]."""
    return JointSums(
        spine_yaw=-bends.spine_lateral,
        spine_pitch=bends.spine_vertical,
        tail_yaw=bends.tail_lateral,
        tail_pitch=bends.tail_vertical,
    )
