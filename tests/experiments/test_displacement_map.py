"""The map of displacement counts whole cycles, whatever the period; its caption names what is drawn."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import suchus
from suchus.article.paper import CLAIMS
from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.displacement.figure import draw_sensitivity
from suchus.robot.design.scale import coarse_step
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement
from suchus.visual.figures.style import caption


@pytest.mark.parametrize("period", [1.3, 0.9])
def test_the_map_holds_the_displacement_of_the_whole_run(period):
    """A map whose samples miss the end of the run lost up to 46 % of it."""
    question = EXPERIMENTS["displacement"].quick()
    gait = replace(question.gait, period=period)
    question = replace(question, gait=gait, strokes=(1.0,), bends=(1.0,), pitches=(0.2,), phases=(0.0,), cycles=2)
    duration = START + 2 * period
    mapped = float(question._displacement_map(duration, silent).map_coordinated.item())
    run = Run(robot=question.robot, gait=gait)
    record = simulate([run], duration=duration, timestep=coarse_step(question.robot))
    assert np.isclose(float(record.time[-1]), duration)
    assert mapped == pytest.approx(float(displacement(record).sel(xyz="x").item()), rel=1e-9)


PRINTED_RATIO = CLAIMS["displacement_ratio"].value


@pytest.mark.parametrize(
    ("strokes", "bends", "ratios", "has_line"),
    [
        ((0.8, 1.2), (0.5, 1.0), (0.5, 2.0), True),
        ((0.8, 1.2), (0.5, 1.0), (0.5, 0.9), False),  # no contour: all ratios are below the printed one
        ((1.0,), (0.5, 1.0), (0.5, 2.0), False),  # only the bend varies: a curve, not a map
    ],
)
def test_the_caption_names_the_orange_line_only_where_it_is_drawn(strokes, bends, ratios, has_line):
    """Ratios are given as multiples of the article's."""
    gait = EXPERIMENTS["displacement"].gait
    record = xr.Dataset(
        {"late_coordinated": ("late", [0.5, 0.4])},
        coords={"stroke": list(strokes), "bend": list(bends), "pitch": [], "late": [0.0, 0.1]},
    )
    for name in ("stroke", "bend"):
        record[name].attrs = {"units": "-", "long_name": name}
    values = np.linspace(*ratios, len(strokes) * len(bends)).reshape(len(strokes), len(bends)) * PRINTED_RATIO
    ratio = xr.DataArray(values, dims=("stroke", "bend"), coords={name: record[name] for name in ("stroke", "bend")})
    figure = draw_sensitivity(record, ratio, gait, 0.03, is_article=True)
    orange = [
        collection
        for collection in figure.axes[0].collections
        if any(
            np.allclose(colour, (0xD5 / 255, 0x5E / 255, 0.0, 1.0), atol=1e-3) for colour in collection.get_edgecolor()
        )
        and any(len(path.vertices) for path in collection.get_paths())
    ]
    assert bool(orange) == has_line
    assert ("orange line" in caption(figure)) == has_line


def test_the_displacement_exactly_as_designed_is_that_of_a_crawl_of_the_design(quick_outcome):
    outcome = quick_outcome("displacement")
    walked = displacement(suchus.crawl(suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"], cycles=1))
    designed = outcome.measures["forward_coordinated_designed"].value
    assert designed == pytest.approx(float(walked.sel(xyz="x").squeeze()), abs=1e-9)
    assert f"exactly as designed {designed:.2f} against" in outcome.decides
