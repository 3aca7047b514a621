"""AmphiBot, a swimming robot of seven segments, from the log of its motors: from rest, steady, and coasting."""

import csv
from collections.abc import Mapping
from functools import lru_cache
from importlib import resources
from math import pi, radians

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant, known
from evidence.league.cases._water import BLOCK_HEAD, DENSITY, KnownSwim, form_of, fresh
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs, waters
from suchus.robot.design import Robot
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.scale import swim_servo_for
from suchus.robot.motion import Gait
from suchus.robot.motion.swim import swimming_gait
from suchus.swimming.water import Outline

_LOG = "amphibot_run1_gait.csv"
_JOINTS, _SEGMENTS = 6, 7
_REPOSITORY = f"motor log of run 1 in the public repository FluidsSim/lilytorch (MIT), as contestants/data/{_LOG}"
_PERIOD, _LAG, _LIGHTS = 0.688, 29.3, 0.577  # [s]; [degree] from joint to joint; [m] from the first to the last light
_PITCH = _LIGHTS / (_SEGMENTS - 1)


def _log() -> list[dict[str, float]]:
    text = (resources.files("evidence.league.cases") / "data" / _LOG).read_text(encoding="utf-8")
    return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(text.splitlines())]


def _given() -> dict[str, Given]:
    found = {
        "period": Given(value=_PERIOD, low=0.686, high=0.690, unit="s", source=_REPOSITORY),
        "lag": Given(value=radians(_LAG), low=radians(28.5), high=radians(30.1), unit="rad", source=_REPOSITORY),
        "pitch": Given(
            value=_PITCH, low=0.093, high=0.099, unit="m",
            source="0.577 m between the first and the last of 13 lights (the same repository): one on each of seven "
            "segments and one on each of six joints, half a segment apart; AmphiBot's segments have 95 mm",
        ),
        "height": Given(
            value=0.056, low=0.053, high=0.060, unit="m",
            source="segments 56 mm high of the public model of the same laboratory's robots, as robots/swimmer.py",
        ),
        "width": Given(
            value=0.042, low=0.038, high=0.052, unit="m",
            source="segments 40 mm wide of the same model; its corners are rounded, and those of an ellipse more",
        ),
        "afloat": Given(
            value=0.95, low=0.90, high=0.99, unit="-",
            source="mass over that of the water displaced: it swims at the surface; how deep is not published",
        ),
        "ramp": Given(
            value=0.5, low=0.1, high=1.0, unit="cycle",
            source="part of the first period in which the motion grows: the log begins when it has grown",
        ),
    }  # fmt: skip
    for i, row in enumerate(_log(), start=1):
        half = 0.5 * radians(row["measured_max_deg"] - row["measured_min_deg"])
        step = radians(0.67) / 2.0
        found[f"amplitude_{i}"] = Given(value=half, low=half - step, high=half + step, unit="rad", source=_REPOSITORY)
    return found


@lru_cache(maxsize=128)
def _body(pitch: float, height: float, width: float, density: float) -> Drawing:
    length = _SEGMENTS * pitch
    wide, high, round_off = 0.5 * width / length, 0.5 * height / length, 0.03
    return Drawing(
        name="amphibot",
        length=length,
        mass=density * 3.1416 / 4.0 * width * height * length,
        density=density,
        stations=(0.0, round_off, 1.0 - round_off, 1.0),
        half_width=(0.6 * wide, wide, wide, 0.8 * wide),
        half_height=(0.6 * high, high, high, 0.8 * high),
        joints=tuple((i + 1) / _SEGMENTS for i in range(_JOINTS)),
    )


def _robot(numbers: Numbers) -> Robot:
    drawing = _body(numbers["pitch"], numbers["height"], numbers["width"], numbers["afloat"] * numbers["density"])
    return drawing.robot(swim_servo_for(drawing.mass, drawing.length, 1.0 / _PERIOD))


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the robot with its log's gait."""
    del frequency
    robot = _robot(numbers)
    return ModelSwimmer(
        robot=robot, gait=_gait(robot, numbers), water=waters(numbers), form=form_of(numbers),
        added_mass=numbers["added_mass"], ramp=numbers["ramp"],
    )  # fmt: skip


def _gait(robot, numbers: Numbers) -> Gait:  # type: ignore[no-untyped-def]
    outline = Outline(robot)
    number = [round(float(outline.joint_positions[servo.joints[0]]) / numbers["pitch"]) for servo in outline.servos]
    return swimming_gait(
        robot,
        name="amphibot_run1",
        frequency=1.0 / numbers["period"],
        amplitude=[numbers[f"amplitude_{i}"] for i in number],
        lag=[(i - 1) * numbers["lag"] / 6.283185307179586 for i in number],
    )


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return speeds and coasting of a swim."""
    del numbers, swimmer
    found: dict[str, float | tuple[float, ...]] = {"steady_speed": swum.speed, "first_periods": swum.periods[:4]}
    return found | ({"coast_down": swum.coast} if swum.coast == swum.coast else {})


def _water(given: Mapping[str, Given]) -> dict[str, Given]:
    """Return the numbers of its water: a head and blocks with rounded edges, a lag that makes a wave of its own length.

    Args:
        given: numbers of body and gait.
    """
    numbers = {name: number.value for name, number in given.items()} | {"density": DENSITY}
    robot = _robot(numbers)
    wavelength = 2.0 * pi / numbers["lag"] / _SEGMENTS
    return fresh(KnownSwim(robot=robot, gait=_gait(robot, numbers), wavelength=wavelength, head=BLOCK_HEAD))


contestant = SingleContestant(
    Contestant(
        name="amphibot",
        title="AmphiBot swims from rest, steadily, and coasts",
        description="A limbless robot of the EPFL, seven segments and six yaw joints, at the surface of still fresh "
        "water, free. "
        "The angles of its joints are those that its motors reported: period 0.688 s, 29.3 degrees of lag from "
        "joint to "
        "joint, amplitudes of 27 to 30 degrees.",
        inputs=_given() | _water(_given()) | {"joints": known(float(_JOINTS), "-", _REPOSITORY)},
        predicts={
            "steady_speed": Quantity(unit="m/s", words="steady speed along its path"),
            "first_periods": Quantity(unit="m/s", words="mean speed in each of the first four periods from rest"),
            "coast_down": Quantity(unit="1/m", words="k in dU/dt = -k U^2, its motors holding their posture"),
        },
        rungs=rungs(SwimTask(build=build, read_quantities=read, cycles=12, coasts=True)),
    )
)
