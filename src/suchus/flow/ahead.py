"""First compilation of the kernels in two processes at once: the pressure solver in one, all others in the other.

numba compiles in one thread. On a new machine this is most of the time before the first picture. The pressure solver
takes half of it.
"""

import subprocess
import sys
from contextlib import suppress

import numba
import numpy as np

from suchus.core import threads
from suchus.flow import compiled, poisson
from suchus.flow.body import Body
from suchus.flow.grid import Grid
from suchus.flow.pose import Pose
from suchus.flow.sides import Sides
from suchus.flow.solid import Cylinder, Sphere
from suchus.flow.water import Fluid

_CELLS = 32
"""Cells of the small domain along each axis [-]."""
_LIMITS = 1e-5, 1e-4  # divergence that a pressure solve may leave [m/s per cell]


class _NoPressureWater(Fluid):
    """Water without a pressure solve."""

    def _solve(self, limits: tuple[float, float]) -> tuple[poisson.Solve, tuple[float, float]]:
        return poisson.Solve(1, *limits), (self.dtype(0), self.dtype(0))


class _PressureWater(Fluid):
    """Water whose pressure solve can be called by itself."""

    def solve(self) -> poisson.Solve:
        """Solve for the pressure of water at rest."""
        return self._solve(_LIMITS)[0]


def precompile(ndim: int, dtype: type) -> None:
    """Compile the kernels of a flow with a body if no flow of this kind has run with these sources on this machine.

    Nothing is compiled here if only one thread may be used, if the cache folder cannot be written to, or if another
    process has started to compile. The flow then compiles its kernels itself.

    Args:
        ndim: number of axes of the grid, 2 or 3.
        dtype: type of the fields.
    """
    folder = compiled.FOLDER
    if folder is None or numba.config.DISABLE_JIT or threads.count() == 1:
        return
    try:
        (folder / f"begun-{ndim}-{dtype.__name__}").touch(exist_ok=False)
    except OSError:  # most often the file exists: another process compiles
        return
    function = compile_solver.__name__
    script = f"from {__name__} import {function}; {function}({ndim}, '{dtype.__name__}')"
    command = [sys.executable, "-c", script]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as solver_process:
        try:
            _step(_NoPressureWater(*_domain(ndim), dtype))
            solver_process.wait()
        finally:
            with suppress(OSError):
                solver_process.kill()


def compile_solver(ndim: int, name: str) -> None:
    """Compile the pressure solver.

    Args:
        ndim: axes of the grid, 2 or 3.
        name: name of the fields' type, ``float32`` or ``float64``.
    """
    water = _PressureWater(*_domain(ndim), getattr(np, name))
    _place_body(water)
    water.solve()


def _domain(ndim: int) -> tuple[Grid, Sides, float]:
    return Grid.covering(*[(-2.0, 2.0)] * ndim, cell=4.0 / _CELLS), Sides(), 0.05


def _place_body(water: Fluid) -> None:
    shape = Cylinder(diameter=1.0) if water.ndim == 2 else Sphere(diameter=1.0)
    water.place([Body(shape=shape)], [Pose().in_dimensions(water.ndim)], 0.0)


def _step(water: Fluid) -> None:
    """Take one step of a small flow, which compiles every kernel of a step."""
    zero_velocity = (0.0,) * water.ndim
    _place_body(water)
    water.step(0.01, zero_velocity, zero_velocity, _LIMITS)
    water.fastest()
    water.contents()
