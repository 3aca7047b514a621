"""What broke the closed forms once: arguments of other kinds and shapes, each a sentence now."""

import numpy as np
import pytest

import suchus
from suchus.core.errors import InvalidDesign
from suchus.robot.design import layout
from suchus.robot.kinematics import dh, leg, limb, printed, spine, tail, tree, wave

CAIMAN = suchus.ROBOTS["caiman"]
ARM = layout(suchus.ROBOTS["strider"]).limbs[0].girdle.limb
WAVE = wave.reading("I", length=1.0, angular_frequency=1.0)
POINT = [CAIMAN.spine.base + 3.9 * CAIMAN.spine.link, 0.0, 0.0]

BAD = {
    "posture that is none": (tree.landmarks, CAIMAN, None),
    "posture that is a truth": (tree.landmarks, CAIMAN, True),
    "posture of one number": (tree.landmarks, CAIMAN, 0.0),
    "posture of words": (tree.frames, CAIMAN, ["x"]),
    "centre of too few": (tree.centre_of_mass, CAIMAN, np.zeros(3)),
    "axis of two": (tree.rotation, (0.0, 1.0), 0.0),
    "axis that is none": (tree.rotation, True, 0.0),
    "azimuths that are too many": (spine.least_bending, CAIMAN.spine, POINT, np.zeros((2, 3))),
    "azimuth that is NaN": (spine.least_bending, CAIMAN.spine, POINT, np.nan),
    "first yaws that go with nothing": (
        lambda: spine.inverse(CAIMAN.spine, np.tile(POINT, (2, 1)), 0.0, first_yaw=np.zeros(3)),
    ),
    "branches at once": (lambda: spine.inverse(CAIMAN.spine, POINT, 0.0, first_yaw=0.0, branch=np.array([1, -1])),),
    "knees at once": (lambda: leg.inverse(CAIMAN.hind_leg, [0.1, 0.1, 0.0], knee=np.array([1, -1])),),
    "ahead of several": (lambda: spine.jacobian(CAIMAN.spine, np.zeros(5), forward_offset=np.zeros(30)),),
    "links that are several": (dh.transform, np.zeros(3), 0.0, 0.0, np.zeros(5)),
    "twist that is none": (dh.transform, 0.0, {}, 0.0, 0.0),
    "turn that is none": (dh.transform, 0.0, 0.0, 0.0, b"x"),
    "limb's angles": (limb.forward, ARM, 3.0),
    "limb's target": (limb.inverse, ARM, [1.0]),
    "length that is none": (lambda: wave.reading("I", length={}, angular_frequency=1.0),),
    "lengths": (lambda: wave.reading("I", length=np.ones(2), angular_frequency=1.0),),
    "frequencies": (lambda: wave.printed_wave(angular_frequency=np.ones(2)),),
    "sign that is none": (lambda: wave.reading("I", length=1.0, angular_frequency=1.0, sign=None),),
    "place and time": (wave.displacement, WAVE, np.zeros(3), np.zeros(2)),
    "place that is none": (wave.envelope, WAVE, object),
    "printed foot": (printed.leg_inverse, CAIMAN.hind_leg, None),
    "printed bend": (printed.cable_changes, CAIMAN.tail, "x"),
    "bend that is NaN": (tail.servo_angle, CAIMAN.tail, np.nan),
}


@pytest.fixture(autouse=True)
def without_the_checks_of_shapes(monkeypatch):
    """As everybody has it; the tests switch them on."""
    monkeypatch.setattr("jaxtyping.config.jaxtyping_disable", True)


@pytest.mark.parametrize("case", BAD)
def test_arguments_that_broke_closed_forms_are_a_sentence(case):
    function, *given = BAD[case]
    with pytest.raises(InvalidDesign, match=r"(needed|allowed|go together)"):
        function(*given)
