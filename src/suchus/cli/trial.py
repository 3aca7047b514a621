"""Small trials for ``suchus doctor``, each in a process of its own, so that a library that dies takes nobody along.

``python -m suchus.cli.trial NAME`` prints what was found as JSON.
"""

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any


def walk() -> dict[str, Any]:
    """Let the caiman walk for a moment; return how long walking took [s]."""
    import suchus  # noqa: PLC0415  what fails to import is what a trial finds

    crawl = suchus.crawl  # imports what it needs
    start = time.perf_counter()
    record = crawl("caiman", "belly_crawl", duration=0.2)
    return {"seconds": time.perf_counter() - start, "finite": bool(record.position.notnull().all())}


def swim() -> dict[str, Any]:
    """Compile a loop that runs on threads; return by which layer, and where the flow solver's code is kept."""
    import numba  # noqa: PLC0415
    import numpy as np  # noqa: PLC0415

    from suchus.flow import compiled, linking  # noqa: PLC0415

    @numba.njit(parallel=True)  # type: ignore[untyped-decorator]
    def doubled(values: Any) -> Any:
        out = np.empty_like(values)
        for i in numba.prange(values.size):
            out[i] = 2.0 * values[i]
        return out

    doubled(np.ones(8))
    kept = compiled.FOLDER
    return {
        "layer": numba.threading_layer(),
        "folder": None if kept is None else str(kept),
        "compiled": 0 if kept is None else len(list(kept.rglob("*.nbc"))),
        "missing": linking.missing(),
    }


def draw() -> dict[str, Any]:
    """Open an OpenGL context without a window; return by what."""
    os.environ.setdefault("MUJOCO_GL", "egl" if sys.platform == "linux" else "glfw")
    import mujoco  # noqa: PLC0415

    context = mujoco.GLContext(64, 64)
    context.make_current()
    context.free()
    return {"by": os.environ["MUJOCO_GL"]}


TRIALS: dict[str, Callable[[], dict[str, Any]]] = {"walk": walk, "swim": swim, "draw": draw}
"""By name."""


if __name__ == "__main__":
    print(json.dumps(TRIALS[sys.argv[1]]()))
