"""100 000 designs of `paper` by one process and by Dask, of which a worker is killed half-way: the same bytes, and what Dask costs.

The step is ten minutes, so that one core does them in minutes; chunks have the size that is the default. Times are of processors, so that other
work on the machine moves them little. It takes some minutes, so that `cluster.sh` runs it only by name.
"""

import resource
import time

from common import Processes, free_port, same, when_begun
from distributed import Client

import navwalker as nw

# 8 x 5 x 5 x 50 x 10 = 100 000 designs, of 121 to 225 satellites.
KEYS = {
    "time_step_s": 600,
    "search_planes": [11, 15],
    "search_satellites_per_plane": [11, 15],
    "search_phasing": [1, 8],
    "search_inclination_deg": [40, 64.5],
    "search_inclination_step_deg": 0.5,
    "search_altitude_km": [500, 950],
    "search_altitude_step_km": 50,
}


def processor_s(pid):
    """Processor time of a process of Linux, seconds."""
    with open(f"/proc/{pid}/stat") as file:
        user, system = file.read().rsplit(")", 1)[1].split()[11:13]
    return (int(user) + int(system)) / 100


def own_s():
    """That of this process."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def by(executor, store):
    """A sweep, its processor time in this process, and the time it took."""
    began = own_s(), time.monotonic()
    found = nw.Scenario("paper", threads=None if executor else 1, **KEYS).sweep(store=store, executor=executor)
    return found, own_s() - began[0], time.monotonic() - began[1]


with Processes() as processes:
    expected, alone_s, elapsed_s = by(None, processes.place / "here")
    chunks = len(expected.index["chunks"])
    print(f"one process, one thread: {expected.designs} designs in {chunks} chunks, {alone_s:.1f} s of processor, {elapsed_s:.0f} s")
    address = f"tcp://127.0.0.1:{free_port()}"
    scheduler = processes.scheduler(address)
    # Without a nanny a worker is one process, and one that is killed does not come back.
    worker = ["distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard", "--no-nanny"]
    workers = [processes.start(worker) for _ in range(2)]
    with Client(address, timeout=60) as client:
        client.wait_for_workers(2, timeout=60)

        print("Dask:")
        began_s = [processor_s(one.pid) for one in (scheduler, *workers)]
        found, client_s, elapsed_s = by(client, processes.place / "dask")
        work_s = [processor_s(one.pid) for one in (scheduler, *workers)]
        scheduler_s, *of_workers_s = [after - before for after, before in zip(work_s, began_s)]
        all_s = client_s + scheduler_s + sum(of_workers_s)
        print(
            f"two workers of one thread: client {client_s:.1f} s, scheduler {scheduler_s:.1f} s, workers {sum(of_workers_s):.1f} s of "
            f"processor, {all_s / alone_s - 1:+.1%} of one process; {elapsed_s:.0f} s"
        )
        same(found, expected)

        def kill():
            processes.kill(workers[0])
            print(f"a worker is killed by SIGKILL when {chunks // 2} of {chunks} chunks are there")

        thread = when_begun(processes.place / "killed", kill, chunks // 2)
        found, _, elapsed_s = by(client, processes.place / "killed")
        thread.join()
        same(found, expected)
        print(f"with a worker killed half-way: {elapsed_s:.0f} s")
