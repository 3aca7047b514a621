"""A MuJoCo specification that carries a table as a custom number, and the plugin that lets water or grains act."""

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
    attach_table(spec, pack_table(table, length, max_pieces), NUMBERS + extra_numbers, acting=acting)
    return spec.compile()


def attach_table(spec: Any, numbers: np.ndarray, user_numbers: int, *, acting: bool) -> None:
    """Let a ``mujoco.MjSpec`` carry a table.

    Args:
        spec: MuJoCo specification of any bodies.
        numbers: the table as a row of numbers, shape (n,).
        user_numbers: numbers of user data that the table needs [-].
        acting: whether what it says acts; ``wetting.install`` goes before.
    """
    numeric = spec.add_numeric(name=NUMERIC, size=len(numbers))
    numeric.data = numbers
    spec.nuserdata = user_numbers
    if acting:
        spec.activate_plugin(PLUGIN)
        spec.add_plugin(name=NUMERIC, plugin_name=PLUGIN, active=True)
