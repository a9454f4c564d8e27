"""Where the chunks of a sweep, or the tiles of an evaluation, are evaluated: by Dask, or by an executor like those of ``concurrent.futures``."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor, CancelledError
from functools import partial
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, Protocol

from navwalker import _native
from navwalker._sweep import Stopped
from navwalker._worker import evaluate_part, pack, this_process

if TYPE_CHECKING:
    from navwalker._scenario import Scenario

# Parts, chunks or tiles, that are given out before the first is back, for each worker, and at least.
_FOR_EACH_WORKER = 3
_AT_LEAST = 16

# How often a chunk is given out again after a scheduler lost it.
_ATTEMPTS = 5

# How long a client of Dask may take to find its scheduler again, seconds.
_RECONNECT_S = 60.0

# After a loss, until the client has seen it, seconds.
_SETTLE_S = 1.0

# What Dask raises for chunks that a scheduler lost, or whose results cannot be fetched from it.
_LOST = ("FutureCancelledError", "CommClosedError")

# Between two counts of the workers of Dask, seconds.
_COUNT_S = 5.0

# Between two looks at the signals, seconds.
_LOOK_S = 0.1


class Future(Protocol):
    """What ``submit`` of an executor returns."""

    def add_done_callback(self, told: Callable[[Any], object], /) -> object: ...
    def result(self) -> bytes: ...
    def cancel(self) -> object: ...


class Executor(Protocol):
    """What evaluates chunks or tiles: an executor like those of ``concurrent.futures``, or a ``Client`` of Dask."""

    def submit(self, work: Callable[..., Any], /, *args: Any, **options: Any) -> Any: ...


class ExecutorEngine:
    """Chunks by anything that is shaped like ``concurrent.futures.Executor``."""

    def __init__(self, executor: Executor, scenario: Scenario, kind: str) -> None:
        self._executor = executor
        self._common = kind, pack(scenario._engine), _native.__version__, this_process()
        self.kind = kind

    def window(self) -> int:
        """How many chunks may be given out at a time."""
        workers = getattr(self._executor, "_max_workers", None)
        return max(_AT_LEAST, _FOR_EACH_WORKER * workers if isinstance(workers, int) else 4 * _AT_LEAST)

    def submit(self, name: str, part: bytes) -> Future:
        """Gives out a part."""
        try:
            future: Future = self._executor.submit(evaluate_part, *self._common, part)
        except BrokenExecutor as error:
            raise Stopped(_broken(error)) from error
        except RuntimeError as error:
            raise Stopped(f"the executor takes no work: {error}") from error
        return future

    def lost(self, error: BaseException) -> bool:
        """Whether a chunk can be given out again after this error."""
        return False


def _on_dask(*arguments: Any) -> Any:
    """The work of a task of Dask; it imports the package itself, so that a worker without it can say so."""
    from navwalker._worker import evaluate_part

    return evaluate_part(*arguments)


# Functions of the main module are sent by value. A worker that cannot import the module of one ends, without a word to the client.
_on_dask.__module__ = "__main__"


class DaskEngine:
    """Chunks by a ``Client`` of Dask."""

    def __init__(self, client: Any, scenario: Scenario, kind: str) -> None:
        self._client = client
        self.kind = kind
        self._scenario = pack(scenario._engine)
        self._common = _native.__version__, this_process()
        self._given: Any = None
        self._generation = 0
        self._lost_s = -_RECONNECT_S
        self._counted_s = -_COUNT_S
        self._threads = 0
        self._require_running()

    def window(self) -> int:
        """How many chunks may be given out at a time; workers come and go."""
        if time.monotonic() - self._counted_s > _COUNT_S and self._client.status == "running":
            self._threads = sum(self._client.nthreads().values())
            self._counted_s = time.monotonic()
        return max(_AT_LEAST, _FOR_EACH_WORKER * self._threads)

    def submit(self, name: str, part: bytes) -> Future:
        """Gives out a part; it is tried again on a worker that has failed, and elsewhere if the worker is lost."""
        if self._given is None:
            # Sent once. It is the result of a task and not data, so that it is not lost with the workers that hold it.
            self._given = self._client.submit(bytes, self._scenario, pure=False)
        arguments = self.kind, self._given, *self._common, part
        key = f"navwalker-{self.kind}-{name}-{self._generation}"
        future: Future = self._client.submit(_on_dask, *arguments, key=key, retries=2)
        return future

    def lost(self, error: BaseException) -> bool:
        """Whether a chunk can be given out again after this error: when the scheduler is there again that has lost it."""
        if not isinstance(error, CancelledError) and type(error).__name__ not in _LOST:
            return False
        # Chunks that were lost together are given out together, once.
        if time.monotonic() - self._lost_s > _LOOK_S:
            time.sleep(_SETTLE_S)
            until = time.monotonic() + _RECONNECT_S
            while self._client.status == "connecting" and time.monotonic() < until:
                time.sleep(_LOOK_S)
            self._require_running()
            self._given = None
            self._generation += 1
        self._lost_s = time.monotonic()
        return True

    def _require_running(self) -> None:
        status = self._client.status
        if status != "running":
            raise Stopped(f"the client of Dask is {status}, expected one that is running")


Engine = ExecutorEngine | DaskEngine


def engine_of(executor: Any, scenario: Scenario, kind: str) -> Engine:
    """The engine for what a caller gives as ``executor``, for parts that are a ``chunk`` or a ``tile``."""
    if type(executor).__module__.split(".")[0] == "distributed" and hasattr(executor, "scheduler_info"):
        if getattr(executor, "asynchronous", False):
            raise Stopped("the client of Dask is asynchronous, expected one that is not")
        return DaskEngine(executor, scenario, kind)
    if not callable(getattr(executor, "submit", None)):
        kind = type(executor).__name__
        raise _native.NavwalkerError(f"executor is a {kind}, expected a Client of Dask or an executor with submit")
    return ExecutorEngine(executor, scenario, kind)


def evaluate(
    engine: Engine, numbers: Iterable[int], part: Callable[[int], tuple[str, bytes]], put: Callable[[int, bytes], None]
) -> None:
    """Evaluates parts by an engine and puts away their results as they come; ``part`` gives the name and the
    bytes of one."""
    waiting = deque((number, 0) for number in numbers)
    done: SimpleQueue[tuple[int, int]] = SimpleQueue()
    running: dict[tuple[int, int], Future] = {}
    try:
        while waiting or running:
            room = engine.window() - len(running) if waiting else 0
            for _ in range(min(room, len(waiting))):
                one = waiting.popleft()
                running[one] = future = engine.submit(*part(one[0]))
                future.add_done_callback(partial(_note, done, one))
            number, attempt = one = _next(done)
            try:
                result = running.pop(one).result()
            except BaseException as error:
                if attempt + 1 < _ATTEMPTS and engine.lost(error):
                    waiting.appendleft((number, attempt + 1))
                    continue
                raise _explained(error, f"{engine.kind} {number + 1}") from error
            put(number, result)
    finally:
        for future in running.values():
            future.cancel()


def _note(done: SimpleQueue[tuple[int, int]], one: tuple[int, int], _: object) -> None:
    done.put(one)


def _next(done: SimpleQueue[tuple[int, int]]) -> tuple[int, int]:
    """The next that is done; a signal is seen meanwhile on every platform."""
    while True:
        try:
            return done.get(timeout=_LOOK_S)
        except Empty:
            continue


def _explained(error: BaseException, part: str) -> BaseException:
    """An error of a worker as one that says what to do."""
    if isinstance(error, (KeyboardInterrupt, SystemExit, _native.NavwalkerError)):
        return error
    if isinstance(error, BrokenExecutor):
        return Stopped(_broken(error))
    if isinstance(error, CancelledError):
        return Stopped("the executor was shut down, or its work was cancelled")
    if isinstance(error, ModuleNotFoundError) and (error.name or "").split(".")[0] == "navwalker":
        return Stopped(f"a worker has no navwalker, or an older one: {error}; install {_native.__version__} there")
    if type(error).__name__ == "KilledWorker":
        return Stopped(f"{part}: the workers that began it were lost, one after the other: {error}")
    return Stopped(f"{part}: {type(error).__name__}: {error}")


def _broken(error: BaseException) -> str:
    return f"the executor is broken, a process of it has ended: {error}"
