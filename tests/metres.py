"""Gaits of the article's robot with other metres, for tests."""

from dataclasses import replace

import numpy as np

from suchus.robot.gaits.belly_crawl import LIMBS
from suchus.robot.motion import START, Gait, GaitInMetres, movement
from suchus.robot.robots import ROBOTS


def with_metres(gait: Gait, **changes) -> Gait:
    """Return a gait of the article's robot with other numbers of ``GaitInMetres``."""
    return replace(GaitInMetres.from_gait(gait, LIMBS), **changes).gait(LIMBS)


def limb_phase(gait: Gait, time):
    """Return the phase of each limb by the gait's clock, not wrapped [cycle]."""
    clock = np.maximum(np.asarray(time) - START, 0.0) / gait.period
    return clock[..., None] + np.array(gait.limb_phases)


def trunk_bend(gait: Gait, phase):
    """Return the lateral bend of the caiman's trunk, left positive [rad]."""
    here = movement(ROBOTS["caiman"], gait)
    many = np.atleast_2d(phase)
    return here.bend_of("trunk", here.axis_phase(many)).reshape(np.shape(phase)[:-1])


def tail_bend(gait: Gait, phase):
    """Return the lateral bend of the caiman's tail, tip to the right positive [rad]."""
    here = movement(ROBOTS["caiman"], gait)
    many = np.atleast_2d(phase)
    return -here.bend_of("tail", here.axis_phase(many)).reshape(np.shape(phase)[:-1])


def placed(robot, gait: Gait, phase):
    """Return the servo angles with limbs at some phases and the axis following them [rad]."""
    here = movement(robot, gait)
    return here.targets(phase, here.axis_phase(phase))
