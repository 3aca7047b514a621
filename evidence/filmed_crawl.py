"""Films of the robot's crawl, and the gait that is read back from them, for the page on capture."""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from suchus.animals.capture import Camera, driven_fraction, film, observe, to_gait
from suchus.robot.design import LEGS
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait, limb_reaches
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl

NAME = "filmed_crawl"
ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]
FILMS, CYCLES = 60, 2
CAMERA = Camera(rate=50.0, noise=0.002, lost=0.05, heading=0.0, scale=None, heights=False, seed=0)
"""The camera; each film has a heading, a scale and a seed of its own."""
LOADED = 0.5
"""Vertical force from which on a foot bears load [N]."""


def near(phase: float, reference: float) -> float:
    """Return a phase as the one of its values that is next to a reference [cycle]."""
    return reference + (phase - reference + 0.5) % 1.0 - 0.5


def half_stroke(gait: Gait) -> float:
    """Return the mean half stroke of the feet of all girdles [m]."""
    return float(np.mean([reach * limb.stroke for limb, reach in zip(gait.limbs, limb_reaches(ROBOT), strict=True)]))


def commanded() -> dict[str, float]:
    """Return what the gait commands, by the names of ``reading``."""
    phases = dict(zip((f"phase_{leg}" for leg in LEGS), GAIT.limb_phases, strict=True))
    numbers = {name: float(GAIT.number(name)) for name in ("axis_lag", "tail_lag", "trunk_bend", "tail_bend")}
    return {**phases, **numbers, "half_stroke": half_stroke(GAIT), "going_back": GAIT.duty_factor}


def reading(record: xr.Dataset, seed: int) -> dict[str, float]:
    """Return what is read of one film: the numbers of the gait, and the duty factors of front and hind feet.

    Args:
        record: of the crawl.
        seed: of the camera's heading, scale and noise.
    """
    random = np.random.default_rng(seed)
    heading, scale = float(random.uniform(-3.0, 3.0)), float(random.uniform(200.0, 2000.0))
    camera = replace(CAMERA, heading=heading, scale=scale, seed=seed)
    walk = observe(film(ROBOT, record, camera), tail_share=driven_fraction(ROBOT))
    gait, target = to_gait(walk, ROBOT, GAIT, name="filmed").gait, commanded()
    phases = dict(zip((f"phase_{leg}" for leg in LEGS), gait.limb_phases, strict=True))
    phases |= {name: float(gait.number(name)) for name in ("axis_lag", "tail_lag")}
    return {
        **{name: near(phase, target[name]) for name, phase in phases.items()},
        "trunk_bend": float(gait.number("trunk_bend")),
        "tail_bend": float(gait.number("tail_bend")),
        "half_stroke": half_stroke(gait),
        "going_back": float(gait.duty_factor),
        "duty_front": float(np.mean([walk.value(f"duty_{leg}") for leg in LEGS[:2]])),
        "duty_hind": float(np.mean([walk.value(f"duty_{leg}") for leg in LEGS[2:]])),
    }


def simulated(record: xr.Dataset) -> dict[str, float]:
    """Return what the joints and the feet of the crawl did, by the names of ``reading``."""
    part = record.sel(time=slice(START, START + CYCLES * GAIT.period - 1e-6))
    wave = np.exp(-2j * np.pi * (part.time.values - START) / GAIT.period)
    trunk = -sum(part.joint_angle.sel(joint=f"spine_yaw_{i}") for i in (1, 2, 3)).values
    tail = sum(part.joint_angle.sel(joint=f"tail_yaw_{i}") for i in range(1, 7)).values
    trunk_wave, tail_wave = (complex(2.0 * np.mean((bend - bend.mean()) * wave)) for bend in (trunk, tail))
    lag = float(np.angle(trunk_wave / tail_wave)) / (2.0 * np.pi)
    load = (part.foot_force.sel(xyz="z") > LOADED).mean("time").values
    return {
        "trunk_bend": abs(trunk_wave),
        "tail_bend": abs(tail_wave),
        "tail_lag": near(lag, GAIT.number("tail_lag")),
        "duty_front": float(load[:2].mean()),
        "duty_hind": float(load[2:].mean()),
    }


def filmed() -> xr.Dataset:
    """Return the record of the crawl that is filmed."""
    return crawl(ROBOT, GAIT, duration=START + CYCLES * GAIT.period)


def measured(films: int = FILMS) -> dict[str, Any]:
    """Return what is commanded, what is simulated, and mean and standard deviation of what is read of the films."""
    record = filmed()
    readings = [reading(record, seed) for seed in range(films)]
    columns = {name: [row[name] for row in readings] for name in readings[0]}
    return {
        "commanded": commanded(),
        "simulated": simulated(record),
        "mean": {name: float(np.mean(values)) for name, values in columns.items()},
        "std": {name: float(np.std(values)) for name, values in columns.items()},
    }
