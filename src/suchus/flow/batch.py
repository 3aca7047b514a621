"""Batches of flows: independent flows on grids of equal size, computed side by side."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from math import isfinite, prod
from threading import Event, Lock

import numba

from suchus.core import threads
from suchus.core.errors import InvalidDesign, OutsideLimits, SuchusError
from suchus.flow.progress import Bar
from suchus.flow.rake import due_after
from suchus.flow.setup import Setup
from suchus.flow.simulation import Simulation

UNSAFE_THREADING_LAYER = "workqueue"
"""Threading layer of numba that several threads may not use at once."""

BatchWatcher = Callable[[int, Simulation], None]
"""Function that is called with the index of a flow and its simulation during a batch."""


class _StoppedBatch(Exception):
    """Ends a flow because another one of the batch has failed."""


def batch(
    setups: Sequence[Setup],
    end_time: float,
    *,
    watch: BatchWatcher | None = None,
    watch_interval: float | None = None,
    thread_count: int | None = None,
    progress: bool = True,
) -> list[Simulation]:
    """Compute independent flows until a time and return their simulations, in the order of the set-ups.

    Each flow takes steps of its own and has the same bytes as alone. Several threads take one flow each. For small
    flows this is faster than several threads for one flow, which wait for each other in every loop.

    Args:
        setups: what is simulated. All have as many cells along each axis and one precision.
        end_time: time to reach, exactly [s].
        watch: called whenever ``watch_interval`` seconds of a flow have passed, and at its end. With several threads,
            calls for different flows may overlap.
        watch_interval: interval of ``watch`` [s]; None calls it after every step.
        thread_count: flows that are computed at the same time; None takes ``threads.count`` [-].
        progress: whether a batch longer than two seconds shows a progress bar.

    Raises:
        InvalidDesign: there is no flow, or cells or precision differ.
        OutsideLimits: ``end_time`` is no time after 0, or ``thread_count`` is not positive.
        SuchusError: a flow cannot go on; the message begins with its index. See ``Simulation.run``.
    """
    check_batch(setups)
    if not (isfinite(end_time) and end_time > 0):
        raise OutsideLimits(f"the batch is to last until {end_time} s; give a finite time above 0.")
    count = threads.count() if thread_count is None else thread_count
    if count < 1:
        raise OutsideLimits(f"a batch is to use {count} threads; give at least 1.")
    simulations = []
    for index, setup in enumerate(setups):
        with _named(index):
            simulations.append(Simulation(setup, thread_count=1))
    count = min(count, len(simulations))
    if count > 1:
        with _named(0):  # several threads would compile the same kernels
            Simulation(setups[0], thread_count=1).advance()
        count = 1 if numba.threading_layer() == UNSAFE_THREADING_LAYER else count
    cells = sum(prod(layer.grid.cells) for layer in simulations[0].water.layers)
    with Bar(0.0, end_time * len(simulations), cells, show=progress) as bar:
        flows = _Flows(simulations, end_time, watch, watch_interval, bar)
        if count == 1:
            for index in range(len(simulations)):
                flows.run(index)
        else:
            flows.run_on_threads(count)
    return simulations


def check_batch(setups: Sequence[Setup]) -> None:
    """Refuse set-ups that do not make a batch.

    Raises:
        InvalidDesign: there is none, or cells or precision differ; the message names the first that differs.
    """
    if not setups:
        raise InvalidDesign("the batch has no flow; give at least one Setup.")
    for index, setup in enumerate(setups):
        if _size_text(setup) != _size_text(setups[0]):
            raise InvalidDesign(
                f"flow {index} of the batch has {_size_text(setup)}, and flow 0 has {_size_text(setups[0])}; a batch "
                f"takes flows with as many cells along each axis and one precision. Call batch once for each grid."
            )


def _size_text(setup: Setup) -> str:
    """Return the cells and the precision of a set-up, in words."""
    grids = [setup.grid] if setup.coarse_grid is None else [setup.grid, setup.coarse_grid]
    sizes = [" x ".join(map(str, grid.cells)) for grid in grids]
    return f"{' fine cells in '.join(sizes)} cells in {setup.precision} precision"


@contextmanager
def _named(index: int) -> Iterator[None]:
    """Let errors of a flow begin with its index."""
    try:
        yield
    except SuchusError as error:
        error.args = (f"flow {index} of the batch: {error.args[0]}", *error.args[1:])
        raise


class _Flows:
    """The flows of a batch while they are computed."""

    def __init__(
        self, simulations: list[Simulation], end_time: float, watch: BatchWatcher | None,
        watch_interval: float | None, bar: Bar,
    ) -> None:  # fmt: skip
        self._simulations, self._end_time, self._bar = simulations, end_time, bar
        self._watch, self._watch_interval = watch, watch_interval
        self._times, self._bar_lock, self._stop = [0.0] * len(simulations), Lock(), Event()

    def run(self, index: int) -> None:
        """Compute one flow until the end."""
        due = due_after(0.0, self._watch_interval)

        def report(simulation: Simulation) -> None:
            nonlocal due
            if self._stop.is_set():
                raise _StoppedBatch
            with self._bar_lock:
                self._times[index] = simulation.time
                self._bar.move(sum(self._times))
            if self._watch is not None and (simulation.time >= due or simulation.time == self._end_time):
                self._watch(index, simulation)
                due = due_after(simulation.time, self._watch_interval)

        with _named(index):
            self._simulations[index].run(self._end_time, watch=report, progress=False)

    def run_on_threads(self, count: int) -> None:
        """Compute all flows, several at a time; the first error ends the others.

        Args:
            count: flows that are computed at the same time.
        """
        with ThreadPoolExecutor(count) as pool:
            futures = [pool.submit(self.run, index) for index in range(len(self._simulations))]
            try:
                for future in futures:
                    future.result()
            except BaseException:
                self._stop.set()
                pool.shutdown(wait=True, cancel_futures=True)
                failures = [future.exception() for future in futures if future.done() and not future.cancelled()]
                for failure in failures:
                    if failure is not None and not isinstance(failure, _StoppedBatch):
                        raise failure from None
                raise
