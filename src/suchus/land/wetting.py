"""Water inside the physics step: a compiled callback, installed once in a process and only where a run has water.

MuJoCo calls it at every evaluation of the passive forces, on whatever thread, without Python's lock. The kernel
(``hydro.kernel``) is kept on disk; the thin callback around it is not, since it freezes what it refers to, the offsets
of this MuJoCo among it.
"""

import ctypes
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import mujoco
import numpy as np
from llvmlite import binding
from numba import cfunc, types

from suchus.errors import InvalidDesign, OtherMuJoCo
from suchus.hydro.kernel import DATA_FIELDS, FIELDS, wet
from suchus.land.structs import offset, verify

_FACTOR = "mj_factorM"
_installed: list[Any] = []
_lock = Lock()


def install() -> None:
    """Let water act in every simulation of this process whose model carries a table of pieces.

    A model without one returns from the callback after a branch, and its bytes stay the same.

    Raises:
        OtherMuJoCo: a field that the kernel needs is not where MuJoCo's own description says.
        InvalidDesign: another passive callback is installed.
    """
    with _lock:
        if _installed:
            return
        if mujoco.get_mjcb_passive() is not None:
            raise InvalidDesign(
                "another passive callback is installed in this process (mujoco.set_mjcb_passive), and MuJoCo takes "
                "one: remove it with mujoco.set_mjcb_passive(None) before a run with water."
            )
        callback = _callback()
        mujoco.set_mjcb_passive(callback.ctypes)
        _installed.append(callback)


def remove() -> None:
    """Take the callback away again; ``install`` puts it back."""
    with _lock:
        if _installed:
            mujoco.set_mjcb_passive(None)
            _installed.clear()


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
    found = [("mjModel", field) for field in FIELDS] + [("mjData", field) for field in DATA_FIELDS]
    at = np.array([offset(struct, field) for struct, field in found])
    for (struct, field), here in zip(found, at, strict=True):
        if here % 8:
            raise OtherMuJoCo(f"{struct}.{field}", mujoco.__version__, f"it begins at byte {here}, not at a whole word")
    return at


@lru_cache(maxsize=1)
def _callback() -> Any:
    """Compile the callback around the kernel."""
    at = offsets()
    address = ctypes.cast(getattr(_library(), _FACTOR), ctypes.c_void_p).value
    binding.add_symbol(f"suchus_{_FACTOR}", address)
    pair = types.voidptr, types.voidptr
    factor = types.ExternalFunction(f"suchus_{_FACTOR}", types.void(*pair))

    def act(model: Any, data: Any) -> None:
        if wet(model, data, at):
            factor(model, data)

    return cfunc(types.void(*pair), nopython=True)(act)


def _library() -> ctypes.CDLL:
    """Return MuJoCo's own library, as its bindings have loaded it."""
    folder = Path(mujoco.__file__).parent
    for pattern in ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll"):
        for path in sorted(folder.glob(pattern)):
            return ctypes.CDLL(str(path))
    raise OtherMuJoCo(_FACTOR, mujoco.__version__, f"its library is not in the package folder {folder.name}")


_SAMPLE = """
<mujoco>
  <size nuserdata="2"/>
  <custom><numeric name="a" data="1 2 3"/></custom>
  <worldbody><body><freejoint/><geom size="0.1" pos="0.01 0.02 0"/>
    <body pos="0.2 0 0"><joint axis="0 1 0"/><geom size="0.05" pos="0.1 0 0"/></body></body></worldbody>
</mujoco>
"""
