"""One browser that watches a record: a time slider, a robot, perhaps a ghost beside it."""

from collections.abc import Sequence
from html import escape
from typing import Any

from viser import uplot

from suchus.apps.viewer.drawn import DrawnAnimal
from suchus.apps.viewer.knobs import SPEED
from suchus.apps.viewer.live_page import FRAMES_PER_RENEWAL, PLOT_INTERVAL
from suchus.apps.viewer.plots import Plots
from suchus.apps.viewer.replay import FilmedAnimal, Player, Take
from suchus.apps.viewer.server import BrowserPage
from suchus.apps.viewer.stage import WORLD, WalkScene


class ReplayPage(BrowserPage):
    """A browser and its own player of a record.

    Args:
        client: viser's handle of the browser.
        takes: the runs of the record.
        ghosts: the runs of the record for comparison; may be none.
        animals: a filmed animal beside each run, in their order; may be none.
    """

    def __init__(
        self, client: Any, takes: Sequence[Take], ghosts: Sequence[Take] = (), animals: Sequence[FilmedAnimal] = ()
    ) -> None:
        super().__init__(client)
        self._takes = {take.label: take for take in takes}
        self._ghosts = {take.label: take for take in ghosts}
        end = max(take.end for take in (*takes, *ghosts))
        self._animals = {take.label: animal for take, animal in zip(takes, animals, strict=bool(animals))}
        self._drawn_animal: DrawnAnimal | None = None
        self._player = Player(float(takes[0].record.time[0]), end)
        gui = client.gui
        with gui.add_folder("Replay"):
            self._play(gui, end)
        with gui.add_folder("Record"):
            self._run = gui.add_dropdown("run", tuple(self._takes))
            self._ghost = (
                gui.add_dropdown("ghost", tuple(self._ghosts), initial_value=_first_ghost(takes, ghosts))
                if ghosts
                else None
            )
        with gui.add_folder("Look"):
            skin = gui.add_checkbox("skin", initial_value=True, hint="Off: the shapes that touch the ground.")
            self._follow = gui.add_checkbox("camera follows", initial_value=True)
        self._dock()
        self._plots = Plots(gui, uplot, takes[0].robot, has_ghost=bool(ghosts))
        self._stage = WalkScene(client.scene, takes[0].robot)
        if ghosts:
            self._stage.compare(ghosts[0].robot)
        self._stage.show_geometry("skin")
        skin.on_update(lambda _: self._stage.show_geometry("skin" if skin.value else "collision geoms"))
        self._labels: tuple[str, str] = ("", "")
        self._pictures, self._plotted = 0, 0.0

    def _play(self, gui: Any, end: float) -> None:
        """Add the time slider, the pause and the playback speed, and connect them to the player."""
        player = self._player
        self._slider = gui.add_slider("time [s]", min=player.time, max=end, step=0.01, initial_value=player.time)
        paused = gui.add_checkbox("pause", initial_value=False)
        speed = gui.add_slider(str(SPEED), SPEED.low, SPEED.high, SPEED.step, 1.0)

        def seek(event: Any) -> None:
            if event.client is not None:
                player.seek(self._slider.value)

        def faster(_: Any) -> None:
            player.speed, _ = SPEED.clip(speed.value, player.speed)

        def pause(_: Any) -> None:
            player.playing = not paused.value

        self._slider.on_update(seek)
        speed.on_update(faster)
        paused.on_update(pause)

    def draw(self, clock: float, elapsed: float) -> None:
        """Play on, and draw the sample that is due."""
        self._player.advance(elapsed)
        take = self._takes[self._run.value]
        ghost = self._ghosts[self._ghost.value] if self._ghost is not None else None
        labels = (take.label, ghost.label if ghost else "")
        if labels != self._labels:
            self._labels, self._plotted = labels, 0.0
            self._tables = take.table(), ghost.table() if ghost else None
            self._stage.set_relief(take.ground.relief)
            self._draw_animal(take)
            self._stage.draw_track(take.record.centre_of_mass.values[::5])
        self._pictures += 1
        self._show(take, ghost, everything=self._pictures % FRAMES_PER_RENEWAL == 1)
        if clock - self._plotted > PLOT_INTERVAL:
            self._plotted = clock
            self._plots.draw(*self._tables, cursor=self._player.time)

    def _draw_animal(self, take: Take) -> None:
        """Draw the animal that walks beside a run."""
        if take.label in self._animals:
            self._drawn_animal = DrawnAnimal(self._client.scene, f"{WORLD}/animal", self._animals[take.label])

    def _show(self, take: Take, ghost: Take | None, *, everything: bool) -> None:
        """Move robot, water, ghost and animal to the player's time; ``everything`` renews slider and text too."""
        time = self._player.time
        with self._client.atomic():
            state = take.sample_at(time)
            self._stage.set_pose(state, (take.ground.uphill, take.ground.sideways), follow=bool(self._follow.value))
            self._stage.show(state)
            self._stage.flood(take.level(time))
            if ghost is not None and self._stage.ghost is not None:
                self._stage.ghost.show(ghost.sample_at(time))
            if self._drawn_animal is not None:
                self._drawn_animal.show(time)
            if everything:
                self._slider.value = round(time, 2)
                self._status.content = status_text(take, ghost, time, self._animals.get(take.label))


def status_text(take: Take, ghost: Take | None, time: float, animal: FilmedAnimal | None = None) -> str:
    """Return the head of the page as HTML: the displacement of each at this time."""
    rows = []
    for prefix, run in (("", take), ("ghost", ghost)):
        if run is not None:
            displacement = run.sample_at(time)["centre_of_mass"] - run.origin
            rows.append(
                f'<tr><td style="padding-right:14px">{escape(f"{prefix} {run.label}".strip())}</td>'
                f'<td style="padding-right:14px;font-weight:600" data-suchus="forward">{displacement[0]:+.3f} m</td>'
                f'<td style="font-weight:600">{displacement[1]:+.3f} m</td></tr>'
            )
    has_other_ground = ghost is not None and not ghost.ground.looks_like(take.ground)
    note = "<div>The ghost went on other ground, which is not shown.</div>" if has_other_ground else ""
    if animal is not None:
        pace = "" if animal.pace == 1.0 else f" and slowed down by a factor of {animal.pace:.3g}"
        note += f"<div>Beside it: the animal in {escape(animal.label)}, scaled to the robot's length{pace}.</div>"
    return (
        '<div style="padding:4px 12px;font:13px sans-serif"><table><tr style="color:#666;font-size:11px">'
        f'<td data-suchus="time">at {time:.2f} s</td><td>forward</td><td>to the left</td></tr>{"".join(rows)}'
        f"</table>{note}</div>"
    )


def _first_ghost(takes: Sequence[Take], ghosts: Sequence[Take]) -> str:
    """Return the ghost to begin with: of one file with itself, the second run."""
    is_same_record = takes[0].label == ghosts[0].label and len(ghosts) > 1 and takes[0].record.equals(ghosts[0].record)
    return ghosts[1 if is_same_record else 0].label
