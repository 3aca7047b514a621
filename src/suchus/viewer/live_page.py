"""One browser that watches a live walk: its controls, its scene, its plots, its clock."""

from html import escape
from threading import Event
from time import monotonic
from typing import Any

from viser import uplot

from suchus.viewer.controls import Controls
from suchus.viewer.plots import Plots
from suchus.viewer.saving import SavedFile
from suchus.viewer.session import Instant, Session, Settings
from suchus.viewer.stage import WalkScene

FRAME = 1 / 20
"""Time between two pictures [s]."""
DRAWN = 3
"""Frames for one renewal of numbers and track, which cost more to a browser than what merely moves."""
PLOT = 0.3
"""Time between two redraws of the plots [s]."""
IDLE = 900.0
"""After so long without a touch the walk pauses, so that a forgotten window costs nothing [s]."""
_LATE = 0.25  # [s]; a slow machine simulates at most so much at once, and so goes slower than real time


class LivePage:
    """A browser and its own walk.

    Args:
        client: viser's handle of the browser.
        session: the walk.
        idle: after how long without a touch it pauses [s].
    """

    def __init__(self, client: Any, session: Session, *, idle: float = IDLE) -> None:
        self._client, self._session, self._idle = client, session, idle
        self._closed = Event()
        gui = client.gui
        self._status = gui.add_html("")
        self._notice = ""
        self._controls = Controls(gui, session, self._say, self._save)
        with gui.add_folder("Look", expand_by_default=False):
            self._skin = gui.add_checkbox("skin", initial_value=True, hint="Off: the shapes that touch the ground.")
            self._follow = gui.add_checkbox("camera follows", initial_value=True)
            switches = {name: gui.add_checkbox(label, initial_value=True) for name, label in _SHOWN}
        gui.main_panel.dock_right()
        gui.main_panel.set_width(330)
        self._plots = Plots(gui, uplot, session.robot)
        self._stage = WalkScene(client.scene, session.robot)
        self._stage.look("skin")
        self._skin.on_update(lambda _: self._stage.look("skin" if self._skin.value else "collision geoms"))
        self._switches = switches

    def _save(self, file: SavedFile) -> None:
        self._client.send_file_download(file.name, file.content, save_immediately=True)

    def close(self) -> None:
        """End the walk."""
        self._closed.set()

    def run(self) -> None:
        """Walk until closed."""
        before = plotted = monotonic()
        begun, bumps, touched, since = -1, 0.0, (0, 0.0), before
        rate, picture = 1.0, 0
        while not self._closed.is_set():
            start, picture = monotonic(), picture + 1
            passed, before = min(start - before, _LATE), start
            settings = self._session.settings
            if not self._controls.paused:
                self._session.advance(passed * settings.speed)
                late = settings.speed * passed / max(passed, monotonic() - start, 1e-6)
                rate += 0.05 * (late - rate)
            if self._session.begun != begun:
                begun = self._session.begun
                self._stage.forget()
                if settings.bumps != bumps:
                    bumps = settings.bumps
                    self._stage.lay(settings.ground.relief)
            self._draw(self._session.look(), rate, everything=picture % DRAWN == 1)
            if start - plotted > PLOT:
                plotted = start
                self._plots.draw(self._session.table())
            now_touched = self._controls.touched, self._client.camera.update_timestamp
            if now_touched != touched:
                touched, since = now_touched, start
            if start - since > self._idle and not self._controls.paused:
                self._controls.pause(True)
                self._say(f"Paused after {self._idle / 60:.0f} minutes without a touch. Untick pause to go on.")
            self._closed.wait(max(0.005, FRAME - (monotonic() - start)))

    def _draw(self, instant: Instant, rate: float, *, everything: bool) -> None:
        settings = self._session.settings
        self._stage.shown = {name: bool(box.value) for name, box in self._switches.items()}
        with self._client.atomic():
            self._stage.mark(settings.broken)
            if not instant.trouble:
                self._stage.place(instant.now, (settings.uphill, settings.sideways), follow=bool(self._follow.value))
                self._stage.show(instant.now, instant.pushed)
                self._stage.flood(instant.level)
            if everything:
                self._stage.go(instant.now["centre_of_mass"])
                self._status.content = status(
                    instant, settings, rate=rate, notice=self._notice, paused=self._controls.paused
                )

    def _say(self, sentence: str) -> None:
        self._notice = sentence
        if sentence:
            self._client.add_notification("suchus", sentence, auto_close_seconds=7.0, color="yellow")


_SHOWN = (
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
            ("to the left", f"{instant.aside:+.3f} m"),
            *((("under water", f"{float(instant.now['share_under']):.0%}"),) if instant.level is not None else ()),
        )
    )
    said = _box(instant.trouble, "#fdecea", "#a1261b") if instant.trouble else _box(notice, "#fff6dc", "#6b5200")
    failed = ", ".join(f"{fault.part.replace('_', ' ')} {fault.kind().replace('_', ' ')}" for fault in settings.broken)
    return (
        f'<div style="padding:4px 12px;font-family:sans-serif">'
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 12px">{cells}</div>'
        f'<div style="font-size:12px;color:#444" data-suchus="state">{escape(state)}</div>'
        f'<div style="font-size:12px;color:#a1261b" data-suchus="failed">{escape(failed)}</div>{said}</div>'
    )


def _box(text: str, back: str, ink: str) -> str:
    if not text:
        return ""
    return (
        f'<div role="status" data-suchus="notice" style="margin-top:6px;padding:6px 8px;border-radius:4px;'
        f'font-size:12px;background:{back};color:{ink}">{escape(text)}</div>'
    )
