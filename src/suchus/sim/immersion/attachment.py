"""A MuJoCo specification that carries a table of pieces as a custom number, and the plugin that lets water act."""

from typing import Any

import numpy as np

from suchus.core.water_table import NUMBERS, pack_table

NUMERIC = "water"
"""Name of the custom number that holds the table, see ``core.water_table``."""
PLUGIN = "suchus.swimming.water"
"""Name of MuJoCo's plugin that lets the water act; ``immersion.wetting`` registers it."""


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
    data = pack_table(table, length, max_pieces)
    numeric = spec.add_numeric(name=NUMERIC, size=len(data))
    numeric.data = data
    spec.nuserdata = NUMBERS + extra_numbers
    if acting:
        spec.activate_plugin(PLUGIN)
        spec.add_plugin(name=NUMERIC, plugin_name=PLUGIN, active=True)
    return spec.compile()
