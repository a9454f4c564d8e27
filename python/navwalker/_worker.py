"""What a worker does with a chunk of a sweep, or a tile of an evaluation.

What reaches it is plain bytes and texts, which any version reads, so that a worker of another version can say so.
"""

from __future__ import annotations

import os
import pickle
import socket
import sys
import threading

from navwalker import _native

_making = threading.Lock()
# The scenario of the last chunk, by what it was made of and its threads: tasks of one process share its evaluator.
_known: dict[tuple[bytes, int | None], _native.Engine] = {}


def this_process() -> str:
    """What tells this process from every other one of the cluster."""
    return f"{socket.gethostname()}:{os.getpid()}"


def pack(engine: _native.Engine) -> bytes:
    """A scenario with its files, as it goes to workers."""
    return pickle.dumps((*engine.packed(), engine.threads))


def evaluate_part(kind: str, scenario: bytes, version: str, client: str, part: bytes) -> bytes:
    """The result of a part, a chunk of a sweep or a tile of an evaluation, that the process ``client`` began with this
    version of the package."""
    own = _native.__version__
    if version != own:
        raise _native.NavwalkerError(
            f"the client has navwalker {version} and the worker {this_process()} has {own}; install one version on both"
        )
    engine = _engine_of(scenario, client)
    return _native.run_chunk(engine, part) if kind == "chunk" else _native.run_tile(engine, part)


def _engine_of(packed: bytes, client: str) -> _native.Engine:
    """The scenario, ready to evaluate, on as many threads as are this worker's."""
    toml, contents, threads = pickle.loads(packed)
    if threads is None:
        threads = _threads_here(client)
    with _making:
        key = packed, threads
        if key not in _known:
            made = _native.Engine.unpacked(toml, contents, threads)
            made.prepare()
            _known.clear()
            _known[key] = made
        return _known[key]


def _threads_here(client: str) -> int | None:
    """The threads of this worker: those that Dask gave it, one in a process of another executor, and in the client's
    own process, where threads of Python evaluate, one for each core."""
    if client == this_process():
        return None
    if "distributed.worker" in sys.modules:
        from distributed import get_worker

        try:
            return min(int(get_worker().state.nthreads), 4 * (os.cpu_count() or 1))
        except ValueError:
            pass
    return 1
