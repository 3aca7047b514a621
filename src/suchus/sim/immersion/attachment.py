"""A MuJoCo specification that carries a table as a custom number, and the plugin that lets water or grains act."""

from typing import Any

import numpy as np

from suchus.core.water_table import NUMBERS, pack_table

NUMERIC = "water"
"""Name of the custom number that holds the table, see ``core.water_table``."""
WATER_ON_PIECES = "suchus.swimming.pieces"
"""Name of MuJoCo's plugin that lets water act on a robot's pieces; ``immersion.wetting`` registers it."""
WATER_ON_SHAPES = "suchus.swimming.water"
"""Name of the plugin that lets water act on the geoms of any model."""
GRAINS_ON_PLATES = "suchus.swimming.grains"
"""Name of the plugin that lets grains act on plates."""


def with_pieces(
    spec: Any,
    table: np.ndarray,
    length: float,
    max_pieces: int | None = None,
    *,
    acting: bool = False,
    extra_numbers: int = 0,
) -> Any:
    """Return a compiled ``mujoco.MjSpec`` that carries a table of pieces.

    Args:
        spec: MuJoCo specification of any bodies.
        table: table of pieces; its bodies are numbered as MuJoCo numbers them.
        length: length for the Reynolds number of friction [m].
        max_pieces: pieces that the table has room for; as many as there are if None.
        acting: whether the water acts in it; ``wetting.install`` goes before.
        extra_numbers: numbers for the added mass of water that is solved elsewhere.
    """
    plugin = WATER_ON_PIECES if acting else None
    attach_table(spec, pack_table(table, length, max_pieces), NUMBERS + extra_numbers, plugin)
    return spec.compile()


def attach_table(spec: Any, numbers: np.ndarray, user_numbers: int, plugin: str | None) -> None:
    """Let a ``mujoco.MjSpec`` carry a table.

    Args:
        spec: MuJoCo specification of any bodies.
        numbers: the table as a row of numbers, shape (n,).
        user_numbers: numbers of user data that the table needs [-].
        plugin: the plugin by which what it says acts, which ``wetting.install`` has registered; None: it does not act.
    """
    numeric = spec.add_numeric(name=NUMERIC, size=len(numbers))
    numeric.data = numbers
    spec.nuserdata = user_numbers
    if plugin is not None:
        spec.activate_plugin(plugin)
        spec.add_plugin(name=NUMERIC, plugin_name=plugin, active=True)
