import flow_cases as cases
import numpy as np
import pytest
from flow_cases import eel_setup, still_setup

from suchus import flow
from suchus.core.errors import Diverged, InvalidDesign, OutsideLimits, UnreadableFile
from suchus.flow.body import window_of
from suchus.flow.compiled import PAD
from suchus.flow.setup import MIN_LAYER_CELLS
from suchus.flow.simulation import LAYER_SPEED_FACTOR


@pytest.mark.parametrize(
    "precision", ["single", pytest.param("double", marks=pytest.mark.slow("the second precision"))]
)
def test_taylor_green_decays_at_second_order(precision):
    coarse, fine = (cases.taylor_green(n, until=0.25, precision=precision) for n in (64, 128))
    assert np.log2(coarse / fine) > 1.8
    assert fine < 2e-3


def test_moving_body_in_still_water_equals_still_body_in_a_stream():
    grid = flow.Grid.covering((-3.5, 3.0), (-2.0, 2.0), cell=1 / 16)
    settings = {"grid": grid, "viscosity": 0.025, "density": 1.0, "step": 0.01}
    still = flow.Simulation(
        flow.Setup(stream=(1.0, 0.0), bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0)),), **settings)
    )
    moving = flow.Simulation(
        flow.Setup(
            bodies=(
                flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Glide(start=(0.0, 0.0), velocity=(-1.0, 0.0))),
            ),
            **settings,
        )
    )
    a, b = still.run(1.5, progress=False), moving.run(1.5, progress=False)
    late = a.time > 0.5
    assert b.force()[late, 0] == pytest.approx(a.force()[late, 0], rel=0.05)
    assert np.mean(b.force()[late, 0]) == pytest.approx(np.mean(a.force()[late, 0]), rel=0.02)


def test_a_frame_that_follows_the_body_changes_nothing():
    settings = {
        "viscosity": 0.025,
        "density": 1.0,
        "step": 0.01,
        "grid": flow.Grid.covering((-2.0, 4.0), (-2.0, 2.0), cell=1 / 16),
    }
    still = flow.Simulation(
        flow.Setup(stream=(1.0, 0.0), bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0)),), **settings)
    )
    glide = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Glide(start=(0.0, 0.0), velocity=(-1.0, 0.0)))
    followed = flow.Simulation(flow.Setup(bodies=(glide,), follow="body", **settings))
    a, b = still.run(0.6, progress=False), followed.run(0.6, progress=False)
    assert b.force() == pytest.approx(a.force(), rel=1e-3, abs=1e-3)
    assert b.column("x")[-1] == pytest.approx(-0.6)


def test_a_frame_that_follows_a_shaking_body_sees_the_same_forces():
    """The frame accelerates; its own inertia must not press on the body."""
    shaking = flow.Body(
        shape=flow.Cylinder(diameter=1.0), motion=flow.Oscillation(frequency=1.0, heave=(0.1, 0.0), phase=np.pi / 2)
    )
    settings = {
        "viscosity": 0.025,
        "density": 1.0,
        "step": 0.0125,
        "grid": flow.Grid.covering((-4.0, 4.0), (-4.0, 4.0), cell=1 / 16),
        "bodies": (shaking,),
    }
    still, followed = flow.Simulation(flow.Setup(**settings)), flow.Simulation(flow.Setup(follow="body", **settings))
    a, b = still.run(0.8, progress=False).force()[:, 0], followed.run(0.8, progress=False).force()[:, 0]
    assert np.ptp(a) > 2
    assert np.abs(a - b).max() < 0.06 * np.ptp(a)


def test_channel_flow_keeps_its_parabola():
    n = 32
    grid = flow.Grid(cells=(2 * n, n), cell=1 / n)
    sides = flow.Sides(
        left=flow.Inflow(profile=lambda y: 6 * y * (1 - y)), right=flow.Outflow(), bottom=flow.Wall(), top=flow.Wall()
    )
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.1, sides=sides))
    sim.run(2.0, progress=False)
    y = grid.y
    assert sim.velocity[0][:, -4] == pytest.approx(6 * y * (1 - y), abs=0.01)
    slope = np.polyfit(grid.x[8:-8], sim.pressure[n // 2, 8:-8], 1)[0]
    assert slope == pytest.approx(-12 * 0.1 * sim.setup.density, rel=0.02)


def test_velocity_is_free_of_divergence():
    sim, _, _ = cases.cylinder(16, 40, x=(-3, 5), y=(-3, 3), until=0.3)
    u, v = sim.water.u, sim.water.v
    inner = np.s_[PAD:-PAD, PAD:-PAD]
    div = (
        u[PAD:-PAD, PAD + 1 : u.shape[1] - PAD + 1] - u[inner] + v[PAD + 1 : v.shape[0] - PAD + 1, PAD:-PAD] - v[inner]
    )
    assert np.abs(div).max() < 1e-3


def test_same_bytes_on_one_and_two_threads():
    runs = [cases.cylinder(16, 100, x=(-6, 10), y=(-8, 8), until=0.4, threads=n)[0] for n in (1, 2)]
    assert runs[0].water.u.tobytes() == runs[1].water.u.tobytes()
    assert runs[0].record.bodies.tobytes() == runs[1].record.bodies.tobytes()


def test_a_run_goes_on_from_its_checkpoint_to_the_same_bytes(tmp_path):
    whole = flow.Simulation(eel_setup())
    whole.run(0.2, progress=False)

    class Killed(Exception):
        pass

    def kill(sim):
        if sim.time > 0.1:
            raise Killed

    first = flow.Simulation(eel_setup())
    with pytest.raises(Killed):
        first.run(0.2, watch=kill, checkpoint=tmp_path / "a b" / "eel.npz", progress=False)
    assert first.time < 0.19
    second = flow.Simulation(eel_setup())
    record = second.run(0.2, checkpoint=tmp_path / "a b" / "eel.npz", progress=False)
    assert second.water.u.tobytes() == whole.water.u.tobytes()
    assert record.bodies.tobytes() == whole.record.bodies.tobytes()
    assert record.time.tobytes() == whole.record.time.tobytes()
    assert second._reference == whole._reference


def test_a_run_around_a_body_that_stands_still_goes_on_to_the_same_bytes(tmp_path):
    """It is placed anew only when the wall's offset has changed by enough: not because of the checkpoint."""
    setup = still_setup(stream=lambda time: (1.0 + time, 0.0), viscosity=0.05)
    whole = flow.Simulation(setup)
    whole.run(0.11, progress=False)  # its steps are evened out before its end, as those of the first half are
    whole.run(0.3, progress=False)
    flow.Simulation(setup).run(0.11, checkpoint=tmp_path / "half.npz", progress=False)
    second = flow.Simulation(setup)
    record = second.run(0.3, checkpoint=tmp_path / "half.npz", progress=False)
    assert second.water.offset == whole.water.offset
    assert second.water.u.tobytes() == whole.water.u.tobytes()
    assert record.bodies.tobytes() == whole.record.bodies.tobytes()


def test_a_broken_checkpoint_or_one_of_another_setup_is_refused(tmp_path):
    path = tmp_path / "state.npz"
    path.write_bytes(b"not a checkpoint")
    with pytest.raises(UnreadableFile, match="not a checkpoint"):
        flow.Simulation(still_setup()).run(0.1, checkpoint=path, progress=False)
    path.unlink()
    flow.Simulation(still_setup(step=0.05)).run(0.1, checkpoint=path, progress=False)
    with pytest.raises(UnreadableFile, match="another setup"):
        flow.Simulation(still_setup(step=0.05, viscosity=0.02)).run(0.1, checkpoint=path, progress=False)


def test_the_eel_swims_head_first_and_its_mirror_image_swims_the_mirror_track():
    def mirrored(time):
        spine = flow.eel(1.0, stations=97).spine(time)
        return flow.MidlineState(
            x=spine.x,
            y=-spine.y,
            heading=-spine.heading,
            half_width=spine.half_width,
            x_rate=spine.x_rate,
            y_rate=-spine.y_rate,
            heading_rate=-spine.heading_rate,
        )

    tracks = []
    for shape in (flow.eel(1.0, stations=97), flow.Midline(spine=mirrored)):
        sim = flow.Simulation(eel_setup(bodies=(flow.FreeBody(shape=shape, name="eel"),)))
        record = sim.run(0.7, progress=False)
        tracks.append(np.stack([record.column(c)[-1] for c in ("x", "y", "angle")]))
    assert tracks[0][0] < -0.02
    assert tracks[1] == pytest.approx(tracks[0] * [1, -1, -1], abs=2e-3)


def test_a_light_free_cylinder_is_stable_and_drifts_with_the_stream():
    body = flow.FreeBody(shape=flow.Cylinder(diameter=1.0), density=0.2)
    sim = flow.Simulation(still_setup(bodies=(body,), stream=(1.0, 0.0), follow="body", viscosity=0.05))
    record = sim.run(1.5, progress=False)
    u = record.column("velocity_x")
    assert 1.5 < u.max() < 1.67  # thrown ahead by the start: (1 + 1) / (0.2 + 1) of the stream in water without end
    assert u[-1] == pytest.approx(1.147, abs=0.01)  # its value with a quarter of the step, or half the cell
    assert np.abs(np.diff(u[5:])).max() < 0.05


def test_a_pushed_body_keeps_its_momentum_with_the_water():
    """In a box of slip walls far away, a neutrally buoyant body at rest stays at rest."""
    body = flow.FreeBody(shape=flow.Cylinder(diameter=1.0))
    sim = flow.Simulation(still_setup(bodies=(body,)))
    for _ in range(5):
        sim.advance(0.02)
    assert np.abs(sim.record.bodies[:, 0, 9:14]).max() < 1e-12


@pytest.mark.parametrize("place", [(1.18, 0.0), (-1.18, 0.0), (0.0, 1.18), (0.0, -1.18)])
def test_a_body_close_to_a_side_acts_on_the_domain_only(place):
    """Its window once went beyond the side, where nothing had been computed yet."""
    setup = still_setup()
    j0, j1, i0, i1 = window_of(setup.bodies[0], flow.Pose(position=place), setup.grid, 0.0)
    assert PAD <= j0 < j1 <= PAD + 64
    assert PAD <= i0 < i1 <= PAD + 64


def test_a_motion_that_outgrows_the_grid_is_refused_when_it_does():
    def faster(time):
        return flow.Pose(position=(2 * time**2, 0.0), velocity=(4 * time, 0.0))

    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=faster)
    sim = flow.Simulation(still_setup(bodies=(body,), viscosity=1 / 500))
    with pytest.raises(InvalidDesign, match=r"at t = 0\..* take cells of at most"):
        sim.run(0.6, progress=False)
    reached = (
        LAYER_SPEED_FACTOR * 16**2 / (2000 * MIN_LAYER_CELLS**2)
    )  # the Reynolds number is 2000 t, the layer 16 / sqrt(Re) cells
    assert reached - 0.04 < sim.time < reached


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda: flow.Grid(cells=(70, 70), cell=0.1), "take 72 x 72"),
        (lambda: flow.Grid(cells=(64, 64), cell=0.0), "positive side"),
        (lambda: still_setup(viscosity=-1.0), "viscosity is -1.0"),
        (lambda: still_setup(courant=1.5), "explodes"),
        (lambda: still_setup(tolerance=1e-9), "precision='double'"),
        (lambda: flow.Sides(left=flow.Periodic()), "other is not"),
        (
            lambda: flow.Sides(
                left=flow.Inflow(profile=lambda y: y), right=flow.Wall(), bottom=flow.Wall(), top=flow.Wall()
            ),
            "cannot leave",
        ),
        (
            lambda: flow.Simulation(still_setup(bodies=(flow.Body(shape=flow.Cylinder(diameter=0.1)),))),
            "at least 3.41 cells",
        ),
        (
            lambda: flow.Simulation(
                still_setup(
                    bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(position=(1.8, 0.0))),)
                )
            ),
            "outside the grid",
        ),
        (lambda: flow.Simulation(still_setup(stream=(1.0, 0.0), viscosity=1e-5)), "take cells of at most"),
    ],
)
def test_bad_input_is_one_sentence_with_the_remedy(make, part):
    with pytest.raises(InvalidDesign, match=part) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_a_step_too_long_is_refused():
    sim = flow.Simulation(still_setup(stream=(1.0, 0.0), step=0.5))
    with pytest.raises(OutsideLimits, match="Take a step of at most"):
        sim.run(1.0, progress=False)


def test_divergence_tells_when_and_keeps_the_last_good_fields():
    sim = flow.Simulation(still_setup(stream=(1.0, 0.0)))
    for _ in range(3):
        sim.advance()
    sim.water.u[40, 40] = np.nan
    before = sim.time
    with pytest.raises(Diverged) as caught:
        sim.advance(0.01)
    assert caught.value.time == pytest.approx(before)
    assert len(caught.value.record["record"].time) == 3
