"""A policy as a value and as a file: a table of gait parameters over commands, and a small network that corrects it.

The file is an ``.npz`` of plain arrays and texts. It is never unpickled.
"""

import io
import tomllib
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, SuchusError, UnknownName, UnreadableFile, UnsuitedRobot
from suchus.core.files import digest
from suchus.core.reading import check_file, unreadable
from suchus.core.writing import write
from suchus.robot.control.observation import observation_layout
from suchus.robot.design import Robot, layout
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

SUFFIX = ".npz"
"""Ending of the file of a policy."""
MAX_FILE_SIZE = 300_000
"""Size of the file of a policy [byte]."""
FORMAT = 1
"""Version of the layout of the file."""
MAX_SIZE_RATIO = 1.25
"""Greatest ratio of length, and of mass, of a robot to those of the robot of a policy, in either direction [-]."""


class Action(NamedTuple):
    """A parameter of the pattern that a policy sets."""

    unit: str
    """SI unit, ``-`` for none."""
    description: str
    """The quantity, in a clause."""
    neutral: float
    """Value with which the gait is as it stands in the catalog."""
    lower_bound: float
    """Least value."""
    upper_bound: float
    """Greatest value."""
    is_odd: bool = False
    """Whether its sign changes in the mirror image."""
    per_limb: bool = False
    """Whether each limb has one."""


ACTIONS: Mapping[str, Action] = MappingProxyType(
    {
        "rate": Action("-", "frequency over that of the gait", 1.0, 0.0, 4.0),
        "stroke": Action("-", "factor on the strokes of all limbs", 1.0, 0.0, 3.0),
        "asymmetry": Action("-", "share by which left strokes are shorter and right ones longer", 0.0, -2.0, 2.0, True),
        "bend": Action("rad", "steady bend of the trunk, left positive", 0.0, -1.0, 1.0, True),
        "tail": Action("rad", "steady bend of the tail, left positive", 0.0, -1.5, 1.5, True),
        "wave": Action("-", "factor on the wave of the axis", 1.0, 0.0, 2.0),
        "lag": Action("cycle", "phase lag of the axis behind the limbs besides that of the gait", 0.0, -0.5, 0.5),
        "limb_stroke": Action("-", "factor on the stroke of a limb, added to that of all", 0.0, -1.5, 1.5, False, True),
        "limb_lowering": Action("-", "how much lower a foot is, over the limb's reach", 0.0, -0.15, 0.15, False, True),
    }
)
"""Parameters of the pattern that a policy may set, by name."""
AXIS_ACTIONS = ("bend", "tail", "wave", "lag")
"""Those that bend spine and tail."""


@dataclass(frozen=True, slots=True)
class Layer:
    """A layer of a network: the inputs times the weights plus the bias."""

    weights: tuple[tuple[float, ...], ...]
    """Weights, one row for each input [-]."""
    bias: tuple[float, ...]
    """Bias, one number for each output [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replicate:
    """What the same training gave with another seed: all that differs from the policy that it belongs to."""

    seed: int
    """Seed of its training."""
    speeds: tuple[float, ...]
    """Commanded forward speeds of its table [m/s]."""
    turns: tuple[float, ...]
    """Commanded turning rates of its table [rad/s]."""
    table: tuple[tuple[tuple[float, ...], ...], ...]
    """Values of its parameters, as ``Policy.table``."""
    layers: tuple[Layer, ...] = ()
    """Layers of its network; none for the table alone."""
    training: tuple[tuple[str, str], ...] = ()
    """What its training reached."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Policy:
    """What was trained: a gait, a table of its parameters over commands, and a network that corrects them.

    The table is interpolated linearly in the commanded speed and in the size of the commanded turning rate. For a turn
    to the right the odd parameters have the other sign. The network maps an observation to one number of -1 to 1 for
    each column of ``action_columns``; ``spans`` times these are added to what the table says. Hidden layers have the
    activation x / (1 + |x|), which every machine computes to the same bits.
    """

    name: str
    """Name."""
    task: str
    """Task for which it was trained."""
    robot: str
    """Name of the robot for which it was trained."""
    robot_digest: str
    """SHA-256 of that robot's design, its first 16 digits."""
    length: float
    """Length of that robot [m]."""
    mass: float
    """Mass of that robot [kg]."""
    servos: tuple[str, ...]
    """Servos of that robot, in the order of its layout."""
    limbs: tuple[str, ...]
    """Limbs of that robot, in the order of its layout."""
    gait: Gait
    """Gait whose parameters it sets."""
    speeds: tuple[float, ...]
    """Commanded forward speeds of the table, rising [m/s]."""
    turns: tuple[float, ...]
    """Commanded turning rates of the table, rising from 0, left positive [rad/s]."""
    parameters: tuple[str, ...]
    """Names of the parameters of the table, among ``ACTIONS``."""
    table: tuple[tuple[tuple[float, ...], ...], ...]
    """Values of the parameters: a row for each speed, in it one for each turning rate."""
    actions: tuple[str, ...] = ()
    """Names of the parameters that the network corrects, among ``ACTIONS``."""
    spans: tuple[float, ...] = ()
    """Greatest correction of each column of ``action_columns``."""
    readings: tuple[str, ...] = ()
    """Readings of the observation, in the order of their columns; see ``observation.observation_layout``."""
    layers: tuple[Layer, ...] = ()
    """Layers of the network; none for the table alone."""
    is_symmetric: bool = True
    """Whether the network's answer to a mirrored observation is the mirrored answer, by averaging both."""
    decision: float = 0.05
    """Time between two answers of the network [s]."""
    training: tuple[tuple[str, str], ...] = ()
    """Record of the training: what, and its value."""
    replicates: tuple[Replicate, ...] = ()
    """What the same training gave with other seeds."""

    def __post_init__(self) -> None:
        with Checks("policy", self) as check:
            check.number("length", 1e-4, 1e3, "m")
            check.number("mass", 1e-9, 1e6, "kg")
            check.number("decision", 1e-4, 10.0, "s")
            check.rising("speeds", -100.0, 100.0, "m/s")
            check.rising("turns", 0.0, 100.0, "rad/s")
            check.that(self.turns[:1] == (0.0,), f"policy.turns begins with {self.turns[:1]}; 0 rad/s is needed")
            for name in (*self.parameters, *self.actions):
                check.that(name in ACTIONS, f"policy has the parameter {name!r}; {', '.join(ACTIONS)} is allowed")
            shape = (len(self.speeds), len(self.turns), len(self.parameters))
            check.that(_shape(self.table) == shape, f"policy.table has not the shape {shape} of its commands")
            if self.layers:
                check.that(
                    len(self.spans) == len(self.layers[-1].bias) == len(self.action_columns),
                    f"policy.layers answer with {len(self.layers[-1].bias)} numbers and policy.spans has "
                    f"{len(self.spans)}; {len(self.action_columns)} are needed, one for each column of its actions",
                )
                sizes = [len(layer.weights) for layer in self.layers[1:]]
                outputs = [len(layer.bias) for layer in self.layers[:-1]]
                check.that(sizes == outputs, f"policy.layers take {sizes} numbers and are given {outputs}")
        for replicate in self.replicates:
            self._of_replicate(replicate)

    def _of_replicate(self, replicate: Replicate) -> "Policy":
        """Return the policy of another seed.

        Raises:
            InvalidDesign: its table or its layers do not suit this policy.
        """
        record = (*self.training, ("seed", str(replicate.seed)), *replicate.training)
        has_network = bool(replicate.layers)
        return replace(
            self,
            speeds=replicate.speeds,
            turns=replicate.turns,
            table=replicate.table,
            layers=replicate.layers,
            readings=self.readings if has_network else (),
            actions=self.actions if has_network else (),
            spans=self.spans if has_network else (),
            training=tuple(dict(record).items()),
            replicates=(),
        )

    @property
    def seeds(self) -> tuple["Policy", ...]:
        """The policies of all seeds of the training, this one first."""
        return (replace(self, replicates=()), *map(self._of_replicate, self.replicates))

    @property
    def action_columns(self) -> tuple[tuple[str, int], ...]:
        """Action and limb of each output of the network; the limb is -1 for an action of the whole body."""
        return tuple(
            (name, limb)
            for name in self.actions
            for limb in (range(len(self.limbs)) if ACTIONS[name].per_limb else (-1,))
        )

    @property
    def bends_axis(self) -> bool:
        """Whether it may bend spine or tail: by its gait, its table or its network."""
        names = {*self.parameters, *self.actions}
        return not names.isdisjoint(AXIS_ACTIONS) or self.gait != self.gait.without("axis")

    @property
    def max_speed(self) -> float:
        """Greatest commanded speed of its table [m/s]."""
        return self.speeds[-1]

    @property
    def max_turn(self) -> float:
        """Greatest commanded turning rate of its table [rad/s]."""
        return self.turns[-1]

    def check_robot(self, robot: Robot) -> None:
        """Refuse a robot that the policy was not trained for.

        Robots that are built of one design differ a little in mass, and are taken.

        Raises:
            UnsuitedRobot: the robot has other servos, other limbs or another size.
        """
        place = layout(robot)
        named_robot = robot.name if robot.name in ROBOTS else f"FILE.toml, the file of {robot.name}"
        for kind, trained, present in (
            ("limbs", self.limbs, place.limb_names),
            ("servos", self.servos, place.servos),
        ):
            if trained != present:
                missing = [name for name in trained if name not in present]
                extra = [name for name in present if name not in trained]
                difference = (
                    f"lacks {', '.join(missing[:3])}" if missing else f"has {', '.join(extra[:3]) or 'another order'}"
                )
                raise UnsuitedRobot(
                    f"policy {self.name!r} was trained for robot {self.robot!r} with {len(trained)} {kind}; robot "
                    f"{robot.name!r} has {len(present)} and {difference}: train one for it with "
                    f"suchus train {self.task} --robot {named_robot}."
                )
        for quantity, unit, trained_size, size in (
            ("length", "m", self.length, robot.length),
            ("mass", "kg", self.mass, robot.mass),
        ):
            if not 1 / MAX_SIZE_RATIO <= size / trained_size <= MAX_SIZE_RATIO:
                raise UnsuitedRobot(
                    f"policy {self.name!r} was trained for a robot of {trained_size:.3g} {unit} {quantity}; robot "
                    f"{robot.name!r} has {size:.3g} {unit}, and {1 / MAX_SIZE_RATIO:g} to {MAX_SIZE_RATIO:g} times as "
                    f"much is allowed: train one for it with suchus train {self.task} --robot {named_robot}."
                )


def robot_digest(robot: Robot) -> str:
    """Return the first 16 digits of the SHA-256 of a robot's design."""
    return digest({"robot": robot})[:16]


def _shape(table: Any) -> tuple[int, ...]:
    """Return the shape of nested rows; (-1,) where they are ragged."""
    try:
        return np.array(table, dtype=float).shape
    except (TypeError, ValueError):
        return (-1,)


@lru_cache(maxsize=256)
def table_values(policy: Policy) -> Float[np.ndarray, "speed turn action"]:
    """Return the table of a policy with a column for each of ``ACTIONS`` that is no limb's, neutral where it has none.

    The array is read-only.
    """
    names = [name for name, action in ACTIONS.items() if not action.per_limb]
    values = np.array(policy.table, dtype=float).reshape(len(policy.speeds), len(policy.turns), len(policy.parameters))
    rows = np.empty((*values.shape[:2], len(names)))
    for column, name in enumerate(names):
        is_present = name in policy.parameters
        rows[..., column] = values[..., policy.parameters.index(name)] if is_present else ACTIONS[name].neutral
    rows.flags.writeable = False
    return rows


def interpolate(policy: Policy, speed: float, turn: float) -> Float[np.ndarray, " action"]:
    """Return what the table of a policy says of a command: a number for each of ``ACTIONS`` that is no limb's.

    Commands beyond the table are those at its end.

    Args:
        policy: the policy.
        speed: commanded forward speed [m/s].
        turn: commanded turning rate, left positive [rad/s].
    """
    values = table_values(policy)
    along_turn = _interpolate_rows(np.array(policy.turns), np.moveaxis(values, 1, 0), abs(turn))
    result = _interpolate_rows(np.array(policy.speeds), along_turn, speed)
    if turn < 0.0:
        is_odd = np.array([action.is_odd for action in ACTIONS.values() if not action.per_limb])
        result = np.where(is_odd, 0.0 - result, result)
    return result


def _interpolate_rows(nodes: np.ndarray, rows: np.ndarray, value: float) -> np.ndarray:
    """Return the rows of an array, shape (node, ...), interpolated linearly at a value, steady beyond the nodes."""
    if len(nodes) == 1:
        return np.asarray(rows[0])
    index = int(np.clip(np.searchsorted(nodes, value, side="right") - 1, 0, len(nodes) - 2))
    fraction = float(np.clip((value - nodes[index]) / (nodes[index + 1] - nodes[index]), 0.0, 1.0))
    return np.asarray(rows[index] + fraction * (rows[index + 1] - rows[index]))


class Networks:
    """The networks of several runs, each with its own policy; all have the same shapes.

    Args:
        policies: policy of each run.
        robot: robot whose layout the runs share.
    """

    def __init__(self, policies: list[Policy], robot: Robot) -> None:
        self._weights = [
            (
                np.array([policy.layers[i].weights for policy in policies]),
                np.array([policy.layers[i].bias for policy in policies]),
            )
            for i in range(len(policies[0].layers))
        ]
        self._spans = np.array([policy.spans for policy in policies])
        self._is_symmetric = np.array([policy.is_symmetric for policy in policies])[:, None]
        self._observation_mirror = observation_mirror(robot, policies[0].gait, policies[0].readings)
        self._action_mirror = action_mirror(policies[0])

    def answer(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run action"]:
        """Return the correction of each column of ``Policy.action_columns``."""
        rows = observations.astype(float)
        outputs = self._forward(rows)
        columns, signs = self._observation_mirror
        mirrored_outputs = self._forward(rows[:, columns] * signs)
        action_columns, action_signs = self._action_mirror
        mean = 0.5 * (outputs + mirrored_outputs[:, action_columns] * action_signs)
        return np.asarray(self._spans * np.where(self._is_symmetric, mean, outputs))

    def _forward(self, rows: np.ndarray) -> np.ndarray:
        """Return the outputs of the networks, clipped to -1 and 1; sums go over the inputs in their order."""
        for number, (weights, bias) in enumerate(self._weights):
            total = bias.copy()
            for i in range(weights.shape[1]):
                total = total + rows[:, i, None] * weights[:, i]
            rows = total if number == len(self._weights) - 1 else total / (1.0 + np.abs(total))
        return np.clip(rows, -1.0, 1.0)


def servo_mirror(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Return for each servo its mirror image among the servos, and the sign of its angle there.

    The servos of a left and a right limb have the same angles in mirrored postures. A servo that bends or rolls the
    axis changes its sign.
    """
    place = layout(robot)
    images, signs = np.arange(len(place.servos)), np.ones(len(place.servos))
    turns = {hinge.name: hinge.turn for segment in robot.axis for hinge in segment.hinges}
    for limb in place.limbs:
        images[limb.servos] = np.arange(len(place.servos))[place.limbs[limb.contralateral].servos]
    for index, name in enumerate(place.servos):
        if turns.get(name) in ("yaw", "roll") or index in place.cables:
            signs[index] = -1.0
    return images, signs


def mirror_shift(gait: Gait) -> float:
    """Return the phase by which the mirror image of a gait is ahead of the gait: half a cycle, or none [cycle].

    Raises:
        InvalidDesign: the mirror image of the gait is another gait.
    """
    phases = np.array(gait.limb_phases)
    mirrored = phases.reshape(-1, 2)[:, ::-1].ravel()
    for shift in (0.5, 0.0):
        if np.allclose(np.exp(2j * np.pi * (mirrored - phases - shift)), 1.0, atol=1e-6):
            return shift
    raise InvalidDesign(
        f"gait {gait.name!r} is not symmetric: its mirror image has other limb phases: leave symmetry out."
    )


_VECTOR_SIGNS: Mapping[str, tuple[float, ...]] = {
    "upward": (1.0, -1.0, 1.0),
    "ahead": (1.0, -1.0, 1.0),
    "acceleration": (1.0, -1.0, 1.0),
    "goal_direction": (1.0, -1.0, 1.0),
    "angular_velocity": (-1.0, 1.0, -1.0),
    "command": (1.0, -1.0),
    "heading_error": (-1.0,),
}
"""Signs in the mirror image of readings that do not belong to servos or limbs."""
_SIGNED_SERVO_READINGS = ("servo_position", "servo_velocity", "servo_torque", "last_action")
_UNSIGNED_SERVO_READINGS = ("tracking_error", "failure")


def observation_mirror(robot: Robot, gait: Gait, readings: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the columns and signs with which an observation becomes that of the mirrored robot.

    Args:
        robot: the robot.
        gait: gait whose clock is observed.
        readings: names of the readings.
    """
    servo_images, servo_signs = servo_mirror(robot)
    limb_images = np.array([limb.contralateral for limb in layout(robot).limbs], dtype=int)
    columns: list[int] = []
    signs: list[float] = []
    for sense in observation_layout(robot, readings):
        count = sense.columns.stop - sense.columns.start
        images, image_signs = np.arange(count), np.ones(count)
        if sense.name in (*_SIGNED_SERVO_READINGS, *_UNSIGNED_SERVO_READINGS):
            images = servo_images
            image_signs = servo_signs if sense.name in _SIGNED_SERVO_READINGS else image_signs
        elif sense.name == "foot_pressure":
            images = limb_images
        elif sense.name == "clock":
            image_signs = np.full(count, np.cos(2 * np.pi * _shift_or_zero(gait)).round())
        elif sense.name in _VECTOR_SIGNS:
            image_signs = np.array(_VECTOR_SIGNS[sense.name])
        columns += (sense.columns.start + images).tolist()
        signs += image_signs.tolist()
    return np.array(columns, dtype=int), np.array(signs)


def _shift_or_zero(gait: Gait) -> float:
    """Return the phase shift of a mirrored gait: 0.5 without limbs, 0 where it is not symmetric [cycle]."""
    if not gait.limb_phases:
        return 0.5
    try:
        return mirror_shift(gait)
    except InvalidDesign:
        return 0.0


def action_mirror(policy: Policy) -> tuple[np.ndarray, np.ndarray]:
    """Return the columns and signs with which the actions of a policy become those of the mirrored robot.

    Limbs stand in pairs, left before right.
    """
    columns = policy.action_columns
    images = [columns.index((name, limb ^ 1 if limb >= 0 else -1)) for name, limb in columns]
    return np.array(images, dtype=int), np.array([-1.0 if ACTIONS[name].is_odd else 1.0 for name, _ in columns])


_DAMAGED = "{} is damaged, cut, or no .npz: its arrays cannot be read; take another copy, or train the policy again."
_TEXTS = ("name", "task", "robot", "robot_digest")
_ROWS = ("servos", "limbs", "parameters", "actions", "readings")
_NUMBERS = ("length", "mass", "decision")
_ARRAYS = ("speeds", "turns", "spans")


def save_policy(policy: Policy, path: str | Path) -> Path:
    """Write a policy to an ``.npz`` and return the path; equal policies give equal bytes.

    Raises:
        InvalidDesign: the file would be larger than ``MAX_FILE_SIZE``.
        Unwritable: the place cannot be written to, or is taken by something that suchus did not write.
    """
    data = policy_bytes(policy)
    if len(data) > MAX_FILE_SIZE:
        raise InvalidDesign(
            f"the file of policy {policy.name!r} would have {len(data) / 1e6:.2g} MB; {MAX_FILE_SIZE / 1e6:g} MB are "
            "allowed: take a smaller network."
        )
    return write(path, data)


def policy_bytes(policy: Policy) -> bytes:
    """Return the content of the file of a policy."""
    from suchus.robot import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    arrays: dict[str, np.ndarray] = {"format": np.array(FORMAT)}
    arrays |= {name: np.array(getattr(policy, name)) for name in (*_TEXTS, *_NUMBERS)}
    arrays |= {name: np.array(getattr(policy, name), dtype="U") for name in _ROWS}
    arrays |= {name: np.array(getattr(policy, name), dtype=float) for name in _ARRAYS}
    arrays |= {
        "table": np.array(policy.table, dtype=float),
        "gait": np.array(blueprint.render(policy.gait)),
        "is_symmetric": np.array(policy.is_symmetric),
        "training": np.array(policy.training, dtype="U").reshape(-1, 2),
    }
    for i, layer in enumerate(policy.layers):
        arrays |= {f"weights_{i}": np.array(layer.weights, dtype=float), f"bias_{i}": np.array(layer.bias, dtype=float)}
    for number, replicate in enumerate(policy.replicates):
        arrays |= {f"{_REPLICATE}{number}_{name}": array for name, array in _replicate_arrays(replicate).items()}
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, array, allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0)), member.getvalue())
    return content.getvalue()


_REPLICATE = "replicate_"  # begins the names of the arrays of other seeds, followed by a number


def _replicate_arrays(replicate: Replicate) -> dict[str, np.ndarray]:
    """Return the arrays of the policy of another seed by name."""
    arrays = {name: np.array(getattr(replicate, name), dtype=float) for name in ("speeds", "turns", "table")}
    for i, layer in enumerate(replicate.layers):
        arrays |= {f"weights_{i}": np.array(layer.weights, dtype=float), f"bias_{i}": np.array(layer.bias, dtype=float)}
    record = np.array(replicate.training, dtype="U").reshape(-1, 2)
    return {"seed": np.array(replicate.seed), **arrays, "training": record}


def load_policy(path: str | Path) -> Policy:
    """Read a policy from an ``.npz``; nothing in it is unpickled.

    Raises:
        UnreadableFile: there is no such file, it is damaged or too large, holds Python objects, or is no policy.
    """
    path = Path(path)
    check_file(path)
    try:
        if path.stat().st_size > MAX_FILE_SIZE:
            raise UnreadableFile(
                f"{path} has {path.stat().st_size / 1e6:.2g} MB; the file of a policy has {MAX_FILE_SIZE / 1e6:g} MB "
                "at most: give a file that suchus train wrote."
            )
        data = path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from error
    return _parse(_arrays(path, data), path)


_MAX_ARRAY_SIZE = 8 * MAX_FILE_SIZE  # [byte]; of all arrays unpacked


def _arrays(path: Path, data: bytes) -> dict[str, np.ndarray]:
    """Return the arrays of an ``.npz`` by name.

    Raises:
        UnreadableFile: it is damaged, holds Python objects or unpacks to too much.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(member.file_size for member in archive.infolist()) > _MAX_ARRAY_SIZE:
                raise UnreadableFile(f"{path} unpacks to more than {_MAX_ARRAY_SIZE / 1e6:g} MB; a policy has less.")
        with np.load(io.BytesIO(data), allow_pickle=False) as loaded:
            return {name: loaded[name] for name in loaded.files}
    except UnreadableFile:
        raise
    except ValueError as error:
        if "pickle" in str(error) or "Object" in str(error):
            raise UnreadableFile(
                f"{path} holds Python objects, which are never unpickled, since they may run programs: give a file "
                "that suchus train wrote."
            ) from error
        raise UnreadableFile(_DAMAGED.format(path)) from error
    except (zipfile.BadZipFile, OSError, EOFError, KeyError, NotImplementedError, zipfile.LargeZipFile) as error:
        raise UnreadableFile(_DAMAGED.format(path)) from error
    except Exception as error:  # zlib.error and whatever else damaged bytes raise
        raise UnreadableFile(_DAMAGED.format(path)) from error


def _parse(arrays: Mapping[str, np.ndarray], path: Path) -> Policy:
    """Return the policy that arrays describe.

    Raises:
        UnreadableFile: an array is missing, or they describe no policy.
    """
    from suchus.robot import blueprint  # noqa: PLC0415  as above

    needed = ("format", *_TEXTS, *_NUMBERS, *_ROWS, *_ARRAYS, "table", "gait", "is_symmetric", "training")
    missing = [name for name in needed if name not in arrays]
    if missing:
        raise UnreadableFile(
            f"{path} is no policy: it lacks {', '.join(missing[:4])}; give a file that suchus train wrote."
        )
    try:
        if int(arrays["format"]) != FORMAT:
            raise UnreadableFile(
                f"{path} has format {int(arrays['format'])} of a policy; this version of suchus reads {FORMAT}: train "
                "it again, or take the version of suchus that wrote it."
            )
        values: dict[str, Any] = {name: str(arrays[name]) for name in _TEXTS}
        values |= {name: float(arrays[name]) for name in _NUMBERS}
        values |= {name: tuple(map(str, arrays[name].tolist())) for name in _ROWS}
        values |= {name: tuple(_finite(arrays[name]).tolist()) for name in _ARRAYS}
        return Policy(
            **values,
            table=_rows(_finite(arrays["table"])),
            gait=blueprint.parse_table(tomllib.loads(str(arrays["gait"])), Gait, f"the gait of {path.name}"),
            is_symmetric=bool(arrays["is_symmetric"]),
            training=_record(arrays["training"]),
            layers=_layers(arrays),
            replicates=_replicates(arrays),
        )
    except UnreadableFile:
        raise
    except SuchusError as error:
        raise UnreadableFile(f"{path} is no policy: {error}") from error
    except (TypeError, ValueError, KeyError, IndexError) as error:
        raise UnreadableFile(
            f"{path} is no policy: its arrays have other shapes or kinds than those that suchus train writes; give "
            "such a file."
        ) from error


def _record(rows: np.ndarray) -> tuple[tuple[str, str], ...]:
    """Return the record of a training from an array of texts, shape (entry, 2)."""
    return tuple((str(key), str(value)) for key, value in rows.tolist())


def _layers(arrays: Mapping[str, np.ndarray], prefix: str = "") -> tuple[Layer, ...]:
    """Return the layers of a network from the arrays whose names begin with a prefix."""
    count = sum(name.startswith(f"{prefix}weights_") for name in arrays)
    return tuple(
        Layer(_rows(_finite(arrays[f"{prefix}weights_{i}"])), tuple(_finite(arrays[f"{prefix}bias_{i}"]).tolist()))
        for i in range(count)
    )


def _replicates(arrays: Mapping[str, np.ndarray]) -> tuple[Replicate, ...]:
    """Return the policies of other seeds that arrays describe."""
    count = sum(name.startswith(_REPLICATE) and name.endswith("_seed") for name in arrays)
    prefixes = [f"{_REPLICATE}{number}_" for number in range(count)]
    return tuple(
        Replicate(
            seed=int(arrays[f"{prefix}seed"]),
            speeds=tuple(_finite(arrays[f"{prefix}speeds"]).tolist()),
            turns=tuple(_finite(arrays[f"{prefix}turns"]).tolist()),
            table=_rows(_finite(arrays[f"{prefix}table"])),
            layers=_layers(arrays, prefix),
            training=_record(arrays[f"{prefix}training"]),
        )
        for prefix in prefixes
    )


def _finite(array: np.ndarray) -> np.ndarray:
    """Return an array of numbers; refuse one that has others."""
    numbers = np.asarray(array, dtype=float)
    if not np.isfinite(numbers).all():
        raise InvalidDesign("it has numbers that are not finite; train it again, or take another copy.")
    return numbers


def _rows(array: np.ndarray) -> Any:
    """Return an array as nested tuples."""
    return tuple(map(_rows, array)) if array.ndim > 1 else tuple(array.tolist())


def with_training(policy: Policy, **entries: str) -> Policy:
    """Return a policy with further entries of its training record."""
    return replace(policy, training=tuple({**dict(policy.training), **entries}.items()))


def with_replicates(policy: Policy, others: Sequence[Policy], names: Sequence[str]) -> Policy:
    """Return a policy that carries those of other seeds of the same training.

    Args:
        policy: the policy.
        others: policies of other seeds, which differ in table, network and record alone.
        names: entries of their records that are kept.
    """
    replicates = tuple(
        Replicate(
            seed=int(dict(other.training)["seed"]),
            speeds=other.speeds,
            turns=other.turns,
            table=other.table,
            layers=other.layers,
            training=tuple((name, value) for name, value in other.training if name in names),
        )
        for other in others
    )
    actions, spans, readings = next(
        ((each.actions, each.spans, each.readings) for each in (policy, *others) if each.layers), ((), (), ())
    )
    return replace(policy, replicates=replicates, actions=actions, spans=spans, readings=readings)


def check_parameters(names: tuple[str, ...]) -> None:
    """Refuse names that are no actions.

    Raises:
        UnknownName: the message lists those that are.
    """
    for name in names:
        if name not in ACTIONS:
            raise UnknownName("action", name, ACTIONS)
