"""Difference between the section model and the flow, for each link and joint, along the recorded motion.

The section model predicts forces for the recorded motion; there is no second run. Its force has a part by the
acceleration and a part by the speed. Two factors on these parts are fitted to some cycles and tested on the others.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float
from scipy.signal import savgol_filter

from suchus.core import rotation
from suchus.robot.design import Robot, with_values
from suchus.robot.design.water import Water
from suchus.sim.land import Lake
from suchus.sim.land.prescribed import SectionLoads, link_bodies, sections_along

DRAWS = 400
"""Draws of the bootstrap, blocks of half a cycle [-]."""
BLOCKS = 3
"""Blocks without which no interval is given [-]: the draws of fewer say nothing of how cycles differ."""
COVERAGE = 0.95
"""Share of the draws that lies in an interval [-]."""
_SMOOTHED, _ORDER = 9, 4
"""Samples and order of the polynomials by which places become rates and accelerations [-]."""


class RecordedMotion(NamedTuple):
    """Root and lateral joints along a record."""

    position: Float[np.ndarray, "sample coordinate"]
    """[m, rad]."""
    rate: Float[np.ndarray, "sample coordinate"]
    """[m/s, rad/s]."""
    push: Float[np.ndarray, "sample coordinate"]
    """[m/s2, rad/s2]."""


def motion_of(record: xr.Dataset, joints: Sequence[str]) -> RecordedMotion:
    """Return the motion in a record of one run, differentiated by local polynomials."""
    yaw = np.unwrap(rotation.yaw(record.orientation.values))
    bends = record.joint_angle.sel(joint=list(joints)).transpose("time", "joint").values
    place = np.column_stack([record.position.values[:, :2], yaw, bends])
    step = float(record.time[1] - record.time[0])
    rate, push = (savgol_filter(place, _SMOOTHED, _ORDER, deriv=order, delta=step, axis=0) for order in (1, 2))
    return RecordedMotion(place, rate, push)


def residual_table(
    robot: Robot, record: xr.Dataset, *, period: float, start_time: float, viscosity: float
) -> xr.Dataset:  # fmt: skip
    """Return the difference between the section model and the flow of a record.

    Args:
        robot: robot that swam.
        record: record of one run in a flow, see ``record.COUPLED``.
        period: period of a cycle [s].
        start_time: time from which samples count [s].
        viscosity: kinematic, of the flow's water [m2/s].

    Returns:
        Along ``part``, the links by the force across them and the joints by their moments: ``rms`` of the flow's and of
        the section model's, ``r2`` as the model is shipped, factors ``added`` and ``drag`` on its two parts that are
        fitted to the first half of the cycles, with their intervals, and ``r2_held_out`` of the fit in the second half.
    """
    parts = compare_sections(robot, record, start_time=start_time, viscosity=viscosity)
    halves = (
        parts.keep & (parts.time < 0.5 * (start_time + parts.time[-1])),
        parts.keep & (parts.time >= 0.5 * (start_time + parts.time[-1])),
    )
    rows = [
        _row(parts.flow[:, k], parts.added_mass[:, k], parts.drag[:, k], parts.keep, halves, period / parts.step)
        for k in range(len(parts.names))
    ]
    names = (
        "rms", "rms_sections", "r2", "added", "added_low", "added_high", "drag", "drag_low", "drag_high", "r2_fitted",
        "r2_held_out",
    )  # fmt: skip
    data = {f"residual_{name}": ("part", [row[k] for row in rows]) for k, name in enumerate(names)}
    kind = ["link"] * parts.links + ["joint"] * (len(parts.names) - parts.links)
    return xr.Dataset({**data, "part_kind": ("part", kind)}, coords={"part": parts.names})


class SectionComparison(NamedTuple):
    """Forces of a flow on links and joints along a record, and the two parts that the section model predicts."""

    names: list[str]
    """Links from the head on, then joints."""
    links: int
    """How many of them are links [-]."""
    time: Float[np.ndarray, " sample"]
    """[s]."""
    keep: Bool[np.ndarray, " sample"]
    """Whether each sample counts [-]."""
    flow: Float[np.ndarray, "sample part"]
    """Force of the flow across each link, moment at each joint [N, N m]."""
    added_mass: Float[np.ndarray, "sample part"]
    """The sections' part by the acceleration, with what is shed."""
    drag: Float[np.ndarray, "sample part"]
    """Their part by the speed."""
    joints: list[str]
    """Lateral joints [-]."""

    @property
    def step(self) -> float:
        """Interval between samples [s]."""
        return float(self.time[1] - self.time[0])


def compare_sections(robot: Robot, record: xr.Dataset, *, start_time: float, viscosity: float) -> SectionComparison:
    """Return the forces of the flow in a record and those of the section model; see ``residual_table``."""
    lateral = {hinge.name for hinge in robot.axis_hinges if hinge.turn == "yaw"}
    loaded_joints = [
        str(name) for name in record.joint.values if np.isfinite(record.joint_water_torque.sel(joint=name)).all()
    ]
    joints = [name for name in loaded_joints if name in lateral]
    record = _between_joints(robot, record, joints)
    motion = motion_of(record, joints)
    hull_free_robot = with_values(robot, {"hull": None})
    lake = Lake(level=0.0, water=replace(Water(), viscosity=viscosity))
    lake_without_added_mass = replace(lake, added_mass=0.0)
    section_loads, drag_loads = (
        _lateral_loads(sections_along(hull_free_robot, joints, *motion, variant), motion)
        for variant in (lake, lake_without_added_mass)
    )
    time = record.time.values
    keep = (time >= start_time) & (time <= time[-1] - _SMOOTHED * (time[1] - time[0]))
    names = [str(name) for name in record.link.values] + joints
    flow = _lateral_loads(_flow_loads(record, joints), motion)
    return SectionComparison(
        names, record.sizes["link"], time, keep, flow, section_loads - drag_loads, drag_loads, joints
    )


def _between_joints(robot: Robot, record: xr.Dataset, joints: Sequence[str]) -> xr.Dataset:
    """Return a record whose links lie between lateral joints; bodies between two joints are summed.

    Limbs are left out, as in the section model.
    """
    groups, link_names = link_bodies(robot, joints), {str(name) for name in record.link.values}
    if not any(body in link_names for group in groups for body in group):
        return record
    names = [f"link_{k + 1}" for k in range(len(groups))]
    loads = {
        name: xr.concat(
            [record[name].sel(link=[body for body in group if body in link_names]).sum("link") for group in groups],
            "link",
        ).transpose("time", "link", ...)
        for name in ("link_force", "link_torque")
    }
    return record.drop_dims("link").assign(loads).assign_coords(link=names)


def _flow_loads(record: xr.Dataset, joints: Sequence[str]) -> SectionLoads:
    """Return the loads of the flow at the samples: means over the control period before each sample."""
    links = np.concatenate([record.link_force.values[..., :2], record.link_torque.values[..., None]], axis=2)
    moments = record.joint_water_torque.sel(joint=list(joints)).transpose("time", "joint").values

    def centred(values: np.ndarray) -> np.ndarray:
        return np.concatenate([0.5 * (values[1:] + values[:-1]), values[-1:]])

    return SectionLoads(centred(links), centred(moments))


def _lateral_loads(loads: SectionLoads, motion: RecordedMotion) -> np.ndarray:
    """Return the force across each link, to the left of the root's heading, and the moments, shape (sample, part)."""
    yaw = motion.position[:, 2, None]
    lateral_force = -np.sin(yaw) * loads.links[:, :, 0] + np.cos(yaw) * loads.links[:, :, 1]
    return np.column_stack([lateral_force, loads.joints])


def r2(values: np.ndarray, model: np.ndarray) -> float:
    """Return the fraction of the variance of values that a model explains; below 0 it is worse than their mean [-]."""
    spread = float(((values - values.mean()) ** 2).sum())
    return float(1.0 - ((values - model) ** 2).sum() / spread) if spread > 0 else float("nan")


def fit_factors(values: np.ndarray, added_force: np.ndarray, drag: np.ndarray) -> np.ndarray:
    """Return the factors on added mass and drag with the least squares of the residual, shape (2,) [-].

    Args:
        values: forces of the flow, shape (sample,).
        added_force: part of the section model by the acceleration, shape (sample,).
        drag: part by the speed, shape (sample,).
    """
    factors, *_ = np.linalg.lstsq(np.column_stack([added_force, drag]), values, rcond=None)
    return np.asarray(factors)


def _row(
    values: np.ndarray, added_force: np.ndarray, drag: np.ndarray, keep: np.ndarray,
    halves: tuple[np.ndarray, np.ndarray],
    cycle: float,
) -> list[float]:  # fmt: skip
    """Return a row of the residual table: rms, explained variance, factors with intervals, and the test."""
    fit_half, test_half = halves
    factors = fit_factors(values[fit_half], added_force[fit_half], drag[fit_half])
    draws = bootstrap_factors(values[fit_half], added_force[fit_half], drag[fit_half], max(round(0.5 * cycle), 2))
    lower_bound, upper_bound = np.quantile(draws, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2], axis=0)

    def fit(mask: np.ndarray) -> float:
        return r2(values[mask], factors[0] * added_force[mask] + factors[1] * drag[mask])

    return [
        float(np.sqrt((values[keep] ** 2).mean())), float(np.sqrt(((added_force + drag)[keep] ** 2).mean())),
        r2(values[keep], (added_force + drag)[keep]), factors[0], lower_bound[0], upper_bound[0], factors[1],
        lower_bound[1], upper_bound[1], fit(fit_half),
        fit(test_half),
    ]  # fmt: skip


def bootstrap_factors(values: np.ndarray, added_force: np.ndarray, drag: np.ndarray, block: int) -> np.ndarray:
    """Return the factors of a block bootstrap, shape (draw, 2); NaN if there are too few blocks.

    Args:
        values: forces of the flow, shape (sample,).
        added_force: part of the section model by the acceleration, shape (sample,).
        drag: part by the speed, shape (sample,).
        block: samples in a block [-].
    """
    if len(values) < BLOCKS * block:
        return np.full((DRAWS, 2), np.nan)
    rng, count = np.random.default_rng(len(values)), max(len(values) // block, 1)
    draws = np.empty((DRAWS, 2))
    for k in range(DRAWS):
        start = rng.integers(len(values), size=count)
        index = ((start[:, None] + np.arange(block)) % len(values)).ravel()  # each sample is drawn as often
        draws[k] = fit_factors(values[index], added_force[index], drag[index])
    return draws
