"""An aerofoil that pitches up in a stream: chord, speed and density are 1."""

import numpy as np

from evidence.atlas.case import Case, Curves, RunEffort, grids
from evidence.atlas.marching import march, middles
from suchus import flow
from suchus.core.progress import Progress

_CODE = ("aerofoil.py", "marching.py")
_PIVOT = 0.25  # [m]; place of the axis behind the nose
_RATE = 0.6  # [rad/s]; to which the rate of pitch rises
_RISE = 4.6  # [1/s]; so that it has 99 % of it after one chord of travel
_BEFORE = 2.0  # [s] of the stream before, in which the layers at rest of the source's start form
_FINER = 8
"""Times as many cells around the aerofoil as in the domain: the layer at Re 10 000 is a hundredth of a chord thick."""


def pitching(time: float) -> flow.Pose:
    """Return the pose of the aerofoil: nose up about its quarter chord from a time of ``_BEFORE`` on."""
    since = max(time - _BEFORE, 0.0)
    angle = -_RATE * (since + (np.exp(-_RISE * since) - 1) / _RISE)
    spin = -_RATE * (1 - np.exp(-_RISE * since))
    along, up = _PIVOT * float(np.cos(angle)), _PIVOT * float(np.sin(angle))
    return flow.Pose(
        position=(-along, -up), angle=float(angle), velocity=(float(spin) * up, -float(spin) * along), spin=float(spin)
    )


def _pitching(effort: RunEffort, progress: Progress) -> Curves:
    whole = flow.Grid.covering((-3.0, 5.0), (-3.0, 3.0), cell=_FINER / effort.cells)
    body = flow.Body(shape=flow.foil(1.0, thickness=0.15), motion=pitching)
    sim = flow.Simulation(
        flow.Setup(
            grid=whole.patch((-0.7, 1.4), (-1.0, 0.6), ratio=_FINER),
            coarse_grid=whole,
            viscosity=1e-4,
            stream=(1.0, 0.0),
            bodies=(body,),
            coarse=True,
        )
    )
    record = march(sim, effort.until, progress).select_after(min(_BEFORE, 0.5 * effort.until))
    angles = np.degrees([-pitching(float(time)).angle for time in middles(record)])
    drag, lift = 2 * record.force().T
    return {"drag": np.stack([angles, drag]), "lift": np.stack([angles, lift])}


CASES = (
    Case(
        name="pitching", run=_pitching, code=_CODE, grids=grids((192, 128, 96), _BEFORE + 1.85),
        quick_effort=RunEffort(cells=64, until=0.1),
        setup="A NACA 0015 aerofoil at Re 10 000 that pitches about its quarter chord, after two chords of travel at "
        "rest; unbounded domain, of which 8 x 6 chords are computed; {cells} cells a chord in a patch of 2.1 x 1.6 "
        "chords around it, an eighth of them elsewhere.",
    ),
)  # fmt: skip
"""The flows of this module."""
