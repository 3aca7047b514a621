"""Inputs that were answered silently, or with a traceback: each ends in a sentence, and its neighbours run."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import Doubtful, InvalidDesign, OutsideLimits

CIRCLE, BALL, WALL = flow.Cylinder(diameter=1.0), flow.Sphere(diameter=1.0), flow.Wall()
PLANE = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=1 / 8)
SPACE = flow.Grid.covering((-1.2, 1.2), (-1.2, 1.2), (-1.2, 1.2), cell=0.1)
STATIONS, ZERO = np.linspace(0.0, 1.0, 41), np.zeros(41)
LAW = flow.BodyContact(gap=0.3, pressure=1.0)


def simulation(*bodies, grid=PLANE, **options):
    return flow.Simulation(flow.Setup(**{"grid": grid, "viscosity": 0.02, "bodies": bodies, "coarse": True} | options))


def stream(*bodies, **options):
    return simulation(*bodies, stream=(1.0, 0.0), **options)


def fish(spine, **options):
    return flow.Body(shape=flow.Midline(spine=spine, **options))


def midline(**changes):
    rows = {"x": STATIONS - 0.5, "y": ZERO, "heading": ZERO, "half_width": 0.2 + ZERO, "x_rate": ZERO, "y_rate": ZERO,
            "heading_rate": ZERO}  # fmt: skip
    return flow.MidlineState(**rows | changes)


def drifting(time):
    return midline(y=ZERO + 0.2 * time, y_rate=ZERO + 0.2)


def inflow(profile, **sides):
    return flow.Sides(left=flow.Inflow(profile=profile), right=flow.Outflow(), **sides)


REFUSED = {
    "a stream that is a class": (lambda: simulation(stream=object), "stream is the class object; give a velocity"),
    "an end that is a text": (lambda: stream().run("3"), "until '3' s; give a finite time"),
    "no interval": (lambda: stream().run(0.1, watch=print, watch_interval=0.0), r"interval of watch is 0\.0 s"),
    "an interval below 0": (lambda: stream().run(0.1, watch=print, watch_interval=-1.0), r"interval of watch is -1\.0"),
    "a watch that is no function": (lambda: stream().run(0.1, watch=3), "watch is 3; give a function"),
    "a step that is a text": (lambda: stream().advance("a"), "a step is to last 'a' s"),
    "a step far too long": (lambda: stream(flow.Body(shape=CIRCLE)).advance(5.0), "has Courant number .* at most"),
    "no thread": (lambda: flow.Simulation(stream().setup, thread_count=0), "is to use 0 threads"),
    "a size that is a text": (lambda: flow.Sphere(diameter="1"), "diameter is '1' m; a positive length"),
    "an inflow of nothing": (lambda: simulation(sides=inflow(lambda y: None)), "are array.None.*one finite number"),
    "a start of nothing": (lambda: simulation(start=lambda x, y: None), "start gives None; it returns 2 arrays"),
    "a midline of nothing": (lambda: simulation(fish(lambda time: None)), "the spine of a midline gives None"),
    "a midline of lists": (lambda: simulation(fish(lambda time: midline(x=list(STATIONS)))), "x of the midline is"),
    "a midline that moves and may not": (
        lambda: simulation(fish(drifting, deforms=False)), r"deforms=False, and its midline moves by 0\.0"
    ),
    "a box around no body": (lambda: stream().control(0.2), "a control volume goes around bodies, and there is none"),
    "a box inside the body": (lambda: stream(flow.Body(shape=CIRCLE)).control(-1.0), "a distance of at least 0"),
    "a box of no size": (lambda: stream(flow.Body(shape=CIRCLE)).control(float("nan")), "margin .* is nan m"),
    "a cell in centimetres": (
        lambda: flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=12.5), "cells of 12.5 m are wider than the rectangle"
    ),
    "a stream that turns into a wall": (
        lambda: [sim.advance() for sim in [simulation(sides=flow.Sides(left=WALL), stream=lambda t: (t, 0.0))] * 4],
        r"along x at t = .* s, and the left side is a Wall",
    ),
}  # fmt: skip
"""What is refused: what to do, and a part of the sentence."""


@pytest.mark.parametrize("case", REFUSED)
def test_it_is_refused_in_a_sentence(case):
    do, words = REFUSED[case]
    with pytest.raises((InvalidDesign, OutsideLimits), match=words) as caught:
        do()
    assert "\n" not in str(caught.value)


def free(**options):
    return flow.FreeBody(**{"shape": CIRCLE, "density": 2.0} | options)


SAID = {
    "a swing in degrees": (
        lambda: simulation(flow.Body(shape=CIRCLE, motion=flow.Oscillation(frequency=0.1, pitch=30.0))),
        "the amplitude of the pitch of body is 30 rad",
    ),
    "an anchor in degrees": (
        lambda: simulation(free(anchor=(0.0, 0.0, 45.0), springs=(0.0, 0.0, 1.0))), "anchor of body is 45 rad",
    ),
    "a weight of nothing": (
        lambda: simulation(free(density=None, gravity=(0.0, -9.81))), "its density is the water's.* gravity does noth",
    ),
    "a weight along a locked axis": (
        lambda: simulation(free(gravity=(0.0, -1.0), free=(True, False, True))),
        r"gravity=\(0.0, -1.0\) of body acts only along .* locks",
    ),
    "a spring along a locked axis": (
        lambda: simulation(free(springs=(0.0, 0.0, 2.0), free=(True, True, False))), "springs=.* locks: it does noth",
    ),
    "a damper about a locked axis in space": (
        lambda: simulation(free(shape=BALL, dampers=(0.0, 0.0, 0.0, 1.0, 0.0, 0.0), free=(True,) * 3), grid=SPACE),
        "dampers=.* locks: it does nothing",
    ),
    "a contact in cells": (
        lambda: simulation(free(), contact=flow.BodyContact(gap=2.5, pressure=1.0)), r"is 2\.5 m or 20 cells",
    ),
    "a contact of nothing": (
        lambda: simulation(free(), contact=flow.BodyContact(gap=1e-3, pressure=1.0)), r"or 0\.008 cells.* give 0\.312",
    ),
    "a contact without a free body": (
        lambda: simulation(flow.Body(shape=CIRCLE), contact=LAW), "a contact is given and no FreeBody",
    ),
    "a stream that enters by an outflow": (
        lambda: stream(sides=flow.Sides(left=flow.Outflow())), "enters with 1 m/s through the left side, an Outflow",
    ),
    "an inflow that leaves": (
        lambda: simulation(sides=inflow(lambda y: -1.0 + 0 * y)), "is -1 m/s: water leaves there. Positive is into",
    ),
}  # fmt: skip
"""What is said and goes on: what to do, and a part of the warning."""


@pytest.mark.parametrize("case", SAID)
def test_it_is_said(case):
    do, words = SAID[case]
    with pytest.warns(Doubtful, match=words):
        do()


@pytest.mark.parametrize("do", [
    lambda: simulation(free(gravity=(0.0, -1.0))),
    lambda: simulation(free(gravity=(0.3, -1.0), springs=(1.0, 1.0, 0.0), free=(False, True, False))),
    lambda: simulation(free(shape=BALL, gravity=(0.0, 0.0, -1.0), free=(True,) * 6), grid=SPACE),
    lambda: simulation(free(), contact=LAW),
    lambda: simulation(sides=inflow(lambda y: 1.0 + 0 * y), stream=(1.0, 0.0)),
    lambda: simulation(flow.Body(shape=CIRCLE, motion=flow.Oscillation(frequency=0.1, pitch=3.0))),
    lambda: simulation(fish(lambda time: midline(), deforms=False)),
    lambda: flow.Grid.covering((0.0, 1.0), (0.0, 1.0), cell=1.0),
    lambda: simulation(sides=flow.Sides(bottom=WALL), stream=lambda time: (time, 0.0)).advance(),
], ids=range(9))  # fmt: skip
def test_inputs_beside_them_are_answered_without_a_word(do):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        do()


def test_several_watchers_are_called_and_what_calls_itself_is_a_function():
    seen = []
    watchers = [lambda sim: seen.append("a"), SimpleNamespace(calls=seen).calls.append]
    stream().run(0.1, watch=watchers, progress=False)
    assert seen[0] == "a"
    assert isinstance(seen[1], flow.Simulation)
