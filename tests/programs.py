"""Programs that tests run: each is a process of its own, forked from one that has imported the libraries.

Numpy, SciPy, numba, MuJoCo, xarray and matplotlib take two seconds of processor time to import. A server imports them
once for each worker of the tests, and forks for each program. It imports nothing of suchus: a program that lacks an
import of suchus fails as it does alone. Where there is no safe fork, each program is an interpreter of its own.

``python tests/programs.py`` is the server. A line of JSON is a request, and the exit code is the answer; an empty line
ends the server.
"""

import gc
import importlib
import json
import os
import runpy
import subprocess
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import IO, Any

LIBRARIES = (
    "numpy", "scipy.constants", "scipy.interpolate", "scipy.ndimage", "scipy.optimize", "scipy.signal",
    "scipy.spatial.transform", "scipy.stats", "numba", "llvmlite.binding", "mujoco", "xarray", "h5netcdf", "h5py",
    "matplotlib.figure", "matplotlib.backends.backend_agg", "mpl_toolkits.mplot3d", "PIL.Image", "pydantic", "jinja2",
    "rich.progress", "tyro",
)  # fmt: skip
"""What most programs import; nothing of suchus."""
CAN_FORK = sys.platform == "linux"
"""Whether a process that has imported the libraries may fork; frameworks of macOS forbid it."""


class Programs:
    """Runs programs of Python.

    Args:
        folder: for what the programs print.
        server: process that forks; None where each program is an interpreter of its own.
    """

    def __init__(self, folder: Path, server: "subprocess.Popen[str] | None") -> None:
        self._folder, self._server = folder, server

    def run(
        self, words: Sequence[str | Path], *, cwd: Path, environment: Mapping[str, str] | None = None
    ) -> "subprocess.CompletedProcess[str]":
        """Run a program to its end, and return its exit code and what it printed.

        Args:
            words: as after ``python``: ``-c CODE``, ``-m MODULE`` or a file, then its arguments.
            cwd: working folder.
            environment: all of its environment variables, by default those of this process.
        """
        command = [str(word) for word in words]
        whole = dict(os.environ if environment is None else environment)
        if self._server is None:
            return subprocess.run(
                [sys.executable, *command], cwd=cwd, env=whole, capture_output=True, text=True, check=False
            )
        out, err = self._folder / "out", self._folder / "err"
        request = {"words": command, "cwd": str(cwd), "environment": whole, "out": str(out), "err": str(err)}
        requests, answers = self._server.stdin, self._server.stdout
        assert requests is not None
        assert answers is not None
        requests.write(json.dumps(request) + "\n")
        requests.flush()
        code = int(answers.readline())
        return subprocess.CompletedProcess(command, code, out.read_text("utf-8"), err.read_text("utf-8"))


@contextmanager
def started() -> Iterator[Programs]:
    """Start the server, and wait for its end, so that its processor time counts as that of the tests."""
    with TemporaryDirectory() as folder:
        if not CAN_FORK:
            yield Programs(Path(folder), None)
            return
        own = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        words = [sys.executable, __file__]
        with subprocess.Popen(words, env=own, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
            try:
                yield Programs(Path(folder), server)
            finally:
                assert server.stdin is not None
                server.stdin.write("\n")  # a closed pipe is not enough: forked processes may hold its other end
                server.stdin.flush()


def serve(requests: IO[str], answers: IO[str]) -> dict[str, Any] | None:
    """Fork for each request, and answer with the exit code of the program.

    Returns:
        the request in the process that is to run it; None in the server, when there are no more requests.
    """
    for library in LIBRARIES:
        importlib.import_module(library)
    gc.freeze()  # what is collected in a program is its own
    while (line := requests.readline()).strip():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.12 warns of the idle threads of libraries
            process = os.fork()
        if process == 0:
            request: dict[str, Any] = json.loads(line)
            return request
        _, status = os.waitpid(process, 0)
        answers.write(f"{os.waitstatus_to_exitcode(status)}\n")
        answers.flush()
    return None


def become(request: Mapping[str, Any]) -> None:
    """Make this process what an interpreter with the request's words would be, and run its program."""
    for file, mode, descriptor in ((os.devnull, "rb", 0), (request["out"], "wb", 1), (request["err"], "wb", 2)):
        with Path(file).open(mode) as stream:
            os.dup2(stream.fileno(), descriptor)
    os.environ.clear()
    os.environ.update(request["environment"])
    os.chdir(request["cwd"])
    importlib.invalidate_caches()
    first, *rest = request["words"]
    path = os.environ.get("PYTHONPATH", "")
    sys.path[:1] = [str(Path(first).parent) if first not in ("-c", "-m") else "", *filter(None, path.split(os.pathsep))]
    if first == "-c":
        sys.argv = ["-c", *rest[1:]]
        sys.modules["__main__"] = empty = ModuleType("__main__")
        exec(compile(rest[0], "<string>", "exec"), vars(empty))
    elif first == "-m":
        sys.argv = rest
        runpy.run_module(rest[0], run_name="__main__", alter_sys=True)
    else:
        sys.argv = [first, *rest]
        runpy.run_path(first, run_name="__main__")


if __name__ == "__main__":
    requested = serve(sys.stdin, sys.stdout)
    if requested is not None:
        become(requested)
