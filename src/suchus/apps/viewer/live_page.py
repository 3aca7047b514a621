"""One browser that watches a live walk: its controls, its scene, its plots, the files that it saves."""

from collections.abc import Callable
from dataclasses import replace
from html import escape
from time import monotonic
from typing import Any, NamedTuple

from viser import uplot

from suchus.apps.viewer.knobs import Knob, displayed_value, knobs_of
from suchus.apps.viewer.plots import Plots
from suchus.apps.viewer.server import BrowserPage
from suchus.apps.viewer.session import Instant, Session, Settings, Switch, plain_knobs
from suchus.apps.viewer.stage import WalkScene
from suchus.robot.blueprint import render
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS, suits
from suchus.robot.motion import Gait
from suchus.sim.faults import FAULTS, Limp, numbers


class SavedFile(NamedTuple):
    """A file that a browser is given."""

    name: str
    """Name of the file."""
    content: bytes
    """Text of the file, in UTF-8."""


def gait_file(robot: Robot, settings: Settings) -> SavedFile:
    """Return the gait that is walked; one that differs from the built-in gait of its name is called ``NAME_tuned``.

    Args:
        robot: the robot that walks.
        settings: sliders and switches.
    """
    gait = settings.walking_gait(robot)
    if gait.name in GAITS and GAITS[gait.name] != gait:
        gait = replace(gait, name=f"{gait.name}_tuned")
    head = (f"Saved from a live walk of {robot.name}: suchus view {robot.name} {gait.name}.toml",)
    return _file(gait.name, render(gait, head=head))


def robot_file(robot: Robot) -> SavedFile:
    """Return the robot that is watched."""
    return _file(robot.name, render(robot, head=("Saved from a live walk.",)))


def _file(name: str, text: str) -> SavedFile:
    return SavedFile(f"{name}.toml", text.encode("utf-8"))


Say = Callable[[str], None]
"""Shows people a sentence; an empty one is not shown."""

Save = Callable[[SavedFile], None]
"""Gives the browser a file to download."""

_SWITCHES: tuple[tuple[Switch, str, str], ...] = (
    ("spine", "spine bends", "Off: the trunk is straight, as in the article's control group."),
    ("tail", "tail swings on the ground", "Off: the tail is straight and lifted."),
    ("coordination", "feedback: three rules", "Limbs respond to their loads; trunk and tail to what the limbs lack."),
    (
        "heading",
        "feedback: heading loop",
        "Keeps the mean heading of the cycle after it is switched on, by longer strokes on one side.",
    ),
)


class Controls:
    """The panel of controls.

    Args:
        gui: viser's interface of one browser.
        session: the walk.
        say: shows people a sentence.
        save: gives the browser a file to download.
    """

    def __init__(self, gui: Any, session: Session, say: Say, save: Save) -> None:
        self._gui, self._session, self._say = gui, session, say
        self.touch_count = 0
        self._switches: dict[str, Any] = {}
        self._sliders: dict[str, Any] = {}
        self._playback()
        if session.settings.policy is None:
            with gui.add_folder("Conditions and feedback"):
                for switch, label, hint in _SWITCHES:
                    self._add_switch(switch, label, hint)
            with gui.add_folder("Gait"):
                self._gaits()
                for name, knob in knobs_of(session.robot, session.settings.gait).items():
                    self._add_slider(name, knob, self._gait_value, session.tune)
            self._files(save)
        else:
            with gui.add_folder(f"Policy {session.settings.policy.name}"):
                self._add_settings("forward", "turn")
        with gui.add_folder("Break a joint"):
            self._faults()
        with gui.add_folder("Push"):
            self._add_settings("force", "direction", "push_duration")
            self._connect(gui.add_button("push the trunk", color="orange"), lambda _: session.push())
        with gui.add_folder("Ground"):
            self._add_settings("uphill", "sideways", "bumps")
        if session.settings.swim is not None:
            with gui.add_folder("Water"):
                if session.settings.policy is None:
                    self._add_switch("swims", "swims", "Off: it walks, on the ground or against the water.")
                self._add_settings("level", "air_fraction")

    @property
    def paused(self) -> bool:
        """Whether the walk stands still."""
        return bool(self._pause.value)

    def pause(self, is_paused: bool) -> None:
        """Let the walk stand still, or go on."""
        self._pause.value = is_paused

    def _connect(self, handle: Any, act: Callable[[Any], object]) -> None:
        """Call ``act`` when a person moves a control, and show the sentence that ``act`` may return."""

        def on_event(event: Any) -> None:
            """Count a touch, act, and show the sentence that the action returns."""
            if event.client is None:  # the program set the value
                return
            self.touch_count += 1
            answer = act(handle.value)
            if isinstance(answer, str):
                self._say(answer)

        (handle.on_click if hasattr(handle, "on_click") else handle.on_update)(on_event)

    def _playback(self) -> None:
        """Add pause, reset and playback speed."""
        gui = self._gui
        with gui.add_folder("Walk"):
            self._pause = gui.add_checkbox("pause", initial_value=False)
            self._connect(self._pause, lambda _: None)
            self._connect(gui.add_button("reset", hint="Begin anew with everything as it is set."), self._reset)
            self._add_settings("speed")

    def _reset(self, _: object) -> None:
        self._session.reset()
        self._pause.value = False

    def _add_switch(self, name: Switch, label: str, hint: str) -> None:
        """Add a checkbox for a switch of ``Settings``; it shows the state that the session accepted."""
        box = self._gui.add_checkbox(label, initial_value=getattr(self._session.settings, name), hint=hint)

        def act(is_on: object) -> str:
            notice = self._session.switch(name, bool(is_on))
            box.value = getattr(self._session.settings, name)
            return notice

        self._connect(box, act)
        self._switches[name] = box

    def _gaits(self) -> None:
        """Add a menu of the gaits in the catalog that have the same sliders as the present gait."""
        current_gait = self._session.settings.gait
        shelf: dict[str, Gait] = {name: gait for name, gait in GAITS.items() if self._fits(gait)}
        if shelf.get(current_gait.name) != current_gait:
            shelf = {current_gait.name: current_gait, **shelf}
        menu = self._gui.add_dropdown("from the catalog", tuple(shelf), initial_value=current_gait.name)

        def act(gait_name: Any) -> str:
            notice = self._session.set_gait(shelf[gait_name])
            for name in knobs_of(self._session.robot, self._session.settings.gait):
                self._sliders[name].value = self._gait_value(name)
            return notice

        self._connect(menu, act)

    def _files(self, save: Save) -> None:
        """Offer gait and robot as TOML files, which every command takes in the place of a name."""
        gui, session = self._gui, self._session
        with gui.add_folder("Save"):
            gait = gui.add_button("save the gait", hint="A TOML file, with spine and tail as they are switched.")
            self._connect(gait, lambda _: save(gait_file(session.robot, session.settings)))
            robot = gui.add_button("save the robot", hint="A TOML file, to be changed by hand.")
            self._connect(robot, lambda _: save(robot_file(session.robot)))

    def _fits(self, gait: Gait) -> bool:
        """Return whether a gait of the catalog has the same sliders, and the robot can follow it."""
        robot, current_gait = self._session.robot, self._session.settings.gait
        return set(knobs_of(robot, gait)) == set(knobs_of(robot, current_gait)) and suits(robot, gait)

    def _gait_value(self, name: str) -> float:
        return displayed_value(self._session.settings.gait, name)

    def _add_slider(
        self, name: str, knob: Knob, value: Callable[[str], float], turn: Callable[[str, object], str]
    ) -> None:
        """Add a slider that shows the value that the session accepted.

        Args:
            name: name of the number.
            knob: its label, range and step.
            value: returns the number as it is now, in the knob's unit.
            turn: asks for another value; returns a sentence if that is not as asked.
        """
        current = value(name)
        slider = self._gui.add_slider(
            str(knob), min=min(knob.low, current), max=max(knob.high, current), step=knob.step, initial_value=current,
            hint=knob.hint,
        )  # fmt: skip

        def act(target: object) -> str:
            notice = turn(name, target)
            slider.value = value(name)
            return notice

        self._connect(slider, act)
        self._sliders[name] = slider

    def _add_settings(self, *names: str) -> None:
        """Add a slider for each of some numbers of ``Settings``."""
        session = self._session
        knobs = plain_knobs(session.robot, session.settings.policy)
        for name in names:
            self._add_slider(
                name, knobs[name], lambda n: round(getattr(session.settings, n) / knobs[n].scale, 9), session.set_number
            )

    def _faults(self) -> None:
        """Add a menu of joints with buttons that break and repair them, and the other faults in a folder."""
        gui, session = self._gui, self._session
        joint = gui.add_dropdown("joint", Limp.parts(session.robot), initial_value=Limp.parts(session.robot)[0])
        self._connect(gui.add_button("make it limp", color="red"), lambda _: session.break_part(joint.value, "limp"))
        self._connect(gui.add_button("lock it", color="dark"), lambda _: session.break_part(joint.value, "locked"))
        self._connect(gui.add_button("repair it", color="green"), lambda _: session.repair_part(joint.value))
        self._connect(gui.add_button("repair all", color="gray"), lambda _: session.repair_part())
        with gui.add_folder("Other faults", expand_by_default=False):
            self._other_faults()

    def _other_faults(self) -> None:
        """Offer every fault of the catalog, with its part and, where it has one, its number."""
        gui, session = self._gui, self._session
        kinds = tuple(name for name, _ in FAULTS.items() if name not in ("limp", "locked"))
        kind = gui.add_dropdown("fault", kinds, initial_value=kinds[0])
        joint = gui.add_dropdown("part", FAULTS[kinds[0]].parts(session.robot))
        magnitude = gui.add_number("how much", 0.0, step=0.01, hint="In SI units; faults without a number ignore it.")
        duration = gui.add_number("recovers after [s]", 0.0, min=0.0, step=0.1, hint="0: it stays.")
        rate = gui.add_number("spells in a second [1/s]", 0.0, min=0.0, step=0.1, hint="0: it is there all the time.")
        length = gui.add_number("mean length of a spell [s]", 0.2, min=0.001, step=0.05)

        def choose(name: object) -> None:
            joint.options = FAULTS[str(name)].parts(session.robot)
            magnitude.value = next(iter(numbers(FAULTS[str(name)]).values()), 0.0)

        def happen(_: object) -> str:
            fields = list(numbers(FAULTS[kind.value]))[:1]
            parameters = dict.fromkeys(fields, float(magnitude.value))
            if duration.value > 0.0:
                parameters["duration"] = float(duration.value)
            if rate.value > 0.0:
                parameters |= {"rate": float(rate.value), "length": float(length.value)}
            return session.break_part(joint.value, kind.value, **parameters)

        choose(kinds[0])
        self._connect(kind, choose)
        self._connect(gui.add_button("let it happen", color="red"), happen)
        self._connect(gui.add_button("repair this part", color="green"), lambda _: session.repair_part(joint.value))


FRAMES_PER_RENEWAL = 3
"""Frames for one renewal of numbers and track, which cost more to a browser than what merely moves."""
PLOT_INTERVAL = 0.3
"""Time between two redraws of the plots [s]."""
IDLE_TIMEOUT = 900.0
"""Time without a touch after which the walk pauses, so that a forgotten window costs nothing [s]."""
_MAX_STEP = 0.25  # [s]; a slow machine simulates at most so much at once, and so goes slower than real time


class LivePage(BrowserPage):
    """A browser and its own walk.

    Args:
        client: viser's handle of the browser.
        session: the walk.
        idle: after how long without a touch it pauses [s].
    """

    def __init__(self, client: Any, session: Session, *, idle: float = IDLE_TIMEOUT) -> None:
        super().__init__(client)
        self._session, self._idle = session, idle
        gui = client.gui
        self._notice = ""
        self._controls = Controls(gui, session, self._say, self._save)
        with gui.add_folder("Look", expand_by_default=False):
            self._skin = gui.add_checkbox("skin", initial_value=True, hint="Off: the shapes that touch the ground.")
            self._follow = gui.add_checkbox("camera follows", initial_value=True)
            switches = {name: gui.add_checkbox(label, initial_value=True) for name, label in _OVERLAYS}
        self._dock()
        self._plots = Plots(gui, uplot, session.robot)
        self._stage = WalkScene(client.scene, session.robot)
        self._stage.show_geometry("skin")
        self._skin.on_update(lambda _: self._stage.show_geometry("skin" if self._skin.value else "collision geoms"))
        self._switches = switches
        self._rate, self._pictures, self._plotted = 1.0, 0, 0.0
        self._walk_number, self._bumps = -1, 0.0
        self._last_touch, self._touch_time = (-1, 0.0), 0.0

    def _save(self, file: SavedFile) -> None:
        self._client.send_file_download(file.name, file.content, save_immediately=True)

    def draw(self, clock: float, elapsed: float) -> None:
        """Walk on, and draw the instant that is reached."""
        settings, elapsed = self._session.settings, min(elapsed, _MAX_STEP)
        if not self._controls.paused:
            self._session.advance(elapsed * settings.speed)
            rate = settings.speed * elapsed / max(elapsed, monotonic() - clock, 1e-6)
            self._rate += 0.05 * (rate - self._rate)
        if self._session.walk_count != self._walk_number:
            self._walk_number = self._session.walk_count
            self._stage.forget()
            if settings.bumps != self._bumps:
                self._bumps = settings.bumps
                self._stage.set_relief(settings.ground.relief)
        self._pictures += 1
        self._show(self._session.instant(), everything=self._pictures % FRAMES_PER_RENEWAL == 1)
        if clock - self._plotted > PLOT_INTERVAL:
            self._plotted = clock
            self._plots.draw(self._session.table())
        self._pause_if_idle(clock)

    def _pause_if_idle(self, clock: float) -> None:
        """Pause the walk after a long time without a touch."""
        touch = self._controls.touch_count, self._client.camera.update_timestamp
        if touch != self._last_touch:
            self._last_touch, self._touch_time = touch, clock
        if clock - self._touch_time > self._idle and not self._controls.paused:
            self._controls.pause(True)
            self._say(f"Paused after {self._idle / 60:.0f} minutes without a touch. Untick pause to go on.")

    def _show(self, instant: Instant, *, everything: bool) -> None:
        """Move the scene to an instant; ``everything`` renews the track and the numbers too."""
        settings = self._session.settings
        self._stage.visible_overlays = {name: bool(box.value) for name, box in self._switches.items()}
        with self._client.atomic():
            self._stage.mark(self._session.present_faults)
            if not instant.trouble:
                self._stage.set_pose(
                    instant.state, (settings.uphill, settings.sideways), follow=bool(self._follow.value)
                )
                self._stage.show(instant.state, instant.push_force)
                self._stage.flood(instant.level)
            if everything:
                self._stage.extend_track(instant.state["centre_of_mass"])
                self._status.content = status(
                    instant, settings, rate=self._rate, notice=self._notice, paused=self._controls.paused
                )

    def _say(self, sentence: str) -> None:
        self._notice = sentence
        if sentence:
            self._client.add_notification("suchus", sentence, auto_close_seconds=7.0, color="yellow")


_OVERLAYS = (
    ("forces", "forces on the feet"),
    ("support", "support and centre of mass"),
    ("track", "track on the ground"),
)


def status(instant: Instant, settings: Settings, *, rate: float, notice: str, paused: bool) -> str:
    """Return the head of the page as HTML: numbers, failed joints, then trouble or a notice.

    Args:
        instant: what is seen.
        settings: what was chosen.
        rate: playback speed that is reached [-].
        notice: a sentence; may be empty.
        paused: whether the walk stands still.
    """
    moves = "swimming" if settings.swim is not None and settings.swims else "walking"
    state = "paused" if paused else "settling" if instant.time < 1.0 else moves
    if not paused and rate < 0.9 * settings.speed:
        state += f" at {rate:.2f} x real time, as fast as this machine can"
    cells = "".join(
        f'<div style="white-space:nowrap"><div style="font-size:11px;color:#666">{label}</div>'
        f'<div style="font-size:17px;font-weight:600" data-suchus="{label}">{value}</div></div>'
        for label, value in (
            ("time", f"{instant.time:.1f} s"),
            ("forward", f"{instant.forward:+.3f} m"),
            ("to the left", f"{instant.lateral_displacement:+.3f} m"),
            *((("under water", f"{float(instant.state['share_under']):.0%}"),) if instant.level is not None else ()),
        )
    )
    notice_box = _box(instant.trouble, "#fdecea", "#a1261b") if instant.trouble else _box(notice, "#fff6dc", "#6b5200")
    failed = ", ".join(f"{fault.part.replace('_', ' ')} {fault.kind().replace('_', ' ')}" for fault in settings.broken)
    return (
        f'<div style="padding:4px 12px;font-family:sans-serif">'
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 12px">{cells}</div>'
        f'<div style="font-size:12px;color:#444" data-suchus="state">{escape(state)}</div>'
        f'<div style="font-size:12px;color:#a1261b" data-suchus="failed">{escape(failed)}</div>{notice_box}</div>'
    )


def _box(text: str, back: str, ink: str) -> str:
    """Return a sentence as a coloured HTML box; empty without a sentence."""
    if not text:
        return ""
    return (
        f'<div role="status" data-suchus="notice" style="margin-top:6px;padding:6px 8px;border-radius:4px;'
        f'font-size:12px;background:{back};color:{ink}">{escape(text)}</div>'
    )
