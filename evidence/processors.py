"""Other processors, imitated: settings with which the libraries take the routines of a processor of another kind.

Usage: python -m evidence.processors PROCESSOR NAME ...: runs the quick forms of experiments on it, and prints their
measures as JSON.
"""

import json
import os
import platform
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from suchus.core import machine

PROCESSORS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "Haswell": {
            "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR",
            "OPENBLAS_CORETYPE": "Haswell",
            "NUMBA_CPU_NAME": "haswell",
        },
        "Sandy Bridge": {
            "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
            "OPENBLAS_CORETYPE": "SandyBridge",
            "NUMBA_CPU_NAME": "sandybridge",
            "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F",
        },
        "Nehalem": {**machine.PORTABLE, "NUMBA_CPU_FEATURES": ""},
        "no vectors in compiled kernels": {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""},
    }
)
"""Environment by processor: NumPy's dispatch, OpenBLAS's kernels, Numba's target, the C library's choice."""
ROOT = Path(__file__).parents[1]


def can_imitate() -> bool:
    """Return whether this machine can: its libraries must have such settings."""
    return (platform.machine(), platform.libc_ver()[0]) == ("x86_64", "glibc")


def quick_measures(processor: str, names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Return the measures of the quick forms of experiments on an imitated processor, in a process of its own.

    Args:
        processor: a key of ``PROCESSORS``.
        names: of the experiments.
    """
    unset = {setting for settings in PROCESSORS.values() for setting in settings}
    environment = {name: value for name, value in os.environ.items() if name not in unset}
    words = [sys.executable, "-W", "ignore", "-m", "evidence.processors", processor, *names]
    done = subprocess.run(
        words, env=environment | PROCESSORS[processor], cwd=ROOT, capture_output=True, text=True, check=True
    )
    measures: dict[str, dict[str, float]] = json.loads(done.stdout.splitlines()[-1])
    return measures


def main(names: Sequence[str]) -> None:
    """Print the measures of the quick forms of experiments."""
    from suchus.experiments.catalog import EXPERIMENTS  # noqa: PLC0415  after the environment is known to be right

    measures = {name: EXPERIMENTS[name].quick().run().measures for name in names}
    print(json.dumps({name: {key: one.value for key, one in found.items()} for name, found in measures.items()}))


if __name__ == "__main__":
    wrong = [name for name, value in PROCESSORS[sys.argv[1]].items() if os.environ.get(name) != value]
    if wrong:
        sys.exit(f"the environment does not imitate {sys.argv[1]}: {', '.join(wrong)} differ; call quick_measures.")
    main(sys.argv[2:])
