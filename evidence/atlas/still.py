"""Bodies that move to and fro in water at rest."""

from dataclasses import replace
from functools import partial

import numpy as np

from evidence.atlas.case import LONG_STEP, Case, Curves, RunEffort, grids
from evidence.atlas.marching import formed, march, middles, refined
from suchus import flow
from suchus.core.progress import Progress, staged

_CODE = ("still.py", "marching.py", "case.py")
_KEULEGAN = 5.0  # [-]; largest speed over frequency and diameter
_STROKE = 2.8  # [m]; of the flapping ellipse, from end to end, in chords
_FREQUENCY = 0.25  # [Hz]
_SWING = np.pi / 4  # [rad]


def _in_line(effort: RunEffort, progress: Progress) -> Curves:
    """Compute a cylinder that moves with ``-U cos(2 pi t / T)``; diameter and period are 1."""
    speed = _KEULEGAN
    motion = flow.Oscillation(frequency=1.0, heave=(-speed / (2 * np.pi), 0.0))
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid.covering((-5.0, 5.0), (-4.0, 4.0), cell=1 / effort.cells), viscosity=speed / 100.0,
            bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion),), coarse=True,
            courant=LONG_STEP,
        )
    )  # fmt: skip
    late = march(sim, effort.until, progress).select_after(effort.until - 1.0)
    return {"force": np.stack([middles(late) % 1.0, late.force()[:, 0] / speed**2])}


_SWINGS = 10.0  # [-]; number of Keulegan and Carpenter at Re 200, and the period in [s]
_READ = 4  # cycles at Re 200 at the end that are read
_GUSTS = (0.0, 2.5)
"""Times at which the gusts of the ensemble begin, at two phases of the motion [s]."""
_GUST, _LASTING = 0.1, 2.0  # [m/s], [s]; of a gust
_PHASES = 250  # of a cycle, at which it is kept


def gust(time: float, begin: float) -> tuple[float, float]:
    """Return the far stream of a small gust across the motion, gone without a kink after two seconds [m/s]."""
    share = (time - begin) / _LASTING
    return 0.0, float(_GUST * np.sin(np.pi * share) ** 2) if 0 < share < 1 else 0.0


def _two_states(effort: RunEffort, progress: Progress) -> Curves:
    """Compute a cylinder that moves with ``-cos(2 pi t / T)``, KC 10, once for each gust.

    ``effort.before`` cycles form the wake on the coarse grid, ``effort.until`` follow on the finer one, of which the
    last are read. A gust to the other side gives the mirror image, whose force across has the other sign: each run is
    two members.
    """
    first, whole = round(effort.initial_duration), round(effort.until)
    half = 0.5 / len(_GUSTS)

    def form() -> list[flow.Simulation]:
        wakes = []
        for k, begin in enumerate(_GUSTS):
            wakes.append(flow.Simulation(replace(_swinging(effort.coarse), stream=partial(gust, begin=begin))))
            march(wakes[-1], first * _SWINGS, staged(progress, f"gust {k + 1}, coarse grid", k * half, (k + 1) * half))
        return wakes

    curves: dict[str, np.ndarray] = {}
    phase = np.linspace(0.0, 1.0, _PHASES)
    for k, wake in enumerate(formed(("two states", effort.coarse, first), form)):
        part = staged(progress, f"gust {k + 1}, fine grid", 0.5 + k * half, 0.5 + (k + 1) * half)
        record = march(refined(wake, _swinging(effort.cells)), whole * _SWINGS, part)
        turns, (along, across) = middles(record) / _SWINGS, record.force().T
        for cycle in range(max(whole - _READ, 0), whole):
            for sign in (1, -1):
                number = 1 + len(curves) // 2
                curves[f"force along {number}"] = np.stack([phase, np.interp(cycle + phase, turns, along)])
                curves[f"force across {number}"] = np.stack([phase, sign * np.interp(cycle + phase, turns, across)])
    return curves


def _swinging(cells: int) -> flow.Setup:
    motion = flow.Oscillation(frequency=1 / _SWINGS, heave=(-_SWINGS / (2 * np.pi), 0.0))
    return flow.Setup(
        grid=flow.Grid.covering((-6.0, 6.0), (-6.0, 6.0), cell=1 / cells), viscosity=1 / 200, coarse=True,
        courant=LONG_STEP, bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion),),
    )  # fmt: skip


def flapping(time: float) -> flow.Pose:
    """Return the pose of an ellipse that flaps along x: ``A/2 cos(2 pi f t)``, upright at both ends of the stroke."""
    turn = 2 * np.pi * _FREQUENCY * time
    rate = 2 * np.pi * _FREQUENCY
    return flow.Pose(
        position=(_STROKE / 2 * np.cos(turn), 0.0), angle=np.pi / 2 + _SWING * np.sin(turn),
        velocity=(-rate * _STROKE / 2 * np.sin(turn), 0.0), spin=rate * _SWING * np.cos(turn),
    )  # fmt: skip


def quasi_steady_peaks() -> tuple[float, float]:
    """Return the largest quasi-steady drag and lift of the flapping ellipse, which its sources divide by [N/m].

    ``1/2 u^2 (1.4 - cos 2a)`` and ``1/2 u^2 1.2 sin 2a`` over a period, with the angle of attack ``a`` and the speed
    ``u`` of the ellipse's middle: the coefficients were measured on wings that move along without turning.
    Source: Wang, Birch and Dickinson 2004, J. Exp. Biol. 207, 449-460, whose motion and measure this is.
    """
    poses = [flapping(float(time)) for time in np.linspace(0.0, 1 / _FREQUENCY, 2001)]
    speed, angle = np.array([pose.velocity[0] for pose in poses]), np.array([pose.angle for pose in poses])
    attack = np.where(speed <= 0, np.pi - angle, angle)
    drag, lift = 0.5 * speed**2 * (1.4 - np.cos(2 * attack)), 0.5 * speed**2 * 1.2 * np.sin(2 * attack)
    return float(drag.max()), float(lift.max())


def _flapping(effort: RunEffort, progress: Progress) -> Curves:
    speed = np.pi * _FREQUENCY * _STROKE
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid.covering((-3.5, 3.5), (-6.5, 2.5), cell=1 / effort.cells), viscosity=speed / 75.0,
            bodies=(flow.Body(shape=flow.Ellipse(length=1.0, width=0.1), motion=flapping),), coarse=True,
            courant=LONG_STEP,
        )
    )  # fmt: skip
    record = march(sim, effort.until, progress)
    time, (along, across) = middles(record), record.force().T
    drag, lift = quasi_steady_peaks()
    against = np.sign(np.sin(2 * np.pi * _FREQUENCY * time))  # the motion begins towards -x: drag is then along x
    strokes = time * _FREQUENCY
    return {"drag": np.stack([strokes, against * along / drag]), "lift": np.stack([strokes, across / lift])}


CASES = (
    Case(
        name="in_line", run=_in_line, code=_CODE,
        grids=grids((48, 32, 24), 5.0), quick_effort=RunEffort(cells=12, until=1.0),
        setup="A cylinder that oscillates in water at rest, Re 100, KC 5; unbounded domain, of which 10 x 8 diameters "
        "are computed; {cells} cells a diameter; the last of five periods.",
    ),
    Case(
        name="two_states", run=_two_states, code=_CODE, grids=grids((32, 24, 16), 5.0, coarse=12, before=6.0),
        quick_effort=RunEffort(cells=12, until=1.0, coarse=8, initial_duration=1.0),
        setup="A cylinder that oscillates in water at rest, Re 200, KC 10; unbounded domain, of which 12 x 12 "
        "diameters are computed. Six periods from rest with {coarse} cells a diameter and five with {cells}, the last "
        "four of which are read, of runs with a small gust across the motion (a tenth of its speed) at two phases of "
        "the first and, by symmetry, with gusts to the other side.",
    ),
    Case(
        name="flapping", run=_flapping, grids=grids((48, 32, 24), 16.0), quick_effort=RunEffort(cells=32, until=4.0),
        code=_CODE,
        setup="An ellipse 10:1 that flaps in water at rest with a stroke of 2.8 chords and a swing of 45 degrees, Re "
        "75; unbounded domain, of which 7 x 9 chords are computed, most of them below; {cells} cells a chord; four "
        "periods from rest.",
    ),
)  # fmt: skip
"""The flows of this module."""
