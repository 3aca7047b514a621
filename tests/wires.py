"""Emulated buses for tests, with a body that needs no physics: servos that are where they were sent."""

from dataclasses import replace

import numpy as np
from tests.felt import felt

from suchus.hardware.bus import Bus, BusPlace, straight
from suchus.hardware.emulator import Emulator, MemoryPort, Trouble
from suchus.hardware.protocols import bus_protocol
from suchus.robot.design import layout
from suchus.robot.design.scale import control_period
from suchus.robot.robots import ROBOTS


class Obedient:
    """A body whose servos are at their goals at once where they have torque."""

    def __init__(self, robot=ROBOTS["caiman"], angles=0.0):
        self.robot, self.period, self.servos = robot, control_period(robot), layout(robot).servos
        self.angles = np.full(len(self.servos), float(angles))
        self.goals = self.angles.copy()
        self.powered = np.ones(len(self.servos))
        self.torques = np.zeros(len(self.servos))
        self.tick, self.latency = 0, 0.0
        self.lost_power_at = {}

    @property
    def time(self):
        return self.tick * self.period

    def sensed(self):
        seen = felt(self.robot, servo_torque=self.torques, foot_pressure=1.5)
        return replace(seen, servo_position=self.angles[None].copy())

    def aim(self, goals):
        for place, angle in goals.items():
            self.goals[place] = angle

    def power(self, place, share):
        if share == 0.0 and self.powered[place] > 0.0:
            self.lost_power_at[self.servos[place]] = self.time
        self.powered[place] = share

    def step(self):
        self.tick += 1
        self.angles = np.where(self.powered > 0.0, self.goals, self.angles)


def wiring(protocol="dynamixel", robot=ROBOTS["caiman"], buses=1, boards=False):
    places = [BusPlace(port=f"bus{i}", protocol=protocol) for i in range(buses)]
    return straight(robot, places, bus_protocol(protocol).default_model, boards=boards)


def emulated(protocol="dynamixel", trouble=None, **of_body):
    """Return an emulator without physics, and a bus to it."""
    made = wiring(protocol)
    emulator = Emulator(made, Obedient(**of_body), trouble or Trouble(), has_clock=True)
    return emulator, Bus(MemoryPort(emulator), bus_protocol(protocol), has_clock=True)
