"""The batches of a study on many machines, through Dask; the extra ``cluster`` installs it."""

import logging
import re
import socket
import ssl
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pickle import PickleError
from typing import Any

import xarray as xr

from suchus.errors import IncompatibleRecord, SuchusError
from suchus.study.chunk import run_chunk
from suchus.study.store import deciding
from suchus.study.study import Study

_LOG = logging.getLogger(__name__)
_ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[^\[\]/:\s]+):(\d{1,5})")
_ALIKE = (
    "python",
    "dask",
    "distributed",
    "cloudpickle",
    "msgpack",
    "numpy",
)  # alike at both ends
_RETRIES = 3  # how often a batch is begun again when its worker is lost
_PATIENCE = 30.0  # [s]; for a first worker
_AGAIN = 0.5  # [s]; between two looks whether somebody listens
_GREETING = 2**20  # bytes of the first message, at most
_SOON = 10.0  # [s]; for a scheduler


class NoCluster(SuchusError, ConnectionError):
    """A scheduler or workers that are not there, or were lost."""


@contextmanager
def connected(address: str, patience: float = _SOON) -> Iterator[Any]:
    """Yield a ``distributed.Client`` of a scheduler.

    Args:
        address: as ``tcp://127.0.0.1:8786``.
        patience: how long to wait for it [s].

    Raises:
        NoCluster: Dask is not installed, the address is none, or no scheduler answers there.
        IncompatibleRecord: the scheduler has other versions, which do not understand ours.
    """
    try:
        from distributed import Client  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise NoCluster("a cluster needs dask.distributed; install it with: pip install 'suchus[cluster]'.") from error
    _reach(address, patience)
    try:
        client = Client(address, timeout=patience, set_as_default=False)
    except (OSError, ValueError, TypeError, RuntimeError, ImportError) as error:
        raise NoCluster(
            f"no scheduler answers at {address} within {patience:g} s; start one with `dask scheduler`, of the same "
            "version as here."
        ) from error
    try:
        _check_versions(client)
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
        _check_versions(client)
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
    except (ImportError, AttributeError, TypeError, PickleError) as error:
        raise NoCluster(
            f"a worker cannot run it ({type(error).__name__}: {error}); install the same versions of Python, Dask and "
            "suchus on every machine."
        ) from error


def _reach(address: str, patience: float) -> None:
    """Refuse an address that is none, or where nobody listens: Dask waits long for both, and in silence.

    Raises:
        NoCluster: there is nothing to connect to.
    """
    found = _ADDRESS.fullmatch(address)
    if found is None or not 0 < int(found[3]) < 65536:
        raise NoCluster(f"{address!r} is no address of a scheduler; one looks like tcp://127.0.0.1:8786.")
    end, told = time.monotonic() + patience, False
    while True:
        try:
            where = found[2].strip("[]"), int(found[3])
            with socket.create_connection(where, timeout=max(patience, 0.1)) as wire:
                if _speaks(wire, found[1] == "tls"):
                    return
            raise NoCluster(f"what answers at {address} is no scheduler; start one with `dask scheduler`.")
        except NoCluster:
            raise
        except (OSError, ValueError) as error:
            unknown = isinstance(error, (socket.gaierror, ValueError))
            if unknown or time.monotonic() + _AGAIN > end:
                raise NoCluster(
                    f"no scheduler answers at {address} within {patience:g} s; start one with `dask scheduler`."
                ) from error
        if not told:
            _LOG.warning("nobody answers at %s; trying for %g s.", address, patience)
            told = True
        time.sleep(_AGAIN)


def _speaks(wire: socket.socket, secret: bool) -> bool:
    """Tell whether a scheduler is at the other end; Dask would wait for one that says nothing, whatever its timeout.

    A scheduler speaks first, with the length of what it says; behind TLS it answers the handshake.
    """
    try:
        if secret:
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE  # Dask checks who it is, with its keys
            context.wrap_socket(wire).close()
            return True
        length = wire.recv(8)
    except TimeoutError:
        return False
    return len(length) == 8 and int.from_bytes(length, "little") < _GREETING


def _check_versions(client: Any) -> None:
    """Refuse schedulers and workers that would not understand what they are sent.

    Raises:
        IncompatibleRecord: naming what they have and what is here.
        NoCluster: they do not even say.
    """
    try:
        told = client.get_versions()
        ours = _packages(told["client"])
        others = {"the scheduler": _packages(told["scheduler"])}
        others |= {f"the worker {name}": _packages(worker) for name, worker in told["workers"].items()}
    except (OSError, TimeoutError, KeyError, TypeError, ValueError, ImportError, AttributeError) as error:
        raise NoCluster("the cluster does not tell its versions; start it with the versions that are here.") from error
    for who, theirs in others.items():
        other = [f"{name} {theirs[name]} (here {ours[name]})" for name in _ALIKE if theirs[name] != ours[name]]
        if other:
            raise IncompatibleRecord(f"{who} has {', '.join(other)}; install the same versions on every machine.")


def _packages(told: Mapping[str, Any]) -> dict[str, str]:
    packages: Mapping[str, Any] = told["packages"]
    return {name: ".".join(str(packages.get(name)).split(".")[: 2 if name == "python" else 3]) for name in _ALIKE}


def _batch(number: int, study: Study, wanted: Mapping[str, str]) -> tuple[int, xr.Dataset]:
    """Run one batch on a worker."""
    here = deciding()
    other = [f"{name} {version} (not {wanted[name]})" for name, version in here.items() if version != wanted[name]]
    if other:
        raise IncompatibleRecord(
            f"a worker has {', '.join(other)}; its bytes could differ: install the same versions everywhere."
        )
    return number, run_chunk(study, number)
