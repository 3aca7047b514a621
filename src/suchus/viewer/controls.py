"""The controls of a live walk: what people turn, press and switch in the browser, passed on to the session."""

from collections.abc import Callable
from typing import Any

from suchus.faults import FAULTS, Limp, numbers
from suchus.gaits import GAITS, suits
from suchus.motion import Gait
from suchus.viewer.knobs import Knob, knobs_of, shown
from suchus.viewer.saving import SavedFile, gait_file, robot_file
from suchus.viewer.session import Session, Switch, plain_knobs

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
        "Keeps the heading at which it is switched on, by longer strokes on one side.",
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
        self.touched = 0
        self._switches: dict[str, Any] = {}
        self._sliders: dict[str, Any] = {}
        self._turned: list[str] = []
        self._playback()
        with gui.add_folder("Conditions and feedback"):
            for switch, label, hint in _SWITCHES:
                self._add_switch(switch, label, hint)
        with gui.add_folder("Gait"):
            self._gaits()
            for name, knob in knobs_of(session.robot, session.settings.gait).items():
                self._add_gait_slider(name, knob)
        self._files(save)
        knobs = plain_knobs(session.robot)
        with gui.add_folder("Break a joint"):
            self._faults()
        with gui.add_folder("Push"):
            for name in ("force", "direction", "push_duration"):
                self._add_slider(name, knobs[name])
            self._on(gui.add_button("push the trunk", color="orange"), lambda _: session.push())
        with gui.add_folder("Ground"):
            for name in ("uphill", "sideways", "bumps"):
                self._add_slider(name, knobs[name])
        if session.settings.swim is not None:
            with gui.add_folder("Water"):
                self._add_switch("swims", "swims", "Off: it walks, on the ground or against the water.")
                for name in ("level", "air_fraction"):
                    self._add_slider(name, knobs[name])

    @property
    def paused(self) -> bool:
        """Whether the walk stands still."""
        return bool(self._pause.value)

    def pause(self, on: bool) -> None:
        """Let the walk stand still, or go on."""
        self._pause.value = on

    def _on(self, handle: Any, act: Callable[[Any], object]) -> None:
        """Let a control act, when a person moves it; what ``act`` returns is shown where it is a sentence."""

        def moved(event: Any) -> None:
            if event.client is None:  # set by ourselves
                return
            self.touched += 1
            answer = act(handle.value)
            if isinstance(answer, str):
                self._say(answer)

        (handle.on_click if hasattr(handle, "on_click") else handle.on_update)(moved)

    def _playback(self) -> None:
        gui = self._gui
        with gui.add_folder("Walk"):
            self._pause = gui.add_checkbox("pause", initial_value=False)
            self._on(self._pause, lambda _: None)
            self._on(gui.add_button("reset", hint="Begin anew with everything as it is set."), self._reset)
            self._add_slider("speed", plain_knobs(self._session.robot)["speed"])

    def _reset(self, _: object) -> None:
        self._session.reset()
        self._pause.value = False

    def _add_switch(self, name: Switch, label: str, hint: str) -> None:
        box = self._gui.add_checkbox(label, initial_value=getattr(self._session.settings, name), hint=hint)

        def act(on: object) -> str:
            notice = self._session.switch(name, bool(on))
            box.value = getattr(self._session.settings, name)
            return notice

        self._on(box, act)
        self._switches[name] = box

    def _gaits(self) -> None:
        mine = self._session.settings.gait
        shelf: dict[str, Gait] = {name: gait for name, gait in GAITS.items() if self._fits(gait)}
        if shelf.get(mine.name) != mine:
            shelf = {mine.name: mine, **shelf}
        menu = self._gui.add_dropdown("from the shelf", tuple(shelf), initial_value=mine.name)

        def act(name: Any) -> str:
            notice = self._session.adopt(shelf[name])
            for field in self._turned:
                self._sliders[field].value = shown(self._session.settings.gait, field)
            return notice

        self._on(menu, act)

    def _files(self, save: Save) -> None:
        """Offer gait and robot as TOML files, which every command takes in the place of a name."""
        gui, session = self._gui, self._session
        with gui.add_folder("Save"):
            gait = gui.add_button("save the gait", hint="A TOML file, with spine and tail as they are switched.")
            self._on(gait, lambda _: save(gait_file(session.robot, session.settings)))
            robot = gui.add_button("save the robot", hint="A TOML file, to be changed by hand.")
            self._on(robot, lambda _: save(robot_file(session.robot)))

    def _fits(self, gait: Gait) -> bool:
        """Return whether a gait of the shelf has the same sliders, and the robot can follow it."""
        robot, mine = self._session.robot, self._session.settings.gait
        return set(knobs_of(robot, gait)) == set(knobs_of(robot, mine)) and suits(robot, gait)

    def _add_gait_slider(self, name: str, knob: Knob) -> None:
        self._turned.append(name)
        now = shown(self._session.settings.gait, name)
        slider = self._slider(knob, now)

        def act(value: object) -> str:
            notice = self._session.tune(name, value)
            slider.value = shown(self._session.settings.gait, name)
            return notice

        self._on(slider, act)
        self._sliders[name] = slider

    def _add_slider(self, name: str, knob: Knob) -> None:
        slider = self._slider(knob, round(getattr(self._session.settings, name) / knob.scale, 9))

        def act(value: object) -> str:
            notice = self._session.put(name, value)
            slider.value = round(getattr(self._session.settings, name) / knob.scale, 9)
            return notice

        self._on(slider, act)
        self._sliders[name] = slider

    def _slider(self, knob: Knob, now: float) -> Any:
        return self._gui.add_slider(
            str(knob),
            min=min(knob.low, now),
            max=max(knob.high, now),
            step=knob.step,
            initial_value=now,
            hint=knob.hint,
        )

    def _faults(self) -> None:
        gui, session = self._gui, self._session
        joint = gui.add_dropdown("joint", Limp.parts(session.robot), initial_value=Limp.parts(session.robot)[0])
        self._on(gui.add_button("make it limp", color="red"), lambda _: session.lose(joint.value, "limp"))
        self._on(gui.add_button("lock it", color="dark"), lambda _: session.lose(joint.value, "locked"))
        self._on(gui.add_button("repair it", color="green"), lambda _: session.mend(joint.value))
        self._on(gui.add_button("repair all", color="gray"), lambda _: session.mend())
        with gui.add_folder("Other faults", expand_by_default=False):
            self._other_faults()

    def _other_faults(self) -> None:
        """Offer every fault of the shelf, with its part and, where it has one, its number."""
        gui, session = self._gui, self._session
        kinds = tuple(name for name, _ in FAULTS.items() if name not in ("limp", "locked"))
        kind = gui.add_dropdown("fault", kinds, initial_value=kinds[0])
        part = gui.add_dropdown("part", FAULTS[kinds[0]].parts(session.robot))
        much = gui.add_number("how much", 0.0, step=0.01, hint="In SI units; faults without a number ignore it.")

        def choose(name: object) -> None:
            part.options = FAULTS[str(name)].parts(session.robot)
            much.value = next(iter(numbers(FAULTS[str(name)]).values()), 0.0)

        def happen(_: object) -> str:
            fields = list(numbers(FAULTS[kind.value]))[:1]
            return session.lose(part.value, kind.value, **dict.fromkeys(fields, float(much.value)))

        choose(kinds[0])
        self._on(kind, choose)
        self._on(gui.add_button("let it happen", color="red"), happen)
        self._on(gui.add_button("repair this part", color="green"), lambda _: session.mend(part.value))
