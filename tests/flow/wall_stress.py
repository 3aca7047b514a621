"""A study, not a part of the package: a layer that no grid carries, by its law as far as it stays attached.

At the robot's own Reynolds number the layer is a fraction of a cell thin. The immersed wall of the solver then makes a
layer of its own, a cell thick, whatever the viscosity. Here the wall that is handed to the immersion slips: along the
skin it moves as fast as makes the water between it and ``GAP`` cells off it lack the momentum that the law's layer
lacks, so that by von Karman's balance the water feels the law's stress; and across itself as the water outside moves
on towards it. The law is that of ``evidence.friction``, Blasius's plate with the length of Thwaites: quasi-steady,
from each place where the water divides, as the speed ``GAP`` cells off the skin says. From where Thwaites's laminar
layer separates (and, of a body with edges, from the edge on), and wherever the water runs against the run that began
ahead, the wall does not slip at all: there the layer leaves the skin. Where the grid carries the layer, no wall slips.

What counts as success, laid down before any of it was run, for a cylinder in a patch of fine cells:

1. towed: mean drag within 10 % of 1.15 at Reynolds number 1e4 and of 1.20 at 1e5;
2. oscillated, Keulegan number 10, beta 1035: drag coefficient within 10 % of 2.0;
3. in each of them, less change from the coarser to the finer of two grids than the plain solver has.

All three in space, on a slice 3.3 diameters wide, since a wake in the plane is another; the plane stands beside it.
Published: 1.09 to 1.21 at 1e4 and 1.20 to 1.21 at 1e5 (fit of Cheng 2013, J. Hydraul. Eng. 139, 782-785, and the curve
of DNV-RP-C205); 2.0 by Sarpkaya 1976 (OTC 2533), read from memory of his figure.

As a script it runs one case, here to the time 50 and read from 20 on:
``python tests/flow/wall_stress.py towed 1e4 32 law plane out/validation/wall_stress 50 20``.
``test_validate_wall_stress`` keeps what runs have left there.
"""

import json
import sys
import time as clock
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import numba
import numpy as np

from suchus import flow
from suchus.core.writing import keep
from suchus.flow import body as bodies_of
from suchus.flow import simulation
from suchus.flow.compiled import PAD
from suchus.flow.force import interpolate, padded, steps_of
from suchus.flow.immerse import fill_source
from suchus.flow.nest import Nested
from suchus.flow.shape import Field, Shape
from suchus.flow.water import Fluid

GAP = 2.0
"""Distance from the skin at which the water outside the layer is read, beyond kernel and offset of the wall [cells]."""

SEPARATES = -0.09
"""Thwaites's parameter, momentum thickness squared times the rate of the speed over the viscosity, at which a laminar
layer separates [-]."""

SMOOTHED = 2
"""Times that the speeds along the skin, a cell apart, are averaged with their neighbours by 1, 2, 1 [-]."""


@numba.njit
def _march(speed, begin, step, spacing, viscosity, gap, share, stress):
    """Follow a layer from where the water divides, in one direction, until it separates or the water turns."""
    n, total, last = speed.size, 0.0, 0.0
    first, other = step * speed[begin % n], step * speed[(begin - step) % n]
    way = spacing * first / (first - other)  # from where the water divides
    for k in range(n):
        i = (begin + step * k) % n
        fast = step * speed[i]
        if fast <= 0.0:
            return
        power = fast**5
        total = power * way / 6.0 if k == 0 else total + 0.5 * spacing * (last + power)
        last = power
        plate = total / power
        rate = (step * speed[(i + step) % n] - step * speed[(i - step) % n]) / (2.0 * spacing)
        if 0.441 * plate * rate / fast < SEPARATES:
            return
        lost = 0.664 * np.sqrt(viscosity * plate / fast) / gap
        slowed = 0.75 * (1.0 - np.sqrt(1.0 - 16.0 * lost / 3.0)) if lost < 1.0 / 6.0 else 1.0
        share[i] = 1.0 - slowed
        stress[i] = step * 0.332 * fast**2 / np.sqrt(fast * plate / viscosity)


@numba.njit
def layers(speeds, spacing, viscosity, gap):
    """Return which share of the speed beside it the wall moves with, and the law's stress over the density.

    Args:
        speeds: of the water along the skin, counter-clockwise around it, shape (ring, point) [m/s].
        spacing: of the points [m].
        viscosity: kinematic [m^2/s].
        gap: how far off the skin the speeds are [m].

    Returns:
        Both of the shape of ``speeds``, 0 where no layer is attached [-, m^2/s^2].
    """
    share, stress = np.zeros_like(speeds), np.zeros_like(speeds)
    n = speeds.shape[1]
    for ring in range(speeds.shape[0]):
        speed = speeds[ring]
        for i in range(n):
            if speed[i] <= 0.0 < speed[(i + 1) % n]:
                _march(speed, i + 1, 1, spacing, viscosity, gap, share[ring], stress[ring])
                _march(speed, i - (speed[i] == 0.0), -1, spacing, viscosity, gap, share[ring], stress[ring])
    return share, stress


class Layered:
    """What comes before ``Fluid`` or ``Nested``: the wall of a round cylinder that slips as its layer says."""

    _bare = _around = None

    def place(self, bodies, poses, time):
        if self._bare is not None and self._bare.shape == self.b.shape:
            self.b = self._bare  # the body's own, for the work of the step
        super().place(bodies, poses, time)
        self._bare, h = self.b.copy(), self.grid.cell
        ((body,), (pose,)) = bodies, poses
        self.radius, self.centre = 0.5 * body.shape.diameter, np.array(pose.position[:2])
        self.along = np.array(pose.velocity[:2])
        count = round(2 * np.pi * self.radius / h)
        self.angles, self.spacing = 2 * np.pi * np.arange(count) / count, 2 * np.pi * self.radius / count
        ends, self._around = [(s.start, s.stop) for s in reversed(self.window_slices)], []
        for c in range(self.ndim):
            points = [(self.grid.faces if c == d else self.grid.centres)(*ends[d], d) for d in (0, 1)]
            x, y = np.meshgrid(points[0] - self.centre[0], points[1] - self.centre[1])
            r = np.maximum(np.hypot(x, y), 1e-9)
            at = np.arctan2(y, x) % (2 * np.pi) / (2 * np.pi) * count
            low = np.floor(at).astype(int)
            off = np.clip((r - self.radius) / (GAP * h), -1.0, 1.0)
            self._around.append((low % count, (low + 1) % count, at - low, off, x / r, y / r))

    def _beside(self):
        """Return the water's velocity against the body, ``GAP`` cells off it, shape (axis, ring, point) [m/s]."""
        out = self.radius + GAP * self.grid.cell
        ring = self.centre[:, None] + out * np.stack([np.cos(self.angles), np.sin(self.angles)])
        if self.ndim == 3:
            first, end = self.window_slices[0].start, self.window_slices[0].stop
            high = self.grid.centres(first, end, 2)
            ring = np.concatenate([np.tile(ring, high.size), np.repeat(high, ring.shape[1])[None]])
        found, steps, places = np.empty((self.ndim, ring.shape[1])), steps_of(self.p), padded(ring, self.grid)
        for c, component in enumerate(self.velocity):
            shifted = places.copy()
            shifted[c] += 0.5
            interpolate(component.reshape(-1), steps, shifted, found[c])
        found = found.reshape(self.ndim, -1, self.angles.size)
        for _ in range(SMOOTHED):
            found = 0.5 * found + 0.25 * (np.roll(found, 1, axis=2) + np.roll(found, -1, axis=2))
        found[:2] -= self.along[:, None, None]
        return found

    def step(self, dt, stream, push, limits, time=0.0):
        cos, sin = np.cos(self.angles), np.sin(self.angles)
        beside = self._beside()
        turning, outward = beside[1] * cos - beside[0] * sin, beside[0] * cos + beside[1] * sin
        h = self.grid.cell
        share, self.stress = layers(turning, self.spacing, float(self.nu) * h, GAP * h)
        self.slip = share * turning
        gone = [self.slip, share * outward, share * beside[2] if self.ndim == 3 else None]
        self.b = self._bare.copy()
        for c, (low, high, part, off, x, y) in enumerate(self._around):
            slip, across, up = (None if g is None else g[:, low] + part * (g[:, high] - g[:, low]) for g in gone)
            more = (across * off * x - slip * y, across * off * y + slip * x, up)[c]
            self.b[c] += more if self.ndim == 3 else more[0]
        self._fill_source()
        super().step(dt, stream, push, limits, time)

    def _fill_source(self):
        source, b, mu0 = (self._flat(a) for a in (self.source, self.b, self.mu0))
        fill_source(source, b, mu0, self._layout[0], self._near_layout, self.inner)


class LayeredFluid(Layered, Fluid):
    """The water around a cylinder on one grid."""


class LayeredNested(Layered, Nested):
    """The water around a cylinder on a patch; the coarser water knows of bodies only where no pressure acts."""

    def _fill_source(self):
        """Tell the coarser pressure too what the fine cells in the body spread, as they will come to it."""
        super()._fill_source()
        ratio, coarse = self.ratio, self.coarse
        fine = np.zeros(self.p.shape)
        fine[self.window_slices] = self.source
        inner = fine[(slice(PAD, -PAD),) * self.ndim]
        split = [part for n in inner.shape for part in (n // ratio, ratio)]
        net = np.zeros(coarse.p.shape)
        net[self._cells] = inner.reshape(split).sum(axis=tuple(range(1, 2 * self.ndim, 2))) / ratio ** (self.ndim - 1)
        coarse.source[:] = net[coarse.window_slices]


class Column(Shape):
    """A round cylinder along z that goes on beyond the domain; two mirrors cut it."""

    ndim = 3

    def __init__(self, *, diameter):
        self.diameter = diameter

    def measure(self, points, time, pose, reach):
        x, y, z = points
        away_y, away_x = np.meshgrid(y - pose.position[1], x - pose.position[0], indexing="ij")
        r = np.maximum(np.hypot(away_x, away_y), 1e-9)
        shape = (z.size, *r.shape)

        def everywhere(plane):
            return np.broadcast_to(plane, shape).copy()

        distance, nx, ny = map(everywhere, (r - 0.5 * self.diameter, away_x / r, away_y / r))
        velocity = tuple(np.full(shape, part) for part in (*pose.velocity, 0.0)[:3])
        return Field(distance, (nx, ny, np.zeros(shape)), velocity, np.full(shape, np.inf))

    def markers(self, time, pose, spacing):
        count = max(8, round(np.pi * self.diameter / spacing))
        turn = 2 * np.pi * (np.arange(count) + 0.5) / count
        normals = np.stack([np.cos(turn), np.sin(turn), np.zeros(count)])
        velocity = np.array((*pose.velocity, 0.0)[:3])[:, None] + np.zeros((3, count))
        return flow.markers.Markers(
            points=np.array((*pose.position, 0.0)[:3])[:, None] + 0.5 * self.diameter * normals,
            weight=np.full(count, np.pi * self.diameter / count), velocities=velocity, normals=normals,
            spins=np.zeros((3, count)),
        )  # fmt: skip

    def bounds(self, time, pose):
        (x, y), r = pose.position[:2], 0.5 * self.diameter
        return x - r, x + r, y - r, y + r, -1e6, 1e6

    def thickness(self, time):
        return np.zeros(1), np.full(1, self.diameter)

    def volume(self, time):
        return np.inf

    def mass(self, time):
        raise NotImplementedError


@contextmanager
def layered(wanted):
    """Let simulations that are made here take the wall with the law's layer, if it is wanted, and cut columns."""
    water = (LayeredFluid, LayeredNested) if wanted else (Fluid, Nested)
    with (
        patch.object(simulation, "Fluid", water[0]),
        patch.object(simulation, "Nested", water[1]),
        patch.object(bodies_of, "check_cut", lambda *_: None),
    ):
        yield


def front(stress, angles):
    """Return how far from the foremost point the layer that begins near it stays attached, over and under [deg].

    ``stress`` has shape (ring, point), ``angles`` go counter-clockwise from the lee; the mean over the rings.
    """
    found = []
    for way, sign in ((-1, -1), (1, 1)):
        ends = []
        for one in stress:
            near = np.flatnonzero((sign * one > 0) & (np.abs(angles - np.pi) < 0.5))
            i = int(near[np.abs(angles[near] - np.pi).argmin()]) if near.size else None
            while i is not None and sign * one[(i + way) % len(one)] > 0:
                i = (i + way) % len(one)
            ends.append(np.nan if i is None else np.degrees(way * (angles[i] - np.pi)))
        found.append(float(np.mean(ends)))
    return found


SPAN = 10 / 3
"""Width of the slice in space, between two mirrors [diameters]."""

IMAGES = 4
"""Times that a body counts in the record which two mirrors cut, with its images [-]."""

COARSE = {"plane": 16, "space": 6}
"""Cells of the whole domain, a diameter [-]; the patch has two or four times as fine ones."""


def cylinder(case, reynolds, cells, where):
    """Return the simulation of a cylinder of diameter 1 whose fastest speed is 1."""
    space, beta = where == "space", 1035.0
    coarse, across = COARSE[where], (-1.5, 1.5) if space else (-1.25, 1.25)
    if case == "towed":
        ends, patched = ((-4.0, 8.0), (-4.0, 4.0)), ((-1.5, 2.0) if space else (-1.0, 2.0), across)
        motion, more = flow.Pose(position=(0.013, 0.007)), {"stream": (1.0, 0.0)}
    else:
        keulegan = reynolds / beta
        ends, patched = ((-5.0, 5.0), (-4.0, 4.0)), ((-2.0, 2.0) if space else (-1.75, 1.75), across)
        motion = flow.Oscillation(frequency=1 / keulegan, heave=(-keulegan / (2 * np.pi), 0.0))
        more = {"follow": "body"}
    span = ((0.0, SPAN),) if space else ()
    sides = flow.Sides(low=flow.Mirror(), high=flow.Mirror()) if space else flow.Sides()
    whole = flow.Grid.covering(*ends, *span, cell=1 / coarse, sides=sides)
    ratio = cells // coarse
    grids = {"grid": whole} if ratio == 1 else {"grid": whole.patch(*patched, *span, ratio=ratio), "coarse_grid": whole}
    shape = Column(diameter=1.0) if space else flow.Cylinder(diameter=1.0)
    start = None
    if space:  # what makes the wake one in space is a ripple of a hundredth of the speed
        stream = more.get("stream", (0.0, 0.0))[0]

        def start(x, y, z):
            ripple = 0.01 * np.exp(-((x - 1.0) ** 2) - y**2) * np.cos(2 * np.pi * z / SPAN * 2)
            return stream + 0.0 * ripple, ripple, 0.0 * ripple

    return flow.Simulation(
        flow.Setup(
            viscosity=1 / reynolds, bodies=(flow.Body(shape=shape, motion=motion),), coarse=True, tolerance=1e-4,
            sides=sides, start=start, **grids, **more,
        ),
        thread_count=1,
    )  # fmt: skip


def read(case, reynolds, record, span, since):
    """Return what is compared: mean drag, rms lift and Strouhal number, or drag and inertia by Morison's equation."""
    late = record.select_after(since)
    time, force = late.time - late.step / 2, late.force() / span
    if case == "towed":
        drag, lift = 2 * force[:, 0], 2 * force[:, 1]
        mean = float(np.average(drag, weights=late.step))
        ups = flow.signals.rises(time, lift)
        strouhal = (len(ups) - 1) / (ups[-1] - ups[0]) if len(ups) > 2 else np.nan
        return {"drag": mean, "lift": float(np.sqrt(np.average(lift**2, weights=late.step))), "strouhal": strouhal}
    period = reynolds / 1035.0
    whole = time < since + period * np.floor((time[-1] - since) / period + 1e-6)
    drag, inertia = flow.morison(
        time[whole], force[whole, 0], frequency=1 / period, speed=1.0, diameter=1.0, density=1.0
    )
    return {"drag": drag, "inertia": inertia}


def run(case, reynolds, cells, law, where, folder, until, since, limit=np.inf):
    """Run a case, and write what came out so far every half a minute."""
    with layered(law == "law"):
        sim, began, told = cylinder(case, reynolds, cells, where), clock.monotonic(), clock.monotonic()
        name = f"{case}_{reynolds:.0f}_{cells}_{law}_{where}"
        folder.mkdir(parents=True, exist_ok=True)
        span, attached = (IMAGES * SPAN if where == "space" else 1.0), []

        def tell():
            told = {
                "name": name,
                "since": since,
                "time": sim.time,
                "steps": len(sim.record.time),
                "seconds": clock.monotonic() - began,
            }
            if sim.time > since + 1.0:
                told |= read(case, reynolds, sim.record, span, since)
            if attached:
                late = [one for time, *one in attached if time > since]
                told["left"] = np.mean(late, axis=0).tolist() if late else []
            keep(folder / f"{name}.json", json.dumps(told).encode())
            series = np.column_stack([sim.record.time, sim.record.force()[:, :2] / span])
            np.save(folder / f"{name}.npy", series.astype(np.float32))
            return told

        while sim.time < until and clock.monotonic() - began < limit:
            sim.advance()
            if law == "law" and case == "towed":
                stress, angles = sim.water.stress.mean(axis=0), sim.water.angles
                ends = front(sim.water.stress, angles)
                rub = float(2 * (stress * -np.sin(angles)).sum() * sim.water.spacing)
                attached.append((sim.time, *ends, rub))
            if clock.monotonic() - told > 30:
                told = clock.monotonic()
                print(tell(), flush=True)
        return tell()


PUBLISHED = {"towed_10000": 1.15, "towed_100000": 1.20, "oscillated_10350": 2.0}
"""Drag coefficients that are asked for, by case and Reynolds number; see the top [-]."""

ASKED, LEAST = 0.1, 15.0
"""Share by which they may be missed [-], and the time that a run is read over at least, diameters over speed [-]."""


def judged(runs):
    """Return what the runs say, in plane and space: how far off the drag of each case is and how cells change it.

    Args:
        runs: what ``run`` returned, by its name.

    Returns:
        Rows with ``off``, ``law`` and ``plain`` (change of the drag from the coarser to the finer cells over the
        former), None where no run is long enough, and ``word``: a case is "kept" or "missed", or "not judged" where
        what there is decides nothing; and ``word`` of all in space, "missed" as soon as one of them is.
    """

    def drag(case, cells, law, where):
        one = runs.get(f"{case}_{cells}_{law}_{where}", {})
        return one["drag"] if "drag" in one and one["time"] - one["since"] >= LEAST else None

    def changed(low, high):
        return None if low is None or high is None else high / low - 1

    rows = []
    for where, coarse in COARSE.items():
        grids = (coarse, 2 * coarse) if where == "plane" else (2 * coarse, 4 * coarse)
        for case, published in PUBLISHED.items():
            law, plain = ([drag(case, cells, one, where) for cells in grids] for one in ("law", "plain"))
            last = next((value for value in law[::-1] if value is not None), None)
            row = {"where": where, "case": case, "published": published, "cells": grids,
                   "drag_law": law, "drag_plain": plain, "off": None if last is None else last / published - 1,
                   "law": changed(*law), "plain": changed(*plain)}  # fmt: skip
            rows.append(row | {"word": _word(row)})
    words = {row["word"] for row in rows if row["where"] == "space"}
    return {"rows": rows, "word": next(word for word in ("missed", "not judged", "kept") if word in words)}


def _word(row):
    """Return the word of a row; finer cells that are missing could still mend what the coarser ones are off."""
    whole = None not in (row["law"], row["plain"])
    off = row["drag_law"][1] is not None and abs(row["off"]) > ASKED
    if off or (whole and abs(row["law"]) >= abs(row["plain"])):
        return "missed"
    return "kept" if whole else "not judged"


def gathered(runs):
    """Return what is kept of runs, by their names: these, what they say, and how the towed cylinder's layer ended.

    ``left``, in plane and space, has the cells a diameter of the finest run that is long enough [-], the angles over it
    and under it [deg], the law's friction and the drag [-].
    """
    left = {}
    for row in judged(runs)["rows"]:
        cells = [cells for cells, drag in zip(row["cells"], row["drag_law"], strict=True) if drag is not None]
        if row["case"] == "towed_10000" and cells:
            one = runs[f"towed_10000_{cells[-1]}_law_{row['where']}"]
            left[row["where"]] = [cells[-1], *one["left"], one["drag"]]
    return {"runs": dict(sorted(runs.items())), "left": left, **judged(runs)}


def left_in(folder):
    """Return what runs have left in a folder and those in it, by their names."""
    found = [json.loads(path.read_text()) for path in folder.rglob("*_*_*_*_*.json")]
    return {one.pop("name"): one for one in found}


if __name__ == "__main__":
    case, reynolds, cells, law, where, out, until, since, *rest = sys.argv[1:]
    print(run(case, float(reynolds), int(cells), law, where, Path(out), float(until), float(since), *map(float, rest)))
