"""The batches of a study on many machines, through Dask; the extra ``cluster`` installs it."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

import xarray as xr

from suchus.errors import IncompatibleRecord, SuchusError
from suchus.study.chunk import run_chunk
from suchus.study.store import deciding
from suchus.study.study import Study

_RETRIES = 3  # how often a batch is begun again when its worker is lost
_PATIENCE = 30.0  # [s]; for a first worker


class NoCluster(SuchusError, ConnectionError):
    """A scheduler or workers that are not there, or were lost."""


@contextmanager
def connected(address: str, patience: float = _PATIENCE) -> Iterator[Any]:
    """Yield a ``distributed.Client`` of a scheduler.

    Args:
        address: as ``tcp://127.0.0.1:8786``.
        patience: how long to wait for it [s].

    Raises:
        NoCluster: Dask is not installed, or no scheduler answers there.
    """
    try:
        from distributed import Client  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise NoCluster("a cluster needs dask.distributed; install it with: pip install 'suchus[cluster]'.") from error
    try:
        client = Client(address, timeout=patience, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise NoCluster(
            f"no scheduler answers at {address} within {patience:g} s; start one with `dask scheduler`."
        ) from error
    try:
        yield client
    finally:
        client.close()


def here(client: Any) -> AbstractContextManager[Any]:
    """Return a context in which files are written by this process alone, whatever client is Dask's default.

    With a default client xarray asks the scheduler for a lock on every file, which a busy one may have forgotten.
    """
    if client is None:
        return nullcontext()
    import dask  # noqa: PLC0415  whoever has a client has it

    context: AbstractContextManager[Any] = dask.config.set(scheduler="threads")
    return context


def spread(
    study: Study, numbers: Sequence[int], client: Any, *, patience: float = _PATIENCE
) -> Iterator[tuple[int, xr.Dataset]]:
    """Run batches on a cluster and yield each with its number as it is finished, in any order.

    A worker that is lost loses its batch, which another one begins again.

    Args:
        study: the study.
        numbers: of its batches.
        client: a ``distributed.Client``.
        patience: how long to wait for a first worker [s].

    Raises:
        NoCluster: no worker comes, too many are lost, or the scheduler is.
        IncompatibleRecord: a worker has other versions, so that its bytes could differ.
    """
    from distributed import CancelledError, KilledWorker, as_completed  # noqa: PLC0415  whoever has a client has it

    try:
        client.wait_for_workers(1, timeout=patience)
        futures = client.map(
            _batch, numbers, study=study, wanted=deciding(), pure=False, retries=_RETRIES, key=f"suchus-{study.name}"
        )
        for future in as_completed(futures, loop=client.loop):
            yield future.result()
            future.release()
    except (CancelledError, KilledWorker, OSError, TimeoutError) as error:
        raise NoCluster(
            f"the cluster was lost ({type(error).__name__}); what was finished is kept: start the study again to go on."
        ) from error


def _batch(number: int, study: Study, wanted: Mapping[str, str]) -> tuple[int, xr.Dataset]:
    """Run one batch on a worker."""
    here = deciding()
    other = [f"{name} {version} (not {wanted[name]})" for name, version in here.items() if version != wanted[name]]
    if other:
        raise IncompatibleRecord(
            f"a worker has {', '.join(other)}; its bytes could differ: install the same versions everywhere."
        )
    return number, run_chunk(study, number)
