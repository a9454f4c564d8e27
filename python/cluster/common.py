"""What the checks on a cluster have in common: a sweep, its bytes by this process, and schedulers and workers of Dask."""

import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import navwalker as nw

# Some 60 chunks.
KEYS = {
    "time_step_s": 120,
    "search_planes": [3, 6],
    "search_satellites_per_plane": [3, 6],
    "search_inclination_step_deg": 2.5,
    "search_altitude_step_km": 200,
}
CHUNK = 10
# A worker that says nothing for so long is given up.
ENVIRONMENT = {
    **os.environ,
    "DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": "8s",
    "DASK_DISTRIBUTED__COMM__TIMEOUTS__TCP": "15s",
    "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "20s",
}


def skipped(why):
    print(why)
    sys.exit(77)


def sweep(store, executor=None):
    return nw.Scenario("paper", **KEYS).sweep(store=store, chunk=CHUNK, executor=executor)


def same(found, expected):
    assert found.path.read_bytes() == expected.path.read_bytes()
    assert found.index == expected.index
    print(f"{found.designs} designs in {len(found.index['chunks'])} chunks, SHA-256 {found.sha256}, as by one process")


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Processes:
    """Processes that end with the check."""

    def __init__(self):
        self.place = Path(tempfile.mkdtemp(prefix="navwalker-cluster-"))
        self.all = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for one in self.all:
            if one.poll() is None:
                os.killpg(one.pid, signal.SIGKILL)
            one.wait()

    def start(self, command, before=()):
        log = open(self.place / f"{len(self.all)}.log", "w")
        options = {"stdout": log, "stderr": subprocess.STDOUT, "env": ENVIRONMENT, "start_new_session": True}
        one = subprocess.Popen([*before, sys.executable, "-m", *command], **options)
        self.all.append(one)
        return one

    def scheduler(self, address, before=()):
        host, port = address.removeprefix("tcp://").split(":")
        return self.start(["distributed.cli.dask_scheduler", "--host", host, "--port", port, "--no-dashboard"], before)

    def worker(self, address, before=(), **options):
        more = [part for name, value in options.items() for part in (f"--{name.replace('_', '-')}", str(value))]
        return self.start(["distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard", *more], before)

    def kill(self, one):
        os.killpg(one.pid, signal.SIGKILL)
        one.wait()


def when_begun(store, act, chunks=3):
    """Does something in another thread once some chunks of a store are there."""

    def wait():
        while len(list(Path(store).glob("chunks/*.parquet"))) < chunks:
            time.sleep(0.02)
        act()

    thread = threading.Thread(target=wait)
    thread.start()
    return thread
