"""Pieces of work on many machines, through Dask; the extra ``cluster`` installs it."""

import logging
import platform
import re
import socket
import ssl
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pickle import PickleError
from typing import Any, TypeVar

from suchus.core import machine
from suchus.core.errors import IncompatibleRecord, SuchusError
from suchus.core.jobs.made_by import source_versions
from suchus.core.sources import ProjectPickle

Item = TypeVar("Item")
Versions = Callable[[], Mapping[str, str]]
_LOG = logging.getLogger(__name__)
_ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[^\[\]/:\s]+):(\d{1,5})")
_SHARED_PACKAGES = (
    "python",
    "dask",
    "distributed",
    "cloudpickle",
    "msgpack",
    "numpy",
)  # alike at both ends
_WORKER_TIMEOUT = 30.0  # [s]; for a first worker
_RETRY_INTERVAL = 0.5  # [s]; between two looks whether somebody listens
_GREETING = 2**20  # bytes of the first message, at most
_UNREAD = "during deserialization"
"""What Dask says where a scheduler or a worker cannot make out what it was sent."""
_SCHEDULER_TIMEOUT = 8.0  # [s]; for a scheduler: a command that finds none ends within 10 s, its start included


class NoCluster(SuchusError, ConnectionError):
    """A scheduler or workers that are not there, or were lost."""


@contextmanager
def connected(address: str, patience: float = _SCHEDULER_TIMEOUT) -> Iterator[Any]:
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


def at_scheduler(address: str | None) -> AbstractContextManager[Any]:
    """Return a context with the client of a scheduler, see ``connected``; with None where no address is given."""
    return connected(address) if address is not None else nullcontext()


def spread(
    work: Callable[[Item], Any],
    items: Sequence[Item],
    client: Any,
    *,
    name: str,
    versions: Versions = source_versions,
    retries: int = 3,
) -> Generator[tuple[int, Any], None, None]:
    """Do one piece of work for each item on a cluster, and yield the results as they are finished, in any order.

    A worker that is lost loses its piece, which another one begins again.

    Args:
        work: makes a piece from its item alone; it and the items travel to the workers as pickles.
        items: what differs between the pieces.
        client: a ``distributed.Client``.
        name: what the pieces are called on Dask's own pages.
        versions: returns what decides the bytes; it must return the same on a worker as here.
        retries: how often a piece is begun again whose worker is lost [-].

    Yields:
        The index of an item, and its result.

    Raises:
        NoCluster: no worker comes, too many are lost, or the scheduler is.
        IncompatibleRecord: a worker has other versions, so that its bytes could differ.
    """
    from distributed import CancelledError, KilledWorker, as_completed  # noqa: PLC0415  whoever has a client has it

    try:
        client.wait_for_workers(1, timeout=_WORKER_TIMEOUT)
        _check_versions(client)
        futures = client.map(
            _piece,
            range(len(items)),
            [ProjectPickle(item) for item in items],
            work=ProjectPickle(work),
            versions=versions,
            expected_versions=dict(versions()) | ({} if machine.asked_to_mix() else machine.arithmetic()),
            pure=False,
            retries=retries,
            key=f"suchus-{name}",
        )
        for future in as_completed(futures, loop=client.loop):
            yield future.result()
            future.release()
    except (CancelledError, KilledWorker, OSError, TimeoutError) as error:
        raise NoCluster(
            f"the cluster was lost ({type(error).__name__}); what was finished is kept: start it again to go on."
        ) from error
    except (ImportError, AttributeError, TypeError, PickleError) as error:
        raise _stranger(error) from error
    except RuntimeError as error:
        if _UNREAD in str(error):
            raise _stranger(error) from error
        raise


def _stranger(error: Exception) -> NoCluster:
    return NoCluster(
        f"a worker cannot run it ({type(error).__name__}: {' '.join(str(error).split())[:200]}); install the same "
        "versions of Python, Dask and suchus on every machine, and all code that the work calls."
    )


def cores(client: Any) -> int:
    """Return how many pieces of work a cluster does at once, at least one [-]."""
    return max(sum(client.nthreads().values()), 1)


def _reach(address: str, patience: float) -> None:
    """Refuse an address that is none, or where nobody listens: Dask waits long for both, and in silence.

    Raises:
        NoCluster: there is nothing to connect to.
    """
    match = _ADDRESS.fullmatch(address)
    if match is None or not 0 < int(match[3]) < 65536:
        raise NoCluster(f"{address!r} is no address of a scheduler; one looks like tcp://127.0.0.1:8786.")
    end, announced = time.monotonic() + patience, False
    while True:
        try:
            endpoint = match[2].strip("[]"), int(match[3])
            with socket.create_connection(endpoint, timeout=max(patience, 0.1)) as wire:
                if _speaks(wire, match[1] == "tls"):
                    return
            raise NoCluster(f"what answers at {address} is no scheduler; start one with `dask scheduler`.")
        except NoCluster:
            raise
        except (OSError, ValueError) as error:
            unknown = isinstance(error, (socket.gaierror, ValueError))
            if unknown or time.monotonic() + _RETRY_INTERVAL > end:
                raise NoCluster(
                    f"no scheduler answers at {address} within {patience:g} s; start one with `dask scheduler`."
                ) from error
        if not announced:
            _LOG.warning("nobody answers at %s; trying for %g s.", address, patience)
            announced = True
        time.sleep(_RETRY_INTERVAL)


def _speaks(wire: socket.socket, secret: bool) -> bool:
    """Return whether a scheduler is at the other end; Dask would wait for one that says nothing, whatever its timeout.

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
        versions = client.get_versions()
        local_versions = _packages(versions["client"])
        remote_versions = {"the scheduler": _packages(versions["scheduler"])}
        remote_versions |= {f"the worker {name}": _packages(worker) for name, worker in versions["workers"].items()}
    except (OSError, TimeoutError, KeyError, TypeError, ValueError, ImportError, AttributeError) as error:
        raise NoCluster(
            "the cluster does not report its versions; start it with the versions that are here."
        ) from error
    for peer, peer_versions in remote_versions.items():
        differences = [
            f"{name} {peer_versions[name]} (here {local_versions[name]})"
            for name in _SHARED_PACKAGES
            if peer_versions[name] != local_versions[name]
        ]
        if differences:
            raise IncompatibleRecord(
                f"{peer} has {', '.join(differences)}; install the same versions on every machine."
            )


def _packages(versions: Mapping[str, Any]) -> dict[str, str]:
    packages: Mapping[str, Any] = versions["packages"]
    return {
        name: ".".join(str(packages.get(name)).split(".")[: 2 if name == "python" else 3]) for name in _SHARED_PACKAGES
    }


def _piece(
    number: int, item: Item, work: Callable[[Item], Any], versions: Versions, expected_versions: Mapping[str, str]
) -> tuple[int, Any]:
    """Do one piece of work, on a worker.

    Args:
        number: index of the item.
        item: what the piece is computed from.
        work: computes the result of an item.
        versions: returns the versions on this worker.
        expected_versions: versions and arithmetic that the results must be made with.
    """
    worker_versions = versions()
    differences = [
        f"{name} {worker_versions.get(name)} (not {expected_versions.get(name)})"
        for name in dict.fromkeys(
            (*worker_versions, *(name for name in expected_versions if name not in machine.arithmetic()))
        )
        if worker_versions.get(name) != expected_versions.get(name)
    ]
    if differences:
        raise IncompatibleRecord(
            f"a worker has {', '.join(differences)}; its bytes could differ: install the same versions everywhere."
        )
    if parts := [
        component
        for component, digest in machine.arithmetic().items()
        if expected_versions.get(component, digest) != digest
    ]:
        raise IncompatibleRecord(
            f"on the worker {platform.node()} the {' and '.join(parts)} give other last bits than here; start all "
            f"processes with {machine.PORTABLE_VARIABLE}=1, take machines of one kind, or say --mixed."
        )
    return number, work(item)
