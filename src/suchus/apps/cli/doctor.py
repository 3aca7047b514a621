"""``suchus doctor``: whether suchus can run here, and what is missing, on one page.

Trials run in processes of their own, so that a library that dies takes nobody along: ``python -m suchus.apps.cli.doctor
NAME`` prints what a trial found as JSON.
"""

import json
import os
import platform
import subprocess
import sys
import tempfile
import time
import webbrowser
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from textwrap import fill
from typing import Any

from suchus.apps.cli.entry import BadCommand
from suchus.core import machine, threads
from suchus.core.errors import SuchusError

_USAGE = """usage: suchus doctor

Say on one page whether suchus can run here: versions, threads, a short walk, the cache of compiled code, OpenGL,
browser, extras. The exit code is 0 when it can run, and 2 when it cannot."""
_EXTRAS = {
    "viewer": "suchus view, and suchus demo live",
    "optimise": "suchus optimise and suchus train",
    "capture": "tracks of DeepLabCut, SLEAP, LightningPose, Anipose, C3D; films",
    "gym": "Gymnasium tasks",
    "usd": "suchus export --format usd",
    "hardware": "suchus drive and suchus calibrate, with real servos",
    "meshes": "suchus import of a robot with meshes",
    "lessons": "QR codes of suchus lessons --serve",
    "cluster": "studies on many machines",
}
"""Purpose of each extra; extras for developers only are left out."""
_TRIAL_TIMEOUT = 300.0  # [s]; a cold disk and a slow machine
_LINE_WIDTH = 110  # columns


class UnfitMachine(SuchusError):
    """Surroundings in which suchus cannot run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Result of one check."""

    heading: str
    """Name of the thing that was checked."""
    lines: tuple[str, ...]
    """Lines that describe what there is."""
    problem: str = ""
    """What keeps suchus from running, and the remedy; empty if nothing does."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """Result of a trial in a process of its own."""

    output: Mapping[str, Any] | None
    """Output of the trial; None if it failed."""
    failure: str = ""
    """Reason of the failure, in one line."""


def doctor(words: Sequence[str]) -> int:
    """Print the page and return 0.

    Raises:
        UnfitMachine: suchus cannot run here.
        BadCommand: there were more words.
    """
    if any(word in ("-h", "--help") for word in words):
        print(_USAGE)
        return 0
    if words:
        raise BadCommand(f"suchus doctor takes no {words[0]!r}.")
    walk, swim, draw = run_trials("walk", "swim", "draw")
    findings = [
        packages(),
        cores(),
        bits(),
        walking(walk),
        compiled(swim),
        places(),
        opengl(draw),
        browsing(),
        extras(),
    ]
    print(page(findings))
    if problems := [finding.problem for finding in findings if finding.problem]:
        raise UnfitMachine(f"suchus cannot run here: {'; '.join(problems)}.")
    print("suchus can run here.")
    return 0


def page(findings: Iterable[Finding]) -> str:
    """Return the findings as one page of text."""
    head = f"suchus {installed('suchus') or '(not installed)'}, Python {platform.python_version()}, "
    lines = [head + f"{platform.system()} {platform.machine()}", ""]
    for finding in findings:
        for number, text in enumerate(finding.lines):
            label = finding.heading if number == 0 else ""
            lines.append(fill(text, _LINE_WIDTH, initial_indent=f"{label:<10} ", subsequent_indent=" " * 11))
    return "\n".join([*lines, ""])


def packages(requires: Iterable[str] | None = None, find_version: Callable[[str], str | None] | None = None) -> Finding:
    """Compare the installed packages with the required packages.

    Args:
        requires: what suchus needs, as its metadata say it; by default those of the installed package.
        find_version: gives the version of a package, None where it is not there.
    """
    listed, mismatches = [], []
    for need in _needs(requires, ""):
        present = (find_version or installed)(need.name)
        listed.append(f"{need.name} {present or 'missing'}")
        if present is None or not need.specifier.contains(present, prereleases=True):
            mismatches.append(f"{need.name} is {present or 'missing'}, and {need.specifier or 'any version'} is needed")
    remedy = f"{', '.join(mismatches)}: pip install --upgrade suchus" if mismatches else ""
    return Finding(heading="packages", lines=(", ".join(listed) or "unknown: suchus is not installed",), problem=remedy)


def extras(requires: Iterable[str] | None = None, find_version: Callable[[str], str | None] | None = None) -> Finding:
    """Return which extras are installed and how to install the others; arguments as for ``packages``."""
    lines = []
    for extra, use in _EXTRAS.items():
        needs = _needs(requires, extra)
        present = [(find_version or installed)(need.name) for need in needs]
        fits = all(p and n.specifier.contains(p, prereleases=True) for n, p in zip(needs, present, strict=True))
        have = ", ".join(f"{need.name} {p}" for need, p in zip(needs, present, strict=True) if p)
        state = f"yes, {have}" if needs and fits else f"no: pip install 'suchus[{extra}]'"
        lines.append(f"{extra:<9} {state} ({use})")
    return Finding(heading="extras", lines=tuple(lines))


def cores() -> Finding:
    """Return how many threads suchus uses."""
    setting = os.environ.get("SUCHUS_THREADS")
    setting_text = "SUCHUS_THREADS is not set" if setting is None else f"SUCHUS_THREADS={setting}"
    try:
        return Finding(heading="threads", lines=(f"{threads.count()} of {os.cpu_count()} cores ({setting_text})",))
    except SuchusError as error:
        return Finding(heading="threads", lines=(setting_text,), problem=str(error).rstrip("."))


def bits() -> Finding:
    """Return what decides the last bits of results on this machine: processor and libraries."""
    machine_text = machine.describe()
    names = ("processor", "vector instructions", "linear algebra", "C library")
    digests = ", ".join(f"{component} {digest}" for component, digest in machine.arithmetic().items())
    portable = f"portable ({machine.PORTABLE_VARIABLE}): {machine_text['portable']}"
    return Finding(
        heading="last bits", lines=("; ".join(machine_text[name] for name in names), f"{digests}; {portable}")
    )


def walking(trial: Trial) -> Finding:
    """Judge the trial walk."""
    if trial.output is None:
        return Finding(heading="walking", lines=("failed",), problem=f"a short walk failed ({trial.failure})")
    if not trial.output["finite"]:
        return Finding(heading="walking", lines=("not a number",), problem="a short walk gave what is no number")
    return Finding(heading="walking", lines=(f"0.2 s of a crawl in {trial.output['seconds']:.1f} s",))


def compiled(trial: Trial) -> Finding:
    """Judge how the flow solver is compiled, and whether the code can be kept."""
    if trial.output is None:
        return Finding(heading="swimming", lines=("failed",), problem=f"a kernel cannot be compiled ({trial.failure})")
    lines = [f"numba compiles; its threads are those of {trial.output['layer']}"]
    if trial.output["layer"] == "workqueue":
        lines.append("workqueue serves one flow at a time: install libgomp (the package libgomp1) for several")
    if trial.output["missing"]:
        lines.append(f"this numba lacks {', '.join(trial.output['missing'])}: first runs may differ in their last bits")
    if trial.output["folder"] is None:
        lines.append("compiled code cannot be kept, so every swim compiles for minutes: set NUMBA_CACHE_DIR")
    else:
        state = "there" if trial.output["compiled"] else "not there yet, the first swim takes a minute or two longer"
        lines.append(f"compiled code is kept in {trial.output['folder']} ({state})")
    return Finding(heading="swimming", lines=tuple(lines))


def places() -> Finding:
    """Return whether results can be written into the working folder."""
    try:
        with tempfile.TemporaryDirectory(dir=Path.cwd(), prefix=".suchus-"):
            return Finding(heading="results", lines=("this folder can be written to",))
    except OSError as error:
        return Finding(heading="results", lines=(f"not into this folder ({error.strerror}): say --out DIR",))


def opengl(trial: Trial) -> Finding:
    """Return whether OpenGL draws off-screen; suchus does not need it."""
    offscreen = f"off-screen by {trial.output['by']}" if trial.output else "none off-screen"
    return Finding(heading="OpenGL", lines=(f"{offscreen}; suchus needs none, browsers draw with WebGL 2",))


def browsing() -> Finding:
    """Return which browser opens pages."""
    opener = browser()
    line = "none with a window: suchus demo writes a page" if opener is None else browser_name(opener)
    return Finding(heading="browser", lines=(line,))


def installed(name: str) -> str | None:
    """Return the version of a package; None where it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def run_trials(*names: str) -> list[Trial]:
    """Run trials side by side, each in its own process, and return their results."""
    command = [sys.executable, "-P", "-m", "suchus.apps.cli.doctor"]
    with ExitStack() as stack:
        running = []
        for name in names:
            trial_process = subprocess.Popen(
                [*command, name], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
            )
            running.append(stack.enter_context(trial_process))
            stack.callback(trial_process.kill)  # runs before the wait for the end of the process
        return [_outcome(process) for process in running]


def _outcome(process: "subprocess.Popen[str]") -> Trial:
    """Wait for a trial's process and return its result, or why it failed."""
    try:
        stdout, stderr = process.communicate(timeout=_TRIAL_TIMEOUT)
    except subprocess.TimeoutExpired:
        return Trial(output=None, failure=f"no answer within {_TRIAL_TIMEOUT:g} s")
    if process.returncode < 0:
        return Trial(output=None, failure=f"the process died of signal {-process.returncode}")
    if process.returncode > 0:
        return Trial(output=None, failure=(stderr.strip().splitlines() or ["no word"])[-1])
    return Trial(output=json.loads(stdout.splitlines()[-1]))


def _needs(requires: Iterable[str] | None, extra: str) -> list[Any]:
    """Return the requirements of suchus or of one extra that apply to this machine.

    Raises:
        UnfitMachine: what reads requirements is missing.
    """
    try:
        parse = import_module("packaging.requirements").Requirement
    except ModuleNotFoundError as error:
        raise UnfitMachine("the package packaging is missing: pip install --upgrade suchus.") from error
    if requires is None:
        try:
            requires = distribution("suchus").requires or ()
        except PackageNotFoundError:
            requires = ()
    requirements = [parse(text) for text in requires]
    plain = [need for need in requirements if need.marker is None or need.marker.evaluate({"extra": ""})]
    if not extra:
        return plain
    return [
        need for need in requirements if need not in plain and need.marker and need.marker.evaluate({"extra": extra})
    ]


_TEXT = ("www-browser", "links", "elinks", "lynx", "w3m")
"""Browsers that draw letters only, and would take the terminal."""


def browser() -> webbrowser.BaseBrowser | None:
    """Return the browser that opens addresses; None where no graphical browser is found.

    It is the one that ``BROWSER`` names, or the system's; on Linux without a display there is none.
    """
    try:
        system = webbrowser.get()
    except webbrowser.Error:
        return None
    return None if browser_name(system) in _TEXT else system


def browser_name(opener: webbrowser.BaseBrowser) -> str:
    """Return the name of a browser, as it is called on the command line."""
    return Path(str(getattr(opener, "name", ""))).name or type(opener).__name__


def trial_walk() -> dict[str, Any]:
    """Let the caiman walk for a moment; return how long walking took [s]."""
    import suchus  # noqa: PLC0415  what fails to import is what a trial finds

    crawl = suchus.crawl  # imports what it needs
    start = time.perf_counter()
    record = crawl("caiman", "belly_crawl", duration=0.2)
    return {"seconds": time.perf_counter() - start, "finite": bool(record.position.notnull().all())}


def trial_swim() -> dict[str, Any]:
    """Compile a loop that runs on threads; return by which layer, and where the flow solver's code is kept."""
    import numba  # noqa: PLC0415
    import numpy as np  # noqa: PLC0415

    from suchus.flow import compiled, linking  # noqa: PLC0415

    @numba.njit(parallel=True)  # type: ignore[untyped-decorator]
    def doubled(values: Any) -> Any:
        results = np.empty_like(values)
        for i in numba.prange(values.size):
            results[i] = 2.0 * values[i]
        return results

    doubled(np.ones(8))
    folder = compiled.FOLDER
    return {
        "layer": numba.threading_layer(),
        "folder": None if folder is None else str(folder),
        "compiled": 0 if folder is None else len(list(folder.rglob("*.nbc"))),
        "missing": linking.missing(),
    }


def trial_draw() -> dict[str, Any]:
    """Open an OpenGL context without a window; return by what."""
    os.environ.setdefault("MUJOCO_GL", "egl" if sys.platform == "linux" else "glfw")
    import mujoco  # noqa: PLC0415

    context = mujoco.GLContext(64, 64)
    context.make_current()
    context.free()
    return {"by": os.environ["MUJOCO_GL"]}


TRIALS: dict[str, Callable[[], dict[str, Any]]] = {"walk": trial_walk, "swim": trial_swim, "draw": trial_draw}
"""Trials by name."""


if __name__ == "__main__":
    print(json.dumps(TRIALS[sys.argv[1]]()))
