"""Water inside the physics step: plugins of passive forces, each registered once in a process, where a run needs it.

MuJoCo calls one at every evaluation of the passive forces of a model that names it, on whatever thread, without
Python's lock. It is no callback (``mjcb_passive``): that acts in every model, and a batch whose process has one
computes positions and velocities twice in a step. The kernels (``hydro.kernel``) are kept on disk; the thin functions
around them are not, since they freeze what they refer to, the offsets of this MuJoCo among it.
"""

import ctypes
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import mujoco
import numpy as np
from llvmlite import binding
from numba import cfunc, types

from suchus.core.errors import OtherMuJoCo
from suchus.core.water_table import AIR_FRACTION, BALL, DENSITY, LEVEL, SUBMERGED_VOLUME, WIDTH, column
from suchus.sim.hydro.kernel import apply_to_pieces, apply_to_plates, apply_to_shapes, has_misfit
from suchus.sim.hydro.memory import DATA_FIELDS, FIELDS
from suchus.sim.immersion.attachment import GRAINS_ON_PLATES, WATER_ON_PIECES, WATER_ON_SHAPES, with_pieces
from suchus.sim.immersion.structs import offset, plugin_struct, verify

_WORDS = {"opt.integrator": 4}
"""Size of the words as which the kernel reads fields, where it is not 8 [byte]."""
_FACTOR, _DEFAULT, _REGISTER = "mj_factorM", "mjp_defaultPlugin", "mjp_registerPlugin"
_KERNELS: Mapping[str, Callable[[int, int, np.ndarray], bool]] = {
    WATER_ON_PIECES: apply_to_pieces,
    WATER_ON_SHAPES: apply_to_shapes,
    GRAINS_ON_PLATES: apply_to_plates,
}
"""The kernel of each plugin; a new machine compiles those alone that are installed."""
_plugin_objects: dict[str, list[Any]] = {}
_lock = Lock()


def install(plugin: str = WATER_ON_PIECES) -> None:
    """Let water or grains act in every simulation of this process whose model names the plugin (``model.wet``).

    Args:
        plugin: name of the plugin, see ``immersion.attachment``. That of pieces, with which is checked that it acts, is
            installed with any.

    Raises:
        OtherMuJoCo: what the kernel needs is not where MuJoCo's own description says.
    """
    with _lock:
        for name in (WATER_ON_PIECES, plugin):
            if name not in _plugin_objects:
                _plugin_objects[name] = _register(name, _KERNELS[name], offsets())
        _check_that_it_acts()


def offsets() -> np.ndarray:
    """Return where the fields lie that the kernel needs, verified, in its order [byte].

    Raises:
        OtherMuJoCo: a field is not where it should be, or is not aligned as the kernel reads it.
    """
    model = mujoco.MjModel.from_xml_string(_SAMPLE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    data.time = 0.375
    verify("mjModel", model, FIELDS)
    verify("mjData", data, DATA_FIELDS)
    fields = [("mjModel", field) for field in FIELDS] + [("mjData", field) for field in DATA_FIELDS]
    positions = np.array([offset(struct, field) for struct, field in fields])
    for (struct, field), position in zip(fields, positions, strict=True):
        word = _WORDS.get(field, 8)
        if position % word:
            raise OtherMuJoCo(
                f"{struct}.{field}", mujoco.__version__, f"it begins at byte {position}, not at a whole word"
            )
    return positions


def _register(name: str, apply: Callable[[int, int, np.ndarray], bool], field_offsets: np.ndarray) -> list[Any]:
    """Compile the functions of a plugin, register it, and return what must stay in memory.

    Args:
        name: name of the plugin.
        apply: its kernel.
        field_offsets: where the fields lie that it needs [byte].
    """
    library = _library()
    binding.add_symbol(f"suchus_{_FACTOR}", _address(library, _FACTOR))
    pair, number = (types.voidptr, types.voidptr), types.int32
    factor = types.ExternalFunction(f"suchus_{_FACTOR}", types.void(*pair))

    def act(model: Any, data: Any, _instance: int, _capability: int) -> None:
        if apply(model, data, field_offsets):
            factor(model, data)

    def no_state(_model: Any, _instance: int) -> int:
        return 0

    def begin(model: Any, _data: Any, _instance: int) -> int:
        return -1 if has_misfit(model, field_offsets) else 0

    def reset(_model: Any, _state: Any, _plugin_data: Any, _instance: int) -> None:
        return None

    functions = {
        "compute": cfunc(types.void(*pair, number, number), nopython=True)(act),
        "nstate": cfunc(number(types.voidptr, number), nopython=True)(no_state),
        "init": cfunc(number(*pair, number), nopython=True)(begin),
        "reset": cfunc(types.void(*pair, types.voidptr, number), nopython=True)(reset),
    }
    plugin = plugin_struct()()
    for function_name in (_DEFAULT, _REGISTER):
        _address(library, function_name)
    getattr(library, _DEFAULT)(ctypes.byref(plugin))
    plugin.name = name.encode()
    plugin.capabilityflags = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    for member, function in functions.items():
        setattr(plugin, member, function.address)
    getattr(library, _REGISTER)(ctypes.byref(plugin))
    return [functions, plugin, field_offsets]


@lru_cache(maxsize=1)
def _check_that_it_acts() -> None:
    """Submerge a ball and check that the kernel computes its volume; a success is checked once in a process."""
    spec = mujoco.MjSpec()
    ball = spec.worldbody.add_body()
    ball.add_freejoint()
    ball.add_geom(size=[0.1, 0, 0])
    table = np.zeros((1, WIDTH))
    column(table, "body")[:], column(table, "kind")[:] = 1, BALL
    for name, axis in (("across", 0), ("upward", 1), ("forward", 2)):
        column(table, name)[:, axis] = 1.0
    column(table, "half")[:], column(table, "volume")[:] = 0.1, 0.004
    model = with_pieces(spec, table, 1.0, acting=True)
    data = mujoco.MjData(model)
    data.userdata[[LEVEL, DENSITY, AIR_FRACTION, AIR_FRACTION + 1]] = 5.0, 1000.0, 1.0, 1.0
    mujoco.mj_forward(model, data)
    if data.userdata[SUBMERGED_VOLUME] != 0.004:
        reason = f"a ball of 4 l under water displaces {1000 * data.userdata[SUBMERGED_VOLUME]:g} l"
        raise OtherMuJoCo("mjpPlugin.compute", mujoco.__version__, reason)


def _address(library: ctypes.CDLL, name: str) -> int:
    """Return where a function of MuJoCo's library begins.

    Raises:
        OtherMuJoCo: it has no such function.
    """
    if not hasattr(library, name):
        raise OtherMuJoCo(name, mujoco.__version__, "its library has no such function")
    return int(ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0)


def _library() -> ctypes.CDLL:
    """Return MuJoCo's own library, as its bindings have loaded it."""
    folder = Path(mujoco.__file__).parent
    for pattern in ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll"):
        for path in sorted(folder.glob(pattern)):
            return ctypes.CDLL(str(path))
    raise OtherMuJoCo(_FACTOR, mujoco.__version__, f"its library is not in the package folder {folder.name}")


_SAMPLE = """
<mujoco>
  <option timestep="0.003" integrator="implicitfast"/>
  <size nuserdata="2"/>
  <custom><numeric name="a" data="1 2 3"/></custom>
  <worldbody><body><freejoint/><geom size="0.1" pos="0.01 0.02 0"/>
    <body pos="0.2 0 0"><joint axis="0 1 0"/><geom size="0.05" pos="0.1 0 0"/></body></body></worldbody>
</mujoco>
"""
