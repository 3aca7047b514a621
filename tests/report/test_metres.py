"""The table of what a metre costs on land and in water."""

from types import SimpleNamespace

from suchus.apps.report.page import metres


def result(**measures):
    told = {name: {"value": value, "unit": unit} for name, (value, unit) in measures.items()}
    return SimpleNamespace(outcome={"measures": told})


SHORE = result(
    speed_land=(0.1, "m/s"), work_per_metre_land=(30.0, "J/m"), net_cost_of_transport_land=(0.86, "-"),
    speed_deep=(0.16, "m/s"), work_per_metre_deep=(7.5, "J/m"),
    speed_surface=(None, "m/s"), work_per_metre_surface=(6.0, "J/m"),
    speed_wading=(0.2, "m/s"),
)  # fmt: skip


def test_rows_go_from_land_to_depth_and_only_where_both_numbers_are_there():
    rows = metres({"other": result(way=(1.0, "m")), "shore": SHORE})
    assert [(row.terrain, row.speed, row.work, row.cost) for row in rows] == [
        ("on level dry land", "0.1 m/s", "30 J/m", "0.86"),
        ("at a depth that is held", "0.16 m/s", "7.5 J/m", ""),
    ]
    assert {row.experiment for row in rows} == {"shore"}
    assert metres({"other": result(way=(1.0, "m"))}) == []
