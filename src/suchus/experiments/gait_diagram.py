"""When do the feet stand, and whereto do spine and tail bend meanwhile?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import LEGS, Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Verdict, judge, silent, staged, stopwatch
from suchus.figures import captioned
from suchus.figures.gait_diagram import GaitTrack, gait_diagram
from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.metrics import between, duty_factor, loaded, sensed_phase
from suchus.motion import START, Gait
from suchus.paper import CYCLES
from suchus.paper.signs import spine_lateral
from suchus.replay import replay
from suchus.robots import ROBOTS

_TOGETHER = 0.125  # [cycle]; Hildebrand calls a symmetrical gait a trot within an eighth of a cycle
_CAPTION = "The crawl of the gait diagram: thick tracks are feet that stand."


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitDiagram(Experiment):
    """The article's Fig. 12 for our crawl: as commanded, and as foot pressure and servo angles tell.

    A foot stands when its pressure exceeds half a newton. Phases are those of the first harmonic of stance. The sense
    of a bend is the article's: right is positive.
    """

    title = "When do the feet stand, and whereto do spine and tail bend?"
    shows = "Section III.D, Fig. 12"
    claims = ("diagonal_gait", "gait_diagram", "tail_swings_in_crawl", "cycle_period", "cycle_count")
    decides = (
        "The legs' phases are commanded, so that the diagonal pairs come as no surprise. What the simulation "
        "adds: feet stand longer than commanded, since the body tips onto the swing foot until the other pair takes "
        "over, and the trunk lags behind its command where stance feet hold it back."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """How."""
    cycles: int = int(CYCLES)
    """How many cycles are shown [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 2, 1000)  # one cycle cannot show that it repeats itself

    def quick(self) -> "GaitDiagram":
        """The same: it takes a second."""
        return replace(self)

    def run(self, progress: Progress = silent) -> Outcome:
        """Crawl and look at the feet."""
        with stopwatch() as seconds:
            end = START + self.cycles * self.gait.period
            record = simulate(
                [Run(robot=self.robot, gait=self.gait)], duration=end, progress=staged(progress, "crawl", 0.0, 1.0)
            ).isel(run=0)
            measures = self._measures(record)
            page = partial(replay, record, self.robot, caption=_CAPTION)
            return Outcome(
                experiment=self.name(),
                measures=measures,
                verdicts=self._verdicts(record, measures),
                record=record,
                settings=self.settings(),
                replays={"gait_replay.html": Replay(caption=_CAPTION, make=page)},
                seconds=seconds(),
            )

    def _measures(self, record: xr.Dataset) -> dict[str, Measure]:
        walk = between(record).isel(time=slice(0, -1))  # whole cycles: the last sample begins the next one
        duty, phase = duty_factor(walk), sensed_phase(walk)
        measures = {f"duty_factor_{leg}": Measure(float(duty.sel(leg=leg)), "-") for leg in LEGS}
        measures |= {f"phase_{leg}": Measure(float(phase.sel(leg=leg)), "cycle") for leg in LEGS[1:]}
        apart = [_circular(phase.sel(leg="RH")), _circular(phase.sel(leg="RF") - phase.sel(leg="LH"))]
        sensed, told = _bends(walk, "servo_angle"), _bends(walk, "servo_target")
        for name in ("spine", "tail"):
            lag, gain = _against(walk, sensed[name], told[name])
            measures[f"{name}_lag"] = Measure(lag, "cycle")
            measures[f"{name}_amplitude"] = Measure(float(np.ptp(sensed[name]) / 2), "rad")
            measures[f"{name}_gain"] = Measure(gain, "-")
        return measures | {
            "diagonal_phase_error": Measure(max(apart), "cycle"),
            "period": Measure(_period(walk), "s"),
            "cycles": Measure(float(walk.limb_phase.sel(leg="LF")[-1] - walk.limb_phase.sel(leg="LF")[0]), "cycle"),
            "spine_changes_per_cycle": Measure(_changes(sensed["spine"]) / self.cycles, "-"),
            "tail_changes_per_cycle": Measure(_changes(sensed["tail"]) / self.cycles, "-"),
        }

    def _verdicts(self, record: xr.Dataset, measures: Mapping[str, Measure]) -> tuple[Verdict, ...]:
        m = {name: measure.value for name, measure in measures.items()}
        swings = _bends(between(record), "servo_angle")["tail"]
        return (
            judge(
                "diagonal_gait",
                m["diagonal_phase_error"],
                f"The stances of a diagonal pair are at most {m['diagonal_phase_error']:.2f} cycle apart by pressure.",
                holds=m["diagonal_phase_error"] < _TOGETHER,
            ),
            judge(
                "gait_diagram",
                m["spine_changes_per_cycle"],
                f"Sensed changes of side per cycle: spine {m['spine_changes_per_cycle']:.1f}, tail "
                f"{m['tail_changes_per_cycle']:.1f}; two are one bend to each side.",
                holds=round(m["spine_changes_per_cycle"]) == 2 and round(m["tail_changes_per_cycle"]) == 2,
            ),
            judge(
                "tail_swings_in_crawl",
                m["tail_amplitude"],
                f"The tail bends from {np.degrees(swings.min()):.0f} to {np.degrees(swings.max()):.0f} degrees.",
                holds=bool(swings.min() < 0 < swings.max()),
            ),
            judge(
                "cycle_period",
                m["period"],
                "The shift in time at which the sensed loads of the feet repeat themselves.",
            ),
            judge("cycle_count", float(round(m["cycles"])), "As simulated from 1 s to the end."),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw commanded and sensed."""
        walk = between(outcome.record)
        told, sensed = _bends(walk, "servo_target"), _bends(walk, "servo_angle")
        meant = (np.mod(walk.limb_phase, 1.0) >= 1.0 - walk.duty_factor).transpose("leg", "time").values
        stands = loaded(walk).transpose("leg", "time").values
        time = walk.time.values
        tracks = [
            GaitTrack(time=time, stance=stands, spine=sensed["spine"], tail=sensed["tail"], label="simulated"),
            GaitTrack(time=time, stance=meant, spine=told["spine"], tail=told["tail"], label="commanded"),
        ]
        marks = list(np.arange(START, time[-1] + 0.01, self.gait.period))
        figure = captioned(
            gait_diagram(tracks, cycles=marks),
            "Gait diagram in the form of the article's Fig. 12, black as simulated (foot pressure, servo angles), grey "
            "as commanded. Filled: a foot stands, or spine and tail bend to the right; open: they bend to the left.",
        )
        return {"gait_diagram": figure}


def _bends(record: xr.Dataset, which: str) -> dict[str, np.ndarray]:
    """Return the lateral angles of spine and tail in the article's signs [rad]."""
    angles = record[which]
    yaw = sum(angles.sel(servo=f"spine_yaw_{i}").values for i in (1, 2, 3))
    return {"spine": spine_lateral(np.asarray(yaw)), "tail": np.asarray(angles.sel(servo="tail_cable").values)}


def _harmonic(record: xr.Dataset, values: np.ndarray) -> complex:
    turn = np.exp(-2j * np.pi * (record.time.values - START) / float(record.period))
    return complex(2 * np.mean((values - values.mean()) * turn))


def _against(record: xr.Dataset, sensed: np.ndarray, told: np.ndarray) -> tuple[float, float]:
    """Return lag [cycle] and gain [-] of what is sensed against what was told, by first harmonics."""
    there, here = _harmonic(record, told), _harmonic(record, sensed)
    if abs(there) < 1e-6:
        return 0.0, float("nan")
    return float(-np.angle(here / there) / (2 * np.pi)), abs(here) / abs(there)


def _circular(phase: Any) -> float:
    """Return the distance of a phase from zero on the circle [cycle]."""
    return float(abs((float(phase) + 0.5) % 1.0 - 0.5))


def _period(record: xr.Dataset) -> float:
    """Return the shift in time at which the feet's loads agree best with themselves [s].

    Looked for from half to one and a half of the commanded period.
    """
    load = record.foot_force.sel(xyz="z").transpose("time", "leg").values
    step, period = float(record.time[1] - record.time[0]), float(record.period)
    shifts = np.arange(int(0.5 * period / step), min(int(1.5 * period / step), len(load) - 2))
    apart = [float(np.mean((load[n:] - load[:-n]) ** 2)) for n in shifts]
    return float(step * shifts[int(np.argmin(apart))])


def _changes(angle: np.ndarray) -> int:
    """Return how often a swinging angle changes its side, small wiggles about the middle not counted."""
    sides = np.sign(angle[np.abs(angle) > 0.1 * np.ptp(angle)])
    return int(np.count_nonzero(np.diff(sides)))


experiment = GaitDiagram()
