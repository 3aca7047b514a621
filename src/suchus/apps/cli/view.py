"""``suchus view``: a walk live, or a record played back, in the browser."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from pathlib import Path
from typing import Annotated, Any

import tyro

from suchus.animals.capture import ReadingOptions, read_tracks
from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.word_checks import check_named_once, option_values
from suchus.apps.viewer import Session
from suchus.apps.viewer.replay import FilmedAnimal, Take, place_animal, takes
from suchus.apps.viewer.swim import films, vortex_film
from suchus.core.checks import require
from suchus.core.files import path_exists
from suchus.robot.design import Robot, check_needs
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.policies import POLICIES, policy_of
from suchus.robot.robots import FOREIGN_ENDINGS, ROBOTS
from suchus.swimming.water import swim_of

_LOOPBACK = ("127.0.0.1", "localhost", "::1")


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerOptions:
    """Address and port of the server."""

    host: str = "127.0.0.1"
    """Address to listen on; by default only this computer can look."""
    port: int = 8080
    """Port to listen on; 0 for any that is free."""
    most: int = 4
    """Number of browsers that are served at once, each with a walk or a player of its own, 1 to 64."""

    def __post_init__(self) -> None:
        require("view", "port", self.port, 0, 65535, "")
        require("view", "most", self.most, 1, 64, "browsers")


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewWalkOptions(ServerOptions):
    """Options of ``suchus view`` for a live walk."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that walks."""
    gait: Gait | None = None
    """Gait at the beginning; by default the robot's own."""
    timestep: float | None = None
    """Time step of the physics [s], a whole fraction of the control period; by default half of the period."""
    lake: tyro.conf.FlagCreatePairsOff[bool] = False
    """Let the robot swim in a lake; the floating caiman if no robot is named."""
    policy: str | None = None
    """A trained policy, its name or its file, that two sliders command; its own robot if none is named."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewRecordOptions(ServerOptions):
    """Options of ``suchus view`` for a record."""

    record: Annotated[Path, tyro.conf.Positional]
    """The record.nc of an experiment on land."""
    ghost: Path | None = None
    """Another record, or the same one, shown pale beside it."""
    animal: Path | None = None
    """Tracked keypoints of a walking animal, which walks beside the robot at its size and pace."""
    fps: float | None = None
    """Frames per second of the animal's film [Hz], if its file does not say."""
    robot: Robot | None = None
    """Robot of the record; by default the one that the record names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewSwimOptions(ServerOptions):
    """Options of ``suchus view swim``."""

    record: Annotated[Path, tyro.conf.Positional]
    """The record.nc of the experiment swimming or swim_3d, or of swim_free in a flow."""


def view(words: Sequence[str]) -> int:
    """Serve until interrupted, and return 0.

    Raises:
        SuchusError: the words or a file make no sense, the viewer is not installed, or the port is taken.
    """
    if words[:1] in (["-h"], ["--help"]):
        print(_HELP)
        return 0
    if words[:1] == ["swim"]:
        return _swim(words[1:])
    if words and not words[0].startswith("-") and _is_record(words[0]):
        return _replay(words)
    return _walk(words)


def _is_record(word: str) -> bool:
    """Return whether a word names a record: any file but those of robots."""
    if Path(word).suffix.lower() in (".toml", *FOREIGN_ENDINGS):
        return False
    return word.endswith(".nc") or (path_exists(Path(word)) and word not in ROBOTS)


def _walk(words: Sequence[str]) -> int:
    """Read the options of a live walk, serve it until interrupted, and return 0."""
    description = "A robot walks live in the browser: change its gait, make joints fail, push it."
    positional = list(takewhile(lambda word: not word.startswith("-"), words[:2]))
    check_named_once(positional, ("--robot", "--gait"), words)
    option_words = [
        argument for option, word in zip(("--robot", "--gait"), positional, strict=False) for argument in (option, word)
    ]
    arguments = [*option_words, *words[len(positional) :]]
    options = parse(ViewWalkOptions, "suchus view", arguments, description)
    is_robot_named = bool(positional) or bool(option_values(arguments, "--robot"))
    if options.policy is not None and not is_robot_named:
        options = replace(options, robot=_robot_of(options.policy))
    elif options.lake and not is_robot_named:
        options = replace(options, robot=ROBOTS["floating_caiman"])
    return serve_walk(options)


def _robot_of(policy_word: str) -> Robot:
    """Return the robot for which a policy was trained.

    Raises:
        BadCommand: it is a robot of a file, which has to be named.
    """
    policy = POLICIES.resolve(policy_word)
    if policy.robot not in ROBOTS:
        raise BadCommand(
            f"policy {policy.name!r} was trained for robot {policy.robot!r}, which is not in the catalog: name its "
            f"file, as in suchus view {policy.robot}.toml --policy {policy_word}."
        )
    robot: Robot = ROBOTS[policy.robot]
    return robot


def serve_walk(options: ViewWalkOptions, opened: Callable[[str], object] | None = None) -> int:
    """Let a robot walk in the browser until interrupted, and return 0.

    Args:
        options: who walks, how, and where it is served.
        opened: called with the address once it can be opened.

    Raises:
        SuchusError: the walk cannot be walked, the viewer is not installed, or the port is taken.
    """
    robot, gait = options.robot, options.gait or default_gait(options.robot)
    swim = swim_of(check_needs(robot, ["axis"], "suchus view --lake")) if options.lake else None
    policy = None if options.policy is None else policy_of(robot, options.policy)
    if policy is not None:
        gait = policy.gait
        swim = policy.gait if policy.task == "swim" else swim

    def session() -> Session:
        return Session(robot, gait, timestep=options.timestep, swim=swim, policy=policy)

    session()  # refuses an impossible walk before a browser opens
    pages = pages_of_viewer()
    setting = "in a lake" if options.lake else gait.name
    if policy is not None:
        setting = f"policy {policy.name}"
    return _serve(
        lambda client: pages.LivePage(client, session()), options, f"{robot.name}, {setting}", opened,
        camera=pages.camera(robot),
    )  # fmt: skip


def _replay(words: Sequence[str]) -> int:
    """Read the options of a replay, serve the record until interrupted, and return 0."""
    description = "A record played back in the browser."
    options = parse(ViewRecordOptions, "suchus view", words, description)
    runs = takes(options.record, options.robot)
    ghosts = takes(options.ghost, options.robot) if options.ghost else ()
    animals = _animals(options, runs)
    pages = pages_of_viewer()
    return _serve(lambda client: pages.ReplayPage(client, runs, ghosts, animals), options, options.record.name)


def _animals(options: ViewRecordOptions, runs: Sequence[Take]) -> tuple[FilmedAnimal, ...]:
    """Return the animal beside each run; nothing if none is asked for."""
    if options.animal is None:
        return ()
    tracks = read_tracks(options.animal, ReadingOptions(rate=options.fps))
    return tuple(place_animal(tracks, run) for run in runs)


def _swim(words: Sequence[str]) -> int:
    """Read the options of a swim's replay, serve it in the plane or in space until interrupted, and return 0."""
    description = "Play a swim back in the browser, with vorticity and pressure of the flow, or the vortices around it."
    options = parse(ViewSwimOptions, "suchus view swim", words, description)
    space = vortex_film(options.record)
    if space is not None:
        pages = pages_of_viewer()
        return _serve(
            lambda client: pages.VortexPage(client, space), options, options.record.name, camera=space.camera()
        )
    swims, curves = films(options.record)
    pages = pages_of_viewer()
    return _serve(
        lambda client: pages.SwimPage(client, swims, curves), options, options.record.name, camera=pages.FROM_ABOVE
    )


def pages_of_viewer() -> Any:
    """Return the module of the pages, which needs viser; refuse where viser is not installed."""
    try:
        from suchus.apps.viewer import pages  # noqa: PLC0415  an optional extra, needed here only
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("viser", "mjviser", "trimesh"):
            raise
        raise BadCommand(
            f"suchus view needs the package {error.name}, which is not installed: pip install 'suchus[viewer]'."
        ) from error
    return pages


def _serve(
    page: Callable[[Any], Any],
    address: ServerOptions,
    title: str,
    opened: Callable[[str], object] | None = None,
    **settings: Any,
) -> int:
    """Serve pages until interrupted, and return 0.

    Args:
        page: makes the page of one browser from viser's handle of it.
        address: host, port and number of browsers.
        title: title of the pages, also printed.
        opened: called with the address once it can be opened.
        **settings: further settings of ``Viewer``.
    """
    pages = pages_of_viewer()
    viewer = pages.Viewer(
        page, host=address.host, port=address.port, max_browsers=address.most, title=title, **settings
    )
    try:
        print(f"{title}: open {viewer.url} in a browser; Ctrl-C ends it.", flush=True)
        if address.host not in _LOOPBACK:
            print(
                f"Whoever reaches {address.host} and knows this address can look and meddle; nothing is encrypted.",
                flush=True,
            )
        if opened is not None:
            opened(viewer.url)
        viewer.wait()
    except KeyboardInterrupt:
        print("ended.")
    finally:
        viewer.stop()
    return 0


_HELP = """usage: suchus view [ROBOT] [GAIT] [--lake] [--policy POLICY] [--host HOST] [--port PORT]
       suchus view RECORD.nc [--ghost RECORD2.nc] [--animal TRACKS]
       suchus view swim RECORD.nc

Show in the browser a robot that walks live, a record played back, or a swim with the flow around it: a record of
swimming in the plane from above, one of swim_3d with the surfaces around its vortices, one of swim_free --water slice
or space likewise, with the angles that its joints took.

  ROBOT, GAIT      names that `suchus list` shows, or TOML files; by default caiman and belly_crawl
  RECORD.nc        the record of an experiment, such as out/displacement/record.nc
  --ghost FILE     another record, or the same one, shown half transparent beside it
  --animal TRACKS  tracked keypoints of a walking animal, shown beside the robot at its size and pace
  --fps N          frames per second of the animal's film, if its file does not say
  --robot ROBOT    robot of a record, if `suchus list` does not show the one that the record names
  --lake           the robot swims in a lake, with sliders for the water level and the air in its hull
  --policy POLICY  a trained policy, by name or file, that two sliders command
  --timestep S     time step of the physics of a live walk [s]; 0.005 by default
  --host HOST      address to listen on; 127.0.0.1 by default: only this computer can look
  --port PORT      port to listen on; 8080 by default, 0 for any free port
  --most N         browsers served at once; 4 by default

Each browser has a walk of its own; several do not disturb each other."""
