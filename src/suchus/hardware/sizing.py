"""Search for sufficient servos for a robot, of one family on one bus and one supply, by simulation."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import nan
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.progress import Progress, silent, staged
from suchus.hardware.loads import (
    AT_LIMIT,
    FULL_WOUND,
    LoadCase,
    ServoLoad,
    cold,
    loads_of_cases,
    measure_loads,
    records_of_each,
    torque_use,
    with_strong_servos,
)
from suchus.hardware.parts import servo_seats
from suchus.robot.design import Motor, Robot, Servo, layout, with_named_servos
from suchus.robot.design.scale import coarse_step
from suchus.robot.kinematics.tree import body_masses
from suchus.robot.motors import motors as shipped

FACTORS = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0)
"""How many times as long a gait's period is tried, where no servo of a family is fast or strong enough [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoFamily:
    """Servos of one family in a robot, and whether they are sufficient."""

    name: str
    """Name of the family."""
    volts: float
    """Its supply [V]."""
    chosen: Mapping[str, Motor]
    """The servo that is bought for each of the robot's."""
    factors: Mapping[str, float]
    """How many times as long the period of each gait is, by its name [-]."""
    loads: Mapping[str, Mapping[str, ServoLoad]]
    """What each of them bears, by case; empty for a family that was not simulated since all of it is too weak."""
    lacking: str = ""
    """Why the family does not do, in a sentence; empty if it does."""

    @property
    def passes(self) -> bool:
        """Whether it is sufficient, also with longer periods."""
        return not self.lacking

    @property
    def as_asked(self) -> bool:
        """Whether it is sufficient at the gaits' own periods."""
        return self.passes and all(factor == 1.0 for factor in self.factors.values())

    @property
    def price(self) -> tuple[float, float]:
        """Least and greatest price of all servos together [EUR]."""
        min_price, max_price = (sum(motor.price[i] for motor in self.chosen.values()) for i in (0, 1))
        return min_price, max_price

    @property
    def mass(self) -> float:
        """Mass of all servos [kg]."""
        return sum(motor.mass for motor in self.chosen.values())

    def current(self, case: str) -> float:
        """Return the mean current of all servos in a case, an upper bound [A]."""
        return sum(load.current for load in self.loads[case].values())

    def battery(self, hours: float) -> float:
        """Return the charge that the hungriest case takes in some hours, an upper bound [A h]."""
        return hours * max((self.current(case) for case in self.loads), default=nan)

    def binding(self) -> list[tuple[str, str, float]]:
        """Return each servo with its most demanding case and its use there, the greatest use first."""
        uses = {
            name: max((use(self.chosen[name], loads[name]), case) for case, loads in self.loads.items())
            for name in self.chosen
            if self.loads
        }
        return sorted(
            ((name, case, greatest_use) for name, (greatest_use, case) in uses.items()), key=lambda entry: -entry[2]
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sizing:
    """Loads of a robot's own servos, and sufficient families of servos that are sold."""

    robot: Robot
    """The robot as it is designed."""
    cases: tuple[LoadCase, ...]
    """What it shall do."""
    designed_loads: Mapping[str, Mapping[str, ServoLoad]]
    """What its own servos bear, by case."""
    families: tuple[ServoFamily, ...]
    """Families, those first that do, the cheapest first."""

    @property
    def best(self) -> ServoFamily | None:
        """The cheapest family that is sufficient at the gaits' own periods; otherwise at longer ones."""
        passing = [family for family in self.families if family.as_asked] or [f for f in self.families if f.passes]
        return passing[0] if passing else None

    @property
    def slower(self) -> ServoFamily | None:
        """A cheaper family that is sufficient at longer periods, if there is one."""
        best = self.best
        cheaper = [f for f in self.families if f.passes and best is not None and sum(f.price) < sum(best.price)]
        return cheaper[0] if cheaper else None


def use(motor: Motor, load: ServoLoad) -> float:
    """Return the greater part of a servo's capability that is used, of torque at its speed or of heat [-]."""
    return max(load.line / FULL_WOUND, load.rms / motor.continuous_torque)


def binding_limit(motor: Motor, load: ServoLoad) -> str:
    """Return the limit that is nearest for a servo: heat, torque or torque at speed."""
    if load.rms / motor.continuous_torque >= load.line / FULL_WOUND:
        return "heat"
    return "torque" if load.torque > 0.9 * motor.stall_torque else "torque at speed"


def families_of(motors: Mapping[str, Motor]) -> dict[str, tuple[float, list[Motor]]]:
    """Return the supply [V] of each family of servos, and its servos, the cheapest first.

    The supply is the greatest nominal voltage of a servo of the family.

    Raises:
        InvalidDesign: a servo of a family does not bear the supply.
    """
    families: dict[str, tuple[float, list[Motor]]] = {}
    for family in dict.fromkeys(motor.family for motor in motors.values()):
        members = sorted(
            (m for m in motors.values() if m.family == family), key=lambda m: (sum(m.price), m.stall_torque)
        )
        volts = max(motor.volts for motor in members)
        for motor in members:
            if not motor.volts_range[0] <= volts <= motor.volts_range[1]:
                raise InvalidDesign(
                    f"family {family!r} has a supply of {volts:g} V, and {motor.name} bears "
                    f"{motor.volts_range[0]:g} to {motor.volts_range[1]:g} V: give it another family."
                )
        families[family] = volts, members
    return families


def places(robot: Robot) -> list[tuple[str, ...]]:
    """Return groups of servos that must be equal: those of left and right limbs of a girdle.

    Linear actuators are left out: no turning servo can replace one.
    """
    linear_cables = {cable.name for cable in robot.cables if cable.linear is not None}
    mirrored = {
        f"{side}{girdle.name}_{hinge.name}": (f"L{girdle.name}_{hinge.name}", f"R{girdle.name}_{hinge.name}")
        for girdle in robot.girdles
        for hinge in girdle.limb.hinges
        for side in "LR"
    }
    return list(
        dict.fromkeys(mirrored.get(name, (name,)) for name in layout(robot).servos if name not in linear_cables)
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkLoad:
    """Mass of the servos that sit on one body, beside the mass that the body has in the simulation."""

    body: str
    """Name of the body."""
    servos: float
    """Mass of its servos [kg]."""
    mass: float
    """Mass of the body with all that is on it, as simulated [kg]."""


def link_masses(robot: Robot) -> Mapping[str, float]:
    """Return the simulated mass of the body on which each servo sits, by the servo's name [kg]."""
    masses = dict(zip([body.name for body in layout(robot).bodies], body_masses(robot)[0].tolist(), strict=True))
    return {name: masses[body] for name, (body, _) in servo_seats(robot).items()}


def link_loads(robot: Robot, motors: Mapping[str, Motor]) -> list[LinkLoad]:
    """Return the mass of servos on each body that carries some, the fullest body first.

    Args:
        robot: the robot; the masses of its bodies hold everything that is on them.
        motors: the servos that are bought, by the names of the robot's.
    """
    masses = link_masses(robot)
    sums: dict[str, float] = {}
    mass_by_body: dict[str, float] = {}
    for name, (body, _) in servo_seats(robot).items():
        if name in motors:
            sums[body] = sums.get(body, 0.0) + motors[name].mass
            mass_by_body[body] = masses[name]
    loads = [LinkLoad(body=body, servos=servos, mass=mass_by_body[body]) for body, servos in sums.items()]
    return sorted(loads, key=lambda load: -load.servos / load.mass)


def with_motors(robot: Robot, motors: Mapping[str, Motor], volts: float) -> Robot:
    """Return a robot with servos that are sold, with the gains and gears of its own servos."""
    servos = {name: Servo.from_motor(motor, volts, template=robot.servo(name)) for name, motor in motors.items()}
    return with_named_servos(robot, servos)


def size(
    robot: Robot,
    load_cases: Sequence[LoadCase],
    *,
    motors: Mapping[str, Motor] | None = None,
    family: str | None = None,
    progress: Progress = silent,
) -> Sizing:
    """Find sufficient servos for a robot, in each family of those that are sold.

    The demand of a movement is measured with servos four times as strong. Of each family the cheapest servos are chosen
    that supply this torque at its speed and bear its heat; one that is heavier than the body on which it sits is none
    of them. Then the robot is simulated with them. A servo that is at its limit for more than 2 % of the time, or too
    warm in the long run, is replaced by the next one, until all are sufficient. A gait that is too fast for a family is
    tried with a longer period. A family whose servos together outweigh a body that carries them does not do.

    Args:
        robot: the robot.
        load_cases: what it shall do.
        motors: the servos that are sold; those that suchus knows if None.
        family: the only one that is looked at.
        progress: told the share that is done.

    Raises:
        UnknownName: there is no such family.
        Diverged: a simulation diverged.
        OutsideLimits: the joints cannot follow a gait.
    """
    families = families_of(shipped() if motors is None else motors)
    if family is not None and family not in families:
        raise UnknownName("family of servos", family, list(families))
    own_loads = loads_of_cases(robot, load_cases, progress=staged(progress, "its own servos", 0.0, 0.3))
    search = _Search(robot, load_cases)
    family_names = [family] if family is not None else list(families)
    candidates = []
    for i, name in enumerate(family_names):
        share = 0.3 + 0.7 * i / len(family_names)
        progress(name, share)
        candidates.append(search.family(name, *families[name]))
    progress("done", 1.0)
    order = sorted(
        candidates, key=lambda candidate: (not candidate.passes, not candidate.as_asked, sum(candidate.price))
    )
    return Sizing(
        robot=robot,
        cases=tuple(load_cases),
        designed_loads=dict(zip([case.name for case in load_cases], own_loads, strict=True)),
        families=tuple(order),
    )


class _Search:
    """Search through families of servos; the demand of each movement is simulated once."""

    def __init__(self, robot: Robot, load_cases: Sequence[LoadCase]) -> None:
        self._robot, self._load_cases, self._places = robot, tuple(load_cases), places(robot)
        self._link_masses = link_masses(robot)
        self._gaits = list(dict.fromkeys(case.gait.name for case in load_cases))
        self._demands: dict[tuple[str, float], xr.Dataset] = {}

    def family(self, name: str, volts: float, motors: Sequence[Motor]) -> ServoFamily:
        """Return the cheapest sufficient servos of a family, with periods as long as necessary."""
        factors = dict.fromkeys(self._gaits, 1.0)
        best_family = ServoFamily(name=name, volts=volts, chosen={}, factors=dict(factors), loads={})
        while True:
            hopeless = self._hopeless(motors, factors)
            if hopeless is not None:
                lacking = self._hopeless(motors, {**factors, hopeless[0]: FACTORS[-1]})
                if lacking is not None:  # nor at the longest period
                    return replace(best_family, lacking=lacking[1], factors=dict(factors))
                shortfall = hopeless
            else:
                best_family, weak = self._simulated(name, volts, motors, factors)
                if weak is None:
                    return self._weighed(best_family)
                shortfall = weak
            gait, lacking_here = shortfall
            longer_factors = [factor for factor in FACTORS if factor > factors[gait]]
            if not longer_factors or not self._can_wait(gait):
                return replace(best_family, lacking=lacking_here, factors=dict(factors))
            factors[gait] = longer_factors[0]

    def _weighed(self, family: ServoFamily) -> ServoFamily:
        """Return a family that does not do where its servos outweigh a body that carries them."""
        fullest = link_loads(self._robot, family.chosen)[:1]
        if not fullest or fullest[0].servos <= fullest[0].mass:
            return family
        (load,) = fullest
        return replace(
            family,
            lacking=(
                f"its servos on {load.body} weigh {1e3 * load.servos:.0f} g, and {load.body} with all that is on it "
                f"{1e3 * load.mass:.0f} g: make {load.body} heavier, or take lighter servos"
            ),
        )

    def is_light(self, motor: Motor, names: Sequence[str]) -> bool:
        """Return whether a servo is no heavier than the body on which it sits, at some places."""
        return all(motor.mass <= self._link_masses[name] for name in names)

    def _can_wait(self, gait: str) -> bool:
        """Return whether a gait may have a longer period: all but swims, whose wave depends on the period."""
        return all(case.lake is None for case in self._load_cases if case.gait.name == gait)

    def _slower_cases(self, factors: Mapping[str, float]) -> list[LoadCase]:
        return [case.slower(factors[case.gait.name]) for case in self._load_cases]

    def demands(self, factors: Mapping[str, float]) -> list[xr.Dataset]:
        """Return the loads of strong servos in each case at a factor on the period; each is simulated once."""
        cases = self._slower_cases(factors)
        keys = [(case.name, factors[case.gait.name]) for case in cases]
        new = [i for i, key in enumerate(keys) if key not in self._demands]
        if new:
            body = with_strong_servos(self._robot)
            records = records_of_each([(body, cases[i]) for i in new], timestep=coarse_step(body))
            self._demands |= {keys[i]: record for i, record in zip(new, records, strict=True)}
        return [self._demands[key] for key in keys]

    def bears(self, motor: Motor, names: Sequence[str], demands: Sequence[xr.Dataset]) -> bool:
        """Return whether a servo supplies the torque at standstill, bears the heat and is light enough, at places."""
        if not self.is_light(motor, names):
            return False
        for demand in demands:
            torque = demand.servo_peak_torque.sel(servo=list(names)).values
            if np.quantile(torque, 1.0 - AT_LIMIT, axis=0).max() > motor.stall_torque:
                return False
            mean_square = demand.servo_mean_square_torque.sel(servo=list(names)).mean("time")
            if float(mean_square.max()) ** 0.5 > motor.continuous_torque:
                return False
        return True

    def fits(self, motor: Motor, volts: float, names: Sequence[str], demands: Sequence[xr.Dataset]) -> bool:
        """Return whether a servo also supplies the torque at its speed, at some places."""
        servo = Servo.from_motor(motor, volts, template=self._robot.servo(names[0]))
        return self.bears(motor, names, demands) and all(
            torque_use(
                servo, demand.servo_mean_torque.sel(servo=name).values, demand.servo_velocity.sel(servo=name).values
            )
            < FULL_WOUND
            for demand in demands
            for name in names
        )

    def _hopeless(self, motors: Sequence[Motor], factors: Mapping[str, float]) -> tuple[str, str] | None:
        """Return the first gait without a servo that bears it, and the reason; None without such a gait."""
        for case, demand in zip(self._slower_cases(factors), self.demands(factors), strict=True):
            for names in self._places:
                if not any(self.bears(motor, names, [demand]) for motor in motors):
                    lightest = min(motors, key=lambda motor: motor.mass)
                    if not self.is_light(lightest, names):
                        return case.gait.name, self._too_heavy(lightest, names)
                    return case.gait.name, self._lacks(names, case, demand)
        return None

    def _too_heavy(self, motor: Motor, names: Sequence[str]) -> str:
        """Return a sentence: the lightest servo of a family is heavier than the body on which it would sit."""
        name = min(names, key=lambda servo: self._link_masses[servo])
        body, _ = servo_seats(self._robot)[name]
        return (
            f"{motor.name} of {name} weighs {1e3 * motor.mass:.0f} g, and {body}, on which it sits, "
            f"{1e3 * self._link_masses[name]:.0f} g with all that is on it: make {body} heavier, or take lighter servos"
        )

    def _lacks(self, names: Sequence[str], case: LoadCase, demand: xr.Dataset) -> str:
        """Return a sentence: no servo of a family is strong enough for some servos in a case."""
        servo_demand = demand.sel(servo=list(names))
        torque, speed = float(servo_demand.servo_peak_torque.max()), float(np.abs(servo_demand.servo_velocity).max())
        rms = float(np.sqrt(servo_demand.servo_mean_square_torque.mean("time")).max())
        return (
            f"none of it is enough for {names[0]} in {case.name} with a period of {case.gait.period:.3g} s, which asks "
            f"for up to {torque:.2f} N m, {rms:.2f} N m root mean square, and {speed:.1f} rad/s"
        )

    def _candidates(self, names: Sequence[str], volts: float, motors: Sequence[Motor], demands: Any) -> list[Motor]:
        """Return the servos to try at some places, the cheapest first: those that fit, else those that bear it."""
        fitting = [motor for motor in motors if self.fits(motor, volts, names, demands)]
        bearing = [motor for motor in motors if self.bears(motor, names, demands)]
        light = [motor for motor in motors if self.is_light(motor, names)] or list(motors)
        return fitting or bearing or [max(light, key=lambda motor: motor.continuous_torque)]

    def _simulated(
        self, name: str, volts: float, motors: Sequence[Motor], factors: Mapping[str, float]
    ) -> tuple[ServoFamily, tuple[str, str] | None]:
        """Return sufficient servos of a family by simulation, or the last ones with the gait that failed."""
        cases, demands = self._slower_cases(factors), self.demands(factors)
        candidates = {names: self._candidates(names, volts, motors, demands) for names in self._places}
        while True:
            chosen_motors = {servo: candidates[names][0] for names in self._places for servo in names}
            body = with_motors(self._robot, chosen_motors, volts)
            records = records_of_each([(cold(body), case) for case in cases])
            loads = {
                case.name: {name: load for name, load in measure_loads(body, record).items() if name in chosen_motors}
                for case, record in zip(cases, records, strict=True)
            }
            family = ServoFamily(name=name, volts=volts, chosen=chosen_motors, factors=dict(factors), loads=loads)
            weak = self._weak(family)
            if not weak:
                return family, None
            at_end = [(names, case) for names, case in weak if len(candidates[names]) < 2]
            if at_end:
                return family, self._shortfall(family, *at_end[0])
            candidates |= {names: candidates[names][1:] for names, _ in weak}

    def _shortfall(self, family: ServoFamily, names: Sequence[str], name: str) -> tuple[str, str]:
        """Return the gait of a case for which the best servo of a family is not sufficient, and the reason."""
        case = next(slower_case for slower_case in self._slower_cases(family.factors) if slower_case.name == name)
        load, motor = family.loads[name][names[0]], family.chosen[names[0]]
        return case.gait.name, (
            f"{motor.name} at {names[0]} is at its limit for {100 * load.at_limit:.0f} % of {name} with a period of "
            f"{case.gait.period:.3g} s, and gives {load.rms:.2f} N m root mean square, where "
            f"{motor.continuous_torque:.2f} N m can be given continuously"
        )

    def _weak(self, family: ServoFamily) -> list[tuple[tuple[str, ...], str]]:
        """Return the places whose servos are not sufficient, each with its most demanding case."""
        weak_places = []
        for names in self._places:
            uses = [
                (use(family.chosen[name], loads[name]), case)
                for case, loads in family.loads.items()
                for name in names
                if not does(family.chosen[name], loads[name])
            ]
            if uses:
                weak_places.append((names, max(uses)[1]))
        return weak_places


def does(motor: Motor, load: ServoLoad) -> bool:
    """Return whether a servo is sufficient: below its limit for 98 % of the time, and never too warm."""
    return load.at_limit <= AT_LIMIT and load.rms <= motor.continuous_torque


def with_better(
    robot: Robot, case: LoadCase, loads: Mapping[str, ServoLoad], motors: Mapping[str, Motor] | None = None
) -> Mapping[str, ServoLoad]:
    """Return loads that name, for each overloaded servo, the cheapest servo that is sufficient.

    Every named servo has been simulated in its position.

    Args:
        robot: the robot.
        case: what it does.
        loads: loads from ``loads_of_cases``.
        motors: the servos that are sold; those that suchus knows if None.
    """
    replaceable = {name for names in places(robot) for name in names}
    weak = [name for name, load in loads.items() if load.at_limit > AT_LIMIT and name in replaceable]
    if not weak:
        return loads
    sold = sorted((shipped() if motors is None else motors).values(), key=lambda motor: sum(motor.price))
    search = _Search(robot, [case])
    (demand,) = search.demands({case.gait.name: 1.0})
    candidates = {
        name: [m for m in sold if m.stall_torque > loads[name].limit and search.fits(m, m.volts, [name], [demand])]
        for name in weak
    }
    while any(candidates.values()):
        trial_motors = {name: options[0] for name, options in candidates.items() if options}
        body = with_named_servos(
            robot, {name: Servo.from_motor(motor, template=robot.servo(name)) for name, motor in trial_motors.items()}
        )
        (record,) = records_of_each([(cold(body), case)])
        then = measure_loads(body, record)
        failing_servos = [name for name, motor in trial_motors.items() if not does(motor, then[name])]
        if not failing_servos:
            replacements = {
                name: replace(loads[name], other=motor.name, other_torque=motor.stall_torque)
                for name, motor in trial_motors.items()
            }
            return {**loads, **replacements}
        candidates |= {name: candidates[name][1:] for name in failing_servos}
    return loads
