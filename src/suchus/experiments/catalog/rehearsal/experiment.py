"""Does the robot walk the same when every command goes over the bus, and how much of a real wire does it bear?"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import radians
from typing import Any, ClassVar, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core.checks import Checks
from suchus.core.errors import Diverged
from suchus.experiments.experiment import Experiment, Measure, Measures, Outcome, Progress, SimulationResult, silent
from suchus.hardware import BusClock, DriveLimits, DriveSettings, Rig, drive
from suchus.hardware.bus import BusPlace, Wiring, straight
from suchus.hardware.emulator import EmulatedBody, Emulator, MemoryPort, Trouble
from suchus.hardware.protocols import bus_protocol, bus_protocols
from suchus.robot.control import Control, Coordinated, HeadingRule, OpenLoop, PatternGenerator
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl
from suchus.sim.metrics import displacement, heading_change
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

RULES = ("open", "closed", "steered", "pattern")
MAX_DISPLACEMENT_CHANGE = 0.02
"""Relative change of the displacement above which a rule is flagged [-]; real walks scatter by about as much."""
MAX_HEADING_CHANGE = radians(5.0)
"""Additional change of heading above which a rule is flagged [rad]."""
MIN_JUDGED_CYCLES = 2.0
"""Fewest cycles with which a wire is judged [-]; a rule takes about one cycle to respond."""
_DRIVE_LIMITS = DriveLimits(silent=10_000, patience=10.0)  # lost packets must not stop the walk here


class Wire(NamedTuple):
    """One kind of imperfect wire."""

    name: str
    """Name in tables."""
    trouble: Trouble
    """Its imperfections."""


class RehearsedWalk(NamedTuple):
    """A walk over an emulated bus."""

    log: xr.Dataset
    """Log of the driver: commands and readings."""
    truth: xr.Dataset
    """Record of the emulated body."""


def rehearse(
    robot: Robot,
    gait: Gait,
    control: Control,
    duration: float,
    *,
    protocol: str = "dynamixel",
    trouble: Trouble | None = None,
    actual_wiring: Wiring | None = None,
) -> RehearsedWalk:
    """Simulate a walk over an emulated bus whose clock is set by the driver.

    Args:
        robot: the robot.
        gait: gait of the walk.
        control: control rule of the walk.
        duration: duration with the first second of standing [s].
        protocol: protocol of the servos.
        trouble: imperfections of the wire; none by default.
        actual_wiring: actual wiring of the robot, where it differs from the configured one.
    """
    bus = BusPlace(port="memory", protocol=protocol)
    wiring = straight(robot, [bus], bus_protocol(protocol).default_model, boards=True)
    trouble = trouble or Trouble()
    emulator = Emulator(
        actual_wiring or wiring, EmulatedBody(robot, gait, latency=trouble.latency), trouble, has_clock=True
    )
    rig = Rig(robot, wiring, [MemoryPort(emulator)], has_clock=True)
    settings = DriveSettings(duration=duration, stop="hold", limits=_DRIVE_LIMITS)
    log = drive(rig, gait, control, settings, clock=BusClock(rig))
    truth = emulator.body.record()
    return RehearsedWalk(log, truth.isel(time=slice(log.sizes["time"])))


def sent_directly(robot: Robot, gait: Gait, goals: np.ndarray) -> xr.Dataset:
    """Simulate a robot that gets its goals without a wire; the difference to a rehearsed walk is due to the wire.

    Args:
        robot: the robot.
        gait: gait in whose first posture it begins.
        goals: goal angles of all servos at every tick, shape (time, servo) [rad].

    Returns:
        Record of the body, with a sample for each row of goals.
    """
    body = EmulatedBody(robot, gait)
    for row in goals:
        body.aim(dict(enumerate(row.tolist())))
        body.step()
    return body.record().isel(time=slice(len(goals)))


def exceeds_tolerance(displacement_change: float, heading_difference: float) -> bool:
    """Return whether a wire changes a walk too much: displacement or heading; NaN counts as too much.

    The limits are ``MAX_DISPLACEMENT_CHANGE`` and ``MAX_HEADING_CHANGE``.

    Args:
        displacement_change: change of the displacement, as a share of that without the wire [-].
        heading_difference: further change of heading [rad].
    """
    return not (
        abs(displacement_change) <= MAX_DISPLACEMENT_CHANGE and abs(heading_difference) <= MAX_HEADING_CHANGE
    )  # NaN is flagged


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal(Experiment):
    """The same walks in the simulation and over an emulated bus, ideal and not.

    Over ideal wires the walk is compared sample by sample, and the angles servo by servo: the displacement alone shows
    nothing, since servos that are commanded alike can be swapped without a trace. It is compared twice: with the
    simulation, whose goals are any angle, and with the simulation that is sent the goals that a servo's steps leave.
    A walk answers the smallest change of its goals, since feet touch down a step of the physics sooner or later.
    Latency holds for goals and readings each; goals are late by whole steps of the physics, readings by whole ticks.
    """

    title = "Does it walk the same over the bus, and how much of a real wire does it bear?"
    shows = "Beyond the article: commands and readings as packets on a servo bus"
    answers = ("position_off", "wire_off", "goal_off", "angle_off", "latency_budget", "flagged")
    needs = ("limbs",)
    reproduces = False
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 2.0}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that walks."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The gait in which it walks."""
    cycles: float = 2.0
    """Cycles of the comparison over ideal wires, and of the gait alone over others [-]."""
    rule_cycles: float = 4.0
    """Cycles of the feedback rules over imperfect wires [-]."""
    protocols: tuple[str, ...] = ("dynamixel", "feetech")
    """Protocols over which it walks with ideal wires."""
    controls: tuple[str, ...] = RULES
    """What decides over imperfect wires: the gait alone, the three feedback rules, these and the heading loop, coupled
    oscillators."""
    latencies: tuple[float, ...] = (0.006, 0.02, 0.05)
    """How long goals are on their way, and readings too [s]."""
    resolutions: tuple[float, ...] = (0.088, 0.3, 1.0)
    """Steps of the servos' angles [degrees]."""
    losses: tuple[float, ...] = (0.01, 0.1)
    """Shares of the packets that are lost [-]."""
    seed: int = 0
    """Seed of what is lost [-]."""

    def __post_init__(self) -> None:
        """Refuse unknown protocols and controls, and imperfections of the wire outside their ranges."""
        with Checks(self.name(), self) as check:
            check.number("cycles", 0.1, 100.0, "")
            check.number("rule_cycles", 0.1, 100.0, "")
            for name, options in (("protocols", tuple(bus_protocols())), ("controls", RULES)):
                unknown = [choice for choice in getattr(self, name) if choice not in options]
                check.that(not unknown, f"{self.name()}.{name} has {unknown}; there is {', '.join(options)}")
            check.that(bool(self.protocols), f"{self.name()}.protocols is empty; one at least is needed")
            for name, upper_bound in (("latencies", 1.0), ("resolutions", 10.0), ("losses", 1.0)):
                row = getattr(self, name)
                check.that(
                    all(0.0 <= setting <= upper_bound for setting in row) and len(set(row)) == len(row),
                    f"{self.name()}.{name} is {row}; 0 to {upper_bound:g} is allowed, each once",
                )

    def quick(self) -> "Rehearsal":
        """A quarter of a cycle, both protocols, and one wire for the three rules."""
        return replace(
            self, cycles=0.25, rule_cycles=0.25, controls=("closed",), latencies=(0.05,), resolutions=(), losses=()
        )

    def wires(self) -> Iterator[Wire]:
        """Yield the imperfect wires."""
        for latency in self.latencies:
            yield Wire(f"latency_{1e3 * latency:g}_ms", Trouble(latency=latency))
        for step in self.resolutions:
            yield Wire(f"step_{step:g}_degrees", Trouble(resolution=radians(step)))
        for share in self.losses:
            yield Wire(f"lost_{100 * share:g}_percent", Trouble(lost=share, seed=self.seed))

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Walk in the simulation, over ideal wires, and over imperfect ones."""
        wires = list(self.wires())
        steps = len(self.protocols) + len(self.controls) * (1 + len(wires))
        finished_steps = 0

        def report_step(label: str) -> None:
            nonlocal finished_steps
            finished_steps += 1
            progress(label, finished_steps / steps)

        duration = START + self.cycles * self.gait.period
        truth = crawl(self.robot, self.gait, duration=duration)
        position_errors, wire_errors, goal_errors, angle_errors = [], [], [], []
        for protocol in self.protocols:
            walk = rehearse(self.robot, self.gait, OpenLoop(), duration, protocol=protocol)
            position_errors.append(np.abs(walk.truth.position - truth.position).max("xyz").values)
            direct = sent_directly(self.robot, self.gait, walk.log.servo_target.values)
            wire_errors.append(np.abs(walk.truth.position - direct.position).max("xyz").values)
            goal_errors.append(np.abs(walk.log.servo_target - truth.servo_target).max("time").values)
            angle_errors.append(np.sqrt(((walk.log.servo_angle - truth.servo_angle) ** 2).mean("time")).values)
            report_step(protocol)
        distances, headings = np.full((2, len(self.controls), 1 + len(wires)), np.nan)
        for i, rule in enumerate(self.controls):
            control = self.control(rule)
            length = START + (self.cycles if rule == "open" else self.rule_cycles) * self.gait.period
            ideal = crawl(self.robot, self.gait, duration=length, control=control)
            distances[i, 0], headings[i, 0] = _displacement_and_turn(ideal)
            report_step(rule)
            for j, wire in enumerate(wires, 1):
                try:
                    walk = rehearse(self.robot, self.gait, control, length, trouble=wire.trouble)
                    distances[i, j], headings[i, j] = _displacement_and_turn(walk.truth)
                except Diverged:
                    pass  # stays NaN, which is flagged
                report_step(f"{rule}, {wire.name.replace('_', ' ')}")
        step = 2 * np.pi / 4096
        record = xr.Dataset(
            {
                "position_off": (("protocol", "time"), np.array(position_errors), {"units": "m"}),
                "wire_off": (("protocol", "time"), np.array(wire_errors), {"units": "m"}),
                "goal_off": (("protocol", "servo"), np.array(goal_errors), {"units": "rad"}),
                "angle_off": (("protocol", "servo"), np.array(angle_errors), {"units": "rad"}),
                "forward": (("rule", "wire"), distances, {"units": "m"}),
                "turned": (("rule", "wire"), headings, {"units": "rad"}),
                "latency": ("wire", [0.0, *(wire.trouble.latency for wire in wires)], {"units": "s"}),
                "half_step": ((), step / 2, {"units": "rad"}),
            },
            coords={
                "protocol": list(self.protocols),
                "time": ("time", truth.time.values, {"units": "s"}),
                "servo": truth.servo.values,
                "rule": list(self.controls),
                "wire": ["ideal", *(wire.name for wire in wires)],
            },
        )
        return SimulationResult(record=record)

    def control(self, rule: str) -> Control:
        """Return the control of a rule by its name."""
        closed = Coordinated().suited(self.robot, self.gait)
        controls: dict[str, Control] = {
            "open": OpenLoop(),
            "closed": closed,
            "steered": replace(closed, heading=HeadingRule()),
            "pattern": PatternGenerator(),
        }
        return controls[rule]

    def measure(self, record: xr.Dataset) -> Measures:
        """Return how far the walks differ, and which wires change the walk of which rule too much."""
        measures = Measures(
            {
                "position_off": Measure(float(record.position_off.max()), "m"),
                "wire_off": Measure(float(record.wire_off.max()), "m"),
                "goal_off": Measure(float(record.goal_off.max()), "rad"),
                "half_step": Measure(float(record.half_step), "rad"),
                "angle_off": Measure(float(record.angle_off.max()), "rad"),
            }
        )
        count = 0
        is_borne: dict[float, bool] = {}
        for rule in record.rule.values:
            rule_record = record.sel(rule=rule)
            ideal = rule_record.isel(wire=0)
            measures[f"forward_{rule}"] = Measure(float(ideal.forward), "m")
            for wire in record.wire.values[1:]:
                displacement_change = float(rule_record.forward.sel(wire=wire) / ideal.forward - 1.0)
                heading_difference = float(rule_record.turned.sel(wire=wire) - ideal.turned)
                measures[f"lost_{rule}_{wire}"] = Measure(displacement_change, "-")
                measures[f"turned_{rule}_{wire}"] = Measure(heading_difference, "rad")
                bad = exceeds_tolerance(displacement_change, heading_difference)
                measures[f"flagged_{rule}_{wire}"] = Measure(
                    float(bad) if self.is_long_enough(str(rule)) else np.nan, "-"
                )
                count += bad
                latency = float(record.latency.sel(wire=wire))
                if latency > 0.0:
                    is_borne[latency] = is_borne.get(latency, True) and not bad
        borne_latencies = [
            latency
            for latency in sorted(is_borne)
            if all(is_borne[shorter_latency] for shorter_latency in is_borne if shorter_latency <= latency)
        ]
        is_judged = all(self.is_long_enough(rule) for rule in self.controls)
        return measures | {
            "latency_budget": Measure(max(borne_latencies, default=0.0) if is_judged else np.nan, "s"),
            "flagged": Measure(float(count) if is_judged else np.nan, "-"),
        }

    def is_long_enough(self, rule: str) -> bool:
        """Return whether walks are long enough to judge what a wire costs a rule."""
        return (self.cycles if rule == "open" else self.rule_cycles) >= MIN_JUDGED_CYCLES

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return what decided, with the bounds beyond which a wire is flagged."""
        return self.render_explanation(
            measures, loses=MAX_DISPLACEMENT_CHANGE, turns=MAX_HEADING_CHANGE, enough=MIN_JUDGED_CYCLES
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw what each wire costs each rule, and how far each servo is off over ideal wires."""
        with styled():
            return {"rehearsal": self._draw(outcome.record)}

    def _draw(self, record: xr.Dataset) -> Figure:
        """Draw the relative change of displacement by wire and rule, and the angle errors over ideal wires."""
        figure, axes = panels(2, 1, height=7.0)
        wires, rules = record.wire.values[1:], record.rule.values
        colours = [COLOURS["neutral"], COLOURS["coordinated"], COLOURS["tail_drag"], COLOURS["limbs_only"]]
        for i, rule in enumerate(rules):
            share = 100.0 * (record.forward.values[i, 1:] / record.forward.values[i, 0] - 1.0)
            axes[0, 0].bar(
                np.arange(len(wires)) + (i - 0.5 * (len(rules) - 1)) * 0.8 / len(rules), share, 0.8 / len(rules),
                color=colours[RULES.index(str(rule))], label=str(rule),
            )  # fmt: skip
        for side in (-1.0, 1.0):
            bound = "beyond: flagged" if side > 0 else None
            axes[0, 0].axhline(
                side * 100.0 * MAX_DISPLACEMENT_CHANGE,
                color=COLOURS["alarm"],
                linewidth=0.8,
                linestyle="--",
                label=bound,
            )
        axes[0, 0].set_xticks(np.arange(len(wires)), [_wire_label(str(wire)) for wire in wires])
        axes[0, 0].set_ylabel("change of displacement [%]")
        axes[0, 0].legend(loc="lower right", ncols=2)
        servos = [str(name).replace("_", " ") for name in record.servo.values]
        for marker, protocol in zip("ox", record.protocol.values, strict=False):
            errors = np.degrees(record.angle_off.sel(protocol=protocol).values)
            axes[1, 0].plot(np.arange(len(servos)), errors, marker, color=COLOURS["ours"], label=str(protocol))
        axes[1, 0].set_xticks(np.arange(len(servos)), servos, rotation=90)
        axes[1, 0].set_ylabel("off [degrees]")
        axes[1, 0].set_ylim(bottom=0.0)
        axes[1, 0].legend(loc="best")
        return captioned(
            figure,
            "Above: what an imperfect wire changes of the displacement of each rule, against the same walk in the "
            f"simulation; beyond the dashed lines, {MAX_DISPLACEMENT_CHANGE:.0%}, it is flagged. Open: the gait "
            f"alone; closed: three "
            "feedback rules; steered: these and a loop that holds the heading; pattern: coupled oscillators. Below: "
            "how far each servo is off the simulation over ideal wires, root mean square.",
        )


def _displacement_and_turn(record: xr.Dataset) -> tuple[float, float]:
    """Return displacement forward [m] and change of heading [rad] of a walk."""
    return float(displacement(record).sel(xyz="x")), float(heading_change(record))


def _wire_label(wire: str) -> str:
    kind, _, amount = wire.partition("_")
    return f"{kind}\n{amount.replace('_percent', ' %').replace('_degrees', '°').replace('_', ' ')}"


experiment = Rehearsal()
