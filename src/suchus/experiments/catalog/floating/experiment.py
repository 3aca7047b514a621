"""Does it float as Archimedes says, and does it right itself?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import nan, pi, radians, tau
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.floating import cases
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.control import Swimming
from suchus.robot.design import Robot, with_values
from suchus.robot.design.scale import control_period
from suchus.robot.motion import LIMBS_UP, cycle_targets, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.afloat import HEAVIER, INDIFFERENT, buoyancy, floats, mass_text, volume_text
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_UPRIGHT = 0.035
"""Heel below which the robot counts as upright [rad]; 2 degrees."""
_DASHES = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)), (0, (3, 1)))
_SHADES = (COLOURS["coordinated"], COLOURS["limbs_only"], COLOURS["tail_drag"], COLOURS["spine_only"], "#333333")


@dataclass(frozen=True, slots=True, kw_only=True)
class Floating(Experiment):
    """Forces of the water against exact answers, and a robot that is released heeled.

    The drafts of sphere, cylinder and box have closed forms. A released box heaves at a known period and conserves its
    energy. A spheroid in ideal water conserves its momentum. Submerged volumes are compared with counted points. The
    robot lies still with its limbs held out and, if it floats, is released at the surface from several angles of heel.
    Its righting lever, with trim and draft free, is drawn over the heel.
    """

    title = "Does it float as Archimedes says, and does it right itself?"
    shows = "Beyond the article, whose robot is amphibious and whose body is not said to float"
    answers = (
        "mass_floating",
        "volume_floating",
        "share_above",
        "metacentric_height_floating",
        "vanishing_floating",
        "roll_at_rest",
    )
    reproduces: ClassVar[bool] = False
    answer_minima: ClassVar[Mapping[str, float]] = {"duration": 10.0}

    robot: Robot = field(default_factory=lambda: ROBOTS["floating_caiman"])
    """The robot that floats."""
    heels: tuple[float, ...] = (radians(60), radians(120), radians(150))
    """Angles of heel from which the robot is released [rad]; the measures are those of the last one."""
    duration: float = 20.0
    """Simulated duration after the release [s]; the mean of the last quarter counts as equilibrium."""
    energy_time: float = 60.0
    """Simulated duration of the rocking box [s]."""
    periods: int = 10
    """Number of simulated periods of heave [-]."""
    poses: int = 16
    """Number of random poses for the submerged volume, for each kind of piece [-]."""
    points: int = 2**18
    """Number of counted points, a power of two [-]."""
    angles: int = 37
    """Number of heels from 0 to 180 degrees at which the righting lever is computed [-]."""
    timestep: float = 0.002
    """Time step of the physics of boxes and spheroids [s]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.rising("heels", 0.0, pi, "rad")
            check.number("duration", 0.1, 1e4, "s")
            check.number("energy_time", 0.2, 1e4, "s")
            check.whole("periods", 2, 1000)
            check.whole("poses", 1, 1000)
            check.whole("points", 2**8, 2**24)
            check.that(self.points.bit_count() == 1, f"points is {self.points}; a power of two is needed")
            check.whole("angles", 3, 1000)
            check.number("timestep", 1e-5, control_period(self.robot), "s")

    def quick(self) -> "Floating":
        """Return one heel, few seconds, fewer points and angles."""
        return replace(self, heels=(radians(150),), duration=1.5, energy_time=1.0, poses=2, points=2**14, angles=5)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate the bodies with exact answers, then release the robot from each heel."""
        progress("exact answers", 0.0)
        parts = [self._drafts(), self._heave(), self._energy(), self._drift(), self._volumes(), self._table()]
        progress("righting levers", 0.4)
        parts.append(self._levers())
        record = self._release_record(staged(progress, "let go", 0.5, 1.0))
        return SimulationResult(record=xr.merge([*parts, record], compat="no_conflicts"), replays=self._replays(record))

    def _drafts(self) -> xr.Dataset:
        """Return computed and exact draft of the bodies with closed forms [m]."""
        known_drafts = cases.drafts()
        return xr.Dataset(
            {
                "body_draft": ("float", [cases.draft_of(draft.body) for draft in known_drafts], {"units": "m"}),
                "exact_draft": ("float", [draft.exact_draft for draft in known_drafts], {"units": "m"}),
            },
            coords={"float": [draft.name for draft in known_drafts]},
        )

    def _heave(self) -> xr.Dataset:
        """Return simulated and exact heave period of a box, without and with added mass [s]."""
        added_mass_ratios = (0.0, 0.6)
        heaves = [cases.simulate_heave(ratio, 0.005, self.periods, self.timestep) for ratio in added_mass_ratios]
        return xr.Dataset(
            {
                "heave_period": ("added_mass", [cases.heave_period(motion) for motion, _ in heaves], {"units": "s"}),
                "exact_heave_period": ("added_mass", [exact for _, exact in heaves], {"units": "s"}),
            },
            coords={"added_mass": list(added_mass_ratios)},
        )

    def _energy(self) -> xr.Dataset:
        """Return the energy of a rocking box over time [J] and its relative gain [-], for each integrator."""
        names = ("implicitfast", "RK4")
        motions = [cases.simulate_rocking(self.energy_time, name, self.timestep) for name in names]  # type: ignore[arg-type]
        energy = np.array([motion.energy.values for motion in motions])
        return xr.Dataset(
            {
                "energy": (("integrator", "box_time"), energy, {"units": "J"}),
                "gained": ("integrator", [cases.relative_energy_gain(motion) for motion in motions], {"units": "1"}),
            },
            coords={"integrator": list(names), "box_time": ("box_time", motions[0].time.values, {"units": "s"})},
        )

    def _drift(self) -> xr.Dataset:
        """Return the relative change of momentum of a spheroid in ideal water, for each integrator [-]."""
        drifts = [
            cases.relative_momentum_drift(cases.simulate_drift("RK4", self.timestep)),
            cases.relative_momentum_drift(cases.simulate_drift("implicitfast", 0.001)),
        ]
        return xr.Dataset({"drift": ("integrator", drifts[::-1], {"units": "1"})})

    def _volumes(self) -> xr.Dataset:
        """Return the relative error of the submerged volume for each kind of piece and pose [-]."""
        errors = {
            kind: cases.volume_errors(body, self.poses, self.points) for kind, body in cases.bodies_by_piece().items()
        }
        return xr.Dataset(
            {"volume_off": (("piece", "pose"), np.array(list(errors.values())), {"units": "1"})},
            coords={"piece": list(errors)},
        )

    @staticmethod
    def _table() -> xr.Dataset:
        """Return the values of ``cases.public_table`` as variables ``table_NAME``."""
        table = cases.public_table()
        units = {"neutral": "m/s2", "ballast": "N", "keel": "rad/s2"}
        return xr.Dataset({f"table_{name}": ((), value, {"units": units[name]}) for name, value in table.items()})

    def _levers(self) -> xr.Dataset:
        """Return righting lever [m] and hydrostatic numbers of the robot with its hull and without."""
        hydrostatic_results = [
            hydrostatics(robot, self._posture(robot), heel_count=self.angles)
            for robot in (self.robot, with_values(self.robot, {"hull": None}))
        ]
        levers = xr.Dataset(
            {"lever": (("hull", "heel"), np.array([statics.lever for statics in hydrostatic_results]), {"units": "m"})},
            coords={"hull": ["floating", "bare"], "heel": ("heel", hydrostatic_results[0].heel, {"units": "rad"})},
        )
        for name, (field_name, unit) in _STATICS.items():
            levers[f"static_{name}"] = (
                "hull",
                np.array([float(getattr(statics, field_name)) for statics in hydrostatic_results]),
                {"units": unit},
            )
        return levers

    @staticmethod
    def _posture(robot: Robot) -> np.ndarray:
        """Return the servo angles of the robot lying still with its limbs held out [rad]."""
        return cycle_targets(robot, straight_gait(robot, limbs=LIMBS_UP), np.zeros(1))[0]

    def _release_record(self, progress: Any) -> xr.Dataset:
        """Simulate the robot released at the surface from each angle of heel."""
        gait = straight_gait(self.robot, limbs=LIMBS_UP)
        runs = [
            Run(
                robot=self.robot,
                gait=gait,
                lake=Lake(level=3.0, heel=heel),
                control=Swimming(),
                label=f"{np.degrees(heel):.0f} degrees",
            )
            for heel in self.heels
        ]
        return simulate(runs, duration=self.duration, progress=progress)

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the run with the last heel; a robot that does not float lies on the ground."""
        heeled = f"Let go at the surface, heeled by {np.degrees(self.heels[-1]):.0f} degrees, limbs held out."
        title, caption = (
            ("A robot is let go at the surface", heeled)
            if floats(self.robot)
            else ("A robot that does not float", "It lies on the ground under water, limbs held out.")
        )
        return replayed("righting_replay.html", record.isel(run=-1), self.robot, title=title, caption=caption)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the errors against the exact answers, and the floating position of the robot."""
        heave = np.abs(record.heave_period / record.exact_heave_period - 1)
        rest_interval = record.isel(time=slice(-max(record.sizes["time"] // 4, 1), None))
        roll = rotation.heel(record.orientation.values)
        final_roll = np.unwrap(roll[-1])[-rest_interval.sizes["time"] :]
        is_upright = np.abs(roll[-1]) < _UPRIGHT
        first_upright = int(np.flatnonzero(~is_upright)[-1]) + 1 if not is_upright.all() else 0
        hull_record, bare_record = record.sel(hull="floating"), record.sel(hull="bare")
        is_at_rest = _is_afloat(hull_record) and float(np.ptp(final_roll)) <= 2.0 * _UPRIGHT
        has_righted = is_at_rest and 0 < first_upright <= len(is_upright) - len(final_roll)
        righting_time = float(record.time[first_upright]) if has_righted else nan
        rest_heel = abs((float(final_roll.mean()) + pi) % tau - pi)
        return Measures(
            {
                "draft_error": Measure(float(np.abs(record.body_draft - record.exact_draft).max()), "m"),
                "heave_period_error": Measure(float(heave.max()), "-"),
                "energy_gain": Measure(float(record.gained.sel(integrator="implicitfast")), "-"),
                "energy_gain_rk4": Measure(float(record.gained.sel(integrator="RK4")), "-"),
                "impulse_drift": Measure(float(record.drift.sel(integrator="RK4")), "-"),
                "impulse_drift_implicitfast": Measure(float(record.drift.sel(integrator="implicitfast")), "-"),
                "volume_error": Measure(float(record.volume_off.max()), "-"),
                "acceleration_neutral": Measure(float(record.table_neutral), "m/s2"),
                "force_of_ballast": Measure(float(record.table_ballast), "N"),
                "acceleration_of_keel": Measure(float(record.table_keel), "rad/s2"),
                "share_above": Measure(float(1.0 - rest_interval.share_under.isel(run=0).mean()), "-"),
                "roll_at_rest": Measure(rest_heel if is_at_rest else nan, "rad"),
                "righting_time": Measure(righting_time, "s"),
            },
            {
                f"{name}_{kind}": Measure(float(statics[f"static_{name}"]), unit)
                for kind, statics in (("floating", hull_record), ("bare", bare_record))
                for name, (_, unit) in _STATICS.items()
                if np.isfinite(float(statics[f"static_{name}"]))
            },
        )

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return the reason for the outcome; a robot is indifferent where its metacentric height is next to zero."""
        height = measures.get("metacentric_height_floating", nan)
        further = {
            "is_indifferent": abs(height) <= INDIFFERENT * self.robot.length,
            "bare": buoyancy(measures["surplus_bare"], measures["mass_bare"]),
            "floating": buoyancy(measures["surplus_floating"], measures["mass_floating"]),
            "heavier": HEAVIER,
            "mass_text": mass_text,
            "volume_text": volume_text,
        }
        return self.render_explanation({"metacentric_height_floating": height, **measures}, **further)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the righting lever with the rolls, and the checks against exact answers."""
        return {"righting": draw_righting(outcome.record), "checks": draw_checks(outcome.record)}


_STATICS: Mapping[str, tuple[str, str]] = {
    "mass": ("mass", "kg"),
    "volume": ("volume", "m3"),
    "missing": ("missing_volume", "m3"),
    "surplus": ("surplus_mass", "kg"),
    "draft": ("draft", "m"),
    "trim": ("trim", "rad"),
    "metacentric_height": ("metacentric_height", "m"),
    "vanishing": ("vanishing", "rad"),
}
"""Measures that are fields of ``Hydrostatics``: the field and its unit."""


def _is_afloat(statics: xr.Dataset) -> bool:
    """Return whether a robot floats, from its hydrostatic numbers ``static_surplus`` and ``static_mass``."""
    return buoyancy(float(statics.static_surplus), float(statics.static_mass)) == "floats"


def draw_righting(record: xr.Dataset) -> Figure:
    """Draw the righting lever over the heel, and of robots that float the heel over time after they were let go.

    Args:
        record: record with ``lever`` (hull, heel) [m], and runs with ``orientation``.
    """
    is_afloat = _is_afloat(record.sel(hull="floating"))
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.2) if is_afloat else panels(1, 1, width=6.0, height=4.2)
        ax = axes[0, 0]
        heel = np.degrees(record.heel.values)
        labels = {
            str(hull): "at the surface" if _is_afloat(record.sel(hull=hull)) else "under water"
            for hull in record.hull.values
        }
        hulls = {
            "floating": ("-", "coordinated", "with its hull, "),
            "bare": ((0, (5, 2)), "limbs_only", "without it, "),
        }
        if np.array_equal(*record.lever.sel(hull=["floating", "bare"]).transpose("hull", ...)):  # the robot has no hull
            hulls = {"floating": ("-", "coordinated", "")}
        for hull, (dashes, colour, hull_text) in hulls.items():
            lever = 1e3 * record.lever.sel(hull=hull)
            ax.plot(heel, lever, color=COLOURS[colour], linestyle=dashes, label=hull_text + labels[hull])
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set(xlabel="heel [deg]", ylabel="righting lever GZ [mm]", xlim=(0, 180), xticks=range(0, 181, 30))
        ax.legend(loc="best")
        if is_afloat:
            _draw_rolls(axes[0, 1], record)
    caption = "Righting lever over the heel, positive where the water turns the robot upright, draft and trim free"
    return captioned(
        figure,
        f"{caption}; and the heel over time of the robot let go at the surface."
        if is_afloat
        else f"{caption} at the surface, level under water. How it heels over time is not drawn: it does not float.",
    )


def _draw_rolls(ax: Any, record: xr.Dataset) -> None:
    """Draw the heel over time of each run."""
    for i, label in enumerate(record.label.values):
        turn = record.orientation.isel(run=i).values
        roll = np.arctan2(*(rotation.rotate(turn, np.eye(3)[axis])[:, 2] for axis in (1, 2)))
        roll = np.degrees(np.unwrap(roll))
        ax.plot(record.time, roll, color=_SHADES[i % 5], linestyle=_DASHES[i % 5], label=f"from {label}")
    ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
    ax.set(xlabel="time [s]", ylabel="heel [deg]", xlim=(0, min(10.0, float(record.time[-1]))))
    ax.legend(loc="best")


def draw_checks(record: xr.Dataset) -> Figure:
    """Draw computed over exact drafts, and the energy of a rocking box over time.

    Args:
        record: ``body_draft`` and ``exact_draft`` (float) [m], ``energy`` (integrator, box_time) [J].
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.2)
        ax = axes[0, 0]
        kinds = [str(name).split()[0] for name in record["float"].values]
        for kind, marker, colour in (("sphere", "o", 0), ("cylinder", "s", 1), ("box", "^", 2)):
            indices = [i for i, body_kind in enumerate(kinds) if body_kind == kind]
            exact, computed = 1e3 * record.exact_draft[indices], 1e3 * record.body_draft[indices]
            ax.plot(exact, computed, marker, markersize=9, color=_SHADES[colour], label=kind)
        max_draft = 1.1e3 * float(record.exact_draft.max())
        ax.plot([0, max_draft], [0, max_draft], color=COLOURS["neutral"], linewidth=0.9, zorder=0)
        ax.set(
            xlabel="exact draft [mm]", ylabel="draft in the physics step [mm]", xlim=(0, max_draft), ylim=(0, max_draft)
        )
        ax.legend(loc="upper left")
        ax = axes[0, 1]
        for i, name in enumerate(record.integrator.values):
            energy = record.energy.sel(integrator=name)
            ax.plot(
                record.box_time, 1e3 * (energy - energy[0]), color=_SHADES[i], linestyle=_DASHES[i],
                label=f"{name}, {1e2 * float(record.gained.sel(integrator=name)):.2g} % gained at most",
            )  # fmt: skip
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set(xlabel="time [s]", ylabel="energy less that at the start [mJ]")
        ax.margins(y=0.3)
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "Drafts of floats at three densities beside closed forms, the line being equality; and the energy of a box "
        "without drag that was let go heeled and pitched.",
    )


experiment = Floating()
