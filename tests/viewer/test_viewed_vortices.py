"""A swim in three dimensions in the viewer: surfaces at a chosen Q, what is refused, and the page's frames."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from tests.wakes import CORE, RADIUS, ringed

from suchus.apps.cli import main
from suchus.apps.viewer import swim
from suchus.apps.viewer.swim import VortexFilm, vortex_film
from suchus.core.errors import IncompatibleRecord
from suchus.core.files import save


@pytest.mark.parametrize(("level", "lower"), [(2.0, False), (4.0, True), (6.0, False)])
def test_the_surface_lies_where_the_field_has_the_chosen_value(level, lower):
    film = VortexFilm(ringed())
    points = film.surfaces(1, level, lower_half_only=lower).vertices
    off = np.hypot(np.hypot(points[:, 1], points[:, 2]) - RADIUS, points[:, 0] - 0.6)
    assert off == pytest.approx(CORE * (2.0 - level / film.level), abs=0.004)
    assert (points[:, 2].max() > 0.1) != lower
    assert points[:, 2].min() < -0.1


@pytest.mark.parametrize(("asked", "found"), [(0.1, 1.2), (1.3, 1.3), (15.9, 15.9), (17.0, 16.0), (float("nan"), 4.0)])
def test_a_value_outside_what_was_kept_is_set_to_the_nearest(asked, found):
    assert VortexFilm(ringed()).clip_level(asked) == pytest.approx(found)


def test_large_surfaces_are_taken_of_blocks(monkeypatch):
    film = VortexFilm(ringed())
    fine = len(film.surfaces(2, 4.0).vertices)
    monkeypatch.setattr(swim, "MAX_POINTS", fine // 2)
    assert film.blocks(4.0) == 1
    monkeypatch.setattr(swim, "MAX_POINTS", fine // 2 - 1)
    assert film.blocks(4.0) == 2
    monkeypatch.setattr(swim, "MAX_POINTS", 1)
    assert film.blocks(4.0) == 4


def test_a_record_on_disk_is_recognised_by_its_vortices(tmp_path):
    film = vortex_film(save(ringed(), tmp_path / "swim.nc"))
    assert film is not None
    assert film.phase == pytest.approx([1 / 3, 2 / 3, 1.0])
    assert film.description() == "64 cells a length, f L² / ν = 7000"
    assert vortex_film(save(ringed().drop_vars("vortices"), tmp_path / "plane.nc")) is None


def test_courses_of_the_experiment_are_plotted():
    share = np.array([[0.1, 0.2], [0.3, 0.6], [0.5, 1.0]])
    record = ringed().assign(
        speed=(("grid", "cycle"), [[0.01, 0.02]]),
        servo_torque=(("moment", "servo"), share * [2.0, 4.0]),
        servo_limit=("servo", [2.0, 4.0]),
    ).assign_coords(cycle=[1, 2], servo=["front", "back"], moment=[1.0, 1.5, 2.0])  # fmt: skip
    speed, torque = VortexFilm(record).curves()
    assert list(speed.lines) == ["64 cells a length"]
    assert torque.lines["back"] == pytest.approx(share[:, 1])
    assert VortexFilm(ringed()).curves() == ()


@pytest.mark.parametrize(
    ("cable", "title", "shown"),
    [
        (["a", "b", "c", "d"], "angle [degrees] of joints of one cable, from rest", ["a", "c", "d"]),
        ([], "angle [degrees] of joints, from rest", ["b", "d"]),  # those that move
    ],
)
def test_what_the_joints_took_in_a_flow_is_plotted(cable, title, shown):
    """Also of a body without a cable, and in the plane."""
    angles = np.outer([0.0, 0.1, 0.2], [0.0 if not cable else 3.0, 1.0, 0.0 if not cable else 2.0, -1.0])[None]
    record = ringed().assign(
        flow_joint_angle=(("flow_run", "flow_time", "joint"), angles),
        coupling_residual=(("flow_run", "flow_time"), [[0.3, 0.01, 0.002]]),
    ).assign_coords(flow_run=["whole"], flow_time=[0.0, 0.1, 0.2], joint=list("abcd"))  # fmt: skip
    record = record.assign_attrs(cable=cable)
    bends, left = VortexFilm(record).curves()
    assert (bends.title, list(bends.lines)) == (title, shown)
    assert bends.lines["d"] == pytest.approx(np.degrees([0.0, -0.1, -0.2]))
    assert left.lines["left over"] == pytest.approx([0.3, 0.01, 0.002])


def nan_line(record):
    return record.assign(film_x=record.film_x.where(record.film_x > 0.5))


WRONG = {
    "has no spin": lambda r: r.drop_vars("spin"),
    "has no film_y, film_heading": lambda r: r.drop_vars(["film_y", "film_heading"]),
    "has no frame": lambda r: r.isel(frame=slice(0)),
    "holds film_x in another form": nan_line,
    "holds spin in another form": lambda r: r.assign(spin=r.spin.transpose("frame", "x", "y", "z")),
    "holds vortex_unit in another form": lambda r: r.assign(vortex_unit=0.0),
    "holds x in another form": lambda r: r.assign_coords(x=r.x.astype(str)),
    "holds half_height in another form": lambda r: r.assign(half_height=("pair", [0.1, 0.2])),
    "holds places or sizes in another form": lambda r: r.isel(z=slice(1)),
    "holds places or sizes in another": lambda r: r.drop_vars("z"),
}


@pytest.mark.parametrize("said", WRONG)
def test_a_record_that_lacks_or_garbles_something_is_refused(said):
    with pytest.raises(IncompatibleRecord, match=f"wake.nc {said}"):
        VortexFilm(WRONG[said](ringed()), "wake.nc")


def test_the_command_refuses_it_in_a_sentence(tmp_path, capsys):
    path = save(ringed().drop_vars("spin"), tmp_path / "swim.nc")
    assert main(["view", "swim", str(path)]) == 2
    told = capsys.readouterr().err
    assert "swim.nc has no spin: only swims in three dimensions" in told
    assert told.count("\n") == 1


@pytest.fixture
def page():
    """The page of a browser that takes everything and shows nothing."""
    pages = pytest.importorskip("suchus.apps.viewer.pages", reason="the extra viewer is not installed")
    gui = MagicMock()
    gui.add_slider.side_effect = lambda *words, **_: SimpleNamespace(value=words[4], on_update=lambda act: None)
    gui.add_checkbox.side_effect = lambda _, initial_value: SimpleNamespace(value=initial_value)
    gui.add_dropdown.side_effect = lambda _, options, **__: SimpleNamespace(value=options[0])
    scene = MagicMock()
    scene.add_mesh_trimesh.side_effect = lambda *_, **__: MagicMock(visible=True)
    return pages.VortexPage(SimpleNamespace(gui=gui, scene=scene, atomic=MagicMock()), VortexFilm(ringed()))


def test_steps_pause_go_round_and_show_one_frame_at_a_time(page):
    page.show()
    for step, frame in ((1, 1), (1, 2), (1, 0), (-1, 2)):
        page.step(step)
        page.show()
        assert page._pause.value
        assert page.frame == frame
        assert page._frame.value == frame + 1
        assert [number for number, surface in page._surfaces.items() if surface.visible] == [frame]
    assert page._client.scene.add_mesh_trimesh.call_count == 3  # what was shown once is kept


def test_the_body_moves_with_the_frames(page):
    page._film.record.film_y[2] += 0.1
    page.step(2)
    page.show()
    assert page._body.vertices == pytest.approx(page._film.body(2).vertices, abs=1e-6)
    assert page._body.vertices[:, 1].mean() == pytest.approx(0.1, abs=1e-6)


def test_another_value_of_q_takes_the_old_surfaces_away(page):
    page.show()
    old = dict(page._surfaces)
    page._level.value = 6.0
    page.show()
    old[0].remove.assert_called_once()
    assert "Q = 6 1/s²" in page._status.content
    made = page._client.scene.add_mesh_trimesh.call_args.args[1]
    assert np.ptp(made.vertices[:, 0]) == pytest.approx(2 * CORE * (2.0 - 6.0 / 4.0), abs=0.01)
    page._halves.value = "none"
    page.show()
    assert page._surfaces == {}


def test_colours_of_the_surfaces_are_those_of_the_bar(page):
    page.show()
    made = page._client.scene.add_mesh_trimesh.call_args.args[1]
    linear = made.visual.vertex_attributes["color"][:, :3] / 255.0
    mesh = page._film.surfaces(0, 4.0)
    assert 12.92 * np.minimum(linear, 0.0031308) + np.maximum(
        0.0, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055 - 12.92 * 0.0031308
    ) == pytest.approx(mesh.colours, abs=0.03)
    red = mesh.colours[:, 0] > mesh.colours[:, 2] + 0.3
    assert mesh.vertices[red, 1].min() > 0.0  # the ring turns counter-clockwise there
