"""A second opinion on the started cylinder: vorticity and stream function in polar coordinates, no immersion at all.

``python tests/flow/polar.py 40`` writes ``tests/data/flow/polar_cd_re40.csv``. Lengths in radii, speeds in that of the
stream, so that time is t* = t U / R and the viscosity 2 / Re. With r = exp(xi) and sine modes n in the angle,

    e^(2 xi) d(omega)/dt = nu lap(omega) - J,    lap(psi) = -e^(2 xi) omega,

central differences on a grid that is fine at the wall, diffusion implicit, convection explicit (pseudo-spectral). The
vorticity at the wall follows from no slip: ``integral of e^((2 - n) xi) omega_n dxi`` is -2 for n = 1, else 0 (Dennis
and Quartapelle 1989, J. Comput. Phys. 61, 218-241; Collins and Dennis 1973, J. Fluid Mech. 60, 105-127). The start is
the layer of Rayleigh at ``START``. For small times the drag approaches that of Bar-Lev and Yang 1975 (J. Fluid
Mech. 72, 625-647).
"""

import sys
from pathlib import Path

import numpy as np
from scipy.linalg import solve_banded

START = 2e-3
"""Time of the first field [R / U]."""

IMPLICIT = 0.55
"""Weight of the new time in the diffusion [-]."""


def graded(count, end, stretch=4.0):
    """Return ``count + 1`` rising points from 0 to ``end``, and the weights of the second difference at each."""
    xi = end * np.expm1(stretch * np.linspace(0, 1, count + 1)) / np.expm1(stretch)
    h = np.diff(xi)
    low, high = np.zeros(count + 1), np.zeros(count + 1)
    low[1:-1], high[1:-1] = 2 / (h[:-1] * (h[:-1] + h[1:])), 2 / (h[1:] * (h[:-1] + h[1:]))
    return xi, low, high


def slope(f, h):
    """Return the derivative along the first axis, zero at both ends, where it is not needed."""
    out, left, right = np.zeros_like(f), h[:-1, None], h[1:, None]
    out[1:-1] = f[2:] * left / right - f[:-2] * right / left + f[1:-1] * (right / left - left / right)
    out[1:-1] /= left + right
    return out


def banded(low, middle, high, first, last):
    """Return a tridiagonal matrix as ``solve_banded`` wants it; ``first`` and ``last`` rows are given."""
    ab = np.zeros((3, middle.size))
    ab[0, 1:], ab[1], ab[2, :-1] = high[:-1], middle, low[1:]
    ab[1, 0], ab[0, 1], ab[2, -2], ab[1, -1] = first, 0, *last
    return ab


def drag(reynolds, until, *, points=200, modes=48, end=3.2, steps=(1e-4, 5e-4, 2e-3)):
    """Return times, drag coefficients, and the part of friction in them, of a cylinder that is started at once."""
    nu, n = 2 / reynolds, np.arange(1, modes + 1)
    xi, low, high = graded(points, end)
    h, square = np.diff(xi), np.exp(2 * xi)
    weight = 0.5 * (np.append(h, 0) + np.insert(h, 0, 0))
    moment, wanted = np.exp(np.outer(xi, 2 - n)) * weight[:, None], np.where(n == 1, -2.0, 0.0)
    angle = np.pi * (np.arange(4 * modes) + 0.5) / (4 * modes)
    sine, cosine = np.sin(np.outer(n, angle)), np.cos(np.outer(n, angle))
    far = np.where(n == 1, 2 * np.exp((xi[-1] + xi[-2]) / 2), 0.0)
    poisson = [
        banded(low, -(low + high) - m**2, high, 1, (m / 2 - 1 / h[-1], m / 2 + 1 / h[-1])) for m in n
    ]  # fmt: skip
    wall = np.eye(1, points + 1)[0]

    def convection(omega):
        right = -square[:, None] * omega
        right[0], right[-1] = 0, far
        psi = np.stack([solve_banded((1, 1), poisson[k], right[:, k]) for k in range(modes)], axis=1)
        jacobian = ((psi * n) @ cosine) * (slope(omega, h) @ sine) - (slope(psi, h) @ sine) * ((omega * n) @ cosine)
        return -jacobian @ sine.T / (2 * modes)

    omega = np.zeros((points + 1, modes))
    omega[:, 0] = np.exp(-(xi**2) / (4 * nu * START))
    omega[:, 0] *= wanted[0] / (moment[:, 0] @ omega[:, 0])
    time, before, matrices, step = START, None, [], 0.0
    out = []
    while time < until:
        dt = steps[0] if time < 0.02 else steps[1] if time < 0.2 else steps[2]
        if dt != step:
            part = -IMPLICIT * nu
            matrices = [
                banded(part * low, square / dt + part * (-(low + high) - m**2), part * high, 1, (0, 1)) for m in n
            ]
            answers = [solve_banded((1, 1), a, wall) for a in matrices]
            before, step = None, dt
        now = convection(omega)
        push = now if before is None else 1.5 * now - 0.5 * before
        lap = -(low + high)[:, None] * omega - omega * n**2
        lap[1:-1] += low[1:-1, None] * omega[:-2] + high[1:-1, None] * omega[2:]
        right = square[:, None] * omega / dt + (1 - IMPLICIT) * nu * lap + push
        right[0] = right[-1] = 0
        for k in range(modes):
            rest = solve_banded((1, 1), matrices[k], right[:, k])
            omega[:, k] = rest + (wanted[k] - moment[:, k] @ rest) / (moment[:, k] @ answers[k]) * answers[k]
        time, before = time + dt, now
        a, b, f = h[0], h[1], omega[:, 0]
        rise = -(2 * a + b) / (a * (a + b)) * f[0] + (a + b) / (a * b) * f[1] - a / (b * (a + b)) * f[2]
        out.append((time, 2 * np.pi / reynolds * (rise - f[0]), -2 * np.pi / reynolds * f[0]))
    return np.array(out).T


def main():
    reynolds = int(sys.argv[1])
    time, cd, friction = drag(reynolds, 5.2, points=240 if reynolds > 100 else 200, modes=48 if reynolds > 100 else 20)
    path = Path(__file__).resolve().parents[1] / "data" / "flow" / f"polar_cd_re{reynolds}.csv"
    at = np.concatenate([np.arange(0.1, 1.0, 0.05), np.arange(1.0, 5.15, 0.1)])
    cd, friction = (np.interp(at, time, values) for values in (cd, friction))
    lines = [
        f"# Drag coefficient of an impulsively started cylinder, and the part of friction in it, Re = {reynolds}.",
        "# Written by tests/flow/polar.py: vorticity and stream function in polar coordinates.",
        "# t* = t U / R (radius), Cd = F / (rho U^2 R).",
        "t_star,cd,friction",
        *(f"{t:.2f},{c:.5f},{f:.5f}" for t, c, f in zip(at, cd, friction, strict=True)),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
