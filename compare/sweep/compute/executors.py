"""Where the pieces of work are done: in this process, or on the workers of a Dask cluster."""

from __future__ import annotations

import asyncio
import importlib
import itertools
import logging
import math
import time
import warnings
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from types import TracebackType
from typing import Any, NamedTuple, Protocol
from urllib.parse import urlsplit

from compare.run.provenance import stamp

WAIT = 3.0
"""In s, for a scheduler to be reached, to answer, and to have a worker."""

IN_FLIGHT = 3
"""Tasks per thread of the cluster that are with it at one time: enough to keep it busy, and few to lose."""

GLANCE = 1.0
"""In s: how often the threads of the cluster are counted."""


AT_ONCE = 2
"""Tasks in this process, each on all cores."""


class ClusterError(RuntimeError):
    """The cluster can't be reached, or is lost; the message says which."""


class Task(NamedTuple):
    """A call of a function of an importable module; ``compiled`` if it leaves the interpreter's lock to others."""

    key: Hashable
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    compiled: bool


class Executor(Protocol):
    """Does tasks."""

    @property
    def threads(self) -> int | None:
        """How many threads a task may use, None for all cores."""
        ...

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Any, Any]]:
        """Yield keys and results as they come; take the tasks as they are needed."""
        ...


class InProcess:
    """The cores of this machine: while a result is taken, and where one task leaves cores idle, the next one runs."""

    threads = None

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Any, Any]]:
        """Yield keys and results in order."""
        running: deque[tuple[Hashable, Future[Any]]] = deque()
        with ThreadPoolExecutor(AT_ONCE) as pool:
            for task in tasks:
                if not task.compiled:  # side by side two of them would only wait for each other
                    yield task.key, task.function(*task.arguments)
                    continue
                running.append((task.key, pool.submit(task.function, *task.arguments)))
                if len(running) > AT_ONCE:
                    key, result = running.popleft()
                    yield key, result.result()
            for key, result in running:
                yield key, result.result()


class Cluster:
    """The workers of a Dask scheduler, each task on one of their threads; use as a context manager.

    Parameters
    ----------
    address : str
        Of the scheduler, "tcp://host:port".

    Raises
    ------
    ValueError
        For another address.
    ClusterError
        If there is no scheduler, or it has no workers, or not this package; if it is lost later.
    ModuleNotFoundError
        Without Dask.

    """

    threads = 1

    def __init__(self, address: str) -> None:
        self._dask: Any = importlib.import_module("distributed")  # of the extra "cluster", and without types
        for logger in ("distributed", "distributed.client", "tornado.application"):
            logging.getLogger(logger).setLevel(logging.CRITICAL)  # the sentences are ours
        self._address = _checked_address(address)
        self._counted = -math.inf
        self._most = 1
        _reach(self._dask, self._address)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # other versions of libraries: those that matter are in the stamp
            self._client = self._dask.Client(address, timeout=WAIT, set_as_default=False)
        try:
            self._client.wait_for_workers(1, timeout=WAIT)
            self._client.submit(stamp, pure=False).result()
        except TimeoutError:
            self._client.close()
            raise ClusterError(
                f"the scheduler at {address} has no workers: start some, dask worker {address}"
            ) from None
        except (ImportError, RuntimeError, self._dask.KilledWorker):
            self._client.close()
            raise ClusterError(
                f"the scheduler at {address} or its workers can't import friction-discs: "
                "install the same version everywhere"
            ) from None

    def __enter__(self) -> Cluster:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with suppress(Exception):  # of a scheduler that is lost
            self._client.close()

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Any, Any]]:
        """Yield keys and results as they come; what a lost worker had is done by another."""
        keys: dict[str, Hashable] = {}
        waiting = iter(tasks)
        running = self._dask.as_completed(with_results=True, loop=self._client.loop)

        def feed() -> None:
            for task in itertools.islice(waiting, max(0, self._room() - len(keys))):
                future = self._client.submit(task.function, *task.arguments, pure=False)
                keys[future.key] = task.key
                running.add(future)

        try:
            feed()
            for future, result in running:
                if isinstance(result, BaseException):  # of a future that was cancelled
                    raise result
                yield keys.pop(future.key), result
                feed()
        except Exception as error:
            lost = (OSError, self._dask.CancelledError, self._dask.KilledWorker)
            if isinstance(error, lost) or self._client.status != "running":
                raise ClusterError(f"lost the cluster at {self._address}: {_in_words(error)}") from None
            raise

    def _room(self) -> int:
        """Return how many tasks may be with the cluster."""
        now = time.monotonic()
        if now >= self._counted + GLANCE:
            self._counted = now
            self._most = max(1, IN_FLIGHT * sum(self._client.nthreads().values()))
        return self._most


def _reach(dask: Any, address: str) -> None:
    """Raise an error unless a scheduler answers: Dask's client may try for long, or fall over what another says."""

    async def kind() -> Any:
        async with dask.rpc(address) as server:
            return (await server.identity())["type"]

    try:
        answer = asyncio.run(asyncio.wait_for(kind(), WAIT))
    except Exception:  # whatever it does with what is no scheduler's answer
        answer = "nothing"
    if answer != "Scheduler":
        raise ClusterError(f"no Dask scheduler answers at {address}: start one, dask scheduler")


def _checked_address(address: str) -> str:
    """Return the address of a scheduler; raise ``ValueError`` for what is none."""
    try:
        parts = urlsplit(address)
        if parts.scheme and parts.hostname and parts.port:
            return address
    except ValueError:  # of the port
        pass
    raise ValueError(f"scheduler = {address!r}: write it as tcp://HOST:PORT")


def _in_words(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
