"""Executors of tasks: this process, or the workers of a Dask cluster."""

import asyncio
import importlib
import itertools
import logging
import math
import time
import warnings
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from concurrent.futures import Future
from contextlib import AbstractContextManager, suppress
from typing import Any, NamedTuple, TypeAlias
from urllib.parse import urlsplit

from compare.output.outside_text import reason_of
from compare.run.provenance import stamp
from reference_model.numerics.threads import Threads

WAIT = 3.0  # time limit in s for a scheduler to answer and to have a worker
IN_FLIGHT = 3  # submitted tasks per thread: enough to keep it busy, and few to lose
COUNT_INTERVAL = 1.0
POLL = 0.01
FROZEN, LATE = 60.0, 3.0  # a task is late after this time in s, and after this multiple of the longest task
AT_ONCE = 2  # simultaneous tasks in this process, each on all cores


class ClusterError(RuntimeError):
    """The cluster cannot be reached or was lost; the message says which."""


class Task(NamedTuple):
    """A call of an importable function; ``compiled`` if it releases the interpreter lock."""

    key: Hashable
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    compiled: bool


class InProcess:
    """The cores of this machine; the next task fills idle cores."""

    threads = None

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Any, Any]]:
        """Yield keys and results in order; ``tasks`` is consumed on demand."""
        running: deque[tuple[Hashable, Future[Any]]] = deque()
        with Threads(AT_ONCE) as pool:
            for task in tasks:
                if not task.compiled:  # two such tasks would wait for the interpreter lock
                    yield task.key, task.function(*task.arguments)
                    continue
                running.append((task.key, pool.submit(task.function, *task.arguments)))
                if len(running) > AT_ONCE:
                    key, future = running.popleft()
                    yield key, pool.result(future)
            for key, future in running:
                yield key, pool.result(future)


class Cluster(AbstractContextManager["Cluster"]):
    """The workers of the Dask scheduler at "tcp://host:port", each task on one thread; a context manager.

    Raises ``ValueError`` for an invalid address, ``ModuleNotFoundError`` without Dask, and ``ClusterError`` if the
    scheduler is lost or does not answer, or if its workers lack this package.
    """

    threads = 1

    def __init__(self, address: str) -> None:
        self._dask: Any = importlib.import_module("distributed")
        for logger in ("distributed", "distributed.client", "tornado.application"):
            logging.getLogger(logger).setLevel(logging.CRITICAL)  # ``ClusterError`` reports problems
        self._address = _checked_address(address)
        self._counted = -math.inf
        self._most = 1
        _reach(self._dask, self._address)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the stamp covers relevant versions
            self._client = self._dask.Client(address, timeout=WAIT, set_as_default=False)
        try:
            self._client.wait_for_workers(1, timeout=WAIT)
            self._client.submit(stamp, pure=False).result()
        except TimeoutError:
            self._client.close()
            raise ClusterError(
                f"the scheduler at {address} has no workers; start one with: dask worker {address}"
            ) from None
        except (ImportError, RuntimeError, self._dask.KilledWorker):
            self._client.close()
            raise ClusterError(
                f"the scheduler at {address} or its workers cannot import friction-discs; "
                "install the same version on all machines"
            ) from None

    def __exit__(self, *_: object) -> None:
        with suppress(Exception):
            self._client.close()

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Any, Any]]:
        """Yield keys and results as they become available; another worker repeats tasks of a lost worker."""
        sent: dict[str, tuple[Task, float]] = {}
        waiting, longest = iter(tasks), 0.0
        running = self._dask.as_completed(with_results=True, loop=self._client.loop)

        def send(task: Task, workers: list[str] | None = None) -> None:
            future = self._client.submit(task.function, *task.arguments, pure=False, workers=workers)
            sent[future.key] = task, time.monotonic()
            running.add(future)

        try:
            while True:
                for task in itertools.islice(waiting, max(0, self._room() - len(sent))):
                    send(task)
                if not sent:
                    return
                if not running.has_ready():
                    time.sleep(POLL)
                    for key, workers in self._late(sent, max(FROZEN, LATE * longest)):
                        send(sent.pop(key)[0], workers)
                    continue
                future, result = next(running)
                if future.key not in sent:  # a late result
                    continue
                if isinstance(result, BaseException):  # the future was cancelled
                    raise result
                task, since = sent.pop(future.key)
                longest = max(longest, time.monotonic() - since)
                yield task.key, result
        except Exception as error:
            lost = (OSError, self._dask.CancelledError, self._dask.KilledWorker)
            if isinstance(error, lost) or self._client.status != "running":
                raise ClusterError(f"lost the cluster at {self._address}: {reason_of(error)}") from None
            raise

    def _late(self, sent: dict[str, tuple[Task, float]], limit: float) -> list[tuple[str, list[str]]]:
        """Return the tasks that take longer than ``limit`` (s), with the workers that do not have them."""
        late = [key for key, (_, since) in sent.items() if time.monotonic() - since > limit]
        held = self._client.processing() if late else {}
        others = {key: [worker for worker, keys in held.items() if key not in keys] for key in late}
        return [(key, workers) for key, workers in others.items() if workers]

    def _room(self) -> int:
        now = time.monotonic()
        if now >= self._counted + COUNT_INTERVAL:
            self._counted = now
            self._most = max(1, IN_FLIGHT * sum(self._client.nthreads().values()))
        return self._most


Executor: TypeAlias = InProcess | Cluster


def _reach(dask: Any, address: str) -> None:
    async def kind() -> Any:
        async with dask.rpc(address) as server:
            return (await server.identity())["type"]

    try:
        answer = asyncio.run(asyncio.wait_for(kind(), WAIT))
    except Exception:  # Dask may raise anything for another program
        answer = "nothing"
    if answer != "Scheduler":
        raise ClusterError(f"no Dask scheduler answers at {address}; start one with: dask scheduler")


def _checked_address(address: str) -> str:
    try:
        parts = urlsplit(address)
        if parts.scheme and parts.hostname and parts.port:
            return address
    except ValueError:  # invalid port
        pass
    raise ValueError(f"scheduler = {address!r}: write it as tcp://HOST:PORT")
